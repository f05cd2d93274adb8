"""Jumps at odd moments: as somebody brakes or turns back, before a box or an edge that holds him up, and given up for another way."""

import numpy as np
import pytest

from gambol.controllers.person import person
from gambol.game.app.views import previews, scenes
from gambol.game.input.wish import Wish
from gambol.game.scene.scene import Box, Overlays
from gambol.game.session.state import begin
from gambol.game.session.tick import Timeline, refused
from gambol.game.world.world import DT, Character, World

AHEAD, BACK, RIGHT, RUN = (0.0, 1.0), (0.0, -1.0), (1.0, 0.0), 1.0
BOX = Box((0.0, 0.15, 3.0), (4.0, 0.3, 2.0))


@pytest.fixture(scope="module")
def somebody():
    return person()


def played(somebody, things, start, *plan):
    """The moments of somebody who starts at x, z [m], heading [rad], on a floor [m], and does what is planned: seconds, and a wish seen from behind him."""
    line = Timeline(begin(World((Character("A", somebody, somebody.start(start[:3], start[3])),), things), 1))
    moments = []
    for seconds, wish in plan:
        for _ in range(round(seconds / DT)):
            line.advance((wish.rounded(),))
            moments.append(line.now)
    return moments


def states(moments):
    return [moment.after.characters[0].state for moment in moments]


def aloft(somebody, moments, since):
    """After how many seconds of some moments, from `since` [s] on, no foot stands in a leap."""
    later = states(moments)[round(since / DT):]
    return next((k * DT for k, state in enumerate(later) if state.active == "jump" and not np.any(state.contacts)), np.inf)


@pytest.mark.few(1)
@pytest.mark.parametrize("delay", [0.1, 0.25, 0.4, 0.65])
def test_who_lets_go_of_a_run_and_taps_leaps_on_off_the_next_foot(somebody, delay):
    """He neither stops first nor is told that it is too far for him, who brakes."""
    run = Wish(move=AHEAD, run=RUN)
    moments = played(somebody, (), (0.0, 0.0, 0.0, 0.0), (1.7, run), (delay, Wish()), (0.1, Wish(jump=True)), (1.5, Wish()))
    assert aloft(somebody, moments, 1.8 + delay) < 0.7


@pytest.mark.few(1)
@pytest.mark.parametrize("delay", [0.1, 0.3, 0.5])
def test_who_throws_the_stick_back_in_a_run_and_taps_leaps_and_then_turns_back(somebody, delay):
    run, back = Wish(move=AHEAD, run=RUN), Wish(move=BACK, run=RUN)
    moments = played(somebody, (), (0.0, 0.0, 0.0, 0.0), (1.7, run), (delay, back), (0.1, Wish(move=BACK, run=RUN, jump=True)), (4.0, back))
    assert aloft(somebody, moments, 1.8 + delay) < 0.7
    assert states(moments)[-1].ground[1] < max(state.ground[1] for state in states(moments)) - 1.0


def test_who_holds_the_button_in_a_run_and_lets_go_of_the_stick_stops(somebody):
    """He aims from where he comes to stand, and does not run on as long as the button is held."""
    moments = played(somebody, (), (0.0, 0.0, 0.0, 0.0), (1.7, Wish(move=AHEAD, run=RUN)), (2.5, Wish(jump=True)))
    last = states(moments)[-1]
    assert np.hypot(*last.velocity[[0, 2]]) < 0.1 and np.all(last.contacts) and aloft(somebody, moments, 0.0) == np.inf


@pytest.mark.few(1)
@pytest.mark.parametrize("late", [0.25, 0.05, 0.5])
def test_who_taps_twice_leaps_twice_though_he_still_winds_up_for_the_first(somebody, late):
    """A tap between the button's being let go and the first take-off, 0.66 s later, was lost."""
    tap = (0.1, Wish(jump=True))
    moments = played(somebody, (), (0.0, 0.0, 0.0, 0.0), (0.3, Wish()), tap, (late, Wish()), tap, (2.0 - late, Wish()))
    flies = np.array([state.active == "jump" and not np.any(state.contacts) for state in states(moments)])
    assert (np.diff(flies.astype(int)) == 1).sum() == 2


@pytest.mark.few(1)
@pytest.mark.parametrize("walks", [1.2, 1.6, 2.5])
def test_who_is_held_up_before_a_box_and_taps_leaps_onto_it(somebody, walks):
    go = Wish(move=AHEAD)
    moments = played(somebody, (BOX,), (0.0, 0.6, 0.0, 0.0), (walks, go), (0.1, Wish(move=AHEAD, jump=True)), (3.0, Wish()))
    assert states(moments)[-1].floor == pytest.approx(0.3)


