"""A person: everything that one body can do, under one supervisor."""

from __future__ import annotations

from pathlib import Path

from .jump import GRAVITY, Jump, Physique
from .locomotion import Locomotion
from .supervisor import Supervisor


def person(locomotion: Locomotion | str | Path | None = None, physique: Physique | None = None,
           gravity=GRAVITY) -> Supervisor:
    """Somebody who walks, runs and jumps.

    locomotion: a controller or a library's file; the shipped library by default. physique: by default
    an adult of the locomotion's own height. gravity: (3,) [m/s²] of the jumps.
    LibraryError if the library can't be used; ValueError for a physique or gravity that can't be.
    """
    walker = locomotion if hasattr(locomotion, "step") else Locomotion.load(locomotion)
    if physique is None:
        physique = Physique()
    return Supervisor({"locomotion": walker, "jump": Jump(physique, gravity)})
