"""Heels and balls: where the blend has them, and where they are shown."""

from __future__ import annotations

import math

from ..compiled import kernel


@kernel
def foot_points(body, legs, positions, orientations, out):
    """Left heel, left ball, right heel, right ball (4, 3) of a pose, in its own frame."""
    for foot in range(2):
        a = legs.hip[foot] + 2
        for i in range(3):
            heel = positions[a, i]
            for k in range(3):
                heel += orientations[a, i, k] * body.heel[k]
            out[2 * foot, i] = heel
            out[2 * foot + 1, i] = positions[a + 1, i]


@kernel
def toe_ends(body, legs, positions, orientations, out):
    """From both balls of a pose to their toes' ends (2, 3), in its own frame."""
    for foot in range(2):
        t = legs.hip[foot] + 3
        for i in range(3):
            out[foot, i] = 0.0
            for k in range(3):
                out[foot, i] += orientations[t, i, k] * body.toe_end[k]


@kernel
def on_floor(m, out):
    """Where the blend's contact points are along the floor (4, 2): x, z in the world."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(4):
        out[k, 0] = m.ground[0] + c * m.points[k, 0] + s * m.points[k, 2]
        out[k, 1] = m.ground[1] - s * m.points[k, 0] + c * m.points[k, 2]


@kernel
def shown_kernel(m, k, out):
    """Where contact point k is shown along the floor: x, z in the ground frame, into `out` (2,)."""
    foot = k // 2
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = m.offset[foot, 0] + m.aside[foot, 0], m.offset[foot, 1] + m.aside[foot, 1]
    ball = m.points[2 * foot + 1]
    out[0], out[1] = ball[0] + c * x - s * z, ball[2] + s * x + c * z
    if k == 2 * foot:
        c, s = math.cos(m.offset[foot, 2]), math.sin(m.offset[foot, 2])
        x, z = m.points[k, 0] - ball[0], m.points[k, 2] - ball[2]
        out[0] += c * x + s * z
        out[1] += c * z - s * x


@kernel
def ball_kernel(m, foot, out):
    """Where a foot's ball is shown: x, z in the world, into `out` (2,)."""
    shown_kernel(m, 2 * foot + 1, out)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = out[0], out[1]
    out[0], out[1] = m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z
