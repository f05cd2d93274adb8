"""What our networks see and learn: from the points' last half second to the whole body, seen from the points.

Poses are "placed": frames of the chart with the place and heading of the hips in the stead of their rates. So what
is to be learnt does not depend on where the body was believed to be a frame before, only on its heading.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from ...body import wrap
from ...compiled import kernel
from ..baselines import Adam, Layers, Samples, backward, forward, starting
from ..pose_vector import FORWARD, HEIGHT, JOINTS, LEFTWARD, PITCH, REFERENCE, ROLL, SKELETON, YAW_RATE
from ..regression import EXACT, in_world, kinematics_kernel, on_ground

LAGS = np.array([0, 2, 4, 8, 16, 30])
"""How many frames before the coming one the points are looked at."""
TURNED = 0.08
"""How far off [rad] the heading is taken to be in half of the samples, a standard deviation."""
DISTANCE, ANGLE = 0.05, math.radians(10.0)
"""Errors of a joint's place [m] and of its angle [rad] that are equally bad."""
_HIDDEN = (768, 768)
_RATE = 2e-3
_SIZE = 256  # samples in a batch
_ROUNDS = 14  # how often each sample is seen, as far as
_LEAST, _MOST = 1500, 9000  # batches allow
_JUDGED = 8192
_FIRST = np.full(len(SKELETON), -1, np.int64)
_FIRST[JOINTS] = 3 * np.arange(len(JOINTS))


def placed(frames: np.ndarray, tracks: np.ndarray) -> np.ndarray:
    """Frames (..., D) of the chart at ground tracks (..., 3), in the world: x, z [m] and heading [rad] for their rates."""
    out = np.array(frames, float)
    out[..., LEFTWARD], out[..., FORWARD], out[..., YAW_RATE] = np.moveaxis(np.asarray(tracks), -1, 0)
    return out


