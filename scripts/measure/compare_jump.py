"""Set our jumps beside recorded ones, and print what is wrong with plans.

    python scripts/measure/compare_jump.py [--plots DIR] [--quick] [--recorded] [--seed 0]

Jumps are found in the takes of ../shared/mocap that the prior is fitted to. Each is planned anew from the very pose and
motion in which the recorded one began, with its distance, height and airtime, by a prior to which no jump of its take was
fitted. Printed are the RMS differences in the air of knee, hip and trunk [°] and of where the upper arms point [°]; of the
whole, how deep they crouch, how far upper arms and elbows turn until touch-down, and how they land. Then comes the table of `jump_faults.py`. With --plots, strips of
both are drawn.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import jump_faults
from gambol.controllers.body import Clip, Pose, centre_of_mass, contact_points, forward_kinematics, heading_of, log
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.prior import STRIDES, TAKES, Prior, Recorded, fit, jumps
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.mocap import calibrate, load, retarget

from _plots import pictures, pyplot

MOCAP = Path(__file__).resolve().parents[3] / "shared" / "mocap"
JUDGED = (*TAKES, "woody2/wd2_Physics_Jump02.bvh")
"""Ours are judged by these: there are scissors, too, which nothing was fitted to."""
STANDS = 0.055
"""Points of feet lower than this over the floor stand [m]."""
SMALL = 0.2, 0.46
"""Jumps no farther than this [m], and shorter [s], are small ones on the spot."""
ANGLES = ("knee", "hip", "trunk", "arm")


@dataclass(frozen=True, eq=False)
class Curves:
    """Knee and hip bend [°], mean of both legs, the trunk's lean forward [°], where the upper arms point (T, 2, 3) seen from the
    chest, centre of mass (T, 3) [m], and how far elbows are bent (T, 2) [°]."""

    knee: np.ndarray
    hip: np.ndarray
    trunk: np.ndarray
    arms: np.ndarray
    centre: np.ndarray
    elbows: np.ndarray


def curves(jump: Jump, roots: np.ndarray, local: np.ndarray) -> Curves:
    """The curves of poses (T, ...)."""
    skeleton = jump.skeleton
    positions, turned = forward_kinematics(skeleton, roots, local)
    knee, hip = (np.degrees(np.mean([np.linalg.norm(log(local[:, skeleton.index(side + name)]), axis=-1)
                                     for side in ("Left", "Right")], 0)) for name in ("Leg", "UpLeg"))
    ahead = heading_of(turned[:, 0, :, 2])
    line = positions[:, skeleton.index("Neck")] - positions[:, 0]
    trunk = np.degrees(np.arctan2(line[:, 0] * np.sin(ahead) + line[:, 2] * np.cos(ahead), line[:, 1]))
    chest = turned[:, skeleton.index("Spine2")]
    arms = np.stack([positions[:, skeleton.index(side + "ForeArm")] - positions[:, skeleton.index(side + "Arm")] for side in ("Left", "Right")], 1)
    arms = np.einsum("tji,tsj->tsi", chest, arms / np.linalg.norm(arms, axis=-1, keepdims=True))
    elbows = np.stack([np.degrees(np.linalg.norm(log(local[:, skeleton.index(side + "ForeArm")]), axis=-1)) for side in ("Left", "Right")], 1)
    return Curves(knee, hip, trunk, arms, centre_of_mass(jump.physique.anatomy, positions, turned), elbows)


def swings(shown: Curves, until: slice) -> tuple[float, float]:
    """How far [°] upper arms turn meanwhile, between any two moments, and elbows bend: means of both sides."""
    arms = np.clip(np.einsum("isk,jsk->sij", shown.arms[until], shown.arms[until]), -1.0, 1.0)
    return float(np.degrees(np.arccos(arms.min((1, 2)))).mean()), float(np.ptp(shown.elbows[until], axis=0).mean())


def recorded(jump: Jump, takes: Sequence[str] = JUDGED) -> Iterator[tuple[Clip, list[Recorded]]]:
    """Takes of ../shared/mocap on our skeleton, with their jumps; none where there is no such folder."""
    for take in takes if MOCAP.is_dir() else ():
        try:
            source = load(MOCAP / take)
            clip = replace(retarget(source, calibration=calibrate([source])), name=Path(take).stem)
        except (OSError, ValueError) as error:
            print(f"  {take}: {error}")
            continue
        yield clip, list(jumps(jump.skeleton, jump.physique.anatomy, clip))


def state_at(jump: Jump, clip: Clip, frame: int) -> CharacterState:
    """The recorded body at a frame, as a state that something else moved."""
    frame = max(frame, 1)
    roots, local = clip.root, clip.rotations
    positions, turned = forward_kinematics(jump.skeleton, roots[frame - 1:frame + 1], local[frame - 1:frame + 1])
    heading = float(heading_of(turned[1, 0][:, 2]))
    flow = (positions[1, 0] - positions[0, 0]) / clip.frame_time
    s, c = np.sin(heading), np.cos(heading)
    points = contact_points(jump.skeleton, positions[1], turned[1])
    floor = np.percentile(contact_points(jump.skeleton, *clip.kinematics())[..., 1], 3) - 0.02
    return CharacterState(np.array([positions[1, 0, 0], positions[1, 0, 2], heading]),
                          np.array([s * flow[0] + c * flow[2], 0.0, c * flow[0] - s * flow[2]]),
                          Pose(roots[frame], local[frame]), points[:, 1] < floor + STANDS, None, float(floor),
                          Pose(roots[frame - 1], local[frame - 1]), clip.frame_time)


def compare(clip: Clip, one: Recorded, prior: Prior, plots: Path | None, number: int) -> dict[str, float] | None:
    """One recorded jump beside ours: prints a line, draws a picture, returns the differences."""
    jump = Jump(prior=prior)
    theirs = curves(jump, clip.root, clip.rotations)
    start, _, first, last, landed, upright = one.events
    state = state_at(jump, clip, start)
    feet = contact_points(jump.skeleton, *(a[last:last + 1] for a in clip.kinematics()))[0]
    place = feet.mean(0) * [1.0, 0.0, 1.0] + [0.0, float(state.floor), 0.0]
    told = f"  {clip.name:22s} {one.time:6.2f} s {'one foot ' if one.single is not None else ''}air {one.airtime:.2f} s, {one.far:.2f} m, {one.pace:.1f} m/s"
    try:
        made = jump.plan(state, Intent(leap=Leap(place, one.airtime)))
    except Unable as reason:
        print(f"{told}  not ours: {str(reason).split(';')[0]}")
        return None
    count = last - first
    times = made.take_off + one.airtime * np.arange(count) / count
    poses = [made.at(t) for t in times]
    ours = curves(jump, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))
    air = slice(first, last)
    rms = {name: float(np.sqrt(np.mean((getattr(ours, name) - getattr(theirs, name)[air]) ** 2))) for name in ANGLES[:3]}
    rms["arm"] = float(np.degrees(np.sqrt(np.mean(np.arccos(np.clip((ours.arms * theirs.arms[air]).sum(-1), -1.0, 1.0)) ** 2))))
    whole = [made.at(t) for t in np.arange(0.0, made.duration, 1 / 120)]
    all_ours = curves(jump, np.stack([p.root for p in whole]), np.stack([p.rotations for p in whole]))
    thin = max(round(1 / (60.0 * clip.frame_time)), 1)
    off, down = round(made.take_off * 120), round(made.touch_down * 120)
    low = down + int(all_ours.centre[down:, 1].argmin())
    rms |= dict(zip(("arms turn", "elbows bend", "arms turn theirs", "elbows bend theirs"), (*swings(all_ours, slice(0, down)), *swings(theirs, slice(start, last)))))
    rms |= {"knee off": ours.knee[0], "knee off theirs": theirs.knee[first], "trunk landed": all_ours.trunk[low], "trunk landed theirs": theirs.trunk[landed],
            "crouch": all_ours.centre[0, 1] - all_ours.centre[:off, 1].min(), "crouch theirs": one.depth,
            "knee turns": fastest(jump, np.stack([p.rotations for p in whole[:int(120 * min(made.through, made.duration)):2]]), 60.0),
            "knee turns theirs": fastest(jump, clip.rotations[start:upright:thin], 1.0 / (thin * clip.frame_time)),
            "sinks": ours.centre[-1, 1] - all_ours.centre[low, 1], "sinks theirs": theirs.centre[last, 1] - theirs.centre[landed, 1]}
    print(f"{told}  RMS knee {rms['knee']:4.1f}°, hip {rms['hip']:4.1f}°, trunk {rms['trunk']:4.1f}°, arm {rms['arm']:4.1f}°; ours / theirs: knee at take-off {rms['knee off']:.0f} / "
          f"{rms['knee off theirs']:.0f}°, trunk landed {rms['trunk landed']:.0f} / {rms['trunk landed theirs']:.0f}°, crouch {rms['crouch']:.2f} / {one.depth:.2f} m, "
          f"sinks {rms['sinks']:.2f} / {rms['sinks theirs']:.2f} m")
    if plots:
        plots.mkdir(parents=True, exist_ok=True)
        strip(plots / f"{clip.name}_{number}.png", told.strip(), jump, clip, one, made)
    return rms


def fastest(jump: Jump, local: np.ndarray, rate: float) -> float:
    """How fast [rad/s] a knee turns at most in poses (T, ...), so many a second."""
    knees = local[:, [jump.skeleton.index(side + "Leg") for side in ("Left", "Right")]]
    return float(np.linalg.norm(log(np.swapaxes(knees[:-1], -1, -2) @ knees[1:]), axis=-1).max() * rate)


def strip(path: Path, title: str, jump: Jump, clip: Clip, one: Recorded, made) -> None:
    """Both as stick figures from the side, at the same shares of the way from event to event: recorded above, ours below."""
    plt = pyplot()
    figure, axes = plt.subplots(2, 1, figsize=(17, 6))
    shares = np.linspace(0.0, 5.0, 16)
    events = np.array([0.0, made.push_off, made.take_off, made.touch_down, made.lowest, min(made.duration, made.lowest + 0.5)])
    frames = np.clip(np.interp(shares, np.arange(6), one.events).round().astype(int), 0, len(clip) - 1)
    shown = [made.at(t) for t in np.interp(shares, np.arange(6), events)]
    theirs, ours = clip.root[frames], np.stack([p.root for p in shown])
    for axis, roots, local in ((axes[0], theirs, clip.rotations[frames]), (axes[1], ours, np.stack([p.rotations for p in shown]))):
        positions, turned = forward_kinematics(jump.skeleton, roots, local)
        heading = float(heading_of(turned[0, 0][:, 2]))
        way = np.array([np.sin(heading), np.cos(heading)])
        for k, p in enumerate(positions):
            along = (p[:, [0, 2]] - positions[0, 0, [0, 2]]) @ way + 0.85 * k
            for j in range(1, len(p)):
                i, name = jump.skeleton.parents[j], jump.skeleton.names[j]
                axis.plot(along[[i, j]], p[[i, j], 1], color="tab:red" if name.startswith("Left") else "tab:blue" if name.startswith("Right") else "k", lw=1.3)
            axis.text(0.85 * k, -0.12, f"{shares[k]:.1f}", fontsize=6)
        axis.set_aspect("equal")
        axis.axis("off")
    axes[0].set_title(title, fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=70)
    plt.close(figure)


def beside(takes: Sequence[str], plots: Path | None) -> None:
    """Every recorded jump beside ours."""
    found, strides, fitted = list(recorded(Jump(), takes)), list(recorded(Jump(), STRIDES)), {Path(take).stem for take in TAKES}
    everything, rows = [one for clip, some in found if clip.name in fitted for one in some] + [one for _, some in strides for one in some], []

    for clip, some in found:
        if not some:
            print(f"  {clip.name}: no jump found")
            continue
        prior = fit([one for one in everything if one.clip != clip.name])
        for number, one in enumerate(some):
            rms = compare(clip, one, prior, plots, number)
            rows += [rms | {"take": clip.name, "feet": 1 if one.single is not None else 2, "small": one.far < SMALL[0] and one.airtime < SMALL[1]}] if rms else []
    for feet in (2, 1):
        some = [row for row in rows if row["feet"] == feet]
        if some:
            takes = sorted({row["take"] for row in some})
            print(f"off {feet} feet, {len(some)} jumps of {len(takes)} takes, each left out: RMS in the air, median, mean, median of takes' medians: " + "; ".join(
                f"{key} {np.median([r[key] for r in some]):.0f}, {np.mean([r[key] for r in some]):.0f}, "
                f"{np.median([np.median([r[key] for r in some if r['take'] == take]) for take in takes]):.0f}°" for key in ANGLES))
            print("  ours / theirs, median: " + "; ".join(f"{key} {np.median([r[key] for r in some]):.2f} / {np.median([r[key + ' theirs'] for r in some]):.2f}"
                                                          for key in ("knee off", "trunk landed", "crouch", "sinks")))
            for name, told in (("until touch-down", some), ("small ones on the spot", [row for row in some if row["small"]])):
                if told:
                    print(f"  {name}, {len(told)}, ours / theirs, median: " + "; ".join(f"{key} by {np.median([r[key] for r in told]):.0f} / {np.median([r[key + ' theirs'] for r in told]):.0f}°"
                                                                                        for key in ("arms turn", "elbows bend")))
            print("  knees turn fastest, ours / theirs, median (worst): " + " / ".join(f"{np.median([r[key] for r in some]):.1f} ({max(r[key] for r in some):.1f})"
                                                                                      for key in ("knee turns", "knee turns theirs")) + " rad/s")


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("takes", nargs="*", help="files under ../shared/mocap; by default those that the prior is fitted to")
    parser.add_argument("--plots", type=Path, help="a folder for strips (needs matplotlib, which the extra `report` brings)")
    parser.add_argument("--recorded", action="store_true", help="only what stands beside recorded jumps")
    parser.add_argument("--quick", action="store_true", help="150 random targets")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    pictures(parser, given.plots)
    if MOCAP.is_dir():
        beside(given.takes or JUDGED, given.plots)
    else:
        print("no ../shared/mocap beside the project: recorded jumps are not to be had here; nothing compared")
    if not given.recorded:
        jump_faults.table(Locomotion.load(), given.quick, given.seed)
    return 0


if __name__ == "__main__":
    sys.exit(main())
