"""What leap somebody can make who asks for one in a state, and the search for it, a piece in each step."""

from .searches import Searches

__all__ = ["Searches"]
