"""A pose as `WIDTH` numbers: joint rotation vectors, and the root without where it is and faces.

Every joint but the hips and the toes has a rotation vector against one reference rotation that all
databases share: local rotation = REFERENCE · exp(v). The references are mid-range, so that |v| stays
away from π, where a rotation vector jumps. Toes are left out: mocap has them stiff or shaking, and
they follow from the floor. The root has, at each frame,

    height [m], pitch, roll [rad], yaw rate [rad/s], forward and leftward velocity [m/s]

where orientation = yaw(θ) · exp((pitch, 0, roll)), and the rates lead from the frame before to this
one: θ' = θ + ω Δt, and x, z go on by the velocity in the heading θ of the frame before. So summing
them up gives back the way exactly. Lengths are of the standard human: whoever it was, the legs are
as long as his. (Only upside down, where |(pitch, roll)| = π, is the heading undefined.)
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import exp, human, log, mirror_index, wrap, yaw

SKELETON = human()
"""Whose body all recorded motion is put on."""
JOINTS = np.array([j for j, name in enumerate(SKELETON.names) if j > 0 and not name.endswith("Toe")])
"""Numbers of the 19 joints with a rotation vector, in the order of the skeleton."""
ROOT = ("height", "pitch", "roll", "yaw rate", "forward velocity", "leftward velocity")
"""What the last columns hold."""
ANGLES = 3 * len(JOINTS)
"""Columns 0 … ANGLES − 1 are rotation vectors [rad]; the root's follow."""
WIDTH = ANGLES + len(ROOT)
HEIGHT, PITCH, ROLL, YAW_RATE, FORWARD, LEFTWARD = range(ANGLES, WIDTH)


def _reference() -> np.ndarray:
    """Mid-range rotations (J, 3, 3): arms half lowered, elbows, hips and knees bent."""
    # half-way turns [rad] of the left side; mirrored for the right
    bent = {"Arm": (0.0, -0.5, -0.6), "ForeArm": (0.0, -0.9, 0.0), "UpLeg": (-0.4, 0.0, 0.0), "Leg": (0.8, 0.0, 0.0)}
    turns = np.zeros((len(SKELETON), 3))
    for name, turn in bent.items():
        turns[SKELETON.index("Left" + name)] = turn
        turns[SKELETON.index("Right" + name)] = np.array(turn) * [1, -1, -1]
    return exp(turns)


REFERENCE = _reference()
"""(J, 3, 3) the rotation of each joint that the zero vector stands for."""
REFERENCE.setflags(write=False)


def _mirror() -> tuple[np.ndarray, np.ndarray]:
    """Which column each column of a mirror image comes from, and with which sign (WIDTH,)."""
    swap = mirror_index(SKELETON)
    place = {int(joint): k for k, joint in enumerate(JOINTS)}
    partner = np.array([place[int(swap[joint])] for joint in JOINTS])
    columns = np.concatenate([(3 * partner[:, None] + np.arange(3)).ravel(), np.arange(ANGLES, WIDTH)])
    # height, pitch, roll, yaw rate, forward, leftward
    return columns, np.concatenate([np.tile([1.0, -1.0, -1.0], len(JOINTS)), [1.0, 1.0, -1.0, -1.0, 1.0, -1.0]])


_MIRROR_COLUMNS, _MIRROR_SIGNS = _mirror()


def mirror(frames: np.ndarray) -> np.ndarray:
    """Frames (..., WIDTH) with left and right exchanged."""
    return frames[..., _MIRROR_COLUMNS] * _MIRROR_SIGNS


def encode(root: np.ndarray, rotations: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Frames (T, WIDTH) of a motion, and its ground track (T, 3): x, z [m] and heading [rad].

    root: (T, 3) [m]. rotations: (T, J, 3, 3) local, of `SKELETON`. dt: seconds between frames.
    The first frame, which nothing comes before, has the rates of the second.
    """
    frames = np.empty((len(root), WIDTH))
    local = np.swapaxes(REFERENCE[JOINTS], -1, -2) @ rotations[:, JOINTS]
    frames[:, :ANGLES] = log(local).reshape(len(root), -1)
    track = np.empty((len(root), 3))
    track[:, :2] = root[:, [0, 2]]
    track[:, 2], tilt = yaw_and_tilt(rotations[:, 0])
    frames[:, HEIGHT] = root[:, 1]
    frames[:, [PITCH, ROLL]] = tilt
    rates = np.zeros((len(root), 3))
    if len(root) > 1:
        turn = np.diff(np.unwrap(track[:, 2]))
        way = np.diff(track[:, :2], axis=0)
        c, s = np.cos(track[:-1, 2]), np.sin(track[:-1, 2])
        rates[1:] = np.stack([turn, s * way[:, 0] + c * way[:, 1], c * way[:, 0] - s * way[:, 1]], -1) / dt
        rates[0] = rates[1]
    frames[:, YAW_RATE:] = rates
    return frames, track


def yaw_and_tilt(orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Heading (...) [rad], and pitch and roll (..., 2) [rad], of orientations (..., 3, 3) of the hips."""
    x, y, z, w = np.moveaxis(Rotation.from_matrix(orientation).as_quat(), -1, 0)
    heading = wrap(2 * np.arctan2(y, w))
    tilt = log(yaw(-heading) @ orientation)
    return heading, tilt[..., [0, 2]]


def advance(track: np.ndarray, frame: np.ndarray, dt: float) -> np.ndarray:
    """The ground track (..., 3) a frame (..., WIDTH) later than `track` (..., 3), seconds dt between them."""
    c, s = np.cos(track[..., 2]), np.sin(track[..., 2])
    forward, left = frame[..., FORWARD], frame[..., LEFTWARD]
    rate = np.stack([s * forward + c * left, c * forward - s * left, frame[..., YAW_RATE]], -1)
    return track + rate * dt


def decode(frames: np.ndarray, track: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Root (..., 3) [m] and local rotations (..., J, 3, 3) of frames (..., WIDTH) at tracks (..., 3)."""
    frames, track = np.asarray(frames, float), np.asarray(track, float)
    batch = frames.shape[:-1]
    rotations = np.broadcast_to(np.eye(3), (*batch, len(SKELETON), 3, 3)).copy()
    rotations[..., JOINTS, :, :] = REFERENCE[JOINTS] @ exp(frames[..., :ANGLES].reshape(*batch, -1, 3))
    tilt = np.stack([frames[..., PITCH], np.zeros(batch), frames[..., ROLL]], -1)
    rotations[..., 0, :, :] = yaw(track[..., 2]) @ exp(tilt)
    return np.stack([track[..., 0], frames[..., HEIGHT], track[..., 1]], -1), rotations
