"""How a jumper stands: from where a jump starts, how high its centre of mass is over its feet, and where the feet are."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...body import exp_kernel, product_kernel
from ...compiled import kernel
from . import carriage
from .balance import STAND_REACH
from .ballistics import apex_airtime
from .dynamics import BodyTables, Physique, centre_kernel, place_kernel
from .sloped_feet import LEVEL, landing_feet, raised, rise, uphill
from .planted_pose import stand_kernel

FLAT = np.array([1.0, 0.0, 1.0])
"""What is left of a vector along the floor."""
HEEL_UP, TOES_DOWN = 0.70, 0.30
"""How far a foot points down as it leaves the floor and as it lands: toes last, toes first [rad]."""
TAKE_OFF_REACH, TOUCH_REACH = 0.982, 0.93
"""How straight legs are, as shares of their length, as they take off and touch down."""
HOP_REACH = 0.957
"""And as they take off together from a springy landing: knees bent by 34°, as recorded."""
HOP_HEEL = 0.45
"""How far a foot points down as it leaves it from a springy landing [rad]."""
FOOT_FADE = 0.07
"""Half-life with which feet settle flat where they come to stand [s]."""
MOST_LEAD = 0.60
"""How far ahead of the balls of its feet a body may leave the floor, as a share of the leg."""
TRAIL = (0.16, 0.30, 0.36)
"""How far behind its feet [m] a body touches down for each m/s forward, at most onto one foot or out of a run, and at most off both feet, as the farthest recorded
jump; at standard height."""
TURNED = 0.2, 0.92
"""Which share of its turn a body has made as it leaves the floor and as it touches down."""


class Ledge(NamedTuple):
    """An edge: where it is, x, z [m]; which way along the floor it is higher, up_x, up_z of length 1; and by how much, high [m]."""

    x: float
    z: float
    up_x: float
    up_z: float
    high: float


@dataclass(frozen=True, eq=False)
class Start:
    """From where a jump starts.

    root: (3,) [m], rotations: (J, 3, 3) of the pose. rates: (J, 3) [rad/s] how fast the joints turn,
    each in its parent's frame. centre, velocity: (3,) of the centre of mass [m, m/s]. feet, feet_rates:
    (2, 5) ball x, y, z [m], yaw, pitch [rad] and how fast they change. heading [rad]. single: the foot that pushes off a run, 0 left
    or 1 right; None for both. ready: it crouches, or waits in the crouch, to push off as soon as it is told. low: it comes down from a
    jump, and its legs give until the centre of mass is so high [m]; None where it does not. acceleration: (3,) [m/s²] of the centre then.
    turn: how far to the left it turns until it lands [rad], looking where it goes; None where nobody told. springs: the landing was made to hop on
    from. onto: how it lands to hop on, 0 left foot, 1 right, 2 both; None to stand there or run on. haste: 0 it leaves hardly
    faster than it runs, as far as can be, on knees that turn no faster than people's; 1 as much faster as takes least force, on legs as straight as can be; 2 heels
    and a free leg as fast as it takes, too. slope: (2,) [m/m] how the ground rises along x and z on which it stands, its floor as high as that at here (2,) [m]; feet are then
    pitched against that ground. lands_on: (2,) how it rises where it lands. levels: (2,) how high each foot stands over the lower one's floor [m], as astride an edge.
    stays: who walks wants to come to rest where he lands. cramped: beyond that is no room to run on. along: he goes slowly, aside or backward, and goes on so. bound: he
    walks, and pushes off the foot under him as those do, but to a place. ledge: the edge over which he leaps up or down; None for none.
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
    ready: bool = False
    low: float | None = None
    acceleration: np.ndarray = field(default_factory=lambda: np.zeros(3))
    turn: float | None = None
    springs: bool = False
    onto: int | None = None
    haste: int = 0
    slope: np.ndarray = field(default_factory=lambda: LEVEL)
    here: np.ndarray = field(default_factory=lambda: LEVEL)
    lands_on: np.ndarray = field(default_factory=lambda: LEVEL)
    levels: np.ndarray = field(default_factory=lambda: LEVEL)
    stays: bool = False
    cramped: bool = False
    along: bool = False
    bound: bool = False
    ledge: Ledge | None = None

    def on(self, slope: np.ndarray, here: np.ndarray) -> Start:
        """The same of one who stands on ground that rises by slope (2,) [m/m], which is as high as his floor at here (2,) [m]."""
        feet = self.feet.copy()
        feet[:, 4] += uphill(feet, slope)
        return replace(self, feet=feet, slope=slope, here=here)

    def rise(self, places: np.ndarray) -> np.ndarray:
        """How high (...) the ground on which it stands is over its floor at places (..., 3) [m]."""
        return rise(places[..., [0, 2]] - self.here, self.slope)

    @property
    def runs(self) -> bool:
        """Whether it pushes off one foot out of a run."""
        return self.single is not None and not self.springs

    @property
    def straight(self) -> float:
        """How straight legs are as they take off, as a share of their length."""
        return HOP_REACH if self.springs and self.single is None else TAKE_OFF_REACH

    @property
    def heel_up(self) -> float:
        """How far a foot points down as it leaves the floor [rad]."""
        return HOP_HEEL if self.springs else HEEL_UP

    def pushing(self, planted: np.ndarray) -> np.ndarray:
        """Of planted feet (2, 5) those that push (2, 5): one of them twice if the other is in the air."""
        return planted if self.single is None else planted[[self.single, self.single]]

    @property
    def lands(self) -> float:
        """The heading [rad] in which it lands."""
        return self.heading + (self.turn or 0.0)

    @property
    def leaves(self) -> float:
        """The heading [rad] in which it leaves the floor."""
        return self.heading + TURNED[0] * (self.turn or 0.0)

    def planted(self, floor: float, body: BodyTables) -> np.ndarray:
        """Where the feet (2, 5) come to stand, the lower on a floor [m]: flat, and as far on as carries them."""
        feet = self.feet + self.feet_rates * (FOOT_FADE / (2.0 * np.log(2.0)))
        feet[:, 1], feet[:, 4] = floor + self.levels + raised(body, self.slope) + self.rise(feet[:, :3]), 0.0
        return feet


