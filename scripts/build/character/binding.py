"""Skin weights: which joints each vertex follows."""

from __future__ import annotations

import numpy as np

from gambol.game.render import NAMES

from . import surface


def ramp(t, low, high):
    """0 below `low`, 1 above `high`, smooth between."""
    u = np.clip((t - low) / (high - low), 0.0, 1.0)
    return u * u * (3.0 - 2.0 * u)


def bound(vertices: np.ndarray, faces: np.ndarray, smoothing: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Joints and weights, both (V, 4), into `skin.NAMES`.

    In T-pose every limb runs along an axis, so that each border between two joints is a ramp
    along it; the ramps are as wide as the flesh that folds there.
    """
    full = np.zeros((len(vertices), len(NAMES)))
    left = vertices[:, 0] >= 0
    for side, chosen in (("Left", left), ("Right", ~left)):
        p = vertices[chosen] * ([1, 1, 1] if side == "Left" else [-1, 1, 1])
        for name, value in _half(p).items():
            name = name.replace("Left", side)
            full[np.ix_(np.flatnonzero(chosen), [NAMES.index(name)])] += value[:, None]
    mean = surface.neighbours(faces, len(vertices))
    for _ in range(smoothing):
        full = 0.5 * full + 0.5 * (mean @ full)
    # between the legs two borders meet: spread them further, or a straddle tears the flesh there
    soft = 1.0 - ramp(np.linalg.norm((vertices - [0.0, 0.855, 0.0]) * [1.0, 1.2, 0.7], axis=1), 0.05, 0.12)[:, None]
    for _ in range(4 * smoothing):
        full = full + 0.7 * soft * (mean @ full - full)
    joints = np.argsort(-full, 1)[:, :4]
    weights = np.take_along_axis(full, joints, 1)
    return joints, weights / weights.sum(1, keepdims=True)


def _half(p: np.ndarray) -> dict[str, np.ndarray]:
    x, y, z = p.T
    # how far a vertex belongs to the arm: past a slanting border through the armpit and the shoulder's top
    arm = ramp(x + 0.30 * (y - 1.425), 0.100, 0.225) * ramp(y, 1.20, 1.33) * (1.0 - ramp(y, 1.485, 1.53))
    # … and to the leg: past a border that rises from the crotch to the hip bone
    rise = 0.905 + 0.30 * np.clip(x - 0.02, 0.0, 0.14) - 0.10 * np.clip(-z, 0.0, 0.1)
    leg = 1.0 - ramp(y, rise - 0.075, rise + 0.075)
    trunk = (1.0 - arm) * (1.0 - leg)
    out: dict[str, np.ndarray] = {}

    def add(name, value):
        out[name] = out.get(name, 0.0) + value
    # trunk, from below upwards
    spine = [ramp(y, 1.00, 1.13), ramp(y, 1.13, 1.27), ramp(y, 1.26, 1.40)]
    neck = ramp(y - 0.25 * np.abs(x), 1.445, 1.525)
    head = ramp(y + 0.35 * np.clip(z, -0.05, 0.1), 1.515, 1.60)
    add("Hips", trunk * (1 - spine[0]))
    add("Spine", trunk * spine[0] * (1 - spine[1]))
    add("Spine1", trunk * spine[1] * (1 - spine[2]))
    collar = ramp(x, 0.03, 0.14) * ramp(y, 1.30, 1.41) * (1 - neck) * 0.8
    add("LeftShoulder", trunk * spine[2] * collar)
    add("Spine2", trunk * spine[2] * (1 - collar) * (1 - neck))
    add("Neck", trunk * neck * (1 - head))
    add("Head", trunk * neck * head)
    # arm: twist grows along the upper arm and again along the forearm
    elbow, wrist = ramp(x, 0.4617 - 0.048, 0.4617 + 0.048), ramp(x, 0.7306 - 0.028, 0.7306 + 0.028)
    turn = ramp(x, 0.19, 0.43)
    add("LeftArm0", arm * (1 - elbow) * (1 - turn))
    add("LeftArm", arm * (1 - elbow) * turn)
    early, late = ramp(x, 0.46, 0.60), ramp(x, 0.58, 0.72)
    add("LeftForeArm0", arm * elbow * (1 - wrist) * (1 - early))
    add("LeftForeArm", arm * elbow * (1 - wrist) * early * (1 - late))
    add("LeftForeArm1", arm * elbow * (1 - wrist) * early * late)
    add("LeftHand", arm * elbow * wrist)
    # leg
    knee = 1.0 - ramp(y, 0.502 - 0.062, 0.502 + 0.062)
    ankle = 1.0 - ramp(y - 0.25 * np.clip(z, -0.06, 0.08), 0.045, 0.105)
    toe = ramp(z, 0.100, 0.148)
    turn = 1.0 - ramp(y, 0.56, 0.88)
    add("LeftUpLeg0", leg * (1 - knee) * (1 - turn))
    add("LeftUpLeg", leg * (1 - knee) * turn)
    add("LeftLeg", leg * knee * (1 - ankle))
    add("LeftFoot", leg * knee * ankle * (1 - toe))
    add("LeftToe", leg * knee * ankle * toe)
    return out
