"""How a human stands at rest, whoever made him: which way is up, what he lacks, and what brings him into T-pose.

Places are told by our joints' names (`human`); of those, trunk, neck, clavicles, hands and toes may be missing.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..body import between, human, yaw

HUMAN = human()
REST = np.array(HUMAN.offsets, float)
for _joint, _parent in enumerate(HUMAN.parents[1:], 1):
    REST[_joint] += REST[_parent]
REST.setflags(write=False)
"""Places (22, 3) [m] of the standard human's joints in T-pose."""
SIDES = ("Left", "Right")
LEANS, ASKEW = np.radians(30.0), np.radians(3.0)
"""Up is an axis of the world if a body leans from it by less than the first, and to the left one if its hips are turned from it by less than the second [rad]."""
_AT = dict(zip(HUMAN.names, REST))
_ALIGNED = {"Arm": "ForeArm", "ForeArm": "Hand", "UpLeg": "Leg", "Leg": "Foot"}


def upright(at: Mapping[str, np.ndarray]) -> np.ndarray:
    """The rotation (3, 3) that lets somebody whose joints are at those places (3,) stand along +Y and face +Z.

    ValueError where they tell of nobody who stands, or of left and right exchanged.
    """
    left = at["LeftUpLeg"] - at["RightUpLeg"]
    up = at["Head"] - 0.5 * (at["LeftUpLeg"] + at["RightUpLeg"])
    length = np.linalg.norm(up)
    if not np.linalg.norm(np.cross(left, up)) > 1e-3 * length**2 > 0.0:
        raise ValueError("its hips and head are in one place; export it with its rest pose")
    y = _near(up / length, LEANS)  # a spine may lean where the world does not
    x = left - y * (y @ left)
    x = _near(x / np.linalg.norm(x), ASKEW)
    x = x - y * (y @ x)
    x /= np.linalg.norm(x)
    frame = np.stack([x, y, np.cross(x, y)])
    toes = [frame @ (at[side + "Toe"] - at[side + "Foot"]) for side in SIDES if side + "Toe" in at]
    if toes and all(toe[2] < -0.5 * np.linalg.norm(toe) for toe in toes):
        raise ValueError("its toes point backward as its joints are named: left and right are exchanged; name them anew")
    return frame


def _near(direction: np.ndarray, angle: float) -> np.ndarray:
    """The axis (3,) that a direction is no farther from than that [rad], else the direction."""
    axis = np.zeros(3)
    k = int(np.abs(direction).argmax())
    axis[k] = np.sign(direction[k])
    return axis if axis @ direction > np.cos(angle) else direction


def complete(at: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Places for all our joints, of somebody upright: those that are lacking where they would be on the standard human.

    ValueError where his legs have no length.
    """
    size = np.mean([np.linalg.norm(at[s + a] - at[s + b]) / np.linalg.norm(_AT[s + a] - _AT[s + b])
                    for s in SIDES for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))])
    if not size > 1e-6:
        raise ValueError("its legs have no length")
    at = dict(at)
    if "Spine2" not in at:
        at["Spine2"] = 0.35 * at["Hips"] + 0.65 * 0.5 * (at["LeftArm"] + at["RightArm"])
    for name, low, share in (("Spine", "Hips", 0.23), ("Spine1", "Spine", 0.5), ("Neck", "Spine2", 0.625)):
        high = "Head" if name == "Neck" else "Spine2"
        at.setdefault(name, at[low] + share * (at[high] - at[low]))
    for side in SIDES:
        at.setdefault(side + "Shoulder", at[side + "Arm"] + 0.75 * (
            0.5 * (at["LeftArm"] + at["RightArm"]) - at[side + "Arm"]))
        fore = at[side + "ForeArm"] - at[side + "Arm"]
        at.setdefault(side + "Hand", at[side + "ForeArm"] + size * 0.2689 * fore / np.maximum(np.linalg.norm(fore), 1e-12))
        at.setdefault(side + "Toe", at[side + "Foot"] + size * (_AT[side + "Toe"] - _AT[side + "Foot"]))
    return at


def to_t_pose(at: Mapping[str, np.ndarray]) -> np.ndarray:
    """World rotations (22, 3, 3) that carry what hangs on each of our joints into T-pose, of somebody upright, `complete`."""
    out: dict[str, np.ndarray] = {}
    for name, parent in zip(HUMAN.names, HUMAN.parents):
        side, part = next(((s, name[len(s):]) for s in SIDES if name.startswith(s)), ("", name))
        if part in _ALIGNED:
            child = side + _ALIGNED[part]
            out[name] = between(at[child] - at[name], _AT[child] - _AT[name])
        elif part == "Foot":
            ahead = (at[side + "Toe"] - at[name]) * [1.0, 0.0, 1.0]
            out[name] = yaw(-np.arctan2(ahead[0], ahead[2])) if np.linalg.norm(ahead) > 1e-6 else np.eye(3)
        elif part in ("Hand", "Toe"):
            out[name] = out[HUMAN.names[parent]]
        else:
            out[name] = np.eye(3)
    return np.stack([out[name] for name in HUMAN.names])
