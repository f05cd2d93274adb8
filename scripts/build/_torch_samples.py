"""Samples that the network for trackers is learnt from, drawn with PyTorch where they are learnt on: `trackers_torch.py`.

As `controllers/reconstruction/trackers` draws them: the same moments, bodies and trackers (its `samples.py`, `bodies.py`, `wearing.py` and
`slots.py`); tests/reconstruction/test_packed_motion.py holds both to be alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

PLACED, STANDS = 63, 4
ANGLES, HEIGHT, PITCH, ROLL, YAW, FORWARD, LEFT = 57, 57, 58, 59, 60, 61, 62


def product(a: Tensor, b: Tensor) -> Tensor:
    """Of 3 × 3 matrices, written out: libraries' batched products of such small ones are far slower, and round more."""
    return (a[..., :, :, None] * b[..., None, :, :]).sum(-2)


def turned(a: Tensor, v: Tensor) -> Tensor:
    """Matrices (..., 3, 3) times vectors (..., 3)."""
    return (a * v[..., None, :]).sum(-1)


def exp(v: Tensor) -> Tensor:
    """Rotations (..., 3, 3) of rotation vectors (..., 3)."""
    square = (v * v).sum(-1)
    small = square < 1e-6
    safe = torch.where(small, torch.ones_like(square), square)
    angle = safe.sqrt()
    a = torch.where(small, 1 - square / 6, torch.sin(angle) / angle)
    b = torch.where(small, 0.5 - square / 24, (1 - torch.cos(angle)) / safe)
    x, y, z = v.unbind(-1)
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    return torch.stack([1 - b * (yy + zz), b * xy - a * z, b * xz + a * y, b * xy + a * z, 1 - b * (xx + zz), b * yz - a * x,
                        b * xz - a * y, b * yz + a * x, 1 - b * (xx + yy)], -1).unflatten(-1, (3, 3))


def yaw(heading: Tensor) -> Tensor:
    """Rotations (..., 3, 3) about the vertical."""
    c, s = heading.cos(), heading.sin()
    no, one = torch.zeros_like(c), torch.ones_like(c)
    return torch.stack([c, no, s, no, one, no, -s, no, c], -1).unflatten(-1, (3, 3))


class Body:
    """The skeleton, and kinematics on it."""

    def __init__(self, pack: dict, device: str):
        def get(name, kind=torch.float32):
            return torch.tensor(np.asarray(pack[name]), dtype=kind, device=device)
        self.device, self.offsets, self.parents = device, get("offsets"), np.asarray(pack["parents"]).tolist()
        self.joints, self.slots, self.legs = (get(name, torch.long) for name in ("joints", "slots", "legs"))
        self.columns, self.signs, self.knee = get("mirror_columns", torch.long), get("mirror_signs"), np.asarray(pack["knee"]).tolist()
        self.group, self.twin, self.middle = get("group", torch.long), get("twin", torch.long), get("middle", torch.bool)
        self.parts, self.lying, self.side = get("parts"), get("lying"), get("side")
        self.inside = self.middle[:, None] & torch.tensor([True, False, False], device=device)
        self.kinds, self.often, self.lags = get("kinds", torch.bool), get("often"), get("lags", torch.long)
        depth = [0] * len(self.parents)
        for j in range(1, len(depth)):
            depth[j] = depth[self.parents[j]] + 1
        levels = [[j for j in range(len(depth)) if depth[j] == d] for d in range(max(depth) + 1)]
        first = {int(j): k for k, j in enumerate(np.asarray(pack["joints"]))}

        def there(numbers):
            return torch.tensor(numbers, device=device)
        # numbers lie where they are used: a list would be carried over at each use, and such steps can't be recorded
        self.levels, self.above = list(map(there, levels)), [there([levels[d].index(self.parents[j]) for j in level]) for d, level in enumerate(levels[1:])]
        self.own = [there([first.get(j, len(first)) for j in level]) for level in levels]
        self.order, self.parent = there(np.argsort(np.concatenate(levels))), there(np.maximum(self.parents, 0))
        self.reference = torch.cat([get("reference")[self.joints], get("reference")[None, len(depth) - 1]])  # the last one is the toes'
        self.leg = float(self.legs_of(self.offsets))

    def legs_of(self, offsets: Tensor) -> Tensor:
        """See `bodies.legs`."""
        knee, foot, toe = self.knee
        return offsets[..., knee, :].norm(dim=-1) + offsets[..., foot, :].norm(dim=-1) + offsets[..., toe, 1].abs()

    def orientations(self, poses: Tensor, heading: Tensor | None = None) -> Tensor:
        """(..., J, 3, 3) of poses (..., 63) that face heading, or ahead."""
        local = exp(torch.cat([poses[..., :ANGLES], torch.zeros_like(poses[..., :3])], -1).unflatten(-1, (-1, 3)))
        local = product(self.reference.expand_as(local), local)
        root = exp(torch.stack([poses[..., PITCH], torch.zeros_like(poses[..., 0]), poses[..., ROLL]], -1))
        levels = [(root if heading is None else product(yaw(heading), root))[..., None, :, :]]
        for above, own in zip(self.above, self.own[1:], strict=True):
            levels.append(product(levels[-1].index_select(-3, above), local.index_select(-3, own)))
        return torch.cat(levels, -3).index_select(-3, self.order)

    def positions(self, orientations: Tensor, offsets: Tensor) -> Tensor:
        """Joints (..., J, 3) from the hips."""
        bones = turned(orientations.index_select(-3, self.parent), offsets)
        levels = [torch.zeros_like(bones[..., :1, :])]
        for above, level in zip(self.above, self.levels[1:], strict=True):
            levels.append(levels[-1].index_select(-2, above) + bones.index_select(-2, level))
        return torch.cat(levels, -2).index_select(-2, self.order)

    def placed(self, poses: Tensor, offsets: Tensor) -> Tensor:
        """Joints (..., J, 3) of placed poses (..., 63)."""
        hips = torch.stack([poses[..., LEFT], poses[..., HEIGHT], poses[..., FORWARD]], -1)
        return self.positions(self.orientations(poses, poses[..., YAW]), offsets) + hips[..., None, :]


