"""What a character is: rotations, skeletons and their kinematics, poses and clips, the standard human."""

from . import rotations
from .anatomy import Anatomy, anatomy, centre_in_pose, centre_of_mass, joint_limits, segment_centres
from .brief import brief
from .ccd import ccd_kernel, foot_turn_kernel
from .clip import Clip, Pose, mirror_index
from .contact import (HEIGHT_GATE, RELEASE, WALK_SPEEDS, contact_height, contact_points, detect_contacts, feet_apart,
                      foot_drift, heel_offset, point_speeds)
from .ground_frame import advance, compose, relative, screw, stacked
from .human import CONTACT_HEIGHT, HEEL, STATURE, human
from .ik import distance_kernel, pole_of, two_bone, two_bone_kernel, two_bone_turns, two_bone_turns_kernel
from .rotation_kernels import exp_kernel, log_kernel, product_kernel, quaternion_kernel, relative_kernel
from .rotations import between, carried, exp, heading_of, log, mean, wrap, yaw
from .skeleton import Skeleton, end_positions, forward_kinematics, local_rotations
from .springs import damp, damp_kernel, settle, spring_kernel
from .support_polygon import (HALF_SOLE, centroid_kernel, hull, hull_kernel, margin, margin_kernel, sole_corners,
                              standing_corners)

__all__ = [
    "CONTACT_HEIGHT", "HALF_SOLE", "HEEL", "HEIGHT_GATE", "RELEASE", "STATURE", "WALK_SPEEDS", "Anatomy", "Clip", "Pose",
    "Skeleton", "advance", "anatomy", "between", "brief", "carried", "ccd_kernel", "centre_in_pose", "centre_of_mass", "centroid_kernel", "compose",
    "contact_height", "contact_points", "damp", "damp_kernel", "detect_contacts", "distance_kernel", "end_positions", "exp",
    "exp_kernel", "feet_apart", "foot_drift", "foot_turn_kernel", "forward_kinematics", "heading_of", "heel_offset",
    "hull", "hull_kernel", "human", "joint_limits", "local_rotations", "log", "log_kernel", "margin", "margin_kernel",
    "mean", "mirror_index", "point_speeds", "pole_of", "product_kernel", "quaternion_kernel", "relative", "relative_kernel",
    "rotations", "screw", "segment_centres", "settle", "sole_corners", "spring_kernel", "stacked", "standing_corners", "two_bone", "two_bone_kernel",
    "two_bone_turns", "two_bone_turns_kernel", "wrap", "yaw",
]
