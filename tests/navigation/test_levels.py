"""Ground on several levels: kerbs, stairs and ramps are walked, edges are kept, gaps are leapt, and what can't be is said."""

import numpy as np
import pytest

from gambol.controllers.contract import Goal, Intent, Leap
from gambol.controllers.navigation import floor_at
from gambol.controllers.navigation.levels import journey, journeys, levels_of, named, next_leg
from gambol.controllers.navigation.levels.run_up import start_of
from gambol.controllers.navigation.planning import plan
from gambol.controllers.navigation.routes import distance, shapes_of
from gambol.controllers.person import person
from gambol.game.scene import Box, Pillar
from gambol.game.world import STAGES

STEPS = tuple(Box((0.0, 0.085 * (k + 1), 2.0 + 0.5 * (0.3 * k + 1.5)), (1.6, 0.17 * (k + 1), 1.5 - 0.3 * k)) for k in range(5))
LANDING, WING = Box((0.0, 0.425, 4.5), (3.0, 0.85, 2.0)), Box((2.5, 0.425, 5.0), (2.0, 0.85, 1.0))
RAMP = Box((-3.5, -0.05, 4.5), (1.4, 0.95, 4.0), np.pi / 2, slope=0.85 / 4.0)
HOUSE = (*STEPS, LANDING, WING, RAMP)
FAR = (Box((0.0, 0.3, 0.0), (2.0, 0.6, 2.0)), Box((0.0, 0.3, 3.0), (2.0, 0.6, 2.0)))


@pytest.fixture(scope="module")
def someone():
    return person()


def region(levels, x, z, floor):
    return levels.regions[levels.under(np.array([x, z]), floor)]


def crossed(things, here, goal, able, floor=0.0, barred=()):
    levels = levels_of(things)
    start = levels.under(np.array(here), floor)
    return journey(levels, np.array(here), start, np.array(goal), levels.meant(np.array(goal), levels.regions[start]), able, barred)


def test_what_one_steps_over_is_one_region():
    assert len(set(levels_of(HOUSE).regions)) == 1, "stairs and a ramp join floor and landing"
    kerb, table = Box((0.0, 0.075, 0.0), (2.0, 0.15, 2.0)), Box((5.0, 0.4, 0.0), (2.0, 0.8, 2.0))
    assert list(levels_of((kerb, table)).regions == levels_of((kerb, table)).regions[2]) == [True, False, True]
    steep = Box((0.0, 0.4, 0.0), (2.0, 0.8, 2.0)), Box((0.0, 0.25, 1.5), (2.0, 0.5, 1.0))
    assert len(set(levels_of(steep).regions)) == 3, "steps of 0.5 and 0.3 m are too high"
    walled = Box((0.0, 0.075, 0.0), (2.0, 0.15, 2.0)), *(Box((x, 1.0, z), (w, 2.0, d)) for x, z, w, d in (
        (1.05, 0.0, 0.1, 2.2), (-1.05, 0.0, 0.1, 2.2), (0.0, 1.05, 2.2, 0.1), (0.0, -1.05, 2.2, 0.1)))
    assert levels_of(walled).regions[0] != levels_of(walled).regions[-1], "walls part what a step would join"


def test_rails_stand_where_the_ground_ends_and_nowhere_else():
    levels, out = levels_of(HOUSE), np.empty(3)
    shapes = shapes_of(levels.stops(levels.regions[-1]), 0.0)

    def near(x, z):
        return min(distance(x, z, shape, out) for shape in shapes)
    for x, z in ((1.5, 4.0), (0.0, 5.5), (3.5, 5.0), (-2.0, 3.8), (0.8, 3.0), (2.5, 4.5)):  # sides of landing, wing, ramp and stairs
        assert near(x, z) < 0.06, (x, z)
    for x, z in ((0.0, 2.0), (0.0, 2.9), (0.0, 3.5), (-1.5, 4.5), (1.5, 5.0), (-5.5, 4.5)):  # where one goes over
        assert near(x, z) > 0.4, (x, z)


def test_what_stands_on_a_landing_stops_there_and_what_hangs_high_nobody():
    post, lamp = Pillar((0.0, 0.85, 4.5), 0.2, 2.0), Box((0.0, 3.0, 4.0), (0.3, 0.2, 0.3))
    levels = levels_of((*HOUSE, post, lamp))
    stops = levels.stops(levels.regions[-1])
    assert sum(hasattr(one, "radius") for one in stops) == 1 and len(stops) == len(levels_of(HOUSE).stops(levels_of(HOUSE).regions[-1])) + 1


