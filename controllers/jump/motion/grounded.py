"""A path that the ground can give: where the body goes along the floor until it leaves, found anew by `centroidal` from what was
estimated first, and when it goes down if that takes longer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..body import FLAT, FLEX, Physique, Start, hermite, measures, over, take_off_velocity, uphill
from ..prior import BETWEEN, LEGS
from .centroidal import course_kernel
from .descent import descent, sinking
from .footing import heels_down, heels_rise, settling, standing_soles
from .off_one_foot import STRIDE
from .path_estimate import Course, Path
from .take_off import top
from .thrust import push

KNOTS = 41
"""Until it leaves the floor, the way is looked at so often."""
NEAR, BEGINS = 0.05, 3.0
"""How much it counts to press where the estimate does, and to begin so: the floor's force goes on without a step."""
SLOWER = 1.0, 1.3, 1.6, 2.0
"""A body on two feet takes so many times as long to wind up, until its soles are enough."""
WITHIN = 0.01
"""Soles are enough if the pressure lies no farther than this outside them [m], at standard height."""
AGAIN = 2
"""How high it leaves and where heels rise follow from where it goes: that is found so often again."""
ASTRAY = 0.5
"""No soles are enough for who must leave so far from where it was estimated [m], at standard height."""
HOPELESS = 0.12
"""Nor where the pressure would have to lie so far outside them at first [m]: of 460 courses that could be kept to in the end none began with more than 0.06."""
AGES = 12.0
"""Nobody winds up and pushes longer [s √(m/s²)] than this over the root of gravity."""
LIGHTEST, TALLER = 0.1, 0.02
"""A slower wind-up leaves so much of its weight on the floor at least, and rises no higher than so much [m], at standard height, before it goes down:
who straightens up as he begins would be carried off the floor."""


def grounded(physique: Physique, start: Start, way: Path, floor: float) -> Path:
    """The path with a `Course` that a floor [m] can give, as far as there is one; a path without a push as it is, one that pushes for ages
    without it."""
    if way.push is None or not np.isfinite(np.concatenate([way.low, way.leave, way.velocity])).all():
        return way
    if (way.wind_up + way.push.duration) * np.sqrt(-way.gravity[1] / physique.size) > AGES:
        return replace(way, push=None)
    planted = start.planted(floor, physique.tables)
    best = None
    for scale in SLOWER if start.single is None and start.low is None else SLOWER[:1]:
        slower = replace(way, wind_up=scale * way.wind_up)
        if scale > 1.0:
            sunk, _, bent = sinking(slower, start, np.linspace(0.0, slower.wind_up, KNOTS))
            if (bent[:, 1] < (1.0 - LIGHTEST) * way.gravity[1]).any() or sunk[:, 1].max() > start.centre[1] + TALLER * physique.size:
                break
        course = _course(physique, start, slower, planted, floor, None)
        for _ in range(AGAIN if course.outside < HOPELESS * physique.size else 0):
            if not np.linalg.norm(course.place[-1] - way.leave[[0, 2]]) < ASTRAY * physique.size:
                course = course._replace(outside=np.inf)
                break
            slower = _left(physique, start, slower, planted, course)
            course = _course(physique, start, slower, planted, floor, course)
        if best is None or course.outside < best[1].outside - WITHIN * physique.size:
            best = slower, course
        if course.outside <= WITHIN * physique.size:
            break
    assert best is not None  # there is always one
    return _on(*best) if np.isfinite(best[1].outside) else replace(way, course=best[1])


