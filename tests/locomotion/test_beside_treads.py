"""Whoever turns about on stairs and beside what is low, his wish changing all the time, keeps his feet and shins out of it, and stands on it."""

from types import SimpleNamespace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.jump.body import Physique
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.struck import flesh

COUNT, FPS, CHANGES = 160, 60, 24
"""So many people; steps a second; a wish holds for so many steps."""
DEEP, STANDS = 0.02, 0.04
"""What is deeper than the first counts, and a standing foot all of whose sole is higher than the second over anything [m]."""
FALLS = 0.3
"""Whose middle is over what lies so much lower [m] than he stands walks on in the air here, and would fall."""


def box(x, z, wide, high, deep):
    return SimpleNamespace(centre=(x, 0.5 * high, z), size=(wide, high, deep), heading=0.0, slope=0.0)


THINGS = {"stairs": tuple(box(0.0, 0.29 * k, 2.0, 0.17 * (k + 1), 0.29) for k in range(6)), "a kerb": (box(0.0, 0.6, 1.2, 0.12, 1.0),), "a low box": (box(0.0, 0.6, 1.4, 0.3, 1.2),)}


def walked(locomotion, things):
    """How deep (T, N) [m] anything is in things, and how high the higher foot that is said to stand is over all, of those who were not put into them, until they step off their side."""
    physique, rng = Physique(), np.random.default_rng(0)
    ground = np.stack([rng.uniform(-0.9, 0.9, COUNT), rng.uniform(-0.8, 1.4, COUNT), rng.uniform(-np.pi, np.pi, COUNT)], -1)
    state, depths, heights = locomotion.start(ground, np.array([floor_at(x, z, things, 9.0) for x, z, _ in ground])), [], []
    fallen = np.zeros(COUNT, bool)
    for k in range(10 * CHANGES):
        if k % CHANGES == 0:
            wish = np.stack([rng.uniform(0.2, 0.8, COUNT), rng.uniform(-2.5, 2.5, COUNT), rng.choice([0.0, 0.0, 0.3, -0.3], COUNT)], -1) * rng.choice([1.0, 1.0, 1.0, 0.0], (COUNT, 1))
        state, pose = locomotion.step(state, Intent(wish, around=things), 1 / FPS)
        places, thick = flesh(physique, *forward_kinematics(locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))
        fallen |= [floor_at(x, z, things, 9.0) < floor - FALLS for (x, z, _), floor in zip(state.ground, state.floor)]
        away = np.min([gap(places.reshape(-1, 3), thing).reshape(places.shape[:2]) for thing in things], 0)
        depths.append(np.where(fallen, 0.0, (thick - away).max(1)))
        soles = (np.minimum(away, places[..., 1]) - thick)[:, -6:].reshape(COUNT, 2, 3).min(-1)
        heights.append(np.where(np.asarray(state.contacts).reshape(COUNT, 2, 2).any(-1) & ~fallen[:, None], soles, 0.0).max(1))
    outside = depths[0] < 0.5 * DEEP
    return np.array(depths)[:, outside], np.array(heights)[:, outside]


@pytest.mark.few(1)
@pytest.mark.parametrize("name, share, floats", (("stairs", 0.0125, 0.0005), ("a kerb", 0.0075, 0.0), ("a low box", 0.010, 0.0015)))
def test_legs_keep_out_of_it_and_feet_stand_on_it(locomotion, name, share, floats):
    """Feet choose their places anew as they come to point otherwise, half a shoe clear of risers beside them; and who turns on stairs stands low enough for his legs to
    reach: they lost hold, and hung in the air."""
    depths, heights = walked(locomotion, THINGS[name])
    assert np.mean(depths > DEEP) < share and np.mean(heights > STANDS) <= floats
