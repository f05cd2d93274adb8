"""A person: everything that one body can do, under one supervisor; and `preparing`, which compiles what that takes; and what it will do in
the next second.
"""

from . import preparing
from .forecast import Forecast, forecast
from .person import built, person, rehearse

__all__ = [
    "Forecast", "built", "forecast", "person", "preparing", "rehearse",
]
