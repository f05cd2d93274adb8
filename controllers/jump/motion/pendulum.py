"""A body that falls ahead about what it presses, an inverted pendulum, and pushes off then: see `take_off`."""

from __future__ import annotations

import math

from ...compiled import kernel


@kernel
def waiting_kernel(quick, longest, reach, middle, fixed, found):
    """How long [s] a body falls ahead before it pushes: `quick`, or longer, if it would have to press farther than `reach` [m]
    from the middle (3,) of its soles. fixed, found: as `fall_kernel` takes and writes them."""
    if _short(quick, middle, fixed, found) <= reach or longest <= quick:
        return quick
    if _short(longest, middle, fixed, found) > reach:
        return longest
    low, high = quick, longest
    while high - low > 1e-4:
        wind_up = 0.5 * (low + high)
        if _short(wind_up, middle, fixed, found) > reach:
            low = wind_up
        else:
            high = wind_up
    fall_kernel(high, fixed, found)
    return high


@kernel
def _short(wind_up, middle, fixed, found):
    """How far [m] from the middle of the soles a body presses that falls so long [s]."""
    fall_kernel(wind_up, fixed, found)
    return math.hypot(found[3, 0] - middle[0], found[3, 2] - middle[2])


@kernel
def fall_kernel(wind_up, fixed, found):
    """The fall of `wind_up` seconds that ends in a push, to be at `land` (3,) after `flight` [s].

    fixed: the push's duration [s] and its moments (see `thrust.moments`); early, late: [1/s] the speed that it gives for each metre that the body is ahead of what it
    presses, as it begins and as it ends; rate: [1/s] of a pendulum of that height; centre, velocity: (3,) of the start; pressed:
    (3,) where the push begins; toes, land: (3,); flight. found: (4, 3) written: where the body is lowest and where it leaves,
    the velocity with which it is lowest, and where it presses until then. Heights are not told.
    """
    duration, (m0, m1, m2), early, late, rate, centre, velocity, pressed, toes, land, flight = fixed
    falls = rate / math.tanh(0.5 * rate * wind_up)  # a pendulum's speed for each metre that it has fallen
    swing = rate * wind_up
    # unknown are the lowest point and the take-off: the speed gained, then the way gone
    a, b = falls + early * (m0 - m1), late * m1 + 1.0 / flight
    c = 1.0 + duration * (falls + early * (m0 - 2.0 * m1 + m2))
    d = duration * late * (m1 - m2) - 1.0
    for i in range(3):
        begun = falls * centre[i] + velocity[i]
        gains = land[i] / flight + begun + early * (m0 - m1) * pressed[i] + late * m1 * toes[i]
        goes = duration * (begun + early * (m0 - 2.0 * m1 + m2) * pressed[i] + late * (m1 - m2) * toes[i])
        low = (d * gains - b * goes) / (a * d - b * c)
        fallen = (low - centre[i] - velocity[i] * math.sinh(swing) / rate) / (math.cosh(swing) - 1.0)
        found[0, i], found[1, i] = low, (a * goes - c * gains) / (a * d - b * c)
        found[2, i], found[3, i] = falls * (low - centre[i]) - velocity[i], centre[i] - fallen
    found[2, 1] = 0.0
