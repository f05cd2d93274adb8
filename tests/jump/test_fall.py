"""Struck in the air: the hit alone changes the motion, the body comes down on its feet wherever the floor is, and says why."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from conftest import ahead
from gambol.controllers.body import contact_points, end_positions, forward_kinematics, yaw
from gambol.controllers.body.anatomy import centre_of_mass
from gambol.controllers.body.support_polygon import sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump.body import measures, soles
from gambol.controllers.jump.motion import deepest
from gambol.controllers.jump.motion.edges import over_nothing, steps_over
from gambol.controllers.jump.motion.fall import _fallen, fall
from gambol.controllers.jump.motion.hit import Hit, struck
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene.scene import Box, Goal

FPS = 60
HIGH = Box((0.0, 1.5, -1.0), (3.0, 3.0, 2.4))
"""A platform to fall off: its edge lies 0.2 m ahead."""
CASES = {"a wall": (0.0, 0.0, 1.2, (), Box((0.0, 1.4, 0.75), (2.0, 1.0, 0.4)), 0.08),
         "a beam": (0.0, 0.0, 1.2, (), Box((0.0, 0.6, 0.85), (2.0, 0.7, 0.2)), 0.08),
         "a roof": (0.0, 0.0, 0.9, (), Box((0.0, 2.27, 0.4), (2.0, 1.0, 2.0)), 0.0),
         "a wall beyond an edge": (3.0, 1.8, 1.6, (HIGH, Box((0.0, 0.9, 2.0), (3.0, 1.8, 1.6))),
                                   Box((0.0, 4.4, 0.95), (2.0, 1.4, 0.4)), 0.08)}
"""Floors that it leaves and aims at [m], how far, what stands there before, what comes in the way, how long after take-off."""


def played(jump, locomotion, name, wish=np.zeros(3)):
    """States and centres of mass of a jump that something comes in the way of after take-off, and the frame of the hit."""
    floor, goal, far, props, late, when = CASES[name]
    person = Supervisor({"locomotion": locomotion, "jump": jump})
    state = person.start((0.0, 0.0, 0.0), floor)
    leap = Leap(ahead(state, far, goal - floor))
    states, hit = [], None
    for _ in range(280):
        jumps = state.memory.active == "jump"
        now = state.memory.memory
        there = bool(states) and (not jumps or now.hits > 0 or now.time > now.plan.take_off + when)
        asks = not states or not jumps and hit is None
        state, _ = person.step(state, Intent(wish, leap if asks else None, (*props, late) if there else props), 1 / FPS)
        states.append(state)
        if hit is None and state.memory.active == "jump" and state.memory.memory.fault:
            hit = len(states) - 1
    assert hit is not None, "nothing was struck"
    return states, hit


@pytest.fixture(scope="module", params=CASES)
def fallen(request, jump, locomotion):
    """One of CASES, its states and the frame of the hit."""
    return request.param, *played(jump, locomotion, request.param)


def bodies(jump, states):
    """Positions, orientations and centres of mass of states."""
    positions, turned = forward_kinematics(jump.skeleton, np.stack([s.pose.root for s in states]).astype(float),
                                           np.stack([s.pose.rotations for s in states]).astype(float))
    return positions, turned, centre_of_mass(jump.physique.anatomy, positions, turned)


def test_nothing_pops_but_what_the_hit_takes(jump, fallen):
    _, states, hit = fallen
    positions, _, centre = bodies(jump, states)
    velocity = np.diff(centre, axis=0) * FPS
    change = np.diff(velocity, axis=0) - jump.gravity / FPS  # change[k] is at pose k + 1
    down = next(k for k in range(hit, len(states)) if states[k].memory.memory.landed)
    assert np.abs(change[hit - 3:hit - 1]).max() < 0.1 and np.abs(np.delete(change[hit - 1:down - 2], 0, 0)).max() < 0.12
    assert np.linalg.norm(change[hit - 1]) > 0.3
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    assert steps[hit - 1:].max() < 0.22  # hands, 13 m/s
    jerk = np.linalg.norm(np.diff(positions, 2, axis=0), axis=-1)[:, 0]
    assert jerk[hit + 1:].max() < 0.05  # the pelvis, 7 m/s caught on toes, and as it walks on


def test_it_ends_on_its_feet_on_the_floor_below_clear_of_what_it_struck(jump, fallen):
    name, states, _ = fallen
    positions, turned, centre = bodies(jump, states[-1:])
    corners = sole_corners(jump.skeleton, positions, turned)[0]
    assert float(states[-1].floor) == 0.0 and states[-1].contacts.all()
    assert np.abs(corners[:, 1]).max() < 0.02
    assert abs(turned[0, 0, 1, 1]) > 0.95 and centre[0, 1] > 0.9
    for thing in (*CASES[name][3], CASES[name][4]):
        assert gap(positions[0], thing).min() > 0.0


def test_it_says_why_while_it_falls_and_after(fallen):
    _, states, hit = fallen
    assert states[hit - 1].memory.refused == "" and "struck something" in states[hit].memory.memory.fault
    while_falling = [s for s in states[hit + 1:] if s.memory.active == "jump"]
    assert while_falling and all("struck something" in s.memory.refused for s in while_falling)
    first = next(s for s in states[hit:] if s.memory.active == "locomotion")
    assert "struck something" in first.memory.refused and "struck something" in first.memory.why


def test_somebody_who_wants_to_walk_on_gets_up_first(jump, locomotion):
    states, hit = played(jump, locomotion, "a wall", np.array([-0.8, 0.0, 0.0]))
    back = next(k for k in range(hit, len(states)) if states[k].memory.active == "locomotion")
    landed = next(k for k in range(hit, len(states)) if states[k].memory.memory.landed)
    assert back - landed > 0.4 * FPS and states[-1].ground[1] < states[back].ground[1] - 0.3


@pytest.mark.parametrize("fallen", ["a wall beyond an edge"], indirect=True, scope="module")
def test_legs_reach_for_the_floor_and_hold_the_limits(jump, fallen):
    _, states, hit = fallen
    falling = [s for s in states[hit:] if s.memory.active == "jump" and not s.memory.memory.landed]
    assert len(falling) > 0.5 * FPS, "three metres"
    positions, turned, centre = bodies(jump, falling)
    toes = end_positions(jump.skeleton, positions, turned)[-1, [jump.skeleton.end_index[s + "Toe"] for s in ("Left", "Right")]]
    assert toes[:, 1].max() < 0.25 and centre[-1, 1] - toes[:, 1].max() > 0.7
    knees = turned[:, jump.skeleton.index("LeftLeg")], turned[:, jump.skeleton.index("LeftUpLeg")]
    bend = np.arcsin(np.clip(np.einsum("nj,nj->n", knees[1][:, :, 2], knees[0][:, :, 1]), -1.0, 1.0))
    assert bend.min() > -0.02


vectors = st.tuples(*[st.floats(-6.0, 6.0)] * 3).map(np.array)


@given(vectors, vectors)
def test_a_hit_gives_no_energy_and_lets_nobody_further_in(velocity, normal):
    assume(np.linalg.norm(normal) > 0.1)
    normal = normal / np.linalg.norm(normal)
    after = Hit(np.zeros(3), normal).after(velocity)
    assert np.linalg.norm(after) <= np.linalg.norm(velocity) + 1e-12
    assert after @ normal >= min(0.0, velocity @ normal * 0.0) - 1e-12
    if velocity @ normal >= 0.0:
        np.testing.assert_allclose(after, velocity, atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_only_what_it_moves_into_is_struck(jump, standing, x, z):
    wall = Box((0.0, 1.0, 0.6), (4.0, 4.0, 1.2))  # its face passes through the body
    assume(abs(z) > 0.1)
    hit = struck(jump.skeleton, standing.pose, np.array([0.0, 0.9, -0.02]), np.array([x, 0.0, z]), (wall,))
    if z <= 0.0:
        assert hit is None
    elif z > 0.41:
        np.testing.assert_allclose(hit.normal, [0.0, 0.0, -1.0], atol=1e-6)


@pytest.mark.few(2)
@pytest.mark.parametrize(("high", "speed"), [(0.5, 1.2), (1.0, 0.8), (0.5, 2.5)])
def test_who_walks_over_an_edge_falls_and_walks_on(jump, locomotion, high, speed):
    """Its mass centre falls as everything does, it lands on the floor below, and it says why."""
    person = Supervisor({"locomotion": locomotion, "jump": jump})
    state, around = person.start((0.0, 0.0, 1.5), high), (Box((0.0, 0.5 * high, 0.0), (6.0, high, 6.0)),)
    fell, why = [], set()
    for _ in range(440):
        state, pose = person.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        if state.memory.active == "jump" and state.memory.memory.time < state.memory.memory.plan.touch_down:
            fell.append(centre_of_mass(jump.physique.anatomy, *forward_kinematics(
                jump.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))))
            why.add(person.parts["jump"].status(person.active(state)[1]).reason)
    assert len(fell) > 4 and np.abs(np.diff(fell, 2, axis=0)[1:, 1] * FPS**2 + 9.81).max() < 2.0
    assert why == {"there was nothing to step on"}
    assert state.memory.active == "locomotion" and float(state.floor) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.few(2)
@pytest.mark.parametrize(("high", "speed", "begins"), [(0.6, 2.4, 0.6), (0.9, 2.4, 0.0), (0.9, 2.8, 0.15), (0.9, 3.5, 0.75), (1.2, 2.8, 0.3)])
def test_who_runs_off_a_ramps_end_runs_on_as_anywhere(jump, locomotion, high, speed, begins):
    """The foot that leaves as he runs on from the landing is led over what lies before it, not over what lies between it and the world's middle: knees were thrown at 5000 m/s²."""
    person, long = Supervisor({"locomotion": locomotion, "jump": jump}), high / 0.3
    state, around = person.start((0.0, begins, 0.0)), (Box((0.0, 0.5 * high - 0.5, 3.0 + 0.5 * long), (2.0, 1.0, long), 0.0, slope=0.3),)
    poses, fell = [], False
    while not (fell and state.memory.active == "locomotion") or len(poses) < 60:
        assert len(poses) < 480, "it never landed"
        state, pose = person.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        fell |= state.memory.active == "jump"
        poses.append(pose)
    for _ in range(30):
        state, pose = person.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        poses.append(pose)
    joints = forward_kinematics(jump.skeleton, *(np.stack([np.asarray(getattr(pose, part), float) for pose in poses[-60:]]) for part in ("root", "rotations")))[0]
    assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * FPS**2 < 450.0


