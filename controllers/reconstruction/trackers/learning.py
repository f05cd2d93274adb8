"""Learning the network: batches that stream from a database, Adam, and a checkpoint now and then from which it goes on, the same.

The loss is that of kinematics on each sample's own body, distances and turns (the smooth form of Huber 1964: squares count a pose that can't be told
so much that those that can be told come out worse), and the cross-entropy of contacts. What is used in the end is the running mean of the
weights (Polyak & Juditsky 1992), so that it can be taken at any time. scripts/build/trackers_torch.py learns the same on a graphics card.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...compiled import kernel
from ...files import ArraysError, arrays
from ..baselines import backward, forward, starting
from ..ours import ANGLE, DISTANCE, cross_kernel, handed_on_kernel
from ..pose_vector import ANGLES, JOINTS, PITCH, REFERENCE, ROLL, SKELETON, WIDTH
from ..regression import EXACT, kinematics_kernel
from .layers import shares
from .network import OUTPUTS, Network
from .samples import FIRST, Batch, Moments
from .slots import INPUTS, PLACES
from .wearing import exactly, members

HIDDEN = (1536, 1536, 1536)
ADDED, DROPPED = True, 0.05
"""Whether layers between the first and the last add to what they are given, and how much of hidden layers is left out at a time."""
NEAR, STRAIGHT = 0.01, math.radians(2.0)
"""Distances [m] and turns [rad] count evenly from about here on, below by their squares."""
SIZE = 512
"""Samples in a batch."""
RATE = 1.2e-3
WARMING = 300
"""Batches in which the rate comes up, or a tenth of them all if they are few; then it falls along a cosine."""
SAYING = 0.1
"""How much the four contacts weigh in the loss."""
MEAN = 0.999
"""What is left of the weights' mean a batch later."""
UNSURE = 0.5
"""How much of what the errors of a pose's numbers have to do with each other is not believed of other people (shrinkage, Ledoit & Wolf 2004)."""
KINDS = ("Hips Head LeftHand RightHand LeftFoot RightFoot", "LeftHand RightHand LeftFoot RightFoot", "Head LeftHand RightHand",
         "Hips LeftHand RightHand LeftFoot RightFoot", "LeftHand LeftFoot RightFoot", "RightHand LeftFoot RightFoot",
         "LeftHand RightFoot", "RightHand LeftFoot", "Head LeftHand RightHand LeftFoot RightFoot",
         "Hips Spine2 Head LeftHand RightHand LeftFoot RightFoot", " ".join(PLACES))
"""Trackers for which errors are told, each without and with turns."""
_JUDGED = 4096
_STANDARD = 1_000_003  # number of the batch that inputs and outputs are scaled by
_RARE = 5e-4  # of recorded rotation vectors that lie beyond the range on either side
_WIDER = math.radians(1.0)


def loss(found: np.ndarray, batch: Batch) -> tuple[float, np.ndarray]:
    """The mean loss of outputs (B, OUTPUTS), poses in metres and radians and contacts' logits, and its derivatives (B, OUTPUTS)."""
    poses = np.ascontiguousarray(found[:, :WIDTH], float)
    slopes = np.empty(found.shape)
    own = np.empty(poses.shape)
    total = misfits_kernel(poses, batch.truth, SKELETON.parents, batch.bodies, REFERENCE, FIRST, JOINTS, DISTANCE, ANGLE, NEAR, STRAIGHT, own)
    slopes[:, :WIDTH] = own
    logits, standing = np.asarray(found[:, WIDTH:], float), batch.contacts
    total += SAYING * float(np.mean(np.logaddexp(0.0, np.where(standing, -logits, logits))))
    slopes[:, WIDTH:] = SAYING / logits.size * (1.0 / (1.0 + np.exp(-np.clip(logits, -30.0, 30.0))) - standing)
    return total, slopes


