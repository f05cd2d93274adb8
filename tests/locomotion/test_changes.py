"""Changes of speed, way and gait: a body's mass is never thrown about, and its feet go along."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import anatomy, centre_of_mass, contact_points, feet_apart, forward_kinematics, rotations as rot
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import HIPS, LABELS, Locomotion, Settings, fourier
from gambol.controllers.locomotion.command import BRAKES
from gambol.controllers.locomotion.memory import RUN
from playing import FPS, hold, mean_velocity, play, whims


def changed(locomotion, before, after, seconds=2.5, phases=12):
    """The motion of `phases` characters in steady gait who are asked for something else at as many moments of it."""
    start = np.linspace(3.0, 4.2, phases)
    wish = np.zeros((round((4.2 + seconds) * FPS), phases, 3))
    for n, time in enumerate(start):
        wish[:, n] = before
        wish[round(time * FPS):, n] = after
    return play(locomotion, wish), (start * FPS).astype(int)


def mass_centre(locomotion, motion):
    """Velocity (T, N, 3) [m/s] and acceleration (T, N, 3) [m/s²] of the mass centre, over frames 1/30 s apart."""
    com = centre_of_mass(anatomy(locomotion.skeleton), motion.positions, motion.orientations)
    pad = ((2, 2), (0, 0), (0, 0))
    return (np.pad((com[4:] - com[:-4]) * (FPS / 4), pad, "edge"),
            np.pad((com[4:] - 2 * com[2:-2] + com[:-4]) * (FPS / 2) ** 2, pad, "edge"))


def test_letting_go_of_the_run_key_throws_nobody_back(locomotion):
    motion, asked = changed(locomotion, (2.8, 0, 0), (1.3, 0, 0))
    velocity, acceleration = mass_centre(locomotion, motion)
    peaks = [np.linalg.norm(acceleration[frame:, n][:, [0, 2]], axis=-1).max() for n, frame in enumerate(asked)]
    assert np.median(peaks) < 6.5 and max(peaks) < 8.5
    for n, frame in enumerate(asked):
        assert velocity[frame:, n, 2].min() > 1.0
        assert np.abs(velocity[-40:, n, 2].mean() - 1.3) < 0.1


def test_a_runner_who_stops_does_not_run_backwards(locomotion):
    motion, asked = changed(locomotion, (3.0, 0, 0), (0, 0, 0))
    velocity, acceleration = mass_centre(locomotion, motion)
    peaks = [np.linalg.norm(acceleration[frame:, n][:, [0, 2]], axis=-1).max() for n, frame in enumerate(asked)]
    assert np.median(peaks) < 8.0 and max(peaks) < 9.0
    for n, frame in enumerate(asked):
        assert velocity[frame:, n, 2].min() > -0.12
        assert np.abs(velocity[frame + round(1.6 * FPS):, n]).max() < 0.3
        assert motion.ground[-1, n, 1] - motion.ground[frame, n, 1] < 2.15


def test_a_quick_walker_who_goes_back_is_not_thrown(library):
    """A foot that tore loose just after it had come down was to be there at once, and then went metres past it: the leg threw the body about at 50 m/s²."""
    quick = Locomotion(library, Settings(agility=2.0, idle=0.0))
    motion, asked = changed(quick, (1.3, 0, 0), (-0.6, 0, 0))
    _, acceleration = mass_centre(quick, motion)
    assert max(np.linalg.norm(acceleration[frame:, n][:, [0, 2]], axis=-1).max() for n, frame in enumerate(asked)) < 15.0
    offsets = np.array([s.memory["offset"][..., :2] for s in motion.states])
    assert np.linalg.norm(offsets, axis=-1).max() < 1.0


def test_a_runner_speeds_up_about_as_soon_as_a_walker(locomotion):
    """Though he pushes only while a foot stands."""
    taken = []
    for before, after in (((0.3, 0, 0), (1.3, 0, 0)), ((2.0, 0, 0), (3.0, 0, 0))):
        motion, asked = changed(locomotion, before, after)
        speed = np.array([s.velocity[:, 0] for s in motion.states])
        taken.append(np.mean([(speed[frame:, n] > after[0] - 0.1).argmax() / FPS for n, frame in enumerate(asked)]))
    assert taken[1] < taken[0] + 0.2, taken


def test_a_careful_runner_stops_without_a_step_back_and_a_quick_one_sooner(library):
    """Where a stop ends is planned with what these legs push, at any agility."""
    rests = []
    for agility in (0.6, 1.0, 2.0):
        walker = Locomotion(library, Settings(agility=agility))
        motion, asked = changed(walker, (3.0, 0, 0), (0, 0, 0))
        velocity, _ = mass_centre(walker, motion)
        assert min(velocity[frame:, n, 2].min() for n, frame in enumerate(asked)) > -0.12
        speed = np.linalg.norm(velocity[..., [0, 2]], axis=-1)
        rests.append(np.mean([np.flatnonzero(speed[frame:, n] > 0.15)[-1] / FPS for n, frame in enumerate(asked)]))
    assert rests[0] > rests[1] + 0.3 and rests[1] > rests[2] + 0.15


def test_a_runner_told_to_turn_on_the_spot_brakes_first(locomotion):
    motion, asked = changed(locomotion, (3.5, 0, 0), (0, 1.5, 0))
    for n, frame in enumerate(asked):
        velocity = np.array([s.velocity[n] for s in motion.states[frame:]])
        assert np.abs(velocity[velocity[:, 0] > 2.3, 1]).max() < 0.2
        assert velocity[-1, 1] == pytest.approx(1.5, abs=0.05) and abs(velocity[-1, 0]) < 0.1
    assert feet_apart(locomotion.skeleton, motion.positions, motion.orientations)[asked.min():].min() > 0.06


def test_a_foot_about_to_land_is_not_sent_elsewhere(locomotion):
    """Who goes on in the very last moment of a stop has a foot on its way beside the other: it lands there, rather than whip to where it would be now."""
    strides = 40
    wish = np.tile([1.3, 0, 0], (round(4.5 * FPS), strides, 1)).astype(float)
    wish[2 * FPS:] = 0.0
    for n in range(strides):
        wish[2 * FPS + n + 10:, n] = 1.0, -1.3, 0.0
    motion = play(locomotion, wish)
    second = motion.positions[4:] - 2.0 * motion.positions[2:-2] + motion.positions[:-4]
    feet = [locomotion.skeleton.index(name) for name in ("LeftFoot", "RightFoot")]
    over = np.linalg.norm(second * (FPS / 2) ** 2, axis=-1)[2 * FPS:, :, feet] / locomotion.library.accelerations["walk"][feet]
    assert over.max() < 4.0


def test_who_starts_leans_into_it_no_harder_than_legs_push(locomotion):
    motion = play(locomotion, np.concatenate([hold(1, (0, 0, 0)), hold(2, (1.3, 0, 0))]))
    velocity, acceleration = mass_centre(locomotion, motion)
    assert 0.3 < np.argmax(velocity[60:, 0, 2] > 0.9 * 1.3) / FPS < 0.65
    assert np.linalg.norm(acceleration[60:100, 0][:, [0, 2]], axis=-1).max() < 5.0


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from((0.6, 1.0, 2.0)))
def test_no_wish_is_taken_up_harder_than_legs_push_and_none_in_flight(library, seed, agility):
    """Whatever hands do: the speed changes by no more than the acceleration allows, or the share more with which a runner brakes where his step drives him on, and not while no foot stands."""
    limits = Settings(agility=agility)
    motion = play(Locomotion(library, limits), whims(np.random.default_rng(seed), 4.0, 2))
    command = np.array([s.memory["command"] for s in motion.states])
    step = np.diff(command, axis=0) * FPS
    flat, runs = np.hypot(step[..., 0], step[..., 2]), np.array([s.memory["family"] == RUN for s in motion.states])
    assert np.all(flat < limits.acceleration * agility * np.where((runs[1:] | runs[:-1]) & (np.diff(command[..., 0], axis=0) < 0.0), 1.0 + BRAKES, 1.0) * 1.001)
    assert np.abs(step[..., 1]).max() < 4.0 * limits.acceleration * agility * 1.001
    flying = np.array([s.memory["grip"].sum(-1) == 0.0 for s in motion.states])[:-1]
    assert np.all(step[flying][..., [0, 2]] == 0.0)


def test_agility_is_how_soon_and_how_hard(library):
    times = []
    for agility in (0.6, 1.0, 2.0):
        walker = Locomotion(library, Settings(agility=agility))
        motion = play(walker, np.concatenate([hold(1, (0, 0, 0)), hold(2, (1.3, 0, 0))]))
        times.append(np.argmax(np.array([s.velocity[0, 0] for s in motion.states]) > 0.9 * 1.3))
    assert times[0] > times[1] > times[2]


@pytest.mark.few(3)
@pytest.mark.parametrize("speed", (0.1, 0.3, 1.0, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.2, 2.6, 3.5, 4.3))
def test_every_speed_is_met(locomotion, speed):
    """Between the fastest walk and the slowest run, too, where nothing was recorded."""
    motion = play(locomotion, hold(7, (speed, 0, 0)))
    assert mean_velocity(motion.ground[240:])[0, 0] == pytest.approx(speed, abs=0.02)


@pytest.mark.few(1)
@pytest.mark.parametrize("rates", ((30, 144), (60, 240)), ids=str)
def test_a_script_ends_where_it_ends_at_any_rate(locomotion, rates):
    ends = []
    for rate in rates:
        state = locomotion.start()
        for wish in ((1.0, 0, 0), (0, 0, 0), (1.3, 0.5, 0), (0, 0, 0)):
            for _ in range(2 * rate):
                state, _ = locomotion.step(state, Intent(np.array(wish, float)), 1 / rate)
        ends.append(state.ground)
    assert np.hypot(*(ends[0] - ends[1])[:2]) < (0.03 if rates[0] == 30 else 0.02)  # where a foot comes down is told to a tick


# from a walk to a run and back

def feet_of(locomotion, family, space, speed, phases):
    """Where heels and balls of a straight gait are (P, 4, 3), by the series themselves."""
    library = locomotion.library
    series = np.tensordot(space.weights(np.array([speed, 0.0, 0.0])), library.coefficients[library.family(family)], 1)
    rows = fourier.evaluate(series, phases)
    local = library.reference @ rot.exp(rows[:, :HIPS].reshape(len(phases), -1, 3))
    return contact_points(library.skeleton, *forward_kinematics(library.skeleton, rows[:, HIPS:LABELS], local))


def test_gaits_change_where_their_feet_are_alike(locomotion):
    """Open phases lead to feet nearer than equal phases do on average, and each foot has its turn."""
    changes = locomotion.tables[5]
    phases = np.arange(64) / 64
    walk = (("walk", locomotion.walk, locomotion.walk.straight()[1]), ("run", locomotion.run, locomotion.run.straight()[0]))
    for family, (own, other) in enumerate((walk, walk[::-1])):
        here, there, equal = feet_of(locomotion, *own, phases), feet_of(locomotion, *other, changes.phase[family]), \
            feet_of(locomotion, *other, phases)
        apart = np.linalg.norm(here - there, axis=-1).mean(-1)
        opened = changes.open[family] == 1
        assert opened[:32].any() and opened[32:].any() and not opened.all()
        assert apart[opened].max() < 0.35
        assert apart[opened].mean() < 0.75 * np.linalg.norm(here - equal, axis=-1).mean()


def test_nobody_changes_gait_elsewhere(locomotion):
    """Families change at open phases only, whatever the hands do: at one that is passed in that step."""
    motion = play(locomotion, whims(np.random.default_rng(3), 20.0, 8))
    family, phase = (np.array([s.memory[name] for s in motion.states]) for name in ("family", "phase"))
    changes, count = locomotion.tables[5], 0
    for n in range(8):
        for frame in np.flatnonzero(np.diff(family[:, n])):
            passed = (phase[frame, n] + np.linspace(0.0, 0.06, 8)) % 1.0
            assert changes.open[family[frame, n], (passed * 64).astype(int)].any()
            count += 1
    assert count > 8


# feet

def test_an_offset_is_gone_when_its_foot_lands(locomotion):
    """Told to turn round in mid-stride, a foot is far off while it stands and where it belongs after a step or two."""
    motion, asked = changed(locomotion, (-0.6, 0, 0), (1.3, 0, 0), seconds=3.0)
    offset = np.array([np.hypot(s.memory["offset"][..., 0], s.memory["offset"][..., 1]) for s in motion.states])
    for n, frame in enumerate(asked):
        assert offset[frame:frame + FPS, n].max() > 0.1
        assert offset[frame + 2 * FPS:, n].max() < 0.06


@pytest.mark.few(2)
@pytest.mark.parametrize("after", ((0, 0, 0.45), (0, 0, -0.45), (0.6, 0, 0.35), (0, 1.5, 0)), ids=str)
def test_legs_do_not_cross_through_each_other(locomotion, after):
    from gambol.controllers.body.contact import feet_apart
    motion, _ = changed(locomotion, (1.3, 0, 0), after)
    apart = feet_apart(locomotion.skeleton, motion.positions, motion.orientations)
    assert apart.min() > 0.015 and np.mean(apart < 0.06) < 0.02


def test_toes_clear_the_floor_in_mid_swing(locomotion):
    """The toe's end, not only heel and ball."""
    from gambol.controllers.body import contact_height, end_positions
    motion = play(locomotion, hold(6, (1.1, 0, 0), (1.3, 0, 0), (1.2, 0.5, 0)))
    ends = end_positions(locomotion.skeleton, motion.positions, motion.orientations)[240:]
    phase = np.array([s.memory["phase"] for s in motion.states])[240:]
    for foot, side in enumerate(("Left", "Right")):
        progress = ((phase - 0.5 * foot) % 1.0) / 0.38
        toe = ends[..., locomotion.skeleton.end_index[side + "Toe"], 1]
        assert toe[(progress > 0.35) & (progress < 0.65)].min() > contact_height(locomotion.skeleton) + 0.008


