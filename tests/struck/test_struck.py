"""Who is struck: momentum is kept, feet catch the capture point, who can't be caught falls and gets up, and everybody goes back to his wish."""

import numpy as np
import pytest

from gambol.controllers.body import centre_of_mass, contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Leap, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.jump.motion import places
from gambol.controllers.person import person
from gambol.controllers.struck import FALLS, STEPS, SWAYS, Struck

DT = 1 / 60
BODY = Physique()
STILL = np.zeros(3)


@pytest.fixture(scope="module")
def somebody():
    return person()


def after(somebody, wish=STILL, seconds=1.0):
    """The state of somebody who has walked as he wishes for a while."""
    state = somebody.start()
    for _ in range(round(seconds / DT)):
        state, _ = somebody.step(state, Intent(np.asarray(wish, float)), DT)
    return state


def played(somebody, state, impulse, wish=STILL, seconds=3.0):
    """All states from a strike on, the first as it was struck."""
    states = [state]
    for n in range(round(seconds / DT)):
        state, _ = somebody.step(state, Intent(np.asarray(wish, float), strike=Strike(impulse) if n == 0 else None), DT)
        states.append(state)
    return states


def placed(states, body=BODY):
    """Joints' places and turns of states."""
    return forward_kinematics(body.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]),
                              np.stack([np.asarray(s.pose.rotations, float) for s in states]))


def centres(states, body=BODY):
    return centre_of_mass(body.anatomy, *placed(states, body))


def recovery(somebody, state, impulse, wish=STILL):
    own = somebody.active(state)[1]
    return somebody.parts["struck"].recovery(own, Intent(np.asarray(wish, float)), Strike(impulse))


@pytest.mark.parametrize(("wish", "impulse"), [((speed, 0.0, 0.0), impulse) for speed, impulses in (
    (0.0, [(0.0, 22.0), (0.0, 55.0), (30.0, -20.0), (-120.0, 30.0), (0.0, 200.0)]), (1.2, [(0.0, 70.0), (30.0, -65.0), (-120.0, 30.0), (0.0, 200.0)])) for impulse in impulses])
def test_momentum_is_kept_at_the_strike(somebody, impulse, wish):
    """Right after it the mass centre has the velocity that it had, and the impulse over the mass, but for what the floor takes in a sixtieth of a second."""
    state = after(somebody, wish, 1.5)
    before, _ = somebody.step(state, Intent(np.asarray(wish, float)), DT)
    was = (centres([before]) - centres([state]))[0, [0, 2]] / DT
    one, two = centres(played(somebody, state, impulse, wish, 2 * DT)[:2])
    gained = (two - one)[[0, 2]] / DT - was
    kick = np.array(impulse) / BODY.mass
    assert np.linalg.norm(gained - kick) < 0.10 * np.linalg.norm(kick) + 0.06


@pytest.mark.parametrize("way", [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)])
def test_harder_blows_take_more(somebody, way):
    """Who is pushed more and more first sways, then steps, then falls; never the other way round."""
    state = after(somebody)
    fates = [recovery(somebody, state, tuple(hard * np.array(way))).fate for hard in (8.0, 16.0, 28.0, 34.0, 40.0, 46.0, 170.0, 400.0)]
    assert fates == sorted(fates)
    assert fates[0] == SWAYS and STEPS in fates and fates[-1] == FALLS


def test_a_foot_goes_to_the_capture_point(somebody):
    """As it lands, the place over which the body would come to rest, x + v/ω, is over the soles or nearly so."""
    for impulse in ((0.0, 50.0), (0.0, -45.0), (48.0, 0.0)):
        made = recovery(somebody, after(somebody), impulse)
        n = int(np.searchsorted(made.times, made.landings[0, 1]))
        point = made.centres[n] + made.velocities[n] / somebody.parts["struck"].rate
        side = int(made.landings[0, 0])
        foot = contact_points(BODY.skeleton, *forward_kinematics(BODY.skeleton, made.roots[n], made.local[n]))[2 * side:2 * side + 2].mean(0)
        assert np.hypot(*(point - foot)[[0, 2]]) < 0.26  # who crosses over sets it down before the other with room
        before = made.centres[0, [0, 2]]
        assert np.hypot(*(foot[[0, 2]] - before)) > 0.25  # it did go there


