"""What a walking character remembers, and what one may tune.

A character's memory is one record of a structured array, so a crowd is a longer array, and
keeping, copying or rewinding a state is copying a record.
"""

from __future__ import annotations

from typing import Any, NamedTuple, SupportsFloat

import numpy as np

from ..body import compose, contact_height, contact_points, end_positions, exp, forward_kinematics, relative
from .fourier import evaluate
from .kernel import COLUMNS
from .library import HIPS, Library

WALK, RUN = 0, 1
"""Gait families, as memory and kernels number them."""
ABOUT, ASKS = 1, 2
"""Somebody is alert who is about to leap, or who asks for a leap."""
PATH = 48
"""Phases of a cycle at which the feet of primitives are looked up."""


class Settings(NamedTuple):
    """What one may tune. Times in seconds, lengths in metres, speeds in m/s.

    agility: what legs can do beside a person's, whose number is 1: how fast a wish is taken up and
    how hard legs may push both grow with it. command_halflife: how fast a wish is taken up.
    acceleration: the most legs push [m/s²], also around a curve; turning may change by four times
    that number [rad/s²]. weight_halflife: smoothing of the blend's weights. switch_halflife: of the
    hand-over between walking and running, for which wishes above run_above and below walk_below
    ask. correct: fixed-point corrections of the query.
    footing: whether feet are held. clearance: how high feet swing at least. breath: how deeply a
    body at rest breathes: how far the chest turns [rad], while the hips sway 0.3 m for each rad.
    idle: how much somebody who stands shifts weight, glances and moves, as recorded; 0 not at all.
    gaze: how far a head turns to where its body goes or to what it is told to look at; 0 not at all.
    """

    agility: float = 1.0
    command_halflife: float = 0.22
    acceleration: float = 4.0
    weight_halflife: float = 0.08
    switch_halflife: float = 0.18
    run_above: float = 1.85
    walk_below: float = 1.70
    correct: int = 3
    footing: bool = True
    clearance: float = 0.018
    breath: float = 0.012
    idle: float = 1.0
    gaze: float = 1.0


DIVIDING = ("agility", "acceleration", "weight_halflife")
"""Of these a step takes shares."""


def plain(settings: Settings) -> Settings:
    """The same settings, each of its own kind of number: kernels are compiled anew for any other, 1 for 1.0. ValueError for one that
    is no number, or that no body moves by."""
    if not isinstance(settings, Settings):
        raise ValueError(f"settings are Settings, such as Settings(agility=2.0); got {settings!r}")
    for name, value in settings._asdict().items():
        if isinstance(value, str) or np.ndim(value) or not isinstance(value, SupportsFloat):
            raise ValueError(f"{name} must be one number, got {value!r}")
    same = Settings._make(type(usual)(value) for usual, value in zip(Settings(), settings))
    for name, value in same._asdict().items():
        if np.isnan(value) or np.isinf(value) and name != "run_above" or value <= 0.0 and name in DIVIDING:
            raise ValueError(f"{name} must be a finite number{' over 0' * (name in DIVIDING)}, got {value}")
    return same


class Legs(NamedTuple):
    """What the step must know of body and library: joint numbers (hip: (2,), left and right;
    head: (2,), neck and head; shoulder, elbow: (2,)), the height of standing heels and balls [m], the number of the rest primitive, and
    where its contact points are along the floor (4, 2), x, z in the ground frame [m]; and where heel, ball and toe's end of both feet of every
    primitive are at phases of its cycle, paths (P, PATH, 6, 3), likewise. bent: (3, 2) [rad] how a runner's elbows are turned on the whole."""

    hip: np.ndarray
    chest: int
    neck: int
    shoulder: np.ndarray
    elbow: np.ndarray
    height: float
    rest: int
    stance: np.ndarray
    paths: np.ndarray
    bent: np.ndarray


