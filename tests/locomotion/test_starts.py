"""Setting off from rest: weight goes over first, then a foot leaves, and what recorded starts add ends in the gait."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import anatomy, centre_of_mass, log
from gambol.controllers.body.springs import spring_kernel
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import LibraryError, Library, Locomotion, Settings, Start, first_stride_build
from gambol.controllers.locomotion.cycles import track
from gambol.controllers.locomotion.first_stride import readiness
from playing import FPS, play


def set_off(locomotion, wish, seconds=3.0, before=0.2):
    wishes = np.zeros((round((before + seconds) * FPS), 1, 3))
    wishes[round(before * FPS):] = wish
    return play(locomotion, wishes)


@pytest.mark.parametrize("wish", [(1.3, 0, 0), (2.5, 0, 0), (0, 1.5, 0), (0, -1.5, 0), (-0.6, 0, 0), (0, 0, 0.4)])
def test_both_feet_stand_while_weight_is_shifted_then_one_leaves(locomotion, wish):
    state, stood = locomotion.start(), []
    for _ in range(FPS):
        state, _ = locomotion.step(state, Intent(np.array(wish, float)), 1 / FPS)
        stood.append(state.contacts.reshape(2, 2).any(-1))
    stood = np.array(stood)
    leaves = int((~stood.all(-1)).argmax())
    assert 0.1 * FPS <= leaves <= 0.45 * FPS
    first = int(np.flatnonzero(~stood[leaves])[0])
    assert stood[leaves, 1 - first]
    assert first == (0 if wish[1] > 0 or wish[1] == 0 and wish[2] >= 0 else 1)


def test_readiness_is_how_fast_a_wish_is_taken_up(locomotion):
    """The spring by which a walker takes up a wish to turn has come as far as one that ran by his readiness."""
    state, spent = locomotion.start(), 0.0
    assert locomotion.readiness(state) < 0.5
    for _ in range(FPS // 2):
        spent += locomotion.readiness(state) / FPS
        state, _ = locomotion.step(state, Intent(np.array([0.0, 1.0, 0.0])), 1 / FPS)
        assert state.velocity[1] == pytest.approx(spring_kernel(0.0, 0.0, 1.0, 0.11, spent)[0], abs=0.06)
    crowd = locomotion.start(np.zeros((2, 3)))
    for _ in range(FPS // 2):  # one alone, and each of many, to the bit
        assert readiness(crowd.memory[0]) == readiness(crowd.memory)[0]
        crowd, _ = locomotion.step(crowd, Intent(np.array([0.0, 1.0, 0.0])), 1 / FPS)
    assert locomotion.readiness(state) == 1.0 and locomotion.readiness(locomotion.start(np.zeros((4, 3)))).shape == (4,)


@pytest.mark.parametrize("wish", [(1.3, 0, 0), (0.8, 0, 0), (0, 1.5, 0)])
def test_the_mass_goes_over_to_the_foot_that_stays(locomotion, wish):
    motion = set_off(locomotion.tuned(Settings(idle=0.0)), wish)
    com = centre_of_mass(anatomy(locomotion.skeleton), motion.positions, motion.orientations)[:, 0]
    assert com[int(0.3 * FPS):int(0.8 * FPS), 0].min() < com[0, 0] - 0.01  # that is the right one, at -X


def test_a_start_ends_in_the_gait(locomotion):
    plain = Locomotion(replace(locomotion.library, start=None))
    with_start, without = (set_off(one, (1.2, 0, 0), 4.0) for one in (locomotion, plain))
    apart = np.degrees(np.linalg.norm(log(np.swapaxes(with_start.rotations, -1, -2) @ without.rotations), axis=-1)).max(-1)[:, 0]
    assert apart[int(0.2 * FPS):int(1.2 * FPS)].max() > 2.0  # it is seen
    assert apart[:int(0.2 * FPS)].max() < 1e-6
    assert apart[int(2.2 * FPS):].max() < 0.5


def test_a_start_broken_off_fades(locomotion):
    wishes = np.zeros((2 * FPS, 1, 3))
    wishes[12:18] = (1.3, 0, 0)
    motion = play(locomotion, wishes)
    turn = np.linalg.norm(log(np.swapaxes(motion.rotations[:-1], -1, -2) @ motion.rotations[1:]), axis=-1)
    assert turn.max() * FPS < 12.0  # no joint jumps [rad/s]


def recorded(locomotion, wish):
    """A start of Gambol's own as if it had been recorded."""
    motion = set_off(locomotion.tuned(Settings(idle=0.0, gaze=0.0, breath=0.0)), wish, 3.5, 1.0)
    return track(motion.clip(0, locomotion.skeleton, "ours"))


def test_what_walks_by_the_blend_has_nothing_beyond_it(locomotion, monkeypatch):
    monkeypatch.setattr(first_stride_build, "STEPS", 0.28)  # his first foot is away for 0.29 s, recorded ones for longer
    library = replace(locomotion.library, start=None)
    space = locomotion.walk
    own, = first_stride_build.samples(recorded(Locomotion(library), (0.9, 0, 0)), library, space)
    beyond = np.degrees(own.rows[..., :-3])
    assert np.sqrt((beyond**2).reshape(2, len(beyond[0]), -1, 3).sum(-1).mean(-1)).max() < 6.0  # phases are told by feet, not by labels
    assert abs(own.turn) < 0.1


def test_a_line_through_starts_is_found_again():
    rng = np.random.default_rng(3)
    u = first_stride_build.grid()
    bump = np.exp(-0.5 * ((u - 0.5) / 0.2) ** 2)[:, None]
    straight, turning = rng.normal(size=(2, 1, 9))
    turns = rng.uniform(0.0, 2.0, 12)
    coefficients = first_stride_build.fitted(bump * (straight + turns[:, None, None] * turning), turns)
    ratio = coefficients[0] / np.where(np.abs(straight) > 0.1, straight, np.nan)
    assert np.nanmax(np.abs(ratio - np.nanmean(ratio, 1, keepdims=True))) < 1e-6
    assert np.allclose(coefficients[1] * straight, coefficients[0] * turning, atol=1e-6)
    assert not coefficients[:, :3].any() and not coefficients[:, -3:].any()


def test_steps_out_of_order_and_standing_part_a_walk():
    feet = np.ones((1200, 2), bool)
    for k in range(4):  # four steps, a pause, two more
        feet[200 + 60 * k:240 + 60 * k, k % 2] = False
    for k in range(2):
        feet[800 + 60 * k:840 + 60 * k, k % 2] = False
    runs = list(first_stride_build.strides(feet))
    assert [len(frames) for frames, _ in runs] == [8, 4]
    assert np.allclose(np.diff(runs[0][1])[:4], [0.38, 0.12, 0.38, 0.12])


def test_a_library_keeps_its_start_and_refuses_a_broken_one(locomotion, tmp_path):
    path = tmp_path / "library.npz"
    locomotion.library.save(path)
    start = Library.load(path).start
    assert start is not None and np.array_equal(start.coefficients, locomotion.library.start.coefficients)
    replace(locomotion.library, start=Start(np.zeros((2, 1, 9, 4), np.float32))).save(path)
    with pytest.raises(LibraryError, match="start must be finite"):
        Library.load(path)
