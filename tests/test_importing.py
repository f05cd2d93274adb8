"""Who imports the controllers gets one clear line for a mistake, reads what a value is in a line, and picks from a batch as from an array."""

import pickle
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from gambol.controllers.body import Clip, Pose, hull, human
from gambol.controllers.contract import CharacterState, Controller, Goal, Intent, Leap, Status, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.locomotion import Blender, ControlSpace, Locomotion, fourier
from gambol.controllers.mocap import Rig, calibrate, load, retarget, write_bvh
from gambol.controllers.navigation import steer, wish
from gambol.controllers.navigation.planning import plan
from gambol.controllers.person import person
from gambol.controllers.reconstruction import parse
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box

DT = 1 / 60


def box(**other):
    """A box, or what lacks or has otherwise what a box has; None for what it lacks."""
    fields = {"centre": (0.0, 0.5, 2.0), "size": (1.0, 1.0, 1.0), "heading": 0.0} | other
    return SimpleNamespace(**{name: value for name, value in fields.items() if value is not None})


@pytest.fixture(scope="module")
def walker():
    return Locomotion.load()


@pytest.mark.parametrize("thing, says", [
    (box(heading=None), "the heading of"), (box(centre=(0.0, 1.0)), "the centre of"), (box(centre=(0.0, np.nan, 2.0)), "the centre of"),
    (box(size=(1.0, -1.0, 1.0)), "the size of"), (box(size=(-1.0, 1.0, 1.0)), "the size of"), (box(heading="north"), "the heading of"), (box(slope=np.nan), "the slope of"),
    (SimpleNamespace(foot=(0.0, 0.0, 2.0), radius=1.0), "the height of"), (SimpleNamespace(foot=(0.0, 0.0, 2.0), radius=-1.0, height=1.0), "the radius of")])
def test_what_stands_about_names_the_field_that_is_unsound(walker, thing, says):
    for someone in (walker, person(walker)):
        with pytest.raises(ValueError, match=says):
            someone.step(someone.start(), Intent(around=(box(), thing)), DT)


@pytest.mark.parametrize("height", [0.9, 1.741, 2.1])
def test_bodies_of_every_size_are_told_of_what_they_were_given(walker, height):
    """In its own numbers, by its own field: not in those of the size that gaits are recorded in."""
    somebody = person(walker, Physique(height=height))
    state = somebody.start()
    for field, thing in (("size", Box((0.0, 0.1, 1.0), (1.0, 0.2, np.nan))), ("centre", Box((0.0, np.inf, 1.0), (1.0, 1.0, 1.0)))):
        with pytest.raises(ValueError, match=f"the {field} of what stands about") as told:
            somebody.step(state, Intent(np.array([0.5, 0.0, 0.0]), around=(thing,)), DT)
        assert repr(getattr(thing, field)) in str(told.value) and "Shrunk" not in str(told.value)
    for given in (1e6, 99e3 if height < 1.0 else -1e6):
        for wrong in (lambda given=given: somebody.start(floor=given), lambda given=given: somebody.step(replace(state, floor=given), Intent(), DT)):
            with pytest.raises(ValueError, match=r"a floor must be a finite height within ±[\d.e+]* m, got " + re.escape(repr(given))):
                wrong()
    for given in (None, "abc", (0.0, 0.0), (np.nan, 0.0, 0.0), (1e6, 0.0, 0.0)):
        with pytest.raises(ValueError, match="a ground must be .* x, z, heading .*got " + re.escape(repr(given))):
            somebody.start(given)


@pytest.mark.parametrize("dt", [None, "soon", np.array([DT]), np.array([DT, DT])])
def test_a_step_is_one_number_of_seconds(walker, dt):
    with pytest.raises(ValueError, match="dt is one number of seconds"):
        walker.step(walker.start(), Intent(), dt)


def test_a_step_takes_a_state_and_an_intent(walker):
    for someone in (walker, person(walker)):
        for state, intent in ((someone.start(), np.array([1.0, 0.0, 0.0])), (Intent(), someone.start())):
            with pytest.raises(ValueError, match="a step takes a CharacterState, an Intent and seconds"):
                someone.step(state, intent, DT)


@pytest.mark.parametrize("call, says", [
    (lambda: steer(None, (0.0, 1.0)), "a ground is .* x, z .*got None"), (lambda: steer((0.0, 0.0), (0.0, 1.0)), r"a ground is .*got \(0.0, 0.0\)"),
    (lambda: steer((0.0, 0.0, 0.0), "fast"), "a velocity is .*got 'fast'"), (lambda: steer((0.0, 0.0, 0.0), 1.0), "a velocity is .*got 1.0"),
    (lambda: plan(None, (1, 2, 0)), "ground must be finite numbers, got None"), (lambda: plan((0, 0), (1, 2, 0)), r"ground is three numbers.*got \(0, 0\)"),
    (lambda: plan((0, 0, 0), "there"), "goal must be finite numbers, got there"),
    *((lambda time=time: wish(plan((0, 0, 0), (1, 2, 0)), time, (0, 0, 0), (0, 0, 0)), "a time into a plan is a number of seconds") for time in (None, np.nan, np.inf)),
    (lambda: load(None), "a motion file is named by a path, got None")])
