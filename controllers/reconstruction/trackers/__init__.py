"""One network for any trackers and any body: what up to eleven places say, each maybe with an orientation, becomes a whole pose with its
contacts, and the most probable pose on the performer's own skeleton.
"""

from .bodies import bodies, legs
from .ground import GROUND
from .learning import HIDDEN, SIZE, Learner, judged
from .network import SHIPPED, Network
from .packed import packed
from .samples import FIRST, LEGS, Batch, Moments, moments_kernel
from .slots import INPUTS, LAGS, PLACES, SLOTS
from .tracker_poses import Trackers
from .tuning import BATCHES, SHARE, Tuner
from .wearing import exactly, members

__all__ = [
    "BATCHES", "FIRST", "GROUND", "HIDDEN", "INPUTS", "LAGS", "LEGS", "PLACES", "SHARE", "SHIPPED", "SIZE", "SLOTS", "Batch", "Learner", "Moments", "Network", "Trackers",
    "Tuner", "bodies", "exactly", "judged", "legs", "members", "moments_kernel", "packed",
]
