"""The weights of the cost, published ones and fitted ones."""

from __future__ import annotations

from .walking_cost import Weights

PUBLISHED = Weights(1.0, 1.2, 1.7, 0.7, 5.2)
"""Mombaur, Truong and Laumond 2010."""
HUMAN = Weights(1.0, 0.35, 0.03, 1.0, 2.2)
"""People's speeds."""
