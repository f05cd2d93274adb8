"""Sessions: what wishes make of a moment, without a window, a clock or a log."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, human
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import gap
from gambol.game.input import Wish
from gambol.game.session import tick
from gambol.game.session.actions import SLOWER
from gambol.game.session.settings import SETTINGS, SettingError
from gambol.game.session.state import newcomer, opening
from gambol.game.session.tick import KEPT, Timeline, advance
from gambol.game.world import COURSE, RATE, Recorded
from stand_in import Glide

AHEAD = Wish(move=(0.0, 1.0))


def pressing(*actions):
    return Wish(pressed=actions)


def played(*wishes, moment=None):
    """The timeline after a tick of each wish, for one player."""
    timeline = Timeline(moment or opening(Glide()))
    for wish in wishes:
        timeline.advance((wish,))
    return timeline


def ground(moment, who=0):
    return moment.after.characters[who].state.ground


def same(a, b):
    return all(np.array_equal(x.state.ground, y.state.ground) and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
               for x, y in zip(a.after.characters, b.after.characters, strict=True)) and all(
        np.array_equal(p.camera.view().eye, q.camera.view().eye) for p, q in zip(a.players, b.players, strict=True))


def test_a_wish_changes_the_very_next_step():
    start = opening(Glide())
    assert np.any(ground(advance(start, (AHEAD,))) != ground(start))


def test_advancing_leaves_the_moment_as_it_was():
    start = opening(Glide())
    here, eye = ground(start).copy(), start.players[0].camera.view().eye.copy()
    advance(start, (Wish(move=(1.0, 0.0), drag=(1.0, 0.0), pressed=("pause", "pace.walk=1")),))
    assert np.array_equal(ground(start), here) and np.array_equal(start.players[0].camera.view().eye, eye)
    assert start.number == 0 and not start.paused and start.setting("pace.walk") == 1.3


def test_every_player_needs_a_wish():
    with pytest.raises(ValueError, match="2 players.*got 1"):
        advance(opening(Glide(), 2), (Wish(),))


def test_pause_holds_the_world_but_not_the_camera_and_a_step_is_one_step():
    timeline = played(AHEAD, AHEAD, pressing("pause"))
    world = timeline.now.after
    for _ in range(20):
        timeline.advance((Wish(move=(0.0, 1.0), orbit=(1.0, 0.0)),))
    assert timeline.now.after is world and abs(timeline.now.players[0].camera.yaw) > 0.1
    timeline.advance((pressing("step"),))
    assert timeline.now.after.number == world.number + 1
    timeline.advance((pressing("pause"),))
    assert timeline.now.after.number == world.number + 2


@pytest.mark.few(1)
@pytest.mark.parametrize("slow", SLOWER)
def test_slow_motion_shows_the_same_way_later_and_evenly(slow):
    timeline = played(*[AHEAD] * 30)
    while timeline.now.slow != slow:
        timeline.advance((Wish(move=AHEAD.move, pressed=("slowmo",)),))
    number, shown = timeline.now.after.number, []
    for _ in range(20 * slow):
        timeline.advance((AHEAD,))
        shown += [timeline.now.figures(alpha)[0].positions[0, 2] for alpha in (0.0, 0.5)]
    assert timeline.now.after.number == number + 20
    moved = np.diff(shown)
    assert moved.min() > 0.8 * moved.mean() and moved.max() < 1.2 * moved.mean()


def test_reset_returns_to_the_opening_and_keeps_what_was_tuned():
    timeline = played(*[AHEAD] * 30, pressing("pace.walk=0.9", "camera.fov=1.1", "strafe_lock"), pressing("reset", "pause"))
    now = timeline.now
    assert np.array_equal(ground(now), [0, 0, 0]) and now.after.time == 0 and not now.players[0].pilot.locked
    assert now.setting("pace.walk") == 0.9 and now.setting("camera.fov") == 1.1
    timeline.advance((pressing("back=1"),))
    assert timeline.now.after.number == 31 + 1, "one can go back to before it"


def test_going_back_branches_from_there_and_forgets_the_rest():
    walked = played(*[AHEAD] * 50)
    branch = played(*[AHEAD] * 50)
    branch.advance((Wish(move=(1.0, 0.0), pressed=("back=20",)),))
    other = played(*[AHEAD] * 30, Wish(move=(1.0, 0.0)))
    assert same(branch.now, other.now) and len(branch.past) == len(other.past) == 31
    assert branch.now.number == 51 and branch.now.after.number == 31
    assert all(same(a, b) for a, b in zip(branch.past, walked.past))


def test_no_more_than_half_a_minute_is_kept_and_pauses_take_none_of_it(monkeypatch):
    assert KEPT == 30 * RATE
    monkeypatch.setattr(tick, "KEPT", few := 200)
    timeline = played(*[Wish()] * (few + 100))
    assert len(timeline.past) == few
    oldest = timeline.past[0]
    for wish in [pressing("pause")] + [Wish()] * 50:
        timeline.advance((wish,))
    assert len(timeline.past) == few and timeline.past[0] is oldest
    timeline.advance((pressing("back=999999"),))
    assert timeline.now.before is oldest.after


@pytest.mark.parametrize("action", ["back=", "back=0", "back=-3", "back=x", "back=1.5"])
def test_going_back_by_nothing_is_refused(action):
    with pytest.raises(SettingError, match="whole number"):
        played(AHEAD, pressing(action))


def test_two_players_walk_apart_each_before_an_own_camera():
    timeline = Timeline(opening(Glide(), 2))
    eyes = [p.camera.view().eye.copy() for p in timeline.now.players]
    for _ in range(150):
        timeline.advance((AHEAD, Wish(move=(0.0, -1.0), drag=(0.001, 0.0))))
    a, b = (ground(timeline.now, who) for who in (0, 1))
    assert a[1] > 0.8 and b[1] < -0.2
    moved = [np.linalg.norm(p.camera.view().eye - eye) for p, eye in zip(timeline.now.players, eyes)]
    assert min(moved) > 0.3
    tints = {c.tint for c in timeline.now.after.characters}
    assert len(tints) == 2


def test_a_second_player_joins_beside_the_first_and_a_third_does_not():
    timeline = played(*[Wish(move=(1.0, 1.0))] * 60, pressing("join"))
    a, b = (ground(timeline.now, who) for who in (0, 1))
    assert np.linalg.norm(a[:2] - b[:2]) == pytest.approx(1.2, abs=0.05)
    timeline.advance((pressing("join"), AHEAD))
    assert len(timeline.now.players) == len(timeline.now.after.characters) == 2
    timeline.advance((pressing("reset"), Wish()))
    assert len(timeline.now.players) == 2
    timeline.advance((pressing("back=2"), AHEAD))
    timeline.advance((pressing("back=30"), AHEAD))
    assert len(timeline.now.players) == 1, "back to when there was one"
    timeline.advance((Wish(),))


def test_a_flying_camera_takes_the_sticks():
    timeline = played(pressing("camera_mode"), pressing("camera_mode"))
    assert timeline.now.players[0].camera.flown
    here, eye = ground(timeline.now).copy(), timeline.now.players[0].camera.view().eye
    for _ in range(30):
        timeline.advance((AHEAD,))
    assert np.allclose(ground(timeline.now), here) and np.linalg.norm(timeline.now.players[0].camera.view().eye - eye) > 0.3


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


@pytest.mark.parametrize("setting", SETTINGS, ids=lambda s: s.name)
def test_every_setting_is_one_stays_in_its_bounds_and_is_only_the_players(setting, locomotion):
    start = opening(locomotion, 2)
    default = start.setting(setting.name)
    assert setting.low <= default <= setting.high
    for value, wanted in ((setting.low, setting.low), (setting.high + 1e6, setting.high), (-1e6, setting.low)):
        now = advance(start, (Wish(pressed=(f"{setting.name}={value}",)), Wish()))
        assert now.setting(setting.name) == wanted and now.setting(setting.name, 1) == default
        assert type(now.setting(setting.name)) is type(default)
        assert np.isfinite(now.after.characters[0].state.pose.rotations).all()


@pytest.mark.parametrize(("action", "says"), [
    ("speed=1", "there is no setting 'speed'; there are locomotion"), ("pace.walk=fast", "pace.walk=fast: needs a number from"),
    ("pace.walk=nan", "needs a number"), ("pace.walk=inf", "needs a number"), ("locomotion.library=1", "no setting")])
def test_a_setting_that_is_none_is_refused(action, says):
    with pytest.raises(SettingError, match=says):
        played(pressing(action))


def test_a_controller_without_settings_stays_as_it_is():
    timeline = played(pressing("locomotion.acceleration=3"))
    assert timeline.now.setting("locomotion.acceleration") is None


numbers = st.floats(-1e3, 1e3) | st.sampled_from([math.nan, math.inf, -math.inf])


@settings(max_examples=50)
@given(st.builds(Wish, move=st.tuples(numbers, numbers), look=st.tuples(numbers, numbers), turn=numbers, run=numbers,
                 slow=st.booleans(), orbit=st.tuples(numbers, numbers), drag=st.tuples(numbers, numbers), zoom=numbers,
                 pan=st.tuples(numbers, numbers)))
def test_rounding_a_wish_once_is_enough_and_leaves_no_nonsense(wish):
    once = wish.rounded()
    assert once.rounded() == once == Wish.of(once.numbers())
    assert all(math.isfinite(v) for v in (*once.move, *once.look, once.turn, once.run, *once.drag, once.zoom))


def test_rounding_is_finer_than_a_hand_can_feel():
    wish = Wish(move=(0.3, -0.77), run=0.5, drag=(0.0123, -1.0), zoom=0.25)
    rounded = wish.rounded()
    assert rounded.move == pytest.approx(wish.move, abs=0.004) and rounded.drag == pytest.approx(wish.drag, abs=2e-4)
    assert rounded.zoom == wish.zoom


def test_a_push_that_waits_is_forgotten_by_a_reset():
    line = played(pressing("pause"), pressing("push"), pressing("reset"))
    assert not line.now.players[0].pushed


@pytest.mark.parametrize("place, level", [((0.0, 0.0), 0.0), ((3.4, 11.4), 0.6), ((1.6, 5.0), 0.0)])
def test_who_joins_stands_on_whatever_is_beside_the_first(place, level):
    """Beside nothing, on a platform, and next to one: never within it."""
    first = newcomer(Glide(), 0, np.array([*place, np.pi / 2]), level, COURSE)
    late = newcomer(Glide(), 1, first.state.ground, level, COURSE)
    feet = np.array([late.state.ground[0], float(late.state.floor), late.state.ground[1]])
    assert min(gap(np.array([feet + [0.0, up, 0.0] for up in (0.3, 1.0, 1.7)]), thing).min() for thing in COURSE) > 0.2
    assert float(late.state.floor) <= level + 0.2 and np.linalg.norm(late.state.ground[:2] - place) > 1.0


def test_who_joins_somebody_that_a_clip_moves_walks():
    body = human()
    clip = Clip("still", body, 1 / 60, np.tile(body.offsets[0], (3, 1)), np.tile(Rotation.identity().as_quat(), (3, len(body), 1)))
    line = played(pressing("crowd=2", "join"), moment=opening(Recorded(clip, Glide())))
    assert [type(one.controller) for one in line.now.after.characters] == [Recorded, Glide, Glide, Glide]
