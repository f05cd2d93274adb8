"""Who is struck on stairs: he steps as far as legs reach, goes over an edge no faster than he fell, lies on treads, and gets up on them."""

import numpy as np
import pytest

from gambol.controllers.body import centre_of_mass, forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.person import person
from gambol.controllers.struck import DROPS, FALLS, flesh
from gambol.controllers.struck.bending import band_kernel
from gambol.controllers.struck.settled import FIRST, ROUNDS
from gambol.controllers.struck.toppling import settles
from gambol.game.scene import Box

DT, BODY = 1 / 60, Physique()
RISE, GOING, TREADS = 0.16, 0.32, 8
STAIRS = (*(Box((0.0, 0.5 * RISE * (n + 1), GOING * n), (2.4, RISE * (n + 1), GOING)) for n in range(TREADS)),
          Box((0.0, 0.5 * RISE * TREADS, GOING * TREADS + 1.0), (2.4, RISE * TREADS, 2.0 + GOING)))


@pytest.fixture(scope="module")
def somebody():
    return person()


def struck(somebody, gained, aside=0.0, on=4, heading=0.0, seconds=0.0):
    """What becomes of somebody who stands on a tread and is struck, by so much velocity (2,) [m/s], and all his states from then on."""
    state, states, strike = somebody.start((aside, GOING * on - 0.02, heading), RISE * (on + 1)), [], Strike(tuple(BODY.mass * np.array(gained)))
    for _ in range(10):
        state, _ = somebody.step(state, Intent(around=STAIRS), DT)
    made = somebody.parts["struck"].recovery(somebody.active(state)[1], Intent(around=STAIRS), strike)
    for n in range(1 + round(seconds / DT)):
        state, _ = somebody.step(state, Intent(around=STAIRS, strike=None if n else strike), DT)
        states.append(state)
    return made, states


def over(roots, local):
    """How far (N, P) [m] flesh is over the ground beneath it, and how deep (N, P) it is in anything."""
    points, thick = flesh(BODY, *forward_kinematics(BODY.skeleton, roots, local))
    high = np.array([[y - t - floor_at(x, z, STAIRS, y - t + 0.3) for (x, y, z), t in zip(row, thick)] for row in points])
    deep = np.max([(thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])) for thing in STAIRS], 0)
    return high, deep


@pytest.mark.few(2)
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("hard", [0.8, 1.1, 1.4])
def test_who_is_pushed_aside_steps_as_far_as_legs_reach(somebody, side, hard):
    """No foot stands while the body flies away from it: it gains no more speed than by toppling over a leg."""
    for aside in (0.0, 0.5 * side):
        made, _ = struck(somebody, (side * hard, 0.0), aside)
        pace = np.linalg.norm(made.velocities[:, [0, 2]], axis=1)
        assert pace.max() < hard + 1.1


@pytest.mark.few(1)
@pytest.mark.parametrize("gained", [(2.05, -2.16), (-2.05, -2.16), (1.7, -2.4)])
def test_who_falls_down_stairs_has_not_lost_the_floor(somebody, gained):
    """Treads that go down beneath him are no abyss: nothing takes him out of his fall, and he gets up on them. He was taken out and fell on into the stairs."""
    rise, going = 0.1668, 0.3258
    stairs = (*(Box((0.0, 0.5 * rise * (n + 1), going * n), (2.4, rise * (n + 1), going)) for n in range(8)), Box((0.0, 4.0 * rise, 8.0 * going + 1.0), (2.4, 8.0 * rise, 2.0 + going)))
    state, states = somebody.start((0.0, 6.0 * going - 0.02, 0.0), 7.0 * rise), []
    for n in range(30 + round(8.0 / DT)):
        state, _ = somebody.step(state, Intent(around=stairs, strike=Strike(tuple(BODY.mass * np.array(gained))) if n == 30 else None), DT)
        states.append(state)
    assert states[30].memory.memory.made.fate == FALLS and not any(s.active == "jump" for s in states) and states[-1].active == "locomotion"
    x, z, _ = states[-1].ground
    assert abs(float(states[-1].floor) - floor_at(x, z, stairs, float(states[-1].floor) + 0.24)) < 0.2


