"""The network as a method: frame by frame, what trackers say becomes the most probable pose on the performer's own skeleton.

The network needs no past and is told what is missing, so a beginning and lost trackers are nothing special. What it was off by in the
last frame, as the solve found, is expected again, fading (as in `ours`). Soles that it says stand stay where they came down, by the
legs alone and in what is shown alone: who is solved with them is carried along by feet that came down in a wrong place, more and more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ...body import Pose, Skeleton, forward_kinematics
from ...contract import but
from ..control_points import ControlPoints
from ..footing import Feet, Footing
from ..ours import Motion, noise, placed
from ..pose_vector import ANGLES, REFERENCE, SKELETON, WIDTH, YAW_RATE, decode
from ..regression import FAR, FLOOR, SPAN, seen_kernel
from .ground import GROUND, goals_kernel, less, nothing, shown_as
from .network import Network
from .samples import FIRST
from .slots import INPUTS, LAGS, SLOTS, view_kernel
from .solver import fit_kernel
from .steadying import RECENT, begun, calmed, quiet, smoothed

FADING = 0.9
"""What is left of the network's error a frame later."""
LOOSENING = 30.0
"""How much larger the network's errors may be than on recordings: trackers are met."""
EXACT_PLACE, EXACT_TURN = 0.01, np.radians(2.0)
"""How exactly trackers' places [m] and turns [rad] are met, standard deviations."""
BLUR = 1.0
"""Noise on points, over this, makes them met so much less exactly."""
RESTING = 0.95
"""What is left of the body's velocity a frame later where no tracker is seen."""
STEPS, TOLERANCE = 6, 1e-4
"""Of the solver: steps at most, and the share of the energy below which a gain ends them."""
BEGINNINGS = 8
"""From so many headings the first frame is tried where no tracker turns."""
SURE = np.radians(10.0)
"""A first frame that turns by more than this when it is seen from its own heading hardly agrees with itself."""
_WORLD, _NONE = np.zeros(3), np.zeros(4)


@dataclass(frozen=True, eq=False)
class Remembered:
    """pose: (D,) placed in the world, as it was solved; before: (D,) the one before. off: (D,) what the network was off by.

    places (SPAN, S, 3) [m], turns (SPAN, S, 3, 3): what slots said in the world, newest first; NaN where nothing. turning: (n,) bool,
    which trackers have told a turn. recent: (T, n, 3) raw points. points, shown: filtered. standing: (4,) how probable it is that heels and balls
    stand. feet: where they do. expected: the pose that the network expects, placed in the world and filtered; known: what slots told then.
    """

    pose: np.ndarray
    before: np.ndarray
    off: np.ndarray
    places: np.ndarray
    turns: np.ndarray
    turning: np.ndarray
    recent: np.ndarray
    points: Motion | None
    shown: Motion
    standing: np.ndarray
    feet: Feet
    expected: Motion | None = None
    known: bytes = b""


