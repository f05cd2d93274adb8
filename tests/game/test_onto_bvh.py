"""Motion onto the skeleton of somebody's own motion file: his joints are where ours are, and it stays his skeleton."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from gambol.controllers.body import Clip, Pose, Skeleton, between, exp, forward_kinematics, human, local_rotations
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Library, Locomotion
from gambol.controllers.mocap import MotionFileError, read, write_bvh
from gambol.game import cli
from gambol.game.output import Take, rig_in, write_onto

BONES = {joint: joint.replace("Left", "l_").replace("Right", "r_") for joint in human().names}
UP = between(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))


@pytest.fixture(scope="module")
def walk():
    """Two seconds of a walk that turns, at 30 frames a second."""
    locomotion = Locomotion(Library.load(DEFAULT_LIBRARY))
    state, poses, contacts = locomotion.start(), [], []
    for _ in range(60):
        state, pose = locomotion.step(state, Intent(np.array([1.0, 0.4, 0.0])), 1 / 30)
        poses.append(Pose(np.array(pose.root, float), np.array(pose.rotations, float)))
        contacts.append(state.contacts)
    return Take("Ada", locomotion.skeleton, tuple(poses), np.stack(contacts))


def kinematics(take):
    return forward_kinematics(take.skeleton, np.stack([p.root for p in take.poses]), np.stack([p.rotations for p in take.poses]))


def file_of(path, take, *, names=None, frames=None, axes=np.eye(3), unit=0.01, above=False):
    """A motion file of a take by another program: other names, joints' frames (22, 3, 3), axes, unit, and a joint above the hips."""
    _, turned = kinematics(take)
    skeleton, frames = take.skeleton, np.tile(np.eye(3), (22, 1, 1)) if frames is None else frames
    offsets = skeleton.offsets.copy()
    offsets[1:] = np.einsum("nji,nj->ni", frames[skeleton.parents[1:]], offsets[1:])
    ends = np.einsum("nji,nj->ni", frames[skeleton.end_parents], skeleton.end_offsets)
    local = local_rotations(skeleton, turned @ frames)
    if names is None:
        names = skeleton.names
    root, parents = np.stack([p.root for p in take.poses]), skeleton.parents
    if above:
        names, parents, offsets = ("Reference", *names), np.array([-1, *(parents + 1)]), np.concatenate([np.zeros((1, 3)), offsets])
        local = np.concatenate([np.tile(np.eye(3), (len(root), 1, 1, 1)), local], 1)
        offsets[1], skeleton = 0.0, replace(skeleton, end_parents=skeleton.end_parents + 1)
    own = Skeleton(tuple(names), parents, offsets @ axes.T / unit, skeleton.end_parents, ends @ axes.T / unit)
    quaternions = Rotation.from_matrix((axes @ local @ axes.T).reshape(-1, 3, 3)).as_quat().reshape(*local.shape[:2], 4)
    write_bvh(Clip("x", own, 1 / 30, root @ axes.T / unit, quaternions), path, unit=1.0)
    return path


def apart(clip, take, axes, unit, joints, first=0):
    """How far [m] joints of a raw clip are at most from where a take has them, seen from the hips, which are its first or second joint, and the hips from where they are."""
    at, ours = clip.kinematics()[0][:, first + joints] @ axes * unit, kinematics(take)[0][:, joints]
    return np.abs(at - at[:, :1] - ours + ours[:, :1]).max(), np.abs(at[:, 0] - ours[:, 0]).max()


@pytest.mark.parametrize("axes, unit, above", [(np.eye(3), 0.01, False), (UP, 0.0254, False), (np.eye(3), 1.0, True), (UP, 0.01, True)])
def test_his_joints_are_where_ours_are(walk, tmp_path, axes, unit, above):
    """Of a file whose zero pose is a person standing, up along Y or Z, in any unit, with or without a joint above the hips."""
    mine = file_of(tmp_path / "mine.bvh", walk, names=BONES.values(), axes=axes, unit=unit, above=above)
    out = write_onto(tmp_path / "out.bvh", rig_in(mine), walk, 30.0)
    bones, hips = apart(read(out), walk, axes, unit, np.arange(22), int(above))
    assert bones < 0.02 and hips < 0.03
    own, same = read(mine).skeleton, read(out).skeleton
    assert own.names == same.names and np.allclose(own.offsets[1:], same.offsets[1:], atol=1e-5) and np.allclose(own.end_offsets, same.end_offsets, atol=1e-5)


