"""Who is struck: ``state', pose = struck.step(state, intent, dt)``. He sways, steps, or falls and gets up again, and walks on."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np

from ..body import Pose, Skeleton, contact_points, forward_kinematics
from ..contract import CharacterState, Controller, Intent, Status, Strike, Unable, level, seconds
from ..jump import GRAVITY, Physique, stands, start_of, stayed
from ..jump.body import measures
from ..jump.motion import as_shown
from ..navigation import gap
from ..navigation.passing import drawn_in
from .capture import FALLS, Way, way
from .flesh import flesh
from .passing import PACES, legs_apart
from .recorded_pushes import response
from .recovery import Recovery, ending
from .settled import LATE
from .stepping import walks_kernel
from .stumble import CHEST, stumble
from .surroundings import about
from .toppling import settles, topple

STRUCK, HOLDS, OVER = 3.0, 1.4, 0.3
"""How well it bids for somebody who is struck, above all others; how firmly it holds on, less than who loses the floor; once one can walk on."""
WISHES = 0.05
"""Wishes smaller than this are none [m/s, rad/s]."""
LANDED = 0.06
"""One walks on as a foot has landed, in so long [s]."""
RESTS = 0.05
"""Who is slower than this [m/s] once he has got up does not walk on by himself."""
SHIFTS = 8.0
"""Rate [1/s] with which the ground frame comes under the centre of mass, from where it was."""
LEADS = 1.0
"""In so long [s] it comes to where it will be of one who walks or stands, until he does."""
SLIDES = 0.3
"""Whose feet would slide faster than this [m/s] were they to catch him falls."""
GRAZES = 0.03
"""Nobody sets his feet home who would get deeper into anything for that [m], as into the edges of treads."""
KNEELS, UPRIGHT = 0.5, 0.85
"""Whose hips would come lower than the first, as a share of where they are as he stands, falls; who has fallen is down until they are at the second."""
ROOMY, TANGLED = 0.06, 0.03
"""Legs whose axes come no nearer than the first [m] are not in each other; whose legs come nearer than the second whatever he does trips over them, and falls."""
ALOFT = 0.12
"""Who is higher over the floor with both feet [m], at standard height, is in the air and no runner: there nobody can be struck."""


@dataclass(frozen=True, eq=False)
class Recovering:
    """What somebody remembers who was struck. made: what he plays; time: [s] since the strike. shift: (3,) x, z [m] of the ground frame from under the centre of mass, and its
    heading's [rad] from the plan's, as that began. stood: (4,) where he was left, as `stands` has it."""

    made: Recovery
    time: float = 0.0
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    stood: np.ndarray | None = None


class Struck(Controller):
    """What becomes of somebody who is struck, `Intent.strike`: a pure function of his state and the impulse.

    physique: whose body. gravity: (3,) [m/s²]. Pre-condition: a foot stands, or is about to. Post-condition: it stands at rest on both feet, or walks on with the velocity
    that the state says, or as soon as somebody wants to walk and a foot has landed.
    """

    def __init__(self, physique: Physique = Physique(), gravity=GRAVITY):
        self.physique, self.gravity = physique, np.asarray(gravity, float)

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton that the poses are of."""
        return self.physique.skeleton

    @property
    def kind(self) -> str:
        """What tells its motion from that of others."""
        return f"Struck {self.physique} {self.gravity.tolist()}"

    @property
    def rate(self) -> float:
        """ω = √(g/h) [1/s] of the pendulum that it is as it stands."""
        return float(np.sqrt(-self.gravity[1] / measures(self.physique).stand))

    def gain(self, strike: Strike) -> np.ndarray:
        """By how much (2,) x, z [m/s] a strike changes the velocity of its mass centre."""
        return np.array(strike.impulse) / self.physique.mass

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """STRUCK for who is struck and not in the air; while it goes on, how firmly it holds on."""
        if isinstance(state.memory, Recovering):
            wishes = bool(np.abs(intent.velocity).max() > WISHES) or intent.leap is not None
            return OVER if wishes and self._walks_on(state) else HOLDS
        if intent.strike is None or np.ndim(state.ground) != 1:
            return 0.0
        low = float(start_of(self.physique, state).feet[:, 1].min()) - float(state.floor)
        return STRUCK if low < self.physique.tables.sole + ALOFT * self.physique.size else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state of who has just been struck. Unable where nothing strikes."""
        if intent.strike is None:
            raise Unable("nothing strikes it")
        made = self._begins(self._planned(state, intent, intent.strike), state)
        shift = np.asarray(state.ground, float) - [*made.centres[0, [0, 2]], made.headings[0]]
        return replace(state, memory=Recovering(made, 0.0, shift, stands(state)))

    def _begins(self, made: Recovery, state: CharacterState) -> Recovery:
        """The same, its legs as they were shown; of a fall that is still to settle as it is: that begins so."""
        if made.settling is not None:
            return made
        roots, local = as_shown(self.physique, start_of(self.physique, state), made.times, made.roots, made.local)
        return replace(made, roots=roots, local=local)

    def recovery(self, state: CharacterState, intent: Intent, strike: Strike) -> Recovery:
        """What becomes of a state that is struck: its mass centre's velocity is what it was and the impulse over the mass."""
        return settles(self._planned(state, intent, strike), math.inf)

    def _planned(self, state: CharacterState, intent: Intent, strike: Strike) -> Recovery:
        """The same; a fall on uneven ground is still to settle."""
        start, floor, size = start_of(self.physique, state), float(level(state.floor)), self.physique.size
        x, z = self.gain(strike)
        start = replace(start, velocity=start.velocity + np.array([x, 0.0, z]))
        free: np.ndarray = np.asarray(np.logical_not(np.asarray(state.contacts, bool).reshape(2, 2)).all(1))
        c, s = np.cos(start.heading), np.sin(start.heading)
        v_f, omega, v_l = np.asarray(intent.velocity, float)
        wish = np.array([s * v_f + c * v_l, c * v_f - s * v_l]) if np.isfinite([v_f, v_l]).all() else np.zeros(2)
        height = CHEST * size if strike.height is None else strike.height
        things = about(intent.around, start.centre[[0, 2]])

        def going(over: bool, pace: float) -> Way:
            return way(start.centre[[0, 2]], start.velocity[[0, 2]], start.feet[:, [0, 2, 3]], free, start.heading, self.rate, wish, self.physique.tables, floor, things, over, pace)

        def played(goes: Way) -> Recovery:
            return stumble(self.physique, start, goes, free, response(), floor, height)

        best, room = None, -1.0
        for pace in PACES:
            goes = going(False, pace)
            made = None if goes.fate == FALLS else played(goes)
            if made is not None and _slides(self.skeleton, made) < SLIDES and self._raised(made).min() > KNEELS:
                apart = legs_apart(self.skeleton, made.roots, made.local)
                if apart > ROOMY:
                    return made
                best, room = (made, apart) if apart > room else (best, room)
        if best is not None and room > TANGLED:
            return best
        made = topple(self.physique, start, floor, self.rate, things)
        if made.supported or (goes := going(True, PACES[-1])).fate == FALLS:
            return made
        return played(goes)

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds. ValueError unless 0 < dt ≤ 0.1, and for who was set elsewhere since the last one."""
        dt = seconds(dt)
        stayed(state.memory.stood, state)
        if intent.strike is not None and state.memory.time > 0.0 and not self._down(state.memory):  # struck again
            state = self.enter(state, intent)
        memory: Recovering = state.memory
        made = settles(memory.made, memory.time + dt - min(dt, LATE))
        time = min(memory.time + dt, made.duration)
        pose, (centre, velocity, heading) = made.at(time), made.moving(time)
        ground = np.array([centre[0], centre[2], heading]) + memory.shift * (1.0 + SHIFTS * time) * np.exp(-SHIFTS * time)
        ends, place = ending(self.skeleton, self.physique.size, made, pose, time)
        share = np.clip((time - ends) / min(LEADS, ends) + 1.0, 0.0, 1.0)
        ground[:2] += share**2 * (3.0 - 2.0 * share) * (place - ground[:2])
        c, s = np.cos(ground[2]), np.sin(ground[2])
        velocity = np.array([s * velocity[0] + c * velocity[2], 0.0, c * velocity[0] - s * velocity[2]])
        if made.fate < FALLS and len(intent.around):
            pose = drawn_in(self.skeleton, pose, ground, intent.around)
        n, part = made.between(time)
        after = replace(state, ground=ground, velocity=velocity, pose=pose, contacts=made.contacts[n + round(part)].copy(),
                        memory=replace(memory, made=made, time=time, stood=np.array([*ground, made.floors[n]])), floor=float(made.floors[n]))
        if np.abs(intent.velocity).max() > WISHES and self._walks_on(after) and not made.stands(time):
            after = replace(after, contacts=after.contacts & np.repeat(np.arange(2) == made.landing(time, LANDED), 2))
        if made.fate == FALLS and memory.time < made.duration <= time and np.hypot(velocity[0], velocity[2]) < RESTS:
            home = self._home(after, intent, made.why)
            home = home if home is None else self._begins(home, after)
            after = after if home is None else replace(after, memory=Recovering(home, 0.0, ground - [*home.centres[0, [0, 2]], home.headings[0]], after.memory.stood))
        return after, pose

    def _home(self, state: CharacterState, intent: Intent, why: str) -> Recovery | None:
        """The step of who has got up on uneven ground, and rests, with which his feet come to stand as people's do; None where they stand so, or it would lead nowhere."""
        start, floor = start_of(self.physique, state), float(level(state.floor))
        free: np.ndarray = np.asarray(np.logical_not(np.asarray(state.contacts, bool).reshape(2, 2)).all(1))
        goes = way(start.centre[[0, 2]], np.zeros(2), start.feet[:, [0, 2, 3]], free, start.heading, self.rate, np.zeros(2), self.physique.tables, floor,
                   about(intent.around, start.centre[[0, 2]]), False)
        if goes.fate >= FALLS or not len(goes.steps):
            return None
        made = stumble(self.physique, start, goes, free, response(), floor, CHEST * self.physique.size)
        return replace(made, why=why) if _deeper(self.physique, made, intent.around) < GRAZES else None

    def status(self, state: CharacterState) -> Status:
        """Running until it stands, and says what it does."""
        memory: Recovering = state.memory
        if memory.time < memory.made.duration:
            return Status("running", memory.made.why)
        return Status("done", memory.made.why)

    def _raised(self, made: Recovery) -> np.ndarray:
        """How high (N,) the hips are over where it stands, as a share of how high they are in the T-pose."""
        return (made.roots[:, 1] - made.floors) / self.skeleton.offsets[0, 1]

    def _down(self, memory: Recovering) -> bool:
        """Whether he falls, lies or gets up: nothing that strikes him then changes that."""
        made = memory.made
        return made.fate == FALLS and bool(self._raised(made)[made.between(memory.time)[0]] < UPRIGHT)

    def _walks_on(self, state: CharacterState) -> bool:
        """Whether one could walk on now: a foot has just landed, or one stands."""
        memory: Recovering = state.memory
        if memory.made.stands(memory.time):
            return True
        if memory.made.landing(memory.time, LANDED) < 0:
            return False
        return bool(walks_kernel(np.asarray(state.velocity, float)[[2, 0]], 0.0, self.physique.size))


