"""A body that follows points: taken over and handed back without a pop, whatever is lost, as a pure function."""

import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from followed import DT, bodies, build, clip, follower, known, person, played, points, pulls  # noqa: F401, fixtures among them
from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.human import STATURE
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction.control_points import SETS, parse
from gambol.controllers.reconstruction.controller import LOST, Reconstruction
from gambol.controllers.reconstruction.evaluation.metrics import position_error
from gambol.controllers.reconstruction.follower import Following
from gambol.controllers.reconstruction.following.approach import towards
from gambol.controllers.reconstruction.following.feet import GIVE
from gambol.controllers.reconstruction.pose_vector import SKELETON
from gambol.controllers.supervisor import Duty
from gambol.game.world.followers import Follows, carried


@pytest.mark.few(1)
@pytest.mark.parametrize("points", [*SETS, "lwrist,rwrist,Head+0/0.09/0.09"])
def test_a_clip_that_is_in_the_database_is_followed(known, clip, points):
    controller = build(known, points)
    seen = controller.controls.extract(clip)
    states = played(controller, controller.begin(seen[0], (seen[1] - seen[0]) / DT), seen[1:])
    away = position_error(bodies(SKELETON, states), clip.kinematics()[0][1:])
    assert away.mean() < (0.02 if len(controller.controls) > 2 else 0.065)
    assert np.median([np.abs(controller.follower.points(s.pose) - p).max() for s, p in zip(states, seen[1:])]) < 0.01


def test_it_takes_over_from_a_walker_and_gives_back_without_a_pop(follower, clip, points):
    someone = person(follower)
    truth = pulls(clip.kinematics()[0]).max()
    states = played(someone, someone.start(), [None] * 30 + list(points[40:]) + [None] * 90)
    duty = [state.memory.active for state in states]
    assert duty == ["locomotion"] * 30 + ["reconstruction"] * len(points[40:]) + ["locomotion"] * 90
    felt = pulls(bodies(SKELETON, states))
    assert felt.max() < 2.9 * truth  # as his first step out of the recorded walk ends: of twelve ends of it no other feels more than 1.2
    positions = bodies(SKELETON, states)
    assert position_error(positions[90:-90], clip.kinematics()[0][100:]).mean() < 0.02
    last = np.linalg.norm(positions[-1] - positions[-2], axis=-1) / DT
    assert last.max() < 0.1 and np.median(last) < 0.05  # it stands, its trunk straightening


def test_it_takes_hold_of_points_of_quite_another_pose(follower, clip, points):
    """Half a metre beside the body and facing elsewhere: begun anew from the points, and the body gets there smoothly."""
    someone = person(follower)
    start = someone.start((0.5, -0.3, 1.2))
    states = played(someone, start, points)
    positions = bodies(SKELETON, [start, *states])
    assert states[0].memory.active == "reconstruction"
    assert pulls(positions).max() < 250
    assert position_error(positions[61:], clip.kinematics()[0][60:]).mean() < 0.02


def test_a_jump_in_the_air_is_not_interrupted(follower, points):
    someone = person(follower)
    state, duty = someone.start(), []
    for _ in range(200):
        wish = Leap(np.array([0.0, 0.0, 0.4])) if not duty else None
        state, _ = someone.step(state, Intent(leap=wish, points=None if not duty else points[0]), DT)
        duty.append(state.memory.active)
    assert duty[0] == "jump" and duty[-1] == "reconstruction" and duty == sorted(duty)


def test_without_recorded_poses_it_begins_only_from_a_body(follower, points):
    poor = Reconstruction(follower.method, follower.controls)
    with pytest.raises(Unable, match="no poses to begin from"):
        poor.begin(points[0])
    with pytest.raises(Unable, match="Reconstruction starts nobody"):
        poor.start()
    assert isinstance(poor.enter(Locomotion.load().start(), Intent(points=points[0])).memory, Following)


@pytest.mark.parametrize(("wrong", "why"), [
    (lambda p: p[:3], "4 are followed, lwrist, rwrist, lankle, rankle"),
    (lambda p: p + [4.0, 0.0, 0.0], "m away from the body"),
    (lambda p: p + np.array([[-1.3], [1.3], [0], [0]]) * [1.0, 0.0, 0.0] * 1.3, "m apart"),
    (lambda p: np.full_like(p, np.nan), "no point is seen")])
def test_points_of_no_such_body_are_refused_with_a_reason(follower, points, wrong, why):
    state = Locomotion.load().start()
    here = wrong(points[0])
    with pytest.raises(Unable, match=why):
        follower.enter(state, Intent(points=here))
    someone = person(follower)
    after, pose = someone.step(someone.start(), Intent(points=here), DT)
    assert after.memory.active == "locomotion" and np.isfinite(pose.rotations).all()


