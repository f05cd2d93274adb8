"""What there is to see of a jump: its arc and where it lands, what the body balances on, what pushes it.

After Ooi 2015, chapter 4. Layers: "jump" the arc (`gambol.game.explain.jump_preview`), "balance" centre of mass and support polygon,
"forces" muscles, weight and the ground's push (`gambol.game.explain.forces`).
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace

from gambol.controllers.jump.motion import Plan

from ..scene import Figure, Overlays
from ..world import Character, World, jump_of
from .forces import Body, balance, forces, planned, pushed
from .jump_preview import Preview, plan_of
from .jump_sketches import aimed, flown

LAYERS = ("jump", "balance", "forces")
WIDE = 58
"""Letters in a line of a picture's corner."""


def explained(figures: Sequence[Figure], before: World, after: World, alpha: float, overlays: Overlays,
              previews: Sequence[Preview | None] = ()) -> tuple[Figure, ...]:
    """The figures of `gambol.game.world.world.figures` with all that the overlays show of their jumps.

    previews: of the first characters, where they aim.
    """
    if not any(getattr(overlays, layer) for layer in LAYERS):
        return tuple(figures)
    drawn = []
    for n, (figure, old, new) in enumerate(zip(figures, before.characters, after.characters)):
        now, sketches = moment_of(old, new, alpha), []
        if overlays.jump:
            seen = previews[n] if n < len(previews) else None
            if seen is not None:
                sketches += aimed(seen, after.props)
            if now is not None:
                sketches += flown(*now)
        if overlays.balance or overlays.forces:
            body = Body.of(new, figure)
            if overlays.balance:
                sketches += balance(body, after.props)
            if overlays.forces:
                g = -float(jump.gravity[1]) if (jump := jump_of(new.controller)) else 9.81
                sketches += forces(body, pushed(new, body.physique, g) if now is None else planned(*now), g)
        drawn.append(replace(figure, sketches=tuple(sketches)))
    return tuple(drawn)


def broken(line: str) -> tuple[str, ...]:
    """A long line in parts that fit into a corner of the picture."""
    return tuple(textwrap.wrap(line, WIDE))


def moment_of(old: Character, new: Character, alpha: float) -> tuple[Plan, float] | None:
    """The jump that is drawn, and how far it is [s], `alpha` of the way between two worlds."""
    after, before = plan_of(new), plan_of(old)
    if after is None:
        return None
    start = before[1] if before is not None and before[0] is after[0] else 0.0
    return after[0], start + alpha * (after[1] - start)
