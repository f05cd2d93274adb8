"""Footage on disk: what calibrated cameras filmed, by Gambol's studio or in the world, checked as it is read; and where a track of
somebody in it begins.
"""

from .first_frames import clicked_pose, exchanged_clicks, first_poses, person_in, seen_in, settled
from .footage import FASTEST, Footage, FootageError, begun, checked, complete, file_of, fingerprint, lost_frames, read_footage

__all__ = [
    "FASTEST", "Footage", "FootageError", "begun", "checked", "clicked_pose", "complete", "exchanged_clicks", "file_of", "fingerprint", "first_poses", "lost_frames", "person_in",
    "read_footage", "seen_in", "settled",
]