def test_another_number_of_points_ends_it_and_the_body_goes_on(follower, points):
    """As if nobody wanted any; and it is said why. Who steps it nevertheless gets a body, and is told."""
    someone = person(follower)
    other, none = (played(someone, someone.start(), list(points[40:80]) + [which] * 20) for which in (points[80][:3], None))
    assert [state.memory.active for state in other] == ["reconstruction"] * 40 + ["locomotion"] * 20
    assert "4 are followed" in other[-1].memory.refused
    assert np.array_equal(bodies(SKELETON, other), bodies(SKELETON, none))
    after, pose = follower.step(follower.begin(points[0]), Intent(points=points[1][:3]), DT)
    assert follower.status(after).kind == "failed" and "4 are followed" in follower.status(after).reason
    assert np.isfinite(pose.rotations).all()


@pytest.mark.few(1)
@pytest.mark.parametrize("step", [1, 2])
def test_trackers_that_exchange_their_points_change_nothing(follower, points, step):
    some = points[::step]
    torn = some.copy()
    torn[40:90, [0, 1]] = some[40:90, [1, 0]]
    one, other = (played(follower, follower.begin(some[0]), which[1:], step * DT) for which in (some, torn))
    assert np.array_equal(bodies(SKELETON, one), bodies(SKELETON, other))


def test_a_lost_foot_stays_above_the_floor(follower, points):
    """With both ankles lost and the hands low the body crouches, or sinks: its feet stay on the floor."""
    low = points[60:].copy()
    low[10:, 2:] = np.nan
    low[:, :2, 1] -= np.minimum(np.arange(len(low)) / 60.0, 0.5)[:, None]
    states = played(follower, follower.begin(points[60]), low[1:90])
    feet = bodies(SKELETON, states)[:, [SKELETON.index(side + "Toe") for side in ("Left", "Right")], 1]
    assert feet.min() > -GIVE


@given(st.data())
@settings(max_examples=8)
def test_no_pattern_of_loss_breaks_the_body(follower, points, data):
    """No NaN, no joint a metre away in the next frame, not far from where the points were, and with them after they are back.

    How hard limbs swing while a metre and more is made up is no law: in one pattern of two hundred at random, a joint
    reached 29 m/s and 1.7 km/s², in most it stays below 700 m/s².
    """
    seed, share = data.draw(st.integers(0, 10**6)), data.draw(st.floats(0.0, 1.0))
    rng = np.random.default_rng(seed)
    seen = points[:170].copy()
    for n in range(4):  # 0.1 to 1 s each, so often that a share of the time is lost
        at = 20
        while at < 100:
            length = int(rng.integers(6, 60))
            if rng.random() < share:
                seen[at:min(at + length, 100), n] = np.nan
            at += length
    someone = person(follower)
    states = played(someone, someone.enter(follower.begin(seen[0]), Intent()), seen)
    positions = bodies(SKELETON, states)
    assert np.isfinite(positions).all()
    assert np.linalg.norm(np.diff(positions, axis=0), axis=-1).max() < 1.0
    assert np.abs(follower.follower.points(states[-1].pose) - points[169]).max() < 0.02
    wandered = np.linalg.norm(positions[:, 0] - follower.controls.on(*_placed(states))[:, 2:].mean(1), axis=-1)
    assert wandered.max() < 1.5


def _placed(states):
    return forward_kinematics(SKELETON, np.stack([np.asarray(s.pose.root, float) for s in states]),
                              np.stack([np.asarray(s.pose.rotations, float) for s in states]))


@pytest.mark.few(1)
@pytest.mark.parametrize("frames, which", [*((frames, which) for frames in (6, 30, 50) for which in ([0], [1, 3])), (6, [0, 1, 2, 3]), (30, [0, 1, 2, 3])])
def test_points_that_were_lost_come_back_without_a_pop(follower, clip, points, which, frames):
    """All of them for as long as the body is still near them: a body that has gone elsewhere meanwhile begins anew."""
    seen, truth = points.copy(), clip.kinematics()[0]
    seen[90:90 + frames, which] = np.nan
    states = played(follower, follower.begin(seen[0]), seen[1:])
    positions = bodies(SKELETON, states)
    felt = pulls(positions[85:])
    assert felt.max() < (6 if len(which) < len(seen[0]) else 8) * pulls(truth).max()  # of half a second without any it knows least
    assert position_error(positions, truth[1:])[90 + frames + 60:].mean() < 0.02