def test_who_is_held_up_at_an_edge_and_taps_leaps_down(somebody):
    moments = played(somebody, (BOX,), (0.0, 2.4, 0.0, 0.3), (2.5, Wish(move=AHEAD)), (0.1, Wish(move=AHEAD, jump=True)), (2.0, Wish()))
    assert states(moments)[-1].floor == 0.0 and states(moments)[-1].ground[1] > 4.1


def test_who_lets_go_of_the_stick_before_a_box_and_taps_hops_where_he_stands(somebody):
    moments = played(somebody, (BOX,), (0.0, 0.6, 0.0, 0.0), (2.5, Wish(move=AHEAD)), (0.5, Wish()), (0.1, Wish(jump=True)), (2.0, Wish()))
    assert any(state.active == "jump" for state in states(moments)) and states(moments)[-1].floor == 0.0


def test_who_waits_to_leap_and_tilts_the_stick_elsewhere_goes_there_at_once(somebody):
    """Who stands too near to a box goes back first. Who holds the stick on, or tilts it the way of the ring, still leaps; and nobody who thought better of it is told why he can't leap."""
    start, tap = (0.0, 1.8, 0.0, 0.0), ((0.5, Wish()), (0.1, Wish(move=AHEAD, jump=True)))
    away = played(somebody, (BOX,), start, *tap, (0.1, Wish()), (0.9, Wish(move=RIGHT)))
    assert away[-55].players[0].aim.wants and not away[-45].players[0].aim.wants
    assert all(state.active == "locomotion" for state in states(away)[-40:]) and states(away)[-1].ground[0] < -0.3
    assert not any(refused(before, after) for before, after in zip(away, away[1:]))
    for held in ([(3.0, Wish(move=AHEAD))], [(0.1, Wish()), (2.9, Wish(move=AHEAD))]):
        assert max(state.floor for state in states(played(somebody, (BOX,), start, *tap, *held))) == pytest.approx(0.3)


@pytest.mark.few(1)
@pytest.mark.parametrize("plan, soon", [(((1.0, Wish()), (0.1, Wish(jump=True)), (0.8, Wish()), (1.5, Wish(move=AHEAD))), 0.75), (((1.0, Wish()), (1.0, Wish(move=AHEAD, jump=True)), (2.0, Wish(move=AHEAD))), 0.7)])
def test_who_holds_the_stick_as_he_lands_on_both_feet_walks_on_as_he_rises(somebody, plan, soon):
    """After a hop, and a leap as far as he can: he stood up first, and then set off."""
    moved = states(played(somebody, (), (0.0, 0.0, 0.0, 0.0), *plan))
    lands = max(k for k, state in enumerate(moved) if state.active == "jump" and not np.any(state.contacts)) + 1
    roots = np.array([state.pose.root for state in moved])
    speed = np.linalg.norm(roots[lands + 6:, [0, 2]] - roots[lands:-6, [0, 2]], axis=-1) / (6 * DT)
    walks = next(k for k in range(20, len(speed)) if speed[k] > 0.6) * DT
    assert walks < soon


@pytest.mark.few(1)
@pytest.mark.parametrize("run, high, then", [(1.0, 0.36, AHEAD), (0.5, 0.32, AHEAD), (1.0, 0.58, BACK)])
def test_nobody_is_told_that_he_cannot_leap_before_he_is_refused(somebody, run, high, then):
    """Who let go of the key waits for his feet, and was told in turn that it is too far, too near, and what he would hit, until he leapt. Who aims on the move was told of each moment's pace."""
    thing = Box((0.0, 0.5 * high, 4.5), (3.0, high, 1.0))
    go, tap, later = Wish(move=AHEAD, run=run), Wish(move=then, run=run, jump=True), Wish(move=then, run=run)
    told, aimed, given_up = [], (), []
    moments = played(somebody, (thing,), (0.0, 0.0, 0.0, 0.0), (1.5, go), (0.15, tap), (1.5, later))
    for before, moment in zip(moments, moments[1:]):
        aimed = previews(moment, aimed)
        if moment.players[0].aim.wants:
            text = scenes(moment, 1.0, [moment.players[0].view(1.0)], Overlays(), aimed=aimed)[0].text
            told += [(moment.players[0].aim.aiming, " ".join(text))] if text else []
        given_up += refused(before, moment, aimed)
    assert len(given_up) <= 1
    assert not any("no jump" in text for aiming, text in told if not aiming)
    assert not any("too far for this" in text or "too near for this" in text for _, text in told)