@pytest.mark.few(2)
@pytest.mark.parametrize(("speed", "high", "shift"), [(0.8, 1.0, 0.6), (1.8, 1.0, 0.3), (1.8, 0.6, 1.2), (2.5, 0.6, 0.1), (2.8, 0.5, 0.0), (3.0, 1.0, 0.3), (4.0, 2.0, 0.75)])
def test_nobody_is_led_down_the_air(jump, locomotion, speed, high, shift):
    """From the moment on at which no foot touches ground any more, whoever came over an edge falls as everything does."""
    person, fps, four = Supervisor({"locomotion": locomotion, "jump": jump}), 120, 4
    state, around = person.start((0.0, -3.0 - shift, 0.0), high), (Box((0.0, 0.5 * high, -10.0), (20.0, high, 20.0)),)
    height, touches, falls = [], [], []
    while not (state.memory.active == "jump" and state.memory.memory.landed):
        assert len(height) < 8 * fps, "it never fell"
        state, pose = person.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / fps)
        placed = forward_kinematics(jump.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))
        corners = sole_corners(jump.skeleton, *placed)
        height.append(centre_of_mass(jump.physique.anatomy, *placed)[1])
        touches.append((corners[:, 1] - np.where(corners[:, 2] < 0.0, high, 0.0)).min() < 0.03)
        falls.append(state.memory.active == "jump")
    last = int(np.flatnonzero(touches[:falls.index(True) + 1])[-1])
    assert falls.index(True) - last <= 0.05 * fps
    flown = np.array(height[last + 1:-1])
    assert np.abs((flown[2 * four:] - 2.0 * flown[four:-four] + flown[:-2 * four]) * (fps / four)**2 + 9.81).max() < 3.0


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 4.0), st.floats(-1.0, 1.0), st.floats(-0.5, 3.0))
def test_who_flies_to_ground_or_touches_it_has_come_over_no_edge(jump, standing, speed, up, edge):
    """In a run's flight nothing touches ground, and all is well as long as something lies under the next step; once nothing does he falls."""
    high, around = 2.0, (Box((0.0, 1.0, edge - 5.0), (20.0, 2.0, 10.0)),)
    assume(abs(edge) > 0.25)
    start = replace(jump.start_of(standing), velocity=np.array([0.0, up, speed]))
    pose = replace(standing.pose, root=np.asarray(standing.pose.root, float) + [0.0, high, 0.0])
    here = replace(start, centre=start.centre + [0.0, high, 0.0])
    if edge > 0.0:
        assert not steps_over(jump.physique, here, pose, around, high, jump.gravity), "it stands"
    flying = replace(pose, root=pose.root + [0.0, 0.1, 0.0])
    lands = here.centre[2] + speed * (up + np.sqrt(up**2 + 2.0 * 9.81 * max(here.centre[1] + 0.1 - high - measures(jump.physique).touch(0.0), 0.0))) / 9.81
    assume(abs(lands - edge) > 1e-3)
    assert steps_over(jump.physique, replace(here, centre=here.centre + [0.0, 0.1, 0.0]), flying, around, high, jump.gravity) == (lands > edge)