class Motion:
    """Recorded frames with their mirror images, and what samples are drawn by."""

    def __init__(self, pack: dict, body: Body):
        device = body.device
        whole = np.cumsum(np.cumsum(pack["frames"].astype(np.int64), 0), 0)
        frames = torch.tensor((whole * pack["step"]).astype(np.float32), device=device)
        track = torch.tensor(pack["track"].astype(np.float32), device=device)
        behind, stands, good = (torch.tensor(pack[name], device=device) for name in ("behind", "stands", "good"))
        self.fps, count = float(pack["fps"]), len(frames)
        self.frames = torch.cat([frames, frames[:, body.columns] * body.signs])
        self.track = torch.cat([track, track * torch.tensor([-1.0, 1.0, -1.0], device=device)])
        self.behind, self.stands = torch.cat([behind, behind]), torch.cat([stands, stands[:, [2, 3, 0, 1]]])
        self.good = torch.cat([good, good + count])
        upto = torch.cumsum(torch.tensor(np.tile(pack["share"], 2), device=device), 0)
        self.upto = upto / upto[-1]
        self.orientations = torch.cat([body.orientations(part).flatten(-2) for part in self.frames.split(1 << 16)])


@dataclass(frozen=True, eq=False)
class Dice:
    """What is drawn by."""

    generator: torch.Generator
    device: str

    def even(self, *shape: int) -> Tensor:
        return torch.rand(*shape, device=self.device, generator=self.generator)

    def normal(self, *shape: int) -> Tensor:
        return torch.randn(*shape, device=self.device, generator=self.generator)

    def whole(self, low: int, high: int, *shape: int) -> Tensor:
        return torch.randint(low, high, shape, device=self.device, generator=self.generator)


def bodies(body: Body, count: int, dice: Dice) -> Tensor:
    """See `bodies.bodies`."""
    size = 1 + 0.06 * dice.normal(count, 1).clamp(-2.5, 2.5)
    parts = 1 + body.parts * dice.normal(count, len(body.parts)).clamp(-2.5, 2.5)
    lying = dice.normal(count, len(body.parents), 3) * body.lying[:, None]
    lying = lying.masked_fill(body.inside, 0.0)
    offsets = body.offsets * (size * parts[:, body.group])[..., None] + lying[:, body.twin] * body.side
    offsets = torch.where((dice.even(count) < 0.25)[:, None, None], body.offsets, offsets)
    return torch.cat([body.offsets[:1].expand(count, 1, 3), offsets[:, 1:]], 1)