def _deeper(physique: Physique, made: Recovery, things) -> float:
    """How much deeper [m] flesh gets into anything than it was at first."""
    points, thick = flesh(physique, *forward_kinematics(physique.skeleton, made.roots, made.local))
    deep = np.array([(thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])).max(1) for thing in things]).reshape(-1, len(points))
    return float((deep - np.maximum(deep[:, :1], 0.0)).max(initial=0.0))


def _slides(skeleton: Skeleton, made: Recovery) -> float:
    """How fast a heel or ball goes along the floor that stands on it [m/s], at most: as where legs are too short for how far a body was thrown."""
    points = contact_points(skeleton, *forward_kinematics(skeleton, made.roots, made.local))[..., [0, 2]]
    pace = np.linalg.norm(np.diff(points, axis=0), axis=-1) / np.diff(made.times)[:, None]
    return float(np.where(made.contacts[1:] & made.contacts[:-1], pace, 0.0).max(initial=0.0))


def rehearse(struck: Struck) -> None:
    """Strike somebody in a T-pose who stands before a wall, so that what that compiles or loads does not halt a game: he is held by it, and falls, on the floor and on a step."""
    skeleton = struck.skeleton
    pose = Pose(skeleton.offsets[0].copy(), np.tile(np.eye(3), (len(skeleton), 1, 1)))
    state = CharacterState(np.zeros(3), np.zeros(3), pose, np.ones(4, bool), None, 0.0, pose, 1.0 / 60.0)
    wall, step = (SimpleNamespace(centre=centre, size=size, heading=0.0) for centre, size in (((0.0, 1.0, 2.5), (4.0, 2.0, 0.2)), ((0.0, 0.05, 1.0), (4.0, 0.1, 1.0))))
    for speed, around in ((0.5, (wall,)), (4.0, (wall,)), (4.0, (wall, step))):
        strike = Strike((0.0, speed * struck.physique.mass))
        intent = Intent(strike=strike, around=around)
        struck.recovery(state, intent, strike)
        struck.step(struck.enter(state, intent), intent, 1.0 / 60.0)
