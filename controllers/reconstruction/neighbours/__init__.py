"""The most alike recorded moments (Mousas 2014, 3): what makes segments alike, and five ways to find the nearest, exact, by
tree, by neighbour graph, by cells and by Faiss.
"""

from .cells import Cells
from .features import Weights
from .graph import Graph
from .lists import MANY, Lists, at_hand
from .search import Exact
from .segments import Neighbourhood, Segments
from .tree import Tree

__all__ = [
    "MANY", "Cells", "Exact", "Graph", "Lists", "Neighbourhood", "Segments", "Tree", "Weights", "at_hand",
]