@pytest.mark.parametrize("impulse", [(0.0, 20.0), (0.0, 50.0), (0.0, 90.0), (0.0, -45.0), (30.0, 0.0), (-40.0, 10.0)])
def test_a_stumble_ends_at_rest_and_no_foot_slides(somebody, impulse):
    made = recovery(somebody, after(somebody), impulse)
    assert made.fate in (SWAYS, STEPS)
    points = contact_points(BODY.skeleton, *forward_kinematics(BODY.skeleton, made.roots, made.local))
    assert points[..., 1].min() > 0.019  # soles are that thick
    stands = made.contacts[1:] & made.contacts[:-1]
    slides = np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1) / np.diff(made.times)[:, None]
    assert slides[stands].max() < 0.02
    assert np.linalg.norm(made.velocities[-1]) < 0.05 and made.contacts[-1].all()
    assert np.allclose(centre_of_mass(BODY.anatomy, *forward_kinematics(BODY.skeleton, made.roots, made.local)), made.centres, atol=1e-5)


@pytest.mark.few(2)
@pytest.mark.parametrize("impulse", [(0.0, 170.0), (0.0, -140.0), (150.0, 0.0), (-170.0, 60.0)])
def test_who_falls_does_not_go_through_the_floor_and_gets_up(somebody, impulse):
    """In no moment is any bone's flesh below the floor; the body lies, and energy does not come from nothing; it stands at last where it lay."""
    states = played(somebody, after(somebody), impulse, seconds=6.5)
    assert states[1].active == "struck" and "falls" in states[1].memory.memory.made.why
    over = places(BODY, *placed(states))[1]
    assert over.min() > -1e-4
    centre = centres(states)
    low = int(centre[:, 1].argmin())
    assert centre[low, 1] < 0.35
    flow = np.gradient(centre[1:], DT, axis=0)
    energy = 0.5 * (flow**2).sum(1) + 9.81 * centre[1:, 1]
    assert energy[:low].max() < energy[0] + 1.5  # J/kg: recorded people threw themselves down
    assert states[-1].active == "locomotion" and states[-1].contacts.all() and centre[-1, 1] > 0.9
    assert np.hypot(*(centre[-1] - centre[low])[[0, 2]]) < 1.2


@pytest.mark.few(2)
@pytest.mark.parametrize("impulse", [(0.0, 70.0), (0.0, -65.0), (60.0, 0.0), (-120.0, 0.0)])
def test_who_walks_goes_on_walking(somebody, impulse):
    wish = (1.2, 0.0, 0.0)
    states = played(somebody, after(somebody, wish, 1.5), impulse, wish, 8.0)
    assert any(s.active == "struck" for s in states) and states[-1].active == "locomotion"
    assert abs(states[-1].velocity[0] - 1.2) < 0.02 and all(np.isfinite(s.pose.root).all() and np.isfinite(s.pose.rotations).all() for s in states)


@pytest.mark.few(1)
@pytest.mark.parametrize(("speed", "gained"), [(1.2, (0.2, 0.0)), (1.2, (-0.2, 0.1)), (1.2, (0.0, 0.75)), (1.2, (0.0, -0.6)), (1.2, (0.65, 0.0)),
                                               (3.0, (0.4, 0.0)), (3.0, (-0.75, 0.0)), (3.0, (0.0, 1.1)), (3.0, (0.0, -0.55)), (3.0, (0.0, 1.55)),
                                               (3.0, (0.0, -1.35))])
