"""Plans of walks to goals: guesses on all sides of what stands about, the best of what they lead to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..goal import wish
from ..obstacles import DEPTH, SHOULDER, highest_step
from ..routes import distance, ends_ground, grid_way, shapes_of
from ..steering import in_world
from .guesses import faced, guesses
from .walk_plan import Plan
from .plan_search import search
from .room import far, narrow, room_on, round_ends, ways_of
from .splines import basis
from .walking_cost import Weights
from .weights import HUMAN

INTERVALS = 24, 80
"""A plan has so many intervals at least, and at most ..."""
INTERVAL = 0.25
"""... about so long [s] ..."""
STRETCH = 0.15, 0.1
"""... and among things that stand about no longer than the one, where he turns aside to pass than the other [m]."""
REPAIRS = 2
"""A plan that comes too near to something between the places that are looked at is mended so often."""
MOST = 250
"""Steps of Newton's method for a guess, at most; twice as many where he has to turn aside to pass."""
WORK, MENDS = 60_000, 12_000
"""Steps times intervals for all guesses of a goal together, at most, so that no plan takes much longer than others, and how many of these are kept for mending; as many
again for ways on which he turns aside to pass. Where none was found, twice as many among twice the intervals."""
TOLERANCE = 1e-6
"""A search ends where another step would gain less than this share of the cost."""
ALLOWED = np.array([0.01, 0.004])
"""Velocities [m/s, rad/s] and distances [m] may break their limits by so much within a search ..."""
TIGHT = np.array([0.01, 0.009])
"""... where he turns aside to pass, which is searched for stiffly and slowly, by nearly the margin: the sweep tells ..."""
STRICT = np.array([0.01, 0.0004])
"""... and where a plan is mended by so much, unless he turns aside ..."""
MARGIN = 0.01
"""... which therefore keeps so much more distance than was asked [m]."""
BRINK = 0.12
"""Goals may lie so near to where the ground ends [m]: there are no walls."""
FARTHEST = 1000.0
"""Nobody is sent farther than this at once [m]: over more, the intervals of one plan get too long to set off by."""
FREE = np.empty((0, 4))
"""No limits to velocities."""
FASTEST = 20.0
"""No walker starts faster than this [m/s, rad/s]."""


def plan(ground: ArrayLike, goal: ArrayLike, velocity: ArrayLike = (0.0, 0.0, 0.0), weights: Weights = HUMAN,
         limits: np.ndarray = FREE, around: Sequence[Any] = (), clearance: float = SHOULDER, floor: float = 0.0,
         leaving: ArrayLike = (0.0, 0.0, 0.0), aside: tuple[float, float] = DEPTH, size: float = 1.0) -> Plan:
    """The walk from ground (3,) x, z [m], heading [rad] to goal (3,) that costs least: Mombaur 2010.

    velocity: (3,) v_f, ω, v_l at the start [m/s, rad/s, m/s]. limits: (H, 4) half-spaces n·(v_f, ω, v_l) + d ≤ 0 that velocities
    keep to, as `ControlSpace.half_spaces` gives them. around: boxes and pillars, of which those count that stop somebody on a
    floor `floor` [m] high. clearance: how far from them the middle of the body stays [m]; as near as he is, where he starts nearer.
    leaving: (3,) how he moves on as he is there; by default he stands. aside: the clearances where he faces something and where he has it behind him [m]: with
    these he side-steps through narrow passages. size: by how much larger all is in words, where somebody of another size is planned for in a smaller world. A goal that can't be reached gives a plan with a reason. ValueError for what is no place, velocity, weight or limit.
    """
    return plans(ground, _numbers("goal", goal)[None], velocity, weights, limits, around, clearance, floor, leaving, aside, size)[0]


