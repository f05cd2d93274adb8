"""What the gate of points does in each frame, compiled: point by point what `point_gate` says, whose words and limits these are."""

from __future__ import annotations

import math

import numpy as np

from ...body import damp_kernel, exp_kernel, product_kernel, spring_kernel
from ...compiled import kernel
from .pose_kernels import way_kernel

SUDDEN = 0.15
"""Farther than this [m] from where its motion leads no point gets within a frame: 540 m/s² is beyond any body."""
ROUGHLY = 3.0
"""Noise takes it farther, up to so many times as far as it lately did, but no farther than `NEAR`."""
FASTEST = 15.0
"""And one of which no motion is known yet no farther than this [m/s] goes."""
BLINK = 0.15
"""A point or a turn that is missing for no longer than this [s] goes on as it went; then it is lost."""
SWERVE = 3.0
"""Meanwhile it gets so much farther [m/s] from where its motion led: of recorded points five in a thousand do."""
NEAR = 0.4
"""A point that comes back within this of where the body has it [m] is believed at once."""
PATIENCE = 0.3
"""Farther away it has to be seen to move like a body for so long [s]."""
STRAY = 1.5
"""… and as much farther as somebody goes [m/s] for as long as no point was followed."""
REACH = 1.5
"""And beyond this [m] it is never believed."""
EASE = 0.1
"""Half-life with which a point that is back comes to where it is seen [s]."""
NOISY = 2.0
"""Noise makes points swerve by up to so many times as far as they were lately off."""
THERE = 0.01
"""It has come there as soon as it is nearer than this [m]."""
SLIP = 3.0
"""It is taken to move at most so much faster or slower than it is seen to [m/s]: else it would swing past."""
SKEW = 0.1
"""What no rotation's RᵀR is farther from 1 than."""
PLAIN = 0.5
"""Two points that are no nearer to where their own motion led than by this times their distance from where the other one's did may have been exchanged."""
ROUGH = 0.2
"""Half-life of the roughness that is told from places [s]."""
RATE = 0.03
"""Half-life of the velocity that is told from places [s]."""


@kernel
def finite_kernel(vector):
    """Whether all three numbers of a vector (3,) are finite."""
    return math.isfinite(vector[0]) and math.isfinite(vector[1]) and math.isfinite(vector[2])


@kernel
def finite_turn_kernel(turn):
    """Whether all nine numbers of a matrix (3, 3) are finite."""
    return finite_kernel(turn[0]) and finite_kernel(turn[1]) and finite_kernel(turn[2])


@kernel
def long_kernel(x, y, z):
    """The length of a vector."""
    return math.sqrt(x * x + y * y + z * z)


@kernel
def usual_kernel(rough):
    """How far [m] a point that is so rough may get from where its motion led within a frame."""
    return min(max(ROUGHLY * rough, SUDDEN), NEAR)


@kernel
def leapt_kernel(seen, dt, raw, rate, steady, rough):
    """How many points, seen at (n, 3) dt [s] later, leapt farther than noise takes them."""
    count = 0
    for n in range(len(seen)):
        way = long_kernel(seen[n, 0] - (raw[n, 0] + rate[n, 0] * dt), seen[n, 1] - (raw[n, 1] + rate[n, 1] * dt), seen[n, 2] - (raw[n, 2] + rate[n, 2] * dt))
        if steady[n] > 0.0 and way > usual_kernel(rough[n]):
            count += 1
    return count


@kernel
def confusable_kernel(pairs, seen, dt, raw, rate, gone, steady, trusted, out):
    """Fills out (P,) bool, see `Gate.confusable`."""
    ahead, lost = raw + rate * dt, np.empty(len(raw), np.bool_)
    for n in range(len(raw)):
        lost[n] = not trusted[n] and (gone[n] > 0.0 or steady[n] > 0.0)
    for p in range(len(pairs)):
        a, b = pairs[p]
        own, other = 0.0, 0.0
        for i in range(3):
            own += (seen[a, i] - ahead[a, i]) ** 2 + (seen[b, i] - ahead[b, i]) ** 2
            other += (seen[a, i] - ahead[b, i]) ** 2 + (seen[b, i] - ahead[a, i]) ** 2
        out[p] = own >= PLAIN ** 2 * other or lost[a] and lost[b]


