"""What a character is: rotations, skeletons and their kinematics, poses and clips, the standard human."""

from .clip import Clip, Pose
from .human import human
from .skeleton import Skeleton, end_positions, forward_kinematics, local_rotations

__all__ = ["Clip", "Pose", "Skeleton", "end_positions", "forward_kinematics", "human", "local_rotations"]