def test_the_quickest_leaps_that_can_be_made_lead_to_a_goal():
    asked = []

    def able(leap):
        asked.append(leap)
        return "too high" if leap.asks[1] > 0.4 else ""
    way = crossed(STAGES["course"], (3.4, 1.2), (3.4, 7.2), able)
    assert [round(leap.place[1], 2) for leap in way.crossings] == [0.3, 0.6] and not way.reason
    assert len(asked) <= 6, "of those alike that can't be made one is asked about"
    for leap in way.crossings:
        assert floor_at(*leap.ground[:2], STAGES["course"]) == pytest.approx(leap.height)
        assert floor_at(*leap.place[[0, 2]], STAGES["course"]) == pytest.approx(leap.place[1])
        assert np.allclose((leap.place[[0, 2]] - leap.ground[:2]) @ [np.cos(leap.ground[2]), -np.sin(leap.ground[2])], 0.0, atol=1e-9), "he looks there"
    other = crossed(STAGES["course"], (3.4, 1.2), (3.4, 7.2), able, barred=[named(way.crossings[0])])
    assert other.crossings and named(other.crossings[0]) != named(way.crossings[0])


@pytest.mark.parametrize("height", [0.6, 0.8, 1.0])
def test_nobody_goes_down_into_a_gap_that_he_can_leap_over(height):
    """Beyond the gap a ramp leads down, and the goal lies behind it, on the floor."""
    near, far = (Box((0.0, 0.5 * height, z), (2.4, height, 2.0)) for z in (0.0, 3.0))
    down = Box((0.0, -0.05, 3.0 + 1.0 + 2.5), (1.4, height + 0.1, 5.0), 0.0, slope=-height / 5.0)
    leaps = crossed((near, far, down), (0.3, 0.3), (0.0, 10.0), lambda _: "", height).crossings
    assert [leap.place[1] for leap in leaps] == pytest.approx([height])


def test_walks_between_leaps_count_as_they_lead(someone):
    """A long wall begins beside a platform: down from it on that side of the wall on which the goal is, though the other is nearer."""
    things = (Box((0.4, 0.2, 0.0), (5.4, 0.4, 2.0)), Box((2.0, 1.0, 5.0), (0.2, 2.0, 7.6)))
    begins, goal = (2.6, 0.0), (1.4, 3.0)
    straight = crossed(things, begins, goal, lambda leap: "", 0.4)
    led = next_leg(someone, someone.start((*begins, 0.0), 0.4), Goal(goal), things)
    assert straight.crossings[0].place[0] > 2.1 and led.crossings[0].place[0] < 1.9


def test_why_no_leaps_lead_there_is_said():
    assert "no leap: too far" in crossed(FAR, (0.0, 0.0), (0.0, 3.0), lambda leap: "too far", 0.6).reason
    nobody = crossed(FAR, (0.0, 0.0), (0.0, 3.0), lambda leap: None, 0.6)
    assert not nobody.crossings and not nobody.reason
    assert not crossed(FAR, (0.0, 0.0), (0.5, 0.5), lambda leap: "", 0.6).crossings, "a walk leads there"


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (0.0, 2.6, 0.4)])
def test_goals_may_lie_near_an_edge_and_where_nobody_can_stand_is_said_first(someone, start):
    """0.12 m from where the ground ends there is no wall. Beyond that nobody sets out, or leaps up to find out that he can't."""
    x, z, floor = start
    table, here = Box((0.0, 0.2, 3.0), (2.0, 0.4, 2.0)), someone.start((x, z, 0.0), floor)
    near, beyond = (next_leg(someone, here, Goal((0.0, where)), (table,)) for where in (2.15, 2.06))
    assert not near.reason and bool(near.crossings) == (floor == 0.0)
    made = [plan((0.0, 2.6, 0.0), (*leg.place, 0.0), around=levels_of((table,)).stops(region(levels_of((table,)), 0.0, 2.5, 0.4)), floor=0.4).reason
            for leg in (near._replace(place=np.array([0.0, 2.15])), beyond)]
    assert made == ["", "the goal is 0.06 m from an edge, 0.12 m are needed"]
    assert not beyond.crossings and (floor or beyond.reason == made[1])