@pytest.mark.few(1)
@pytest.mark.parametrize("wild", [[3.0, 0.0, 0.0], [0.0, -1.0, 0.7]])
def test_a_wild_point_is_not_followed(follower, clip, points, wild):
    seen, truth = points.copy(), clip.kinematics()[0]
    seen[90, 0] += wild
    seen[120:125, 3] += wild
    states = played(follower, follower.begin(seen[0]), seen[1:])
    assert position_error(bodies(SKELETON, states), truth[1:])[30:].max() < 0.06
    assert pulls(bodies(SKELETON, states)).max() < 2.5 * pulls(truth).max()


@pytest.mark.few(1)
@pytest.mark.parametrize("aside", [(0.0, 0.0, 0.0), (0.9, 0.0, 0.5), (-3.0, 0.0, 2.0)])
def test_points_that_are_at_odds_with_the_body_begin_it_anew(follower, clip, points, aside):
    """A clip that begins with four frames of a body at the origin, as some do: the fourth frame after them is right."""
    empty = follower.controls.on(*(x[0] for x in clip.kinematics())) * [0.0, 1.0, 0.0] + [0.05, 0.0, 0.0]
    there = points[60:] + np.array(aside)
    states = played(follower, follower.begin(points[0]), [*[empty] * 4, *there])
    away = position_error(bodies(SKELETON, states)[4:], clip.kinematics()[0][60:] + np.array(aside))
    assert away[4 if np.linalg.norm(aside) > 2 else 60:].mean() < 0.03
    assert np.median([np.abs(follower.follower.points(s.pose) - p).max() for s, p in zip(states[64:], there[60:])]) < 0.02


def test_it_gives_up_when_all_points_are_lost_and_then_it_stands(follower, points):
    someone = person(follower)
    nothing = np.full_like(points[0], np.nan)
    states = played(someone, someone.enter(follower.begin(points[100]), Intent()), list(points[101:150]) + [nothing] * 180)
    given_up = [s.memory.active for s in states].index("locomotion", 1)
    assert abs((given_up - 49) * DT - LOST) < 0.05
    assert states[given_up].memory.why == "the points are lost"
    positions = bodies(SKELETON, states)
    assert np.linalg.norm(positions[-1] - positions[-2], axis=-1).max() / DT < 0.05
    back, _ = someone.step(states[-1], Intent(points=follower.controls.on(*_placed(states[-1:]))[0]), DT)
    assert back.memory.active == "reconstruction"


def test_the_same_state_and_points_give_the_same_pose_and_rewinding_replays(follower, points):
    states = played(follower, follower.begin(points[0]), points[1:120])
    again = played(follower, states[39], points[41:120])
    assert all(np.array_equal(a.pose.rotations, b.pose.rotations) and np.array_equal(a.pose.root, b.pose.root)
               for a, b in zip(again, states[40:]))
    with pytest.raises(AttributeError):
        states[0].memory.lost = 1.0


@pytest.mark.few(1)
@pytest.mark.parametrize("rate", [30, 45, 90, 120, 144])
def test_other_frame_rates_show_the_same_motion(follower, clip, points, rate):
    """Within a frame's way of it: points are seen when they are seen."""
    dt = 1 / rate
    times = np.arange(1, int(2.5 * rate)) * dt
    seen = np.stack([[np.interp(t, np.arange(len(points)) * DT, points[:, n, i]) for n in range(4) for i in range(3)]
                     for t in times]).reshape(-1, 4, 3)
    states = played(follower, follower.begin(points[0]), seen, dt)
    truth = clip.resample(rate).kinematics()[0][1:len(times) + 1]
    positions = bodies(SKELETON, states)
    fastest = np.linalg.norm(np.diff(clip.kinematics()[0][:, 0], axis=0), axis=-1).max()
    assert position_error(positions, truth).mean() < 0.02 + fastest
    assert pulls(positions, dt).max() < 8 * pulls(clip.kinematics()[0]).max()


@pytest.mark.few(1)
@pytest.mark.parametrize("step, dt", [(2, DT), (3, DT), (2, DT / 2)])
def test_points_of_a_slower_rate_than_the_loop_are_followed(follower, clip, points, step, dt):
    """NaN between, or no points at all; in a loop that is faster than frames, whichever step they come in."""
    for between in (np.full_like(points[0], np.nan), None):
        every = [points[round(k * dt / DT)] if k % step == step - 1 else between for k in range(1, round(180 * DT / dt))]
        states = played(follower, follower.begin(points[0]), every, dt)
        shown = bodies(SKELETON, states)[round(DT / dt) - 1::round(DT / dt)]
        assert follower.status(states[-1]).kind == "running"
        assert position_error(shown, clip.kinematics()[0][1:1 + len(shown)])[30:].mean() < 0.06


