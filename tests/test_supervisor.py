"""The supervisor picks, keeps and falls back, and nobody sees the hand-over."""

import re
import sys
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest

from gambol.controllers.body import Pose, forward_kinematics, human
from gambol.controllers.contract import CharacterState, Controller, Intent, Leap, Status, Unable
from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.controller import Jump
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.locomotion.memory import Settings
from gambol.controllers.scaled import Scaled
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar

FPS = 60
WANTED = Intent(leap=Leap(np.zeros(3)))


@dataclass(frozen=True)
class Steps:
    """What a stand-in remembers: whose it is, and how many steps it made."""

    name: str
    count: int = 0


@dataclass
class StandIn(Controller):
    """A controller that bids what it is told and ends when it is told."""

    name: str
    bid: float
    hold: float = 0.5
    refuses: str = ""
    after: int = 10**9
    ends: Status = Status("done")
    skeleton = human()

    def start(self, ground=(0.0, 0.0, 0.0), floor=0.0):
        return CharacterState(np.asarray(ground, float), np.zeros(3), Pose(np.zeros(3), np.tile(np.eye(3), (22, 1, 1))),
                              np.ones(4, bool), Steps(self.name), floor)

    def precondition(self, state, intent):
        return self.hold if state.memory.name == self.name else self.bid if intent.leap is not None or self.name == "walk" else 0.0

    def enter(self, state, intent):
        if self.refuses:
            raise Unable(self.refuses)
        return replace(state, memory=Steps(self.name))

    def step(self, state, intent, dt):
        return replace(state, memory=Steps(self.name, state.memory.count + 1)), state.pose

    def status(self, state):
        return self.ends if state.memory.count >= self.after else Status("running")


def run(supervisor, intents):
    state, names = supervisor.start(), []
    for intent in intents:
        state, _ = supervisor.step(state, intent, 1 / FPS)
        names.append(state.memory.active)
    return state, names


def test_the_best_bid_gets_it_and_keeps_it_while_it_holds():
    supervisor = Supervisor({"walk": StandIn("walk", 0.5), "hop": StandIn("hop", 0.8, hold=1.5), "jump": StandIn("jump", 1.0, hold=1.5)})
    _, names = run(supervisor, [Intent(), WANTED, WANTED, Intent(), Intent()])
    assert names == ["walk", "jump", "jump", "jump", "jump"]


@pytest.mark.parametrize(("ends", "why", "refused"), [
    (Status("done"), "jump is done", ""), (Status("failed", "it struck a box"), "it struck a box", "it struck a box")])
def test_one_that_ends_hands_back_and_says_why(ends, why, refused):
    supervisor = Supervisor({"walk": StandIn("walk", 0.5), "jump": StandIn("jump", 1.0, hold=1.5, after=3, ends=ends)})
    state, names = run(supervisor, [WANTED] + [Intent()] * 4)
    assert names == ["jump"] * 3 + ["walk"] * 2
    assert run(supervisor, [WANTED] + [Intent()] * 3)[0].memory.why == why
    assert run(supervisor, [WANTED] + [Intent()] * 3)[0].memory.refused == refused


def test_a_refusal_is_shown_as_long_as_it_is_asked_and_the_next_best_is_taken():
    walk, jump = StandIn("walk", 0.5), StandIn("jump", 1.0, refuses="too far")
    state, names = run(Supervisor({"walk": walk, "jump": jump}), [Intent(), WANTED])
    assert names == ["walk", "walk"] and state.memory.refused == "too far"
    assert run(Supervisor({"walk": walk, "jump": jump}), [WANTED, Intent()])[0].memory.refused == ""
    _, names = run(Supervisor({"walk": walk, "jump": jump, "hop": StandIn("hop", 0.8)}), [WANTED])
    assert names == ["hop"]


