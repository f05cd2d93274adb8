"""What `measure/jump.py` measures of one jump: random wishes, and every figure of the poses that are played.

Nothing is read from a plan but when it takes off and touches down, and where it meant the balls of the feet.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import (Pose, centre_of_mass, contact_height, contact_points, detect_contacts, end_positions,
                                     foot_drift, forward_kinematics, hull, joint_limits, log, margin, segment_centres,
                                     sole_corners, wrap)
from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import Physique
from gambol.controllers.jump.motion import Plan
from gambol.controllers.locomotion import Locomotion
from gambol.game.scene import Box

FPS, FINE = 60, 240
BODIES = (  # name, mass [kg], height [m], strength, flexibility: least and most
    ("child", (22.0, 1.15, 0.75, 0.9), (40.0, 1.45, 1.0, 1.2)), ("adult", (55.0, 1.60, 0.8, 0.8), (85.0, 1.90, 1.2, 1.1)),
    ("heavy", (95.0, 1.65, 0.6, 0.7), (130.0, 1.90, 0.9, 0.9)))
PLANETS = (("Earth", 9.81), ("Moon", 1.62), ("Mars", 3.71), ("any", None))


@dataclass(frozen=True, eq=False)
class Trial:
    """One wish: whose, where, from what state, and what stands about."""

    jump: Jump
    state: CharacterState
    leap: Leap
    around: tuple[Box, ...]
    running: bool
    kind: str

    @property
    def intent(self) -> Intent:
        """What is asked."""
        return Intent(self.state.velocity, self.leap, self.around)


@dataclass(frozen=True, eq=False)
class Motion:
    """Poses at N times [s]: positions (N, J, 3), orientations (N, J, 3, 3), local rotations, centre of mass (N, 3)."""

    times: np.ndarray
    positions: np.ndarray
    orientations: np.ndarray
    local: np.ndarray
    centre: np.ndarray

    @staticmethod
    def of(jump: Jump, made: Plan, times) -> Motion:
        """What a plan shows at these times."""
        poses = [made.at(t) for t in times]
        return Motion.posed(jump, times, [p.root for p in poses], [p.rotations for p in poses])

    @staticmethod
    def posed(jump: Jump, times, roots, local) -> Motion:
        """What these poses are."""
        local = np.array(local, float)
        positions, orientations = forward_kinematics(jump.skeleton, np.array(roots, float), local)
        return Motion(np.asarray(times), positions, orientations, local,
                      centre_of_mass(jump.physique.anatomy, positions, orientations))


def starts(locomotion: Locomotion, rng: np.random.Generator, count: int) -> tuple[CharacterState, list[CharacterState]]:
    """The standard human at rest, and runners of many speeds at the moment in which they can leap."""
    jump, runners = Jump(), []
    rest = replace(locomotion.step(locomotion.start(), Intent(), 1 / FPS)[0], elapsed=0.0)
    for speed in rng.uniform(2.2, 3.2, count):
        state, wish = locomotion.start(), np.array([speed, 0.0, 0.0])
        for k in range(400):
            before = state
            state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
            state = replace(state, previous=before.pose, elapsed=1 / FPS)
            here = np.array([state.ground[0], 0.0, state.ground[1]])
            if k > 150 + 7 * len(runners) % 90 and jump.precondition(state, Intent(wish, Leap(here + [0.0, 0.0, 2.0]))) > 0.0:
                runners.append(moved(state, -here))
                break
    return rest, runners


def moved(state: CharacterState, way: np.ndarray) -> CharacterState:
    """The same state elsewhere."""
    pose, before = (p and Pose(p.root + way, p.rotations) for p in (state.pose, state.previous))
    return replace(state, pose=pose, previous=before, ground=state.ground + [way[0], way[2], 0.0],
                   floor=float(state.floor) + way[1])


def grown(state: CharacterState, factor: float) -> CharacterState:
    """The same state of a body so many times as large, at an equal Froude number."""
    pose, before = (p and Pose(p.root * factor, p.rotations) for p in (state.pose, state.previous))
    return replace(state, pose=pose, previous=before, ground=state.ground * [factor, factor, 1.0],
                   velocity=state.velocity * [factor**0.5, factor**-0.5, factor**0.5], elapsed=state.elapsed * factor**0.5)


def trial(rng: np.random.Generator, rest: CharacterState, runners: list[CharacterState]) -> Trial:
    """A random wish of the range that the issue names."""
    body = BODIES[rng.integers(len(BODIES))]
    physique = Physique(*(float(v) for v in rng.uniform(body[1], body[2])), sex=("male", "female")[rng.integers(2)])
    planet, pull = PLANETS[rng.integers(len(PLANETS))]
    gravity = np.array([0.0, -float(pull or rng.uniform(1.5, 15.0)), 0.0])
    running = bool(rng.random() < 0.5)
    state = grown(runners[rng.integers(len(runners))] if running else rest, physique.size)
    far, height = rng.uniform(0.0, 3.5 if running else 1.5), rng.uniform(-1.0, 0.5)
    around = ()
    if height > 0.0:  # a platform, its edge well before the feet
        around = (Box((0.0, 0.5 * height, far + 0.75), (3.0, height, 2.0)),)
    else:  # from a platform down to the ground
        state = moved(state, np.array([0.0, -height, 0.0]))
        around = (Box((0.0, -0.5 * height, -2.6), (3.0, -height, 6.0)),) if height < 0.0 else ()
    jump = Jump(physique, gravity)
    return Trial(jump, state, Leap(np.array([0.0, max(height, 0.0), far])), around, running,
                 f"{body[0]} on {planet}, {'running' if running else 'standing'}")


def possible(t: Trial) -> bool:
    """Whether energy alone allows the arc, with legs as strong and as long as this body's: never more than that.

    Whoever leaves with v over the push's way d has done ½ v² = (F/m − g) d at most; a runner brings
    his own ½ v². The least v to a place d away and h higher is v² = g (h + √(h² + d²)); feet may land
    ahead of the centre of mass and take off behind it, half a leg each.
    """
    g, size = -t.jump.gravity[1], t.jump.physique.size
    far = max(t.leap.place[2] - 0.9 * size, 0.0)
    up = t.leap.place[1] - float(t.state.floor) - 0.35 * size
    least = g * (up + np.hypot(up, far))
    force = 9.81 * t.jump.physique.strength * (4.2 if t.running else 3.1)
    most = 2.0 * max(force - g, 0.0) * 0.6 * size + float(t.state.velocity[0]) ** 2
    return bool(least <= most)


def result_of(t: Trial, made: Plan) -> dict[str, float]:
    """All figures of one jump, from its poses."""
    jump, physique = t.jump, t.jump.physique
    size = physique.size
    off, down, end = made.take_off, made.touch_down, min(made.duration, made.through)
    times = np.append(np.arange(0.0, end, 1 / FPS), end)
    seen = Motion.of(jump, made, times)
    out = {}
    # where it landed
    sole = contact_height(jump.skeleton)
    flat = Motion.of(jump, made, [end])
    heading = float(t.state.ground[2])
    # as soon as the soles are flat, or as it stands
    flat_at = Motion.of(jump, made, [min(down + 0.1, end), end])
    sides = [0, 1] if made.path.lands is None else [made.path.lands]
    middles = sole_corners(jump.skeleton, flat_at.positions, flat_at.orientations).reshape(2, 2, 6, 3)[:, sides][:, :, [0, 1, 4, 5]].mean((1, 2))
    out["miss cm"] = 100.0 * np.linalg.norm(middles[:1 if np.isfinite(made.through) else 2] - t.leap.place, axis=1).max()
    turns, tilts = [], []
    for side, sign in [(("Left", 1.0), ("Right", -1.0))[k] for k in sides]:
        foot = flat.orientations[0, jump.skeleton.index(side + "Foot")]
        yaw = wrap(np.arctan2(foot[0, 2], foot[2, 2]) - heading - sign * 0.08)
        turns.append(abs(yaw))
        tilts.append(np.arccos(np.clip(foot[1, 1], -1.0, 1.0)))
    out["turn deg"], out["tilt deg"] = np.degrees(max(turns)), np.degrees(max(tilts))
    still = np.linalg.norm(seen.centre[-1] - seen.centre[-4]) / (times[-1] - times[-4])
    out["through"] = bool(np.isfinite(made.through))
    out["speed at the end"] = 0.0 if out["through"] else still
    # take-off: from the poses of the last three 1/240 s on the floor, and by a parabola through the flight
    h = 1 / FINE
    c = Motion.of(jump, made, off - h * np.array([0.0, 1.0, 2.0])).centre
    leaving = (3.0 * c[0] - 4.0 * c[1] + c[2]) / (2.0 * h)
    fine = np.arange(off, down, h)
    air = Motion.of(jump, made, fine)
    s = fine - off
    straight = air.centre - 0.5 * jump.gravity * s[:, None] ** 2
    flown = np.polyfit(s, straight, 1)[0]
    wished = made.path.velocity
    out["take-off before %"] = 100.0 * np.linalg.norm(leaving - wished) / np.linalg.norm(wished)
    out["take-off flown %"] = 100.0 * np.linalg.norm(flown - wished) / np.linalg.norm(wished)
    out["off the parabola mm"] = 1000.0 * np.abs(straight - straight[0] - flown * s[:, None]).max()
    # flight: at the plan's own moments, where nothing is interpolated
    own = made.times[(made.times >= off - 1e-9) & (made.times <= down + 1e-9)]
    out |= flight(jump, Motion.of(jump, made, own))
    # balance while it stands, before take-off
    grounded = Motion.of(jump, made, np.arange(0.0, off - 1e-9, 1 / FINE))
    low = sole_corners(jump.skeleton, grounded.positions, grounded.orientations)
    inside = []
    for place, centre in zip(low, grounded.centre):
        on = place[:, 1] < float(t.state.floor) + 0.02 * size
        inside.append(100.0 * float(margin(hull(place[on][:, [0, 2]]), centre[[0, 2]])))
    out["margin cm"] = 0.0 if t.running else min(inside)
    out["wind-up margin cm"] = 0.0 if t.running else min(inside[:int(0.7 * made.push_off * FINE)])
    out |= ground(t, made)
    # feet
    out |= feet(t, made, seen, sole)
    # joints
    limits = joint_limits(jump.skeleton)
    vectors = log(seen.local)
    over = np.maximum(vectors - limits.upper, limits.lower - vectors)
    out["beyond limits deg"] = np.degrees(max(over.max(), 0.0))
    out["joint beyond"] = jump.skeleton.names[int(np.unravel_index(over.argmax(), over.shape)[1])] if over.max() > 1e-6 else ""
    out["frames beyond %"] = 100.0 * (over.max((1, 2)) > np.radians(0.1)).mean()
    speed = np.linalg.norm(log(np.swapaxes(seen.local[:-2], -1, -2) @ seen.local[1:-1]), axis=-1) * FPS
    for name in ("UpLeg", "Leg", "Foot"):
        ids = [jump.skeleton.index(side + name) for side in ("Left", "Right")]
        out[f"{name} rad/s"] = speed[:, ids].max()
    return out


def flight(jump: Jump, air: Motion) -> dict[str, float]:
    """Energy of the centre of mass and angular momentum about it, over a flight of even steps."""
    h = air.times[1] - air.times[0]
    g = -jump.gravity[1]
    # central differences: exact for a parabola
    velocity = (air.centre[2:] - air.centre[:-2]) / (2.0 * h)
    energy = 0.5 * (velocity**2).sum(-1) + g * (air.centre[1:-1, 1] - air.centre[0, 1])
    momentum = angular(jump, air)
    drift = np.linalg.norm(momentum - momentum[0], axis=-1).max()
    return {"energy drift": np.abs(energy - energy[0]).max() / abs(energy[0]),
            "momentum drift": drift / max(np.linalg.norm(momentum[0]), 1e-9)}


def angular(jump: Jump, seen: Motion) -> np.ndarray:
    """The angular momentum (N − 1, 3) [kg m²/s] about the centre of mass between N moments."""
    anatomy, step = jump.physique.anatomy, np.diff(seen.times)[:, None, None]
    places = segment_centres(anatomy, seen.positions, seen.orientations) - seen.centre[:, None]
    turned = seen.orientations[:, anatomy.joints]
    mid, rate = 0.5 * (places[1:] + places[:-1]), np.diff(places, axis=0) / step
    spin = log(turned[1:] @ np.swapaxes(turned[:-1], -1, -2)) / step
    middle = 0.5 * (turned[1:] + turned[:-1])
    own = np.einsum("tsij,sjk,tslk,tsl->tsi", middle, anatomy.inertias, middle, spin)
    return (anatomy.masses[:, None] * np.cross(mid, rate) + own).sum(1)


def ground(t: Trial, made: Plan) -> dict[str, float]:
    """Which force F = m (c̈ − g) the ground gives by the poses, and from where, before take-off and after touch-down.

    The centre of pressure is told twice: of the centre of mass alone, and with the moment that turning limbs take. Where
    hardly anything stands (a third of the weight) it is not.
    """
    jump, out = t.jump, {"pull %": 0.0, "friction": 0.0}
    mass, g = jump.physique.mass, -float(jump.gravity[1])
    for part, first, last, floor in (("push", 0.0, made.take_off, float(t.state.floor)),
                                     ("landing", made.touch_down, min(made.through, made.duration), float(t.leap.place[1]))):
        seen = Motion.of(jump, made, made.times[(made.times >= first - 1e-9) & (made.times <= last + 1e-9)])
        before, after = (step[:, None] for step in (np.diff(seen.times)[:-1], np.diff(seen.times)[1:]))
        c = seen.centre
        bent = 2.0 * (after * c[:-2] - (before + after) * c[1:-1] + before * c[2:]) / (before * after * (before + after))
        force = mass * (bent - jump.gravity)
        out["pull %"] = max(out["pull %"], -100.0 * force[:, 1].min() / (mass * g))
        held = force[:, 1] > 0.33 * mass * g
        c, force = c[1:-1][held], force[held]
        out["friction"] = max(out["friction"], float((np.linalg.norm(force[:, [0, 2]], axis=1) / force[:, 1]).max(initial=0.0)))
        moment = (np.diff(angular(jump, seen), axis=0) / (0.5 * (before + after)))[held]
        pressed = (c - force / force[:, 1:2] * (c[:, 1:2] - floor))[:, [0, 2]]
        turned = pressed + np.stack([moment[:, 2], -moment[:, 0]], 1) / force[:, 1:2]
        corners = sole_corners(jump.skeleton, seen.positions, seen.orientations)[1:-1][held]
        far = []
        for place, alone, whole in zip(corners, pressed, turned):
            on = place[place[:, 1] < floor + 0.03 * jump.physique.size]
            if len(on) > 2:
                shape = hull(on[:, [0, 2]])
                far.append([-100.0 * float(margin(shape, alone)), -100.0 * float(margin(shape, whole))])
        if far:
            far = np.array(far)
            out[f"{part} off soles cm"] = far[:, 0].max()
            out[f"{part} with limbs cm"] = np.percentile(far[:, 1], 75)
    return {f"{part} {kind} cm": 0.0 for part in ("push", "landing") for kind in ("off soles", "with limbs")} | out


def feet(t: Trial, made: Plan, seen: Motion, sole: float) -> dict[str, float]:
    """Drift and depth of planted heels, balls and toes' ends, at 60 Hz."""
    skeleton = t.jump.skeleton
    points = contact_points(skeleton, seen.positions, seen.orientations)
    tips = end_positions(skeleton, seen.positions, seen.orientations)[
        :, [skeleton.end_index["LeftToe"], skeleton.end_index["RightToe"]]]
    before, after = seen.times <= made.take_off, seen.times >= made.touch_down
    floor = np.where(after, t.leap.place[1], float(t.state.floor))
    lowest = np.minimum(points[..., 1].min(-1), tips[..., 1].min(-1)) - floor
    says = made.contacts[np.clip(np.searchsorted(made.times, seen.times + 1e-9) - 1, 0, len(made.times) - 1)]
    says = says & (before | after)[:, None]
    step = np.diff(points, axis=0, append=points[-1:]) * FPS
    found = detect_contacts(points[..., 1] - floor[:, None], np.linalg.norm(step, axis=-1), height_gate=sole + 0.01, release=1.0)
    found &= (before | after)[:, None]
    drifts = []
    for standing in (says, found):
        stances = foot_drift(points, standing)
        drifts.append(100.0 * stances.drift[stances.stop - stances.start >= 4].max(initial=0.0))
    return {"drift said cm": drifts[0], "drift seen cm": drifts[1],
            "depth before cm": 100.0 * max(0.0, sole - lowest[before].min()),
            "depth after cm": 100.0 * max(0.0, sole - lowest[after].min())}
