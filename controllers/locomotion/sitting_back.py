"""A trunk that leans against the ground's push as its body brakes.

Blends of steady gaits lean as at each moment's speed: a run's lean would last through its stop.
"""

from __future__ import annotations

from ..body import spring_kernel
from ..compiled import kernel

AGAINST = 0.06
"""So far [rad] a trunk leans for each m/s² that its body brakes by: in recorded walks that stop, at about 1 m/s², it goes from 0° or 1° ahead to 3° or 4° back,
and stands 2° to 3° back; no stop of a run is recorded."""
MOST = 0.22
"""The most that it leans [rad]."""
HALFLIFE = 0.18
"""Half-life of its lean [s]."""
LEVEL = 0.5
"""The share that the neck takes back: eyes stay on where one goes."""


@kernel
def sit_back(m, neck, row, dt):
    """Lean the three joints below `neck` of a series row for dt."""
    goal = 0.0
    if m.rate[0] * m.command[0] < 0.0:
        goal = min(max(AGAINST * m.rate[0], -MOST), MOST)
    m.braked[0], m.braked[1] = spring_kernel(m.braked[0], m.braked[1], goal, HALFLIFE, dt)
    for j in range(neck - 3, neck):
        row[j] += m.braked[0] / 3.0
    row[neck] -= LEVEL * m.braked[0]