def test_what_moved_is_passed_on():
    supervisor = Supervisor({"walk": StandIn("walk", 0.5)})
    first = supervisor.start()
    state, _ = supervisor.step(first, Intent(), 1 / 30)
    assert state.previous is first.pose and state.elapsed == 1 / 30


@pytest.fixture(scope="module")
def person():
    return Supervisor({"locomotion": Locomotion.load(), "jump": Jump()})


@pytest.mark.few(3)
@pytest.mark.parametrize(("speed", "far"), [(0.0, 0.7), (1.2, 1.1), (1.37, 1.1), (2.8, 2.2)])
def test_walking_jumping_and_walking_on_are_one_motion(person, speed, far):
    """No joint moves faster at a hand-over than bodies do, and none leaves its way between two frames."""
    state, wish, places, active = person.start(), np.array([speed, 0.0, 0.0]), [], []
    asked = False
    for k in range(420):
        place = np.array([state.ground[0], 0.0, state.ground[1] + far])
        leap = None if asked or k < 139 else Leap(place)
        state, pose = person.step(state, Intent(wish if k < 300 else np.zeros(3), leap), 1 / FPS)
        asked = asked or state.memory.active == "jump"
        places.append(forward_kinematics(person.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))[0])
        active.append(state.memory.active)
    changes = np.flatnonzero(np.array(active[1:]) != np.array(active[:-1])) + 1
    assert [active[k] for k in changes] == ["jump", "locomotion"]
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=-1) * FPS
    assert np.isfinite(speeds).all() and speeds.max() < 20.0  # hands that swing
    trunk = [person.skeleton.index(name) for name in ("Hips", "Spine", "Spine1", "Spine2")]
    jerk = np.linalg.norm(np.diff(places, 2, axis=0)[:, trunk], axis=-1) * FPS  # change of velocity in a frame [m/s]
    for k in changes:
        assert jerk[k - 3:k + 3].max() < 1.5
    # arms swing up in their own time, however late the foot strikes
    arms = [person.skeleton.index(side + part) for side in ("Left", "Right") for part in ("ForeArm", "Hand")]
    jumped = np.array(places)[changes[0] - 2:changes[0] + 8, arms]
    acceleration = np.linalg.norm(jumped[4:] - 2.0 * jumped[2:-2] + jumped[:-4], axis=-1) * (FPS / 2) ** 2
    usual = person.parts["locomotion"].library.accelerations["run" if speed > 2.0 else "walk"][arms]
    assert (acceleration < 4.5 * usual).all()


def compiled():
    """For how many kinds of arguments each kernel was compiled."""
    return {f"{name}.{key}": len(value.signatures) for name, module in list(sys.modules.items()) if "controllers" in name
            for key, value in vars(module).items() if isinstance(getattr(value, "signatures", None), list)}


def leaping(someone, dt, airtime=None):
    """Somebody takes a step and leaps, all in steps of dt seconds."""
    state, active = someone.start(), set()
    for k in range(60):
        leap = Leap(np.array([0.0, 0.0, 0.05]), airtime) if 2 < k < 12 else None
        state, _ = someone.step(state, Intent(leap=leap), dt)
        active.add(state.memory.active)
    assert active == {"locomotion", "jump"}, state.memory.refused
    return state


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.float16, np.array, Fraction])
def test_a_step_of_any_kind_of_number_compiles_nothing_anew(person, kind):
    dt, airtime = kind(0.0625), kind(0.5)
    plain = leaping(person, 0.0625, 0.5)
    before = compiled()
    assert sum(before.values()) > 20
    odd = leaping(person, dt, airtime)
    assert compiled() == before
    np.testing.assert_array_equal(odd.pose.rotations, plain.pose.rotations)
    assert type(odd.elapsed) is float