def legs_of(library: Library) -> Legs:
    """What the step must know of a library."""
    at = library.skeleton.index
    elbow = np.array([at("LeftForeArm"), at("RightForeArm")])
    return Legs(np.array([at("LeftUpLeg"), at("RightUpLeg")]), at("Spine2"), at("Neck"),
                np.array([at("LeftShoulder"), at("RightShoulder")]), elbow, contact_height(library.skeleton), library.rest, _stance(library), _paths(library), _bent(library, elbow))


def _bent(library: Library, elbow: np.ndarray) -> np.ndarray:
    """How joints are turned in the middle of its runs' cycles (3, 2) [rad]; at rest, if it has none."""
    runs = library.family("run")
    means = library.coefficients[runs if len(runs) else [library.rest], 0, :HIPS].reshape(max(len(runs), 1), -1, 3)
    return np.ascontiguousarray(means.mean(0)[elbow].T, float)


def _stance(library: Library) -> np.ndarray:
    """Where heels and balls are at rest (4, 2): x, z in the ground frame [m]."""
    row = library.coefficients[library.rest, 0]
    local = library.reference @ exp(row[:HIPS].reshape(-1, 3))
    points = contact_points(library.skeleton, *forward_kinematics(library.skeleton, row[HIPS:HIPS + 3], local))
    return np.ascontiguousarray(points[:, [0, 2]], float)


def _paths(library: Library) -> np.ndarray:
    """Where heels, balls and toes' ends of every primitive are at PATH phases of its cycle (P, PATH, 6, 3) [m], left foot first, in the ground frame."""
    rows = evaluate(np.asarray(library.coefficients, float), np.arange(PATH) / PATH)
    local = library.reference @ exp(rows[..., :HIPS].reshape(*rows.shape[:2], -1, 3))
    placed = forward_kinematics(library.skeleton, rows[..., HIPS:HIPS + 3], local)
    points, ends = contact_points(library.skeleton, *placed), end_positions(library.skeleton, *placed)
    at = library.skeleton.end_index
    feet = [np.stack([points[..., 2 * n, :], points[..., 2 * n + 1, :], ends[..., at[side + "Toe"], :]], -2) for n, side in enumerate(("Left", "Right"))]
    return np.ascontiguousarray(np.concatenate(feet, -2), np.float32)


def walks(memory: Any) -> bool:
    """Whether what a character remembers is a walker's, as `memory_dtype` has it."""
    return isinstance(memory, np.ndarray | np.void) and {"family", "settled", "weights"} <= set(memory.dtype.names or ())


