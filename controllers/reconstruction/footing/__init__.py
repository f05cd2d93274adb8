"""Feet that stand stay where they came down, held by their legs; where a body is carried away from them, they step."""

from .planted import Feet, Footing

__all__ = ["Feet", "Footing"]
