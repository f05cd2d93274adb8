"""Jumps by hand: aimed, refused, seen, followed."""

from concurrent.futures import Executor, Future
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from gambol.controllers.body import contact_points
from gambol.controllers.contract import Leap
from gambol.controllers.jump import SETS_FEET, Physique
from gambol.controllers.person import person
from gambol.controllers.navigation import gap
from gambol.game.app.views import previews, scenes
from gambol.game.explain.jump_preview import previewed
from gambol.game.explain.jump_sketches import CAN, CANNOT, aimed
from gambol.game.input.aimed import SLACK
from gambol.game.input.making import jumping
from gambol.game.input.wish import Wish
from gambol.game.input.within_reach import BEYOND
from gambol.game.scene.scene import Box, Overlays, Patch
from gambol.game.session.state import begin, opening
from gambol.game.session.tick import Timeline, advance, refused
from gambol.game.world.world import DT, Character, World


@pytest.fixture(scope="module")
def somebody():
    return person()


def hands(seconds):
    """Up, ahead, and at a run."""
    held, still = Wish(jump=True), Wish()
    ahead, run = Wish(jump=True, move=(0.0, 1.0)), Wish(move=(0.0, 1.0), run=1.0)
    plan = [(held, 20), (still, 150), (ahead, 40), (still, 150), (run, 90), (Wish(move=(0.0, 1.0), run=1.0, jump=True), 10), (run, 140)]
    return [wish.rounded() for wish, ticks in plan for _ in range(ticks)][:seconds * 60]


@pytest.mark.thorough
def test_hands_jump_and_the_same_hands_again_to_the_bit(somebody):
    ends, jumped = [], 0
    for _ in range(2):
        timeline, before = Timeline(opening(somebody)), None
        for wish in hands(10):
            timeline.advance((wish,))
            now = jumping(timeline.now.after.characters[0].state)
            jumped += now is not None and before is None
            before = now
        ends.append(timeline.now.after.characters[0].state)
    assert jumped == 6, "three jumps, twice"
    assert np.array_equal(ends[0].pose.rotations, ends[1].pose.rotations) and np.array_equal(ends[0].ground, ends[1].ground)
    assert ends[0].floor == 0.0 and np.isfinite(ends[0].pose.root).all()


@pytest.mark.few(1)
@pytest.mark.parametrize("ticks", [55, 69])
@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_who_taps_it_in_the_midst_of_a_turn_sets_his_feet_is_told_so_and_leaps(somebody, ticks, turn):
    """Whether he lets go of the key that turns him or not; nothing is given up meanwhile."""
    timeline, told = Timeline(opening(somebody)), []
    for wish in [Wish(turn=1.0)] * ticks + [Wish(turn=turn, jump=True)] * 2 + [Wish(turn=turn)] * 60:
        before = timeline.now
        timeline.advance((wish.rounded(),))
        state = timeline.now.after.characters[0].state
        assert not refused(before, timeline.now)
        if jumping(state) is not None:
            break
        told.append(state.refused)
    assert jumping(state) is not None and SETS_FEET in told


def test_who_holds_the_button_crouches_and_is_off_soon_after_letting_go(somebody):
    """In play; who taps it winds up as ever."""
    took, held = [], Wish(jump=True)
    for wishes in ([Wish(jump=True, move=(0.0, 1.0)).rounded()] * 25 + [held] * 50, [held] * 2):
        timeline = Timeline(opening(somebody))
        for wish in wishes + [Wish()] * 4:
            timeline.advance((wish,))
        made = jumping(timeline.now.after.characters[0].state).plan
        took.append(made.take_off)
    assert took[0] < 0.36 < 0.5 < took[1]


@pytest.fixture(scope="module")
def beyond(somebody):
    """Somebody who aims farther than it can jump, and what it sees of that."""
    timeline = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1))
    for wish in [Wish(jump=True)] * 10 + [Wish(jump=True, move=(0.0, 1.0))] * 110:
        timeline.advance((wish.rounded(),))
    return timeline, previews(timeline.now)[0]