def going(someone, things, start, floor, goal, seconds=25.0):
    state, states = someone.start(start, floor), []
    for _ in range(round(60 * seconds)):
        state, _ = someone.step(state, Intent(goal=goal, around=things), 1 / 60)
        states.append(state)
        if someone.status(state).kind != "running":
            break
    return states


def test_he_walks_up_stairs_keeps_to_an_l_and_down_a_ramp(someone):
    goal = Goal((3.1, 5.0))
    up = going(someone, HOUSE, (0.0, 0.5, 0.0), 0.0, goal)
    assert someone.status(up[-1]).kind == "done" and float(up[-1].floor) == pytest.approx(0.85) and np.hypot(*(up[-1].ground[:2] - goal.floor)) < 0.03
    down = going(someone, HOUSE, (*up[-1].ground[:2], 0.0), 0.85, Goal((-6.2, 4.5)))
    assert someone.status(down[-1]).kind == "done" and float(down[-1].floor) == pytest.approx(0.0, abs=0.01)
    floors = [floor_at(*state.ground[:2], HOUSE) for state in up + down]
    assert np.abs(np.diff(floors)).max() < 0.21, "never over an edge"
    assert all(state.active == "locomotion" for state in up + down)


def test_he_leaps_over_a_gap_and_walks_on(someone):
    states = going(someone, FAR, (0.3, -0.6, 2.0), 0.6, Goal((0.5, 3.6), 0.0))
    last = states[-1]
    assert someone.status(last).kind == "done" and np.hypot(*(last.ground[:2] - [0.5, 3.6])) < 0.03 and float(last.floor) == pytest.approx(0.6)
    assert {state.active for state in states} == {"locomotion", "jump"} and min(float(state.floor) for state in states) == pytest.approx(0.6)
    assert any(state.going.crossings for state in states) and not last.going.crossings
    assert len(last.going.barred) <= 5, "at the end of his reach, those that turn out impossible from where he stands are replaced"


LONG = (Box((0.0, 0.3, 0.0), (2.0, 0.6, 5.0)), Box((0.0, 0.3, 5.9), (2.0, 0.6, 5.0)))


def test_he_leaps_from_a_walk_and_walks_on(someone):
    states = going(someone, LONG, (0.0, -2.0, 0.0), 0.6, Goal((0.2, 7.0), 0.0))
    active = [state.active for state in states]
    off, on = active.index("jump"), len(active) - active[::-1].index("jump")
    assert states[off - 1].velocity[0] > 1.2 and states[on].velocity[0] > 1.2, "neither before nor after does he stop"
    assert someone.status(states[-1]).kind == "done" and np.hypot(*(states[-1].ground[:2] - [0.2, 7.0])) < 0.03
    assert min(float(state.floor) for state in states) == pytest.approx(0.6) and not states[-1].going.stands
    assert np.abs([state.ground[0] for state in states]).max() < 0.3, "the leap on the way is taken, not another as short"


WIDE = (LONG[0], Box((0.0, 0.3, 6.39), (2.0, 0.6, 5.0)))


def test_a_walk_leads_over_gaps_that_are_too_wide_from_a_stand(someone):
    leap = Intent(leap=Leap(np.array([0.0, 0.6, 4.11])), around=WIDE)
    assert "too far" in someone.refusal(someone.start((0.0, 2.14, 0.0), 0.6), leap)
    states = going(someone, WIDE, (0.0, -2.0, 0.0), 0.6, Goal((0.0, 7.0)))
    assert someone.status(states[-1]).kind == "done" and min(float(state.floor) for state in states) == pytest.approx(0.6)


@pytest.fixture(scope="module")
def went_back(someone):
    """The states of one who stands too near to a wide gap."""
    return going(someone, WIDE, (0.0, 1.9, 0.0), 0.6, Goal((0.0, 7.0)))


def test_who_stands_too_near_for_his_run_up_steps_back_for_it(someone, went_back):
    states = went_back
    off = [state.active for state in states].index("jump")
    assert someone.status(states[-1]).kind == "done" and min(float(state.floor) for state in states) == pytest.approx(0.6)
    assert any(state.going.back for state in states) and min(state.ground[1] for state in states) < 0.4
    assert states[off - 1].velocity[0] > 1.2 and not states[-1].going.barred, "then he leaps from a walk, at once"