@kernel(fastmath=EXACT, error_model="numpy")
def misfits_kernel(found, truth, parents, bodies, reference, first, joints, distance, angle, near, straight, slopes):
    """The mean loss of placed poses (B, D) on bodies (B, J, 3); fills its derivatives (B, D) by `found`.

    Of each joint's distance and of each rotation vector's difference √(d² + near²) − near counts, over `distance` and `angle`.
    """
    batch, size = found.shape
    count, far = len(parents), size - 6
    positions, wanted, axes = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    orientations, scratch = np.empty((count, 3, 3)), np.empty((3, 3, 3))
    force, moment, here = np.empty((count, 3)), np.empty((count, 3)), np.empty(3)
    total, share = 0.0, 1.0 / len(joints)
    for b in range(batch):
        kinematics_kernel(truth[b], 1.0, parents, bodies[b], reference, first, wanted, orientations, axes, scratch)
        kinematics_kernel(found[b], 1.0, parents, bodies[b], reference, first, positions, orientations, axes, scratch)
        slope = slopes[b]
        slope[:] = 0.0
        for at in range(0, far + 1, 3):  # the last one's are the hips' pitch and roll
            x, y = (at, at + 1) if at < far else (PITCH, ROLL)
            u, v, w = found[b, x] - truth[b, x], found[b, y] - truth[b, y], 0.0
            if at < far:
                w = found[b, at + 2] - truth[b, at + 2]
            length = math.sqrt(u * u + v * v + w * w + straight * straight)
            total += share * (length - straight) / angle
            slope[x], slope[y] = share * u / (length * angle), share * v / (length * angle)
            if at < far:
                slope[at + 2] = share * w / (length * angle)
        force[:], moment[:] = 0.0, 0.0  # moments about the origin
        for j in joints:
            square = near * near
            for i in range(3):
                square += (positions[j, i] - wanted[j, i]) ** 2
            length = math.sqrt(square)
            total += share * (length - near) / distance
            for i in range(3):
                force[j, i] = share * (positions[j, i] - wanted[j, i]) / (length * distance)
            cross_kernel(positions[j], force[j], moment[j])
        handed_on_kernel(parents, first, positions, axes, force, moment, here, slope)
        for d in range(size):
            slope[d] /= batch
    return total / batch


@kernel(fastmath=EXACT, error_model="numpy")
def adam_kernel(value, slope, first, second, share, scale, left):
    """Adam (Kingma & Ba 2015) on flat arrays, in one sweep; `left` the fourth, the running mean, is told apart."""
    for i in range(len(value)):
        first[i] += np.float32(0.1) * (slope[i] - first[i])
        second[i] += np.float32(0.001) * (slope[i] * slope[i] - second[i])
        value[i] -= share * first[i] / (math.sqrt(second[i] * scale) + np.float32(1e-8))
        left[i] += np.float32(1.0 - MEAN) * (value[i] - left[i])