def test_where_a_jump_is_refused_the_nearest_place_is_one_that_can_be_jumped_to(beyond, somebody):
    timeline, seen = beyond
    who, jump = timeline.now.after.characters[0], somebody.parts["jump"]
    state = who.controller.active(who.state)[1]
    assert seen.fault and seen.nearest is not None
    assert not previewed(jump, state, Leap(seen.nearest), ()).fault
    assert previewed(jump, state, Leap(seen.nearest + 0.3 * (seen.place - seen.nearest)), ()).fault
    far, near = (np.linalg.norm((place - seen.stand)[[0, 2]]) for place in (seen.place, seen.nearest))
    assert seen.why == f"{far - near:.1f} m farther than this body can jump"
    assert seen.told == "0.1 m farther than this body can jump: it lands in the green ring"
    rings = {sketch.tint for sketch in aimed(seen, ()) if isinstance(sketch, Patch)}
    assert rings == {CAN, CANNOT}


def test_the_nearest_place_is_not_sought_anew_while_one_aims_the_same_way(beyond, somebody, monkeypatch):
    timeline, seen = beyond
    sought = []
    monkeypatch.setattr(type(somebody.parts["jump"]), "nearest", lambda jump, start, place, *_: sought.append(place))
    again, = previews(timeline.now, (seen,))
    assert again.nearest is seen.nearest and not sought
    turned = replace(seen.found, nearest=seen.stand + [0.5, 0.0, 1.5], place=seen.stand + [0.6, 0.0, 1.8])
    previews(timeline.now, (replace(seen, found=turned),))
    assert len(sought) == 1
    previews(timeline.now, (replace(seen, found=replace(seen.found, heading=1.0)),))
    assert len(sought) == 2, "who is to land turned another way reaches other places"


def test_who_lets_go_is_told_why_not_without_coordinates(somebody):
    """Down from a low platform the ring may lie farther than is forgiven."""
    low = Box((0.0, 0.05, 0.0), (1.4, 0.1, 1.4))
    timeline, told = Timeline(begin(World((Character("A", somebody, somebody.start().at((0.0, 0.0, 0.0), 0.1)),), (low,)), 1)), []
    for wish in [Wish(jump=True)] * 10 + [Wish(jump=True, move=(0.0, 1.0))] * 120:
        timeline.advance((wish.rounded(),))
    moment, (seen,) = timeline.now, previews(timeline.now)
    for _ in range(60):
        after = advance(moment, (Wish(),))
        told += refused(moment, after)
        moment = after
    assert told == [f"no jump: {seen.why}"]


def test_a_runner_sees_how_he_would_lie_in_what_his_leap_would_touch(somebody):
    """A beam across the way, and none."""
    run, seen = Wish(move=(0.0, 1.0), run=1.0), {}
    for high in (1.3, 4.0):
        things = (Box((0.0, high + 0.2, 5.4), (4.0, 0.4, 0.2)),)
        timeline, touched, last = Timeline(begin(World((Character("A", somebody, somebody.start()),), things), 1)), [], None
        for k in range(150):
            state = timeline.now.after.characters[0].state
            timeline.advance((replace(run, jump=state.ground[1] > 3.2).rounded(),))
            if state.ground[1] > 3.3 and k % 8 == 0 and state.ground[1] < 5.0:
                last, = previews(timeline.now, (last,))
                touched.append(None if last is None else last.touch)
        seen[high] = [one for one in touched if one is not None]
    assert seen[1.3] and not seen[4.0]
    touch = seen[1.3][-1]
    assert "would hit" in touch.reason and abs(touch.place[2] - 5.4) < 0.3 and 1.0 < touch.place[1] < 1.9


