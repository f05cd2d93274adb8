"""The path estimate (Ooi 2015, 3.1.1): where the centre of mass goes, from the lowest point of the
wind-up over take-off to landing, and what stops a body from going there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from ..body.rotations import yaw
from ..body.support import HALF_SOLE
from . import style
from .ballistics import apex_airtime, least_effort, take_off_velocity
from .dynamics import BodyTables, Physique
from .poise import HALF_STANCE, STAND_REACH
from .posture import stand_kernel
from .thrust import Push, push, risen
from .windup import crouch_depth, strength

HEEL_UP, TOES_DOWN = 0.70, 0.30
"""How far a foot points down as it leaves the floor and as it lands: toes last, toes first [rad]."""
TAKE_OFF_REACH, TOUCH_REACH = 0.955, 0.93
"""How straight legs are, as shares of their length, as they take off and touch down."""
MOST_LEAD = 0.60
"""How far ahead of its ball of foot a runner may leave the floor, as a share of the leg."""
YIELD = (0.05, 0.13)
"""How long a runner's foot gives before it pushes, at least and at most [s]."""
OVER_BALLS = 0.058
"""A standing jumper's centre of mass leaves so far ahead of the balls of the feet [m], at standard height."""
SHORTEST_PUSH = 0.08
"""No foot pushes a runner off in less [s]."""
SQUAT, DEEPEST_SQUAT = 0.6, 0.30
"""How much lower [m] a body lands for each metre that it jumps up, and at most, at standard height."""
SOFT = (0.035, 2.5, 0.10)
"""How much lower [m] a body touches down for each m/s that it falls faster than the second [m/s], and at most:
bent legs give way without the knees flying. At standard height and what an adult falls."""
FOOT_FADE = 0.07
"""Half-life with which feet settle flat where they come to stand [s]."""
LEAST_CROUCH = 0.07
"""A body crouches at least so deep [m], at standard height."""
LEAST_AIRTIME = 0.30
"""Shorter flights look like stumbling [s]; on Earth, at standard height."""


@dataclass(frozen=True, eq=False)
class Start:
    """From where a jump starts.

    root: (3,) [m], rotations: (J, 3, 3) of the pose. rates: (J, 3) [rad/s] how fast the joints turn,
    each in its parent's frame. centre, velocity: (3,) of the centre of mass [m, m/s]. feet, feet_rates:
    (2, 5) ball x, y, z [m], yaw, pitch [rad] and how fast they change. heading [rad]. single: the foot that pushes off a run, 0 left
    or 1 right; None for both.
    """

    root: np.ndarray
    rotations: np.ndarray
    rates: np.ndarray
    centre: np.ndarray
    velocity: np.ndarray
    feet: np.ndarray
    heading: float
    feet_rates: np.ndarray = field(default_factory=lambda: np.zeros((2, 5)))
    single: int | None = None

    def planted(self, floor: float, body: BodyTables) -> np.ndarray:
        """Where the feet (2, 5) come to stand on a floor [m]: flat, and as far on as carries them."""
        feet = self.feet + self.feet_rates * (FOOT_FADE / (2.0 * np.log(2.0)))
        feet[:, 1], feet[:, 4] = floor + body.sole, 0.0
        return feet


@dataclass(frozen=True, eq=False)
class Path:
    """The way of the centre of mass: lowest point, take-off, landing (3,) [m], its velocities (3,) [m/s] at
    the lowest point and at take-off, the flight's and the wind-up's time [s], the push between,
    None for a fall; strong: whether the muscles can. far, up: how far and how much higher the feet land [m]. heading
    [rad]. low_arms: the arms stay down."""

    low: np.ndarray
    leave: np.ndarray
    land: np.ndarray
    passing: np.ndarray
    velocity: np.ndarray
    airtime: float
    wind_up: float
    gravity: np.ndarray
    push: Push | None
    strong: bool = True
    far: float = 0.0
    up: float = 0.0
    heading: float = 0.0
    low_arms: bool = False

    @property
    def falling(self) -> np.ndarray:
        """The velocity (3,) [m/s] at landing."""
        return self.velocity + self.gravity * self.airtime


@dataclass(frozen=True)
class Measures:
    """Heights [m] of a body's centre of mass over the floor: standing, as it takes off, as it touches
    down; stride: from the ball of a runner's foot as it leaves."""

    stand: float
    leave: float
    touch: float
    stride: float


