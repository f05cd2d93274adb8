"""The way of the blend's foot until it comes down, and where the other foot lies meanwhile: foretold, so that a foot that swings gives way early (`swing`)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import kernel
from .foot_lines import with_toe
from .kernel import COLUMNS, SCRATCH
from .minimum_jerk import smooth
from .root_motion import advance, short_way
from .swing import SAMPLES, SWING, other_line

RISEN = 0.03
"""A foot whose heel is this high over where it rests turns about its ball [m]."""


class Ahead(NamedTuple):
    """Room for what is looked up of the time to come.

    until: (2,) when each foot that swings comes down [s], 0 for one that should be down. way: (2, SAMPLES, 3, 3) where the blend's heels, balls and toes' ends
    will be, x and z in the world and y over the floor, after `shares` (2, SAMPLES) of that time, 0 or less where that is
    past or nothing is planned. beside: (2, SAMPLES, 3, 2) the centre line of the other foot then, x and z in the world. toe: (2, 3) from the blend's
    balls to their toes' ends now, in the ground frame [m]. between: weights halfway; halfway: (4, 3) heels and balls then.
    """

    row: np.ndarray
    weights: np.ndarray
    local: np.ndarray
    positions: np.ndarray
    orientations: np.ndarray
    scratch: np.ndarray
    points: np.ndarray
    barycentric: np.ndarray
    vectors: np.ndarray
    lines: np.ndarray
    until: np.ndarray
    shares: np.ndarray
    way: np.ndarray
    beside: np.ndarray
    toe: np.ndarray
    now: np.ndarray
    between: np.ndarray
    halfway: np.ndarray


@kernel
def room_to_plan(width, joints):
    """That room, for a library as wide and a body of as many joints."""
    return Ahead(np.empty(COLUMNS, np.float32), np.empty(width, np.float32), np.empty((joints, 3, 3), np.float32),
                 np.empty((joints, 3), np.float32), np.empty((joints, 3, 3), np.float32), np.empty(SCRATCH, np.float32),
                 np.empty((4, 3), np.float32), np.empty(4), np.empty((4, 3)), np.empty((2, 3, 2)),
                 np.empty(2), np.empty((2, SAMPLES)), np.empty((2, SAMPLES, 3, 3)), np.empty((2, SAMPLES, 3, 2)), np.empty((2, 3)), np.empty((5, 3, 3)),
                 np.empty(width, np.float32), np.empty((4, 3), np.float32))


@kernel
def foretell_way(m, body, foot, left, legs, ahead, fades):
    """Write into ahead.way where the blend's foot will be until it comes down, `left` further in phase, into ahead.shares when, and into ahead.beside where the other foot
    will be.

    As the paths of the primitives have it at weights and along a way that lead evenly from now to then, and off it by as much as
    it is now and will be then, most of which goes at first; while an offset `fades`, which may carry the foot on for a while, by as much as it will be halfway, too. The other foot stays, and turns about its ball as the blend's does once its heel is up.
    """
    ground, now, end, at, there, half = ahead.vectors[0], ahead.now[0], ahead.now[1], ahead.now[2], ahead.now[3], ahead.now[4]
    strike, whole, paths = SWING[m.family] + 0.5 * foot, ahead.until[foot], legs.paths
    stands = other_line(m, body, foot, ahead.lines[0]) and (m.grip[2 - 2 * foot] > 0.0 or m.grip[3 - 2 * foot] > 0.0)
    _along_paths(m.weights, ahead.weights, 0.0, paths, strike - left, foot, now)
    _along_paths(m.weights, ahead.weights, 1.0, paths, strike, foot, end)
    for i in range(3):  # the toe keeps to the paths' own, which it is off by at first
        now[2, i] = m.points[2 * foot + 1, i] + ahead.toe[foot, i] - now[2, i]
        end[2, i] = ahead.points[2 * foot + 1, i] - end[1, i]
    for k in range(2):
        for i in range(3):
            now[k, i] = m.points[2 * foot + k, i] - now[k, i]
            end[k, i] = ahead.points[2 * foot + k, i] - end[k, i]
    if fades:
        _along_paths(m.weights, ahead.weights, 0.5, paths, strike - 0.5 * left, foot, half)
        for i in range(3):
            half[2, i] = ahead.halfway[2 * foot + 1, i] - half[1, i]
            for k in range(2):
                half[k, i] = ahead.halfway[2 * foot + k, i] - half[k, i]
    goes = ahead.vectors[1]  # the ground frame as it moves now, for all that time
    for i in range(3):
        goes[i] = m.ground[i]
    advance(goes, m.velocity[0], m.velocity[1], m.velocity[2], whole)
    turn, turned = short_way(goes[2] - m.ground[2]), short_way(ground[2] - goes[2])
    for k in range(SAMPLES):
        share = 1.0 - SWING[m.family] * (1.0 - (k + 0.5) / SAMPLES) / max(left, 1e-6)
        ahead.shares[foot, k] = share
        if share <= 0.0:
            continue
        phase = strike - (1.0 - share) * left
        _along_paths(m.weights, ahead.weights, share, paths, phase, foot, at)
        heading = m.ground[2] + share * turn + share * share * turned
        x = m.ground[0] + share * (goes[0] - m.ground[0]) + share * share * (ground[0] - goes[0])
        z = m.ground[1] + share * (goes[1] - m.ground[1]) + share * share * (ground[1] - goes[1])
        c, s = math.cos(heading), math.sin(heading)
        gone = share * (2.0 - share)
        for p in range(3):
            for i in range(3):
                if fades:
                    at[p, i] += (1.0 - share) * (1.0 - 2.0 * share) * now[p, i] + share * (4.0 * (1.0 - share) * half[p, i] + (2.0 * share - 1.0) * end[p, i])
                else:
                    at[p, i] += now[p, i] + gone * (end[p, i] - now[p, i])
            ahead.way[foot, k, p, 0] = x + c * at[p, 0] + s * at[p, 2]
            ahead.way[foot, k, p, 1] = at[p, 1]
            ahead.way[foot, k, p, 2] = z - s * at[p, 0] + c * at[p, 2]
        beside = ahead.beside[foot, k]
        for p in range(3):
            beside[p, 0], beside[p, 1] = ahead.lines[0, p, 0], ahead.lines[0, p, 1]
        if stands:
            _along_paths(m.weights, ahead.weights, share, paths, phase, 1 - foot, there)
            _pivot(m, body, 1 - foot, there, heading, legs.height, beside)


@kernel
def _pivot(m, body, foot, there, heading, height, line):
    """Turn the centre line (3, 2) of a foot that stands about its ball, as the blend's heel and ball (2, 3) lie in the ground frame of that heading, the more the higher the heel is."""
    free = smooth((there[0, 1] - height) / RISEN)
    if free <= 0.0:
        return
    c, s = math.cos(heading + m.offset[foot, 2]), math.sin(heading + m.offset[foot, 2])
    x, z = there[0, 0] - there[1, 0], there[0, 2] - there[1, 2]
    line[0, 0] += free * (line[1, 0] + c * x + s * z - line[0, 0])
    line[0, 1] += free * (line[1, 1] - s * x + c * z - line[0, 1])
    with_toe(body, line)


@kernel
def _along_paths(first, last, share, paths, phase, foot, out):
    """Write where heel, ball and toe's end (3, 3) of a foot are at a phase on the paths (P, PHASES, 6, 3) of primitives, at weights that have
    gone that share of the way from the first to the last."""
    at = (phase % 1.0) * paths.shape[1]
    one = int(at) % paths.shape[1]
    two, part = (one + 1) % paths.shape[1], at - int(at)
    for k in range(3):
        for i in range(3):
            out[k, i] = 0.0
    for p in range(paths.shape[0]):
        w = first[p] + share * (last[p] - first[p])
        if w > 0.0:
            for k in range(3):
                for i in range(3):
                    a, b = paths[p, one, 3 * foot + k, i], paths[p, two, 3 * foot + k, i]
                    out[k, i] += w * (a + part * (b - a))
