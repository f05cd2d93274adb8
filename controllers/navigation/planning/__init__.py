"""Walking to a goal as people do, by optimal control: Mombaur, Truong and Laumond 2010."""

from .in_time import plan_in_time
from .limits import too_near
from .walk_plan import Plan
from .goal_planner import FREE, plan, plans, rehearse, unfit
from .walking_cost import Weights
from .weights import HUMAN, PUBLISHED, WeightsError, in_toml, read_weights

__all__ = ["FREE", "HUMAN", "PUBLISHED", "Plan", "Weights", "WeightsError", "in_toml", "plan", "plan_in_time", "plans", "read_weights", "rehearse",
           "too_near", "unfit"]