def plans(ground: ArrayLike, goals: ArrayLike, velocity: ArrayLike = (0.0, 0.0, 0.0), weights: Weights = HUMAN,
          limits: np.ndarray = FREE, around: Sequence[Any] = (), clearance: float = SHOULDER, floor: float = 0.0,
          leaving: ArrayLike = (0.0, 0.0, 0.0), aside: tuple[float, float] = DEPTH, size: float = 1.0) -> list[Plan]:
    """Plans to many goals (G, 3) in one search, each as of `plan`. ground, velocity, leaving: (3,), or (G, 3) for each."""
    goals = _numbers("goal", goals)
    if goals.ndim != 2 or goals.shape[1] != 3:
        raise ValueError(f"a goal is x, z [m] and heading [rad], got shape {goals.shape[1:]}")
    grounds, velocities, onward = (_each(name, value, len(goals)) for name, value in (("ground", ground), ("velocity", velocity), ("leaving", leaving)))
    for what, moving in (("starts", velocities), ("leaves", onward)):
        if np.abs(moving).max(initial=0.0) > FASTEST:
            raise ValueError(f"nobody {what} faster than {FASTEST:g} m/s or rad/s, got {moving}")
    alpha = _numbers("weights", weights)
    if alpha.shape != (5,) or not (np.all(alpha[:4] > 0.0) and alpha[4] >= 0.0):
        raise ValueError(f"weights: time and the three accelerations cost more than 0, looking away no less than 0; got {tuple(weights)}")
    planes = np.ascontiguousarray(_numbers("limits", limits))
    if planes.ndim != 2 or planes.shape[1] != 4 or np.any(planes[:, 3] > 0.0):
        raise ValueError("limits are (H, 4) half-spaces n·(v_f, ω, v_l) + d ≤ 0 with d ≤ 0, so that standing keeps to them")
    shapes = shapes_of(around, floor)
    with np.errstate(divide="ignore"):
        top = float(np.min(-planes[:, 3] / planes[:, 0], initial=FASTEST, where=planes[:, 0] > 1e-9))
    found: list[Plan | None] = [None] * len(goals)
    same: dict[bytes, tuple[np.ndarray, np.ndarray, list]] = {}  # searches among the same shapes, for the same girth
    girth = np.minimum([clearance, *aside], clearance)
    for number, (start, goal) in enumerate(zip(grounds, goals)):
        if max(np.abs(velocities[number]).max(), np.abs(onward[number]).max()) < 1e-9 and np.hypot(*(goal - start)[:2]) < 1e-6 and abs(goal[2] - start[2]) < 1e-6:
            found[number] = Plan(np.repeat(goal[None], 4, 0), 0.0, 0.0, goal)
            continue
        if why := _refused(start, goal, shapes, clearance, size):
            found[number] = Plan.none(start, goal, why)
            continue
        found[number] = Plan.none(start, goal, f"no way leads there that is {girth[1:].sum() * size:.2f} m wide")
        for routes, near, taken in ways_of(start, goal, shapes, girth, MARGIN):
            if routes:
                same.setdefault(near.tobytes() + taken.tobytes(), (near, taken, []))[2].append((number, routes))
    for near, taken, tasks in same.values():
        _solve(found, tasks, grounds, velocities, goals, onward, weights, planes, near, shapes, taken, top)
    return [one for one in found if one is not None]


class _Post(NamedTuple):
    foot: tuple[float, float, float] = (0.5, 0.0, 0.5)
    radius: float = 0.1
    height: float = 1.0


def rehearse() -> None:
    """A plan that nobody needs, past a post, what walks it, and a search on a grid, so that what they compile or load does not halt a game."""
    made = plan(np.zeros(3), (1.0, 1.0, 1.0), limits=np.array([[1.0, 0.0, 0.0, -2.0]]), around=(_Post(),))
    wish(made, 0.0, *made.at(0.0))
    shapes = shapes_of((_Post(),))
    grid_way((0.0, 0.0), (1.0, 1.0), shapes, SHOULDER)
    narrow(np.zeros((1, 2)), shapes, SHOULDER)


def _numbers(name: str, value: Any) -> np.ndarray:
    try:
        numbers = np.asarray(value, float)
    except (TypeError, ValueError):
        numbers = np.full(1, np.nan)
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} must be finite numbers, got {value}")
    return numbers


def _each(name: str, value: Any, count: int) -> np.ndarray:
    """(3,) or (count, 3) finite numbers as (count, 3). ValueError for others."""
    numbers = _numbers(name, value)
    if numbers.shape not in ((3,), (count, 3)):
        raise ValueError(f"{name} is three numbers, or three for each goal; got {value}")
    return np.array(np.broadcast_to(numbers, (count, 3)))  # kernels are compiled for what may be written to


def unfit(goal: ArrayLike, around: Sequence[Any], floor: float = 0.0, clearance: float = SHOULDER, size: float = 1.0) -> str:
    """Why nobody can stand at a goal (2,) x, z [m] among what stops people on a floor `floor` [m] high; "" where one can. clearance, size: as of `plan`."""
    return _unfit(np.asarray(goal, float), shapes_of(around, floor), clearance, size)


def _unfit(goal: np.ndarray, shapes: np.ndarray, clearance: float, size: float) -> str:
    out = np.empty(3)
    for shape in shapes:
        there, edge = distance(goal[0], goal[1], shape, out), ends_ground(shape)
        needed = min(BRINK, clearance) if edge else clearance
        if there < needed:
            what = "an edge" if edge else "something"
            if there <= 0.0:
                return f"the goal lies in something, or on it and no way leads up: steps rise by {highest_step(size) * size:.2f} m at most"
            return f"the goal is {there * size:.2f} m from {what}, {needed * size:.2f} m are needed"
    return ""


def _refused(start: np.ndarray, goal: np.ndarray, shapes: np.ndarray, clearance: float, size: float) -> str:
    """Why nobody can walk from start to goal, whatever the way; "" where a way may be."""
    far_off = float(np.hypot(*(goal - start)[:2]))
    if far_off > FARTHEST:
        return f"the goal is {far_off * size:.0f} m away; {FARTHEST * size:g} m can be planned at once: give a goal on the way there first"
    if why := _unfit(goal, shapes, clearance, size):
        return why
    out = np.empty(3)
    return "the walk starts within something" if any(distance(start[0], start[1], shape, out) <= 0.0 for shape in shapes) else ""


