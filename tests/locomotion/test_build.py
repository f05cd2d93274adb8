"""From motion to cycles to a library: what the controller plays, cut and built again, is what was played."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from gambol.controllers.body import Clip, exp, human
from gambol.controllers.body.clip import mirror_index
from gambol.controllers.body.rotations import log
from gambol.controllers.locomotion import Library, LibraryError, Locomotion
from gambol.controllers.locomotion.library_build import Source, build_library, gather, mirrored, read_recipe, rest_pose
from gambol.controllers.locomotion.cycles import SAMPLES, cut, track
from gambol.controllers.mocap import write_bvh
from playing import FPS, hold, mean_velocity, play

WALKS = {"slow": (0.5, 0, 0), "forward": (0.9, 0, 0), "brisk": (1.25, 0, 0), "left": (0.9, 0.6, 0), "right": (0.9, -0.6, 0),
         "tight left": (0.5, 1.0, 0), "tight right": (0.5, -1.0, 0), "side left": (0, 0, 0.4), "side right": (0, 0, -0.4),
         "diagonal left": (0.5, 0, 0.35), "diagonal right": (0.5, 0, -0.35), "back": (-0.5, 0, 0), "spin left": (0, 1.2, 0),
         "spin right": (0, -1.2, 0)}
RUNS = {"run": (2.6, 0, 0), "run left": (2.6, 0.4, 0)}


@pytest.fixture(scope="session")
def recorded(locomotion):
    """By name, the clip of each of WALKS and RUNS: standing a second, then six of steady gait; and its velocity."""
    wishes = [*WALKS.values(), *RUNS.values()]
    motion = play(locomotion, np.concatenate([hold(1, *np.zeros((len(wishes), 3))), hold(7, *wishes)]))
    return {name: (motion.clip(n, locomotion.skeleton, name), mean_velocity(motion.ground[3 * FPS:, n]))
            for n, name in enumerate([*WALKS, *RUNS])}


def cycles_of(clip, family):
    """The cycles of a clip once its gait is steady."""
    return [c for c in cut(track(clip), family) if c.start > 2.5]


@pytest.mark.few(3)
@pytest.mark.parametrize("name", [*WALKS, *RUNS])
def test_a_played_gait_is_cut_into_its_own_cycles(recorded, name):
    """Velocity and period come back, told from the poses alone; the ends of a cycle meet."""
    clip, velocity = recorded[name]
    cycles = cycles_of(clip, "run" if name in RUNS else "walk")
    assert len(cycles) >= 2
    found = np.array([c.velocity for c in cycles])
    np.testing.assert_allclose(found.mean(0)[[0, 2]], velocity[[0, 2]], atol=0.04)
    np.testing.assert_allclose(found.mean(0)[1], velocity[1], atol=0.06)
    periods = np.array([c.period for c in cycles])
    assert np.ptp(periods) < 0.06 * periods.mean()
    starts = np.diff([c.start for c in cycles])
    turns = np.round(starts / periods.mean())
    np.testing.assert_allclose(starts, turns * periods.mean(), atol=0.06)
    assert max(c.closure for c in cycles) < np.radians(4.5)


def test_a_cycle_is_what_it_says(recorded):
    for cycle in cycles_of(recorded["forward"][0], "walk"):
        joints = len(human())
        assert cycle.rotations.shape == (SAMPLES, joints, 3, 3) and cycle.hips.shape == (SAMPLES, 3)
        np.testing.assert_allclose(cycle.rotations @ cycle.rotations.swapaxes(-1, -2),
                                   np.broadcast_to(np.eye(3), cycle.rotations.shape), atol=1e-9)
        assert cycle.duration.mean() == pytest.approx(cycle.period, rel=5e-3) and cycle.duration.min() > 0
        assert cycle.labels.min() >= 0 and cycle.labels.max() <= 1
        assert cycle.labels[SAMPLES // 5, :2].max() < 0.5, "the left foot swings first"
        assert cycle.labels[SAMPLES // 5, 2:].max() > 0.5, "while the right one stands"
        assert np.abs(cycle.hips[:, 0]).max() < 0.1 and 0.8 < cycle.hips[:, 1].mean() < 1.05


def test_events_are_aligned_whenever_they_fall(recorded):
    """The same walk, hurrying through a part of each cycle and dawdling through the rest, has the same
    poses at the same phases: other times of the events, and no other cycle."""
    clip, _ = recorded["forward"]
    even = cycles_of(clip, "walk")[0]
    times = np.arange(len(clip)) / FPS
    rhythm = times + 0.07 * even.period * np.sin(2 * np.pi * (times - even.start) / even.period)
    rhythm = np.clip(rhythm, 0, times[-1])
    turned = [Slerp(times, Rotation.from_quat(clip.quaternions[:, j]))(rhythm).as_quat() for j in range(len(clip.skeleton))]
    root = np.stack([np.interp(rhythm, times, x) for x in clip.root.T], -1)
    uneven = cycles_of(replace(clip, root=root, quaternions=np.stack(turned, 1)), "walk")[0]
    assert np.abs(uneven.events - even.events).max() > 0.04
    np.testing.assert_allclose(uneven.velocity, even.velocity, atol=0.03)

    def apart(a, b):
        return np.sqrt(np.mean(np.sum(log(a.swapaxes(-1, -2) @ b)**2, -1)))
    shifted = np.roll(even.rotations, round(0.07 * SAMPLES), axis=0)
    assert apart(uneven.rotations, even.rotations) < 0.35 * apart(shifted, even.rotations)
    assert np.ptp(uneven.duration) > 0.2 * uneven.period, "and the series knows where it hurries"


def test_standing_still_is_no_gait(locomotion):
    clip = play(locomotion, hold(4, (0, 0, 0))).clip(0, locomotion.skeleton, "standing")
    assert cut(track(clip), "walk") == [] and cut(track(clip), "run") == []


@pytest.mark.parametrize("name, family", (("forward", "walk"), ("left", "walk"), ("side left", "walk"), ("run left", "run")))
def test_mirroring_twice_changes_nothing(recorded, name, family):
    swap = mirror_index(human())
    for cycle in cycles_of(recorded[name][0], family):
        twice = mirrored(mirrored(cycle, swap), swap)
        for field in ("velocity", "rotations", "hips", "labels", "duration"):
            np.testing.assert_allclose(getattr(twice, field), getattr(cycle, field), atol=1e-12)
        assert twice.period == cycle.period


@pytest.mark.few(2)
@pytest.mark.parametrize("name, family", (("forward", "walk"), ("left", "walk"), ("diagonal left", "walk"), ("run left", "run")))
def test_a_mirrored_cycle_is_a_cycle_of_the_mirrored_clip(recorded, name, family):
    """Mirrored before cutting or after, the same: pose by pose, at the same phases."""
    clip, _ = recorded[name]
    swap = mirror_index(human())
    after = mirrored(cycles_of(clip, family)[0], swap)
    before = cycles_of(clip.mirror(), family)[0]
    np.testing.assert_allclose(after.velocity, before.velocity, atol=0.03)
    apart = log(after.rotations.swapaxes(-1, -2) @ before.rotations)
    assert np.sqrt(np.mean(np.sum(apart**2, -1))) < np.radians(4)
    np.testing.assert_allclose(after.hips, before.hips, atol=0.03)
    assert np.mean(np.abs(after.labels - before.labels)) < 0.08


# the whole way: files in, library out

@pytest.fixture(scope="session")
def folder(recorded, tmp_path_factory):
    """Somebody's own clips, and among them one that is broken and one that is no motion."""
    home = tmp_path_factory.mktemp("clips")
    for kind, names in (("walks", WALKS), ("runs", RUNS)):
        (home / kind).mkdir()
        for name in names:
            write_bvh(recorded[name][0], home / kind / f"{name}.bvh")
    text = (home / "walks" / "slow.bvh").read_text()
    (home / "walks" / "broken.bvh").write_text(text[:len(text) // 2])
    legless = recorded["slow"][0].skeleton.offsets.copy()
    legless[human().index("LeftLeg")] = 0.0
    write_bvh(replace(recorded["slow"][0], skeleton=replace(human(), offsets=legless)), home / "walks" / "legless.bvh")
    (home / "walks" / "notes.txt").write_text("not a motion")
    (home / "recipe.toml").write_text(
        'provenance = "played by Gambol"\n[[source]]\nglob = "walks/*.bvh"\nfamilies = ["walk"]\nskip = ["spin*"]\n'
        '[[source]]\nglob = "runs/*.bvh"\nfamilies = ["run"]\nrank = 0.2\nrest = false\n')
    return home


@pytest.fixture(scope="session")
def built(folder):
    """A library of that folder by its recipe, the notes, and what was told on the way."""
    told = []
    library, notes = build_library(folder, folder / "recipe.toml", lambda *step: told.append(step))
    return library, notes, told


def test_a_folder_becomes_a_library(built, tmp_path):
    library, _, told = built
    families = {p.family for p in library.primitives}
    assert families == {"walk", "run", "rest"} and len(library.family("walk")) > 8
    assert library.provenance == "played by Gambol"
    assert "walk" in library.bends and {"walk", "run"} == set(library.accelerations)
    assert np.all(library.velocities[library.rest] == 0)
    library.save(tmp_path / "own.npz")
    assert Library.load(tmp_path / "own.npz").primitives == library.primitives
    for what in {t[0] for t in told}:
        done = [(n, of) for w, n, of in told if w == what]
        assert all(0 <= n <= of for n, of in done) and [n for n, _ in done] == sorted(n for n, _ in done)


def test_every_primitive_knows_its_clip(built, recorded):
    library, _, _ = built
    for p in library.primitives:
        assert p.clip in recorded and not p.clip.startswith("spin"), "what the recipe skips is left out"
        assert 0 <= p.start < recorded[p.clip][0].duration
        assert (p.clip in RUNS) == (p.family == "run")


def test_a_broken_file_is_noted_and_not_fatal(built):
    _, notes, _ = built
    assert len([n for n in notes if "broken.bvh" in n]) == 1
    assert not any("notes.txt" in n for n in notes)
    assert len([n for n in notes if "legless" in n and "LeftUpLeg has no length" in n]) == 1


def test_what_is_missing_is_said(built):
    """Nobody turned on the spot in the clips that the recipe takes."""
    assert any(re.fullmatch(r"no cycle for radius 0 left .* rad/s", n) for n in built[1])
    assert not any("radius inf normal" in n for n in built[1])


def test_primitives_move_as_they_were_recorded(built, recorded):
    """Each one's own velocity in the library is near the recorded one of its clip."""
    library, _, _ = built
    flip = np.array([1, -1, -1])
    for p, velocity in zip(library.primitives, library.velocities):
        if p.family == "walk" and p.start > 2.5:
            wanted = recorded[p.clip][1] * (flip if p.mirrored else 1)
            assert np.linalg.norm((velocity - wanted) / [0.54, 0.99, 0.25]) < 0.4, (p.clip, velocity, wanted)


def test_the_built_library_walks_as_it_is_asked(built):
    own = Locomotion(built[0])
    wishes = np.array([(0.8, 0, 0), (0.8, 0.3, 0), (0.3, 0, 0.2), (1.1, 0, 0)])
    motion = play(own, hold(12, *wishes))
    for n, wish in enumerate(wishes):
        np.testing.assert_allclose(mean_velocity(motion.ground[240:, n]), wish, atol=0.08)
    still = play(own, hold(3, (0, 0, 0)))
    assert np.ptp(still.points[20:], axis=0).max() < 5e-4, "and stands still"


# what can't be built

def test_an_empty_folder_is_refused_by_name(tmp_path):
    with pytest.raises(LibraryError, match=re.escape(str(tmp_path)) + ".*no .bvh or .amc"):
        build_library(tmp_path)
    with pytest.raises(LibraryError, match="no such folder"):
        build_library(tmp_path / "nowhere")


def test_too_little_motion_is_refused_with_what_is_wanted(recorded, tmp_path):
    write_bvh(recorded["forward"][0].slice(0, 240), tmp_path / "forward.bvh")
    with pytest.raises(LibraryError, match=r"usable walking cycles.*several directions"):
        build_library(tmp_path)


def test_nothing_but_broken_files_is_refused(tmp_path):
    (tmp_path / "broken.bvh").write_text("HIERARCHY\nnonsense")
    with pytest.raises(LibraryError, match="0 usable walking cycles"):
        build_library(tmp_path)


@pytest.mark.parametrize("text", (
    "", "provenance = 'nothing else'", "[[source]]\ncolour = 'red'", "[[source", "\xff", "[source]\nglob = '*.bvh'",
    "source = ['*.bvh']", "provenance = 3\n[[source]]\nglob = '*.bvh'\nfamilies = ['walk']"))
def test_a_recipe_that_is_none_is_refused_by_name(text, tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(LibraryError, match=re.escape(str(path))):
        read_recipe(path)
    with pytest.raises(LibraryError, match="none.toml"):
        read_recipe(tmp_path / "none.toml")


def test_a_recipe_is_read_as_written(folder):
    sources, provenance = read_recipe(folder / "recipe.toml")
    assert provenance == "played by Gambol"
    assert sources == [Source("walks/*.bvh", ("walk",), ("spin*",)), Source("runs/*.bvh", ("run",), rank=0.2, rest=False)]


def test_recorded_walking_is_cut(shared):
    """Two clips of a real actor: cycles at the speed at which the hips cross the floor."""
    home = shared / "mocap" / "woody2"
    names = sorted(p.name for p in home.glob("*.bvh") if re.search(r"walk", p.name, re.I))[:2]
    if not names:
        pytest.skip("no walks in woody2")
    tracks, problems = gather(home, [Source(name, ("walk",)) for name in names])
    assert not problems and len(tracks) == len(names)
    for one, _, _ in tracks:
        cycles = [c for c in cut(one, "walk") if c.closure < np.radians(9)]
        for cycle in cycles:
            a, b = round(cycle.start * 120), round((cycle.start + cycle.period) * 120)
            path = one.clip.root[a:b + 1][:, [0, 2]]
            direct = np.linalg.norm(path[-1] - path[0]) / cycle.period
            speed = np.hypot(cycle.velocity[0], cycle.velocity[2])
            half = 0.5 * cycle.velocity[1] * cycle.period
            assert speed * abs(np.sinc(half / np.pi)) == pytest.approx(direct, abs=0.12), "the chord of its arc"
    assert any(cut(one, "walk") for one, _, _ in tracks)


@pytest.mark.parametrize("lowered, wins", [(1.3, True), (0.9, True), (0.3, False)])
def test_nobody_rests_in_a_t_pose_if_there_is_anything_else(lowered, wins):
    """Though it is nearer to the mean of walking here, and somebody stands lower beside it; of T-poses alone the best is taken."""
    skeleton, turns = human(), np.tile(np.eye(3), (120, len(human()), 1, 1))
    arms = turns.copy()
    for side, way in (("Left", -1.0), ("Right", 1.0)):
        arms[:, skeleton.index(side + "Arm")] = exp(np.array([0.0, 0.0, way * lowered]))
    root = np.tile(skeleton.offsets[0], (120, 1))
    tracks = [track(Clip(name, skeleton, 1 / 60, root - [0.0, down, 0.0], Rotation.from_matrix(some.reshape(-1, 3, 3)).as_quat().reshape(120, -1, 4))) for name, some, down in (("t", turns, 0.0), ("stands", arms, 0.01))]
    assert rest_pose(tracks, turns[0])[1] == ("stands" if wins else "t")
    assert rest_pose(tracks[:1], turns[0])[1] == "t"


def test_a_report_says_of_a_library_that_it_hardly_walks(locomotion):
    from gambol.controllers.locomotion.coverage import report

    whole = locomotion.library
    slow = [n for n, one in enumerate(whole.primitives) if one.family == "rest" or one.family == "walk" and abs(whole.velocities[n, 0]) < 0.5
            and abs(whole.velocities[n, 1]) < 0.6]
    shuffle = replace(whole, primitives=tuple(whole.primitives[n] for n in slow), velocities=whole.velocities[slow], coefficients=whole.coefficients[slow])
    assert not any("hardly walks" in line for line in report(whole))
    assert any("hardly walks" in line for line in report(shuffle))
