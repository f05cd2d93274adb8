"""Where a body errs that is known by head and hands: by joint, by what the performer does, and what truth of one kind would take away.

    python scripts/measure/tracker_parts.py LARGE --small FOLDER [--tuned]

LARGE, FOLDER: as for scripts/measure/reconstruction_trackers.py, whose tested takes these are, from nothing; every take counts alike. Then the truth is laid
into what was found, the rest as it is: the way that hips face (they turn, with the legs, below the upper body), where they are and how they lean as well, when
legs do what they do (of each second all that the legs did, later or earlier by up to 0.6 s, as is best in hindsight), and how legs are bent. Ankles are off together, by
the mean of both, or against each other, by half their difference; the wrong one is ahead where the other is by 20 cm. At last trackers are added,
also some that tell only how they are turned.
"""

from __future__ import annotations

import os
from dataclasses import replace

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from gambol.controllers.body import forward_kinematics, yaw
from gambol.controllers.reconstruction import JOINTS, SKELETON
from gambol.controllers.reconstruction.trackers import Network
from reconstruction_figures import table
from reconstruction_trackers import FPS, Performance, asked, opened, played, recorded

WORN = {"head and hands": ("", ""), "and the waist's turn alone": ("root", "Hips"), "and the waist": ("root", ""),
        "and the shins' turns alone": ("lknee,rknee", "LeftLeg,RightLeg"), "and both turns alone": ("root,lknee,rknee", "Hips,LeftLeg,RightLeg"),
        "and the feet": ("lankle,rankle", ""), "and waist and feet": ("root,lankle,rankle", "")}
"""What is worn, and at which joints without a place."""
LEGS = np.array([SKELETON.index(side + name) for side in ("Left", "Right") for name in ("UpLeg", "Leg", "Foot")])
ARMS = np.array([SKELETON.index(side + name) for side in ("Left", "Right") for name in ("Arm", "ForeArm", "Hand")])
TRUNK = np.setdiff1d(JOINTS, np.concatenate([LEGS, ARMS]))
WRISTS = np.array([SKELETON.index("LeftHand"), SKELETON.index("RightHand")])
ANKLES = np.array([SKELETON.index("LeftFoot"), SKELETON.index("RightFoot")])
SHIFTS, WINDOW, CALM = np.arange(-36, 37, 3), 60, 30
"""By how many frames legs may come late or early; of how many frames together; over how many speeds are evened."""
GOES, RUNS, TURNS, WORKS, LEADS = 0.3, 2.0, np.radians(45.0), 0.4, 0.2
"""From which speed somebody goes, and runs [m/s], which rate he turns [rad/s], and which speed of wrists about the hips his arms work [m/s]; how far
one ankle is ahead of the other that leads [m]."""
KINDS = ("stands, arms at rest", "stands, arms work", "walks straight", "runs straight", "turns")
ORACLES = ("as found", "hips face as they do", "hips are as they are", "legs in time", "hips face, legs in time", "hips are, legs in time", "legs bend as they do",
           "hips are, legs bend")


def heading(turns: np.ndarray) -> np.ndarray:
    """The way (T,) [rad] that orientations (T, 3, 3) face."""
    return np.arctan2(turns[:, 0, 2] - turns[:, 2, 0], turns[:, 0, 0] + turns[:, 2, 2])


def kinds(on: Performance) -> np.ndarray:
    """What (T,) the performer does in each frame, numbers of `KINDS`."""
    speed = uniform_filter1d(np.gradient(on.root[:, [0, 2]], 1 / FPS, axis=0), CALM, axis=0, mode="nearest")
    speed = np.linalg.norm(speed, axis=-1)
    rate = np.abs(uniform_filter1d(np.gradient(np.unwrap(heading(on.rotations[:, 0])), 1 / FPS), CALM, mode="nearest"))
    wrists = np.linalg.norm(np.gradient(on.positions[:, WRISTS] - on.positions[:, :1], 1 / FPS, axis=0), axis=-1).mean(-1)
    working = uniform_filter1d(wrists, CALM, mode="nearest") > WORKS
    return np.select([rate > TURNS, speed > RUNS, speed > GOES, working], [4, 3, 2, 1], 0)


