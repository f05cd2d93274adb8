"""Our own method: small networks that see the points' last half second, joined with the local regression; what lost points
very likely are, and filters for noise.
"""

from .combined import cells, ours

__all__ = [
    "cells", "ours",
]