@dataclass(frozen=True, eq=False)
class Measures:
    """Heights [m] of a body's centre of mass over the floor: standing; leaves: (L,) as it takes off so far ahead (L,) [m] of
    the balls of its feet; touches: (T,) as it touches down so far behind (T,) [m] the middle of its soles, negative ahead of it.

    carried: (2,) how high the centre of mass lies over the pelvis for that, at take-off and at touch-down [m].
    """

    stand: float
    leads: np.ndarray
    leaves: np.ndarray
    trails: np.ndarray
    touches: np.ndarray
    carried: np.ndarray

    def touch(self, trail: float, aside: float = 0.0) -> float:
        """How high it touches down `trail` [m] behind its feet, and so far to a side of them."""
        return over(float(np.interp(trail, self.trails, self.touches)), aside)

    def leave(self, lead: float, aside: float = 0.0) -> float:
        """How high it takes off `lead` [m] ahead of the balls of its feet, and so far to a side of them."""
        return over(float(np.interp(lead, self.leads, self.leaves)), aside)

    def of(self, leave: float, touch: float) -> Measures:
        """The same legs under a body whose centre of mass is carried at other heights over its pelvis [m]."""
        return replace(self, leaves=self.leaves + leave - self.carried[0], touches=self.touches + touch - self.carried[1],
                       carried=np.array([leave, touch]))


def measures(physique: Physique) -> Measures:
    """The heights of the centre of mass of a body over its own feet; found once."""
    return _measures(physique)  # however it is called


@lru_cache(maxsize=64)
def _measures(physique):
    body = physique.tables
    feet = landing_feet(np.zeros(3), 0.0, body)
    leads = np.linspace(-0.2, MOST_LEAD, 9) * (body.thigh + body.shank)
    ball = feet[:, 2].mean()
    leaves = [_height(physique, carriage.TAKE_OFF, HEEL_UP, TAKE_OFF_REACH, feet, ball + lead) for lead in leads]
    trails = np.linspace(-TRAIL[2], TRAIL[2], 9) * body.size
    touches = [_height(physique, carriage.TOUCH, TOES_DOWN, TOUCH_REACH, feet, -trail) for trail in trails]
    return Measures(_height(physique, carriage.STAND, 0.0, STAND_REACH, feet), leads, np.array(leaves), trails, np.array(touches),
                    np.array([carried(physique, carriage.TAKE_OFF), carried(physique, carriage.TOUCH)]))


