"""Feet that stand stay where they came down, held by their legs; where a body is carried away from them, they step."""

from .planted import Feet, Footing, legs_of
from .strained_leg import bend_kernel

__all__ = ["Feet", "Footing", "bend_kernel", "legs_of"]
