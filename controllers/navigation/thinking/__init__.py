"""What somebody on his way to a goal thinks of beside his steps: plans, leaps, and when what he thought of is used."""

from .going import NEARER, Going, Thinking, astray, ready, within
from .sized import in_size, shrunk, speeds
from .thought import Thought, steps_of
from .ways import SHARE, another, began, landed, poised, run_up

__all__ = ["NEARER", "SHARE", "Going", "Thinking", "Thought", "another", "astray", "began", "in_size", "landed", "poised", "ready", "run_up", "shrunk", "speeds", "steps_of", "within"]
