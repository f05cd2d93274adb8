"""One network for any trackers and any body: what up to eleven places say, each maybe with an orientation, becomes a whole pose with its
contacts, and the most probable pose on the performer's own skeleton.
"""

from .bodies import bodies
from .learning import HIDDEN, SIZE, Learner
from .network import SHIPPED, Network
from .samples import Moments, standing, tracks_of
from .slots import INPUTS, LAGS, PLACES, SLOTS
from .tracker_poses import Trackers

__all__ = [
    "HIDDEN", "INPUTS", "LAGS", "PLACES", "SHIPPED", "SIZE", "SLOTS", "Learner", "Moments", "Network", "Trackers", "bodies", "standing", "tracks_of",
]
