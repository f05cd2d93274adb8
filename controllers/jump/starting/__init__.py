"""From where a jump starts: what it needs to know of a state and of the floor there, whether it can start at this moment and off which foot, and what a jumper remembers of it."""

from .after_landing import landed, rebounding, standing
from .floors import astride, on_ground, on_its_floor
from .from_state import RUNNING, goes, start_of
from .jumping import Jumping, stands, stayed
from .readiness import FRESH, ready, sets_feet
from .told import FEET, cramped, turning
from .while_going import SLOWLY, along_of, leaves_under, off_one, off_under, walks_to

__all__ = [
    "FEET", "FRESH", "RUNNING", "SLOWLY", "Jumping", "along_of", "astride", "cramped", "goes", "landed", "leaves_under", "off_one", "off_under", "on_ground", "on_its_floor", "ready", "rebounding", "sets_feet",
    "standing", "start_of", "stands", "stayed", "turning", "walks_to",
]