def seen_from(ground: np.ndarray, poses: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Placed poses (..., D) that are seen from ground (..., 3) `other`, as seen from `ground`."""
    out = np.array(poses, float)
    there = np.stack([out[..., LEFTWARD], np.zeros(out.shape[:-1]), out[..., FORWARD]], -1)[..., None, :]
    hips = on_ground(in_world(there, other), ground)[..., 0, :]
    out[..., LEFTWARD], out[..., FORWARD] = hips[..., 0], hips[..., 2]
    out[..., YAW_RATE] = wrap(out[..., YAW_RATE] + np.asarray(other)[..., 2] - np.asarray(ground)[..., 2])
    return out


WORLD = np.zeros(3)
"""The ground that the world is seen from."""


def view(points: np.ndarray, heading: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inputs (..., len(LAGS) · n · 3), and the ground (..., 3) they are seen from: below the newest points' middle.

    points: (..., len(LAGS), n, 3) [m] in the world. heading: (...) [rad].
    """
    middle = points[..., 0, :, :].mean(-2)
    ground = np.stack([middle[..., 0], middle[..., 2], heading], -1)
    return on_ground(points, ground[..., None, :]).reshape(*ground.shape[:-1], -1), ground


def draw(samples: Samples, chosen: np.ndarray, rng: np.random.Generator | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Inputs (B, P) and placed poses (B, D), both seen from the points, of chosen samples (B,).

    With an rng, half of the headings are off.
    """
    at, first = samples.which[chosen], samples.first[chosen]
    heading = samples.tracks[at - 1, 2]
    if rng is not None:
        heading = heading + rng.normal(0.0, TURNED, len(at)) * (rng.random(len(at)) < 0.5)
    inputs, ground = view(samples.points[np.maximum(at[:, None] - LAGS, first[:, None])], heading)
    return inputs, seen_from(ground, placed(samples.frames[at], samples.tracks[at]), WORLD)


@kernel(fastmath=EXACT, error_model="numpy")
def misfit_kernel(found, truth, parents, offsets, reference, first, joints, distance, angle, slopes):
    """The mean loss of placed poses (B, D); fills its derivatives (B, D) by `found`.

    Forces pull the joints to where they should be; they and their moments are handed on towards the hips.
    """
    batch, size = found.shape
    count, far = len(parents), size - 6
    positions, wanted, axes = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    orientations, scratch = np.empty((count, 3, 3)), np.empty((3, 3, 3))
    force, moment, here = np.empty((count, 3)), np.empty((count, 3)), np.empty(3)
    near, straight = 1.0 / (distance * distance * len(joints)), 1.0 / (angle * angle * len(joints))
    total = 0.0
    for b in range(batch):
        kinematics_kernel(truth[b], 1.0, parents, offsets, reference, first, wanted, orientations, axes, scratch)
        kinematics_kernel(found[b], 1.0, parents, offsets, reference, first, positions, orientations, axes, scratch)
        slope = slopes[b]
        slope[:] = 0.0
        for d in range(size):
            if d < far or d == PITCH or d == ROLL:
                error = found[b, d] - truth[b, d]
                slope[d] = straight * error
                total += 0.5 * straight * error * error
        force[:], moment[:] = 0.0, 0.0  # moments about the origin
        for j in joints:
            for i in range(3):
                error = positions[j, i] - wanted[j, i]
                force[j, i] = near * error
                total += 0.5 * near * error * error
            cross_kernel(positions[j], force[j], moment[j])
        handed_on_kernel(parents, first, positions, axes, force, moment, here, slope)
        for d in range(size):
            slope[d] /= batch
    return total / batch


@kernel(fastmath=EXACT, error_model="numpy")
def handed_on_kernel(parents, first, positions, axes, force, moment, here, slope):
    """Adds to slope (D,) what forces (J, 3) on joints and their moments (J, 3) about the origin, handed on towards the hips, do to a placed pose."""
    for j in range(len(parents) - 1, -1, -1):
        p = parents[j]
        cross_kernel(positions[j], force[j], here)
        for i in range(3):
            here[i] = moment[j, i] - here[i]
        if p < 0:
            slope[LEFTWARD] += force[j, 0]
            slope[HEIGHT] += force[j, 1]
            slope[FORWARD] += force[j, 2]
        else:
            for i in range(3):
                force[p, i] += force[j, i]
                moment[p, i] += moment[j, i]
        if p < 0 or first[j] >= 0:
            for k in range(3):
                column = first[j] + k
                if p < 0:
                    column = PITCH if k == 0 else YAW_RATE if k == 1 else ROLL
                for i in range(3):
                    slope[column] += axes[j, i, k] * here[i]


@kernel(fastmath=EXACT, error_model="numpy")
def cross_kernel(a, b, out):
    """Fills out (3,) with a × b."""
    out[0], out[1], out[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def misfit(found: np.ndarray, truth: np.ndarray) -> tuple[float, np.ndarray]:
    """How far placed poses (B, D) are from the true ones, and the derivatives (B, D) of that.

    Half the mean over samples and joints of the squares of distances over `DISTANCE` and angles over `ANGLE`: what
    is measured in the end, and not how far off each number is in its own spread.
    """
    found, truth = np.ascontiguousarray(found, float), np.ascontiguousarray(truth, float)
    slopes = np.empty(found.shape)
    return misfit_kernel(found, truth, SKELETON.parents, SKELETON.offsets, REFERENCE, _FIRST, JOINTS, DISTANCE, ANGLE,
                         slopes), slopes


@dataclass(frozen=True, eq=False)
class Networks:
    """Networks that differ by their seeds, and of which the mean is taken. errors: (D, D) as in `Layers`, of the mean."""

    members: tuple[Layers, ...]
    errors: np.ndarray

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Placed poses (..., D) for inputs (..., P)."""
        inputs = np.ascontiguousarray(inputs, np.float32)
        if inputs.ndim == 1:
            return np.asarray(sum(_predicted(member, inputs) for member in self.members)) / len(self.members)
        return np.asarray(sum(member.predict(inputs) for member in self.members)) / len(self.members)

    def save(self, folder: Path) -> None:
        """Write them into a new folder."""
        folder.mkdir()
        for number, member in enumerate(self.members):
            replace(member, errors=self.errors).save(folder / f"{number}.npz")

    @staticmethod
    def load(folder: Path) -> Networks:
        """Read what `save` wrote. OSError or ValueError for anything else."""
        members = tuple(Layers.load(path) for path in sorted(folder.iterdir()))
        if not members:
            raise ValueError(f"{folder}: has no networks")
        return Networks(members, members[0].errors)


def _predicted(layers, x):
    """`Layers.predict` for one input (P,), several times as fast."""
    x, last = (x - layers.ins[0]) / layers.ins[1], len(layers.weights) - 1
    for number, (weights, biases) in enumerate(zip(layers.weights, layers.biases, strict=True)):
        x = layer_kernel(x, weights, biases, number < last)
    return x * layers.outs[1] + layers.outs[0]


@kernel(fastmath=EXACT, error_model="numpy")
def layer_kernel(x, weights, biases, rectified):
    """One layer of a network (outputs,). Half of what a layer sees is zero, and their weights are not even read."""
    out = biases.copy()
    for i in range(len(x)):
        if x[i] != 0.0:
            for j in range(len(out)):
                out[j] += x[i] * weights[i, j]
    if rectified:
        for j in range(len(out)):
            out[j] = max(out[j], np.float32(0.0))
    return out


def learn(samples: Samples, seeds: int = 2, batches: int | None = None, hidden: tuple[int, ...] = _HIDDEN,
          progress: Callable[[int, int], None] | None = None) -> Networks:
    """Networks learnt by Adam, the same from the same samples. batches: of each; by default as many as make sense.

    progress: called with how many batches are done, and of how many. The errors are those on what was learnt: as a
    shape for what the solver may change, they did better on takes not seen than the errors on takes not learnt.
    """
    if batches is None:
        batches = int(np.clip(_ROUNDS * len(samples) // _SIZE, _LEAST, _MOST))

    def told(seed, batch):
        if progress is not None:
            progress(seed * batches + batch, seeds * batches)
    members = tuple(_learn(samples, seed, batches, hidden, partial(told, seed)) for seed in range(seeds))
    chosen = np.random.default_rng(seeds).permutation(len(samples))[:_JUDGED]
    inputs, truth = draw(samples, chosen)
    errors = Networks(members, np.empty(0)).predict(inputs) - truth
    values, vectors = np.linalg.eigh(errors.T @ errors / len(errors))
    return Networks(members, np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T)


def _learn(samples, seed, batches, hidden, progress):
    rng = np.random.default_rng(seed)
    ins, outs = (np.stack([a.mean(0), np.maximum(a.std(0), 1e-3)]).astype(np.float32)
                 for a in draw(samples, rng.integers(len(samples), size=_JUDGED), rng))
    values = starting((len(ins[0]), *hidden, len(outs[0])), rng)
    count, adam = len(hidden) + 1, Adam(values, batches, _RATE)
    for batch in range(batches):
        inputs, truth = draw(samples, rng.integers(len(samples), size=_SIZE), rng)
        found, seen, own = forward(values[:count], values[count:], ((inputs - ins[0]) / ins[1]).astype(np.float32))
        _, slopes = misfit(found * outs[1] + outs[0], truth)
        adam.step(backward(values[:count], seen, own, (slopes * outs[1]).astype(np.float32)))
        progress(batch + 1)
    return Layers(tuple(values[:count]), tuple(values[count:]), ins, outs, np.eye(len(outs[0])))
