"""Soles in a leap: on the floor while they push, and not through it in low flights."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import Physique
from gambol.controllers.jump.starting import ready
from gambol.controllers.person import person as anybody

FPS = 60


def soles(jump, made, some):
    """How high (N, 2) [m] the lowest of each sole is in some of a plan's poses."""
    return sole_corners(jump.skeleton, *forward_kinematics(jump.skeleton, made.roots[some], made.local[some])).reshape(int(some.sum()), 2, -1, 3)[..., 1].min(-1)


def leaps(jump, state, ways):
    """The plans of leaps so far ahead (n,) [m] that can be made from a state."""
    x, z, heading = state.ground
    for far in ways:
        try:
            yield jump.plan(state, Intent(leap=Leap(np.array([x + far * np.sin(heading), 0.0, z + far * np.cos(heading)]))))
        except Unable:
            continue


def gone(walker, state, velocity, steps):
    for _ in range(steps):
        state, _ = walker.step(state, Intent(np.array([velocity, 0.0, 0.0])), 1 / FPS)
    return state


@pytest.mark.few(1)
@pytest.mark.parametrize("pace", [2.2, 2.8])
@pytest.mark.parametrize("later", [0, 13, 26])
def test_nobody_pushes_off_in_the_air_out_of_a_run_that_he_let_go(person, jump, later, pace):
    """Feet that were about to come down were taken for such as stand, and came down over the same time whatever the push took: 3 cm high while they pushed."""
    slows, found = gone(person, person.start(), pace, 120 + later), []
    for k in range(30):
        if k % 2 == 0 and ready(jump.physique, slows):
            single = jump.start_of(slows).single
            for made in leaps(jump, slows, (0.6, 1.0, 1.5)) if single is not None else ():
                pushes = (made.times <= made.take_off + 1e-9) & (np.linalg.norm(made.forces, axis=1) > 6.0 * jump.physique.mass)
                found.append(soles(jump, made, pushes)[:, single].max() - float(slows.floor))
        slows = gone(person, slows, 0.0, 1)
    assert len(found) > 3 and max(found) < 0.014


@pytest.mark.few(1)
@pytest.mark.parametrize("height", [0.9, 1.741])
@pytest.mark.parametrize("pace", [0.8, 1.2, 1.6])
def test_no_sole_goes_through_the_floor_in_low_flights(height, pace):
    """Toes that pointed down dragged through it, up to 2.7 cm deep, a child's by a twentieth of its height."""
    size = height / 1.741
    walker = anybody(physique=Physique(73.0 * size**3, height))
    jump, found = walker.parts["jump"], []
    assert isinstance(jump, Jump)
    state = gone(walker, walker.start(), pace * np.sqrt(size), 90)
    for _ in range(6):
        if ready(jump.physique, state):
            for made in leaps(jump, state, np.array([0.4, 0.8, 1.2]) * size):
                air = (made.times > made.take_off + 1e-9) & (made.times < made.touch_down - 1e-9)
                found.append(soles(jump, made, air).min() - float(state.floor))
        state = gone(walker, state, pace * np.sqrt(size), 8)
    assert len(found) > 6 and min(found) > -0.004 * size
