"""A body sent on as VMC programs send theirs, so that Unity, Unreal, Blender, VSeeFace and others show it as it moves.

A bundle a frame: /VMC/Ext/OK, /VMC/Ext/Root/Pos, /VMC/Ext/Bone/Pos of Unity's humanoid bones, /VMC/Ext/Blend/Val with how sure the
body is, /VMC/Ext/T. Turns are local and from the T-pose; axes are Unity's, left-handed with +X to the right.
"""

from __future__ import annotations

import re
import socket
from collections.abc import Sequence

import numpy as np
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
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
    turns = Rotation.from_matrix(np.asarray(pose.rotations, float))
    about = Rotation.from_rotvec([0.0, heading, 0.0])
    quaternions = turns.as_quat()
    quaternions[0] = (about.inv() * turns[0]).as_quat()
    places = np.array(skeleton.offsets, float)
    places[0] = about.inv().apply(np.asarray(pose.root, float) - [x, 0.0, z])
    builder = OscBundleBuilder(IMMEDIATELY)
    for path, *values in (("/VMC/Ext/OK", 1),
                          ("/VMC/Ext/Root/Pos", "root", *(np.array([x, 0.0, z]) * FROM_UNITY), *(about.as_quat() * MIRRORED)),
                          *(("/VMC/Ext/Bone/Pos", BONES[name], *(place * FROM_UNITY), *(quaternion * MIRRORED))
                            for name, place, quaternion in zip(skeleton.names, places, quaternions) if name in BONES),
                          ("/VMC/Ext/Blend/Val", SURE, float(np.clip(sure, 0.0, 1.0))), ("/VMC/Ext/Blend/Apply",),
                          ("/VMC/Ext/T", float(time))):
        message = OscMessageBuilder(path)
        for value in values:
            message.add_arg(float(value) if isinstance(value, float) else value)
        builder.add_content(message.build())
    return builder.build().dgram


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
