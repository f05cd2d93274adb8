"""What tracking is measured on: recorded motion as the model can take it, films of it from four sides, and errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.ndimage import uniform_filter
from scipy.spatial.transform import Rotation

from gambol.controllers.mocap import load, retarget
from gambol.controllers.tracking.cameras import Lens, ring
from gambol.controllers.tracking.silhouettes import Surface, contour_of, rendered, skinned
from gambol.controllers.tracking.twists import Chain, Configuration, fitted, local_turns, posed
from gambol.game.meshes import surface_of

RATE = 60.0
CLIPS = {"run 16_35": ("cmu/16/16_35.amc", "all"), "run 16_55": ("cmu/16/16_55.amc", "all"), "squats 14_06": ("cmu/14/14_06.amc", "deepest"),
         "cartwheel 49_06": ("cmu/49/49_06.amc", "tilted"), "cartwheel 49_08": ("cmu/49/49_08.amc", "tilted")}
"""Which recordings, and which part of each: all of it, round the deepest crouch, or round the moment upside-down."""


@dataclass(frozen=True, eq=False)
class Film:
    """A clip of T frames as the chain can take it, and cameras round it."""

    name: str
    surface: Surface
    lenses: tuple[Lens, ...]
    truth: list[Configuration]

    @property
    def chain(self) -> Chain:
        return self.surface.chain

    def masks(self, t: int) -> list[np.ndarray]:
        """The perfect silhouettes of a frame, by the finest mesh."""
        positions, orientations, _ = posed(self.chain, self.truth[t])
        vertices = skinned(self.surface, positions, orientations)
        return [rendered(lens, vertices, self.surface.triangles).mask for lens in self.lenses]


def films(folder: Path, width: int, frames: int, names: Sequence[str] = tuple(CLIPS)) -> list[Film]:
    """Those clips that are there."""
    made, surface = [], surface_of()
    for name in names:
        file, part = CLIPS[name]
        if not (folder / file).exists():
            print(f"  {name}: no {file} in {folder}")
            continue
        clip = retarget(load(folder / file)).resample(RATE)
        middle = 0 if part == "all" else int(clip.root[:, 1].argmin()) if part == "deepest" else int(clip.rotations[:, 0, 1, 1].argmin())
        first = int(np.clip(middle - frames // 2, 0, max(len(clip) - frames, 0)))
        clip = clip.slice(first, first + frames)
        track = fitted(surface.chain, clip.root, clip.rotations)
        truth = [Configuration(root.copy(), angles.copy()) for root, angles in zip(track.root, track.angles)]
        low, high = clip.root.min(0), clip.root.max(0)
        away = max(4.5, 0.9 * float(np.hypot(*(high - low)[[0, 2]])) + 2.5)
        middle_of = 0.5 * (low + high)
        made.append(Film(name, surface, ring(4, away, 1.5, (middle_of[0], 1.0, middle_of[2]), (width, width * 3 // 4), 0.7), truth))
    return made


def noisy(mask: np.ndarray, rng: np.random.Generator, share: float = 0.15, rectangles: int = 3) -> np.ndarray:
    """A silhouette as a poor segmentation gives it: rectangles full or empty, 15 % of all pixels wrong, then the majority of 5 × 5."""
    out, (height, width) = mask.copy(), mask.shape
    for _ in range(rectangles):
        w, h = rng.integers(width // 40, width // 8, 2)
        x, y = rng.integers(0, width), rng.integers(0, height)
        out[y:y + h, x:x + w] = rng.random() < 0.5
    out ^= rng.random(out.shape) < share
    return uniform_filter(out.astype(np.float32), 5) > 0.5


def overlay(film: Film, masks: Sequence[Sequence[np.ndarray]], poses: Sequence[Configuration], frames: Sequence[int]) -> np.ndarray:
    """A picture (H, W, 3) of what was seen, grey, the true contour, green, and the model's, red: a row a frame, a column a camera."""
    rows, half = [], 110
    for t in frames:
        row = []
        for lens, mask in zip(film.lenses, masks[t - 2]):
            true, ours = (contour_of(silhouette(film, lens, pose)) for pose in (film.truth[t], poses[t]))
            picture = np.where(mask[..., None], 150, 40).astype(np.uint8).repeat(3, -1)
            for contour, colour in ((true, (0, 255, 0)), (ours, (255, 60, 60))):
                x, y = contour.pixels.astype(int).T
                picture[y, x] = colour
            middle = true.pixels.mean(0).astype(int)
            wide = np.pad(picture, ((half, half), (half, half), (0, 0)))
            row.append(wide[middle[1]:middle[1] + 2 * half, middle[0]:middle[0] + 2 * half].repeat(2, 0).repeat(2, 1))
        rows.append(np.concatenate(row, 1))
    return np.concatenate(rows)


