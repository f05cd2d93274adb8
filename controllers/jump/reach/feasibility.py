"""What a body can't jump, told before it winds up, and the nearest place that it can."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...body import centre_of_mass, end_positions, forward_kinematics, yaw
from ...contract import Unable
from ...navigation import clearance
from ..body import FLAT, TURNED, Physique, Start, along, measures, carriage, turns
from ..motion import SPINS, Path, Plan, Push, rolls
from ..muscles import strongest
from ..prior import BETWEEN, LEGS
from .seeking import Onward

RUNNER = 4.2
"""What the leg of a runner gives, stretched as the foot strikes, in an adult's weights on Earth, at strength 1."""
STANDER = 3.5
"""And what both legs give that push off together: half as much again as from the deepest crouch at rest."""
SLIP = 1.0
"""Soles slip on the floor under a force that leans farther: their friction."""
ASIDE = 0.03
"""The ground presses no farther outside the soles that stand than this [m], at standard height."""
STOPS = 6.0, 0.5
"""What legs give as they stop a fall, in an adult's weights on Earth at strength 1, and over which way [m], at
standard height."""
ROLLED = 1.2
"""Who rolls comes down so many times as fast as legs alone stop: the shoulder and the back take the rest."""
STEEP = "too deep for legs alone"
"""Why nobody comes down so hard who does not roll."""
TOO_WEAK = "this body is too weak to jump here at all"
"""Why nobody leaps whose muscles don't lift him off the floor."""
BESIDE = "no foot is under it to push off at this moment"
"""Why nobody leaps off feet that are too far before, behind or beside him, as they are in the midst of a stride."""
SETS_FEET = "it sets its feet first, which are too near each other, or turned too far, to crouch over"
"""Why nobody leaps yet whose legs would go through each other."""
MOMENTARY = BESIDE, SETS_FEET
"""Why a leap is refused for a moment only: the next footfall may be another."""
TOO_NEAR = "too near for this "
"""So begins why a leap is refused for which who goes on would have to brake too much."""
HARD = "no leg pushes off so hard"
"""Why a leap is refused that is too high for the leg that pushes: one that flies longer asks more of it still."""
HOPELESS = 1.5
"""Nobody leaps along a path that is estimated to ask legs for so many times what they give: of 985 that could be leapt none was estimated to ask for all of it."""
PACE = "too far for this ", TOO_NEAR
"""And one for which the foot that pushes would have to speed up or brake too much."""
RUNS_ON = "too fast for this place: who lands on one foot from this run comes to rest beyond it"
"""Why nobody leaps who wants to stay where there is no room to come to rest."""
BESIDE_IT = 0.05
"""What is nearer than this [m] is no way ahead."""
GRAZE = 0.05
"""So much of its flesh a flying body may graze things with [m]."""
RUNS_TURNED = 0.8
"""So far at most turns in the air who pushes off a run [rad]."""
TILT = 75.0
"""No body is tilted farther from upright in the air, or comes down half as far [°]."""


class Refused(Unable):
    """A jump that this body can't make. nearest: the place (3,) [m] nearest to the target that it can reach
    from `here` (3,), if one was found. onward: with what it is gone on with finding out, in the next step; None where all is known."""

    def __init__(self, reason: str, nearest: np.ndarray | None = None, here: np.ndarray | None = None, onward: Onward | None = None):
        if nearest is not None:
            reason += "; the nearest that it reaches is " + ("" if here is None else _away(nearest - here) + ", at ")
            reason += f"({nearest[0]:.2f}, {nearest[1]:.2f}, {nearest[2]:.2f})"
        super().__init__(reason)
        self.nearest, self.onward = nearest, onward


def _away(way: np.ndarray) -> str:
    """How far away something is by a way (3,) [m], and how far up or down."""
    far, up = float(np.hypot(way[0], way[2])), f"{abs(way[1]):.1f} m {'up' if way[1] > 0.0 else 'down'}" if abs(way[1]) > 0.05 else ""
    if far < BESIDE_IT:
        return up or "where it stands"
    return f"{far:.1f} m away{up and ' and ' + up}"


