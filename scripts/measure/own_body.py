"""Measure how deep arms come into the body's own trunk and legs, on bodies of several builds, as they are drawn.

    python scripts/measure/own_body.py [--bodies NAME ...] [--character FILE ...]

Forearms and hands are the skin that hangs on them; what they may not be in is the skin of trunk, pelvis and thighs, posed by the same motion. Whether a place is inside is told
by the solid angle under which that skin is seen from there (the generalised winding number), and how deep by the nearest place on it. Ten motions, five frames a second.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.person import person
from gambol.game.character import Build, load, tailored
from gambol.game.render import Body, mannequin, scale_of, skin, worn

RATE, EVERY = 60, 12
"""Steps a second, and every which of them is looked at."""
BUILDS = {"usual": None, "slim": Build(weight=-1.0), "heavy": Build(weight=1.0), "heavy, broad hips": Build(weight=1.0, hips=1.2),
          "narrow shoulders": Build(shoulders=0.85, hips=1.1), "child of six": Build(height=1.2, child=1.0)}
DEEP = 0.02
"""Frames are counted in which skin is deeper than this [m]."""
DEEPEST = 0.15
"""What is farther from all skin than this [m] is outside."""
ARMS = "ForeArm", "Hand"
TRUNK = "Hips", "Spine", "Spine1", "Spine2", "LeftUpLeg", "RightUpLeg", "LeftUpLeg0", "RightUpLeg0"


def motions(somebody) -> Iterator[tuple[str, list]]:
    """What is played: a name and its poses."""
    go = {"stands": (0.0, 0.0, 0.0), "strolls": (0.7, 0.0, 0.0), "walks": (1.3, 0.0, 0.0), "walks fast": (1.8, 0.0, 0.0), "runs": (2.5, 0.0, 0.0), "runs fast": (3.5, 0.0, 0.0),
          "steps aside": (0.0, 0.0, 0.5), "walks back": (-0.6, 0.0, 0.0), "turns": (0.6, 1.2, 0.0)}
    for name, wish in go.items():
        state, poses = somebody.start(), []
        for k in range(RATE * (20 if name == "stands" else 6)):
            state, pose = somebody.step(state, Intent(np.array(wish)), 1 / RATE)
            poses += [pose] if k % EVERY == 0 else []
        yield name, poses
    state, poses = somebody.start(), []
    for k in range(4 * RATE):
        leap = Leap(np.array([0.0, 0.0, 0.8])) if k == RATE else None
        state, pose = somebody.step(state, Intent(leap=leap), 1 / RATE)
        poses += [pose] if k % EVERY == 0 else []
    yield "leaps", poses


def hung_on(mesh, names) -> np.ndarray:
    """Which vertices (V,) hang on joints of those names, left or right, more than on any other."""
    main = np.take_along_axis(mesh.joints, mesh.weights.argmax(1)[:, None], 1)[:, 0]
    return np.isin(main, [k for k, name in enumerate(skin.NAMES) if name in names])


def depths(body: Body, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """How deep (T, 2) [m] the left and the right arm are in trunk and thighs of a body in the poses of figures (T, 22, 3), (T, 22, 3, 3); 0 outside."""
    if body is mannequin():  # which is drawn as it is
        at, turned, scale = positions, orientations, scale_of(positions, skin.REST, skin.STANDARD.parents)
    else:
        at, turned, scale = worn(body, positions, orientations)
    moved = skin.motions(at, turned, scale, body.joints)
    coarse, fine = body.levels[-1], body.levels[1]
    trunk = hung_on(coarse, TRUNK)
    faces = coarse.triangles[trunk[coarse.triangles].all(1)]
    arms = [hung_on(coarse, [side + part + n for part in ARMS for n in ("", "0", "1")]) for side in ("Left", "Right")]
    out = np.zeros((len(positions), 2))
    for t in range(len(positions)):
        posed = skin.skinned(coarse.positions, coarse.joints, coarse.weights, moved[t], scale[t])
        skinned = skin.skinned(fine.positions, fine.joints, fine.weights, moved[t], scale[t])[hung_on(fine, TRUNK)]
        tree = cKDTree(skinned)
        for side in range(2):
            places = posed[arms[side]]
            far, _ = tree.query(places)
            places, far = places[far < DEEPEST], far[far < DEEPEST]
            inside = winding(posed[faces], places) > 0.5
            out[t, side] = far[inside].max(initial=0.0)
    return out


def winding(faces: np.ndarray, places: np.ndarray) -> np.ndarray:
    """How often (P,) the surface of triangles (F, 3, 3) goes round each place (P, 3): van Oosterom and Strackee 1983."""
    a, b, c = (faces[None, :, k] - places[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    volume = np.sum(a * np.cross(b, c), -1)
    flat = la * lb * lc + np.sum(a * b, -1) * lc + np.sum(b * c, -1) * la + np.sum(c * a, -1) * lb
    return np.arctan2(volume, flat).sum(1) / (2 * np.pi)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=list(BUILDS), choices=list(BUILDS))
    parser.add_argument("--character", nargs="+", default=[], type=Path, help="bodies in GLB or VRM files")
    options = parser.parse_args()
    bodies = {name: mannequin() if BUILDS[name] is None else tailored(BUILDS[name]) for name in options.bodies} | {path.stem: load(path) for path in options.character}
    somebody = person()
    played = []
    for name, poses in motions(somebody):
        played.append((name, *forward_kinematics(somebody.skeleton, np.array([pose.root for pose in poses]), np.array([pose.rotations for pose in poses]))))
    print(f"{'deepest, cm (frames over 2 cm, %)':34}" + "".join(f"{name:>20}" for name in bodies))
    for name, at, turned in played:
        row = []
        for body in bodies.values():
            found = depths(body, at, turned).max(1)
            row.append(f"{100 * found.max():6.1f} ({100 * np.mean(found > DEEP):5.1f})")
        print(f"{name:34}" + "".join(f"{cell:>20}" for cell in row), flush=True)


if __name__ == "__main__":
    main()