@pytest.mark.parametrize("after", [(1.3, 1.2, 0), (0.7, 0, 0)])
def test_no_foot_falls_onto_a_height_over_the_floor_as_a_run_becomes_a_walk(locomotion, after):
    """The blend's foot goes under the floor for a while; held up only there, heels and balls stopped in mid-air at up to 175 m/s², and soles were slapped flat."""
    motion, asked = changed(locomotion, (2.8, 0, 0), after)
    high = motion.points[..., 1]
    stopped, low = (high[2:] - 2.0 * high[1:-1] + high[:-2]) * FPS**2, (high[1:-1] > 0.03) & (high[1:-1] < 0.18)
    worst = [np.where(low, stopped, 0.0)[frame:frame + 2 * FPS, n].max() for n, frame in enumerate(asked)]
    assert max(worst) < 115.0 and np.median(worst) < 80.0


@pytest.mark.few(2)
@pytest.mark.parametrize("before, after", [(2.5, 1.3), (2.5, 0.0), (3.0, 1.3)])
def test_no_runner_sinks_as_he_begins_to_walk(locomotion, before, after):
    """His hips go down as a foot of his run comes to bear, and a walk's up: carried on, they went down by 8 cm more than in any stride, into a lunge."""
    motion, asked = changed(locomotion, (before, 0, 0), (after, 0, 0))
    hips = motion.positions[:, :, 0, 1]
    for n, frame in enumerate(asked):
        assert hips[frame:frame + 2 * FPS, n].min() > hips[frame - FPS:frame, n].min() - 0.04