def test_what_is_no_place_time_or_path_is_told_in_a_line(call, says):
    with pytest.raises(ValueError, match=says):
        call()


def test_places_and_impulses_are_numbers():
    for value in ("ab", None):
        with pytest.raises(ValueError, match="a goal"):
            Goal(value)  # pyright: ignore[reportArgumentType]
        with pytest.raises(ValueError, match="impulse"):
            Strike(value)  # pyright: ignore[reportArgumentType]


class Odd(Controller):
    """Wants to act at once, as far as it is told how."""

    skeleton = human()

    def __init__(self, bid=0.9):
        self.bid = bid

    def precondition(self, state, intent):
        return self.bid

    def enter(self, state, intent):
        return state

    def status(self, state):
        return Status()


class Nowhere(Odd):
    """Gives a pose that is none."""

    def step(self, state, intent, dt):
        return state, Pose(np.full(3, np.nan), state.pose.rotations)


@pytest.mark.parametrize("part, says", [(Odd("very"), "the precondition of the controller 'odd'"), (Odd(np.nan), "the precondition of the controller 'odd'"),
                                        (Nowhere(), "the controller 'odd' gave a pose that is not finite")])
def test_a_controller_of_ones_own_is_named_where_it_goes_wrong(walker, part, says):
    somebody = Supervisor({"walk": walker, "odd": part})
    with pytest.raises(ValueError, match=says):
        somebody.step(somebody.start(), Intent(), DT)


def test_a_controller_that_lacks_an_answer_says_which(walker):
    somebody = Supervisor({"walk": walker, "odd": Odd()})
    with pytest.raises(NotImplementedError, match="Odd is a controller without step"):
        somebody.step(somebody.start(), Intent(), DT)
    for parts in ({}, [walker], None):
        with pytest.raises(ValueError, match="a supervisor takes controllers by name"):
            Supervisor(parts)
    with pytest.raises(ValueError, match="the controller 'three' has no precondition, enter, step, status"):
        Supervisor({"walk": walker, "three": 3})  # pyright: ignore[reportArgumentType]


def test_what_is_printed_of_a_value_is_short(walker):
    state = person(walker).start()
    for value in (state, state.pose, walker.start(np.zeros((5, 3))), walker.library, walker.walk, human(), Intent()):
        assert type(value).__name__ in repr(value) and len(repr(value)) < 2500 and repr(value).count("\n") < 3, type(value)


def led(somebody, state, intents):
    """All states as one is asked for one thing after another."""
    states = []
    for intent in intents:
        state, _ = somebody.step(state, intent, DT)
        states.append(state)
    return states


LEAP, BEFORE = Leap((0.0, 0.0, 1.0)), (Box((0.0, 0.3, 0.8), (1.0, 0.6, 0.2)),)
DOING = {"jump": [Intent(leap=LEAP)] * 30, "crouch": [Intent(aim=LEAP)] * 20, "struck": [Intent(strike=Strike((150.0, 60.0)))],
         "goal": [Intent(goal=Goal((0.0, 3.0)), around=BEFORE)] * 20,
         "thinking": [Intent(goal=Goal((0.0, 3.0)), around=BEFORE)] * 2,
         "sought": [Intent(leap=Leap((0.0, 0.0, 1.4)), around=BEFORE)] * 3}
"""What somebody is asked who stands, step by step."""


@pytest.mark.parametrize("doing", DOING)
def test_states_print_in_a_few_hundred_letters_and_are_pickled(walker, doing):
    """In the midst of whatever they do, and of what is still being worked out; what comes of them is the same to the bit."""
    somebody, intents = person(walker), DOING[doing]
    state = led(somebody, somebody.start(), intents)[-1]
    assert len(repr(state)) < 900 and "\n" not in repr(state)
    there = pickle.loads(pickle.dumps(state))
    for mine, other in zip(*(led(somebody, one, intents[-1:] * 40) for one in (state, there))):
        assert np.array_equal(mine.pose.rotations, other.pose.rotations) and np.array_equal(mine.ground, other.ground) and mine.refused == other.refused


def apart(mine: CharacterState, other: CharacterState):
    """How far two bodies are apart, joint by joint in angle and at the root [m]."""
    return np.abs(np.asarray(mine.pose.rotations, float)[1:] - other.pose.rotations[1:]).max(), np.abs(np.asarray(mine.pose.root, float) - other.pose.root).max()


