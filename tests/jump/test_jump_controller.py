"""The jump controller: pure, the same twice, and clear about what it can't do before it winds up."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import contact_height, contact_points, end_positions, forward_kinematics
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump.body import soles
from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.controller import Jump, Jumping
from gambol.controllers.jump.reach.feasibility import Refused
from gambol.controllers.navigation import gap
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene.scene import Box, Goal, Pillar
from conftest import ahead

FPS = 60
WALL = Box((0.0, 1.5, 0.8), (3.0, 3.0, 0.2))
ROOF = Box((0.0, 2.1, 1.2), (3.0, 1.0, 0.8))


def leap(z, y=0.0, airtime=None, around=()):
    return Intent(np.zeros(3), Leap(np.array([0.0, y, z]), airtime), around)


def bits(state):
    return b"".join(np.ascontiguousarray(a).tobytes() for a in (
        state.ground, state.velocity, state.pose.root, state.pose.rotations, state.contacts, np.float64(state.floor)))


def played(jump, state, intent=Intent()):
    """The states of a whole jump."""
    states = [state]
    while jump.status(states[-1]).kind == "running" and len(states) < 400:
        states.append(jump.step(states[-1], intent, 1 / FPS)[0])
    return states


def test_a_jump_replays_to_the_bit_and_leaves_its_states_alone(jump, standing):
    first = jump.enter(standing, leap(0.7))
    before = bits(first), first.memory.time
    states = played(jump, first)
    assert (bits(first), first.memory.time) == before
    again = played(jump, jump.enter(standing, leap(0.7)))
    assert [bits(s) for s in states] == [bits(s) for s in again] and len(states) > 60
    assert bits(jump.step(states[40], Intent(), 1 / FPS)[0]) == bits(states[41])


def test_it_says_that_it_starts_nobody_and_plans_only_what_is_asked(jump, standing):
    with pytest.raises(Unable, match="Jump starts nobody, it takes over from others"):
        jump.start()
    with pytest.raises(Refused, match="nobody asked"):
        jump.plan(standing, Intent())


def test_it_ends_standing_over_the_place_and_says_so(jump, standing):
    last = played(jump, jump.enter(standing, leap(0.5)))[-1]
    assert jump.status(last).kind == "done" and last.contacts.all()
    feet = last.pose.root[[0, 2]] - [0.0, 0.5]
    assert np.linalg.norm(feet) < 0.15 and np.linalg.norm(last.velocity[[0, 2]]) < 0.2


@settings(max_examples=12, deadline=None)
@given(st.floats(0.004, 0.1))
def test_any_step_comes_through(jump, standing, dt):
    state = jump.enter(standing, leap(0.4))
    for _ in range(30):
        state, pose = jump.step(state, Intent(), dt)
    assert np.isfinite(pose.root).all() and np.isfinite(pose.rotations).all()


@pytest.mark.parametrize("dt", [0.0, -0.1, 0.2, np.nan])
def test_a_step_must_be_one(jump, standing, dt):
    with pytest.raises(ValueError, match="dt"):
        jump.step(jump.enter(standing, leap(0.4)), Intent(), dt)


@pytest.mark.parametrize(("physique", "intent", "reason"), [
    (Physique(), Intent(np.zeros(3)), "nobody asked"),
    (Physique(), leap(np.nan), "finite"),
    (Physique(), leap(np.inf), "finite"),
    (Physique(), Intent(np.zeros(3), Leap(np.array([0.0, 1.0]))), "three"),
    (Physique(), leap(0.5, airtime=0.0), "airtime"),
    (Physique(), leap(0.5, airtime=-1.0), "airtime"),
    (Physique(), leap(0.5, airtime=np.nan), "airtime"),
    (Physique(), leap(0.5, airtime=1e9), "airtime"),
    (Physique(), leap(0.8, 1.0, around=(WALL,)), "inside"),
    (Physique(), leap(1.3, around=(WALL,)), "would hit"),
    (Physique(), leap(1.3, around=(Pillar((0.0, 0.0, 0.8)),)), "would hit"),
    (Physique(), leap(1.2, around=(ROOF,)), "head would hit"),
    (Physique(), leap(0.4, 0.3, around=(Box((0.0, 0.1, 3.0), (1.0, 0.2, 1.0)),)), "nothing to land on"),
    (Physique(), leap(8.0), r"too far: [78]\.\d m; the nearest that it reaches is .* m away"),
    (Physique(), leap(0.8, 2.0), r"too high: 0\.[78] m away and 2.0 m up"),
    (Physique(strength=0.15), leap(1.0), "too weak"),
    (Physique(), leap(0.5, airtime=2.0), "2.00 s in the air is too long"),
    (Physique(), leap(1.0, -30.0), "too deep"),
], ids=lambda v: v if isinstance(v, str) else "")
def test_what_can_t_be_is_refused_before_the_wind_up_and_says_why(standing, physique, intent, reason):
    with pytest.raises(Refused, match=reason):
        Jump(physique).enter(standing, intent)


def test_a_refusal_names_a_place_that_can_be_reached(jump, standing):
    with pytest.raises(Refused) as refused:
        jump.enter(standing, leap(5.0))
    nearest = refused.value.nearest
    assert 0.8 < nearest[2] < 5.0 and f"{nearest[2]:.2f}" in str(refused.value)
    jump.enter(standing, Intent(np.zeros(3), Leap(nearest)))


def test_the_nearest_place_is_the_same_however_far_the_refused_one_is(jump, standing):
    nearest = []
    for far in (3.0, 20.0, 1e3, 1e5):
        with pytest.raises(Refused) as refused:
            jump.enter(standing, leap(far))
        nearest.append(refused.value.nearest)
    np.testing.assert_allclose(nearest, [nearest[0]] * 4, atol=0.005)  # but for where between the feet the way begins


@pytest.mark.parametrize(("far", "reason"), [(0.4, "too near for this run|no leg pushes off so hard"), (9.0, "no leg|too far")])
def test_a_runner_who_is_refused_is_told_the_nearest_place_too(jump, running, far, reason):
    """Beyond the target, if that is too near."""
    here = jump.middle(jump.start_of(running), float(running.floor))
    towards = running.pose.rotations[0][:, 2] * [1.0, 0.0, 1.0]
    with pytest.raises(Refused, match=f"({reason}).*the nearest that it reaches is") as refused:
        jump.enter(running, Intent(leap=Leap(here + far * towards)))
    nearest = refused.value.nearest
    jump.enter(running, Intent(leap=Leap(nearest)))
    closer = nearest + 0.1 * (here + far * towards - nearest)
    with pytest.raises(Refused):
        jump.enter(running, Intent(leap=Leap(closer)))


@pytest.mark.parametrize("strength, words", [(0.4, "too weak to jump here at all, with a strength of 0.4"), (0.6, "strength of 0.6 keeps it in the air for 0.26 s at most, and it takes 0.30 s")])
def test_a_body_that_can_t_jump_at_all_is_told_so_wherever_it_is_asked_to(standing, strength, words):
    """And not how far it would be; what it is told of, a shorter jump, it can make."""
    jump = Jump(Physique(strength=strength))
    for place in (None, [0.0, 0.0, 0.1], [0.0, 0.0, 0.5], [0.0, 0.4, 0.5]):
        with pytest.raises(Refused, match=words):
            jump.plan(standing, Intent(leap=Leap(None if place is None else np.array(place))))
    if strength > 0.5:
        assert jump.plan(standing, Intent(leap=Leap(None, 0.25))).path.airtime == pytest.approx(0.25)


@pytest.mark.few(1)
@pytest.mark.parametrize("deep", [5.0, 50.0])
def test_who_is_asked_too_deep_is_told_how_deep_he_can_get_there(jump, standing, deep):
    """Right above the place, however deep that is; a little deeper is refused."""
    with pytest.raises(Refused, match=r"too deep: .*nearest that it reaches is 0\.9 m away and 3\.[12] m down") as refused:
        jump.plan(standing, leap(1.0, -deep))
    nearest = refused.value.nearest
    assert nearest[[0, 2]] == pytest.approx([0.0, 1.0]) and -3.25 < nearest[1] < -3.0
    jump.plan(standing, Intent(leap=Leap(nearest)))
    with pytest.raises(Refused):
        jump.plan(standing, Intent(leap=Leap(nearest - [0.0, 0.1, 0.0])))


def test_a_goal_stops_nobody(jump, standing):
    assert isinstance(jump.enter(standing, leap(0.8, around=(Goal((0.0, 0.0, 0.8)),))).memory, Jumping)


@pytest.mark.parametrize("values", [{"mass": 0.0}, {"mass": np.nan}, {"height": 0.0}, {"strength": -1.0}, {"flexibility": 9.0}])
def test_no_body_is_like_that(values):
    with pytest.raises(ValueError, match=next(iter(values))):
        Physique(**values)


@pytest.mark.parametrize("height", [0.5, 1.2, 1.741, 3.0])
def test_a_body_weighs_as_an_adult_of_its_height_unless_told(height):
    body = Physique(height=height)
    assert body.mass == 73.0 * (height / 1.741) ** 3 and type(body.mass) is float
    assert body == Physique(None, height) == Physique(body.mass, height) and Physique().mass == 73.0
    assert replace(Physique(), height=height).mass == 73.0, "a body that is replaced keeps its mass"
    assert replace(Physique(), height=height, mass=None) == body


@pytest.mark.parametrize("height", [0.5, 1.0])
def test_small_bodies_of_their_own_weight_jump(height):
    jump, size = Jump(Physique(height=height)), height / 1.741
    assert jump.highest == pytest.approx(size * Jump().highest, rel=0.2)


@pytest.mark.parametrize("gravity", [(0, 0, 0), (0, 9.81, 0), (1, -9.81, 0), (0, np.nan, 0), (0, -9.81)])
def test_gravity_pulls_down(gravity):
    with pytest.raises(ValueError, match="gravity"):
        Jump(gravity=gravity)


def test_stronger_bodies_and_lighter_places_reach_further(standing):
    def farthest(jump):
        with pytest.raises(Refused) as refused:
            jump.enter(standing, leap(30.0))
        return refused.value.nearest[2]
    weak, usual = farthest(Jump(Physique(strength=0.8))), farthest(Jump())
    moon = farthest(Jump(gravity=(0.0, -1.62, 0.0)))
    assert weak < usual < moon


def test_an_adult_leaps_farther_ahead_than_back_and_aside(jump, standing):
    """And ahead nearly as far as the farthest recorded jump, 2.01 m, his feet no farther ahead of him as he lands than in that (0.36 m)."""
    reached = []
    for way in (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0):
        with pytest.raises(Refused) as refused:
            jump.enter(standing, Intent(leap=Leap(4.0 * np.array(way))))
        reached.append(float(refused.value.nearest @ way))
    assert reached[0] > 1.85 and reached[0] > reached[1] + 0.1 and reached[0] > reached[2] + 0.1
    made = jump.plan(standing, leap(1.85))
    ahead = soles(made.feet, jump.physique.tables).mean(0) - made.moving(made.touch_down)[0]
    assert 0.33 < ahead[2] < 0.37


def test_it_bids_only_for_a_jump_that_can_start_and_holds_on_to_one(jump, standing, running):
    assert jump.precondition(standing, Intent()) == 0.0
    assert jump.precondition(standing, leap(0.5)) > 0.5
    aloft = replace(standing, floor=-1.0)
    assert jump.precondition(aloft, leap(0.5)) == 0.0
    inside = jump.enter(standing, leap(0.5))
    assert jump.precondition(inside, Intent(np.array([1.0, 0.0, 0.0]))) > jump.precondition(standing, leap(0.5))


def reaches(jump, made, around):
    """How near head, hands and elbows come to things in flight [m]."""
    skeleton = jump.skeleton
    shown = [made.at(t) for t in np.linspace(made.take_off, made.touch_down, 30)]
    positions, turned = forward_kinematics(skeleton, np.stack([p.root for p in shown]), np.stack([p.rotations for p in shown]))
    ends = end_positions(skeleton, positions, turned)
    points = np.concatenate([ends[:, [skeleton.end_index[n] for n in ("Head", "LeftHand", "RightHand")]],
                             positions[:, [skeleton.index(n) for n in ("LeftForeArm", "RightForeArm")]]], 1)
    return min(gap(points.reshape(-1, 3), thing).min() for thing in around)


@pytest.mark.parametrize(("far", "bottom"), [(0.7, 2.0), (0.5, 2.0), (1.0, 1.93)])
def test_arms_stay_down_where_a_roof_is_above_them(jump, standing, far, bottom):
    roof = Box((0.0, bottom + 0.5, 0.4), (3.0, 1.0, 3.0))
    assert reaches(jump, jump.plan(standing, leap(far, around=(roof,))), (roof,)) > 0.0
    state = jump.enter(standing, leap(far, around=(roof,)))
    states = played(jump, state, Intent(around=(roof,)))
    assert not any(s.memory.fault for s in states), "nor is anything struck"


def test_ten_jumps_straight_up_stay_where_they_are(jump, locomotion):
    person = Supervisor({"locomotion": locomotion, "jump": jump})
    state, places, jumps = person.start(), [], 0
    for _ in range(2400):
        at_rest = state.memory.active == "locomotion" and not np.abs(state.velocity).max() > 0.02
        before = state.memory.active
        state, _ = person.step(state, Intent(leap=Leap(None, 0.5) if at_rest and jumps < 10 else None), 1 / FPS)
        if before == "locomotion" and state.memory.active == "jump":
            jumps += 1
            places.append(jump.middle(jump.start_of(replace(state, memory=None)), 0.0))
        if jumps == 10 and at_rest and state.memory.active == "locomotion":
            break
    assert jumps == 10
    places.append(jump.middle(jump.start_of(replace(state, memory=None)), 0.0))
    assert np.linalg.norm(np.array(places) - places[0], axis=1).max() < 0.02


@pytest.mark.parametrize("inside", [0.005, 0.06])
def test_nobody_lands_with_heels_over_an_edge(jump, standing, inside):
    """A place just within a platform is none to stand on; farther in there is."""
    step = Box((0.0, 0.1, 1.5), (2.0, 0.2, 2.0))
    with pytest.raises(Refused, match="too near an edge"):
        jump.plan(standing, leap(0.5 + inside, 0.2, around=(step,)))
    made = jump.plan(standing, leap(0.5 + inside + 0.14, 0.2, around=(step,)))
    assert soles(made.feet, jump.physique.tables)[:, 2].min() > 0.5


@pytest.mark.parametrize("turn", [-1.5, 0.0, 1.5])
def test_feet_that_still_come_down_are_not_said_to_stand(person, turn):
    """Who leaps out of a walk sets a foot down as he winds up: it slid 15 cm and more while it was said to be on the floor."""
    state, jumps = person.start(), 0
    for _ in range(90):
        state, _ = person.step(state, Intent(np.array([1.2, turn, 0.0])), 1 / FPS)
    wanted, before, slid, high = Leap(ahead(state, 1.0)), None, np.zeros(4), 0.0
    for _ in range(60):
        state, pose = person.step(state, Intent(leap=None if jumps else wanted), 1 / FPS)
        jumps += state.active == "jump"
        if 0 < jumps < 20:
            points = contact_points(person.skeleton, *forward_kinematics(person.skeleton, pose.root, np.asarray(pose.rotations, float)))
            if before is not None:
                both = state.contacts & before[1]
                slid += np.where(both, np.linalg.norm((points - before[0])[:, [0, 2]], axis=-1), 0.0)
                high = max(high, float(((points[:, 1] - contact_height(person.skeleton)) * both).max()))
            before = points, state.contacts
    assert jumps >= 15 and slid.max() < 0.03 and high < 0.03


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.4), (0.0, 0.0, 1.3), (0.8, 0.0, 0.0), (0.0, 0.0, -0.6)])
def test_the_ground_of_who_lands_leads_on_into_that_of_who_stands(person, place):
    """`ground` is what a game follows: the walk that takes over has it where the jump left it."""
    state, grounds = person.start(), []
    for n in range(400):
        state, _ = person.step(state, Intent(leap=Leap(place) if n == 30 else None), 1 / 60)
        grounds.append((state.active, *state.ground))
    active, ground = [name for name, *_ in grounds], np.array([where for _, *where in grounds])
    over = next(n for n in range(1, 400) if active[n - 1] == "jump" != active[n])
    assert np.hypot(*(ground[over] - ground[over - 1])[:2]) < 0.012
    assert np.linalg.norm(ground[-1, :2] - np.array(place)[[0, 2]]) < 0.08
