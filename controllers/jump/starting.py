"""From where a jump starts: what it needs to know of a state, whether it can start at this moment, and what a jumper remembers of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..body import Pose, Skeleton, centre_of_mass, contact_points, forward_kinematics, wrap, yaw
from ..contract import CharacterState, Leap, level
from ..navigation import STEP, floor_at, in_world, room, slope_at
from .body import FLAT, Physique, Start, raised, soles, vectors
from .motion import LIKE, PLANT, Plan, carried, moments
from .reach import Onward

RUNNING = 0.95
"""Faster than this [m/s] one foot pushes and the jump waits for it to strike."""
FRESH = -0.06
"""A foot has just struck while the body is no further than this past it [m]: still behind it."""
STEEP = 0.9
"""Downhill that is seen from as high over it as mass centres are [m], at standard height: a foot strikes farther behind there, square to the ground."""
HALF_TURN = 1e-3
"""So little short of half a turn [rad] is one."""
FEET = "left", "right", "both"
"""On which feet one may land to hop on."""
HIGH, SINKS = 0.012, 0.2
"""But not while it is higher over the floor than the first [m] and comes down faster than the second [m/s], at standard height: nobody pushes off a foot that is still in
the air, whatever its contacts say."""
SLOWLY = 0.12, LIKE[1]
"""Who is told to leap along his way, and is slower than the first [m/s], leaps on the spot; who is faster than the second as runners do."""
CLEAR = 0.015
"""A foot that has just left the floor, and is no higher than this over it [m], at standard height, would come into it as its body goes down."""
AHEAD = 0.95
"""Who goes ahead does so by at least this share of his speed."""
BETWEEN, HIGHEST = np.linspace(0.1, 1.0, 10), 2.0
"""Shares of his way at which the floor is looked at, for what is no higher over it than this [m]."""
STEEPLY, DOWNHILL = 0.21, -0.05
"""Up what rises by more than the first a metre no leg pushes off in so short a time, and down it a foot that strikes carries him on; hands wait for no other down what
falls by more than the second."""
STEPS = 0.36
"""Onto what lies higher than this over his way, or lower [m], nobody leaps off the foot under him."""
BACK = 0.8
"""Who goes back by more than this share of his speed goes backward."""
UNDER = 0.15
"""What lies higher or lower than this over the floor of who walks is no more of it [m]."""
UP = 0.06
"""A foot higher than this over the floor is in the air [m]."""
NEAR = 1e-6
"""Who is no farther from where he was left than this [m, rad] is there."""
KNEES, APART = 0.31, 0.06
"""Knees of a crouch are so far ahead of their ankles, as the feet point. Ankles and knees that are nearer than the second to each other, across the way that
the body faces, are too near [m], at standard height."""
TURNED = np.radians(40.0)
"""A foot that is turned farther from there [rad] is not crouched over."""
BEYOND = 0.2, 0.4, 0.6, 0.8, 1.0
"""Who runs on from where he lands needs floor and room so far beyond [m]."""
STANDS = 0.01
"""Who is slower than this [m/s, rad/s], and stands on both feet, has set them."""
UNEVEN = 0.02
"""Ground is no slope where the floor under a foot lies by more than this beside it [m]."""
BEHIND = 0.055
"""The ground frame of who stands is so far behind the middle of his soles [m], at standard height."""
SPRINGS = 0.05
"""So long after the lowest point of a landing [s] another leap may still go off from there."""


@dataclass(frozen=True, eq=False)
class Jumping:
    """What a jumper remembers. time: [s] since the plan began. fault: what was struck in mid-air, from where the
    plan is a fall. hits: how often. shift: (3,) x, z [m] of the ground frame from under the centre of mass, and its heading's [rad] from the plan's, as that began. asked: what is
    not to be asked again until it was let go; refused: why the leap that was to follow can't be made, onward: with what that is gone on with being found out.
    stood: (4,) where it was left, see `stands`."""

    plan: Plan
    time: float = 0.0
    fault: str = ""
    hits: int = 0
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    asked: Leap | None = None
    refused: str = ""
    onward: Onward | None = None
    stood: np.ndarray | None = None

    @staticmethod
    def begun(made: Plan, state: CharacterState, asked: Leap | None = None, fault: str = "", hits: int = 0) -> Jumping:
        """The memory of one who begins a plan in a state."""
        return Jumping(made, 0.0, fault, hits, np.asarray(state.ground, float) - [*made.centres[0, [0, 2]], made.path.heading], asked, stood=stands(state))

    @property
    def rebounds(self) -> bool:
        """Whether its legs give to a landing on both feet, or on one to hop on, so that another leap could go off from there."""
        made = self.plan
        return not self.fault and not made.rolls and (made.path.lands is None or made.path.hops) and made.touch_down + PLANT <= self.time < made.lowest + SPRINGS

    @property
    def rises(self) -> bool:
        """Whether it comes up again from a landing on both feet, and may go down into a crouch from there."""
        made = self.plan
        return not self.fault and not made.rolls and made.path.lands is None and made.lowest <= self.time

    @property
    def landed(self) -> bool:
        """Whether the feet have come down."""
        return self.time >= self.plan.touch_down


def stands(state: CharacterState) -> np.ndarray:
    """Where (4,) somebody is: x, z [m], heading [rad], and how high his floor [m]."""
    return np.array([*np.asarray(state.ground, float), float(state.floor)])


def stayed(stood: np.ndarray | None, state: CharacterState) -> None:
    """Nothing, if somebody is where (4,) a motion left him that was planned in the world. ValueError where he was set elsewhere meanwhile."""
    if stood is not None and not (np.abs(stands(state) - stood) <= NEAR).all():
        raise ValueError("who jumps, falls or stumbles can't be set elsewhere, as that was planned where he is: start him there anew, or wait until he walks")


def start_of(physique: Physique, state: CharacterState, crouched: bool = False) -> Start:
    """What a jump of a body needs to know of a state. crouched: whether it crouches already."""
    skeleton, masses = physique.skeleton, physique.anatomy
    pose = Pose(np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))
    positions, turned = forward_kinematics(skeleton, pose.root, pose.rotations)
    centre = centre_of_mass(masses, positions, turned)
    velocity, rates, feet_rates = np.zeros(3), np.zeros((len(skeleton), 3)), np.zeros((2, 5))
    feet = _feet(skeleton, positions, turned)
    if state.previous is not None and state.elapsed > 0.0:
        before = forward_kinematics(skeleton, np.asarray(state.previous.root, float), np.asarray(state.previous.rotations, float))
        velocity = (centre - centre_of_mass(masses, *before)) / state.elapsed
        moved = feet - _feet(skeleton, *before)
        moved[:, 3:] = wrap(moved[:, 3:])
        heels, balls = np.asarray(state.contacts).reshape(2, 2).T
        feet_rates = np.where((heels | balls)[:, None], 0.0, moved / state.elapsed)
        rolls = heels & ~balls  # a foot comes down on over its heel
        feet_rates[rolls, 1], feet_rates[rolls, 4] = np.minimum(moved[rolls, 1], 0.0) / state.elapsed, np.maximum(moved[rolls, 4], 0.0) / state.elapsed
        rates = vectors(pose.rotations @ np.swapaxes(np.asarray(state.previous.rotations, float), -1, -2)) / state.elapsed
    return Start(pose.root, pose.rotations, rates, centre, velocity, feet, float(state.ground[2]), feet_rates, _single(state), crouched)


def along_of(state: CharacterState, leap: Leap | None) -> bool:
    """Whether a leap is one of somebody who goes slowly, aside or backward, on his way."""
    return leap is not None and leap.along and SLOWLY[0] < float(np.hypot(state.velocity[0], state.velocity[2])) < SLOWLY[1]


def off_one(physique: Physique, start: Start, leap: Leap | None, state: CharacterState, gravity: float) -> Start:
    """The same start of somebody who leaps so, off the foot that keeps his speed best of those that stand flat; as it is where none does. gravity: [m/s²] downward."""
    if leap is None or not along_of(state, leap):
        return start
    contacts = np.asarray(state.contacts).reshape(2, 2)
    back = float(goes(state) @ yaw(start.heading)[:, 2]) < -BACK * float(np.linalg.norm(goes(state)))
    high = start.feet[:, 1] > float(state.floor) + physique.tables.sole + CLEAR * physique.size
    clear = high & ~contacts.any(1) if back else np.ones(2, bool)  # ahead of who goes back it stands on its heel, and would be drawn through the floor
    flat = np.flatnonzero(contacts.all(1) & clear[::-1])
    ways = [replace(start, single=int(side), along=True) for side in flat]
    found = [carried(physique, way, goes(state), float(state.floor), gravity, leap.waited) for way in ways]
    return min(zip(ways, found), key=lambda one: (not one[1].keeps, one[1].strays))[0] if ways else start


def walks_to(state: CharacterState, leap: Leap | None) -> bool:
    """Whether a leap is one of somebody who walks ahead to a place, in no time that he was told, and not to hop on."""
    ahead, _, aside = state.velocity
    pace = math.hypot(ahead, aside)
    return leap is not None and leap.place is not None and leap.airtime is None and leap.on is None and RUNNING < pace < SLOWLY[1] and ahead > AHEAD * pace


def leaves_under(state: CharacterState, leap: Leap | None, around: Sequence[Any]) -> bool:
    """Whether a leap is one of somebody who walks to a place that he can leap to off the foot under him: no higher or lower than scripts, or hands, have it."""
    if leap is None or not walks_to(state, leap):
        return False
    place = np.asarray(leap.place, float)
    return place.shape == (3,) and bool(np.isfinite(place).all()) and even(state, place, around, UP if leap.slack > 0.0 else STEPS)


def off_under(physique: Physique, start: Start, leap: Leap | None, state: CharacterState, gravity: float, around: Sequence[Any]) -> tuple[Start, bool]:
    """The same start of somebody who walks to a place, off the foot under him if this is the best moment; and whether that is to come. gravity: [m/s²] downward."""
    if leap is None or not leaves_under(state, leap, around):
        return start, False
    place, waits = np.asarray(leap.place, float), False
    (level, slope), here, way = _ground(state, around), np.asarray(state.ground, float)[:2], goes(state)
    steep = float(slope @ way[[0, 2]]) / float(np.linalg.norm(way))
    if leap.slack > 0.0 and steep < DOWNHILL:
        return start, False

    def floor(foot: np.ndarray) -> float:
        """How high [m] the ground on which he goes is at a place (3,)."""
        return level + float(slope @ (foot[[0, 2]] - here))

    def finds(foot: np.ndarray) -> bool:
        """Whether a foot finds floor there."""
        return not len(around) or abs(floor_at(foot[0], foot[2], around, floor(foot) + STEP) - floor(foot)) < UNDER
    contacts = np.asarray(state.contacts).reshape(2, 2)
    for side in np.flatnonzero(contacts.any(1)):
        off = replace(start, single=int(side), along=True, bound=True)
        now, later = moments(physique, off, way, place, floor(start.feet[side]), gravity, finds, steep, leap.slack > 0.0, float(state.velocity[1]))
        if now and contacts[side].all():
            return off, True
        waits = waits or later
    return start, waits


def even(state: CharacterState, place: np.ndarray, around: Sequence[Any], steps: float) -> bool:
    """Whether a place (3,) lies on the level or on the slope on which somebody goes, no steep one, or no more than `steps` [m] over or under it, and nothing stands higher on the way there."""
    (floor, slope), here = _ground(state, around), np.asarray(state.ground, float)[:2]
    way = place[[0, 2]] - here
    up = float(place[1]) - floor - float(slope @ way)
    if abs(up) > steps or abs(float(slope @ way)) > STEEPLY * float(np.hypot(*way)):
        return False
    high = floor + UP + (max(up, 0.0) if abs(up) > UP else 0.0)
    return not len(around) or all(floor_at(x, z, around, floor + float(slope @ (share * way)) + HIGHEST) < high + float(slope @ (share * way))
                                  for share in BETWEEN for x, z in [here + share * way])


def goes(state: CharacterState) -> np.ndarray:
    """How fast (3,) [m/s] somebody goes in the world."""
    x, z = in_world(state.ground, state.velocity)
    return np.array([x, 0.0, z])


def turning(start: Start, leap: Leap | None) -> Start:
    """The same start of one who lands on the feet and in the heading that a leap says, if it says any: the shorter way round, to the left where both
    are half a turn."""
    if leap is not None and leap.on in FEET:
        start = replace(start, onto=FEET.index(leap.on))
    if leap is not None and leap.stays:
        start = replace(start, stays=True)
    if leap is None or leap.heading is None or not math.isfinite(leap.heading):
        return start
    turn = math.remainder(leap.heading - start.heading, math.tau)
    return replace(start, turn=turn + math.tau if turn < -math.pi + HALF_TURN else turn)


def cramped(start: Start, leap: Leap | None, ground: np.ndarray, around: Sequence[Any]) -> Start:
    """The same start of one who has no room to run on beyond where he lands: before a wall, or an edge that he wants to stay on. ground: where x, z [m] he is."""
    if leap is None or leap.place is None or start.single is None or not len(around):
        return start
    place = np.asarray(leap.place, float)
    if place.shape != (3,) or not np.isfinite(place).all():
        return start
    there, high = place[[0, 2]], float(place[1])
    ahead = (there - ground[:2]) / max(float(np.hypot(*(there - ground[:2]))), 1e-9)
    for far in BEYOND:
        x, z = there + far * ahead
        if room(np.array([x, z]), high, around) > 0.0:
            high = floor_at(x, z, around, high + UP)  # as slopes and treads go on
            continue
        return replace(start, cramped=leap.stays or floor_at(x, z, around, high + UP) >= high - UP)
    return start


def on_ground(start: Start, state: CharacterState, around: Sequence[Any]) -> Start:
    """The same start on ground as it rises under somebody; as it is on level ground, and where a foot stands beside the slope."""
    x, z, _ = np.asarray(state.ground, float)
    floor = float(state.floor)
    slope = slope_at(x, z, around, floor + UP)
    if not slope.any():
        return start
    sloping = start.on(slope, np.array([x, z]) + (floor - floor_at(x, z, around, floor + UP)) / (slope @ slope) * slope)
    heights = floor + sloping.rise(start.feet[:, :3])
    even = all(abs(floor_at(ball[0], ball[2], around, high + UNEVEN) - high) < UNEVEN for ball, high in zip(start.feet, heights))
    return sloping if even else start


def astride(physique: Physique, start: Start, state: CharacterState) -> tuple[Start, float]:
    """The same start of one whose feet stand on floors of their own, as astride an edge, and how high the lower of these is [m]; who pushes off one foot has but one."""
    floor = float(level(state.floor))
    if start.single is not None:
        return start, floor
    over = start.feet[:, 1] - (floor + raised(physique.tables, start.slope) + start.rise(start.feet[:, :3]))
    over = np.where(np.asarray(state.contacts).reshape(2, 2)[:, 1] & (np.abs(over) > UNEVEN), over, 0.0)
    return (replace(start, levels=over - over.min()) if over.any() else start), floor + float(over.min())


def rebounding(start: Start, made: Plan, time: float) -> Start:
    """The start of one who is `time` [s] into a plan and comes down: its landing is the crouch of the jump that follows."""
    n = int(np.clip(np.searchsorted(made.times, time), 1, len(made.times) - 1))
    gains = (made.velocities[n] - made.velocities[n - 1]) / (made.times[n] - made.times[n - 1])
    low = min(float(start.centre[1]), float(made.centres[n:, 1].min()))
    return replace(start, heading=made.path.heading + made.path.turn, velocity=made.moving(time)[1], acceleration=gains, ready=True, low=low,
                   single=made.path.lands, springs=made.path.hops)


def standing(physique: Physique, made: Plan) -> np.ndarray:
    """Where (2,) x, z [m] the ground frame is of one who stands on both feet as a plan lands."""
    heading = made.path.heading + made.path.turn
    return soles(made.feet, physique.tables).mean(0)[[0, 2]] - BEHIND * physique.size * np.array([np.sin(heading), np.cos(heading)])


def landed(physique: Physique, state: CharacterState, made: Plan) -> CharacterState:
    """The state of one who plays a plan that lands on both feet as it will stand there, at rest."""
    middle = made.centres[-1] if made.rolls else soles(made.feet, physique.tables).mean(0)
    pose = made.at(made.duration if np.isinf(made.through) else made.lowest)
    return replace(state, ground=np.array([middle[0], middle[2], made.path.heading + made.path.turn]), velocity=np.zeros(3), pose=pose, contacts=np.ones(4, bool),
                   memory=None, floor=float(made.feet[:, 1].mean() - physique.tables.sole), previous=None, elapsed=0.0)


def ready(physique: Physique, state: CharacterState, around: Sequence[Any] = ()) -> bool:
    """Whether a jump can start at this moment: standing feet, or a foot that has just struck, among boxes and pillars around."""
    start = start_of(physique, state)
    speed = float(np.hypot(start.velocity[0], start.velocity[2]))
    if start.single is None:
        low = start.feet[:, 1] - float(state.floor) < physique.tables.sole + UP * physique.size
        return speed < RUNNING and bool(low.any())
    towards = start.velocity * FLAT / max(speed, 1e-9)
    falls = -float(on_ground(start, state, around).slope @ towards[[0, 2]]) if len(around) else 0.0
    past = float((start.centre - start.feet[start.single, :3]) @ towards) - STEEP * physique.size * max(falls, 0.0)
    return past < FRESH and not _comes_down(physique, state)[start.single]


def on_its_floor(physique: Physique, start: Start, floor: float, around: Sequence[Any]) -> bool:
    """Whether feet that push come to stand on that floor [m], heel or ball: who goes over an edge has one of them beyond it."""
    body, feet = physique.tables, start.planted(floor, physique.tables)
    for side in (0, 1) if start.single is None else (start.single,):
        ball, ahead = feet[side, :3], np.array([np.sin(feet[side, 3]), 0.0, np.cos(feet[side, 3])])
        places = ball, ball + (body.heel[2] - body.toe[2]) * ahead
        if all(floor_at(x, z, around, high + UP) < high - UP for (x, _, z), high in zip(places, floor + start.rise(np.array(places)))):
            return False
    return True


def sets_feet(physique: Physique, state: CharacterState) -> bool:
    """Whether somebody on the move still has to set his feet: as they come to stand now, his legs would go through each other in a crouch. Where he moves, his
    gait sets them within a step or two; a runner pushes off one foot, and does not crouch."""
    if np.all(state.contacts) and np.abs(state.velocity).max() < STANDS:
        return False
    body, start = physique.tables, start_of(physique, state)
    if start.single is not None:
        return False
    feet = start.planted(float(state.floor), body)
    turned = wrap(feet[:, 3] - start.heading)
    ankles = feet[:, :3] @ yaw(start.heading)[:, 0] - body.toe[2] * np.sin(turned)  # to the left
    knees = ankles + KNEES * body.size * np.sin(turned)
    return bool(np.abs(turned).max() > TURNED or min(ankles[0] - ankles[1], knees[0] - knees[1]) < APART * body.size)


def _feet(skeleton: Skeleton, positions: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """The feet (2, 5) of a placed body: balls, yaw, pitch. Yaw is where a foot points that is turned level about its own x axis: a runner's heel comes up until toes point down
    and back, and where those point turns round then."""
    feet = np.zeros((2, 5))
    for side, name in enumerate(("Left", "Right")):
        foot = turned[skeleton.index(name + "Foot")]
        feet[side, :3] = positions[skeleton.index(name + "Toe")]
        pitch = np.arctan2(-foot[1, 2], foot[1, 1])
        ahead = foot[:, 2] * np.cos(pitch) + foot[:, 1] * np.sin(pitch)
        feet[side, 3:] = np.arctan2(ahead[0], ahead[2]), pitch
    return feet


def _ground(state: CharacterState, around: Sequence[Any]) -> tuple[float, np.ndarray]:
    """How high [m] the ground is under somebody, and how (2,) it rises along x and z [m/m]."""
    x, z, _ = np.asarray(state.ground, float)
    floor = float(state.floor)
    slope = slope_at(x, z, around, floor + UNDER) if len(around) else np.zeros(2)
    return floor_at(x, z, around, floor + UNDER) if slope.any() else floor, slope


def _comes_down(physique: Physique, state: CharacterState) -> np.ndarray:
    """Whether each foot (2,), heel and toes, is still in the air and comes down."""
    if state.previous is None or not state.elapsed > 0.0:
        return np.zeros(2, bool)
    before, now = (contact_points(physique.skeleton, *forward_kinematics(physique.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))[:, 1]
                   .reshape(2, 2).min(1) for pose in (state.previous, state.pose))
    return (now - float(state.floor) > physique.tables.sole + HIGH * physique.size) & (before - now > SINKS * math.sqrt(physique.size) * state.elapsed)


def _single(state: CharacterState) -> int | None:
    """The foot that pushes a runner off: the one that stands, if the other is in the air."""
    if np.hypot(state.velocity[0], state.velocity[2]) < RUNNING:
        return None
    standing = np.asarray(state.contacts).reshape(2, 2).any(1)
    return int(np.argmax(standing)) if standing.sum() == 1 else None