@pytest.mark.few(1)
@pytest.mark.parametrize("far, begins", [*((far, begins) for far in (1.2, 1.82, 2.1) for begins in (-1.2, 0.6, 1.17, 1.8)), (1.5, 0.6), (1.95, 1.8)])
def test_whoever_is_sent_across_leaps_at_the_first_or_second_run_up(someone, far, begins):
    """Where he begins decides which of his steps ends at the edge; 1.17: so far before it as the room on a platform of 2 m lets him."""
    gap = far - journeys.INSET - journeys.LANDING
    things = (LONG[0], Box((0.0, 0.3, 5.0 + gap), (2.0, 0.6, 5.0)))
    states = going(someone, things, (0.0, begins - 0.36, 0.0), 0.6, Goal((0.0, 5.5 + gap)))
    assert someone.status(states[-1]).kind == "done" and min(float(state.floor) for state in states) == pytest.approx(0.6)
    runs = [state.going.pace > 0.0 for state in states]
    assert sum(now and not was for was, now in zip([False, *runs], runs)) <= 2 and len(states) < 15 * 60


def test_leaps_alike_are_not_all_asked_about():
    """What is refused in the same words for two leaps side by side, as far and as high, and for six anywhere, is refused for all: who is asked for each
    stands and thinks for seconds."""
    asked = []

    def able(leap):
        asked.append(leap.asks)
        return "its legs would hit something 0.3 m ahead" if leap.asks[1] > 0.5 else ""
    way = crossed(STAGES["course"], (3.4, 1.6), (5.9, 12.4), able)
    assert way.crossings and not way.reason and sum(up > 0.5 for _, up in asked) <= 2 * 6


def test_leaps_go_off_from_the_side_that_one_stands_at():
    """Whoever stands amid a platform was thought to land as far from its middle."""
    asked = []
    way = crossed(FAR, (0.2, 0.0), (0.4, 3.2), lambda leap: asked.append(leap) or "", floor=0.6)
    leap, = way.crossings
    assert leap.ground[1] == pytest.approx(1.0 - journeys.INSET) and leap.place[2] == pytest.approx(2.0 + journeys.LANDING)


def test_leaps_keep_clear_of_what_nobody_stands_beside():
    """A pillar at the edge: its place is left to leaps beside it, which a walk can lead to."""
    things = (*FAR, Pillar((0.0, 0.6, 0.9), 0.15, 1.8), Pillar((0.6, 0.6, 2.2), 0.15, 1.8))
    for leap, *_ in journeys.crossings(levels_of(things), np.array([[0.0, 0.0], [0.0, 3.0]])):
        for place, height in ((leap.ground[:2], leap.height), (leap.place[[0, 2]], leap.place[1])):
            for pillar in things[2:]:
                assert height < 0.1 or np.hypot(*(place - np.array(pillar.foot)[[0, 2]])) >= 0.30 + pillar.radius


def test_run_ups_begin_on_the_level_from_which_the_leap_goes_off(someone):
    """A platform of 1.3 m with the floor joined to it by stairs: nobody runs up from beside or below it."""
    stairs = tuple(Box((0.0, 0.075 * (k + 1), -0.3 + 0.3 * k), (1.6, 0.15 * (k + 1), 0.3)) for k in range(3))
    for deep, room in ((1.3, False), (3.4, True)):
        things = (*stairs, Box((0.0, 0.3, 0.45 + 0.5 * deep), (1.6, 0.6, deep)))
        for x, heading in ((0.0, 0.0), (0.44, np.pi / 2)):
            edge = (x, 0.45 + deep - 0.36) if heading == 0.0 else (x, 1.5)
            ahead = np.array([np.sin(heading), np.cos(heading)])
            leap = journeys.Crossing(np.array([*edge, heading]), np.array([edge[0] + 1.8 * ahead[0], 0.6, edge[1] + 1.8 * ahead[1]]), 0.6)
            begins = start_of(someone, leap, things)
            assert (begins is not None) == (room and heading == 0.0)


