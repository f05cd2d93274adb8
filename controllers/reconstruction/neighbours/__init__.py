"""The most alike recorded moments (Mousas 2014, 3): what makes segments alike, and four ways to find the nearest, exact, by
tree, by neighbour graph and by cells.
"""

from .cells import Cells
from .features import Weights
from .graph import Graph
from .search import Exact
from .segments import Neighbourhood, Segments
from .tree import Tree

__all__ = [
    "Cells", "Exact", "Graph", "Neighbourhood", "Segments", "Tree", "Weights",
]
