"""Compare our jumps with recorded ones: knee, hip and centre of mass, side by side.

    python scripts/measure/compare_jump.py [--plots DIR] [CLIP ...]

Jumps are found in the clips of ../shared/mocap: both feet in the air, the centre of mass falling
freely. Each is planned anew from the very pose and motion in which the recorded one began, with its
distance, height and airtime, and aligned at take-off. Printed are the RMS differences of knee and
hip bend [°] and of the centre of mass's height [cm], from 0.5 s before take-off to 0.3 s after
touch-down; drawn, with --plots, are the curves.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gambol.controllers.body import Clip, Pose, centre_of_mass, contact_points, forward_kinematics, heading_of, log
from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Jump, Refused
from gambol.controllers.mocap import calibrate, load, retarget

from _plots import pictures, pyplot

MOCAP = Path(__file__).resolve().parents[3] / "shared" / "mocap"
CLIPS = ("woody2/wd2_Physics_Jump00.bvh", "woody2/wd2_Physics_Jump02.bvh", "woody2/wd2_Physics_Jump03.bvh",
         "woody2/wd2_long_broad_jump.bvh", *(f"cmu/16/16_{n:02d}.amc" for n in (1, 2, 3, 5, 6, 9)),
         *(f"cmu/127/127_{n}.amc" for n in (21, 25, 26, 27)))
ALOFT = 0.035
"""Higher above its place in stance than this [m] is a foot's lowest point in the air."""
SHORTEST, LONGEST = 0.18, 0.9
"""Flights that count as jumps [s]; runners' strides are shorter, climbing is longer."""
BEFORE, AFTER = 0.5, 0.3


@dataclass(frozen=True, eq=False)
class Curves:
    """Knee and hip bend [°], mean of both legs, and centre of mass (T, 3) [m] of a motion at its own rate."""

    knee: np.ndarray
    hip: np.ndarray
    centre: np.ndarray


def curves(jump: Jump, roots: np.ndarray, local: np.ndarray) -> Curves:
    """The curves of poses (T, ...)."""
    skeleton = jump.skeleton
    knee, hip = (np.degrees(np.mean([np.linalg.norm(log(local[:, skeleton.index(side + name)]), axis=-1)
                                     for side in ("Left", "Right")], 0)) for name in ("Leg", "UpLeg"))
    return Curves(knee, hip, centre_of_mass(jump.physique.anatomy, *forward_kinematics(skeleton, roots, local)))


def flights(jump: Jump, clip: Clip) -> Iterator[tuple[int, int]]:
    """First and last frame in the air of every jump of a clip."""
    points = contact_points(jump.skeleton, *clip.kinematics())
    air = points[..., 1].min(-1) - np.percentile(points[..., 1].min(-1), 5) > ALOFT
    edges = np.flatnonzero(np.diff(np.pad(air.astype(int), 1)))
    for first, last in edges.reshape(-1, 2):
        if SHORTEST < (last - first) * clip.frame_time < LONGEST and first * clip.frame_time > BEFORE \
                and (len(clip) - last) * clip.frame_time > AFTER:
            yield int(first), int(last)


def recorded(jump: Jump, names: Sequence[str] = CLIPS) -> Iterator[tuple[Clip, list[tuple[int, int]]]]:
    """Clips of ../shared/mocap on our skeleton, with their jumps; none where there is no such folder."""
    for name in names if MOCAP.is_dir() else ():
        try:
            source = load(MOCAP / name)
            clip = replace(retarget(source, calibration=calibrate([source])), name=Path(name).stem)
        except (OSError, ValueError) as error:
            print(f"  {name}: {error}")
            continue
        yield clip, list(flights(jump, clip))


def begins(theirs: Curves, first: int, rate: float, speed: float) -> int:
    """The frame in which a jump begins: standing before the crouch; of a runner, its last foot-strike or so."""
    if speed > 1.5:
        return max(first - round(0.22 * rate), 1)
    height = theirs.centre[max(first - round(1.0 * rate), 1):first, 1]
    low = int(height[-max(round(0.5 * rate), 1):].argmin()) + max(len(height) - round(0.5 * rate), 0)
    return first - len(height) + int(height[:low + 1].argmax())