def test_a_goal_is_in_nobodys_way_down(jump, locomotion):
    """It has no surface to be pushed out of: whoever falls beside one falls as without."""
    someone = Supervisor({"locomotion": locomotion, "jump": jump})
    top = Box((0.0, 0.3, 0.0), (2.0, 0.6, 2.0))
    ends = []
    for around in ((top,), (top, Goal((0.0, 0.0, 3.0)))):
        state = someone.start((0.0, 0.5, 0.0), 0.6)
        for _ in range(150):
            state, _ = someone.step(state, Intent(np.array([1.3, 0.0, 0.0]), around=around), 1 / 60)
        ends.append(state)
    assert float(ends[0].floor) == 0.0 and np.isfinite(ends[1].pose.root).all()
    assert np.allclose(ends[0].pose.root, ends[1].pose.root)


@given(st.floats(0.0, 3.0), st.floats(0.0, 0.03), st.floats(0.15, 0.5))
def test_feet_that_stand_on_the_floor_are_over_nothing_nowhere(jump, standing, level, near, beyond):
    """However high the floor was from which the body came; higher up they are, if it was a step or more."""
    def over(high):
        root = np.asarray(standing.pose.root, float) + [0.0, high, 0.0]
        return over_nothing(jump.skeleton, replace(standing.pose, root=root), np.ones(4, bool), (), level)
    assert not over(near)
    assert over(beyond) == (max(beyond, level) > 0.33) or 0.28 < max(beyond, level) < 0.4


