"""What is played, as values: its state, one tick of it, actions and settings, the input log and its replay, looking back, and
the comparison of methods beside a player.
"""

from . import comparison, settings
from .actions import ACTIONS
from .comparison import GHOST, Comparison, wanted, written
from .fingerprint import digest
from .input_log import SUFFIX, Log, LogWriter, read
from .replay import of_library, performer_of, replay, strayed
from .rewind import Look
from .settings import SETTINGS, Setting
from .state import SessionState, begin, opening, owners
from .tick import Timeline, refused
from .tracking import unpenalised

__all__ = [
    "ACTIONS", "GHOST", "SETTINGS", "SUFFIX", "Comparison", "Log", "LogWriter", "Look", "SessionState", "Setting",
    "Timeline", "begin", "comparison", "digest", "of_library", "opening", "owners", "performer_of", "read", "refused",
    "replay", "settings", "strayed", "unpenalised", "wanted", "written",
]