def memory_dtype(primitives: int) -> np.dtype:
    """The record of one character over a library of that many primitives.

    There is room for the next multiple of 128, since kernels are compiled anew for every width: one
    serves most libraries. The four contact points are left heel, left ball, right heel, right ball; feet are left, right.
    """
    return np.dtype([
        ("library", "u4"),  # the checksum of the library that the weights are of
        ("ground", "f8", 3),  # x, z [m], θ [rad]
        ("velocity", "f4", 3),  # achieved (v_f, ω, v_l)
        ("command", "f4", 3), ("rate", "f4", 3), ("asked", "f4", 3),  # the shaped wish, its rate, and what it goes to
        ("family", "i4"), ("wanted", "i4"),  # WALK or RUN: what is, and what the wish asks for
        ("simplex", "i4", 2), ("stretch", "f4"),  # last simplex in each one's space; the command over what its gaits reach
        ("weights", "f4", -(-primitives // 128) * 128), ("led", "f4", -(-primitives // 128) * 128), ("phase", "f4"),  # the blend's, and those that they follow
        ("settled", "i4"),  # at rest, both feet in place
        ("drift", "f4", 2),  # lateral, forward: what standing feet say beyond the nominal velocity
        ("points", "f4", (4, 3)),  # the blend's contact points in the ground frame
        ("grip", "f4", 4),  # how firmly each point is held: 0 free … 1
        ("stood", "f8", (4, 2)), ("standing", "i4", 4), ("torn", "i4", 2),  # where each point was held, x, z in the world; whether it stands; feet let go until well into their swing
        ("raised", "f4", 4), ("raised_rate", "f4", 4),  # points' heights, shown minus blended
        ("offset", "f4", (2, 3)), ("offset_rate", "f4", (2, 3)), ("offset_push", "f4", (2, 3)),  # each foot's x, z in the world and turn, shown minus blended; its speed and acceleration
        ("base", "f8", 2), ("climb", "f8", 2), ("tilt", "f8", (2, 2)),  # the ground under each foot over the floor, how fast that goes up, how it rises along x and z
        ("left", "f8", 2), ("left_at", "f8", (2, 2)),  # the ground it left, and where, x, z in the world
        ("held", "i4", 2), ("land", "f8", (2, 2)),  # whether it found its own; how far from where the blend does it comes down
        ("aim", "f8", (2, 5)), ("aimed", "i4", 2), ("kept", "i4", 2),  # where each foot will come down, x, z in the world, and the ground there; whether that is certain; whether the ground kept it from where it was to
        ("coming", "f8", (2, 2, 2)),  # where heel and ball of each foot of the blend come down, x, z in the world
        ("pace", "f4"), ("runner", "f4"), ("most", "f4"), ("stairs", "f4"), ("brink", "f4"), ("wished", "f4", 2),  # the share of the wished speed that short steps leave; how much of a runner he is on stairs; the most [m/s] that the ground ahead allows, 0 if all; likewise, but of stairs that it stands on, in every direction; how far ahead the ground ends of who has let go [m], 0 where it does not; the wish, to the left and ahead [m/s]
        ("high", "f8", 2), ("off", "i4", 4),  # how high the ground that each foot is led on lies over where it comes down; which points are shown off the ground
        ("level", "f8"), ("level_rate", "f8"), ("middle", "f8"), ("lower", "f8"),  # how high the body's own plane lies over the floor, and between its feet; how much lower it is to stand for its heels to
        ("anchor", "f4", 2),  # how much each foot hangs on its ball rather than its heel
        ("aside", "f4", (2, 2)), ("aside_rate", "f4", (2, 2)),  # how each foot gives way to the other, x, z in the world
        ("swing", "f4", 2),  # how far each foot had to go when it left
        ("lift", "f4", 2), ("lift_rate", "f4", 2),  # how high each foot is held over the floor
        ("rise", "f4", 2), ("rise_rate", "f4", 2),  # how far each heel is lifted to give its leg length [rad]
        ("bears", "f4", 2), ("bears_rate", "f4", 2),  # how far each ball bears, or has just borne
        ("toe", "f4", 2), ("toe_rate", "f4", 2),  # how far the floor has bent each foot's toes, or had just now [rad]
        ("taut", "f4", 2),  # how firmly each leg is held straight, or was until just now
        ("lent", "f4", 2), ("lent_rate", "f4", 2),  # how free each heel is to rise, for its knee to bend as the blend's
        ("pelvis", "f4"), ("pelvis_rate", "f4"),  # how far short legs have lowered the pelvis
        ("row", "f4", COLUMNS), ("row_rate", "f4", COLUMNS),  # the blended series and its rate
        ("blend", "f4", COLUMNS), ("blend_rate", "f4", COLUMNS),  # inertialisation after a switch
        ("fade", "f4"),  # its half-life [s]
        ("breath", "f4"),  # phase of breathing
        ("stop", "f4"), ("steep", "f4"), ("quick", "f4"), ("waits", "i4"),  # how much phase is left until the strike that ends a walk, how it slows down until then, how many times as fast as usual it steps; whether both feet wait after it
        ("halt", "f8", 3), ("halts", "i4"),  # where to come to rest, x, z in the world, heading or NaN; whether there is such a place, and he stops for it
        ("onset", "f4"), ("first", "i4"), ("shares", "f4", 2), ("shares_rate", "f4", 2),  # how much phase of a start is left, its first foot, how far it shows, and how fast that changes
        ("heads", "i4"), ("towards", "f8", 2),  # whether it is told which heading and speed it is to have in the end, and these
        ("turn", "f4"), ("turned", "f4"), ("turn_gain", "f4"), ("turn_haste", "f4"), ("turn_goes", "f4"), ("turn_stretch", "f4"),  # how far it turns in steps of their own, 0 for none; where in its phase that is; over what is fitted; how far (0 … 1) its second step is a runner's; how fast [m/s] one goes after it; how many times as long its strides come to be
        ("stray", "f8", 2), ("spot", "i4"), ("turns_to", "f8"), ("turn_ends", "f8"), ("left_turn", "i4"), ("glide", "f8", 2), ("backs", "i4"), ("corner", "f4"), ("corner_rate", "f4"),  # whether on the spot; the heading it was told, that it ends with; whether it has just been left; what is left of the walk before it, x, z in the world [m/s]; to which side he turns back who brakes for it, 1 left, -1 right; how far his pose takes a corner
        ("rested", "f4"), ("presence", "f4"), ("presence_rate", "f4"),  # how long it has stood [s], how far its idling shows
        ("moment", "f4"), ("luck", "u4"), ("alert", "i4"), ("cramped", "i4"),  # where in the recorded idling it is, and what comes next; whether walls leave arms or feet no room
        ("looks", "i4"), ("look", "f4", 3),  # whether there is a place to look at, and which
        ("gaze", "f4", 2), ("gaze_rate", "f4", 2),  # how far the head turns and nods
        ("braked", "f4", 2),  # how far the trunk leans against its braking, and how fast
        ("felt", "i4"), ("mass", "f8", 3), ("mass_rate", "f8", 3), ("pull", "f4", 3), ("went", "f8", 2), ("walled", "i4"), ("lag", "f8", 2), ("lag_rate", "f8", 2),  # for how many steps it is told where the mass centre is off the ground frame, along the world's axes [m], how fast and how hard it goes there; how fast the ground frame went; whether walls slow it down; how far [m] it lags behind its command, x, z in the world, and how fast that changes
        ("ran", "f4"), ("carried", "f4", 2),  # how lately it ran (0 … 1), how far its elbows are carried bent for it, and how fast that changes
    ], align=True)


def put(memory: np.ndarray, ground: np.ndarray) -> None:
    """Carry characters (...), in place, to other ground frames (..., 3), with all that they know in the world."""
    there, here = ground[..., None, :], memory["ground"][..., None, :]
    turn = (there - here) * [0.0, 0.0, 1.0]
    for name, axes in (("offset", [0, 1]), ("offset_rate", [0, 1]), ("offset_push", [0, 1]), ("land", [0, 1]), ("aside", [0, 1]), ("aside_rate", [0, 1])):
        memory[name][..., axes] = compose(turn, _flat(memory[name][..., axes]))[..., :2]
    for name in ("stood", "left_at", "coming"):
        memory[name] = _carried(memory[name], memory["ground"], ground)
    memory["halts"] = memory["felt"] = 0
    memory["lag"] = memory["lag_rate"] = 0.0
    memory["ground"], memory["aimed"] = ground, 0


def _carried(places: np.ndarray, here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Places (..., K, 2) or (..., 2, K, 2) x, z in the world, as seen from one ground frame (..., 3), seen from another."""
    shape = places.shape
    flat = places.reshape(here.shape[:-1] + (-1, 2))
    return compose(there[..., None, :], relative(here[..., None, :], _flat(flat)))[..., :2].reshape(shape)


def _flat(places):
    """Places (..., 2) x, z as ground frames of heading 0."""
    return np.concatenate([places, np.zeros(places.shape[:-1] + (1,))], -1)