def _course(physique: Physique, start: Start, way: Path, planted: np.ndarray, floor: float, before: Course | None) -> Course:
    """The way along the floor until it leaves, for this way up and down. before: the one found last, which tells where heels rise."""
    assert way.push is not None
    until = way.wind_up + way.push.duration
    half = np.linspace(0.0, until, 2 * KNOTS - 1)
    down, pushing = half[half < way.wind_up], half[half >= way.wind_up] - way.wind_up
    sunk, _, bent = sinking(way, start, down)
    height = np.concatenate([sunk[:, 1], way.low[1] + way.push.moved(pushing, 0.0 * way.passing)[0][:, 1]])
    force = np.concatenate([bent[:, 1] - way.gravity[1], way.push.force(pushing)[:, 1]])
    times, (guess, place) = half[::2], _guess(start, way, floor)
    share = np.clip((times - way.wind_up) / way.push.duration, 0.0, 1.0)
    centres = np.empty((KNOTS, 3))
    centres[:, [0, 2]], centres[:, 1] = place if before is None else before.place, height[::2]
    height -= floor + start.levels.mean()
    feet = settling(start, planted, physique.tables, times, way.wind_up, way.push.duration)
    flat = np.ones(feet.shape[:2], bool)
    if start.single is not None:  # whose hips are under his mass; who crouches on two feet sits back, heels down
        flat = heels_down(centres, feet, physique.tables, FLEX * physique.flexibility - uphill(planted, start.slope))
    flat &= (share <= heels_rise(start, planted, centres, share, way.push.duration))[:, None]
    feet[..., 1] -= planted[:, 1] - planted[0, 1]  # as if it were level
    hulls, counts = standing_soles(feet, float(planted[0, 1]), flat, start.single, physique.tables)
    near = np.full(KNOTS, NEAR)
    near[0] = BEGINS
    place, velocity, pressed = (np.empty((KNOTS, 2)) for _ in range(3))
    outside = course_kernel(times[1], force / height, np.stack([start.centre[[0, 2]], start.velocity[[0, 2]]]), way.airtime, way.land[[0, 2]],
                            way.leave[[0, 2]], guess, near, hulls, counts, place, velocity, pressed)
    lean = float((np.linalg.norm(place - pressed, axis=1) / height[::2]).max())
    return Course(times, place, velocity, pressed, float(outside), lean)


def _guess(start: Start, way: Path, floor: float) -> Iterator[np.ndarray]:
    """Where the estimate presses and where its centre of mass is (KNOTS, 2) x, z, evenly from the start until it leaves."""
    assert way.push is not None
    before = np.linspace(0.0, way.wind_up, KNOTS)
    pushing = np.linspace(0.0, way.push.duration, KNOTS)[1:-1]
    c, _, a = descent(way, start, floor, before)
    gone = way.push.moved(pushing, way.passing)[0]
    centres = np.concatenate([c, way.low + gone])
    force = np.concatenate([a - way.gravity, way.push.force(pushing)])
    pressed = centres - force * ((centres[:, 1] - floor) / np.maximum(force[:, 1], 1e-3 * -way.gravity[1]))[:, None]
    known, times = np.concatenate([before, way.wind_up + pushing]), np.linspace(0.0, way.wind_up + way.push.duration, KNOTS)
    return (np.ascontiguousarray(np.stack([np.interp(times, known, part[:, k]) for k in (0, 2)], 1)) for part in (pressed, centres))


def _left(physique: Physique, start: Start, way: Path, planted: np.ndarray, course: Course) -> Path:
    """The path that leaves where the course does, as high as its legs then reach."""
    leave = way.leave.copy()
    leave[[0, 2]] = course.place[-1]
    assert way.push is not None  # `grounded` has looked
    if not start.runs:
        leave[1] = top(physique, start, way.keys[2 * BETWEEN, :LEGS], start.pushing(planted), start.heading, leave, way.velocity, way.push.duration)
    else:
        assert start.single is not None  # who runs pushes off one foot
        tall, ball = STRIDE * measures(physique).leave(0.0), planted[start.single, :3]
        before, after = (over(tall, float(np.linalg.norm((place - ball) * FLAT))) for place in (way.leave, leave))
        leave[1] += after - before
    leave[1] = max(leave[1], way.low[1] + 0.25 * (way.leave[1] - way.low[1]))
    return _on(replace(way, leave=leave), course)


def _on(way: Path, course: Course) -> Path:
    """The path along a course: its lowest point, take-off and velocities as the course has them."""
    low, passing, leave = way.low.copy(), way.passing.copy(), way.leave.copy()
    leave[[0, 2]] = course.place[-1]
    low[[0, 2]] = hermite(course.times, course.place, course.velocity, [way.wind_up])[0]
    assert way.push is not None
    before, after = (hermite(course.times, course.place, course.velocity, [way.wind_up + shift])[0] for shift in (-1e-4, 1e-4))
    passing[[0, 2]] = (after - before) / 2e-4
    velocity = take_off_velocity(leave, way.land, way.airtime, way.gravity)
    return replace(way, low=low, passing=passing, leave=leave, velocity=velocity, push=push(leave - low, passing, velocity, way.gravity, way.push.springs), course=course)