@dataclass(frozen=True, eq=False)
class Trackers:
    """The method for some trackers. controls: the joints that they were calibrated to; those that have no slot, and points beside a joint
    that don't turn, still pull at the body. dt: [s] between frames. skeleton: the performer's, with the chart's joints.
    steady: whether noise on points is filtered, and poses a little. ValueError for another skeleton.
    """

    network: Network
    controls: ControlPoints
    dt: float = 1 / 60
    skeleton: Skeleton = SKELETON
    steady: bool = True
    hears_turns = True

    def __post_init__(self):
        if self.skeleton.names != SKELETON.names or not np.array_equal(self.skeleton.parents, SKELETON.parents):
            raise ValueError("the performer's skeleton must have the chart's joints")

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Remembered:
        """The memory after known frames (T, D) of the chart with ground tracks (T, 3), the newest last; one alone is no past."""
        frames = placed(np.asarray(frames, float)[-SPAN:], np.asarray(tracks, float)[-SPAN:])[::-1]
        places, turns = nothing(len(SLOTS))
        if len(frames) > 1:
            for k, frame in enumerate(frames):
                positions, orientations = self._joints(frame)
                places[k], turns[k] = positions[SLOTS], orientations[SLOTS]
            for absent in np.setdiff1d(np.arange(len(SLOTS)), self._slots[self._slots >= 0]):
                places[:, absent], turns[:, absent] = np.nan, np.nan
        pose, before = frames[0], frames[min(1, len(frames) - 1)]
        return Remembered(pose, before, np.zeros(WIDTH), places, turns, np.zeros(len(self.controls), bool),
                          np.full((RECENT, len(self.controls), 3), np.nan), None, begun(pose, less(pose, before)), _NONE,
                          Feet.none())

    def step(self, memory: Remembered, points: np.ndarray, turns: np.ndarray | None = None) -> tuple[Remembered, Pose]:
        """The pose a frame later, for trackers at points (n, 3) [m] in the world with turns (n, 3, 3), NaN where not known."""
        points = np.array(points, float)
        points[~(np.abs(points) < FAR).all(-1)] = np.nan
        count = len(self.controls)
        turns = np.full((count, 3, 3), np.nan) if turns is None else np.asarray(turns, float)
        recent = np.concatenate([memory.recent[1:], points[None]])
        if not self.steady:
            after = but(self._followed(memory, points, turns, 0.0), recent=recent)
            return self._planted(after, after.pose, points)
        filtered, points, level = quiet(memory.points, recent, points, self.dt)
        after = self._followed(memory, points, turns, BLUR * level)
        shown = smoothed(memory.shown, after.pose, level, self.dt)
        return self._planted(but(after, recent=recent, points=filtered, shown=shown), shown.place, points)

    def find(self, points: np.ndarray, velocities: np.ndarray | None = None, turns: np.ndarray | None = None
             ) -> tuple[np.ndarray, np.ndarray]:
        """See `following.Beginning`: one frame and its ground track, with turns or without; two, where velocities are known.

        Where none turns the body may face anywhere: it is tried facing `BEGINNINGS` ways, and what agrees best is taken.
        """
        if not np.isfinite(points).all(-1).any():
            raise ValueError("no point is seen")
        points, count = np.asarray(points, float), len(self.controls)
        turns = np.full((count, 3, 3), np.nan) if turns is None else np.asarray(turns, float)
        still = np.zeros(WIDTH)
        best, least = still, np.inf
        for heading in 2.0 * np.pi / BEGINNINGS * np.arange(BEGINNINGS):
            pose = still.copy()
            pose[YAW_RATE] = heading
            cost = np.inf
            for _ in range(2):
                memory = self.begin(pose[None], pose[None, GROUND])
                after, cost = self._solved(self._told(memory, points, turns), points, turns)
                turned = less(after.pose, pose)[YAW_RATE]
                pose = after.pose
                cost += (turned / SURE) ** 2
            if cost < least:
                best, least = pose, cost
        poses = best[None]
        if velocities is not None and np.isfinite(velocities).all(-1).any():
            earlier = points - np.where(np.isfinite(velocities), velocities, np.nan) * self.dt
            memory = self.begin(poses, poses[:, GROUND])
            poses = np.stack([self._solved(self._told(memory, earlier, turns), earlier, turns)[0].pose, best])
        frames, tracks = poses.copy(), poses[:, GROUND]
        frames[:, GROUND] = 0.0
        return frames, tracks

    def energy(self, memory: Remembered) -> float:
        """How ill the last half second's places and turns and the pose they make agree with each other, whatever came before."""
        known = self._slots >= 0
        points, turns = np.full((len(known), 3), np.nan), np.full((len(known), 3, 3), np.nan)
        points[known], turns[known] = memory.places[0, self._slots[known]], memory.turns[0, self._slots[known]]
        points[self.controls.offsets.any(-1)] = np.nan
        return self._solved(but(memory, off=np.zeros(WIDTH), expected=None), points, turns, BLUR * noise(memory.recent) if self.steady else 0.0)[1]

    def exchanged(self, memory: Remembered, i: int, j: int) -> Remembered:
        """The memory in which two trackers had each other's number all the time; the same one where they have no slots."""
        a, b = self._slots[[i, j]]
        if min(a, b) < 0:
            return memory
        slots, order = np.arange(len(SLOTS)), np.arange(len(self.controls))
        slots[[a, b]], order[[i, j]] = (b, a), (j, i)
        points = memory.points and but(memory.points, place=memory.points.place[order], change=memory.points.change[order])
        return but(memory, places=memory.places[:, slots], turns=memory.turns[:, slots], turning=memory.turning[order],
                       recent=memory.recent[:, order], points=points, off=np.zeros(WIDTH), expected=None)

    def _followed(self, memory, points, turns, blur):
        """The memory a frame later, but for what is shown."""
        placed = np.isfinite(points).all(-1).any()
        coasting = memory.pose + RESTING * less(memory.pose, memory.before)
        if not (placed or np.isfinite(turns).all((-1, -2)).any()):
            coasting[:ANGLES] = np.clip(coasting[:ANGLES], self.network.lower, self.network.upper)  # no knee swings on beyond straight
            return but(self._told(memory, points, turns), pose=coasting, before=memory.pose, standing=_NONE)
        after = self._solved(self._told(memory, points, turns), points, turns, blur)[0]
        if not placed:  # turns alone don't tell where one goes
            after.pose[GROUND[:2]] = coasting[GROUND[:2]]
        return after

    def _told(self, memory, points, turns):
        """The memory with what trackers say now."""
        place, turn = np.full((len(SLOTS), 3), np.nan), np.full((len(SLOTS), 3, 3), np.nan)
        known = np.isfinite(turns).all((-1, -2))
        place[self._slots[self._plain]] = points[self._plain]
        turning = known & (self._slots >= 0)
        turn[self._slots[turning]] = turns[turning]
        last = None
        for n in self._beside:
            if not known[n] and last is None:
                last = self._joints(memory.pose)[1]
            held = turns[n] if known[n] or last is None else last[self.controls.joints[n]]
            place[self._slots[n]] = points[n] - held @ self.controls.offsets[n]
        return but(memory, places=np.concatenate([place[None], memory.places[:-1]]),
                       turns=np.concatenate([turn[None], memory.turns[:-1]]), turning=memory.turning | known)

    def _solved(self, memory, points, turns, blur=0.0):
        """The memory with the pose of its newest places, and the energy of that. blur: [m] noise that is left on points."""
        places, spun = np.ascontiguousarray(memory.places[LAGS]), np.ascontiguousarray(memory.turns[LAGS])
        here = np.asarray(np.isfinite(places).all(-1))
        turned = np.asarray(np.isfinite(spun).all((-1, -2)) & self._hearing(memory.turning))
        inputs, ground = np.empty(INPUTS, np.float32), np.empty(3)
        view_kernel(places, spun, here, turned, self.skeleton.offsets, SKELETON.offsets, LAGS, self.dt, memory.pose[GROUND], inputs, ground)
        expected, standing = self.network.predict(inputs)
        known = here[0].tobytes() + turned[0].tobytes()
        calm = None
        if self.steady:
            calm, expected = calmed(memory.expected, known == memory.known, expected, ground, self.dt)
        mean = expected + FADING * memory.off
        goals, spun, hold, keep = np.empty_like(points), np.empty_like(turns), np.empty(len(points)), np.empty(len(points))
        goals_kernel(points, turns, ground, 1.0 / (EXACT_PLACE ** 2 + blur ** 2), EXACT_TURN ** -2.0, goals, spun, hold, keep)
        frame, pose = np.empty(WIDTH), np.empty(WIDTH)
        parents, offsets, joints, beside = self._body
        energy = fit_kernel(mean, self._precision(here[0].tobytes(), turned[0].tobytes()), mean, self.network.lower, self.network.upper, parents, offsets,
                            REFERENCE, FIRST, joints, beside, goals, hold, spun, keep, STEPS, TOLERANCE, frame,
                            np.empty((len(SKELETON), 3)), np.empty((len(SKELETON), 3, 3)))
        seen_kernel(frame, ground, _WORLD, pose)
        return but(memory, pose=pose, before=memory.pose, off=less(frame, expected), standing=standing, expected=calm, known=known), energy

    def _planted(self, memory, shown, points):
        """The memory with feet as they stand, and the pose to show. shown: (D,) the placed pose without. points: (n, 3) of trackers, NaN where not seen."""
        told = self._footing.told(self.controls.joints, points)
        feet, pose = self._footing.step(memory.feet, shown_as(shown), memory.standing, told, self.dt)
        return but(memory, feet=feet), pose

    def _hearing(self, turning):
        """Which slots (S,) have a tracker that turns."""
        out = np.zeros(len(SLOTS), bool)
        out[self._slots[(self._slots >= 0) & turning]] = True
        return out

    def _joints(self, pose):
        """Positions (J, 3) and orientations (J, 3, 3) of a placed pose (D,)."""
        return forward_kinematics(self.skeleton, *decode(pose, pose[GROUND]))

    @cached_property
    def _slots(self) -> np.ndarray:
        """The slot of each tracker, -1 where it has none or another tracker has it."""
        found = np.full(len(self.controls), -1)
        for n, joint in enumerate(self.controls.joints):
            slot = np.flatnonzero(SLOTS == joint)
            if len(slot) and slot[0] not in found:
                found[n] = slot[0]
        return found

    @cached_property
    def _plain(self) -> np.ndarray:
        """The trackers that have a slot and are in their joints."""
        return np.flatnonzero((self._slots >= 0) & ~self.controls.offsets.any(-1))

    @cached_property
    def _beside(self) -> list[int]:
        """The trackers that have a slot and are beside their joints."""
        return np.flatnonzero((self._slots >= 0) & self.controls.offsets.any(-1)).tolist()

    @cached_property
    def _body(self):
        """Parents, offsets; joints and offsets of trackers."""
        return self.skeleton.parents, self.skeleton.offsets, self.controls.joints, self.controls.offsets

    @cached_property
    def _footing(self) -> Footing:
        """Who plants feet."""
        return Footing(self.skeleton)

    @cached_property
    def _precision(self) -> Callable[[bytes, bytes], np.ndarray]:
        """The precision (D, D) of what is believed, by which slots are placed and turned."""
        @lru_cache(256)
        def made(placed, turned):
            covariance = self.network.spread(np.frombuffer(placed, bool), np.frombuffer(turned, bool))
            floor = FLOOR.copy()
            floor[GROUND] = 0.002, 0.002, np.radians(0.3)
            return np.linalg.inv(LOOSENING * (covariance + np.diag(floor ** 2)))
        return made
