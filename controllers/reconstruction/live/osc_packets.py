"""What packets of trackers say, as VR programs send them: the VMC protocol and VRChat's OSC trackers.

Understood are /VMC/Ext/Hmd/Pos, /VMC/Ext/Con/Pos and /VMC/Ext/Tra/Pos (a serial number, a position and a quaternion),
/VMC/Ext/T (the sender's clock) and /tracking/trackers/N/position (a position), alone or in bundles. Both come from Unity, whose
axes are left-handed: +X is to the right there.
"""

from __future__ import annotations

import logging
import re
from typing import NamedTuple

import numpy as np
from pythonosc import osc_bundle, osc_message
from pythonosc.osc_packet import OscPacket, ParseError

FROM_UNITY = np.array([-1.0, 1.0, 1.0])
"""From its axes into ours and back."""
_VMC = re.compile(r"/VMC/Ext/(Hmd|Con|Tra)/Pos")
_VRCHAT = re.compile(r"/tracking/trackers/([1-8]|head)/position")
_CLOCK = "/VMC/Ext/T"
LONGEST_NAME = 100
"""Letters of a tracker's name."""
# the library logs a broken packet whole, for everybody to see: here it is counted
_quiet = logging.getLogger("gambol.osc")
_quiet.disabled = True
for _module in (osc_bundle, osc_message):
    vars(_module)["logging"] = _quiet


class Seen(NamedTuple):
    """Trackers of a packet: serial numbers, kinds ("Hmd", "Con", "Tra") and places (3,) [m], Y up and +X to the left of +Z.

    sent: when by the sender's clock [s]; None where it does not say.
    """

    trackers: list[tuple[str, str, np.ndarray]]
    sent: float | None = None


def understood(packet: bytes) -> Seen | None:
    """What a packet says. No trackers in messages about something else, None for a packet that is broken."""
    try:
        messages = [timed.message for timed in OscPacket(packet).messages]
    except (ParseError, ValueError, IndexError, RecursionError):
        return None
    found, sent = [], None
    for message in messages:
        values = message.params
        if match := _VMC.fullmatch(message.address):
            serial, kind, numbers = (values[0] if values else None), match[1], values[1:4]
        elif match := _VRCHAT.fullmatch(message.address):
            serial, kind, numbers = match[1], "Hmd" if match[1] == "head" else "Tra", values[:3]
        else:
            if message.address == _CLOCK and len(values) == 1 and type(values[0]) in (int, float) and abs(values[0]) < 1e9:
                sent = float(values[0])
            continue
        if not isinstance(serial, str) or len(serial) > LONGEST_NAME or len(numbers) != 3 or not all(type(number) in (int, float) for number in numbers):
            return None
        place = np.array(numbers, float)
        if not np.all(np.abs(place) < 1e3):  # NaN is not, either
            return None
        found.append((serial, kind, place * FROM_UNITY))
    return Seen(found, sent)
