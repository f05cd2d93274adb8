"""Arms of stout bodies are outside of their own trunks and thighs, wherever they swing, and move as smoothly as they did."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from gambol.controllers.body import forward_kinematics, human
from gambol.game.character import Build, tailored
from gambol.game.render import dressed, mannequin, skin, worn
from gambol.game.render.girth import ARMS, arms_out, girth
from gambol.game.scene import Figure

HEAVY = tailored(Build(weight=1.0, hips=1.15))
TRUNK = [skin.STANDARD.index(name) for name in ("Hips", "Spine", "Spine1", "Spine2", "LeftUpLeg", "RightUpLeg")]


def posed(swing: float, down: float = 1.45, bent: float = 0.2) -> tuple[np.ndarray, np.ndarray]:
    """Joints (1, 22, 3) and their turns of somebody whose arms hang down so far from T-pose, swung ahead and behind [rad], elbows bent."""
    skeleton, turns = human(), np.tile(np.eye(3), (22, 1, 1))
    for arm, side in zip(ARMS, (1.0, -1.0)):
        turns[arm[0]] = (Rotation.from_rotvec([-swing, 0.0, 0.0]) * Rotation.from_rotvec([0.0, 0.0, -side * down])).as_matrix()
        turns[arm[1]] = Rotation.from_rotvec([0.0, -side * bent, 0.0]).as_matrix()
    at, turned = forward_kinematics(skeleton, np.array([0.0, 1.0, 0.0]), turns)
    return at[None], turned[None]


def depth(body, at, turned, scale) -> float:
    """How deep [m] skin of forearms and hands lies behind the nearest skin of trunk and thighs, by that one's normal."""
    mesh = body.levels[1]
    motion = skin.motions(at, turned, scale, body.joints)[0]
    placed = skin.skinned(mesh.positions, mesh.joints, mesh.weights, motion, scale[0])
    facing = skin.skinned(mesh.positions + mesh.normals * 0.01, mesh.joints, mesh.weights, motion, scale[0]) - placed
    main = skin.AT[np.take_along_axis(mesh.joints, mesh.weights.argmax(1)[:, None], 1)[:, 0]]
    trunk, arms = np.isin(main, TRUNK), np.isin(main, ARMS[:, 1:])
    far, near = cKDTree(placed[trunk]).query(placed[arms])
    behind = np.sum((placed[arms] - placed[trunk][near]) * facing[trunk][near], 1) < 0.0
    return float(far[behind & (far < 0.15)].max(initial=0.0))


@pytest.mark.parametrize("swing", [-0.2, 0.0, 0.2])
def test_arms_are_out_of_a_stout_body(monkeypatch, swing):
    at, turned = posed(swing)
    now = depth(HEAVY, *worn(HEAVY, at, turned))
    monkeypatch.setattr("gambol.game.render.wear.arms_out", lambda body, at, turned, scale: np.broadcast_to(np.eye(3), (len(at), 2, 3, 3)))
    before = depth(HEAVY, *worn(HEAVY, at, turned))
    assert before > 0.025 and now < 0.01, (before, now)


def test_hands_before_a_belly_come_out_ahead():
    at, turned = posed(0.5, bent=1.9)
    out, _, _ = worn(HEAVY, at, turned)
    belly = HEAVY.levels[0].positions[:, 2].max()
    assert depth(HEAVY, *worn(HEAVY, at, turned)) < 0.02 and out[0, ARMS[:, 2], 2].min() > 0.5 * belly


def test_arms_that_touch_nothing_stay():
    at, turned = posed(0.0, down=0.6)
    assert np.array_equal(arms_out(HEAVY, *worn(HEAVY, at, turned))[0], np.tile(np.eye(3), (2, 1, 1)))


def test_arms_give_way_smoothly():
    """Nowhere in a swing of half a turn do they go much faster than they swing."""
    swings = np.linspace(-1.2, 1.2, 481)
    poses = [posed(swing) for swing in swings]
    at, turned, scale = worn(HEAVY, np.concatenate([p for p, _ in poses]), np.concatenate([t for _, t in poses]))
    step = np.linalg.norm(np.diff(at[:, ARMS[:, 2]], axis=0), axis=-1)
    assert step.max() < 2.0 * np.median(step)


def test_one_is_as_many():
    """Whoever else is drawn changes nothing."""
    poses = [posed(swing) for swing in (-0.5, 0.0, 0.4)]
    together = worn(HEAVY, np.concatenate([p for p, _ in poses]), np.concatenate([t for _, t in poses]))[0]
    assert np.allclose(together, np.concatenate([worn(HEAVY, *pose)[0] for pose in poses]), atol=1e-9)


def test_both_sides_are_alike():
    at, turned, _ = worn(HEAVY, *posed(0.0))
    assert np.allclose(at[0, ARMS[0]] * [-1.0, 1.0, 1.0], at[0, ARMS[1]], atol=0.004)


def test_a_body_without_a_trunk_has_no_girth():
    limbs = [replace(mesh, triangles=mesh.triangles[:0]) for mesh in HEAVY.levels]
    bare = replace(HEAVY, levels=tuple(limbs))
    assert girth(bare) is None
    at, turned = posed(0.0)
    assert np.isfinite(worn(bare, at, turned)[0]).all()


def test_figures_have_the_joints_of_what_they_wear():
    at, turned = posed(0.0)
    plain, stout = Figure(at[0], turned[0]), Figure(at[0], turned[0], body=HEAVY)
    same, other = dressed((plain, stout))
    assert same is plain and np.array_equal(other.positions, worn(HEAVY, at, turned)[0][0])
    assert np.linalg.norm(other.positions[ARMS[0, 2]] - at[0, ARMS[0, 2]]) > 0.03 and dressed((Figure(at[0], turned[0], body=mannequin()),))