class Learner:
    """A network while it is learnt. moments: what from. batches: in all; the rate falls to nothing until then.

    seed: of all that is drawn. hidden: the widths of the layers between, as wide as each other.
    """

    rate, of, added, dropped = RATE, "", ADDED, DROPPED
    """Of learning; what a checkpoint must be of, beside seed, size and widths; see `ADDED`."""

    def __init__(self, moments: Moments, batches: int, seed: int = 0, hidden: tuple[int, ...] = HIDDEN, size: int = SIZE):
        self.moments, self.batches, self.seed, self.size, self.batch = moments, batches, seed, size, 0
        self.count = len(hidden) + 1
        self.values = starting((INPUTS, *hidden, OUTPUTS), np.random.default_rng([seed, 0, 1]))
        self.first, self.second = ([np.zeros_like(value) for value in self.values] for _ in range(2))
        self.means = [value.copy() for value in self.values]
        truth = moments.draw(_JUDGED, seed, _STANDARD).truth
        self.outs = np.stack([truth.mean(0), np.maximum(truth.std(0), 1e-3)])

    def step(self) -> float:
        """Learn from one batch more. Returns its loss."""
        batch = self.moments.draw(self.size, self.seed, self.batch)
        weights, biases = self.values[:self.count], self.values[self.count:]
        kept = shares((self.size, len(biases[0])), self.count - 1, self.dropped, np.random.default_rng([self.seed, self.batch, 2]))
        found, seen, own = forward(weights, biases, batch.inputs, self.added, kept)
        out = np.asarray(found, float)
        out[:, :WIDTH] = out[:, :WIDTH] * self.outs[1] + self.outs[0]
        total, slopes = loss(out, batch)
        slopes[:, :WIDTH] *= self.outs[1]
        rate = self.rate * self.share()
        self.batch += 1
        share, scale = np.float32(rate / (1.0 - 0.9 ** self.batch)), np.float32(1.0 / (1.0 - 0.999 ** self.batch))
        slopes = backward(weights, seen, own, slopes.astype(np.float32), self.added, kept)
        for value, slope, first, second, mean in zip(self.values, slopes, self.first, self.second, self.means, strict=True):
            adam_kernel(value.reshape(-1), np.ascontiguousarray(slope).reshape(-1), first.reshape(-1), second.reshape(-1), share, scale, mean.reshape(-1))
        return total

    def share(self) -> float:
        """What the rate is now, as a share of what it is at most."""
        return min(1.0, (self.batch + 1) / min(WARMING, 0.1 * self.batches)) * 0.5 * (1.0 + math.cos(math.pi * min(self.batch / self.batches, 1.0)))

    def learn(self, path: Path, every: int, progress: Callable[[int, int, float], None] | None = None) -> None:
        """Go on to the last batch, with a checkpoint at path after `every` batches and at the end.

        progress: called with the batches done, how many there are, and the mean loss since the last call.
        """
        losses: list[float] = []
        while self.batch < self.batches:
            losses.append(self.step())
            if (self.batch % 50 == 0 or self.batch == self.batches) and progress is not None:
                progress(self.batch, self.batches, float(np.mean(losses)))
                losses.clear()
            if self.batch % every == 0 or self.batch == self.batches:
                self.save(path)

    def save(self, path: Path) -> None:
        """Write a checkpoint; it is there whole or not at all."""
        arrays = {f"{kind}{i}": value for kind in ("values", "first", "second", "means") for i, value in enumerate(getattr(self, kind))}
        own = path.with_name(f"{path.name}.{os.getpid()}.part")
        with own.open("wb") as file:
            np.savez(file, batch=self.batch, seed=self.seed, of=self.of, size=self.size, outs=self.outs, **arrays)
        os.replace(own, path)

    def resume(self, path: Path) -> None:
        """Go on from a checkpoint. ArraysError if it is of another seed, batch or network, or none."""
        file = {"of": np.array("")} | arrays(path, "checkpoint", {}, "")
        there = [file[f"values{i}"].shape for i in range(sum(name.startswith("values") for name in file))]
        if not {"seed", "size", "batch", "outs"} <= set(file) or (int(file["seed"]), int(file["size"]), str(file["of"])) != (self.seed, self.size, self.of) or there != [value.shape for value in self.values]:
            raise ArraysError(f"{path}: is of another seed, batch size or width, or of other motion; move it away to begin anew")
        for kind in ("values", "first", "second", "means"):
            setattr(self, kind, [file[f"{kind}{i}"] for i in range(len(there))])
        self.batch, self.outs = int(file["batch"]), file["outs"]

    def take(self, path: Path) -> None:
        """What was learnt elsewhere (scripts/build/trackers_torch.py) in the place of what was learnt here. ArraysError for a file of anything else."""
        file = arrays(path, "file of weights", {}, "")
        names = [f"{kind}{i}" for kind in ("weights", "biases") for i in range(self.count)]
        if not {"outs", "learnt", *names} <= set(file) or [file[name].shape for name in names] != [value.shape for value in self.values]:
            raise ArraysError(f"{path}: is of other widths, or has no weights")
        self.means, self.outs, self.batch = [file[name].astype(np.float32) for name in names], file["outs"].astype(float), int(file["learnt"]) // self.size

    def network(self) -> Network:
        """The network as it is now: the weights' mean without its first steps, and how far off it is with some trackers."""
        used = self.used()
        bare = Network(tuple(used[:self.count]), tuple(used[self.count:]), self.outs, np.empty(0), np.empty(0), np.empty(0),
                       *self.range(), self.batch, self.added)
        return judged(bare, self.moments, self.seed, self.believed)

    def used(self) -> list[np.ndarray]:
        """Weights, then biases, as a network has them."""
        return self.means

    def believed(self, covariance: np.ndarray, placed: np.ndarray, turned: np.ndarray) -> np.ndarray:
        """What is believed of errors (WIDTH, WIDTH) with trackers placed and turned (S,) bool that had this covariance on what was learnt from."""
        return covariance

    def range(self) -> tuple[np.ndarray, np.ndarray]:
        """The range of joints' rotation vectors (ANGLES,) each [rad] in what is learnt from."""
        frames = self.moments.database.frames[np.sort(self.moments.which[::max(1, len(self.moments) // 200_000)])]
        low, high = np.quantile(frames[:, :ANGLES].astype(float), (_RARE, 1.0 - _RARE), axis=0)
        return low - _WIDER, high + _WIDER


def judged(network: Network, moments: Moments, seed: int = 0, believed: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray] | None = None) -> Network:
    """The network with how far off it is on moments, with the trackers of `KINDS`. believed: see `Learner`."""
    kinds, factors = [], []
    for text in KINDS:
        placed = members(text)
        for turned in (np.zeros_like(placed), placed):
            batch = moments.draw(_JUDGED, seed, _STANDARD + 1, exactly(_JUDGED, placed, turned))
            errors = network.predict(batch.inputs)[0] - batch.truth
            covariance = shrunk(errors.T @ errors / len(errors))
            kinds.append(np.concatenate([placed, turned]))
            factors.append(root(covariance if believed is None else believed(covariance, placed, turned)))
    return replace(network, kinds=np.stack(kinds), factors=np.stack(factors), rests=np.full((len(kinds), WIDTH), 1e-10))


def shrunk(covariance: np.ndarray) -> np.ndarray:
    """A covariance (D, D) as it is believed of others: variances as they are, the rest `UNSURE`."""
    return (1.0 - UNSURE) * covariance + UNSURE * np.diag(np.diagonal(covariance))


def root(covariance: np.ndarray) -> np.ndarray:
    """Rows (D, D) whose squares sum up to a covariance (D, D)."""
    values, vectors = np.linalg.eigh(covariance)
    return np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
