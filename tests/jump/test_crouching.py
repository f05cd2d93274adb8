"""Who aims crouches: down by its springs, still as long as it waits, off at once when it is told, up again when it is not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump import Crouching, Jump, Jumping, Physique
from gambol.controllers.navigation import gap
from gambol.controllers.struck import flesh
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box

from conftest import ahead

FPS = 60


def led(person, intents, state=None):
    """The states of somebody who is told so, one for each intent."""
    state, states = person.start() if state is None else state, []
    for intent in intents:
        state, _ = person.step(state, intent, 1 / FPS)
        states.append(state)
    return states


@pytest.fixture(scope="module")
def waiting(person):
    """Standing, then aiming a metre ahead for a second."""
    leap = Leap(ahead(person.start(), 1.0))
    return leap, led(person, [Intent()] * 10 + [Intent(aim=leap)] * 70)


def centres(jump, states):
    return np.array([jump.start_of(person_state(s)).centre for s in states])


def person_state(state):
    return replace(state, memory=state.memory.memory)


def test_who_aims_goes_down_and_waits_there(jump, waiting):
    """With no step in its force, nor ever pulled; both feet stay."""
    _, states = waiting
    assert all(isinstance(s.memory.memory, Crouching) for s in states[12:])
    height = centres(jump, states)[:, 1]
    assert 0.08 < height[0] - height[-1] < 0.35 and np.abs(np.diff(height[-8:])).max() < 5e-4
    bends = np.diff(height[9:], 2) * FPS**2
    assert bends.min() > -0.9 * 9.81 and np.abs(np.diff(bends)).max() < 4.0
    feet = np.array([contact_points(jump.skeleton, *forward_kinematics(jump.skeleton, s.pose.root.astype(float), s.pose.rotations.astype(float)))
                     for s in states[20:]])
    assert np.abs(feet - feet[-1])[..., [0, 2]].max() < 0.003 and states[-1].contacts.all()


def test_told_it_is_off_at_once_and_lands_where_it_should(person, waiting):
    leap, states = waiting
    after = led(person, [Intent(leap=leap)] + [Intent()] * 110, states[-1])
    made = after[0].memory.memory.plan
    usual = person.parts["jump"].plan(person_state(states[5]), Intent(leap=leap))
    assert made.take_off < 0.33 < 0.6 < usual.take_off
    assert np.linalg.norm(made.feet[:, [0, 2]].mean(0) - usual.feet[:, [0, 2]].mean(0)) < 1e-6
    shown = made.at(0.0)
    assert np.abs(shown.root - states[-1].pose.root).max() < 2e-3 and np.abs(shown.rotations - states[-1].pose.rotations).max() < 0.02


def test_from_the_crouch_it_comes_up_without_bowing_and_the_ground_frame_goes_on_without_a_step(jump, person, waiting):
    leap, states = waiting
    after = led(person, [Intent(leap=leap)] + [Intent()] * 60, states[-1])
    placed = [forward_kinematics(jump.skeleton, s.pose.root.astype(float), s.pose.rotations.astype(float))[0] for s in [states[-1], *after]]
    neck = np.array([p[jump.skeleton.index("Neck")] - p[0] for p in placed])
    lean = np.degrees(np.arctan2(neck[:, 2], neck[:, 1]))
    assert lean[:20].max() < lean[0] + 3.0, "it is bent already as far as it will be"
    moved = np.diff([s.ground[1] for s in [states[-1], *after]])
    assert moved.min() > -0.002 and moved.max() < 0.03 and np.abs(np.diff(moved)).max() < 0.005


def test_straight_up_it_can_be_in_the_air_for_so_long_and_no_longer(jump, person, waiting):
    state = person_state(waiting[1][5])
    assert jump.plan(state, Intent(leap=Leap(None, jump.longest))).path.velocity[1] > 2.6
    with pytest.raises(Unable, match=f"too high: this body gets {jump.highest:.2f} m up at most"):
        jump.plan(state, Intent(leap=Leap(None, 1.05 * jump.longest)))
    child = Jump(Physique(mass=30.0, height=1.3, strength=0.9))
    assert child.longest < 0.9 * jump.longest


def test_it_stands_up_if_nothing_comes_of_it_and_walks_at_once_if_it_shall(person, waiting):
    _, states = waiting
    up = led(person, [Intent()] * 120, states[-1])
    assert up[-1].active == "locomotion" and up[5].active == "jump"
    heights = np.array([s.pose.root[1] for s in up])
    assert heights[-1] == pytest.approx(float(states[0].pose.root[1]), abs=0.01) and np.abs(np.diff(heights)).max() < 0.02
    assert led(person, [Intent(np.array([1.0, 0.0, 0.0]))] * 2, states[-1])[-1].active == "locomotion"


def test_the_crouch_follows_the_aim(jump, person, waiting):
    """Deeper for what takes more, leaning to where it goes, without a jump of speed."""
    _, states = waiting
    here = jump.middle(jump.start_of(person_state(states[-1])), 0.0)
    farther = led(person, [Intent(aim=Leap(here + [0.0, 0.0, 1.5]))] * 60, states[-1])
    high = led(person, [Intent(aim=Leap(None, 0.5))] * 60, states[-1])
    now, far, up = centres(jump, [states[-1], farther[-1], high[-1]])
    assert far[1] < now[1] - 0.03 and up[1] < now[1] - 0.03 and up[2] < now[2] - 0.03
    assert np.abs(np.diff(centres(jump, states[-1:] + farther), 2, axis=0)).max() < 0.003


def test_what_can_t_be_is_told_once_and_waits_on(person, waiting, monkeypatch):
    _, states = waiting
    planned, sought = [], Jump._looked_for
    monkeypatch.setattr(Jump, "_looked_for", lambda *given: planned.append(1) or sought(*given))
    far = Leap(np.array([0.0, 0.0, 9.0]))
    after = led(person, [Intent(leap=far)] * 20, states[-1])
    assert "too far" in after[-1].refused and isinstance(after[-1].memory.memory, Crouching) and len(planned) == 1
    assert led(person, [Intent(aim=far)] * 3, after[-1])[-1].refused == ""


def test_weaker_bodies_crouch_deeper_for_the_same(locomotion):
    """So deep that the spring muscles can."""
    depth = []
    for strength in (0.85, 1.3):
        someone = Supervisor({"locomotion": locomotion, "jump": Jump(Physique(strength=strength))})
        states = led(someone, [Intent()] * 10 + [Intent(aim=Leap(None, 0.45))] * 70)
        depth.append(float(states[0].pose.root[1] - states[-1].pose.root[1]))
    assert depth[0] > depth[1] + 0.05


def test_it_is_the_same_to_the_bit_and_any_aim_is_borne(person, waiting):
    leap, states = waiting
    again = led(person, [Intent(aim=leap)] * 5, states[40])
    assert all(np.array_equal(a.pose.rotations, b.pose.rotations) and np.array_equal(a.pose.root, b.pose.root)
               for a, b in zip(again, states[41:46]))
    for place in (np.full(3, np.nan), np.zeros(2), np.array([0.0, 90.0, 1e4])):
        after = led(person, [Intent(aim=Leap(place))] * 30, states[-1])
        assert np.isfinite(after[-1].pose.root).all() and np.isfinite(after[-1].pose.rotations).all()
    assert isinstance(led(person, [Intent(leap=leap)], states[-1])[0].memory.memory, Jumping)


def test_who_crouches_beside_a_box_draws_his_arms_in(person):
    """They swing back as he goes down: hands were 15 cm in it."""
    box = SimpleNamespace(centre=(-0.59, 0.3, 0.0), size=(0.8, 0.6, 2.0), heading=0.0)
    states = led(person, [Intent(aim=Leap(ahead(person.start(), 1.0)), around=(box,))] * 70)
    assert isinstance(states[-1].memory.memory, Crouching)
    arms = [person.skeleton.index(name) for name in ("RightForeArm", "RightHand")]
    placed = np.array([forward_kinematics(person.skeleton, s.pose.root, s.pose.rotations)[0][arms] for s in states])
    assert gap(placed.reshape(-1, 3), box).min() > 0.0


@pytest.mark.few(2)
@pytest.mark.parametrize(("high", "heading"), [(0.45, 0.0), (0.45, 0.5), (0.6, 0.0), (0.9, 0.5)])
def test_it_crouches_no_deeper_than_a_box_before_it_leaves_room_for(jump, person, high, heading):
    """Who has walked up to a box and aims at its top bends no knee into it; and leaps onto it if that can be."""
    things, walks = (Box((0.0, 0.5 * high, 2.0), (6.0, high, 2.0)),), np.array([1.0, 0.0, 0.0])
    begins = person.start((-1.5 * np.sin(heading), 1.0 - 1.5 * np.cos(heading), heading))
    stands = led(person, [Intent(walks, around=things)] * 150 + [Intent(around=things)] * 150, begins)[-1]
    top = Leap(np.array([stands.ground[0], high, 1.5]))
    waits, free = (led(person, [Intent(aim=top, around=around)] * 70, stands) for around in (things, ()))

    def deepest(states):
        points, thick = flesh(jump.physique, *forward_kinematics(jump.skeleton, np.stack([s.pose.root for s in states]).astype(float),
                                                                 np.stack([s.pose.rotations for s in states]).astype(float)))
        return float((thick - gap(points.reshape(-1, 3), things[0]).reshape(points.shape[:-1])).max())
    assert deepest(waits) < 0.02 < 0.08 < deepest(free)
    assert 0.02 < waits[0].pose.root[1] - waits[-1].pose.root[1] < free[0].pose.root[1] - free[-1].pose.root[1] - 0.03
