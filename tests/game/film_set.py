"""What tests film: a short scenario, two cameras, and a stage that draws where in its picture each pixel is."""

import numpy as np

SCENARIO = """
title = "Short"
duration = 0.2
fps = 20
[[actors]]
name = "A"
moves = [{ for = 1.0, velocity = [1, 0, 0] }]
[[props]]
kind = "box"
centre = [0.4, 0.4, 0.8]
size = [0.3, 0.8, 0.3]
heading = 30
"""
CAMERAS = """
[front]
size = [64, 48]
eye = [0.2, 1.2, 5.0]
target = [0, 0.9, 0]
fov = 40
[side]
size = [48, 64]
eye = [4.0, 1.4, 0.5]
target = [0, 0.9, 0]
fov = 50
distortions = [-0.2, 0.05, 0.001, 0.002]
"""


class Drawing:
    """A stage that draws where in its picture each pixel is, and counts."""

    def __init__(self):
        self.size, self.count = (16, 16), 0

    def resize(self, size):
        self.size = size

    def frame(self, scene):
        self.count += 1
        width, height = self.size
        out = np.zeros((height, width, 4), np.uint8)
        out[..., 0] = np.linspace(0, 255, width).astype(np.uint8)
        out[..., 1] = np.linspace(0, 255, height).astype(np.uint8)[:, None]
        return out
