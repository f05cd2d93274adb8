"""What the network learns on: moments of recorded takes, in bodies of all proportions, seen by trackers as they are worn.

Moments stream from the memory-mapped database: of each only the last half second is read, so memory stays as it is however
large the database. What is drawn depends on the seed and the batch's number alone: learning goes on where it was cut off, the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...compiled import kernel
from ..database import Database, contacts
from ..ours import seen_from
from ..pose_vector import FORWARD, HEIGHT, JOINTS, LEFTWARD, REFERENCE, SKELETON, WIDTH, YAW_RATE
from ..regression import EXACT, kinematics_kernel
from .bodies import bodies, legs
from .slots import INPUTS, LAGS, SLOTS, views_kernel
from .wearing import Worn, worn

FIRST = np.full(len(SKELETON), -1, np.int64)
FIRST[JOINTS] = 3 * np.arange(len(JOINTS))
FIRST.setflags(write=False)
LEGS = np.array([SKELETON.index(side + name) for side in ("Left", "Right") for name in ("Foot", "Toe")])
_STANDARD = float(legs(SKELETON.offsets))
EVEN = 0.6
"""A subject is drawn as often as the number of its frames to this power: one who walks for an hour does not fill the batches."""


@dataclass(frozen=True, eq=False)
class Batch:
    """inputs: (B, INPUTS) float32. truth: (B, WIDTH) placed poses, seen from the ground. contacts: (B, 4) bool. bodies: (B, J, 3) [m]."""

    inputs: np.ndarray
    truth: np.ndarray
    contacts: np.ndarray
    bodies: np.ndarray


@dataclass(frozen=True, eq=False)
class Moments:
    """Moments of a database to learn on. which: (M,) numbers of frames. first: (M,) where their takes begin. upto: (M,) in (0, 1],
    the share of draws that fall on them or those before. contacts: (N, 4) bool, of every frame of the database: left heel, left
    ball, right heel, right ball."""

    database: Database
    which: np.ndarray
    first: np.ndarray
    upto: np.ndarray
    contacts: np.ndarray

    @staticmethod
    def of(database: Database) -> Moments:
        """All sound moments of a database's takes. ValueError if there is none."""
        which, first, whose = [], [], []
        subjects = sorted({take.subject for take in database.takes})
        for take in database.takes:
            good = take.start + np.flatnonzero(database.sound[take.start:take.stop])
            which.append(good)
            first.append(np.full(len(good), take.start))
            whose.append(np.full(len(good), subjects.index(take.subject)))
        if not sum(map(len, which)):
            raise ValueError(f"{database.path}: has no sound frame to learn from")
        who = np.concatenate(whose)
        upto = np.cumsum(np.bincount(who)[who] ** (EVEN - 1.0))
        return Moments(database, np.concatenate(which).astype(np.int32), np.concatenate(first).astype(np.int32), upto / upto[-1], contacts(database))

    def __len__(self) -> int:
        return len(self.which)

    def draw(self, count: int, seed: int, number: int, wearing: Worn | None = None) -> Batch:
        """A batch: the same for the same seed and number. wearing: which trackers there are; drawn, too, by default."""
        rng = np.random.default_rng([seed, number])
        chosen = np.searchsorted(self.upto, rng.random(count))
        at, first = self.which[chosen].astype(np.int64), self.first[chosen].astype(np.int64)
        people = bodies(count, rng)
        shape = count, len(LAGS), len(SLOTS)
        places, turns, there = np.empty((*shape, 3)), np.empty((*shape, 3, 3)), np.empty(shape[:2], np.bool_)
        truth = np.empty((count, WIDTH))
        moments_kernel(self.database.frames, self.database.sound, at, first, 1.0 / self.database.fps, LAGS, SLOTS, people,
                       legs(people) / _STANDARD, SKELETON.offsets, SKELETON.parents, REFERENCE, FIRST, LEGS, truth, places, turns, there)
        wearing = worn(count, rng) if wearing is None else wearing
        wearing = wearing.among(there)
        places, turns = wearing.spoilt(places, turns)
        heading = wearing.heading - self.database.frames[at, YAW_RATE].astype(float) / self.database.fps
        given = np.concatenate([np.zeros((count, 2)), heading[:, None]], -1)
        inputs, grounds = np.empty((count, INPUTS), np.float32), np.empty((count, 3))
        views_kernel(places, turns, wearing.placed, wearing.turned, people, SKELETON.offsets, LAGS, 1.0 / self.database.fps,
                     given, inputs, grounds)
        return Batch(inputs, seen_from(grounds, truth, np.zeros(3)), self.contacts[at], people)


@kernel(fastmath=EXACT, error_model="numpy")
def moments_kernel(frames, sound, at, first, dt, lags, slots, people, ratio, standard, parents, reference, starts, legs,
                   truth, places, turns, there):
    """Fills truth (B, D), placed with the newest hips at the origin, and the joints `slots` at lags: places (B, L, S, 3),
    turns (B, L, S, 3, 3), there (B, L), whether the take had begun.

    The way goes with the length of legs, `ratio`; and the lowest joint of `legs` stays as high as the feet's size has it.
    """
    count = len(parents)
    positions, orientations = np.empty((count, 3)), np.empty((count, 3, 3))
    axes, scratch, frame = np.empty((count, 3, 3)), np.empty((3, 3, 3)), np.empty(frames.shape[1])
    for b in range(len(at)):
        x, z, heading, done, up = 0.0, 0.0, 0.0, 0, 0.0
        for k in range(len(lags)):
            whole = True
            while done < lags[k]:
                now = at[b] - done
                if now - 1 < first[b] or not sound[now - 1]:
                    whole = False
                    break
                heading -= frames[now, YAW_RATE] * dt
                c, s = math.cos(heading), math.sin(heading)
                forward, left = frames[now, FORWARD] * dt, frames[now, LEFTWARD] * dt
                x -= s * forward + c * left
                z -= c * forward - s * left
                done += 1
            there[b, k] = whole
            if not whole:
                for s in range(len(slots)):
                    places[b, k, s] = 0.0
                    turns[b, k, s] = 0.0
                continue
            for d in range(len(frame)):
                frame[d] = frames[at[b] - done, d]
            frame[LEFTWARD], frame[FORWARD], frame[YAW_RATE] = x * ratio[b], z * ratio[b], heading
            if k == 0:
                kinematics_kernel(frame, 1.0, parents, standard, reference, starts, positions, orientations, axes, scratch)
                lowest = positions[legs[0], 1]
                for j in legs:
                    lowest = min(lowest, positions[j, 1])
                frame[HEIGHT] *= ratio[b]
                kinematics_kernel(frame, 1.0, parents, people[b], reference, starts, positions, orientations, axes, scratch)
                low = positions[legs[0], 1]
                for j in legs:
                    low = min(low, positions[j, 1])
                up = lowest - low
                frame[HEIGHT] += up
                truth[b] = frame
                for j in range(count):
                    positions[j, 1] += up
            else:
                frame[HEIGHT] = frame[HEIGHT] * ratio[b] + up
                kinematics_kernel(frame, 1.0, parents, people[b], reference, starts, positions, orientations, axes, scratch)
            for s in range(len(slots)):
                for i in range(3):
                    places[b, k, s, i] = positions[slots[s], i]
                    for j in range(3):
                        turns[b, k, s, i, j] = orientations[slots[s], i, j]