def test_bodies_and_settings_of_whole_numbers_compile_nothing_anew():
    def someone(physique, settings):
        return Supervisor({"locomotion": Locomotion.load().tuned(settings), "jump": Jump(physique)})
    leaping(someone(Physique(80.0, strength=2.0), Settings(acceleration=4.0)), 1 / 60)
    before = compiled()
    leaping(someone(Physique(80, strength=np.float32(2)), Settings(acceleration=4, footing=1, breath=0)), 1 / 60)
    assert compiled() == before


@pytest.mark.parametrize("dt", [0, 1, -1, 0.0, -0.1, 0.1001, np.nan, np.inf, np.float32(np.nan), np.float32(0.11)])
def test_a_step_that_is_none_is_refused_at_the_door(person, dt):
    leap = Intent(leap=Leap(np.array([0.0, 0.0, 0.5])))
    for someone in (person, Scaled(person.parts["locomotion"], 0.7)):
        with pytest.raises(ValueError, match=re.escape("dt must be in (0, 0.1] s, got ")):
            someone.step(someone.start(), leap, dt)


@pytest.mark.parametrize("dt", [0.1, np.float32(0.1)])
def test_the_longest_step_is_one_for_bodies_of_all_sizes(person, dt):
    for size in (0.3, 0.7, 1.0, 1.5):
        child = Scaled(person.parts["locomotion"], size)
        state = child.start()
        for _ in range(20):
            state, pose = child.step(state, Intent(np.array([0.5, 0.0, 0.0])), dt)
        assert np.isfinite(pose.root).all() and state.ground[1] > 0.5


def test_nothing_changes_the_state_that_was_stepped(person):
    state = person.start()
    before = state.pose.root.tobytes(), state.memory.memory.tobytes()
    person.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 0.6]))), 1 / FPS)
    assert (state.pose.root.tobytes(), state.memory.memory.tobytes()) == before


def test_what_can_t_be_jumped_is_told_while_walking_goes_on(person):
    state = person.start()
    for _ in range(3):  # a path is looked at in each
        state, pose = person.step(state, Intent(np.array([1.0, 0.0, 0.0]), Leap(np.array([0.0, 0.0, 9.0]))), 1 / FPS)
    assert state.memory.active == "locomotion" and "too far" in state.memory.refused and np.isfinite(pose.root).all()


def test_a_refused_leap_is_planned_once_until_something_changes():
    """Held on, by one who stands and by one who runs: once a stance at most."""
    from gambol.controllers.contract import Unable
    from gambol.controllers.supervisor import Asked
    calls, bids = [], []

    class Never(Jump):
        def precondition(self, state, intent):
            bids.append(state)
            return super().precondition(state, intent)

        def seek(self, state, intent, onward=None):
            calls.append(state)
            raise Unable("not from here")
    person = Supervisor({"locomotion": Locomotion.load(), "jump": Never()})
    state, leap = person.start(), Leap(np.array([0.0, 0.0, 9.0]))
    for _ in range(30):
        state, _ = person.step(state, Intent(leap=leap), 1 / 60)
    assert len(calls) == len(bids) == 1 and state.refused == "not from here" and isinstance(state.memory.asked, Asked)
    state, _ = person.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 8.0]))), 1 / 60)
    assert len(calls) == 2, "another place"
    for k in range(5):
        state, _ = person.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 8.0 + 0.004 * k]))), 1 / 60)
    assert len(calls) == 2 and state.refused, "hardly another"
    state, _ = person.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 8.025]))), 1 / 60)
    assert len(calls) == 3, "which has crept on"
    state, _ = person.step(state, Intent(), 1 / 60)
    state, _ = person.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 8.0]))), 1 / 60)
    assert len(calls) == 4 and state.refused, "asked anew"


def test_who_was_refused_as_he_glided_is_asked_again_once_he_rests():
    """Where he stepped back from a box, he was refused for his pace, and never asked again."""
    from gambol.controllers.supervisor import Asked
    state = Supervisor({"locomotion": Locomotion.load()}).start()
    slow, still = (replace(state, velocity=np.array([-speed, 0.0, 0.0])) for speed in (0.12, 0.03))
    asked = Asked("jump", WANTED, slow)
    assert asked.still(slow, WANTED) and not asked.still(still, WANTED)
    assert Asked("jump", WANTED, still).still(still, WANTED)


