"""Where feet come down next, if somebody goes on as they are asked to: a sole on the floor for each, paler the later."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gambol.controllers.body import CONTACT_HEIGHT, contact_height
from gambol.controllers.contract import but
from gambol.controllers.person import forecast

from ..scene import Figure, Overlays, Patch
from ..world import Character, World

AHEAD = 1.0
"""So far is looked ahead [s]."""
TINTS = ((0.02, 0.20, 0.62), (0.62, 0.07, 0.04))
"""Of the left sole and of the right one."""
SOLE = np.array([(-0.030, -0.17), (0.030, -0.17), (0.038, -0.10), (0.045, 0.0), (0.030, 0.07), (0.0, 0.085), (-0.030, 0.07), (-0.045, 0.0),
                 (-0.038, -0.10)])
"""A standard body's sole about its ball [m]: to the left and ahead."""
OVER = 0.006
"""So high over its floor it lies [m]."""


def stepping(figures: Sequence[Figure], after: World, overlays: Overlays) -> tuple[Figure, ...]:
    """The figures, those who walk with their coming footholds, where contacts are shown."""
    if not overlays.contacts:
        return tuple(figures)
    return tuple(replace(figure, sketches=(*figure.sketches, *_soles(one))) for figure, one in zip(figures, after.characters, strict=True))


def _soles(one: Character) -> list[Patch]:
    if one.state.active not in ("", "locomotion") or one.intent.points is not None or not one.opacity:
        return []
    told = forecast(one.controller, one.state, but(one.intent, leap=None, aim=None, strike=None, sighting=None), AHEAD)
    rests = contact_height(one.controller.skeleton)
    left, ahead = rests / CONTACT_HEIGHT * SOLE.T
    soles = []
    for when, (x, y, z, heading), tint in zip(told.when, told.foothold, TINTS):
        if np.isfinite(when):
            c, s = np.cos(heading), np.sin(heading)
            corners = np.stack([x + c * left + s * ahead, np.full(len(SOLE), y - rests + OVER), z - s * left + c * ahead], -1)
            soles.append(Patch("contacts", corners, tint, 0.75 * (1.0 - 0.6 * when / AHEAD)))
    return soles
