"""What ours is measured against: the paper's three rivals, and what one would try today."""

from .gplvm import SGPLVM
from .local import LOOSE, LocalPCA, LocalPCR, Nearest
from .regressors import Adam, Layers, backward, forward, network, ridge, starting
from .windows import Samples

__all__ = [
    "LOOSE", "SGPLVM", "Adam", "Layers", "LocalPCA", "LocalPCR", "Nearest", "Samples", "backward", "forward", "network",
    "ridge", "starting",
]
