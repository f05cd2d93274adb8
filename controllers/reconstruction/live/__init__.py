"""Where live points come from: recorded performances, trackers over the network, and how their wearer stands in the room; and
where the body goes that is made of them: to programs that show it.
"""

from .osc_stream import HOST, PORT, Replayed, Stream, Trackers
from .packet_log import SUFFIX, PacketLog, PacketLogError
from .placing import SIZES, Placement, Standing, placed, stances
from .sources import Recorded
from .timeline import Timeline
from .tracker_map import StreamError, read_map, read_tables, usual_map
from .vmc_sender import Sender, SenderError, Senders, address

__all__ = [
    "HOST", "PORT", "SIZES", "SUFFIX", "PacketLog", "PacketLogError", "Placement", "Recorded", "Replayed", "Sender", "SenderError", "Senders", "Standing", "Stream", "StreamError",
    "Timeline", "Trackers", "address", "placed", "read_map", "read_tables", "stances", "usual_map",
]