@pytest.mark.few(2)
@pytest.mark.parametrize("before", [2.5, 3.0, 3.5])
def test_feet_of_a_run_that_becomes_a_walk_come_to_stand_evenly(locomotion, before):
    """Just before a strike they still go at 3.5 m/s; they stood within a frame, and on their heels for a fifth of a second."""
    motion, asked = changed(locomotion, (before, 0, 0), (1.3, 0, 0))
    flat = motion.points[..., [0, 2]]
    stopped = np.linalg.norm(flat[2:] - 2.0 * flat[1:-1] + flat[:-2], axis=-1) * FPS**2
    walks = np.array([s.memory["family"] for s in motion.states]) == 0
    on_heel = (np.linalg.norm(np.diff(motion.points[..., ::2, :], axis=0), axis=-1) < 0.005) & (motion.points[1:, :, 1::2, 1] > 0.045)
    longest = 0
    for n, frame in enumerate(asked):
        begins = frame + int(walks[frame:, n].argmax())
        assert np.where(motion.points[1:-1, n, :, 1] < 0.06, stopped[:, n], 0.0)[begins - 1:begins + FPS].max() < 110.0
        for foot in range(2):
            count = np.zeros(FPS + 1, int)
            for k in range(FPS):
                count[k + 1] = (count[k] + 1) * on_heel[begins + k, n, foot]
            longest = max(longest, count.max())
    assert longest < 8


@pytest.mark.few(1)
@pytest.mark.parametrize("wish", [(0, 0, 0.45), (0, 0, -0.45), (0, 1.5, 0), (-0.6, 0, 0), (0, 0, 0)])
def test_nobody_goes_on_running_who_does_not_ask_for_it(locomotion, wish):
    """At whatever moment of a run something slow is asked for, it is walked two seconds later."""
    motion, _ = changed(locomotion, (3.5, 0, 0), wish, 2.5, phases=24)
    assert not motion.states[-1].memory["family"].any()
