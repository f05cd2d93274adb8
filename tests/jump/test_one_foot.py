"""Hops: on both feet, on one, and from foot to foot, off landings that give and push as one spring."""

import numpy as np
import pytest

from gambol.controllers.jump.starting import ready, start_of
from gambol.controllers.body import contact_points, forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap, Unable, but
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.motion.landing import Springy, absorb

FPS = 60


def hopped(person, feet, far, airtimes):
    """The states of somebody who hops onto feet, each so far [m] ahead of the one before and so long [s] in the air, until he stands, and the plans."""
    state, states, plans = person.start(), [], []
    for _ in range(60 * len(feet) + 90):
        memory, leap = state.memory.memory, None
        if isinstance(memory, Jumping) and (not plans or memory.plan is not plans[-1]):
            plans.append(memory.plan)
        n = len(plans)
        if n < len(feet) and (not plans or not isinstance(memory, Jumping) or memory.landed):
            leap = Leap(np.array([0.0, 0.0, far * (n + 1)]), airtimes[n % len(airtimes)], on=feet[n])
        state, _ = person.step(state, Intent(leap=leap), 1 / FPS)
        states.append(state)
    return states, plans


def begins(states, plans):
    return [next(n for n, s in enumerate(states) if isinstance(s.memory.memory, Jumping) and s.memory.memory.plan is plan) - 1 for plan in plans]


def grounded(states, plans):
    """How long [s] feet stand between each hop and the next."""
    begun = begins(states, plans)
    return np.array([(b - a) / FPS + after.take_off - plan.touch_down for a, b, plan, after in zip(begun, begun[1:], plans, plans[1:])])


WAYS = {"on both": (["both"] * 3 + [None], 0.0, [0.4]), "on the left": (["left"] * 3 + [None], 0.0, [0.25]), "ahead on the right": (["right"] * 3 + [None], 0.4, [0.25]),
        "from foot to foot": (["left", "right"] * 2 + [None], 0.6, [0.27]), "skips": (["left", "left", "right", "right", "left", None], 0.4, [0.12, 0.26])}


@pytest.fixture(scope="module", params=WAYS)
def hops(request, person):
    feet, far, airtimes = WAYS[request.param]
    return request.param, feet, far, *hopped(person, feet, far, airtimes)


def test_each_goes_off_from_the_landing_before_within_the_time_that_people_take(hops):
    name, feet, _, states, plans = hops
    assert len(plans) == len(feet)
    on_the_ground = grounded(states, plans)
    assert 0.24 < on_the_ground.min() and on_the_ground.max() < 0.4, "recorded, told from poses, which see 0.04 s more: 0.28 … 0.42 s"


def test_the_feet_that_were_asked_for_stand_and_no_other(hops):
    _, feet, far, states, plans = hops
    for n, (begun, foot, plan) in enumerate(zip(begins(states, plans), feet, plans)):
        down = begun + int(np.ceil(plan.touch_down * FPS)) + 2
        on = states[down].contacts.reshape(2, 2).any(1)
        assert tuple(on) == {"left": (True, False), "right": (False, True)}.get(foot, (True, True))
        landed = plan.feet.mean(0) if foot in (None, "both") else plan.feet[("left", "right").index(foot)]
        assert landed[2] == pytest.approx(far * (n + 1), abs=0.06)  # balls are ahead of the soles' middle


def test_no_foot_sinks_in_or_slides_and_the_body_stands_in_the_end(jump, hops):
    *_, states, plans = hops
    placed = [forward_kinematics(jump.skeleton, s.pose.root.astype(float), s.pose.rotations.astype(float)) for s in states]
    assert min(sole_corners(jump.skeleton, *one)[..., 1].min() for one in placed) > -0.012
    balls = np.array([contact_points(jump.skeleton, *one).reshape(2, 2, 3)[:, 1] for one in placed])
    stands = np.array([s.contacts.reshape(2, 2)[:, 1] for s in states])
    still = stands[1:] & stands[:-1]
    assert (np.linalg.norm(np.diff(balls[..., [0, 2]], axis=0), axis=-1)[still]).max() < 0.02
    assert states[-1].active == "locomotion" and states[-1].contacts.all()


