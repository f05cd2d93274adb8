"""What packets of trackers say, as VR programs send them: the VMC protocol and VRChat's OSC trackers.

Understood are /VMC/Ext/Hmd/Pos, /VMC/Ext/Con/Pos and /VMC/Ext/Tra/Pos (a serial number, a position and a quaternion),
/VMC/Ext/T (the sender's clock), /tracking/trackers/N/position (a position) and …/rotation (degrees about X, Y and Z, turned about
Z first, then X, then Y: Unity's order), alone or in bundles. SlimeVR sends either. Both come from Unity, whose axes are left-handed:
+X is to the right there.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from pythonosc import osc_bundle, osc_message
from pythonosc.osc_packet import OscPacket, ParseError
from scipy.spatial.transform import Rotation

FROM_UNITY = np.array([-1.0, 1.0, 1.0])
"""From its axes into ours and back."""
MIRRORED = np.array([1.0, -1.0, -1.0, 1.0])
"""So are the quaternions x, y, z, w of turns."""
_VMC = re.compile(r"/VMC/Ext/(Hmd|Con|Tra)/Pos")
_VRCHAT = re.compile(r"/tracking/trackers/([1-8]|head)/(position|rotation)")
_CLOCK = "/VMC/Ext/T"
_ASIDE = _CLOCK, "/VMC/Ext/OK", "/VMC/Ext/Root/Pos"  # every program says these of itself
LONGEST_NAME = 100
"""Letters of a tracker's name."""
MOST_PARTS = 1024
"""A packet of more messages than any program sends is broken: one of 60 kB may hold 15,000 empty ones, which take longer to read than a frame."""
# the library logs a broken packet whole, for everybody to see: here it is counted
_quiet = logging.getLogger("gambol.osc")
_quiet.disabled = True
for _module in (osc_bundle, osc_message):
    vars(_module)["logging"] = _quiet


class Reading(NamedTuple):
    """A tracker: serial number, kind ("Hmd", "Con", "Tra"), place (3,) [m], Y up and +X to the left of +Z, and turn (4,), a unit
    quaternion x, y, z, w; NaN what is not said.
    """

    serial: str
    kind: str
    place: np.ndarray
    turn: np.ndarray


class Seen(NamedTuple):
    """Trackers of a packet, each one once. sent: when by the sender's clock [s]; None where it does not say. about: the address of a message about something else, ""
    where there is none."""

    trackers: list[Reading]
    sent: float | None = None
    about: str = ""


def understood(packet: bytes) -> Seen | None:
    """What a packet says. No trackers in messages about something else, None for a packet that is broken."""
    if _parts(packet) > MOST_PARTS:
        return None
    try:
        messages = [timed.message for timed in OscPacket(packet).messages]
    except (ParseError, ValueError, IndexError, RecursionError):
        return None
    found: dict[str, Reading] = {}
    sent, about = None, ""
    for message in messages:
        values = message.params
        if match := _VMC.fullmatch(message.address):
            reading = _tracker(values[0], match[1], values[1:4], _turn(values[4:8])) if len(values) > 3 else None
        elif match := _VRCHAT.fullmatch(message.address):
            kind, turned = "Hmd" if match[1] == "head" else "Tra", match[2] == "rotation"
            reading = None
            if _numbers(values, 3, 1e6):
                reading = _tracker(match[1], kind, [] if turned else values, _euler(values) if turned else None)
        else:
            if message.address == _CLOCK and len(values) == 1 and type(values[0]) in (int, float) and abs(values[0]) < 1e9:
                sent = float(values[0])
            elif message.address not in _ASIDE:
                about = message.address
            continue
        if reading is None:
            return None
        before = found.get(reading.serial)
        found[reading.serial] = reading if before is None else reading._replace(
            place=np.where(np.isnan(reading.place), before.place, reading.place), turn=np.where(np.isnan(reading.turn), before.turn, reading.turn))
    return Seen(list(found.values()), sent, about)


def _parts(packet: bytes) -> int:
    """How many parts a bundle has, bundles in it with theirs; counted no farther than one beyond `MOST_PARTS`."""
    bundles, count = [(0, len(packet))], 0
    while bundles:
        start, end = bundles.pop()
        if not packet.startswith(b"#bundle\0", start, end):
            continue
        at = start + 16
        while at < end and count <= MOST_PARTS:
            size = max(int.from_bytes(packet[at:at + 4], "big", signed=True), 0)
            bundles.append((at + 4, min(at + 4 + size, end)))
            at, count = at + 4 + size, count + 1
    return count


def _tracker(serial: Any, kind: str, place: Sequence[Any], turn: np.ndarray | None) -> Reading | None:
    """A tracker of a place (3,), nothing where it is not said, and a turn in Unity's axes; None if it can't be one."""
    if not isinstance(serial, str) or len(serial) > LONGEST_NAME:
        return None
    where = np.full(3, np.nan)
    if place:
        if not _numbers(place, 3, 1e3):
            return None
        where = np.array(place, float) * FROM_UNITY
    return Reading(serial, kind, where, np.full(4, np.nan) if turn is None else turn * MIRRORED)


def _turn(values: Sequence[Any]) -> np.ndarray | None:
    """The unit quaternion (4,) of one; None of none, as some send for a tracker that knows no turn."""
    if not _numbers(values, 4, 1.1) or not 0.9 < (size := math.hypot(*values)) < 1.1:
        return None
    return np.array(values, float) / size


def _euler(values: Sequence[Any]) -> np.ndarray:
    """The unit quaternion (4,) of Unity's Euler angles [°]: about Z, then X, then Y."""
    x, y, z = values
    return Rotation.from_euler("YXZ", [y, x, z], degrees=True).as_quat()


def _numbers(values: Sequence[Any], count: int, most: float) -> bool:
    """Whether they are so many numbers, none beyond `most`."""
    return len(values) == count and all(type(value) in (int, float) and abs(value) < most for value in values)  # NaN is not, either
