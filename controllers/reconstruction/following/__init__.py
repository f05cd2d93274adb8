"""What makes a controller of a method: beginning from nothing but points, a gate for exchanged, lost and wild points, feet out
of the floor, and taking a body over without a pop; the way to points that are far.
"""

from .approach import APART, FAR, reached, spread, towards
from .feet import above
from .hand_over import difference, guessed_past, joints_of, moved, unbroken
from .initial_pose import Beginning, Starts
from .leaps import LEAP, led
from .point_gate import Doubts, Gate, rotations

__all__ = [
    "APART", "FAR", "LEAP", "Beginning", "Doubts", "Gate", "Starts", "above", "difference", "guessed_past", "joints_of", "led", "moved", "reached",
    "rotations", "spread", "towards", "unbroken",
]
