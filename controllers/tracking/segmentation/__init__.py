"""Who is where in a picture: two regions with Gaussians of their own everywhere, and the model's shape; eq. (15) of Rosenhahn 2007."""

from .level_set import SEGMENTATION, Cutting, Segmentation, Segmented, costs_of, energy, segmented
from .local_gaussians import features_of, in_company, likelihood_ratio
from .signed_distance import signed_distance
from .total_variation import cheapest, gap

__all__ = [
    "SEGMENTATION", "Cutting", "Segmentation", "Segmented", "cheapest", "costs_of", "energy", "features_of", "gap", "in_company", "likelihood_ratio", "segmented",
    "signed_distance",
]