def worn(body: Body, count: int, dice: Dice) -> tuple[Tensor, ...]:
    """placed, turned (B, L, S); moved (B, L, S, 3), off (B, 1, S, 3), spun (B, L, S, 3, 3), heading (B,): see `wearing.worn`."""
    lags, slots, nothing = len(body.lags), body.kinds.shape[1], torch.zeros((), device=body.device)
    kind = torch.searchsorted(torch.cumsum(body.often, 0), dice.even(count))
    free = kind >= len(body.kinds)
    placed = torch.where(free[:, None], dice.even(count, slots) < 0.6, body.kinds[kind.clamp(max=len(body.kinds) - 1)])
    sure = dice.whole(2, 7, count)[:, None] == torch.arange(slots, device=body.device)
    placed = placed | (sure & ~placed.any(-1, keepdim=True))
    turning, way = 0.45 + 0.35 * (kind == 2), dice.even(count)
    spins = placed & (way < turning)[:, None]
    spins = spins | (placed & ((way >= turning) & (way < turning + 0.1))[:, None] & (dice.even(count, slots) < 0.5))
    unplaced = spins & free[:, None] & (dice.even(count, slots) < 0.2) & ~sure
    placed = placed & ~(unplaced & (placed & sure).any(-1, keepdim=True))
    lag, way = torch.arange(lags, device=body.device)[None, :, None], dice.even(count, 1, 1)
    known = (way >= 0.15) | (lag < dice.whole(1, lags, count, 1, 1))
    since = dice.whole(1, lags + 1, count, 1, slots)
    known = known & ~((way >= 0.15) & (way < 0.35) & (dice.even(count, 1, slots) < 0.4) & (lag < since))
    known = known & ~((way >= 0.35) & (way < 0.45) & (dice.even(count, 1, slots) < 0.4) & (lag >= since.clamp(max=lags - 1)))
    level = torch.where(dice.even(count) < 0.5, nothing, dice.even(count))[:, None, None, None]
    sitting = 0.05 * (dice.even(count) >= 0.5)[:, None, None, None]
    moved = level * 0.008 * dice.normal(count, lags, slots, 3)
    spun = exp(level * 0.015 * dice.normal(count, lags, slots, 3) + sitting * dice.normal(count, 1, slots, 3))
    astray = dice.even(count)
    heading = torch.where(astray < 0.35, dice.normal(count) * 0.1, torch.where(astray < 0.5, dice.normal(count) * 0.5, nothing))
    off = torch.where((dice.even(count) < 0.5)[:, None, None, None], nothing, dice.normal(count, 1, slots, 3) * 0.01)
    return placed[:, None] & known, spins[:, None] & known, moved, off, spun, heading


def moments(body: Body, motion: Motion, at: Tensor, offsets: Tensor) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """truth (B, 63), places (B, L, S, 3), turns (B, L, S, 3, 3), there (B, L) of frames `at` (B,) on bodies: see `samples.moments_kernel`."""
    which = (at[:, None] - body.lags).clamp(min=0)
    own = motion.orientations[which].unflatten(-1, (3, 3))
    ratio, joints = body.legs_of(offsets) / body.leg, body.positions(own, offsets[:, None])
    height = motion.frames[at, HEIGHT]
    lowest = height + body.positions(own[:, 0], body.offsets).index_select(1, body.legs)[..., 1].amin(-1)
    up = lowest - (height * ratio + joints[:, 0].index_select(1, body.legs)[..., 1].amin(-1))
    way, facing = motion.track[which] - motion.track[at][:, None], motion.track[at, 2]
    c, s = facing.cos()[:, None], facing.sin()[:, None]
    hips = torch.stack([(c * way[..., 0] - s * way[..., 1]) * ratio[:, None], motion.frames[which, HEIGHT] * ratio[:, None] + up[:, None],
                        (s * way[..., 0] + c * way[..., 1]) * ratio[:, None]], -1)
    heading = yaw(way[..., 2])[:, :, None]
    places = turned(heading, joints.index_select(2, body.slots)) + hips[:, :, None]
    truth = motion.frames[at].clone()
    truth[:, HEIGHT] = height * ratio + up
    truth[:, YAW:] = 0
    return truth, places, product(heading, own.index_select(2, body.slots)), body.lags <= motion.behind[at][:, None]