@lru_cache(maxsize=64)
def measures(physique: Physique, low_arms: bool = False) -> Measures:
    """The heights of the centre of mass of a body over its own feet."""
    feet = landing_feet(np.zeros(3), 0.0, physique.tables)
    leave, touch = style.TAKE_OFF.copy(), style.TOUCH.copy()
    if low_arms:
        leave[3], touch[3] = style.LOW_ARMS[[0, 2]]
    found = []
    for angles, pitch, share in ((style.STAND, 0.0, STAND_REACH), (leave, HEEL_UP, TAKE_OFF_REACH),
                                 (touch, TOES_DOWN, TOUCH_REACH)):
        found.append(_height(physique, angles, pitch, share, feet))
    return Measures(*found, 1.022 * found[1])


def _height(physique: Physique, angles, pitch: float, share: float, feet: np.ndarray) -> float:
    """The centre of mass's height over two feet, the legs `share` of their length."""
    body, skeleton = physique.tables, physique.skeleton
    local = np.tile(np.eye(3), (len(skeleton), 1, 1))
    positions, turned = np.empty((len(skeleton), 3)), np.empty((len(skeleton), 3, 3))
    style.carry_kernel(angles, style.joints_of(skeleton), local)
    local[0] = Rotation.from_rotvec([angles[0], 0.0, 0.0]).as_matrix()
    free = np.column_stack([feet[:, :4], [pitch, pitch], [0.0, 0.0]])
    tilt = np.stack([yaw(f[3]) @ Rotation.from_rotvec([f[4], 0.0, 0.0]).as_matrix() for f in free])
    ankles = free[:, :3] - tilt @ body.toe
    centre = np.array([0.0, body.sole + 1.1 * (body.thigh + body.shank), 0.0])
    root = centre.copy()
    for _ in range(40):
        stand_kernel(body, centre, free.copy(), 1.0, root, local, positions, turned)
        line = positions[body.hip] - ankles
        wanted = np.sqrt((share * (body.thigh + body.shank)) ** 2 - line[:, 0] ** 2 - line[:, 2] ** 2)
        centre[1] += (wanted - line[:, 1]).min()
    return float(centre[1])


def soles(feet: np.ndarray, body: BodyTables) -> np.ndarray:
    """The corners (4 F, 3) [m] of the soles of flat feet (F, 5): heels and tips."""
    half = HALF_SOLE * body.sole / 0.02
    corners = [(side * half, -body.sole, along) for along in (body.heel[2] - body.toe[2], body.tip[2])
               for side in (-1.0, 1.0)]
    return np.concatenate([foot[:3] + np.array(corners) @ yaw(foot[3]).T for foot in feet])


def landing_feet(place: np.ndarray, heading: float, body: BodyTables) -> np.ndarray:
    """Two feet (2, 5) whose soles' middle is at `place` (3,), toes slightly out."""
    middle = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    feet = np.zeros((2, 5))
    for side, sign in enumerate((1.0, -1.0)):
        feet[side, 3] = heading + sign * 0.08
        ball = np.array([sign * HALF_STANCE * body.sole / 0.02, body.sole, 0.0])
        feet[side, :3] = place + yaw(heading) @ ball - yaw(feet[side, 3]) @ [0.0, 0.0, middle]
    return feet