def test_a_runner_sees_one_arc_through_all_of_a_stride(somebody):
    timeline, lengths = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1)), []
    run = Wish(move=(0.0, 1.0), run=1.0)
    for wish in [run] * 150 + [replace(run, jump=True)] * 50:
        timeline.advance((wish.rounded(),))
        if wish.jump:
            seen, = previews(timeline.now)
            assert not seen.fault
            lengths.append(float(np.linalg.norm((seen.arc[-1] - seen.arc[0])[[0, 2]])))
    assert min(lengths) > 0.5 * max(lengths)


def test_cameras_follow_a_jumper_without_a_jerk(somebody):
    timeline, eyes = Timeline(opening(somebody)), []
    for wish in hands(10):
        timeline.advance((wish,))
        eyes.append(timeline.now.players[0].camera.target[1])
    assert np.abs(np.diff(eyes)).max() < 0.03 and np.ptp(eyes) > 0.05
    assert np.ptp(eyes[-45:]) < 0.05


def test_pressed_in_the_air_it_aims_from_where_it_will_land_and_goes_off_again_from_the_landing(somebody):
    """The ring is drawn meanwhile, and the second jump lands in it."""
    timeline, plans, rings = Timeline(opening(somebody)), [], []
    for step in range(260):
        now = jumping(timeline.now.after.characters[0].state)
        if now is not None and (not plans or now.plan is not plans[-1]):
            plans.append(now.plan)
        flies = now is not None and len(plans) == 1 and now.plan.take_off + 0.05 < now.time < now.plan.touch_down - 0.05
        timeline.advance([Wish(jump=20 < step < 60 or flies, move=(0.0, 1.0) if 30 < step < 60 or flies else (0.0, 0.0))])
        seen = previews(timeline.now, ())[0] if flies else None
        rings += [] if seen is None else [seen.place]
    assert len(plans) == 2 and plans[1].take_off < 0.45
    middles = [plan.feet[:, [0, 2]].mean(0) for plan in plans]
    assert len(rings) > 10 and np.linalg.norm(rings[0][[0, 2]] - middles[0]) < 0.1
    assert np.linalg.norm(rings[-1][[0, 2]] - middles[1]) < 0.1 < np.linalg.norm(middles[1] - middles[0])


class Held(Executor):
    """Somebody who does nothing yet."""

    done = None

    def submit(self, fn, /, *args, **kwargs):
        assert self.done is None
        self.done = partial(fn, *args, **kwargs)
        return Future()


def test_where_something_would_be_touched_the_body_is_seen_as_it_would_lie_in_it(somebody):
    hurdle = Box((0.0, 0.35, 0.75), (2.0, 0.7, 0.2))
    timeline = Timeline(begin(World((Character("A", somebody, somebody.start()),), (hurdle,)), 1))
    for wish in [Wish(jump=True)] * 10 + [Wish(jump=True, move=(0.0, 1.0))] * 50 + [Wish(jump=True)] * 20:
        timeline.advance((wish.rounded(),))
    moment = timeline.now
    seen, = previews(moment)
    assert seen.touch is not None and seen.why.startswith(seen.touch.reason) and "would hit" in seen.why
    assert gap(seen.touch.place[None], hurdle)[0] < 0.12
    who, ghost = scenes(moment, 1.0, [moment.players[0].view(1.0)], Overlays(jump=True))[0].figures
    assert ghost.opacity < 1.0 and np.abs(ghost.positions[0] - seen.touch.root).max() < 1e-9
    assert len(scenes(moment, 1.0, [moment.players[0].view(1.0)], Overlays())[0].figures) == 1
    again, = previews(moment, (seen,))
    assert again.touch is seen.touch, "which is not planned again while nothing moves"
    held = Held()
    waiting, = previews(moment, (), held)
    assert waiting.touch is None and waiting.nearest is None and held.done is not None, "no picture waits for it"
    later, = previews(moment, (waiting,), held)
    assert later.seeking is waiting.seeking, "nor is it asked for twice"
    waiting.seeking.set_result(held.done())
    told, = previews(moment, (later,), held)
    assert told.why == seen.why and np.array_equal(told.touch.root, seen.touch.root)
    far = replace(moment, after=replace(moment.after, props=()))
    assert previews(far)[0].touch is None


