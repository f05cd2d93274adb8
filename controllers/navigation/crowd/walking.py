"""A crowd that walks: goals of N walkers become wishes, wishes that avoid each other become one intent for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...contract import Intent
from ..routes import clear, grid_way, shapes_of, ways
from ..steering import Steering, in_world, turn_towards, within
from .avoidance import Manners, avoid, lag
from .doors import Turns, doors_of, queued, taking_turns
from .groups import together

SIDEWAYS = 0.35
"""Who goes v forward steps aside with this much of it at most ..."""
SHUFFLE = 0.15
"""... and this beside [m/s]: people turn rather than side-step."""


def towards(places, goals, speeds, brake: float = 0.6) -> np.ndarray:
    """Wishes (N, 2) [m/s] straight to goals (N, 2) [m] at speeds (N,) [m/s], fading over the last `brake` metres."""
    offset = np.asarray(goals, float) - np.asarray(places, float)
    far = np.linalg.norm(offset, axis=-1, keepdims=True)
    return offset / np.maximum(far, 1e-9) * np.asarray(speeds, float)[..., None] * np.clip(far / brake, 0.0, 1.0)


def aims(places, goals, around: Sequence[Any] = (), clearance: float = 0.30) -> np.ndarray:
    """Where (N, 2) [m] walkers at places (N, 2) turn first on their shortest ways to goals (N, 2) past what stands about.

    Their goals where nothing is in the way, or where no way leads. It takes milliseconds for each who sees no goal: ask a few times a second.
    """
    shapes, found = shapes_of(around), np.array(goals, float)
    for i, (here, there) in enumerate(zip(np.asarray(places, float), np.array(goals, float))):
        if not clear(here[0], here[1], there[0], there[1], shapes, clearance):
            known = ways(here, there, shapes, clearance, most=1)
            way = known[0] if known else grid_way(here, there, shapes, 0.5 * clearance, 0.1)
            found[i] = next((place for place in way[1:] if np.hypot(*(place - here)) > 0.1), there)
    return found


def stepping(ground, velocity, chosen, steering: Steering = Steering(), manners: Manners = Manners()) -> np.ndarray:
    """Velocities (N, 3) v_f, ω, v_l that have walkers move as chosen (N, 2) in the world [m/s], turning to where they go.

    ground: (N, 3) x, z [m], heading [rad]. velocity: (N, 3), how they move. What lies aside is stepped, as far as people do; what lies
    behind waits for the turn.
    """
    ground, velocity, chosen = np.asarray(ground, float), np.asarray(velocity, float), np.asarray(chosen, float)
    speed = np.linalg.norm(chosen, axis=-1)
    trust = speed**2 / (speed**2 + steering.fade**2)
    omega, error = turn_towards(ground[..., 2], np.arctan2(chosen[..., 0], chosen[..., 1]), velocity[..., 1], steering)
    late = 0.5 * lag(manners.halflife) * velocity[..., 1]  # the body turns on while it takes the wish up
    heading = ground[..., 2] + np.clip(late, -np.abs(error), np.abs(error))
    cosine, sine = np.cos(heading), np.sin(heading)
    forward = chosen[..., 0] * sine + chosen[..., 1] * cosine
    left = chosen[..., 0] * cosine - chosen[..., 1] * sine
    most = SIDEWAYS * np.abs(forward) + SHUFFLE
    return within(np.stack([np.maximum(forward, -SHUFFLE), trust * omega, np.clip(left, -most, most)], -1), steering.reach)


def crowd_intent(ground, velocity, goals, speeds, radii=0.22, around: Sequence[Any] = (), steering: Steering = Steering(),
                 manners: Manners = Manners(), groups=None, turns: Turns | None = None) -> Intent:
    """What takes N walkers to their goals past each other: one intent for one step of the whole crowd.

    ground: (N, 3) x, z [m], heading [rad]; velocity: (N, 3) v_f, ω, v_l, both of the crowd's state. goals: (N, 2) [m], or where they `aims`.
    speeds: (N,) [m/s]. radii: (N,) [m] of their bodies. around: what stands about; at doors in it people queue. groups: (N,) who walks
    with whom, as `together` takes it. turns: whose turn it is at doors, from `crowd_turns`; by default that of who is nearer.
    """
    ground, velocity = np.asarray(ground, float), np.asarray(velocity, float)
    wishes = towards(ground[:, :2], goals, np.broadcast_to(np.asarray(speeds, float), len(ground)))
    moving = in_world(ground, velocity)
    wishes = wishes if groups is None else together(ground[:, :2], wishes, groups)
    wishes = queued(ground[:, :2], wishes, goals, doors_of(around), moving, turns)
    chosen = avoid(ground[:, :2], moving, wishes, radii, around, ground[:, 2], manners)
    return Intent(stepping(ground, velocity, chosen, steering, manners))


def crowd_turns(ground, velocity, goals, speeds, around: Sequence[Any], turns: Turns | None, dt: float) -> Turns:
    """Whose turn it is at the doors among what stands about, a step of dt [s] later; arguments as of `crowd_intent`, turns: as they were, None at first."""
    ground = np.asarray(ground, float)
    wishes = towards(ground[:, :2], goals, np.broadcast_to(np.asarray(speeds, float), len(ground)))
    return taking_turns(ground[:, :2], wishes, goals, doors_of(around), in_world(ground, np.asarray(velocity, float)), turns, dt)
