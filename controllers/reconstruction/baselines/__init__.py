"""What ours is measured against: the paper's three rivals, and what one would try today."""

from .gplvm import SGPLVM
from .local import LocalPCA, LocalPCR, Nearest
from .regressors import Layers, network, ridge
from .windows import Samples

__all__ = ["SGPLVM", "Layers", "LocalPCA", "LocalPCR", "Nearest", "Samples", "network", "ridge"]