def _solve(found, tasks, grounds, velocities, goals, onward, weights, planes, shapes, around, girth, top, finer: int = 1) -> None:
    """Plans for tasks [(number, ways)] among the same shapes, those of `around` as seen from the starts, put into `found` where they cost less.
    finer: so many times the intervals; where nothing was found it is sought among twice as many."""
    intervals = finer * max(_intervals(way, weights, top, STRETCH[int(girth[1] < girth[0])] if len(shapes) else 0.0) for _, routes in tasks for way in routes)
    table = basis(intervals)
    first, times, aims, whose = [], [], [], []
    for number, routes in tasks:
        for way in routes:
            moving = np.append(in_world(grounds[number], velocities[number]), velocities[number, 1])
            leaving = np.append(in_world(goals[number], onward[number]), onward[number, 1])
            tight = None if girth[1] == girth[0] else lambda places: narrow(places, shapes, girth[0] + MARGIN)
            guess, seconds = guesses(way, grounds[number, 2], goals[number, 2], weights, top, table, moving, leaving, tight)
            first.append(guess)
            times.append(seconds)
            aims.append(np.broadcast_to(faced(way, table), (len(guess), len(table.shares), 2)))
            whose += [number] * len(guess)
    splines, seconds, facing = (np.ascontiguousarray(np.concatenate(parts)) for parts in (first, times, aims))
    starts, ends = (np.ascontiguousarray(poses[whose]) for poses in (grounds, goals))
    ends[:, 2] = splines[:, -1, 2]
    speeds = np.column_stack([in_world(starts, velocities[whose]), velocities[whose, 1]])
    leaves = np.column_stack([in_world(ends, onward[whose]), onward[whose, 1]])

    ceilings = np.array([found[number].cost for number in whose])
    straight, work = girth[1] == girth[0], np.full(len(found), finer * WORK)
    most = MOST if straight else 2 * MOST

    def searched(which, margin, shapes, allowed, ceilings=np.full(len(splines), np.inf), kept=0):
        some, times, count = splines[which], seconds[which], len(splines[which])
        costs, faults, steps = np.empty(count), np.empty((count, 2)), np.empty(count, np.int64)
        mine = np.array(whose)[which]
        search(some, times, starts[which], speeds[which], ends[which], leaves[which], facing[which], np.asarray(weights, float), table.values, table.weights, planes, shapes,
               girth + margin, allowed, most, TOLERANCE, mine, (work[mine] - kept) // intervals, ceilings[which], kept > 0, costs, faults, steps)
        np.subtract.at(work, mine, intervals * np.abs(steps))
        splines[which], seconds[which] = some, times
        return costs, faults, np.all(faults <= allowed, 1) & np.isfinite(costs)

    costs, faults, sound = searched(slice(None), MARGIN, shapes, ALLOWED if straight else TIGHT, ceilings, MENDS)
    for number, _ in tasks:
        mine = [s for s in np.argsort(costs) if whose[s] == number]
        true = round_ends(grounds[number], goals[number], around, girth, MARGIN)
        for s in mine:
            for _ in range(REPAIRS):  # it may cut a corner between two places that are looked at
                missing = -room_on(splines[s], true, girth)
                if not sound[s] or missing <= 0.0:
                    break
                margin = MARGIN + 2.0 * missing
                wider = round_ends(grounds[number], goals[number], around, girth + margin)
                (costs[s],), _, (sound[s],) = searched(slice(s, s + 1), margin, wider, STRICT if straight else ALLOWED)
            if sound[s] and room_on(splines[s], true, girth) >= 0.0:
                if costs[s] < found[number].cost:
                    found[number] = Plan(splines[s].copy(), float(seconds[s]), float(costs[s]), ends[s])
                break
        else:
            if not found[number].reason:
                continue
            found[number] = Plan.none(grounds[number], goals[number], _why(faults[mine], sound[mine]))
            if finer == 1:
                task = [(number, routes) for one, routes in tasks if one == number]
                _solve(found, task, grounds, velocities, goals, onward, weights, planes, shapes, around, girth, top, finer=2)


def _why(faults: np.ndarray, sound: np.ndarray) -> str:
    if np.any(faults[:, 1] <= ALLOWED[1]) and not np.any(sound):
        return "no walk gets there within the limits of the velocities"
    return "no walk was found past what stands about"


def _intervals(way: np.ndarray, weights: Weights, top: float, stretch: float) -> int:
    length = far(way)
    seconds = max((36.0 * weights.forward * length**2 / weights.time) ** 0.25, 1.5 * length / top)
    return int(np.clip(np.ceil(max(seconds / INTERVAL, length / stretch if stretch else 0.0) / 8) * 8, *INTERVALS))