def legs_off(on: Performance, root: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """How far (T, 6) [cm] legs' joints are from the performer's."""
    return 100 * np.linalg.norm(forward_kinematics(on.skeleton, root, rotations)[0][:, LEGS] - on.positions[:, LEGS], axis=-1)


def in_time(on: Performance, root: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """As `legs_off`, of the legs that come earlier or later as is best for each `WINDOW`."""
    tried, frames = [], np.arange(len(root))
    for shift in SHIFTS:
        shifted = rotations.copy()
        shifted[:, LEGS] = rotations[np.clip(frames + shift, 0, len(root) - 1)][:, LEGS]
        tried.append(legs_off(on, root, shifted))
    tried, windows = np.array(tried), frames // WINDOW
    sums = np.array([np.bincount(windows, one.mean(-1)) for one in tried])
    return tried[np.argmin(sums, 0)[windows], frames]


def truths(on: Performance, root: np.ndarray, rotations: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Mean distances (len(ORACLES), T) [cm] of the joints with the truth laid in. off: (T, J) as found."""
    faced, been, bent = rotations.copy(), rotations.copy(), rotations.copy()
    faced[:, 0] = yaw(heading(on.rotations[:, 0]) - heading(rotations[:, 0])) @ rotations[:, 0]
    been[:, 0] = on.rotations[:, 0]
    bent[:, LEGS] = on.rotations[:, LEGS]
    legs = [off[:, LEGS], legs_off(on, root, faced), legs_off(on, on.root, been), in_time(on, root, rotations), in_time(on, root, faced),
            in_time(on, on.root, been), legs_off(on, root, bent), np.zeros_like(off[:, LEGS])]
    above = off[:, np.setdiff1d(JOINTS, LEGS)].sum(-1)
    return np.array([(above + one.sum(-1)) / len(JOINTS) for one in legs])


def feet(on: Performance, positions: np.ndarray) -> np.ndarray:
    """How far ankles are off [cm], together and against each other, each ahead, aside and up, and whether the wrong one leads [%], NaN where none does: (T, 7)."""
    back = np.swapaxes(yaw(heading(on.rotations[:, 0])), -1, -2)[:, None]
    found, truth = ((back @ (some[:, ANKLES] - on.positions[:, :1])[..., None])[..., 0] for some in (positions, on.positions))
    away, leads = 100 * (found - truth), truth[:, 0, 2] - truth[:, 1, 2]
    wrong = np.where(np.abs(leads) > LEADS, 100.0 * (leads * (found[:, 0, 2] - found[:, 1, 2]) < 0.0), np.nan)
    ways = [2, 0, 1]
    return np.concatenate([np.abs(away.sum(1))[:, ways] / 2, np.abs(away[:, 0] - away[:, 1])[:, ways] / 2, wrong[:, None]], 1)


def judged(network: Network, on: Performance, worn: tuple[str, str], deep: bool) -> dict[str, np.ndarray]:
    """Of each frame: off (T, J) [cm] and angle (T, J) [deg] of each joint, heading (T,) [deg] and place (T,) [cm] of the hips, `feet`;
    if `deep`, truths (len(ORACLES), T), too."""
    more, unplaced = worn
    told = on.positions.copy()
    told[:, [SKELETON.index(name) for name in unplaced.split(",") if name]] = np.nan
    root, rotations, _ = played(network, replace(on, positions=told), ",".join(filter(None, ("head,lwrist,rwrist", more))), True)
    positions = forward_kinematics(on.skeleton, root, rotations)[0]
    off = 100 * np.linalg.norm(positions - on.positions, axis=-1)
    between = (np.swapaxes(on.rotations, -1, -2) @ rotations).reshape(-1, 3, 3)
    faces = heading(np.swapaxes(yaw(heading(on.rotations[:, 0])), -1, -2) @ yaw(heading(rotations[:, 0])))
    found = {"off": off, "angle": np.degrees(Rotation.from_matrix(between).magnitude()).reshape(off.shape), "heading": np.degrees(np.abs(faces)),
             "place": off[:, 0], "weight": np.full(len(off), 1 / len(off)), "kind": kinds(on), "feet": feet(on, positions)}
    return {**found, "truths": truths(on, root, rotations, off).T} if deep else found


def both_sides(name: str) -> np.ndarray:
    """Numbers of a joint's right and left."""
    return np.array([j for j in JOINTS if SKELETON.names[j].removeprefix("Left").removeprefix("Right") == name])


def main() -> None:
    """Print the four tables."""
    options = asked(__doc__).parse_args()
    network, large, core = opened(options)
    those = [recorded(large, take) for take in (core.validation if options.tuned else core.test)]
    sets = {}
    for name, worn in WORN.items():
        every = [judged(network, on, worn, not sets) for on in those]
        sets[name] = {key: np.concatenate([one[key] for one in every]) for key in every[0]}
    first = sets["head and hands"]
    weight, whole = first["weight"] / len(those), first["off"][:, JOINTS].mean(-1)
    names = dict.fromkeys(SKELETON.names[j].removeprefix("Left").removeprefix("Right") for j in JOINTS)
    rows = []
    for name in names:
        own = both_sides(name)
        mean = weight @ first["off"][:, own].mean(-1)
        rows.append((name, f"{mean:.1f}", f"{100 * mean * len(own) / len(JOINTS) / (weight @ whole):.0f}", f"{weight @ first['angle'][:, own].mean(-1):.1f}"))
    print(table(("joint", "cm", "share of all, %", "deg"), rows), flush=True)
    rows, footed = [], []
    for number, name in enumerate((*KINDS, "all")):
        some = weight * (first["kind"] == number if number < len(KINDS) else 1.0)
        share, some = some.sum(), some / max(some.sum(), 1e-12)
        parts = [some @ first["off"][:, own].mean(-1) for own in (TRUNK, ARMS, LEGS)]
        rows.append((name, f"{100 * share:.0f}", *(f"{part:.1f}" for part in parts), f"{some @ first['place']:.1f}", f"{some @ first['heading']:.0f}",
                     *(f"{one:.2f}" for one in some @ first["truths"])))
        leads = some * np.isfinite(first["feet"][:, -1])
        wrong = leads @ np.nan_to_num(first["feet"][:, -1]) / max(leads.sum(), 1e-12)
        footed.append((name, *(f"{one:.1f}" for one in some @ first["feet"][:, :-1]), f"{wrong:.0f}"))
    print("\n" + table(("", "of time, %", "trunk cm", "arms cm", "legs cm", "hips cm", "hips' heading deg", *ORACLES), rows))
    print("\n" + table(("ankles", "together: ahead", "aside", "up", "against each other: ahead", "aside", "up", "the wrong one leads, %"), footed), flush=True)
    rows = [(name, *(f"{weight @ one['off'][:, own].mean(-1):.2f}" for own in (JOINTS, TRUNK, ARMS, LEGS)),
             f"{weight @ np.sqrt((one['angle'][:, JOINTS] ** 2).mean(-1)):.1f}", f"{weight @ one['heading']:.1f}") for name, one in sets.items()]
    print("\n" + table(("trackers that turn", "cm", "trunk", "arms", "legs", "joint deg", "hips' heading deg"), rows))


if __name__ == "__main__":
    main()
