"""Scripted runs from TOML: what the file may say, checked field by field, and the film that comes of it."""

from . import film, scenario
from .described import described
from .doubts import doubts
from .film import Frame, run, scenes, worlds
from .scenario import Scenario, ScenarioError, load, locate, shipped
from .shot_table import overlays

__all__ = [
    "Frame", "Scenario", "ScenarioError", "described", "doubts", "film", "load", "locate", "overlays", "run", "scenario", "scenes", "shipped",
    "worlds",
]
