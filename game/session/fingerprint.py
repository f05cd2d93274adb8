"""What tells one motion from another: who moves, and where everybody is."""

from __future__ import annotations

import hashlib
import zlib

import numpy as np

from gambol.controllers.contract import Controller

from .state import SessionState


def digest(controller: Controller) -> str:
    """What tells the motion of one controller from that of another: its kind and its gaits, with which a library's starts, turns and idling are taken to go."""
    library, hashed = controller.library, hashlib.sha256(controller.kind.encode())
    if library is not None:
        for array in (library.velocities, library.coefficients, library.reference):
            hashed.update(np.ascontiguousarray(array).data)
    return hashed.hexdigest()[:16]


def fingerprint(moment: SessionState) -> int:
    """A checksum of where everybody is, to notice where a replay goes another way."""
    print_ = 0
    for character in moment.after.characters:
        for array in (character.state.ground, character.state.pose.root, character.state.pose.rotations):
            print_ = zlib.crc32(np.ascontiguousarray(array).data, print_)
    return print_