def path(physique: Physique, start: Start, feet: np.ndarray, landing: np.ndarray, floor: float,
         gravity: np.ndarray, airtime: float | None = None, low_arms: bool = False) -> Path:
    """The path from the planted `feet` (F, 5) on a `floor` [m] to the `landing` feet (2, 5).

    airtime: [s], or None for the least effort. low_arms: with the arms down. The crouch is as deep as the muscles need it (`windup`).
    """
    body, heights = physique.tables, measures(physique, low_arms)
    size = body.sole / 0.02
    ground = soles(feet, body)
    middle, goal = ground.mean(0), soles(landing, body).mean(0)
    flat = (goal - middle) * [1.0, 0.0, 1.0]
    far = float(np.linalg.norm(flat))
    towards = flat / far if far > 1e-6 else np.zeros(3)
    running = start.single is not None
    passing = start.velocity * [1.0, 0.0, 1.0] if running else np.zeros(3)
    reach = ((ground - middle) @ towards)
    ahead, behind = float(reach.max()) - 0.01, -float(reach.min()) - 0.01
    facing = yaw(start.heading)[:, 2]
    balls = float(((feet[:, :3] - middle) @ facing).max()) + OVER_BALLS * size
    g = -float(gravity[1])
    # who jumps up lands with folded legs, and need not bring the body as high
    squat = min(SQUAT * max(float(goal[1]) - floor, 0.0), DEEPEST_SQUAT * size)
    wind_up = 0.10
    low = start.centre + start.velocity * wind_up * [1.0, 0.0, 1.0]
    stance = feet[:, :3].mean(0) * [1.0, 0.0, 1.0]
    leave = middle * [1, 0, 1] + [0.0, floor + heights.leave, 0.0]
    trail, soft, deep, strong = 0.0, 0.0, 0.1, True
    for _ in range(12 if running else 6):
        land = goal * [1, 0, 1] - trail * towards + [0.0, goal[1] + _over(heights.touch - max(squat, soft), trail), 0.0]
        flight = airtime if airtime is not None else max(
            least_effort(leave, land, passing, gravity), LEAST_AIRTIME * np.sqrt(9.81 / g * size),
            apex_airtime(leave, land, max(land[1] - leave[1], 0.0) + 0.04 * size, gravity))
        velocity = take_off_velocity(leave, land, flight, gravity)
        speed = float(velocity @ towards)
        trail = min(0.30 * size, max(0.16 * speed, 0.0))
        soft = softened(g * flight - float(velocity[1]), size)
        if running:
            drop = 0.07 * size
            height = min(start.centre[1] - 0.5 * drop, floor + heights.stand - drop)
            pace = float(np.linalg.norm(passing))
            past = (start.centre - stance) @ passing / pace
            most = MOST_LEAD * (body.thigh + body.shank)
            mean = 0.5 * (passing + velocity * [1.0, 0.0, 1.0])
            # the foot stays where it is: no longer than the leg reaches, and then from less deep
            longest = max((most - past - pace * YIELD[0]) / max(float(np.linalg.norm(mean)), 1e-6), SHORTEST_PUSH)
            rise = min(max(leave[1] - height, 0.0), risen(longest, velocity[1], g))
            pushed = push(np.array([0.0, rise, 0.0]), np.zeros(3), velocity, gravity)
            wind_up = float(np.clip((most - past - np.linalg.norm(mean) * pushed.duration) / pace, *YIELD))
            low = (start.centre + start.velocity * wind_up) * [1.0, 0.0, 1.0]
            leave = 0.5 * (leave + low + mean * pushed.duration)  # half the way: the whole one swings about
            leave[1] = floor + _over(heights.stride, np.linalg.norm((leave - stance)[[0, 2]]))
            low[1] = leave[1] - rise
        else:
            rise = leave[1] - floor - heights.stand
            deep = crouch_depth(physique, velocity, rise, gravity)
            strong = deep == deep  # not a number where the muscles can't
            deep = max(deep, LEAST_CROUCH * size) if strong else float(strength(physique).depth[-1])
            need = 0.45 * push(np.array([0.0, deep + rise, 0.0]), np.zeros(3), velocity, gravity).duration * speed
            lead = min(ahead, 0.5 * need + 0.5 * max(ahead - behind, 0.0))
            # heels rise before the body leaves: it must be over the balls by then
            more = max(balls - lead * float(towards @ facing), 0.0) * facing * (far * (towards @ facing) > -0.15)
            leave = middle * [1, 0, 1] + lead * towards + more
            low = leave - towards * min(need, lead + 0.1 * behind) - 0.4 * more + [0.0, floor + heights.stand - deep, 0.0]
            leave[1] = floor + _over(heights.leave, np.linalg.norm(lead * towards + more))
            wind_up = 0.34 + 0.9 * np.sqrt(max(start.centre[1] - low[1], 0.0) / max(g, 3.0))
    velocity = take_off_velocity(leave, land, flight, gravity)  # from where it leaves in the end
    return Path(low, leave, land, passing, velocity, float(flight), float(wind_up), gravity,
                push(leave - low, passing, velocity, gravity), strong, far, float(goal[1]) - floor, start.heading, low_arms)


def softened(fall: float, size: float) -> float:
    """How much lower [m] a body of this size touches down that falls with `fall` [m/s], see SOFT."""
    return size * min(SOFT[0] * max(fall / np.sqrt(size) - SOFT[1], 0.0), SOFT[2])


def _over(height: float, aside: float) -> float:
    """How high a centre of mass stands that leans `aside` from where it would stand `height` [m] high."""
    return float(np.sqrt(max(height**2 - aside**2, 0.25 * height**2)))
