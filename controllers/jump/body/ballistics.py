"""Arcs: where a centre of mass goes in the air, and what take-off an arc needs.

Ooi 2015, 3.1.1 "Path estimation" prints no formula; it is
x = x0 + v t + ½ g t², and so v = (x − x0) / t − ½ g t, between the *centres of mass* at take-off
and at landing.
"""

from __future__ import annotations

import numpy as np

from ...compiled import kernel
from .dynamics import GRAVITY


def take_off_velocity(start, end, airtime, gravity=GRAVITY) -> np.ndarray:
    """The velocity (..., 3) [m/s] with which a body leaves `start` to be at `end` after `airtime`.

    start, end, gravity: (..., 3) [m, m/s²]. airtime: (...) [s], above 0.
    """
    airtime = np.asarray(airtime, float)[..., None]
    return (np.asarray(end, float) - start) / airtime - 0.5 * np.asarray(gravity) * airtime


def along(start, velocity, time, gravity=GRAVITY) -> np.ndarray:
    """Where (..., 3) [m] a body is `time` (...) [s] after it left `start` with `velocity`."""
    time = np.asarray(time, float)[..., None]
    return start + np.asarray(velocity) * time + 0.5 * np.asarray(gravity) * time**2


def least_effort(start, end, velocity=(0.0, 0.0, 0.0), gravity=GRAVITY) -> float:
    """The airtime [s] whose take-off changes the `velocity` of the run-up least.

    ‖d/t − ½ g t − v0‖² is least where ¼ g² t⁴ + ½ (g·v0) t³ + (d·v0) t − d² = 0 (d = end − start);
    from rest t⁴ = 4 d² / g². 0 if there is nowhere to go.
    """
    d, g, v = np.asarray(end, float) - start, np.asarray(gravity, float), np.asarray(velocity, float)
    along_g, along_v, square = float(g @ v), float(d @ v), float(d @ d)
    if along_g == 0.0:  # one positive root
        return airtime_kernel(float(g @ g), along_v, square)
    roots = np.roots([float(0.25 * g @ g), 0.5 * along_g, 0.0, along_v, -square])
    real = roots[(np.abs(roots.imag) < 1e-7 * (1.0 + np.abs(roots))) & (roots.real > 1e-9)].real
    if not len(real):
        return 0.0
    effort = [np.sum((take_off_velocity(start, end, t, g) - v) ** 2) for t in real]
    return float(real[int(np.argmin(effort))])


@kernel
def airtime_kernel(g, v, d):
    """The positive root of ¼ g t⁴ + v t − d, by Newton's method from beyond it: from there on the quartic is convex."""
    t = max((4.0 * d / g) ** 0.25, (4.0 * abs(v) / g) ** (1.0 / 3.0)) * 2.0 ** (1.0 / 3.0)
    for _ in range(60):
        step = (0.25 * g * t**4 + v * t - d) / (g * t**3 + v) if t > 0.0 else 0.0
        t -= step
        if step < 1e-12 * t:
            break
    return t


def apex_airtime(start, end, height, gravity=GRAVITY) -> float:
    """The airtime [s] of an arc whose top lies `height` [m] above `start`.

    For gravity straight down. ValueError if `end` lies above that top.
    """
    g = -float(np.asarray(gravity)[1])
    up = float(np.asarray(end)[1] - np.asarray(start)[1])
    if height < max(up, 0.0):
        raise ValueError(f"an arc {height:.2f} m high never comes to {up:.2f} m")
    return float(np.sqrt(2.0 * height / g) + np.sqrt(2.0 * max(height - up, 0.0) / g))