STAIRS = tuple(Box((0.0, 0.08 * (k + 1), 0.3 * k), (2.0, 0.16 * (k + 1), 0.3)) for k in range(6))


@settings(max_examples=25, deadline=None)
@given(st.floats(-1.3, 1.3), st.floats(0.2, 1.6), st.floats(-3.1, 3.1), st.floats(0.1, 0.5))
def test_soles_come_down_in_no_riser(jump, standing, x, z, heading, high):
    """Whoever falls on stairs, or off their open side, whichever way he heads."""
    start, turn = jump.start_of(standing), yaw(heading)
    moved = np.array([x, floor_at(x, z, STAIRS) + high, z])
    start = replace(start, root=turn @ start.root + moved, centre=turn @ start.centre + moved, heading=heading,
                    rotations=np.concatenate([turn[None] @ start.rotations[:1], start.rotations[1:]]))
    feet = fall(jump.physique, start, None, STAIRS, jump.gravity).feet
    floor = float(feet[0, 1]) - jump.physique.tables.sole
    assert max(floor_at(a, b, STAIRS, floor + 0.3) for a, _, b in soles(feet, jump.physique.tables)) < floor + 0.02


LEAVES = {"backward": (np.pi, (-0.5, 0.0, 0.0)), "aside": (-0.5 * np.pi, (0.0, 0.0, 0.5)), "slowly ahead": (0.0, (0.4, 0.0, 0.0)), "turning": (0.0, (0.5, 1.2, 0.0))}