@pytest.fixture(scope="module")
def leaper():
    return Supervisor({"locomotion": Locomotion.load(settings=Settings(idle=0.0)), "jump": Jump()})


def leaps_after(leaper, place, around, steps=90):
    """After how many steps somebody who stands and asks for a leap is on it, None if not by then; around: of the number of a step. And his last state."""
    state = leaper.start()
    for k in range(steps):
        state, _ = leaper.step(state, Intent(leap=Leap(np.array(place)), around=around(k)), 1 / FPS)
        if state.active == "jump":
            return k, state
    return None, state


def test_what_moves_far_away_holds_no_leap_up_whatever_its_numbers_are_held_in(leaper):
    """It was sought anew in each step, and never found."""
    box = Box(np.array([0.0, 0.125, 1.0]), np.array([0.8, 0.25, 0.6]))
    still, _ = leaps_after(leaper, (0.0, 0.25, 1.0), lambda k: (box, Pillar((50.0, 0.0, 50.0))))
    assert leaps_after(leaper, (0.0, 0.25, 1.0), lambda k: (Box(box.centre.copy(), box.size.copy()), Pillar((50.0 + k / FPS, 0.0, 50.0))))[0] == still is not None


def test_a_leap_is_sought_anew_once_what_refused_it_has_gone_aside(leaper):
    """However slowly that goes: less than a step's tolerance in each of them."""
    goes, state = leaps_after(leaper, (0.0, 0.0, 1.0), lambda k: (Box((0.02 * k, 1.5, 0.8), (1.0, 3.0, 0.2)),), 180)
    assert goes is not None and goes > 20


def test_what_is_no_place_is_refused_in_words_though_things_move(leaper):
    goes, state = leaps_after(leaper, (0.0, 1.0), lambda k: (Box((0.0, 0.1, 1.5), (1.0, 0.2, 1.0)), Pillar((1.0 + 0.2 * k, 0.0, 1.0))), 20)
    assert goes is None and "three finite numbers" in state.refused


@pytest.mark.parametrize("nobody", [None, "somebody", 5])
def test_what_is_no_state_is_told_of(nobody):
    """As of who forgot to keep what `start` gave."""
    somebody = Supervisor({"walk": StandIn("walk", 0.5), "jump": Jump()})
    jump, state = somebody.parts["jump"], somebody.start()
    for ask in (somebody.status, jump.status, somebody.active, jump.start_of, lambda it: somebody.refusal(it, WANTED), lambda it: jump.refusal(it, WANTED),
                lambda it: somebody.precondition(it, WANTED), lambda it: somebody.enter(it, WANTED)):
        with pytest.raises(ValueError, match=f"a CharacterState is asked about, .* got a {type(nobody).__name__}"):
            ask(nobody)
    for ask in (somebody.refusal, jump.refusal):
        with pytest.raises(ValueError, match="is an Intent; got a"):
            ask(state, nobody)
    with pytest.raises(ValueError, match="this state is of nobody who jumps: enter it first"):
        jump.step(state, Intent(), 1 / FPS)
    with pytest.raises(ValueError, match="this state is not of several controllers: enter it first"):
        somebody.refusal(somebody.parts["walk"].start(), WANTED)


@pytest.mark.parametrize("wrong, says", [(None, "settings are Settings"), ({"agility": 2.0}, "settings are Settings"), (Settings(agility="2"), "agility must be one number, got '2'"),
                                         (Settings(gaze=None), "gaze must be one number"), (Settings(agility=[1.0]), "agility must be one number")])
def test_settings_are_numbers(wrong, says):
    with pytest.raises(ValueError, match=re.escape(says)):
        Locomotion.load(settings=wrong)
