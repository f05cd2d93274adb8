"""A first pose by hand: where joints are seen in a frame of each camera, and the body, its stature with it, that has them there."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from ..body import STATURE, Skeleton, human
from ..files import printable, reason, tables as read_tables
from .cameras import Lens
from .twists import Chain, Configuration, chain_of, posed, retract_kernel

Clicks = Mapping[str, Mapping[str, tuple[float, float]]]
"""Camera → joint → pixel."""
FEWEST = 6
"""So many joints have to be seen by two cameras."""
CARELESS, LOOSE = 0.01, 0.8
"""How far off a click is, over the picture's height, and how far joints are from rest [rad], where nothing else is known."""
SHORTEST, TALLEST = 1.0, 2.4
"""Of bodies [m]."""
ASTRAY, SLIP = 0.03, 0.15
"""So far off a body that has joints where they were clicked, over the picture's height, are clicks that tell no body, by their median, and a
single one that slipped. Of clicks by hand the median is 0.007, the worst 0.03; of those 25 % too far apart it is 0.04."""
LIMBS = (("Arm", "ForeArm"), ("ForeArm", "Hand"), ("UpLeg", "Leg"), ("Leg", "Foot"), ("Foot", "Toe"))
"""Bones of either side, from the trunk outwards."""
ACROSS, BACKWARD = 0.05, 0.04
"""Elbows, or knees and feet, that are so far [m] on each other's side are crossed; knees that bend and toes that point so far [m] backward are nobody's."""


class ClickError(ValueError):
    """Clicks that say nothing sound: the file and the field."""


def read_clicks(path: str | Path, lenses: Sequence[Lens], skeleton: Skeleton | None = None) -> Clicks:
    """A .toml file with a table for each camera, `LeftArm = [x, y]` in pixels of pictures that are `width` wide, else of its own
    size. ClickError, in one line."""
    path, skeleton = Path(path), skeleton or human()
    try:
        tables = read_tables(path)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as fault:
        raise ClickError(f"{path}: {reason(fault) if isinstance(fault, OSError) else printable(str(fault))}") from None
    known, width = {lens.name: lens.size for lens in lenses}, tables.pop("width", None)
    if width is not None and not (type(width) is int and 16 <= width <= 16384):
        raise ClickError(f"{path}: width: needs a whole number of pixels")
    made: dict[str, dict[str, tuple[float, float]]] = {}
    for camera, table in tables.items():
        if camera not in known:
            raise ClickError(f"{path}: [{printable(camera)}]: there is no such camera; there are {', '.join(known)}")
        wide, high = known[camera]
        share = 1.0 if width is None else wide / width
        made[camera] = {}
        for joint, at in table.items() if isinstance(table, dict) else ():
            if joint not in skeleton:
                raise ClickError(f"{path}: {camera}.{printable(joint)}: there is no such joint; there are {', '.join(skeleton.names)}")
            if not (isinstance(at, list) and len(at) == 2 and all(isinstance(v, int | float) and abs(v) < 1e5 for v in at)):
                raise ClickError(f"{path}: {camera}.{joint}: needs x and y in pixels")
            if not (0 <= at[0] <= wide / share and 0 <= at[1] <= high / share):
                raise ClickError(f"{path}: {camera}.{joint}: {at} is beside a picture of {wide / share:.0f} × {high / share:.0f}; "
                                 "width says how wide the pictures were that were clicked in")
            made[camera][joint] = (share * at[0], share * at[1])
    return made


