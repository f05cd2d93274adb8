"""Who leaps off one foot out of a walk or a run leaves hardly faster along the floor than he came: he flies longer instead."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump.starting import ready

FPS = 60
MOST = 0.3
"""[m/s]; of recorded ones two brake by 0.4, two gain 0.0 and 0.2."""


@pytest.fixture(scope="module", params=[1.4, 2.2, 2.6, 3.2])
def footfalls(request, person):
    """The states in which somebody who goes so fast [m/s] could leap off either foot."""
    jump, wish, state, found = person.parts["jump"], Intent(np.array([request.param, 0.0, 0.0])), person.start(), {}
    for n in range(260):
        state, _ = person.step(state, wish, 1 / FPS)
        own = person.active(state)[1]
        start = jump.start_of(own)
        if n > 150 and start.single is not None and ready(jump.physique, own):
            found.setdefault(start.single, own)
    return list(found.values())


def leaps(jump, state, airtime=None):
    """The gain [m/s] of leaps to places farther and farther ahead, as far as the leg can push him, and the words of the first that is refused for being too far."""
    start, gains = jump.start_of(state), []
    pace = start.velocity * [1.0, 0.0, 1.0]
    speed = float(np.linalg.norm(pace))
    for far in speed * np.arange(0.5, 2.0, 0.06):
        try:
            made = jump.plan(state, Intent(leap=Leap(start.centre * [1.0, 0.0, 1.0] + far / speed * pace, airtime)))
        except Unable as why:
            if "too near" not in str(why):
                return gains, str(why)
            continue
        gains.append(float(np.linalg.norm(made.path.velocity[[0, 2]])) - speed)
    return gains, ""


def test_nobody_gains_more_speed_than_one_leg_adds(jump, footfalls):
    for state in footfalls:
        gains, why = leaps(jump, state)
        assert len(gains) > 3 and max(gains) < MOST
        assert why.startswith(("no leg pushes off so hard", "too far for this run")) and "the nearest that it reaches is" in why


def test_a_flight_that_is_told_and_too_short_is_refused(jump, footfalls):
    for state in footfalls:
        gains, why = leaps(jump, state, 0.32)
        assert max(gains, default=0.0) < MOST and ("too short for this body there; the jump takes" in why or "one leg adds 0.30 m/s at most" in why)
