"""Who wears trackers is asked to stand in one pose after the other, so that it is known how they are worn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from .base import say

if TYPE_CHECKING:
    import numpy as np

MOST = 20.0
"""So long [s] a pose is waited for."""
MOVED = 0.15
"""It is another pose than the one before where a tracker has moved so far [m]; poses that move none farther than twice that are not asked for."""
LEAST = 3
"""Fewer poses tell too little."""
_TELL = 5.0


def worn(source: Any, placement: Any, place: np.ndarray, turn: np.ndarray, times: Iterator[float], tell: Callable[[Any], None] | None = None,
         say: Callable[[str], None] = say) -> Any:
    """A `Wearer` who stood with trackers at a place (n, 3) [m] with turns (n, 3, 3) of the room, and then as asked; None if too few poses were seen.

    source: whose points are the room's. times: [s] to ask it at, as they come. tell: hears what is asked (`app.Asked`), each time. say: says what is known.
    """
    from gambol.controllers.reconstruction.calibration import POSES, apart, stance

    first = stance(source.controls, place, turn)
    found = [(place, turn, first)]
    asked = [first]
    for number in range(len(POSES)):
        if number != first and apart(source.controls.joints, asked[-1], number) > 2.0 * MOVED:
            asked.append(number)
    for count, number in enumerate(asked[1:], 2):
        words, pose = list(POSES.items())[number]
        say(f"{count} of {len(asked)}: {words}; hold still for a second ({MOST:.0f} s)")

        known = "" if tell is None or len(found) < LEAST else _fitted(source, placement, found).said(source.controls.names)

        def shown(left: float, points: np.ndarray, words: str = f"{count} of {len(asked)}: {words}, for a second", pose: np.ndarray = pose,
                  known: str = known) -> None:
            if tell is not None:
                from ..app import Asked

                tell(Asked(words, pose, left, placement(points), known))
        seen = _held(source, times, found[-1][0], words, shown, say)
        if seen is not None:
            found.append((*seen, number))
    if len(found) < LEAST:
        say("too few poses were seen: move about instead")
        return None
    wearer = _fitted(source, placement, found)
    left_out = len(found) - wearer.known.heard
    say(f"{wearer.known.heard} poses were seen" + (f", {left_out} more were not as asked and don't count" if left_out else ""))
    return wearer


def _fitted(source: Any, placement: Any, found: list) -> Any:
    """The `Wearer` who stood so: places, turns and the pose's number of each."""
    import numpy as np

    from gambol.controllers.reconstruction.calibration import Wearer

    places, turns, numbers = (list(some) for some in zip(*found, strict=True))
    return Wearer.posed(source.controls, placement, np.array(places), np.array(turns), numbers)


def _held(source: Any, times: Iterator[float], before: np.ndarray, words: str, shown: Callable[[float, np.ndarray], None],
          say: Callable[[str], None]) -> tuple[np.ndarray, np.ndarray] | None:
    """Places (n, 3) [m] and turns (n, 3, 3) of somebody who stands still, otherwise than `before`; None if nobody does in time."""
    import numpy as np

    from gambol.controllers.reconstruction.live import Standing

    standing, began, told = Standing(), None, 0.0
    for now in times:
        began = now if began is None else began
        seen = source.at(now)
        shown(MOST - (now - began), seen)
        standing = standing.watch(now, seen, source.turns)
        if (place := standing.place) is not None and (turn := standing.turn) is not None and np.isfinite(turn).all() and (
                np.linalg.norm(place - before, axis=-1).max() > MOVED):
            return place, turn
        if now - began > MOST:
            say(f"left out: {words}")
            return None
        if now - began > told + _TELL:
            told += _TELL
            say(f"{words}: {MOST - told:.0f} s left")
    return None
