"""pyrender drawing one mesh offscreen: floor, a directional light with a shadow map, edges smoothed by 4 samples.

The mesh stays as it is, which is the best case: to pose it, all of it would have to be made anew.

    python pyrender_frames.py SCENE.npz OUT.png       (run by bench/render.py --rivals, in an environment of its own)
"""

import json
import os
import sys
import time

os.environ["PYOPENGL_PLATFORM"] = "egl"

import numpy as np
import pyrender
import trimesh
from OpenGL import GL
from PIL import Image


def looking(eye, target):
    """The pose (4, 4) of a camera or lamp that looks along its -z."""
    pose, back = np.eye(4), (eye - target) / np.linalg.norm(eye - target)
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    pose[:3, :3], pose[:3, 3] = np.stack([right, np.cross(back, right), back], 1), eye
    return pose


data = np.load(sys.argv[1])
width, height = data["size"].tolist()
scene = pyrender.Scene(bg_color=(0.7, 0.75, 0.8), ambient_light=(0.3, 0.3, 0.3))
paint = pyrender.MetallicRoughnessMaterial(baseColorFactor=(0.75, 0.42, 0.22, 1.0), metallicFactor=0.0)
scene.add(pyrender.Mesh.from_trimesh(trimesh.Trimesh(data["vertices"][0], data["triangles"], process=False), paint))
floor = trimesh.creation.box((20.0, 0.02, 20.0))
floor.apply_translation((0.0, -0.01, 0.0))
scene.add(pyrender.Mesh.from_trimesh(floor, smooth=False))
scene.add(pyrender.PerspectiveCamera(float(data["fov"]), aspectRatio=width / height),
          pose=looking(data["eye"], data["target"]))
scene.add(pyrender.DirectionalLight(intensity=4.0), pose=looking(np.array([3.1, 3.75, -1.1]), np.zeros(3)))
renderer = pyrender.OffscreenRenderer(width, height)
took = []
for k in range(int(data["frames"]) + 5):
    if k == 5:
        spent = time.process_time()
    began = time.perf_counter()
    picture, _ = renderer.render(scene, pyrender.RenderFlags.SHADOWS_DIRECTIONAL)
    took.append(1000.0 * (time.perf_counter() - began))
spent = 1000.0 * (time.process_time() - spent) / int(data["frames"])
Image.fromarray(picture).save(sys.argv[2])
assert picture.shape[:2] == (height, width), picture.shape
renderer._platform.make_current()
print(json.dumps({"draws": GL.glGetString(GL.GL_RENDERER).decode(), "took": took[5:], "processor": spent}))