def clicked(lenses: Sequence[Lens], clicks: Clicks, freedom: str = "full") -> tuple[Chain, Configuration]:
    """The chain of a body of its stature and its pose that have joints where they were clicked.

    ClickError where fewer than `FEWEST` joints were seen by two cameras, hips and shoulders among them, and for clicks that no body has.
    """
    skeleton = human()
    seen = [(lens, skeleton.index(joint), np.array(at, float)) for lens in lenses for joint, at in clicks.get(lens.name, {}).items()]
    places = {j: place for j in {j for _, j, _ in seen} if (place := _crossing([(lens, at) for lens, k, at in seen if k == j])) is not None}
    four = [skeleton.index(name) for name in ("LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm")]
    if len(places) < FEWEST or not set(four) <= set(places):
        raise ClickError(f"{len(places)} joints are seen by two cameras; it needs {FEWEST}, hips and shoulders among them")
    left, right, one, other = (places[j] for j in four)
    up = 0.5 * (one + other) - 0.5 * (left + right)
    across = left - right
    across -= up * (across @ up) / (up @ up)
    x, y = across / np.linalg.norm(across), up / np.linalg.norm(up)
    start = np.eye(4)
    start[:3, :3] = np.stack([x, y, np.cross(x, y)], 1)
    start[:3, 3] = 0.5 * (left + right)
    chain = chain_of(skeleton, freedom)  # type: ignore[arg-type]
    lower, upper = chain.lower, chain.upper
    rest = np.clip(np.zeros(len(chain)), lower, upper)

    def unpacked(x: np.ndarray) -> tuple[Configuration, float]:
        root, angles = start.copy(), rest.copy()
        root[:3, :3] = Rotation.from_rotvec(x[3:6]).as_matrix() @ start[:3, :3]
        root[:3, 3] += x[:3]
        step = np.concatenate([np.zeros(6), x[6:-1]])
        retract_kernel(chain.first, chain.count, step, np.eye(4), angles, lower, upper)
        return Configuration(root, angles), float(np.exp(x[-1]))

    def away(x: np.ndarray) -> np.ndarray:
        """(n, 2) how far clicks are from the body's joints, over their pictures' heights."""
        pose, size = unpacked(x)
        positions = posed(chain, pose)[0]
        positions = positions[0] + size * (positions - positions[0])
        return np.array([(lens.project(positions[j])[0] - at) / lens.size[1] for lens, j, at in seen])

    def residuals(x: np.ndarray) -> np.ndarray:
        return np.concatenate([np.ravel(away(x)) / CARELESS, x[6:-1] / LOOSE, [x[-1] / 0.1]])
    found = least_squares(residuals, np.zeros(7 + len(chain)), loss="soft_l1", max_nfev=60)
    off = np.linalg.norm(away(found.x), axis=1)
    lens, joint, _ = seen[int(off.argmax())]
    if np.median(off) > ASTRAY:
        raise ClickError(f"no body has joints where they were clicked: half of them are {np.median(off) * lens.size[1]:.0f} pixels off or more; "
                         "were they clicked in pictures so wide, of these cameras?")
    if off.max() > SLIP:
        raise ClickError(f"{lens.name}.{skeleton.names[joint]} is {off.max() * lens.size[1]:.0f} pixels from where the other clicks have it")
    pose, size = unpacked(found.x)
    body = chain_of(human(float(np.clip(STATURE * size, SHORTEST, TALLEST))), freedom)  # type: ignore[arg-type]
    return body, pose


def exchanged(lenses: Sequence[Lens], clicks: Clicks) -> list[str]:
    """What makes left and right seem exchanged by whoever clicked, in words: of a camera where its rays miss the others', of all where bones or bends
    are nobody's. A person may stand so after all; who is seen to bend or turn nothing may be exchanged unseen."""
    rays = {camera: {joint: (lens, np.array(at, float)) for joint, at in clicks.get(camera, {}).items()} for camera, lens in ((one.name, one) for one in lenses)}
    lines = []
    for part in sorted({joint[4:] for seen in rays.values() for joint in seen if joint.startswith("Left")}):
        left, right = f"Left{part}", f"Right{part}"
        both = [camera for camera, seen in rays.items() if left in seen and right in seen]
        if not (wrong := _exchanged_in([(rays[one][left], rays[one][right]) for one in both])):
            continue
        for camera in (both[one] for one in wrong):
            rays[camera][left], rays[camera][right] = rays[camera][right], rays[camera][left]

        where = ", ".join(both[one] for one in wrong) if 2 * len(wrong) < len(both) else "in some cameras"
        lines.append(f"{where}: {left} and {right} seem exchanged")
    if lines:  # which once mended leave little else
        return lines
    at = {}
    for joint in {joint for seen in rays.values() for joint in seen}:
        if (place := _crossing([seen[joint] for seen in rays.values() if joint in seen])) is not None:
            at[joint] = place
    return list(_twisted(at))