def carried(physique: Physique, angles: np.ndarray) -> float:
    """How high [m] the centre of mass lies over the pelvis of a body carried by `angles` (11,), its legs hanging."""
    return carried_kernel(physique.tables, np.ascontiguousarray(angles, float), carriage.joints_of(physique.skeleton))


@kernel
def upright_kernel(body, angles, joints):
    """The local rotations (J, 3, 3) of a body carried by `angles` (11,), its pelvis upright, and room for places (J, 3) and turns (J, 3, 3)."""
    count = len(body.parents)
    local = np.zeros((count, 3, 3))
    for j in range(count):
        for i in range(3):
            local[j, i, i] = 1.0
    carriage.carry_kernel(angles, joints, local)
    return local, np.empty((count, 3)), np.empty((count, 3, 3))


@kernel
def carried_kernel(body, angles, joints):
    """See `carried`. joints: as in `carriage.joints_of`."""
    local, positions, turned = upright_kernel(body, angles, joints)
    centre = np.empty(3)
    exp_kernel(angles[0], 0.0, 0.0, local[0])
    for hip in body.hip:
        exp_kernel(-angles[0], 0.0, 0.0, local[hip])
    place_kernel(body, np.zeros(3), local, positions, turned)
    centre_kernel(body, positions, turned, centre)
    return centre[1]


def airtime_up(physique: Physique, height: float, gravity: np.ndarray) -> float:
    """The airtime [s] in which a body that jumps in place rises by `height` [m] after it has left the floor."""
    heights = measures(physique)
    leave, touch = heights.leave(0.0), heights.touch(0.0)
    return apex_airtime([0.0, leave, 0.0], [0.0, touch, 0.0], max(height, touch - leave), gravity)


def _height(physique: Physique, angles, pitch: float, share: float, feet: np.ndarray, ahead: float = 0.0) -> float:
    """The centre of mass's height over two feet, `ahead` [m] of the origin, the legs `share` of their length."""
    body = physique.tables
    return stretched(physique, angles, feet, pitch, share, 0.0, np.array([0.0, body.sole + 1.1 * (body.thigh + body.shank), ahead]))


def stretched(physique: Physique, angles: np.ndarray, feet: np.ndarray, pitch: float, share: float, heading: float,
              guess: np.ndarray) -> float:
    """How high [m] the centre of mass is over `guess`'s (3,) place on the floor, where the leg of two feet (2, 5) that is
    stretched more is `share` of its length, the feet `pitch` [rad] down, the body carried by `angles` (11,) and heading as told."""
    return stretched_kernel(physique.tables, np.ascontiguousarray(angles, float), carriage.joints_of(physique.skeleton),
                            np.ascontiguousarray(feet, float), float(pitch), float(share), float(heading),
                            np.ascontiguousarray(guess, float))


@kernel
def stretched_kernel(body, angles, joints, feet, pitch, share, heading, guess):
    """See `stretched`. joints: as in `carriage.joints_of`."""
    local, positions, turned = upright_kernel(body, angles, joints)
    turn, lean = np.empty((3, 3)), np.empty((3, 3))
    exp_kernel(0.0, heading, 0.0, turn)
    exp_kernel(angles[0], 0.0, 0.0, lean)
    product_kernel(turn, lean, local[0])
    ankles, free = np.empty((2, 3)), np.zeros((2, 6))
    for side in range(2):
        exp_kernel(0.0, feet[side, 3], 0.0, turn)
        exp_kernel(pitch, 0.0, 0.0, lean)
        product_kernel(turn, lean, turned[0])
        for i in range(3):
            ankles[side, i] = feet[side, i]
            for k in range(3):
                ankles[side, i] -= turned[0, i, k] * body.toe[k]
    centre, root = guess.copy(), guess.copy()
    leg = share * (body.thigh + body.shank)
    for _ in range(40):
        free[:, :4], free[:, 4] = feet[:, :4], pitch
        stand_kernel(body, centre, free, 1.0, root, local, positions, turned)
        short = np.inf
        for side in range(2):
            x, y, z = positions[body.hip[side]] - ankles[side]
            short = min(short, math.sqrt(max(leg * leg - x * x - z * z, 0.0)) - y)
        centre[1] += short
        root[1] += short
        if abs(short) < 1e-6:
            break
    return centre[1]


def over(height: float, aside: float) -> float:
    """How high a centre of mass stands that leans `aside` from where it would stand `height` [m] high."""
    return float(np.sqrt(max(height**2 - aside**2, 0.25 * height**2)))
