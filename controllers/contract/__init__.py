"""The contract every controller keeps: ``state', pose = controller.step(state, intent, dt)``.

State goes in, state comes out; a controller holds only what it was built from. So rewinding,
replaying, testing and crowds need nothing more than keeping states.
"""

from .protocol import LONGEST, Controller, Unable, given, grounded, known, level, seconds
from .states import CharacterState, Duty, OfSize, Status, but
from .wishes import HARDEST, HIGHEST, Goal, Intent, Leap, Sighting, Strike

__all__ = [
    "HARDEST", "HIGHEST", "LONGEST", "CharacterState", "Controller", "Duty", "Goal", "Intent", "Leap", "OfSize", "Sighting", "Status", "Strike", "Unable", "but",
    "given", "grounded", "known", "level", "seconds",
]
