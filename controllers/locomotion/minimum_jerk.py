"""Smooth ways: of a share, and of least jerk to a place of rest."""

from __future__ import annotations

from ..compiled import kernel


@kernel
def smooth(share):
    """From 0 to 1, and level at both ends, as a share does; what is beyond them stays there."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@kernel
def smoothest(x, v, a, whole, s, order):
    """The smoothest way (minimum jerk, Flash and Hogan 1985) from place x, speed v and acceleration a to rest at 0 in `whole` seconds, after the share s of that
    time: its place (order 0), speed (1) or acceleration (2)."""
    v, a = v * whole, 0.5 * a * whole * whole
    p, q, r = -10.0 * x - 6.0 * v - 3.0 * a, 15.0 * x + 8.0 * v + 3.0 * a, -6.0 * x - 3.0 * v - a
    if order == 0:
        return x + s * (v + s * (a + s * (p + s * (q + s * r))))
    if order == 1:
        return (v + s * (2.0 * a + s * (3.0 * p + s * (4.0 * q + s * 5.0 * r)))) / whole
    return (2.0 * a + s * (6.0 * p + s * (12.0 * q + s * 20.0 * r))) / (whole * whole)