@pytest.mark.few(2)
@pytest.mark.parametrize("high", (0.5, 0.8, 1.2))
@pytest.mark.parametrize("name", LEAVES)
def test_who_steps_off_an_edge_lands_clear_of_it_however_he_faces(jump, locomotion, name, high):
    """Knees of who came off facing it were 20 cm in what he stepped off as he sank, and so was the seat of who turned his back."""
    platform, (heading, wish) = Box((0.0, 0.5 * high, 0.0), (2.0, high, 2.0)), LEAVES[name]
    person = Supervisor({"locomotion": locomotion, "jump": jump})
    for nearer in (0.06, 0.24, 0.3):
        state, states = person.start((0.0, 0.45 + nearer, heading), high), []
        for _ in range(4 * FPS):
            fell = any(s.memory.active == "jump" for s in states)
            state, _ = person.step(state, Intent(np.zeros(3) if fell else np.array(wish), around=(platform,)), 1 / FPS)
            states.append(state)
            if fell and all(s.active == "locomotion" for s in states[-FPS // 2:]):
                break
        deep = deepest(jump.physique, np.stack([s.pose.root for s in states]).astype(float), np.stack([s.pose.rotations for s in states]).astype(float), (platform,))
        assert deep.max() < 0.04, (nearer, deep.max())
        assert fell or name == "turning"


@settings(max_examples=20, deadline=None)
@given(st.floats(0.0, 1.0), st.floats(-3.1, 3.1))
def test_a_push_off_an_edge_begins_with_the_speed_that_is_there_and_pushes_along_the_floor_alone(jump, standing, hard, way):
    """Its whole impulse is as told once the foot has left; up and down nothing but gravity is felt."""
    start, push = jump.start_of(standing), hard * np.array([np.sin(way), 0.0, np.cos(way)])
    start = replace(start, centre=start.centre + [0.0, 1.5, 0.0], root=start.root + [0.0, 1.5, 0.0], velocity=np.array([0.3, -0.2, 0.1]))
    made, _ = _fallen(jump.physique, start, None, (), jump.gravity, push, 1.0, None)
    air = made.times < made.touch_down - 1e-9
    np.testing.assert_allclose(made.centres[0], start.centre, atol=1e-12)
    np.testing.assert_allclose(made.velocities[0], start.velocity, atol=1e-12)
    last = np.flatnonzero(air)[-1]
    np.testing.assert_allclose(made.velocities[last] - start.velocity - jump.gravity * made.times[last], push, atol=1e-9)
    middle, step = 0.5 * (made.velocities[1:] + made.velocities[:-1]), np.diff(made.times)[:, None]
    np.testing.assert_allclose((np.diff(made.centres, axis=0) / step)[:last], middle[:last], atol=0.02)
    np.testing.assert_allclose(np.trapezoid(made.forces[air], made.times[air], axis=0), jump.physique.mass * push, atol=1.0)
    np.testing.assert_allclose(made.centres[air, 1], start.centre[1] - 0.2 * made.times[air] + 0.5 * jump.gravity[1] * made.times[air] ** 2, atol=1e-9)


@pytest.mark.few(3)
@pytest.mark.parametrize("high", (0.2, 0.28, 0.299, 0.303, 0.31, 0.33, 0.36))
@pytest.mark.parametrize("speed", (0.7, 1.3))
def test_nobody_walks_on_air_whatever_the_height_of_the_ledge(jump, locomotion, high, speed):
    """What is no step down any more is a fall: between the two heights from which each was said, people walked on as high as they had been."""
    around, person = (Box((0.0, 0.5 * high, -2.0), (3.0, high, 4.0)),), Supervisor({"locomotion": locomotion, "jump": jump})
    state, off = person.start((0.0, -1.0, 0.0), high), 0
    for _ in range(3 * FPS):
        state, _ = person.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        feet = contact_points(jump.skeleton, *forward_kinematics(jump.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float)))
        aloft = min(y - floor_at(x, z, around, y + 0.1) for x, y, z in feet) > 0.1 and state.memory.active == "locomotion"
        off = off + 1 if aloft else 0
        assert off < 8
    assert float(state.floor) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("gives", (0.6, 1.0))
def test_arms_come_to_a_softer_landing_by_and_by(jump, standing, gives):
    """Elbows of who sinks less than usual snapped by 13° in the frame in which he touched down."""
    start = jump.start_of(standing)
    start = replace(start, centre=start.centre + [0.0, 1.0, 0.0], root=start.root + [0.0, 1.0, 0.0], velocity=np.array([0.5, -0.3, 0.0]))
    made, _ = _fallen(jump.physique, start, None, (), jump.gravity, np.zeros(3), gives, None)
    down = int(np.searchsorted(made.times, made.touch_down))
    shown = made.local[down - 4:down + 8]
    for side in ("Left", "Right"):
        elbow = shown[:, jump.skeleton.index(side + "ForeArm")]
        bent = np.degrees(np.arccos(np.clip(0.5 * (np.trace(elbow, axis1=-2, axis2=-1) - 1.0), -1.0, 1.0)))
        assert np.abs(np.diff(bent) / np.diff(made.times[down - 4:down + 8])).max() < 420.0


@pytest.mark.few(2)
@pytest.mark.parametrize("high", [0.15, 0.3])
@pytest.mark.parametrize("speed", [0.6, 10.0])
def test_who_stands_on_what_is_taken_away_comes_down(jump, locomotion, high, speed):
    """Where a step leads down, too: he hung in the air for good."""
    someone = Supervisor({"locomotion": locomotion, "jump": jump})
    state = someone.start((0.0, 0.0, 0.0), high)
    for n in range(240):
        state, _ = someone.step(state, Intent(around=(Box((speed * n / FPS, high / 2, 0.0), (2.0, high, 2.0)),)), 1 / FPS)
    feet = contact_points(jump.skeleton, *forward_kinematics(jump.skeleton, state.pose.root, state.pose.rotations))
    assert float(state.floor) == 0.0 and np.abs(feet[:, 1] - 0.02).max() < 0.01


def test_who_stands_with_one_foot_over_an_edge_stays(jump, locomotion):
    someone = Supervisor({"locomotion": locomotion, "jump": jump})
    for x in (0.0, 0.95):
        state = someone.start((x, 0.0, 0.0), 0.3)
        for _ in range(120):
            state, _ = someone.step(state, Intent(around=(Box((0.0, 0.15, 0.0), (2.0, 0.3, 2.0)),)), 1 / FPS)
        assert state.memory.active == "locomotion" and float(state.floor) == 0.3