@pytest.mark.few(1)
@pytest.mark.parametrize("gained", [(2.05, -2.16), (2.27, -0.35)])
def test_nobody_sets_his_feet_home_through_treads(somebody, gained):
    """Who has got up with his feet apart on two treads leaves them there: a foot went 20 cm through the edge between."""
    _, states = struck(somebody, gained, on=6, seconds=7.0)
    _, deep = over(*(np.stack([np.asarray(getattr(s.pose, part), float) for s in states[::2]]) for part in ("root", "rotations")))
    assert states[-1].active == "locomotion" and deep.max() < 0.12


def test_who_goes_over_the_edge_of_stairs_falls_as_gravity_has_it(somebody):
    made, states = struck(somebody, (1.1, 0.0), 0.5, seconds=4.0)
    assert made.fate == DROPS
    air = [n for n, s in enumerate(states) if s.active == "jump" and not s.contacts.any()]
    assert len(air) > 5 and np.array_equal(air, np.arange(air[0], air[-1] + 1))
    at = [states[n] for n in air]
    centre = centre_of_mass(BODY.anatomy, *forward_kinematics(BODY.skeleton, np.stack([np.asarray(s.pose.root, float) for s in at]), np.stack([np.asarray(s.pose.rotations, float) for s in at])))
    assert np.abs(np.diff(centre[:, 1], 2) / DT**2 + 9.81)[2:-2].max() < 1.5
    assert states[-1].active == "locomotion" and states[-1].floor == pytest.approx(floor_at(*states[-1].ground[:2], STAIRS, float(states[-1].floor) + 0.1), abs=0.02)


@pytest.mark.few(2)
@pytest.mark.parametrize(("gained", "heading"), [((0.0, -2.4), 0.0), ((0.4, 2.4), np.pi), ((0.0, -2.6), np.pi), ((-2.2, 0.5), 0.0), ((0.0, 2.2), np.pi)])
def test_who_falls_on_stairs_lies_on_them_and_gets_up_on_treads(somebody, gained, heading):
    """Where he lies some of his trunk lies on a tread or its edge, and none of him is far in one; he floats in no moment, and at the end his soles stand."""
    made, _ = struck(somebody, gained, heading=heading)
    assert made.fate == FALLS
    every = slice(12, None, 4)
    high, deep = over(made.roots[every], made.local[every])
    lies = int(made.centres[every, 1].argmin())
    assert high[lies].min() < 0.02 and np.sort(high[lies])[4] < 0.08
    assert deep.max() < 0.06 and np.median(deep.max(1)) < 0.01
    assert np.percentile(high.min(1), 95) < 0.03
    assert high[-1, -6:].min() < 0.02 and np.abs(made.centres[-1, 1] - made.floors[-1] - 0.95) .max() < 0.15


def test_lying_bends_and_begins_as_he_was_struck(somebody):
    """The first pose is the one as he was struck, and on one level nothing is bent."""
    made, states = struck(somebody, (0.0, -2.4))
    assert made.fate == FALLS and made.roots[0, 1] == pytest.approx(float(states[0].pose.root[1]), abs=0.02)
    level = (Box((0.0, 0.25, 0.0), (9.0, 0.5, 9.0)),)
    state = somebody.start((0.0, 0.0, 0.0), 0.5)
    own = somebody.active(state)[1]
    strike = Strike((0.0, 2.6 * BODY.mass))
    one, other = (somebody.parts["struck"].recovery(own, Intent(around=things), strike) for things in (level, ()))
    assert one.fate == FALLS and np.array_equal(one.local, other.local) and np.allclose(one.roots, other.roots)