def state_at(jump: Jump, clip: Clip, frame: int) -> CharacterState:
    """The recorded body at a frame, as a state that something else moved."""
    roots, local = clip.root, clip.rotations
    positions, turned = forward_kinematics(jump.skeleton, roots[frame - 1:frame + 1], local[frame - 1:frame + 1])
    heading = float(heading_of(turned[1, 0][:, 2]))
    flow = (positions[1, 0] - positions[0, 0]) / clip.frame_time
    s, c = np.sin(heading), np.cos(heading)
    points = contact_points(jump.skeleton, positions[1], turned[1])
    standing = points[:, 1] < 0.02 + ALOFT
    return CharacterState(np.array([positions[1, 0, 0], positions[1, 0, 2], heading]),
                          np.array([s * flow[0] + c * flow[2], 0.0, c * flow[0] - s * flow[2]]),
                          Pose(roots[frame], local[frame]), standing, None, 0.0, Pose(roots[frame - 1], local[frame - 1]),
                          clip.frame_time)


def compare(jump: Jump, clip: Clip, first: int, last: int, plots: Path | None, number: int) -> dict[str, float] | None:
    """One recorded jump beside ours: prints a line, draws a picture, returns the RMS differences."""
    rate = 1.0 / clip.frame_time
    theirs = curves(jump, clip.root, clip.rotations)
    flow = np.gradient(theirs.centre, clip.frame_time, axis=0)
    start = begins(theirs, first, rate, float(np.hypot(*flow[max(first - round(0.3 * rate), 0), [0, 2]])))
    landed = contact_points(jump.skeleton, *(a[last:last + 1] for a in clip.kinematics()))[0]
    place = landed.mean(0) * [1.0, 0.0, 1.0]
    place[1] = 0.0
    air = (last - first) * clip.frame_time
    name = f"{clip.name} {first * clip.frame_time:6.2f} s"
    state = state_at(jump, clip, start)
    far = float(np.hypot(*(theirs.centre[last] - theirs.centre[first])[[0, 2]]))
    told = f"  {name:34s} air {air:.2f} s, {far:.2f} m, v0 {np.hypot(*state.velocity[[0, 2]]):.1f} m/s"
    try:
        made = jump.plan(state, Intent(leap=Leap(place, air)))
    except Refused as reason:
        print(f"{told}  not ours: {str(reason).split(';')[0]}")
        return None
    times = np.arange(-min(BEFORE, made.take_off), air + AFTER, clip.frame_time)
    poses = [made.at(made.take_off + t) for t in times]
    ours = curves(jump, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))
    at = first + np.round(times * rate).astype(int)
    inside = (at >= 0) & (at < len(clip))
    rms = {}
    for key, a, b in (("knee", ours.knee, theirs.knee[at[inside]]), ("hip", ours.hip, theirs.hip[at[inside]]),
                      ("height", 100 * (ours.centre[:, 1]), 100 * theirs.centre[at[inside], 1])):
        rms[key] = float(np.sqrt(np.mean((a[inside] - b) ** 2)))
    print(f"{told}  RMS knee {rms['knee']:4.1f}°, hip {rms['hip']:4.1f}°, height {rms['height']:4.1f} cm; most bent knee "
          f"{ours.knee.max():.0f}° / {theirs.knee[at[inside]].max():.0f}°")
    if plots:
        draw(plots / f"{clip.name}_{number}.png", name, times, ours, theirs, at[inside], inside, air)
    return rms


def draw(path: Path, title: str, times, ours: Curves, theirs: Curves, at, inside, air: float) -> None:
    """Three curves over time from take-off, ours beside theirs."""
    plt = pyplot()
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(7, 7))
    for axis, label, a, b in zip(axes, ("knee [°]", "hip [°]", "centre of mass [m]"), (ours.knee, ours.hip, ours.centre[:, 1]),
                                 (theirs.knee[at], theirs.hip[at], theirs.centre[at, 1])):
        axis.plot(times[inside], b, label="recorded")
        axis.plot(times, a, label="ours")
        axis.axvspan(0.0, air, alpha=0.1)
        axis.set_ylabel(label)
    axes[0].set_title(title)
    axes[0].legend()
    axes[-1].set_xlabel("time from take-off [s]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("clips", nargs="*", help="files under ../shared/mocap; by default those of the issue")
    parser.add_argument("--plots", type=Path, help="a folder for pictures (needs matplotlib, which the extra `report` brings)")
    given = parser.parse_args()
    if not MOCAP.is_dir():
        print("no ../shared/mocap beside the project: recorded jumps are not to be had here; nothing compared")
        return 0
    pictures(parser, given.plots)
    jump, all_rms = Jump(), []
    for clip, found in recorded(jump, given.clips or CLIPS):
        if not found:
            print(f"  {clip.name}: no jump found")
        for number, (first, last) in enumerate(found):
            rms = compare(jump, clip, first, last, given.plots, number)
            all_rms += [rms] if rms else []
    if all_rms:
        print(f"{len(all_rms)} jumps, median RMS: " + ", ".join(
            f"{key} {np.median([r[key] for r in all_rms]):.1f} {'cm' if key == 'height' else '°'}" for key in all_rms[0]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