def meant(place: Any, airtime: float | None = None) -> np.ndarray:
    """A place (3,) [m] to leap to, as numbers. Refused where it is none, or where nobody is in the air for so long [s]."""
    numbers = np.asarray(place, float)
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise Refused(f"the target must be three finite numbers, got {place!r}")
    if airtime is not None and not 0.05 <= airtime <= 10.0:
        raise Refused(f"the airtime must be within 0.05 … 10 s, got {airtime!r}")
    return numbers


def begins(start: Any) -> Start:
    """From where a leap is looked for. ValueError for what is none, as a state is."""
    if not isinstance(start, Start):
        raise ValueError(f"a leap is looked for from jump.start_of(state); got a {type(start).__name__}")
    return start


def too_weak(physique: Physique, usual: Path, longest: float) -> str:
    """What is told of a body whose muscles don't do the usual jump straight up. longest: [s] that it can be in the air."""
    if strongest(physique, measures(physique).leave(0.0) - measures(physique).stand, usual.gravity) <= 0.0:
        return TOO_WEAK + f", with a strength of {physique.strength:g}"
    return (f"this body is too weak to jump here: a strength of {physique.strength:g} keeps it in the air for {longest:.2f} s at most, and it takes {usual.airtime:.2f} s; "
            "an airtime asks for less")


def fault(physique: Physique, way: Path, around: Sequence[Any], floor: float) -> str:
    """Why a path can't be gone, or nothing. around: boxes and pillars; floor: of the take-off [m]."""
    if not all(np.isfinite(part).all() for part in (way.low, way.leave, way.land, way.velocity)):
        return "there is no such arc"
    if not way.strong:
        return _weak(physique, way, floor)
    if way.running and abs(way.turn) > RUNS_TURNED:
        return f"who runs turns by {np.degrees(RUNS_TURNED):.0f}° at most in the air, not by {np.degrees(abs(way.turn)):.0f}°"
    least = (TURNED[1] - TURNED[0]) * abs(way.turn) / SPINS[1]
    if way.airtime < least:
        return f"too short to turn by {np.degrees(abs(way.turn)):.0f}°: that takes {least:.2f} s in the air"
    if way.push is None:
        return f"no push leaves the floor for {way.airtime:.2f} s in the air"
    force, gives = _asked(physique, way, way.push)
    if force > gives:  # a push as short as that throws the limbs, too
        return (f"{HARD} from this {'run' if way.running else 'hop' if way.push.springs else 'pace'}: {force:.1f} times its weight on Earth, "
                f"where {'this one has' if way.single else 'these have'} {gives:.1f}")
    if way.course is not None and (way.course.outside > ASIDE * physique.size or way.course.lean > SLIP):
        gains = np.linalg.norm(way.velocity * FLAT) > np.linalg.norm(way.course.velocity[0])
        return f"{PACE[0] if gains else PACE[1]}{'run' if way.running else 'pace'}: no foot {'speeds up' if gains else 'brakes'} so much in one step"
    if np.linalg.norm((way.land - way.leave)[[0, 2]]) > 1e-6 and way.airtime <= 0.0:
        return "the arc takes no time"
    return stopped(physique, way, ROLLED if rolls(physique, way) else 1.0) or blocked(physique, way, around)


def hopeless(physique: Physique, way: Path) -> bool:
    """Whether the muscles fall so short of an estimated path that nothing would come of finding where the ground can push."""
    if not way.strong or way.push is None:
        return not way.strong
    force, gives = _asked(physique, way, way.push)
    return force > HOPELESS * gives


def _asked(physique: Physique, way: Path, push: Push) -> tuple[float, float]:
    """How hard legs push at most, and how hard they can, in their body's weights on Earth."""
    gives = physique.strength * (STANDER if not (way.running or push.springs) else RUNNER if way.single else 2.0 * RUNNER)
    return float(np.linalg.norm(push.force(np.linspace(0.0, push.duration, 24)), axis=-1).max()) / 9.81, gives


def stopped(physique: Physique, way: Path, share: float = 1.0) -> str:
    """Why legs can't stop a fall that is a share as fast, or nothing."""
    spare = STOPS[0] * 9.81 * physique.strength + float(way.gravity[1])
    down, stops = -float(way.falling[1]), share * np.sqrt(2.0 * STOPS[1] * physique.size * max(spare, 0.0))
    return f"too deep: it would land at {down:.1f} m/s, and its legs stop {stops:.1f} m/s" if down > stops else ""