@pytest.mark.few(1)
@pytest.mark.parametrize("dt", [1 / 240, 1 / 60, 1 / 30, 0.09, 0.1])
def test_a_fall_is_bent_in_a_few_rounds_a_step_and_what_was_shown_stays(somebody, dt):
    """No step does more than its share of the rounds, and every state is that of the fall as it is in the end."""
    made, states = struck(somebody, (0.4, 2.4), heading=np.pi)
    state, shares = somebody.step(states[0], Intent(around=STAIRS, strike=Strike((0.0, 2.0 * BODY.mass))), dt)[0], []
    whole = settles(state.memory.memory.made, np.inf)
    while state.memory.memory.time < 0.3:
        before = state.memory.memory.made.settling
        state, pose = somebody.step(state, Intent(around=STAIRS), dt)
        memory = state.memory.memory
        after, shown = memory.made.settling, whole.at(memory.time)
        shares.append((ROUNDS if after is None else after.rounds) - before.rounds if before else 0)
        assert np.array_equal(pose.root, shown.root) and np.array_equal(pose.rotations, shown.rotations)
    assert max(shares) <= np.ceil(ROUNDS * dt / FIRST) + 1 and memory.made.settling is None
    assert np.abs(whole.local[12:] - state.memory.memory.made.local[12:]).max() == 0.0 and made.settling is None


@pytest.mark.parametrize("seed", range(3))
def test_the_band_is_solved_as_the_whole_matrix_would_be(seed):
    rng = np.random.default_rng(seed)
    count, wide = 9, 4
    half = rng.normal(size=(count * wide, count * wide))
    whole = half @ half.T + 5.0 * np.eye(count * wide)
    whole[np.abs(np.subtract.outer(np.arange(count * wide), np.arange(count * wide))) > 2 * wide] = 0.0
    whole += np.eye(count * wide) * np.abs(whole).sum(1)  # positive definite
    band = np.array([[whole[i, i - k] if i >= k else 0.0 for k in range(2 * wide, -1, -1)] for i in range(count * wide)])
    right = rng.normal(size=count * wide)
    found = right.copy()
    band_kernel(band, found)
    assert np.allclose(whole @ found, right, atol=1e-9)


@pytest.mark.few(1)
@pytest.mark.parametrize("towards", [0.6, 1.6, -1.2])
@pytest.mark.parametrize("hard", [1.9, 2.2])
def test_who_has_got_up_on_a_platform_sets_his_feet_where_people_stand(somebody, towards, hard):
    """Nobody walks on there by himself, as on a level floor: feet that got up wide apart stayed so for good."""
    stage = Box((0.0, 0.2, 0.0), (2.4, 0.4, 2.4)), Box((0.0, 0.4, 2.0), (2.4, 0.8, 1.6))
    state, states = somebody.start((0.0, 0.0, 0.2), 0.4), []
    for n in range(round(11.0 / DT)):
        strike = Strike((BODY.mass * hard * np.sin(towards), BODY.mass * hard * np.cos(towards))) if n == 10 else None
        state, _ = somebody.step(state, Intent(around=stage, strike=strike), DT)
        states.append(state)
    roots, local = np.stack([s.pose.root for s in states]).astype(float), np.stack([s.pose.rotations for s in states]).astype(float)
    positions, _ = forward_kinematics(BODY.skeleton, roots, local)
    feet = positions[:, [BODY.skeleton.index(side + "Foot") for side in ("Left", "Right")]]
    assert roots[:, 1].min() < 0.75 and state.active == "locomotion", "he fell, and stands"
    assert np.linalg.norm((feet[-1, 0] - feet[-1, 1])[[0, 2]]) < 0.34
    up = next(n for n in range(len(roots) - 1, 0, -1) if roots[n, 1] < 0.4 + 0.8)
    body = [j for j, name in enumerate(BODY.skeleton.names) if not name.endswith("Hand")]  # who stands idles with his hands, at 3 m/s now and then
    assert np.linalg.norm(np.diff(positions[up:, body], axis=0), axis=-1).max() < 3.0 * DT, "nothing jumps as he sets them there"
    assert np.linalg.norm(np.diff(positions[up:], 2, axis=0), axis=-1).max() < 0.03, "nor does a hand"
