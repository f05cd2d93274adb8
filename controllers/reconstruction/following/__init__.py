"""What makes a controller of a method: beginning from nothing but points, a gate for exchanged, lost and wild points, feet out
of the floor, and taking a body over without a pop; the way to points that are far.
"""

from .approach import APART, FAR, reached, spread, towards
from .feet import above
from .hand_over import difference, guessed_past, joints_of, moved, unbroken
from .initial_pose import Beginning, Starts
from .leaps import KEPT, LATELY, LEAP, NOISY, kept, led, missed
from .point_gate import Doubts, Gate, rotations

__all__ = [
    "APART", "FAR", "KEPT", "LATELY", "LEAP", "NOISY", "Beginning", "Doubts", "Gate", "Starts", "above", "difference", "guessed_past", "joints_of", "kept", "led", "missed", "moved", "reached",
    "rotations", "spread", "towards", "unbroken",
]