def test_joints_may_be_turned_anyhow(walk, tmp_path):
    """A zero pose of bones along any axes: how joints stand is told by how they walk, legs better than arms that hang, and whatever their frames are, the same."""
    rng = np.random.default_rng(7)
    found = []
    for _ in range(2):
        mine = file_of(tmp_path / "mine.bvh", walk, frames=exp(1.5 * rng.normal(size=(22, 3))))
        out = read(write_onto(tmp_path / "out.bvh", rig_in(mine), walk, 30.0))
        legs, hips = apart(out, walk, np.eye(3), 0.01, np.array([0, *range(14, 22)]))
        assert apart(out, walk, np.eye(3), 0.01, np.arange(22))[0] < 0.08 and legs < 0.012 and hips < 0.012
        found.append(out.kinematics()[0])
    assert np.abs(found[0] - found[1]).max() < 0.01, "centimetres"


def test_a_smaller_one_goes_as_much_less_far(walk, tmp_path):
    mine = file_of(tmp_path / "mine.bvh", walk, unit=0.0125)  # read as centimetres
    rig = rig_in(mine)
    assert abs(rig.rig.height / 1.741 - 0.8) < 0.02
    out = read(write_onto(tmp_path / "out.bvh", rig, walk, 30.0))
    way = np.linalg.norm((out.root[-1] - out.root[0])[[0, 2]]) / 100.0
    assert abs(way / np.linalg.norm((walk.poses[-1].root - walk.poses[0].root)[[0, 2]]) - 0.8) < 0.02


def test_what_nothing_moves_on_is_told(walk, tmp_path):
    short = replace(walk, poses=walk.poses[:20], contacts=walk.contacts[:20])
    turned = file_of(tmp_path / "short.bvh", short, frames=exp(np.random.default_rng(3).normal(size=(22, 3)) * 1.5))
    strange = file_of(tmp_path / "strange.bvh", short, names=[f"bone{k}" for k in range(22)])
    legless = file_of(tmp_path / "legless.bvh", replace(walk, skeleton=replace(walk.skeleton, offsets=np.where(
        np.arange(22)[:, None] == walk.skeleton.index("LeftLeg"), 0.0, walk.skeleton.offsets))))
    for path, said in ((legless, "LeftUpLeg has no length"), (turned, "zero pose is no person standing, and it moves for 0.67 s only"), (strange, "no foot or ankle")):
        with pytest.raises(MotionFileError, match=f"{path.name}: .*{said}"):
            rig_in(path)


def test_the_command_moves_a_motion_files_skeleton_or_says_why_not(walk, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file_of(tmp_path / "me.bvh", walk, names=BONES.values(), axes=UP)
    (tmp_path / "go.toml").write_text('title = "x"\nduration = 0.3\nfps = 10\n[[actors]]\nname = "A"\n[[actors]]\nname = "B"\nstart = [3, 0, 0]\n')

    def export(*words):
        done = CliRunner().invoke(cli.app, ["export", "go.toml", *words])
        return done.exit_code, done.output
    code, said = export("-o", "out.bvh", "--onto", "me.bvh", "--actor", "B")
    clip = read(tmp_path / "out.bvh")
    assert code == 0 and "out.bvh: 3 frames" in said and abs(clip.root[0, 0] - 300.0) < 10.0 and clip.root[0, 2] > 80.0, "B's motion, up along Z"
    for words, told in ((("-o", "me.bvh", "--onto", "me.bvh"), "would be overwritten"), (("-o", "o.glb", "--onto", "me.bvh"), "ends in .bvh"),
                        (("-o", "o.bvh", "--onto", "none.bvh"), "there is no such file"), (("-o", "o.bvh", "--onto", "go.toml"), "no rig is read from it")):
        code, said = export(*words)
        assert code == 2 and told in said.replace("\n", " "), words
