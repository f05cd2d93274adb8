"""Walking to a goal as people do, by optimal control: Mombaur, Truong and Laumond 2010."""

from .plan import Plan
from .planner import plan, plans
from .walking_cost import Weights
from .weights import HUMAN, PUBLISHED

__all__ = ["HUMAN", "PUBLISHED", "Plan", "Weights", "plan", "plans"]
