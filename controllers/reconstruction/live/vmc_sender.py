"""A body sent on as VMC programs send theirs, so that Unity, Unreal, Blender, VSeeFace and others show it as it moves.

A bundle a frame: /VMC/Ext/OK, /VMC/Ext/Root/Pos, /VMC/Ext/Bone/Pos of Unity's humanoid bones, /VMC/Ext/Blend/Val with how sure the
body is, /VMC/Ext/T. Turns are local and from the T-pose; axes are Unity's, left-handed with +X to the right.
"""

from __future__ import annotations

import math
import re
import socket
import struct
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import Pose, Skeleton
from ...files import printable, reason
from .osc_packets import FROM_UNITY, MIRRORED

PORT = 39539
"""The port that programs which show bodies listen at, unless told otherwise."""
SURE = "Confidence"
"""The blend shape that says how sure the body is, 0 … 1."""
BONES = {"Hips": "Hips", "Spine": "Spine", "Spine1": "Chest", "Spine2": "UpperChest", "Neck": "Neck", "Head": "Head"} | {
    side + ours: side + theirs for side in ("Left", "Right") for ours, theirs in (
        ("Shoulder", "Shoulder"), ("Arm", "UpperArm"), ("ForeArm", "LowerArm"), ("Hand", "Hand"),
        ("UpLeg", "UpperLeg"), ("Leg", "LowerLeg"), ("Foot", "Foot"), ("Toe", "Toes"))}
"""Unity's name of each joint."""


class SenderError(ValueError):
    """A place that nothing can be sent to, and what would help."""


def address(text: str) -> tuple[str, int]:
    """Host and port of "HOST", "HOST:PORT" or ":PORT", HOST in brackets if it has colons. SenderError for anything else."""
    found = re.fullmatch(r"(?:\[([^\[\]]+)\]|([^:\[\]]*))(?::([^:]*))?", text)
    bracketed, bare, port = found.groups() if found else ("", "", "")
    host, port = bracketed or bare, str(PORT) if port is None else port
    if not port.isascii() or not port.isdigit() or not 0 < int(port) < 65536:
        raise SenderError(f"{printable(text)!r} is no address: give HOST:PORT, such as 127.0.0.1:{PORT}")
    return host or "127.0.0.1", int(port)


def bundle(skeleton: Skeleton, pose: Pose, ground: np.ndarray, time: float, sure: float = 1.0) -> bytes:
    """One frame as a packet.

    pose: of the skeleton, one body in the world. ground: (3,) x, z [m], heading [rad], which is the root. time: [s] of the
    sender. sure: 0 … 1 how sure the body is.
    """
    x, z, heading = (float(v) for v in ground)
    said = np.empty((1 + len(skeleton), 7))  # of the root and of all joints: place and turn
    said[0] = x, 0.0, z, 0.0, math.sin(0.5 * heading), 0.0, math.cos(0.5 * heading)
    said[1:, :3], said[1:, 3:] = skeleton.offsets, Rotation.from_matrix(np.asarray(pose.rotations, float)).as_quat()
    hips, (c, s), (half, sine) = said[1], (math.cos(heading), math.sin(heading)), (said[0, 6], said[0, 4])
    along, up, across = np.asarray(pose.root, float) - said[0, :3]
    hips[:3] = c * along - s * across, up, s * along + c * across
    i, j, k, w = hips[3:]
    hips[3:] = half * i - sine * k, half * j - sine * w, half * k + sine * i, half * w + sine * j
    said[:, :3] *= FROM_UNITY
    said[:, 3:] *= MIRRORED
    root, *bones = said.astype(">f4")
    return b"".join([_HEAD, _begun("/VMC/Ext/Root/Pos", "root"), root.tobytes(),
                     *(_begun("/VMC/Ext/Bone/Pos", BONES[name]) + bone.tobytes() for name, bone in zip(skeleton.names, bones) if name in BONES),
                     _begun("/VMC/Ext/Blend/Val", SURE, "f"), struct.pack(">f", min(max(sure, 0.0), 1.0)), _begun("/VMC/Ext/Blend/Apply", numbers=""),
                     _begun("/VMC/Ext/T", numbers="f"), struct.pack(">f", time)])


@lru_cache(64)
def _begun(path: str, name: str = "", numbers: str = "fffffff") -> bytes:
    """A message of a bundle as far as its numbers, of these kinds: its size, where it goes, kinds, and its name if it has one (OSC 1.0)."""
    head = b"".join(text.encode() + b"\0" * (4 - len(text) % 4) for text in (path, "," + "s" * bool(name) + numbers, name) if text)
    return struct.pack(">i", len(head) + 4 * len(numbers)) + head


_HEAD = b"#bundle\0" + struct.pack(">q", 1) + _begun("/VMC/Ext/OK", numbers="i") + struct.pack(">i", 1)
"""A bundle that counts at once, and its first message: the body is there."""


class Sender:
    """Sends bodies to a program. SenderError if its address is none. lost: how many frames could not be sent."""

    def __init__(self, host: str, port: int = PORT):
        self.lost = 0
        try:
            family, kind, _, _, self._to = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        except (OSError, UnicodeError) as error:
            raise SenderError(f"{printable(host)!r} is no machine that can be found: {reason(error)}") from None
        self._socket = socket.socket(family, kind)
        self._socket.setblocking(False)

    def send(self, skeleton: Skeleton, pose: Pose, ground: np.ndarray, time: float, sure: float = 1.0) -> None:
        """See `bundle`. Nobody listening is no mistake."""
        try:
            self._socket.sendto(bundle(skeleton, pose, ground, time, sure), self._to)
        except OSError:
            self.lost += 1

    def close(self) -> None:
        """Send no more."""
        self._socket.close()


class Senders:
    """Sends bodies to several programs at once, each once. places: as `address` reads them. SenderError if any of them is none."""

    def __init__(self, places: Sequence[str]):
        self._all = [Sender(*place) for place in dict.fromkeys(map(address, places))]

    @property
    def lost(self) -> int:
        """How many frames could not be sent, each program's."""
        return sum(one.lost for one in self._all)

    def send(self, skeleton: Skeleton, pose: Pose, ground: np.ndarray, time: float, sure: float = 1.0) -> None:
        """See `bundle`."""
        for one in self._all:
            one.send(skeleton, pose, ground, time, sure)

    def close(self) -> None:
        """Send no more."""
        for one in self._all:
            one.close()