@pytest.mark.few(1)
@pytest.mark.parametrize("up", [0.2, 0.4])
def test_run_ups_lead_onto_what_is_higher(someone, up):
    """Too far from a stand, and on."""
    things = (LONG[0], Box((0.0, 0.3 + 0.5 * up, 6.2), (2.0, 0.6 + up, 5.0)))
    leap = Intent(leap=Leap(np.array([0.0, 0.6 + up, 3.92])), around=things)
    assert "too far" in someone.refusal(someone.start((0.0, 2.14, 0.0), 0.6), leap)
    states = going(someone, things, (0.0, -2.0, 0.0), 0.6, Goal((0.0, 7.0)))
    assert someone.status(states[-1]).kind == "done" and float(states[-1].floor) == pytest.approx(0.6 + up)
    assert min(float(state.floor) for state in states) == pytest.approx(0.6)


def test_who_went_back_for_a_run_up_makes_that_leap(went_back):
    """Another way that had become as short was begun, and the first one again from there, without an end."""
    leaps = [named(state.going.crossings[0]) for state in went_back if state.going is not None and state.going.crossings]
    assert len(set(leaps)) == 1


@pytest.mark.few(1)
@pytest.mark.parametrize("wide", [0.01, 0.06, 0.12, 0.25])
def test_crevices_are_stepped_over(someone, wide):
    things = (LONG[0], Box((0.0, 0.3, 5.0 + wide), (2.0, 0.6, 5.0)))
    assert len(set(levels_of(things).regions[:2])) == 1 and levels_of(things).regions[-1] != levels_of(things).regions[0]
    states = going(someone, things, (0.0, 0.5, 0.0), 0.6, Goal((0.3, 4.4)))
    assert someone.status(states[-1]).kind == "done" and {state.active for state in states} == {"locomotion"}
    assert {float(state.floor) for state in states} == {0.6}
    heights = levels_of(things).floors(np.column_stack([np.zeros(40), np.linspace(2.0, 3.0, 40)]), 0.6)
    assert np.allclose(heights, 0.6), "the way that is drawn leads across"


def test_what_is_wider_than_a_crevice_parts_levels():
    regions = levels_of((LONG[0], Box((0.0, 0.3, 5.4), (2.0, 0.6, 5.0)))).regions
    assert len(set(regions)) == 3
    down = levels_of((LONG[0], Box((0.0, 0.05, 5.4), (2.0, 0.1, 5.0)))).floors(np.column_stack([np.zeros(5), np.linspace(2.3, 3.5, 5)]), 0.6)
    assert down[-1] == pytest.approx(0.1), "and who comes down stays there"


def test_without_room_to_step_back_a_gap_is_too_wide(someone):
    short = (Box((0.0, 0.3, 1.75), (2.0, 0.6, 1.5)), WIDE[1])
    status = someone.status(going(someone, short, (0.0, 1.9, 0.0), 0.6, Goal((0.0, 7.0)), 3.0)[-1])
    assert status.kind == "failed" and "no leap" in status.reason


def test_a_step_that_is_hindered_becomes_a_leap_from_a_stand(someone):
    """He is held back as he was to leap."""
    state = someone.start((0.0, -2.0, 0.0), 0.6)
    for _ in range(60 * 20):
        aside = np.array([-1.2, 0.0, 0.0]) if state.going is not None and state.going.off is not None and not state.going.stands else None
        state, _ = someone.step(state, Intent(goal=Goal((0.0, 7.0)), around=LONG, aside=aside), 1 / 60)
        if someone.status(state).kind != "running":
            break
    assert someone.status(state).kind == "done" and float(state.floor) == pytest.approx(0.6)


def test_without_room_to_stop_nobody_leaps_from_a_walk(someone):
    short = (LONG[0], Box((0.0, 0.3, 4.1), (2.0, 0.6, 1.4)))
    states = going(someone, short, (0.0, -2.0, 0.0), 0.6, Goal((0.0, 4.2)))
    assert someone.status(states[-1]).kind == "done" and any(state.going.crossings for state in states) and not any(state.going.pace for state in states)


def test_who_can_not_leap_there_says_so_and_stays(someone):
    wide = (FAR[0], Box((0.0, 0.3, 5.0), (2.0, 0.6, 2.0)), Box((0.0, 1.5, 5.0), (2.0, 3.0, 2.0)))
    states = going(someone, wide, (0.0, 0.0, 0.0), 0.6, Goal((0.0, 5.0)), 1.0)
    status = someone.status(states[-1])
    assert status.kind == "failed" and status.reason and np.hypot(*states[-1].ground[:2]) < 0.05