@kernel
def admit_kernel(seen, body, motion, dt, lost, raw, rate, smooth, swerve, gone, steady, rough, heard, trusted, offset, slip, goals):
    """Rewrites what `Gate` holds, and fills goals (n, 3), as `Gate.admit` says."""
    ahead, moved = np.empty(3), np.empty(3)
    for n in range(len(seen)):
        there, known, since = finite_kernel(seen[n]), finite_kernel(raw[n]), gone[n] + dt
        for i in range(3):
            moved[i], ahead[i] = seen[n, i] - raw[n, i], raw[n, i] + smooth[n, i] * dt
            swerve[n, i] = moved[i] - rate[n, i] * dt
        away = min(long_kernel(swerve[n, 0], swerve[n, 1], swerve[n, 2]), long_kernel(seen[n, 0] - ahead[0], seen[n, 1] - ahead[1], seen[n, 2] - ahead[2]))
        usual, on = usual_kernel(rough[n]), steady[n] > 0.0
        goes_on = there and known and away <= usual + (SWERVE * gone[n] if on else FASTEST * since)
        blinks = not there and known and since <= BLINK
        if there and known:
            before = rough[n] * heard[n]
            heard[n] = damp_kernel(heard[n], 1.0, ROUGH, dt)
            rough[n] = damp_kernel(before, min(away, NEAR), ROUGH, dt) / max(heard[n], 1e-9)
        if not blinks:
            steady[n] = steady[n] + since if goes_on else 0.0
        for i in range(3):
            rate[n, i] = smooth[n, i] if blinks else (moved[i] + rate[n, i] * gone[n]) / since if goes_on else 0.0
            smooth[n, i] = damp_kernel(smooth[n, i], rate[n, i], RATE, dt) if on else rate[n, i]
            raw[n, i] = ahead[i] if blinks else seen[n, i] if there else np.nan
            if not goes_on or gone[n] != 0.0:
                swerve[n, i] = 0.0
        gap = long_kernel(raw[n, 0] - body[n, 0], raw[n, 1] - body[n, 1], raw[n, 2] - body[n, 2])
        believed = gap <= REACH and (blinks and trusted[n] or goes_on and (trusted[n] or gap <= NEAR + STRAY * lost or steady[n] >= PATIENCE))
        back = believed and there and lost == 0.0 and not (trusted[n] and away <= usual)
        slower = long_kernel(motion[n, 0] - smooth[n, 0], motion[n, 1] - smooth[n, 1], motion[n, 2] - smooth[n, 2])
        for i in range(3):
            if not believed:
                offset[n, i], slip[n, i] = 0.0, 0.0
            elif back:
                offset[n, i], slip[n, i] = body[n, i] - seen[n, i], (motion[n, i] - smooth[n, i]) * min(1.0, SLIP / max(slower, 1e-9))
            else:
                offset[n, i], slip[n, i] = spring_kernel(offset[n, i], slip[n, i], 0.0, EASE, dt)
            goals[n, i] = raw[n, i] + offset[n, i] if believed else np.nan
        trusted[n], gone[n] = believed, 0.0 if there else since


@kernel
def told_kernel(turns, dt, turned, spin, untold):
    """Rewrites turned (n, 3, 3), spin (n, 3) and untold (n,) of `Gate`, as `Gate.told` says."""
    old, turn, found, work = np.empty((3, 3)), np.empty((3, 3)), np.empty(3), np.empty((2, 3, 3))
    for n in range(len(turns)):
        there, known, since = finite_turn_kernel(turns[n]), finite_turn_kernel(turned[n]), untold[n] + dt
        old[:] = turned[n]
        if there:
            turned[n] = turns[n]
        elif known and since <= BLINK:
            exp_kernel(spin[n, 0] * dt, spin[n, 1] * dt, spin[n, 2] * dt, turn)
            product_kernel(old, turn, turned[n])
        else:
            turned[n] = np.nan
        if known and there:
            way_kernel(old, turns[n], found, work)
            for i in range(3):
                spin[n, i] = damp_kernel(spin[n, i], (found[i] + spin[n, i] * untold[n]) / since, RATE, dt)
        elif not (known and since <= BLINK):
            spin[n] = 0.0
        untold[n] = 0.0 if there else since


@kernel
def swerves_kernel(raw, swerve, swerved, gone, rough, trusted, offset):
    """See `Gate.swerves` [m]."""
    most = 0.0
    for n in range(len(raw)):
        along = swerve[n, 0] * swerved[n, 0] + swerve[n, 1] * swerved[n, 1] + swerve[n, 2] * swerved[n, 2]
        settled = long_kernel(offset[n, 0], offset[n, 1], offset[n, 2]) <= THERE
        if trusted[n] and gone[n] == 0.0 and finite_kernel(raw[n]) and settled and along > 0.0:
            once = min(long_kernel(swerve[n, 0], swerve[n, 1], swerve[n, 2]), long_kernel(swerved[n, 0], swerved[n, 1], swerved[n, 2]))
            most = max(most, once - NOISY * rough[n])
    return most


@kernel
def sound_kernel(turns, out):
    """Fills out (n, 3, 3), see `rotations`."""
    for n in range(len(turns)):
        m, skew = turns[n], 0.0
        for i in range(3):
            for k in range(3):
                product = m[0, i] * m[0, k] + m[1, i] * m[1, k] + m[2, i] * m[2, k] - (1.0 if i == k else 0.0)
                skew = max(skew, abs(product)) if math.isfinite(product) else np.inf
        size = (m[0, 0] * (m[1, 1] * m[2, 2] - m[1, 2] * m[2, 1]) - m[0, 1] * (m[1, 0] * m[2, 2] - m[1, 2] * m[2, 0])
                + m[0, 2] * (m[1, 0] * m[2, 1] - m[1, 1] * m[2, 0]))
        if skew <= SKEW and size > 0.5:
            out[n] = m
        else:
            out[n] = np.nan
