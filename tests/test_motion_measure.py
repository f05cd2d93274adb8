"""The detector behind the figures of changes: on motions whose mass centre, friction, feet and swings are known."""

import sys
from pathlib import Path

import numpy as np
import pytest

from gambol.controllers.body import human
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion

sys.path.insert(0, str(Path(__file__).parents[1] / "scripts" / "measure"))
from _motion import GRAVITY, LIGHT, Motion  # noqa: E402

FPS = 60
NATURAL = {"walk": np.full(22, 10.0), "run": np.full(22, 40.0)}


@pytest.fixture(scope="module")
def standing():
    """The pose of somebody who stands."""
    return Locomotion.load().start().pose


def moved(standing, way, rate=FPS):
    """A statue that is carried along a way (T, 3) [m]."""
    roots = np.asarray(standing.root, float) + way
    rotations = np.broadcast_to(np.asarray(standing.rotations, float), (len(way), 22, 3, 3))
    return Motion(human(), rate, roots[:, None], rotations[:, None], NATURAL)


def pushed(acceleration, seconds=1.0, rate=FPS):
    """The way of something pushed evenly (3,) [m/s²]."""
    return 0.5 * np.square(np.arange(round(seconds * rate)) / rate)[:, None] * np.asarray(acceleration, float)


@pytest.mark.parametrize("rate", [30, 60, 120])
def test_an_even_push_is_found_and_its_friction_is_its_share_of_the_weight(standing, rate):
    motion = moved(standing, pushed((0.0, 0.0, 1.5), rate=rate), rate)
    inner = slice(8, -8)
    np.testing.assert_allclose(motion.com_acceleration[inner, 0], [[0.0, 0.0, 1.5]] * len(motion.com[inner]), atol=1e-6)
    np.testing.assert_allclose(motion.friction[inner, 0], 1.5 / GRAVITY, atol=1e-6)
    np.testing.assert_allclose(motion.joints[inner, 0], 0.15, atol=1e-6)


def test_a_fall_counts_as_a_light_load(standing):
    motion = moved(standing, pushed((1.0, -GRAVITY, 0.0)))
    np.testing.assert_allclose(motion.friction[8:-8, 0], 1.0 / (LIGHT * GRAVITY), atol=1e-6)


def test_who_stands_stands_and_who_is_dragged_drifts(standing):
    still = moved(standing, np.zeros((60, 3)))
    assert still.standing.all() and still.drift().max() == 0.0 and not still.running.any()
    dragged = moved(standing, np.linspace(0.0, 0.2, 60)[:, None] * [0.0, 0.0, 1.0])
    assert dragged.drift().mean() == pytest.approx(0.2, abs=0.01)


def test_who_is_fast_is_judged_as_a_runner(standing):
    fast = moved(standing, np.arange(60)[:, None] / FPS * [0.0, 0.0, 3.0])
    assert fast.running.all() and not moved(standing, np.arange(60)[:, None] / FPS * [0.0, 0.0, 1.0]).running.any()


def test_a_walk_has_swings_and_its_toes_clear_the_floor():
    """And a library that scuffs would be seen: the same walk, sunk by two centimetres."""
    walker = Locomotion.load()
    state, poses = walker.start(), []
    for _ in range(6 * FPS):
        state, pose = walker.step(state, Intent(np.array([1.3, 0.0, 0.0])), 1 / FPS)
        poses.append(pose)
    roots, rotations = (np.array([np.asarray(getattr(p, name), float) for p in poses])[:, None] for name in ("root", "rotations"))
    whole = Motion(walker.skeleton, FPS, roots, rotations, walker.library.accelerations)
    assert len(whole.scuffs()) >= 6 and not whole.scuffs().any()
    assert whole.apart.min() > 0.06 and whole.friction.max() < 0.6
    sunk = Motion(walker.skeleton, FPS, roots - [0.0, 0.02, 0.0], rotations, walker.library.accelerations)
    assert sunk.scuffs().mean() > 0.5