def wrong(physique: Physique, made: Plan) -> str:
    """Why a finished plan is none that a body could play, or nothing: one that tumbles, or is no motion at all."""
    if not all(np.isfinite(part).all() for part in (made.roots, made.local, made.centres)):
        return "there is no such jump"
    air = (made.times >= made.take_off) & (made.times <= made.touch_down)
    tilt = np.degrees(np.arccos(np.clip(made.local[air, 0, 1, 1], -1.0, 1.0)))
    if tilt.max() > TILT or tilt[-1] > 0.5 * TILT:
        return "it would tumble: turn towards the place first"
    return ""


def _weak(physique: Physique, way: Path, floor: float) -> str:
    """What is missing where the muscles are too weak."""
    heights = measures(physique)
    if strongest(physique, heights.leave(0.0) - heights.stand, way.gravity) <= 0.0:
        return TOO_WEAK
    if strongest(physique, way.leave[1] - floor - heights.stand, way.gravity) <= 0.0:
        return BESIDE
    if way.up > 0.05:
        return f"too {'high' if way.up > 0.35 * way.far else 'far'}: {way.far:.1f} m away and {way.up:.1f} m up"
    return f"too far: {way.far:.1f} m" if way.far > 0.05 else "too high"


def blocked(physique: Physique, way: Path, around: Sequence[Any]) -> str:
    """What the flying body would hit: "" or "its head would hit something 0.8 m ahead" and the like."""
    if not len(around):
        return ""
    size, time = physique.size, np.linspace(0.0, way.airtime, 25)
    centre = along(way.leave, way.velocity, time, way.gravity)
    # legs are tucked in the middle of the flight
    tucked = np.interp(time / way.airtime, (0.0, 0.3, 0.75, 1.0), (1.0, 0.72, 0.72, 0.96))
    upward = np.array([0.0, 1.0, 0.0])
    head, hands = _upper(physique, way, time)
    # the soles may touch what they leave and where they land
    for name, offset, radius, inner in (
            ("head", head, 0.11, slice(1, None)), ("trunk", 0.28 * size * upward, 0.16, slice(1, None)),
            ("hips", -0.05 * size * upward, 0.16, slice(1, None)),
            ("legs", -(measures(physique).stand - 0.12 * size) * tucked[:, None] * upward, 0.08, slice(4, -4)),
            ("hands", hands, 0.10, slice(0, None))):
        places = (centre + offset)[..., inner, :].reshape(-1, 3)
        near = clearance(places, around)
        if near.min() < radius * size - GRAZE:
            return hits(name, float(np.linalg.norm((places[int(near.argmin())] - way.leave)[[0, 2]])))
    return ""


def hits(part: str, ahead: float) -> str:
    """That a part of a body would hit something so far ahead [m] of it, in words."""
    return f"its {part} would hit " + (f"something {ahead:.1f} m ahead" if ahead >= BESIDE_IT else "what it is right beside")


def _upper(physique: Physique, way: Path, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the head's middle (N, 3) and fingers, wrists and elbows (6, N, 3) are from the centre of mass, as it is carried."""
    skeleton = physique.skeleton
    angles = carriage.keyed(way.airtime * np.linspace(0.0, 1.0, BETWEEN + 1), way.keys[2 * BETWEEN:3 * BETWEEN + 1, :LEGS])(time)
    local = np.tile(np.eye(3), (len(time), len(skeleton), 1, 1))
    for one, posed in zip(angles, local):
        carriage.carry_kernel(one, carriage.joints_of(skeleton), posed)
    facing = way.heading if not way.turn else way.heading + way.turned(way.wind_up + (0.0 if way.push is None else way.push.duration) + time)
    local[:, 0] = yaw(facing) @ turns(angles[:, :1] * [1.0, 0.0, 0.0])
    positions, turned = forward_kinematics(skeleton, np.zeros((len(time), 3)), local)
    positions -= centre_of_mass(physique.anatomy, positions, turned)[:, None]
    ends = end_positions(skeleton, positions, turned)
    head = 0.5 * (positions[:, skeleton.index("Head")] + ends[:, skeleton.end_index["Head"]])
    return head, np.stack([ends[:, skeleton.end_index[side + "Hand"]] if part == "" else positions[:, skeleton.index(side + part)]
                           for side in ("Left", "Right") for part in ("", "Hand", "ForeArm")])