def test_who_walks_or_runs_takes_a_push_in_stride(somebody, speed, gained):
    """His next steps take in what they can: he goes on with v + J/m, is back at his wish within 1.5 s, and no foot slides that stands, whichever does."""
    wish = np.array([speed, 0.0, 0.0])
    for more in (0.0, 0.17, 0.33, 0.5):
        state = after(somebody, wish, 2.0 + more)
        calm, _ = somebody.step(state, Intent(wish), DT)
        states = played(somebody, state, tuple(BODY.mass * np.array(gained)), wish, 1.5)
        assert all(s.active == "locomotion" and s.memory.strike is None for s in states) and states[1].memory.why == "its next steps take in what pushed it"
        kick = (np.asarray(states[1].ground) - calm.ground)[:2] / DT
        assert np.linalg.norm(kick - gained) < 0.1 * np.linalg.norm(gained)
        assert np.abs(np.asarray(states[-1].velocity) - wish).max() < 0.07
        points = contact_points(BODY.skeleton, *placed(states))
        stands = np.stack([s.contacts for s in states])
        slides = np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1)
        slid = np.where(stands[1:] & stands[:-1] & (slides > 0.3 * DT), slides, 0.0)
        assert slid.sum(0).max() < 0.02  # as a foot comes down
        assert points[..., 1].min() > 0.015


@pytest.mark.few(2)
@pytest.mark.parametrize(("speed", "gained"), [(1.2, (0.8, 0.0)), (1.2, (0.0, -0.9)), (1.2, (0.0, 0.9)), (3.0, (1.0, 0.0)), (3.0, (0.0, 1.8)), (3.0, (0.0, -1.5))])
def test_what_is_harder_is_no_longer_taken_in_stride(somebody, speed, gained):
    state = after(somebody, (speed, 0.0, 0.0), 2.0)
    assert played(somebody, state, tuple(BODY.mass * np.array(gained)), (speed, 0.0, 0.0), DT)[-1].active == "struck"


def test_a_child_takes_less_in_stride_and_who_sets_off_none():
    """Speeds grow as the root of a body's size; who shifts his weight to set off, or stops, has no coming step that would take a push in; who takes his first one has."""
    small = person(physique=Physique(25.0, 1.2))
    wish = np.array([1.0, 0.0, 0.0])
    steady, shifting, setting_off = (after(small, wish, seconds) for seconds in (2.0, 0.1, 0.6))
    stopping, _ = small.step(steady, Intent(), DT)
    for state, gained, taken in ((steady, 0.55, True), (steady, 0.62, False), (setting_off, 0.3, True), (shifting, 0.1, False), (stopping, 0.1, False)):
        went, _ = small.step(state, Intent(wish, strike=Strike((25.0 * gained, 0.0))), DT)
        assert (went.active == "locomotion") == taken


def test_who_is_in_the_air_is_struck_once_he_stands(somebody):
    """The strikes are kept, added up, and none is lost."""
    state = after(somebody)
    leap, strikes, kept = Leap(None, airtime=0.4), 0, []
    for _ in range(240):
        aloft = state.active == "jump" and not state.contacts.any()
        hits = aloft and strikes < 2
        strikes += hits
        state, _ = somebody.step(state, Intent(leap=None if strikes or aloft else leap, strike=Strike((0.0, 25.0)) if hits else None), DT)
        kept.append(state.memory.strike)
        if state.active == "struck":
            break
    assert strikes == 2 and state.active == "struck" and state.memory.strike is None
    assert [one.impulse for one in kept if one is not None][0] == (0.0, 25.0) and kept[-2].impulse == (0.0, 50.0)
    assert state.memory.memory.made.velocities[0][2] == pytest.approx(50.0 / BODY.mass, abs=0.15)


