"""Bodies of other proportions, to learn on: what trackers' calibration finds of people, and what it gets wrong of them."""

from __future__ import annotations

import numpy as np

from ..pose_vector import SKELETON

STANDARD = 0.25
"""This share of bodies is the standard one."""
SIZE = 0.06
"""How far people's sizes differ, a share …"""
_PARTS = {"Spine": 0.06, "Neck": 0.08, "Shoulder": 0.12, "Arm": 0.10, "ForeArm": 0.06, "Hand": 0.06, "UpLeg": 0.12, "Leg": 0.04,
          "Foot": 0.04, "Toe": 0.10}
"""… and how far their parts' lengths beside that; by the joint at whose end the bone is."""
_AS = {"Spine1": "Spine", "Spine2": "Spine", "Head": "Neck"}
LIE = 0.008
"""How far joints lie off the bones of a standard body [m]: of trunk, hips and shoulders."""
_LOOSE = {"Spine", "Neck", "Shoulder", "Arm", "UpLeg"}


def _plain(name: str) -> str:
    plain = name.removeprefix("Left").removeprefix("Right")
    return _AS.get(plain, plain)


_GROUPS: list[str] = list(_PARTS)
_GROUP = np.array([_GROUPS.index(_plain(name)) if j else 0 for j, name in enumerate(SKELETON.names)])
_LYING = np.array([LIE if j and _plain(name) in _LOOSE else 0.0 for j, name in enumerate(SKELETON.names)])
_TWIN = np.array([SKELETON.index(name.replace("Right", "Left")) for name in SKELETON.names])
_SIDE = np.array([[-1.0 if name.startswith("Right") else 1.0, 1.0, 1.0] for name in SKELETON.names])
_MIDDLE = np.array([not name.startswith(("Left", "Right")) for name in SKELETON.names])


def bodies(count: int, rng: np.random.Generator) -> np.ndarray:
    """Offsets (count, J, 3) [m] of bodies, symmetric, with the chart's joints."""
    size = 1.0 + SIZE * np.clip(rng.normal(size=(count, 1)), -2.5, 2.5)
    parts = 1.0 + np.array(list(_PARTS.values())) * np.clip(rng.normal(size=(count, len(_GROUPS))), -2.5, 2.5)
    lying = rng.normal(size=(count, len(SKELETON), 3)) * _LYING[:, None]
    lying[:, _MIDDLE, 0] = 0.0
    lying = lying[:, _TWIN] * _SIDE
    offsets = SKELETON.offsets * (size * parts[:, _GROUP])[..., None] + lying
    plain = rng.random(count) < STANDARD
    offsets[plain] = SKELETON.offsets
    offsets[:, 0] = SKELETON.offsets[0]
    return offsets


def legs(offsets: np.ndarray) -> np.ndarray:
    """How long (...) [m] the left leg of bodies (..., J, 3) is from hip to floor, straight."""
    knee, foot, toe = (SKELETON.index("Left" + name) for name in ("Leg", "Foot", "Toe"))
    return (np.linalg.norm(offsets[..., knee, :], axis=-1) + np.linalg.norm(offsets[..., foot, :], axis=-1)
            + np.abs(offsets[..., toe, 1]))


def proportions() -> dict[str, np.ndarray]:
    """What `bodies` are drawn by: the part of each joint, how far parts differ, how far joints lie off, twins, sides, and which are in the middle."""
    return {"group": _GROUP, "parts": np.array(list(_PARTS.values())), "lying": _LYING, "twin": _TWIN, "side": _SIDE, "middle": _MIDDLE}
