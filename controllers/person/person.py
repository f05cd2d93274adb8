"""A person: everything that one body can do, under one supervisor."""

from __future__ import annotations

from os import PathLike
from typing import Any

from ..jump import GRAVITY, Jump, Physique, rehearse as rehearse_jump
from ..locomotion import Locomotion
from ..scaled import Scaled
from ..struck import Struck, rehearse as rehearse_strike
from ..supervisor import Supervisor
from . import preparing


def person(locomotion: Any = None, physique: Physique | None = None, gravity=GRAVITY) -> Supervisor:
    """Somebody who walks, runs and jumps, and who stumbles if something strikes him.

    locomotion: a controller or a library's file; the shipped library by default. physique: by default
    a standard adult; another height walks as its legs are long. gravity: (3,) [m/s²] of the jumps.
    LibraryError if the library can't be used; ValueError for a physique or gravity that can't be.
    """
    if not isinstance(physique, Physique | None):
        raise ValueError(f"physique is a Physique, such as Physique(height=1.2), or None for a standard adult; got {physique!r}")
    walker = Locomotion.load(locomotion) if locomotion is None or isinstance(locomotion, str | PathLike) else locomotion
    physique = Physique() if physique is None else physique
    factor = physique.size
    return Supervisor({"locomotion": walker if factor == 1.0 else Scaled(walker, factor),
                       "jump": Jump(physique, gravity), "struck": Struck(physique, gravity)})


def rehearse(someone: Any) -> None:
    """All that somebody can do, done by nobody: steps, also beside things, a jump, a blow and ways to goals past what stands about. No step after it compiles or
    loads anything, so that none halts a game."""
    walker = someone.parts.get("locomotion")
    if walker is not None:
        preparing.place(walker)
        preparing.weight(walker)
        preparing.things(walker)
    if "jump" in someone.parts:
        rehearse_jump(someone.parts["jump"])
    if "struck" in someone.parts:
        rehearse_strike(someone.parts["struck"])
    preparing.goals()


def built(someone: Any, physique: Physique, gravity=GRAVITY) -> Any:
    """The same gaits in another body; a controller that is no person stays as it is."""
    if "jump" not in someone.parts:
        return someone
    walker = someone.parts["locomotion"]
    return person(walker.controller if isinstance(walker, Scaled) else walker, physique, gravity)