@pytest.mark.few(1)
@pytest.mark.parametrize("way", [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)])
@pytest.mark.parametrize("wish", [(0.0, 0.0, 0.0), (1.2, 0.0, 0.0)])
def test_nobody_is_pushed_onto_his_knees(somebody, way, wish):
    """Pushed by what does not make him fall, in any moment of a stride, he stays up: no leg is left so far behind that hips go down to the knees, and no gentle push makes a walker fall."""
    state = after(somebody, wish, 1.5)
    tall = float(BODY.skeleton.offsets[0, 1])
    for _ in range(1 if wish == (0.0, 0.0, 0.0) else 6):
        for hard in (0.5, 0.7, 0.9, 1.3):
            states = played(somebody, state, tuple(BODY.mass * hard * np.array(way)), wish, 1.5)
            falls = any(s.active == "struck" and s.memory.memory.made.fate == FALLS for s in states)
            assert falls or min(float(s.pose.root[1]) for s in states) > 0.465 * tall
            assert not (falls and wish[0] > 0.0 and hard < 0.8)
        for _ in range(6):
            state, _ = somebody.step(state, Intent(np.array(wish)), DT)


def test_who_is_down_is_not_struck_anew(somebody):
    """Pushed as he lies, he goes on getting up; once he is up he is struck like anybody."""
    states = played(somebody, after(somebody), (0.0, 170.0), seconds=1.6)
    lying = states[-1]
    assert lying.memory.memory.made.fate == FALLS and lying.pose.root[1] < 0.4
    struck, _ = somebody.step(lying, Intent(strike=Strike((60.0, 0.0))), DT)
    calm, _ = somebody.step(lying, Intent(), DT)
    assert np.array_equal(struck.pose.root, calm.pose.root) and struck.memory.memory.made is calm.memory.memory.made


def test_it_is_a_function_of_state_and_impulse(somebody):
    state = after(somebody)
    one, other = (played(somebody, state, (10.0, 60.0), seconds=2.0) for _ in range(2))
    assert all(np.array_equal(a.pose.rotations, b.pose.rotations) and np.array_equal(a.pose.root, b.pose.root) for a, b in zip(one, other))


def test_who_stumbles_may_be_struck_again(somebody):
    state = played(somebody, after(somebody), (0.0, 50.0), seconds=0.4)[-1]
    before = state.memory.memory.made.moving(state.memory.memory.time)[1]
    again, _ = somebody.step(state, Intent(strike=Strike((0.0, -60.0))), DT)
    gained = again.memory.memory.made.velocities[0] - before
    assert again.memory.memory.time == pytest.approx(DT) and gained[2] == pytest.approx(-60.0 / BODY.mass, abs=0.1)


@pytest.mark.few(1)
@pytest.mark.parametrize(("physique", "gravity"), [(Physique(25.0, 1.2), 9.81), (Physique(), 1.62), (Physique(110.0, 1.95), 9.81)])
def test_any_body_anywhere(physique, gravity):
    """A child, somebody on the moon and a giant: nothing below the floor, and they stand again."""
    somebody = person(physique=physique, gravity=np.array([0.0, -gravity, 0.0]))
    state = after(somebody, seconds=0.2)
    for speed in (0.5, 2.5):
        states = played(somebody, state, (0.0, speed * physique.mass), seconds=9.0)
        assert states[1].active == "struck" and states[-1].active == "locomotion"
        soles = places(physique, *placed(states, physique))[1][:, -6:]
        assert soles.min() > -0.004 * physique.size


def test_bad_strikes_say_what_would_be_right():
    for impulse, height in (((np.nan, 0.0), None), ((2000.0, 0.0), None), ((1.0,), None), ((1.0, 0.0), -1.0), ((1.0, 0.0), np.nan)):
        with pytest.raises(ValueError, match="N·s|height"):
            Strike(impulse, height)


def test_nobody_is_struck_by_nothing(somebody):
    state = somebody.active(after(somebody))[1]
    struck = Struck()
    assert struck.precondition(state, Intent()) == 0.0
    assert struck.precondition(state, Intent(strike=Strike((0.0, 30.0)))) > 1.0