def view(body: Body, fps: float, places: Tensor, turns: Tensor, placed: Tensor, spins: Tensor, offsets: Tensor, given: Tensor) -> tuple[Tensor, Tensor]:
    """Inputs (B, INPUTS) and the ground (B, 3) they are seen from: see `slots.view_kernel`."""
    steps, lags = len(body.lags), body.lags.float()
    number = torch.arange(steps, device=body.device)[None, :, None]
    newest, latest = (number.expand_as(known).masked_fill(~known, steps).amin(1) for known in (placed, spins))
    seen, facing = (newest < steps).float()[..., None], (latest < steps).float()[..., None]
    newest, latest = newest.clamp(max=steps - 1), latest.clamp(max=steps - 1)
    place = places.gather(1, newest[:, None, :, None].expand(-1, -1, -1, 3))[:, 0]
    turn = turns.gather(1, latest[:, None, :, None, None].expand(-1, -1, -1, 3, 3))[:, 0]
    middle = (place * seen).sum(1) / seen.sum(1).clamp(min=1)
    across, along = turns[:, 0, :3, 0, 2] - turns[:, 0, :3, 2, 0], turns[:, 0, :3, 0, 0] + turns[:, 0, :3, 2, 2]
    upright, angle, heading = spins[:, 0, :3] & (across ** 2 + along ** 2 > 1e-6), torch.atan2(across, along), given
    for slot in (2, 1, 0):
        heading = torch.where(upright[:, slot], angle[:, slot], heading)
    back = yaw(-heading)[:, None]
    level = torch.stack([middle[:, 0], torch.full_like(heading, 0.9), middle[:, 2]], -1)[:, None]
    both, spinning = ((known[:, :-1] & known[:, 1:]).float()[..., None] for known in (placed, spins))
    seconds = ((body.lags[1:] - body.lags[:-1]).float() / fps)[None, :, None, None]
    pace = turned(back[:, None], places[:, :-1] - places[:, 1:]) / seconds
    spin = _columns(product(back[:, None], turns[:, :-1] - turns[:, 1:])) / (3.0 * seconds)
    own = [turned(back, place - level) / 0.4 * seen, seen, seen * lags[newest][..., None] / lags[-1],
           _columns(product(back, turn)) * facing, facing, facing * lags[latest][..., None] / lags[-1],
           torch.cat([pace * both, both], -1).transpose(1, 2).flatten(2), torch.cat([spin * spinning, spinning], -1).transpose(1, 2).flatten(2)]
    shape = (offsets - body.offsets) / 0.05
    shape = torch.cat([torch.zeros_like(shape[:, :1]), shape[:, 1:]], 1)
    return torch.cat([torch.cat(own, -1).flatten(1), shape.flatten(1)], -1), torch.cat([middle[:, ::2], heading[:, None]], -1)


def _columns(turns: Tensor) -> Tensor:
    return torch.cat([turns[..., 0], turns[..., 2]], -1)


@dataclass(frozen=True, eq=False)
class Batch:
    """See `samples.Batch`; joints: (B, J, 3) the true ones."""

    inputs: Tensor
    truth: Tensor
    stands: Tensor
    bodies: Tensor
    joints: Tensor


@torch.no_grad()
def sample(body: Body, motion: Motion, at: Tensor, offsets: Tensor, wearing: tuple[Tensor, ...]) -> Batch:
    """What is learnt from: frames `at` (B,) on bodies (B, J, 3), as trackers tell of them."""
    placed, spins, moved, off, spun, astray = wearing
    truth, places, turns, there = moments(body, motion, at, offsets)
    places, turns = places + turned(turns, off) + moved, product(turns, spun)
    given = astray - motion.frames[at, YAW] / motion.fps
    inputs, ground = view(body, motion.fps, places, turns, placed & there[..., None], spins & there[..., None], offsets, given)
    c, s = ground[:, 2].cos(), ground[:, 2].sin()
    truth[:, LEFT], truth[:, FORWARD] = s * ground[:, 1] - c * ground[:, 0], -s * ground[:, 0] - c * ground[:, 1]
    truth[:, YAW] = torch.remainder(-ground[:, 2] + math.pi, 2 * math.pi) - math.pi
    return Batch(inputs, truth, motion.stands[at], offsets, body.placed(truth, offsets))


def batches(body: Body, motion: Motion, size: int, dice: Dice) -> Iterator[Batch]:
    """All that are drawn from now on."""
    while True:
        draw = torch.rand(size, device=body.device, generator=dice.generator, dtype=torch.float64)
        at = motion.good[torch.searchsorted(motion.upto, draw).clamp(max=len(motion.good) - 1)]
        yield sample(body, motion, at, bodies(body, size, dice), worn(body, size, dice))