def _exchanged_in(pairs: Sequence[tuple[tuple[Lens, np.ndarray], tuple[Lens, np.ndarray]]]) -> list[int]:
    """In which of the cameras left and right have to be exchanged for their rays to meet, the fewer; none where they meet, or never do."""
    def miss(flips: Sequence[bool]) -> float:
        sides = zip(*((right, left) if flip else (left, right) for flip, (left, right) in zip(flips, pairs)), strict=True)
        return max(_miss(side) for side in sides)
    if len(pairs) < 2 or (now := miss([False] * len(pairs))) < ASTRAY:
        return []
    some = product([False, True], repeat=len(pairs) - 1) if len(pairs) <= 8 else np.eye(len(pairs), dtype=bool)[:, 1:].tolist()
    best = min(([False, *flips] for flips in some), key=miss)
    if miss(best) > 0.5 * now:
        return []
    wrong = [number for number, flip in enumerate(best) if flip]
    return wrong if 2 * len(wrong) <= len(pairs) else [number for number, flip in enumerate(best) if not flip]


def _miss(rays: Sequence[tuple[Lens, np.ndarray]]) -> float:
    """How far rays miss the place that is nearest to all, over their pictures' heights."""
    place = _crossing(rays)
    return 0.0 if place is None else max(float(np.linalg.norm(lens.project(place)[0] - at)) / lens.size[1] for lens, at in rays)


def _twisted(at: Mapping[str, np.ndarray]) -> Iterator[str]:
    """What no body has of joints at places (3,) [m]: left and right exchanged for all cameras."""
    skeleton = human()

    def there(*parts: str) -> bool:
        return all(side + part in at for side in ("Left", "Right") for part in parts)

    def over(one: str, other: str) -> np.ndarray:
        return at[other] - at[one]
    if not there("UpLeg", "Arm"):
        return
    size = float(np.median([np.linalg.norm(over(side + upper, side + lower)) / np.linalg.norm(skeleton.offsets[skeleton.index(side + lower)])
                            for upper, lower in LIMBS if there(upper, lower) for side in ("Left", "Right")] or [1.0]))
    hips, shoulders = over("RightUpLeg", "LeftUpLeg"), over("RightArm", "LeftArm")
    up = 0.5 * (at["LeftArm"] + at["RightArm"] - at["LeftUpLeg"] - at["RightUpLeg"])
    up /= np.linalg.norm(up)
    across = hips - up * (hips @ up)
    across /= np.linalg.norm(across)
    ahead = np.cross(across, up)
    if shoulders @ across < 0.0:
        yield "LeftArm and RightArm, or LeftUpLeg and RightUpLeg, seem exchanged: the trunk is turned round between them"
        return
    for upper, lower in LIMBS[:4]:
        if not there(upper, lower):
            continue
        bone = size * float(np.linalg.norm(skeleton.offsets[skeleton.index("Left" + lower)]))
        own, crossed = (max(abs(float(np.linalg.norm(over("Left" + upper, one + lower))) - bone), abs(float(np.linalg.norm(over("Right" + upper, other + lower))) - bone))
                        for one, other in (("Left", "Right"), ("Right", "Left")))
        if own > 0.3 * bone and crossed < 0.5 * own:
            yield f"Left{lower} and Right{lower} seem exchanged: to them it is {100 * own:.0f} cm more or less than bones are long"
            return
    for upper, lower in (("ForeArm", "ForeArm"), ("Leg", "Foot")):
        if there(upper, lower) and all(over("Right" + part, "Left" + part) @ across < -ACROSS * size for part in (upper, lower)):
            yield f"Left{upper} and Right{upper} seem exchanged, and what is below them: each is on the other's side"
            return
    backward = [-float(over(side + "Foot", side + "Toe") @ ahead) for side in ("Left", "Right") if there("Foot", "Toe")]
    backward += [-float((at[side + "Leg"] - 0.5 * (at[side + "UpLeg"] + at[side + "Foot"])) @ ahead) for side in ("Left", "Right") if there("Leg", "Foot")]
    if backward and sum(backward) > BACKWARD * size * len(backward):
        yield "all of left and right seems exchanged: knees bend and toes point backward"


def _crossing(rays: Sequence[tuple[Lens, np.ndarray]]) -> np.ndarray | None:
    """The place (3,) [m] that is nearest to pixels' rays; None of a single one."""
    if len(rays) < 2:
        return None
    matrix, vector = np.zeros((3, 3)), np.zeros(3)
    for lens, at in rays:
        along = lens.directions(at)
        across = np.eye(3) - np.outer(along, along)
        matrix += across
        vector += across @ lens.eye
    return np.linalg.solve(matrix + 1e-9 * np.eye(3), vector)
