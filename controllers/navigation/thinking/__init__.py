"""What somebody on his way to a goal thinks of beside his steps: plans, leaps, and when what he thought of is used."""

from .going import NEARER, Going, Thinking, astray, ready, within
from .thought import Thought, steps_of
from .ways import SHARE, another, began, landed, poised, run_up

__all__ = ["NEARER", "SHARE", "Going", "Thinking", "Thought", "another", "astray", "began", "landed", "poised", "ready", "run_up", "steps_of", "within"]