@pytest.mark.parametrize("height", [0.0, -1.0, float("nan"), float("inf")])
def test_a_height_of_nobody_is_refused(follower, height):
    with pytest.raises(ValueError, match="height"):
        Reconstruction(follower.method, follower.controls, height)


@pytest.mark.parametrize("dt", [0.0, -0.1, 0.11, float("nan")])
def test_steps_that_make_no_sense_are_refused(follower, points, dt):
    with pytest.raises(ValueError, match="dt"):
        follower.step(follower.begin(points[0]), Intent(points=points[0]), dt)


@pytest.mark.few(1)
@pytest.mark.parametrize("height", [1.2, 1.5, 2.0])
def test_a_body_of_another_size_on_another_floor_does_the_same(known, follower, points, height):
    """For as long as rounding stays small: until points moved by 1e-10 m part from the plain ones too, as neighbours change."""
    other, factor = build(known, height=height), height / STATURE
    some = points[:45]
    plain = played(follower, follower.begin(some[0]), some[1:])
    moved = [some + np.random.default_rng(seed).normal(0.0, 1e-10, some.shape) for seed in range(3)]
    shaken = [played(follower, follower.begin(those[0]), those[1:]) for those in moved]
    parts = [max(np.abs(one.pose.rotations - s.pose.rotations).max() for s in same) > 1e-4 for one, *same in zip(plain, *shaken)]
    together = parts.index(True) if any(parts) else len(parts)
    assert together >= 20
    grown = some * factor + [0.0, 0.3, 0.0]
    sized = played(other, other.begin(grown[0], floor=0.3), grown[1:])[:together]
    for one, two in zip(plain, sized):
        assert np.allclose(one.pose.rotations, two.pose.rotations, atol=1e-3)
        assert np.allclose(one.pose.root * factor + [0.0, 0.3, 0.0], two.pose.root, atol=1e-3)
    assert np.mean([np.array_equal(a.contacts, b.contacts) for a, b in zip(plain, sized)]) > 0.9


def test_the_floor_below_the_performer_carries_the_follower():
    """Both ankles have to be over a box; beside and above the performer it is as much higher; a walker keeps its own."""
    follows = Follows("ours", parse("4", SKELETON), "performer", np.array([2.0, 0.1, 0.0]))
    box = SimpleNamespace(centre=np.array([0.0, 0.25, 2.0]), size=np.array([1.0, 0.5, 1.0]), heading=0.0)
    state = replace(Locomotion.load().start(), floor=0.7)

    def floor(z, ankle, stride=0.0, duty="reconstruction"):
        truth = np.zeros((len(SKELETON), 3))
        truth[SKELETON.index("LeftFoot")], truth[SKELETON.index("RightFoot")] = (0.1, ankle, z), (-0.1, ankle, z + stride)
        return carried(follows, replace(state, memory=Duty(duty, None, "")), truth, [box]).floor
    assert floor(0.0, 0.08) == pytest.approx(0.1) and floor(2.0, 0.58) == pytest.approx(0.6)
    assert floor(2.0, 0.45) == floor(2.3, 0.58, stride=0.4) == floor(1.3, 0.9, stride=0.4) == pytest.approx(0.1)
    assert floor(2.0, 0.58, duty="locomotion") == 0.7


def test_a_walker_goes_to_points_that_are_too_far_away(follower, points):
    someone = person(follower)
    state, duty = someone.start((0.0, 0.0, 2.0)), []
    there = points[20] + [2.0, 0.0, 3.0]
    for _ in range(600):
        state, _ = someone.step(state, Intent(towards(state, there), points=there), DT)
        duty.append(state.memory.active)
    assert duty[0] == "locomotion" and duty[-1] == "reconstruction"
    assert np.abs(follower.controls.on(*_placed([state]))[0] - there).max() < 0.01
    assert not towards(state, there * np.nan).any()


def test_methods_tell_their_motions_apart():
    """By the same points."""
    kinds = {Reconstruction(type(name, (), {})(), parse("4", SKELETON)).kind for name in ("One", "Other")}  # type: ignore[arg-type]
    assert len(kinds) == 2


def test_points_that_are_nowhere_are_unseen_and_nothing_is_reckoned_with_them(follower, known):  # noqa: F811
    """Infinite ones as those that are NaN, in a loop of fewer steps than the method has frames."""
    frames, ends = follower.controls.extract(known[1][0])[:40:2], []
    for nowhere in (np.inf, np.nan):
        state = follower.begin(frames[0])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for k, seen in enumerate(frames):
                state, pose = follower.step(state, Intent(points=np.where(k in (5, 6, 7), nowhere, seen)), 2 * DT)
        ends.append(pose)
    assert np.array_equal(ends[0].rotations, ends[1].rotations) and np.array_equal(ends[0].root, ends[1].root)
