"""The world: characters and their controllers, stepped at a fixed rate; performers that play a clip, followers that know a
few points of somebody, and the course that the game opens on.
"""

from .centre_of_mass import jump_of, physique_of
from .courtesy import avoiding
from .course import COURSE, STAGES
from .embodied import Embodied
from .followers import KEPT, Errors, Follows, Hidden, beginning, follower_of, lately
from .learnt_methods import METHODS, NAMES, SHIPPED, TINTS, TURNING, Learning, Methods, compiled, methods, taught, usual
from .performers import walker_of
from .primitive import nearest, posed
from .recorded import Recorded, performance
from .solid import stopped
from .tracked_footage import Filmed
from .watched import Watches, rig, switched, tracked_of, tracked_vertices, tracker_ready, tracking_of, watches_of
from .world import DT, RATE, Character, FixedStep, World, figures, ground_between, pose_between

__all__ = [
    "COURSE", "DT", "KEPT", "METHODS", "NAMES", "RATE", "SHIPPED", "STAGES", "TINTS", "TURNING", "Character", "Embodied", "Errors",
    "Filmed", "FixedStep", "Follows", "Hidden", "Learning", "Methods", "Recorded", "Watches", "World", "avoiding", "beginning",
    "compiled", "figures", "follower_of",
    "ground_between", "jump_of", "lately", "methods", "nearest", "performance", "physique_of", "pose_between", "posed", "rig", "stopped", "switched", "taught",
    "tracked_of", "tracked_vertices", "tracker_ready", "tracking_of", "usual", "walker_of", "watches_of",
]
