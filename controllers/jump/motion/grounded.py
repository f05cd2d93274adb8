"""A path that the ground can give: where the body goes along the floor until it leaves, found anew by `centroidal` from what was
estimated first, and when it goes down if that takes longer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..body import FLAT, HEEL_UP, TAKE_OFF_REACH, Physique, Start, hermite, measures, over, stretched, take_off_velocity
from ..prior import BETWEEN, LEGS
from .centroidal import course_kernel
from .descent import descent, sinking
from .footing import heels_rise, standing_soles
from .path_estimate import Course, Path
from .take_off import STRIDE
from .thrust import push

KNOTS = 41
"""Until it leaves the floor, the way is looked at so often."""
NEAR, BEGINS = 0.05, 3.0
"""How much it counts to press where the estimate does, and to begin so: the floor's force goes on without a step."""
SLOWER = 1.0, 1.3, 1.6, 2.0
"""A body on two feet takes so many times as long to wind up, until its soles are enough."""
WITHIN = 0.01
"""Soles are enough if the pressure lies no farther than this outside them [m], at standard height."""
LIGHTEST = 0.1
"""A slower wind-up leaves so much of its weight on the floor at least."""


def grounded(physique: Physique, start: Start, way: Path, floor: float) -> Path:
    """The path with a `Course` that a floor [m] can give, as far as there is one; a path without a push as it is."""
    if way.push is None or not np.isfinite(np.concatenate([way.low, way.leave, way.velocity])).all():
        return way
    planted = start.planted(floor, physique.tables)
    best = None
    for scale in SLOWER if start.single is None and start.low is None else SLOWER[:1]:
        slower = replace(way, wind_up=scale * way.wind_up)
        if scale > 1.0 and (sinking(slower, start, np.linspace(0.0, slower.wind_up, KNOTS))[2][:, 1] < (1.0 - LIGHTEST) * way.gravity[1]).any():
            break
        slower = _left(physique, start, slower, planted, _course(physique, start, slower, planted, floor), floor)
        course = _course(physique, start, slower, planted, floor)
        if best is None or course.outside < best[1].outside - WITHIN * physique.size:
            best = slower, course
        if course.outside <= WITHIN * physique.size:
            break
    assert best is not None  # there is always one
    return _on(*best)


def _course(physique: Physique, start: Start, way: Path, planted: np.ndarray, floor: float) -> Course:
    """The way along the floor until it leaves, for this way up and down."""
    assert way.push is not None
    until = way.wind_up + way.push.duration
    half = np.linspace(0.0, until, 2 * KNOTS - 1)
    down, pushing = half[half < way.wind_up], half[half >= way.wind_up] - way.wind_up
    sunk, _, bent = sinking(way, start, down)
    height = np.concatenate([sunk[:, 1], way.low[1] + way.push.moved(pushing, 0.0 * way.passing)[0][:, 1]]) - floor
    force = np.concatenate([bent[:, 1] - way.gravity[1], way.push.force(pushing)[:, 1]])
    times, guess = half[::2], _guess(start, way, floor)
    share = np.clip((times - way.wind_up) / way.push.duration, 0.0, 1.0)
    flat = share <= heels_rise(start, planted, guess[1], share)
    hulls, counts = standing_soles(start, planted, physique.tables, times, flat)
    near = np.full(KNOTS, NEAR)
    near[0] = BEGINS
    place, velocity, pressed = (np.empty((KNOTS, 2)) for _ in range(3))
    outside = course_kernel(times[1], force / height, np.stack([start.centre[[0, 2]], start.velocity[[0, 2]]]), way.airtime, way.land[[0, 2]],
                            way.leave[[0, 2]], guess[0], near, hulls, counts, place, velocity, pressed)
    lean = float((np.linalg.norm(place - pressed, axis=1) / height[::2]).max())
    return Course(times, place, velocity, pressed, float(outside), lean)


def _guess(start: Start, way: Path, floor: float) -> tuple[np.ndarray, np.ndarray]:
    """Where the estimate presses (KNOTS, 2), x and z, and where its centre of mass is (KNOTS, 3), evenly from the start until it leaves."""
    assert way.push is not None
    before = np.linspace(0.0, way.wind_up, KNOTS)
    pushing = np.linspace(0.0, way.push.duration, KNOTS)[1:-1]
    c, _, a = descent(way, start, floor, before)
    gone = way.push.moved(pushing, way.passing)[0]
    centres = np.concatenate([c, way.low + gone])
    force = np.concatenate([a - way.gravity, way.push.force(pushing)])
    pressed = centres - force * ((centres[:, 1] - floor) / np.maximum(force[:, 1], 1e-3 * -way.gravity[1]))[:, None]
    known, times = np.concatenate([before, way.wind_up + pushing]), np.linspace(0.0, way.wind_up + way.push.duration, KNOTS)
    rows = np.concatenate([pressed[:, [0, 2]], centres], 1)
    rows = np.stack([np.interp(times, known, row) for row in rows.T], 1)
    return np.ascontiguousarray(rows[:, :2]), rows[:, 2:]


def _left(physique: Physique, start: Start, way: Path, planted: np.ndarray, course: Course, floor: float) -> Path:
    """The path that leaves where the course does, as high as its legs then reach."""
    leave = way.leave.copy()
    leave[[0, 2]] = course.place[-1]
    if start.single is None:
        leave[1] = stretched(physique, way.keys[2 * BETWEEN, :LEGS], planted, HEEL_UP, TAKE_OFF_REACH, start.heading, leave)
    else:
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
    before, after = (hermite(course.times, course.place, course.velocity, [way.wind_up + shift])[0] for shift in (-1e-4, 1e-4))
    passing[[0, 2]] = (after - before) / 2e-4
    velocity = take_off_velocity(leave, way.land, way.airtime, way.gravity)
    return replace(way, low=low, passing=passing, leave=leave, velocity=velocity, push=push(leave - low, passing, velocity, way.gravity), course=course)
