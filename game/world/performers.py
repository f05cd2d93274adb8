"""Who is shown as somebody moved once, a clip's or a film's, and what takes him further than that."""

from __future__ import annotations

from typing import Any

from .recorded import Recorded
from .tracked_footage import Filmed


def walker_of(performer: Any) -> Any:
    """The controller that walks for those who follow a performer, or join him; the performer's own where it walks itself."""
    return performer.walker if isinstance(performer, Recorded | Filmed) else performer
