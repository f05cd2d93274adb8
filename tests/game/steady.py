"""A method of reconstruction that needs no database, for tests of those who follow points."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction.pose_vector import HEIGHT, PITCH, ROLL, WIDTH, YAW_RATE
from gambol.controllers.reconstruction.regression.beliefs import Gaussian
from gambol.controllers.reconstruction.regression.map_solver import Solver
from gambol.controllers.reconstruction.regression.method import Method
from gambol.controllers.supervisor import Supervisor
from gambol.game.world import learnt_methods as learning


class Steady:
    """A prior that needs no database: the coming pose is like the last one, and upright."""

    def believe(self, memory, seen, goals):
        deviation = np.full(WIDTH, 0.08)
        deviation[HEIGHT], deviation[YAW_RATE:] = 0.02, 1.0
        mean = memory.frames[0].copy()
        mean[PITCH], mean[ROLL], mean[HEIGHT] = 0.0, 0.0, 0.95
        return Gaussian(mean, deviation**2), None


class NoStarts:
    """Where to begin from points: nowhere, as nobody here has to."""

    def find(self, points, velocities=None, turns=None):
        raise AssertionError("the body stands where its points are")


@pytest.fixture(autouse=True)
def no_database(monkeypatch):
    """Every method is `Steady`, learnt at once."""
    monkeypatch.setattr(learning, "learnt", lambda name, database, controls, progress=None: Method(
        Steady(), Solver(controls, 1 / 60)))
    monkeypatch.setattr(learning.Methods, "database", lambda self, progress=None: None)
    monkeypatch.setattr(learning.Methods, "starts", lambda self, name, points: NoStarts())
    learning.methods.cache_clear()
    yield
    learning.methods.cache_clear()


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


SCENE = """
title = "Test"
duration = 3
fps = 60
overlays = ["mesh", "points", "errors"]
[[actors]]
name = "A"
moves = [{ for = 3, velocity = [1.3, 0.3, 0] }]
[[actors]]
name = "shadow"
follows = { actor = "A", points = 4, beside = [-1.5, 0, 0.25], hidden = [{ points = "lwrist", from = 1, to = 2 }] }
[[actors]]
name = "ghost"
ghost = true
follows = { actor = "A", points = "4", method = "lpcr", beside = [-1.5, 0, 0.25] }
"""
