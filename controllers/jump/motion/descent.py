"""The way down: where the centre of mass goes until the lowest point of a jump.

Down it goes by a polynomial; along the floor a standing body falls as an inverted pendulum whose foot is the centre of
pressure, so that the ground gives what that takes from under the soles (see `take_off`).
"""

from __future__ import annotations

import numpy as np

from ...compiled import kernel
from ..body import Start
from .path_estimate import Path
from .take_off import MEETS


def descent(way: Path, start: Start, floor: float, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Place [m], velocity and acceleration (N, 3) of the centre of mass at times (N,) [s], evenly from 0 to the lowest point, as it is
    estimated: what `grounded` begins with. floor: [m].
    """
    assert way.push is not None  # a fall has none, and comes down in the air
    c, v, a = sinking(way, start, times)
    if way.running:
        along = joined(start.centre, start.velocity, np.zeros(3), way.low, way.passing, way.push.force(0.0) + way.gravity, times, way.wind_up)
        for part, flat in zip((c, v, a), along):
            part[:, [0, 2]] = flat[:, [0, 2]]
        return c, v, a
    half = np.linspace(0.0, times[-1], 2 * len(times) - 1)
    sunk, _, bent = sinking(way, start, half)
    rates = (bent[:, 1] + 1e-9 - way.gravity[1]) / (sunk[:, 1] - floor)
    fallen = fallen_kernel(half, rates, start.centre[[0, 2]], (start.centre - start.acceleration / rates[0])[[0, 2]],
                           start.velocity[[0, 2]], way.low[[0, 2]], way.passing[[0, 2]], way.pressed[[0, 2]])
    c[:, [0, 2]], v[:, [0, 2]], a[:, [0, 2]] = fallen
    return c, v, a


def sinking(way: Path, start: Start, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Place [m], velocity and acceleration (N, 3) of the way down at times (N,) [s] until the lowest point, of which the upward part counts.

    A runner goes down by a quartic: how hard the ground meets the foot is left open. A standing body does by a quintic,
    later where `Path.dip` says so.
    """
    assert way.push is not None
    pushed = way.push.force(0.0) + way.gravity
    if way.running:
        return joined(start.centre, start.velocity, None, way.low, way.passing, pushed, times, way.wind_up)
    pushed[1] = min(pushed[1], -MEETS * way.gravity[1])
    lasts = min(way.dip, way.wind_up)
    sinks = start.velocity if way.dip >= way.wind_up else 0.0 * start.velocity
    return joined(start.centre, sinks, start.acceleration, way.low, way.passing, pushed, np.maximum(times - way.wind_up + lasts, 0.0), lasts)


def joined(start, velocity, acceleration, end, end_velocity, end_acceleration, times, t):
    """Place, velocity, acceleration (N, 3) at times (N,) along the quintic with these ends at 0 and t [s], or, without a
    first acceleration, the quartic."""
    place, speed, gain = np.empty((3, len(times), 3))
    still = acceleration is None
    joined_kernel(start, velocity, np.zeros(3) if acceleration is None else acceleration, still, end, end_velocity, end_acceleration, times, float(t), place, speed, gain)
    return place, speed, gain


@kernel
def joined_kernel(start, velocity, acceleration, quartic, end, end_velocity, end_acceleration, times, t, place, speed, gain):
    """Write `joined`'s place, velocity and acceleration (N, 3). quartic: whether its first acceleration is left open."""
    low = 2 if quartic else 3
    for i in range(3):
        v, a = velocity[i], 0.0 if quartic else acceleration[i]
        d, e, f = end[i] - start[i] - v * t - 0.5 * a * t**2, (end_velocity[i] - v - a * t) * t, (end_acceleration[i] - a) * t**2
        if quartic:
            first, second, third = 6.0 * d - 3.0 * e + 0.5 * f, 5.0 * e - 8.0 * d - f, 3.0 * d - 2.0 * e + 0.5 * f
        else:
            first, second, third = 10.0 * d - 4.0 * e + 0.5 * f, 7.0 * e - 15.0 * d - f, 6.0 * d - 3.0 * e + 0.5 * f
        for n in range(len(times)):
            s = times[n] / t
            lower = s ** (low - 2)
            place[n, i] = start[i] + v * times[n] + 0.5 * a * times[n]**2 + lower * s**2 * (first + s * (second + s * third))
            speed[n, i] = v + a * times[n] + lower * s * (low * first + s * ((low + 1) * second + s * (low + 2) * third)) / t
            gain[n, i] = a + lower * (low * (low - 1) * first + s * ((low + 1) * low * second + s * (low + 2) * (low + 1) * third)) / t**2


@kernel
def fallen_kernel(times, rates, start, under, velocity, end, end_velocity, pressed):
    """Along the floor (N, 2) place, velocity and acceleration of a body that falls as an inverted pendulum.

    ẍ = rates (x − p): times, rates: (2 N − 1,) [s], [1/s²], evenly spaced. The centre of pressure p goes from `under` (2,)
    to `pressed` (2,); two bumps on its way, one early and one late, are chosen so that x ends at `end` with `end_velocity` (2,).
    """
    count, step = (len(times) + 1) // 2, times[2] - times[0]
    place, speed = np.empty((count, 4)), np.empty((count, 4))  # x, z without bumps; what each bump adds
    foot = np.zeros((len(times), 4))
    for n in range(len(times)):
        s = times[n] / times[-1]
        for k in range(2):
            foot[n, k] = under[k] + (pressed[k] - under[k]) * s
        foot[n, 2], foot[n, 3] = (1.0 - s) * (1.0 - (1.0 - s) ** 6), s * (1.0 - s**6)
    place[0, :2], speed[0, :2] = start, velocity
    place[0, 2:], speed[0, 2:] = 0.0, 0.0
    for n in range(count - 1):  # Runge's and Kutta's method
        i = 2 * n
        for k in range(4):
            x, v = place[n, k], speed[n, k]
            a1 = rates[i] * (x - foot[i, k])
            v2, a2 = v + 0.5 * step * a1, rates[i + 1] * (x + 0.5 * step * v - foot[i + 1, k])
            v3, a3 = v + 0.5 * step * a2, rates[i + 1] * (x + 0.5 * step * v2 - foot[i + 1, k])
            v4, a4 = v + step * a3, rates[i + 2] * (x + step * v3 - foot[i + 2, k])
            place[n + 1, k] = x + step * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0
            speed[n + 1, k] = v + step * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0
    found = np.empty((3, count, 2))
    determinant = place[-1, 2] * speed[-1, 3] - place[-1, 3] * speed[-1, 2]
    for k in range(2):
        far, fast = end[k] - place[-1, k], end_velocity[k] - speed[-1, k]
        early = (far * speed[-1, 3] - fast * place[-1, 3]) / determinant
        late = (fast * place[-1, 2] - far * speed[-1, 2]) / determinant
        for n in range(count):
            found[0, n, k] = place[n, k] + early * place[n, 2] + late * place[n, 3]
            found[1, n, k] = speed[n, k] + early * speed[n, 2] + late * speed[n, 3]
            found[2, n, k] = rates[2 * n] * (found[0, n, k] - foot[2 * n, k] - early * foot[2 * n, 2] - late * foot[2 * n, 3])
    return found