@pytest.mark.parametrize("asked", [Intent(strike=Strike((0.0, 150.0))), Intent(leap=Leap(None))])
@pytest.mark.parametrize("waits", [0, 1])
def test_who_is_set_elsewhere_is_struck_and_leaps_there(walker, asked, waits):
    """Had only his ground been replaced, his pose would have come after him at 1000 m/s."""
    somebody = person(walker)
    state = led(somebody, somebody.start(), [Intent((1.2, 0.0, 0.0))] * 60 + [Intent()] * 60)[-1]
    x, z, heading = state.ground
    there = state.at((x + 10.0, z + 20.0, heading), 3.0)
    intents = [Intent()] * waits + [asked] + [asked if asked.strike is None else Intent()] * 60
    for mine, other in zip(led(somebody, state, intents), led(somebody, there, intents)):
        assert mine.active == other.active
        assert np.allclose(other.ground - mine.ground, [10.0, 20.0, 0.0], atol=0.02) and float(other.floor) == pytest.approx(3.0 + float(mine.floor), abs=1e-6)
        turned, _ = apart(mine, other)
        assert turned < 0.05
        assert np.allclose(other.pose.root - mine.pose.root, [10.0, 3.0, 20.0], atol=0.02)
    assert mine.active in ("jump", "struck")


def test_elsewhere_one_faces_as_one_is_told_and_a_crowd_is_set_as_one_is(walker):
    crowd = led(walker, walker.start(np.array([[0.0, 0.0, 0.3], [2.0, 1.0, -1.0]])), [Intent((1.0, 0.2, 0.0))] * 40)[-1]
    crowd = replace(crowd, previous=crowd.pose)
    there = crowd.at(crowd.ground + [[5.0, 0.0, 1.0], [0.0, -3.0, -0.5]], np.array([1.0, 0.0]))
    goes, _ = walker.step(there, Intent((1.0, 0.2, 0.0)), DT)
    assert np.abs(goes.pose.root - there.pose.root).max() < 0.05 and np.abs(goes.pose.rotations - there.pose.rotations).max() < 0.2
    assert np.array_equal(there.previous.root, there.pose.root) and there.pose.root.dtype == crowd.pose.root.dtype
    for ground, floor in (((0.0, 0.0, 0.0), None), (np.full((2, 3), np.nan), None), (crowd.ground, np.inf)):
        with pytest.raises(ValueError, match="elsewhere is a finite"):
            crowd.at(ground, floor)


@pytest.mark.parametrize("doing", ["jump", "crouch", "struck"])
def test_who_jumps_or_falls_is_not_set_elsewhere(walker, doing):
    """His motion was planned where he is: what he was set to was not heard."""
    somebody = person(walker)
    state = led(somebody, somebody.start(), DOING[doing])[-1]
    assert state.active == {"crouch": "jump"}.get(doing, doing)
    for moved in (replace(state, ground=state.ground + [1.0, 0.0, 0.0]), replace(state, floor=0.5), state.at(state.ground + [0.0, 0.0, 1.0])):
        with pytest.raises(ValueError, match="can't be set elsewhere.*start him there anew"):
            somebody.step(moved, Intent(), DT)
    somebody.step(state.at(state.ground), Intent(), DT)


def test_a_state_of_a_body_of_another_size_is_refused(walker):
    adult, child, baby = (person(walker, Physique(height=height)) for height in (1.741, 1.2, 0.7))
    state = led(child, child.start(), [Intent((0.6, 0.0, 0.0))] * 20)[-1]
    for other, one in ((adult, state), (baby, state), (child, adult.start())):
        with pytest.raises(ValueError, match="this state is of a body"):
            other.step(one, Intent(), DT)
    taken = adult.parts["locomotion"].enter(child.active(state)[1], Intent())
    after, _ = adult.parts["locomotion"].step(taken, Intent(), DT)
    assert abs(after.pose.root[1] - state.pose.root[1]) < 0.05, "who takes over takes the body as it is"


def test_some_of_a_batch_go_on_as_they_would_have(walker):
    rng = np.random.default_rng(0)
    crowd, wishes = walker.start(rng.uniform(-3.0, 3.0, (5, 3))), rng.normal(size=(5, 3))
    for _ in range(40):
        crowd, _ = walker.step(crowd, Intent(wishes), DT)
    _, poses = walker.step(crowd, Intent(wishes), DT)
    for some in (2, slice(1, 3), np.array([0, 3]), np.array([True, False, False, True, False])):
        _, few = walker.step(crowd[some], Intent(wishes[some]), DT)
        assert np.array_equal(few.rotations, poses.rotations[some]) and np.array_equal(few.root, poses.root[some])


