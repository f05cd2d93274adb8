"""Other people's characters, made from ours: other names, poses, units, axes and proportions."""

import sys
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[1] / "render"))

from poses import figure  # noqa: E402

from gambol.game.character.write import FLOAT, UBYTE, USHORT, Glb  # noqa: E402
from gambol.game.render import skin  # noqa: E402
from gambol.game.render.mesh import mannequin  # noqa: E402

A_POSE = dict(LeftArm=(0, 0, -50), RightArm=(0, 0, 50), LeftUpLeg=(0, 0, 6), RightUpLeg=(0, 0, -6),
              LeftFoot=(0, 0, -6), RightFoot=(0, 0, 6))
_SHORT = {"UpLeg": "Thigh", "Leg": "Shin", "Foot": "Foot", "Toe": "Toe", "Shoulder": "Clavicle", "Arm": "UpperArm",
          "ForeArm": "ForeArm", "Hand": "Hand"}


def mixamo(name):
    return f"mixamorig:{name.replace('Toe', 'ToeBase')}"


def vrm(name):
    parts = {"UpLeg": "UpperLeg", "Leg": "LowerLeg", "Arm": "UpperArm", "ForeArm": "LowerArm", "Toe": "ToeBase"}
    middle = {"Spine1": "Chest", "Spine2": "UpperChest"}
    for side in ("Left", "Right"):
        if name.startswith(side):
            return f"J_Bip_{side[0]}_{parts.get(name[len(side):], name[len(side):])}"
    return f"J_Bip_C_{middle.get(name, name)}"


def rigify(name):
    middle = {"Hips": "spine", "Spine": "spine.001", "Spine1": "spine.002", "Spine2": "spine.003", "Neck": "spine.004",
              "Head": "spine.006"}
    for side in ("Left", "Right"):
        if name.startswith(side):
            part = {"UpperArm": "upper_arm", "Clavicle": "shoulder"}.get(_SHORT[name[len(side):]], _SHORT[name[len(side):]].lower())
            return f"DEF-{part}.{side[0]}"
    return f"DEF-{middle[name]}"


def unreal(name):
    parts = {"UpLeg": "thigh", "Leg": "calf", "Foot": "foot", "Toe": "ball", "Shoulder": "clavicle", "Arm": "upperarm",
             "ForeArm": "lowerarm", "Hand": "hand"}
    middle = {"Hips": "pelvis", "Spine": "spine_01", "Spine1": "spine_02", "Spine2": "spine_03", "Neck": "neck_01"}
    for side in ("Left", "Right"):
        if name.startswith(side):
            return f"{parts[name[len(side):]]}_{side[0].lower()}"
    return middle.get(name, name.lower())