def test_one_leg_gives_as_deep_as_recorded_and_the_other_is_held_up(person, jump):
    states, plans = hopped(person, *WAYS["on the left"])
    low = plans[1].at(plans[1].push_off)
    touched, lowest = plans[0].moving(plans[0].touch_down)[0][1], plans[1].centres[:, 1].min()
    assert 0.12 < touched - lowest < 0.18, "recorded: 0.13 … 0.17 m"
    knees = [np.degrees(np.linalg.norm(np.arccos((np.trace(low.rotations[jump.skeleton.index(side + "Leg")]) - 1.0) / 2.0))) for side in ("Left", "Right")]
    assert 45 < knees[0] < 75 and 95 < knees[1] < 140


@pytest.mark.parametrize("far", [0.0, 0.3])
def test_who_is_not_asked_again_puts_the_other_foot_down_beside_it(person, jump, far):
    states, plans = hopped(person, ["left"], far, [0.25])
    assert len(plans) == 1
    down = int(np.ceil(plans[0].touch_down * FPS))
    on = np.array([s.contacts.reshape(2, 2).any(1) for s in states[down + 1:down + 50]])
    assert on[:, 0].all() and not on[:15, 1].any() and on[30:, 1].all()
    roots = np.array([s.pose.root for s in states[down:]])
    assert np.abs(np.diff(roots, 2, axis=0)).max() < 0.012 and states[-1].active == "locomotion"


@pytest.mark.parametrize("fall, legs", [(0.5, 1), (1.2, 1), (2.0, 2), (3.0, 2)])
def test_a_springy_landing_begins_with_no_force_and_is_lowest_where_it_should_be(fall, legs):
    support = np.array([[x, 0.0, z] for x in (-0.05, 0.05) for z in (-0.1, 0.15)] * legs)
    made = absorb(np.array([0.0, 0.98, 0.0]), np.array([0.0, -fall, 0.0]), np.array([0.0, 0.975, 0.0]), support, 9.81, hops=True)
    assert isinstance(made, Springy)
    times = np.linspace(0.0, 0.4, 4001)
    place, velocity, bent = made.motion(times)
    assert bent[0, 1] == pytest.approx(-9.81) and velocity[0, 1] == pytest.approx(-fall)
    assert np.abs(np.gradient(place[:, 1], times)[1:-1] - velocity[1:-1, 1]).max() < 0.01
    assert times[place[:, 1].argmin()] == pytest.approx(made.down[0], abs=2e-3) and 0.12 < made.down[0] < 0.2
    assert np.abs(np.diff(bent[:, 1])).max() < 1.0, "the force goes on as the body comes up"


def test_what_is_no_foot_and_what_no_leg_can_push_is_refused(jump, standing, person):
    with pytest.raises(Unable, match="'left', 'right' or 'both' to hop on, or None to stand, got 'tail'"):
        jump.plan(standing, Intent(leap=Leap(None, 0.3, on="tail")))  # pyright: ignore[reportArgumentType]
    states, plans = hopped(person, ["left"], 0.0, [0.25])
    down = begins(states, plans)[0] + int(np.ceil((plans[0].touch_down + 0.09) * FPS))
    memory = states[down].memory.memory
    assert memory.rebounds
    with pytest.raises(Unable, match="0.75 s in the air is too long for this body there"):
        jump.plan(but(states[down], memory=memory, previous=states[down - 1].pose, elapsed=1 / FPS), Intent(leap=Leap(np.zeros(3), 0.75)))


def test_nobody_pushes_off_one_foot_that_is_behind_him_already(person):
    """However slowly he walks: the leg in front had to be torn back up in a twentieth of a second, at 540 m/s²."""
    physique, rng, state, seen = person.parts["jump"].physique, np.random.default_rng(0), person.start(), 0
    for n in range(40 * 60):
        if n % 40 == 0:
            wish = np.array([rng.uniform(1.0, 1.5), rng.uniform(-2.0, 2.0), 0.0])
        state, _ = person.step(state, Intent(wish), 1 / 60)
        start = start_of(physique, state)
        if start.single is not None and ready(physique, state):
            seen += 1
            assert (start.centre - start.feet[start.single, :3]) @ (start.velocity * [1.0, 0.0, 1.0]) < 0.0
    assert seen > 20
