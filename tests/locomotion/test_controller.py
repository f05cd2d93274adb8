"""The controller over the shipped library: a pure function of its state, whatever is asked and wherever."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.ground_frame import compose
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import LibraryError, Locomotion, Settings
from playing import FPS, WISHES, hold, mean_velocity, play, whims

law = settings(max_examples=15, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def bits(state):
    """Everything a state is, as bytes (but for the padding between a record's fields)."""
    return b"".join(np.ascontiguousarray(a).tobytes() for a in (
        state.ground, state.velocity, state.pose.root, state.pose.rotations, state.contacts,
        *(state.memory[name] for name in state.memory.dtype.names)))


def walked(locomotion, seed, seconds=2.0, count=1):
    """States of some characters in the midst of something."""
    return play(locomotion, whims(np.random.default_rng(seed), seconds, count)).states[-1]


# a pure function of its state

def test_the_same_twice_is_the_same_to_the_bit(library, locomotion, whimsical):
    again = play(Locomotion(library), whimsical.wish[:400])
    assert all(bits(a) == bits(b) for a, b in zip(again.states, whimsical.states[:400], strict=True))


def test_a_crowd_is_its_members_to_the_bit(locomotion, whimsical):
    for n in (0, 7):
        alone = play(locomotion, whimsical.wish[:300, n:n + 1])
        np.testing.assert_array_equal(alone.rotations[:, 0], whimsical.rotations[:300, n])
        np.testing.assert_array_equal(alone.root[:, 0], whimsical.root[:300, n])
        assert alone.states[-1].memory[0] == whimsical.states[299].memory[n]


@pytest.mark.parametrize("batch", ((), (1,), (3, 1, 2, 1), (0,)), ids=str)
def test_any_batch_axes(locomotion, batch):
    rng = np.random.default_rng(0)
    ground, wish = rng.normal(size=batch + (3,)), rng.normal(size=batch + (3,))
    state = locomotion.start(ground)
    for _ in range(40):
        state, pose = locomotion.step(state, Intent(wish), 1 / 60)
    joints = len(locomotion.skeleton)
    assert state.ground.shape == state.velocity.shape == pose.root.shape == batch + (3,)
    assert pose.rotations.shape == batch + (joints, 3, 3) and state.contacts.shape == batch + (4,)
    assert state.contacts.dtype == bool and state.pose is pose
    for i in np.ndindex(batch):
        one = locomotion.start(ground[i])
        for _ in range(40):
            one, single = locomotion.step(one, Intent(wish[i]), 1 / 60)
        np.testing.assert_array_equal(pose.rotations[i], single.rotations)
        np.testing.assert_array_equal(pose.root[i], single.root)


def test_one_wish_for_a_whole_crowd(locomotion):
    state = locomotion.start(np.zeros((2, 3, 3)))
    shared, _ = locomotion.step(state, Intent(np.array([1.0, 0.2, 0.0])), 1 / 60)
    each, _ = locomotion.step(state, Intent(np.tile([1.0, 0.2, 0.0], (2, 3, 1))), 1 / 60)
    assert bits(shared) == bits(each)


@law
@given(seeds, st.sampled_from((1, 4)))
def test_a_state_is_never_changed(locomotion, seed, count):
    """Frozen arrays do; states that come out share nothing with those that went in."""
    state = walked(locomotion, seed, 1.0, count)
    for array in (state.memory, state.ground, state.velocity, state.pose.root, state.pose.rotations, state.contacts):
        array.setflags(write=False)
    wish = np.full(3, 0.5)
    wish.setflags(write=False)
    before = bits(state)
    after, _ = locomotion.step(state, Intent(wish), 1 / 60)
    assert bits(state) == before and not np.shares_memory(after.memory, state.memory)
    after.memory["ground"] += 1.0
    assert bits(state) == before


@law
@given(seeds)
def test_rewinding_is_keeping_a_state(locomotion, seed):
    wish = whims(np.random.default_rng(seed), 2.0, 2)
    motion = play(locomotion, wish)
    state = motion.states[59]
    for w in wish[60:]:
        state, _ = locomotion.step(state, Intent(w), 1 / FPS)
    assert bits(state) == bits(motion.states[-1])


# whatever is asked of it

wild = st.one_of(st.floats(allow_nan=True, allow_infinity=True), st.floats(-5, 5), st.sampled_from((np.nan, np.inf, -np.inf, 1e30)))


@settings(max_examples=24, deadline=None)
@given(st.lists(st.tuples(wild, wild, wild, st.integers(1, 60)), min_size=1, max_size=5), st.floats(1e-4, 0.1))
def test_no_wish_makes_a_broken_pose(locomotion, wishes, dt):
    state = locomotion.start()
    for *wish, steps in wishes:
        for _ in range(steps):
            state, pose = locomotion.step(state, Intent(np.array(wish)), dt)
        assert np.isfinite(pose.root).all() and np.isfinite(state.ground).all() and np.isfinite(state.velocity).all()
        np.testing.assert_allclose(pose.rotations @ pose.rotations.swapaxes(-1, -2), np.tile(np.eye(3), (22, 1, 1)), atol=1e-4)
        assert 0.5 < pose.root[1] < 1.2 and np.abs(state.velocity).max() < 15
    for _ in range(160):
        state, pose = locomotion.step(state, Intent(), 0.05)
    assert np.abs(state.velocity).max() < 0.02, "and it can still stop"


@pytest.mark.few(2)
@pytest.mark.parametrize("wish", ((0, 0, 17.0), (-15.0, 0, 0), (20.0, 0, 0)), ids=str)
def test_too_much_is_forgotten_as_soon_as_enough(library, wish):
    """Stopping takes no longer after an absurd wish than after one that could be met."""
    motion = play(Locomotion(library, Settings(idle=0.0)), np.concatenate([hold(5, wish), hold(2.5, (0, 0, 0))]))
    assert np.abs(np.diff(motion.root[-20:], axis=0)).max() * FPS < 0.05


def test_a_wish_that_is_no_number_is_no_wish(locomotion):
    state = walked(locomotion, 3)
    nothing, _ = locomotion.step(state, Intent(np.zeros(3)), 1 / 60)
    for wish in ((np.nan, 0, 0), (1, np.inf, 0), (1, 1, -np.inf)):
        assert bits(locomotion.step(state, Intent(np.array(wish)), 1 / 60)[0]) == bits(nothing)


def test_one_broken_wish_leaves_the_others_alone(locomotion):
    state = walked(locomotion, 3, count=3)
    wish = np.tile([1.0, 0.0, 0.0], (3, 1))
    sound, _ = locomotion.step(state, Intent(wish), 1 / 60)
    wish[1] = np.nan
    spoilt, _ = locomotion.step(state, Intent(wish), 1 / 60)
    np.testing.assert_array_equal(spoilt.pose.rotations[[0, 2]], sound.pose.rotations[[0, 2]])


@pytest.mark.parametrize("dt", (0.0, -1 / 60, 0.1001, np.nan, np.inf))
def test_steps_that_are_none_are_refused(locomotion, dt):
    with pytest.raises(ValueError, match="dt"):
        locomotion.step(locomotion.start(), Intent(), dt)


@pytest.mark.parametrize("ground", ((0.0, 0.0), (np.nan, 0, 0), (0, np.inf, 0), 0.0, np.zeros((3, 2))))
def test_places_that_are_none_are_refused(locomotion, ground):
    with pytest.raises(ValueError, match="ground"):
        locomotion.start(ground)


def test_a_replaced_ground_carries_the_character_there(locomotion):
    """Feet and all: what follows is what would have followed, seen from elsewhere."""
    there = np.array([[3.0, -2.0, 2.0], [-7.0, 1.0, -1.0]])
    for seconds in (0.5, 1.1, 1.7):
        state = walked(locomotion, 4, seconds, 2)
        moved = replace(state, ground=there)
        for _ in range(30):
            was = moved
            state, pose = locomotion.step(state, Intent(np.array([1.0, 0.3, 0])), 1 / 60)
            moved, other = locomotion.step(moved, Intent(np.array([1.0, 0.3, 0])), 1 / 60)
            assert np.abs(moved.ground - was.ground)[..., :2].max() < 0.06
            np.testing.assert_allclose(other.rotations[:, 1:], pose.rotations[:, 1:], atol=1e-4)
            np.testing.assert_allclose(moved.velocity, state.velocity, atol=1e-4)
    for ground in (np.full((2, 3), np.nan), np.zeros(3)):
        with pytest.raises(ValueError, match="ground"):
            locomotion.step(replace(state, ground=ground), Intent(), 1 / 60)


def test_memory_of_another_library_is_refused_or_begun_anew(locomotion):
    library = locomotion.library
    other = Locomotion(replace(library, coefficients=library.coefficients * 0.99))
    state = walked(other, 1)
    assert state.memory.dtype == locomotion.start().memory.dtype, "only the library tells them apart"
    for memory in (state.memory, None):
        with pytest.raises(ValueError, match="enter"):
            locomotion.step(replace(state, memory=memory), Intent(), 1 / 60)
    entered = locomotion.enter(state, Intent())
    np.testing.assert_array_equal(entered.ground, state.ground)
    locomotion.step(entered, Intent(), 1 / 60)


def test_entering_keeps_what_it_knows_and_starts_where_the_character_is(locomotion):
    state = walked(locomotion, 1)
    assert locomotion.enter(state, Intent()) is state
    ground = np.array([3.0, -2.0, 1.0])
    stranger = replace(locomotion.start(ground), memory="another's")
    entered = locomotion.enter(stranger, Intent())
    np.testing.assert_allclose(entered.ground, ground, atol=0.02)
    locomotion.step(entered, Intent(), 1 / 60)
    assert 0 <= locomotion.precondition(state, Intent()) <= 1
    assert locomotion.status(state).kind == "running"


def test_a_library_without_runs_walks_at_any_speed(library):
    walks = library.family("walk")
    keep = replace(library, primitives=tuple(library.primitives[i] for i in walks), velocities=library.velocities[walks],
                   coefficients=library.coefficients[walks], bends={"walk": library.bends["walk"]})
    locomotion = Locomotion(keep)
    assert locomotion.run is None
    motion = play(locomotion, hold(6, (3.0, 0, 0)))
    speed = mean_velocity(motion.ground[-180:])[0]
    assert np.isfinite(motion.root).all() and 1.2 < speed[0] < 2.1


def test_nobody_has_to_have_walked_backward(locomotion, tmp_path):
    """Without backward walking rest lies on the hull's rim: it still walks, and what is missing stays still."""
    library = locomotion.library
    keep = [i for i, v in enumerate(library.velocities) if v[0] >= 0 and library.primitives[i].family != "run"]
    forward = replace(library, primitives=tuple(library.primitives[i] for i in keep), bends={},
                      velocities=library.velocities[keep], coefficients=library.coefficients[keep])
    forward.save(tmp_path / "forward")  # and the name is kept as it was given
    walker = Locomotion.load(tmp_path / "forward")
    motion = play(walker, np.concatenate([hold(4, (1.0, 0, 0)), hold(3, (-1.0, 0, 0))]))
    assert np.mean([s.velocity[..., 0] for s in motion.states[120:240]]) == pytest.approx(1.0, abs=0.1)
    assert np.abs(motion.states[-1].velocity).max() < 0.1
    sideways = replace(forward, velocities=forward.velocities * [1.0, 1.0, 0.0])
    with pytest.raises(LibraryError, match="can't be walked"):
        Locomotion(sideways)


# the same everywhere

@law
@given(seeds, st.floats(-30, 30), st.floats(-30, 30), st.floats(-np.pi, np.pi))
def test_motion_is_the_same_from_every_place_and_in_every_direction(library, seed, x, z, heading):
    """Turning and shifting the start turns and shifts the whole motion, but for how somebody idles who stands there."""
    locomotion = Locomotion(library, Settings(idle=0.0))
    frame = np.array([x, z, heading])
    wish = whims(np.random.default_rng(seed), 3.0, 1)
    here, there = play(locomotion, wish), play(locomotion, wish, frame[None])
    moved = compose(frame, here.root[:, 0][:, [0, 2, 2]] * [1, 1, 0])
    np.testing.assert_allclose(there.root[:, 0][:, [0, 2]], moved[:, :2], atol=1e-3)
    np.testing.assert_allclose(there.root[..., 1], here.root[..., 1], atol=1e-3)
    turn = np.array([[np.cos(heading), 0, np.sin(heading)], [0, 1, 0], [-np.sin(heading), 0, np.cos(heading)]])
    np.testing.assert_allclose(there.rotations[:, 0, 0], turn @ here.rotations[:, 0, 0], atol=5e-3)
    np.testing.assert_allclose(there.rotations[:, 0, 1:], here.rotations[:, 0, 1:], atol=2e-2)
    np.testing.assert_array_equal([s.contacts for s in there.states], [s.contacts for s in here.states])


@pytest.mark.thorough
def test_the_size_of_the_step_does_not_matter(locomotion):
    """From display rate to a thousand a second: the same blend, the same phase, the same place."""
    *ends, finest = [play(locomotion, hold(2.0, *WISHES[::2]).repeat(n, axis=0), dt=1 / (FPS * n)).states[-1].memory for n in (1, 4, 17)]
    for end in ends:
        assert np.abs(end["weights"] - finest["weights"]).max() < 0.08  # of who is still getting faster
        assert np.abs((end["phase"] - finest["phase"] + 0.5) % 1 - 0.5).max() < 0.05
        assert np.abs(end["ground"] - finest["ground"]).max() < 0.05


@pytest.mark.parametrize("name, value", [("breath", np.nan), ("clearance", np.inf), ("agility", 0.0), ("acceleration", -1.0), ("weight_halflife", 0.0)])
def test_settings_that_no_body_moves_by_are_refused(name, value):
    with pytest.raises(ValueError, match=f"{name} must be a finite number"):
        Locomotion.load(settings=Settings()._replace(**{name: value}))


def test_the_shipped_library_is_read_once_for_all_who_walk_by_it_whatever_their_settings(tmp_path):
    one, other = Locomotion.load(), Locomotion.load(settings=Settings(agility=2.0))
    assert one is not other and one.library is other.library and one.tables is other.tables
    assert one.settings == Settings() and other.settings.agility == 2.0
    one.library.save(tmp_path / "own.npz")
    first, again = (Locomotion.load(tmp_path / "own.npz") for _ in range(2))
    assert first.library is not again.library, "a file of one's own may have changed"


def test_wishes_for_another_number_of_bodies_are_refused_with_both_shapes(locomotion):
    with pytest.raises(ValueError, match=r"shape \(7, 3\) for bodies that take \(10, 3\)"):
        locomotion.step(locomotion.start(np.zeros((10, 3))), Intent(np.zeros((7, 3))), 1 / 60)