def write(path, name=mixamo, pose=A_POSE, unit=1.0, turn=(0, 0, 0), scales=None, fingers=False, saved=None, change=None):
    """A GLB of the mannequin in another rig. Returns the joints' places (22, 3) of its T-pose [m].

    turn: rotation vector [degrees] of all joints' parent, which scales by `unit`. scales: lengths by
    our joint's name. saved: a pose in which the nodes stand, other than the bound one.
    change: a function of the GLB in the making, called last.
    """
    parents, count = skin.STANDARD.parents, len(skin.STANDARD)
    shape, rest = mannequin().levels[2], skin.REST.copy()
    positions, weights = shape.positions.astype(float), np.zeros((len(shape.positions), count))
    for k in range(4):
        np.add.at(weights, (np.arange(len(weights)), skin.AT[shape.joints[:, k]]), shape.weights[:, k])
    if scales:
        rest, positions = _resized(rest, positions, weights, scales)
    offsets = rest - np.where(parents[:, None] < 0, 0.0, rest[parents])
    posed = figure(**pose)
    at = _placed(rest[0], offsets, posed.orientations)
    moved = np.einsum("vj,vji->vi", weights, np.stack(
        [(positions - rest[j]) @ posed.orientations[j].T + at[j] for j in range(count)], 1))
    normals = np.einsum("vj,vji->vi", weights, np.stack([shape.normals @ posed.orientations[j].T for j in range(count)], 1))
    # joint frames roll as they like in other rigs
    frames = posed.orientations @ Rotation.random(count, rng=7).as_matrix()
    whole = np.eye(4)
    whole[:3, :3] = Rotation.from_rotvec(np.radians(turn)).as_matrix() * unit
    inside = np.linalg.inv(whole)
    glb = Glb()
    top = glb.add("nodes", {"name": "Armature", "matrix": whole.T.ravel().tolist(), "children": [1]})
    binds = np.stack([_matrix(frames[j], at[j]) for j in range(count)])
    binds = inside @ binds @ np.diag([unit, unit, unit, 1.0])
    stand = binds
    if saved:
        other = figure(**saved)
        stand = np.stack([_matrix(o @ b.T @ f, p) for o, b, f, p in zip(
            other.orientations, posed.orientations, frames, _placed(rest[0], offsets, other.orientations))])
        stand = inside @ stand @ np.diag([unit, unit, unit, 1.0])
    joints = []
    for j in range(count):
        local = stand[j] if parents[j] < 0 else np.linalg.inv(stand[parents[j]]) @ stand[j]
        children = [1 + int(c) for c in np.flatnonzero(parents == j)]
        joints.append(glb.add("nodes", {"name": name(skin.STANDARD.names[j]), "matrix": local.T.ravel().tolist()}
                              | ({"children": children} if children else {})))
    bones = weights
    if fingers:  # all of the left hand's outer half on a finger
        hand = skin.STANDARD.index("LeftHand")
        joints.append(glb.add("nodes", {"name": name("LeftHandIndex1")}))
        glb.json["nodes"][joints[hand]]["children"] = [joints[-1]]
        outer = positions[:, 0] > rest[hand, 0] + 0.08
        bones = np.concatenate([weights, np.where(outer, weights[:, hand], 0.0)[:, None]], 1)
        bones[outer, hand] = 0.0
        binds = np.concatenate([binds, binds[hand:hand + 1]])
    four = np.argsort(-bones, 1)[:, :4]
    share = np.take_along_axis(bones, four, 1)
    share /= share.sum(1, keepdims=True)
    into = np.linalg.inv(whole[:3, :3])
    inverse = np.linalg.inv(binds)
    skin_ = glb.add("skins", {"joints": joints, "inverseBindMatrices": glb.array(inverse.swapaxes(1, 2).reshape(-1, 16))})
    normals = normals @ into.T
    mesh = glb.add("meshes", {"primitives": [{"attributes": {
        "POSITION": glb.array(moved @ into.T, bounds=True), "JOINTS_0": glb.array(np.where(share > 0, four, 0), UBYTE),
        "NORMAL": glb.array(normals / np.linalg.norm(normals, axis=1, keepdims=True), FLOAT),
        "WEIGHTS_0": glb.array(share)}, "indices": glb.array(shape.triangles.ravel(), USHORT)}]})
    glb.add("scenes", {"nodes": [top, glb.add("nodes", {"name": "Skin", "mesh": mesh, "skin": skin_})]})
    if change:
        change(glb)
    glb.save(path)
    return rest


def _matrix(turn, at):
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = turn, at
    return out


def _placed(root, offsets, orientations):
    at = np.zeros((len(offsets), 3))
    for j, parent in enumerate(skin.STANDARD.parents):
        at[j] = root if parent < 0 else at[parent] + orientations[parent] @ offsets[j]
    return at


def _resized(rest, positions, weights, scales):
    """Bones that end at the named joints become longer or shorter; the flesh goes along."""
    parents = skin.STANDARD.parents
    new = rest.copy()
    for j, joint in enumerate(skin.STANDARD.names):
        if parents[j] >= 0:
            new[j] = new[parents[j]] + (rest[j] - rest[parents[j]]) * scales.get(joint, 1.0)
    moved = np.zeros_like(positions)
    for j in range(len(skin.STANDARD)):
        grow = np.ones(3)
        for child in np.flatnonzero(parents == j):
            factor = scales.get(skin.STANDARD.names[child], 1.0)
            grow[np.argmax(np.abs(rest[child] - rest[j]))] = factor
        moved += weights[:, j, None] * ((positions - rest[j]) * grow + new[j])
    lift = moved[:, 1].min()
    return new - [0.0, lift, 0.0], moved - [0.0, lift, 0.0]