def silhouette(film: Film, lens: Lens, pose: Configuration) -> np.ndarray:
    """The model's mask (H, W) at a pose."""
    positions, orientations, _ = posed(film.chain, pose)
    return rendered(lens, skinned(film.surface, positions, orientations), film.surface.triangles).mask


@dataclass(frozen=True, eq=False)
class Errors:
    """Of F frames: angles, swings, twists (F, J') [°] of joints that turn and the hips; metres (F, J); how much it shakes,
    over the truth; how many frames it lags."""

    angles: np.ndarray
    swings: np.ndarray
    twists: np.ndarray
    metres: np.ndarray
    jitter: float
    lag: float

    def told(self) -> str:
        return (f"{self.angles.mean():5.2f}° (σ {self.angles.std():5.2f}, p95 {np.percentile(self.angles, 95):5.1f}, worst {self.angles.max():5.1f}; "
                f"limbs' directions {self.swings.mean():5.2f}°, twist {self.twists.mean():5.2f}°) {100 * self.metres.mean():5.2f} cm "
                f"(worst {100 * self.metres.max():5.1f}) jitter {self.jitter:4.2f}× lag {self.lag:5.2f}")


def errors(chain: Chain, got: Sequence[Configuration], want: Sequence[Configuration]) -> Errors:
    """How far poses are off."""
    one, other = (local_turns(chain, Configuration(np.stack([p.root for p in poses]), np.stack([p.angles for p in poses]))).rotations
                  for poses in (got, want))
    joints = np.r_[0, np.flatnonzero(chain.count)]
    away = Rotation.from_matrix((np.swapaxes(other, -1, -2) @ one)[:, joints].reshape(-1, 3, 3))
    axes = np.tile(np.stack([_bone(chain, j) for j in joints]), (len(got), 1))
    q = away.as_quat()
    twist = 2 * np.arctan2(np.abs((q[:, :3] * axes).sum(1)), np.abs(q[:, 3]))
    swing = 2 * np.arccos(np.clip(np.hypot((q[:, :3] * axes).sum(1), q[:, 3]), 0, 1))
    shape = (len(got), len(joints))
    at, there = (np.stack([posed(chain, pose)[0] for pose in poses]) for poses in (got, want))
    return Errors(*(np.degrees(v).reshape(shape) for v in (away.magnitude(), swing, np.minimum(twist, 2 * np.pi - twist))),
                  np.linalg.norm(at - there, axis=-1), _shake(at) / _shake(there), _lag(at, there))


def _bone(chain: Chain, j: int) -> np.ndarray:
    """Along which axis of its own a joint's limb lies."""
    skeleton = chain.skeleton
    below = np.flatnonzero(skeleton.parents == j)
    offset = skeleton.offsets[below[0]] if len(below) else skeleton.end_offsets[np.flatnonzero(skeleton.end_parents == j)[0]]
    return offset / np.linalg.norm(offset)


def _shake(at: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(at, 3, axis=0), axis=-1).mean())


def _lag(at: np.ndarray, there: np.ndarray) -> float:
    """By how many frames the truth has to be held back to fit best, from a parabola through the three best."""
    inner = there[4:-4]
    shifts = np.arange(-4, 5)
    off = np.array([((at[4 + s:len(at) - 4 + s] - at[4 + s:len(at) - 4 + s].mean(0) - inner + inner.mean(0)) ** 2).mean() for s in shifts])
    k = int(np.clip(off.argmin(), 1, len(off) - 2))
    a, b, c = off[k - 1:k + 2]
    return float(shifts[k] + np.clip(0.5 * (a - c) / max(a - 2 * b + c, 1e-12), -1.0, 1.0))