def test_some_of_a_batch_begin_anew_and_the_others_notice_nothing(walker):
    rng = np.random.default_rng(0)
    places, wishes = rng.uniform(-3.0, 3.0, (5, 3)), rng.normal(size=(5, 3))
    crowd = walker.start(places)
    for _ in range(40):
        crowd, _ = walker.step(crowd, Intent(wishes), DT)
    done = np.array([True, False, False, True, False])
    fresh = walker.start(places[done], 0.5)
    mixed = crowd.put(done, fresh)
    assert np.array_equal(mixed.floor, [0.5, 0.0, 0.0, 0.5, 0.0]) and np.all(crowd.floor == 0.0)
    _, poses = walker.step(mixed, Intent(wishes), DT)
    assert np.array_equal(poses.rotations[~done], walker.step(crowd, Intent(wishes), DT)[1].rotations[~done])
    assert np.array_equal(poses.rotations[done], walker.step(fresh, Intent(wishes[done]), DT)[1].rotations)
    with pytest.raises(ValueError, match="not of a batch"):
        walker.start()[0]
    with pytest.raises(ValueError, match="do not fit where"):
        crowd.put(done, walker.start(places))
    with pytest.raises(ValueError, match="of the controller that steps it"):
        crowd.put(0, person(walker).start())


def test_pieces_taken_alone_say_what_they_take(walker):
    samples = np.random.default_rng(0).normal(size=(64, 3))
    assert np.allclose(fourier.fit(samples.tolist()), np.linalg.lstsq(fourier.basis(np.arange(64) / 64), samples, rcond=None)[0])
    with pytest.raises(ValueError, match="samples are"):
        fourier.fit(samples[:, 0])
    for points in (samples[:, :2], np.full((10, 3), np.nan)):
        with pytest.raises(ValueError, match="the velocities must be"):
            ControlSpace.build(points)
    with pytest.raises(ValueError, match="seen from above"):
        hull(samples)
    with pytest.raises(ValueError, match="a Blender takes a Locomotion"):
        Blender(walker.library)


CLIP = Clip("clip", human(), 1 / 60, np.zeros((4, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (4, 22, 1)))


@pytest.mark.parametrize("wrong, says", [
    ({"frame_time": -0.1}, "frame_time is a number above zero, not -0.1"), ({"frame_time": 0}, "frame_time"), ({"frame_time": "60"}, "frame_time"),
    ({"root": np.zeros((3, 3))}, "3 frames of 22 joints have a root (3, 3) and quaternions (3, 22, 4); got (3, 3) and (4, 22, 4)"),
    ({"quaternions": np.zeros((4, 22, 3))}, "got (4, 3) and (4, 22, 3)"), ({"quaternions": np.zeros((4, 21, 4))}, "got (4, 3) and (4, 21, 4)")])
def test_a_clip_that_no_reader_would_take_is_not_written(tmp_path, wrong, says):
    with pytest.raises(ValueError, match=re.escape(says)):
        write_bvh(replace(CLIP, **wrong), tmp_path / "a.bvh")
    assert not (tmp_path / "a.bvh").exists()


@pytest.mark.parametrize("call, says", [
    (lambda path: write_bvh(CLIP, path, unit="cm"), "unit is a number above zero, not 'cm'"), (lambda path: write_bvh(CLIP, path, order=None), "the order of rotations is"),
    (lambda path: retarget(str(path)), "what is retargeted is a Clip, as load gives it; got a str"), (lambda path: calibrate([None]), "clips are Clips, as load gives them; got NoneType"),
    (lambda path: CLIP.resample("60"), "fps is a number of frames a second"), (lambda path: CLIP.resample(0), "fps is"), (lambda path: CLIP.resample(-1), "fps is"),
    (lambda path: parse(None, human()), "points are named, as in"), (lambda path: parse(4, human()), "points are named, as in"),
    (lambda path: Rig.of(None, None, None), "names are bones' names"), (lambda path: Rig.of("root", [-1], [[0, 0, 0]]), "names are bones' names"),
    (lambda path: Rig.of(human().names, [None, *human().parents[1:]], np.zeros((22, 3))), "parents are numbers of bones, -1 of the root"),
    (lambda path: Rig.of(human().names, human().parents, np.zeros((22, 3)), metres="cm"), "metres, in one unit, is a number above zero, not 'cm'"),
    (lambda path: Rig.of(human().names, human().parents, np.zeros((22, 3)), metres=0), "metres, in one unit"),
    (lambda path: Supervisor({"walk": Locomotion}), "the controller 'walk' is a class, Locomotion: make one of it")])
def test_what_is_of_another_kind_is_told_of(tmp_path, call, says):
    with pytest.raises(ValueError, match=says):
        call(tmp_path / "a.bvh")
    assert not list(tmp_path.iterdir())


def test_points_may_be_named_in_a_list():
    assert parse(["lwrist", "rwrist"], human()).names == parse("lwrist,rwrist", human()).names