@pytest.mark.few(1)
@pytest.mark.parametrize("move", [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0)])
@pytest.mark.parametrize("strafe", [False, True])
def test_who_holds_it_until_the_ring_stops_leaps_as_far_as_he_can(somebody, move, strafe):
    """Ahead, aside and back, and turned there first or not; a ring that stops lies no nearer than he can leap."""
    timeline, reach = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1)), somebody.parts["jump"].about
    push, told, made = Wish(jump=True, move=move, strafe=strafe), [], None
    for wish in [replace(push, move=(0.0, 0.0))] * 2 + [push] * 150 + [Wish(strafe=strafe)] * 130:
        before = timeline.now
        timeline.advance((wish.rounded(),))
        told += refused(before, timeline.now)
        made = made or jumping(timeline.now.after.characters[0].state)
        if made is not None:
            break
    assert made is not None and not told
    far = float(np.linalg.norm(made.plan.feet[:, [0, 2]].mean(0) - timeline.now.after.characters[0].state.pose.root[[0, 2]]))
    assert far > 0.85 * reach(np.arctan2(-move[0], move[1]) if strafe else 0.0)


@pytest.mark.few(1)
@pytest.mark.parametrize(("high", "away"), [(0.3, 0.6), (0.3, 1.0), (0.4, 0.8), (0.5, 0.6)])
@pytest.mark.parametrize("hold", [0.9, 1.4, 2.0])
def test_who_pushes_the_ring_far_onto_a_box_lands_on_it(somebody, high, away, hold):
    """However long it is pushed: on a box the ring stops where bodies come up to."""
    box = Box((0.0, high / 2, away + 1.5), (3.0, high, 3.0))
    timeline, told = Timeline(begin(World((Character("A", somebody, somebody.start()),), (box,)), 1)), []
    for wish in [Wish(jump=True, move=(0.0, 1.0))] * round(hold / DT) + [Wish()] * 130:
        before = timeline.now
        timeline.advance((wish.rounded(),))
        told += refused(before, timeline.now)
    assert not told and timeline.now.after.characters[0].state.floor == pytest.approx(high)


@pytest.mark.few(1)
@pytest.mark.parametrize("body", [{}, {"height": 1.2}, {"height": 2.1}, {"strength": 0.7}, {"strength": 2.0}])
def test_where_the_ring_stops_is_little_beyond_what_bodies_reach(somebody, body):
    who = person(physique=Physique(**body)) if body else somebody
    jump, state = who.parts["jump"], who.active(who.start())[1]
    for aside in (0.0, 1.6, 3.1):
        way = 9.0 * np.array([np.sin(aside), 0.0, np.cos(aside)])
        start, floor = jump.placed(state, Leap(way, heading=0.0))
        middle = jump.middle(start, floor)
        reaches = float(np.linalg.norm(jump.nearest(start, middle + way, floor) - middle))
        assert 0.0 < jump.about(aside) + BEYOND - reaches < SLACK[False]


@pytest.mark.few(1)
@pytest.mark.parametrize("hold", [1.2, 1.3])
def test_who_was_pushed_as_he_aimed_keeps_to_the_floor_until_he_leaps(somebody, hold):
    """He straightens up as he begins the leap: a slow wind-up went on upward, and carried him off by 11 cm for half a second."""
    timeline, highest = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1)), 0.0
    for n in range(round(4.2 / DT)):
        time = n * DT
        pushed = ("push",) if abs(time - 1.4) < 0.5 * DT else ()
        timeline.advance((Wish(jump=0.6 <= time < 1.4 + hold, pressed=pushed).rounded(),))
        state = timeline.now.after.characters[0].state
        points = contact_points(somebody.skeleton, *timeline.now.after.characters[0].joints)[..., 1]
        if np.asarray(state.contacts).any():
            highest = max(highest, float(points.min()))
    assert 0.0 < highest < 0.04
