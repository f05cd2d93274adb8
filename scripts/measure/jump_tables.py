"""Fill the empty tables and figures of Ooi's thesis: wind-up, muscles, limits, path, force, balance, thrust.

    python scripts/measure/jump_tables.py [--plots FOLDER]

Tables go to the terminal; with --plots the figures too, as PNG files (needs matplotlib: the
`report` extra). The jump is an adult's, straight up unless a table says otherwise.
"""

from __future__ import annotations

import argparse
import itertools
import time
from pathlib import Path

import numpy as np

from gambol.controllers.body import forward_kinematics, hull, joint_limits, sole_corners, standing_corners
from gambol.controllers.jump.body import Physique, along, least_effort, measures, take_off_velocity
from gambol.controllers.jump.motion import push
from gambol.controllers.jump.muscles import (GAINS, STIFFNESS, WIDTH, Crouch, Muscle, crouch, crouch_depth, extend, sample,
                                             shoot, spring_bend, spring_force, strength, strongest)

from _plots import pictures, pyplot

ADULT = Physique()
G = 9.81
BODIES = (("adult", ADULT), ("child", Physique(25.0, 1.25, 0.9)), ("heavy", Physique(110.0, 1.78, 0.85)),
          ("athlete", Physique(75.0, 1.80, 1.3)))
CONSTANTS = ((0.05, 0.1), (0.1, 0.1), (0.3, 0.0), (0.3, 0.1), (0.3, 0.3), (0.3, 0.9), (0.6, 0.1), (0.75, 0.1), (0.9, 0.1), (1.2, 0.1),
             (2.4, 0.1))
UNBOUND = 0.3
"""No step of a wind-up is that long [m]: the thesis bounds none."""


def rise(physique: Physique) -> float:
    """From standing to take-off [m]."""
    heights = measures(physique)
    return heights.leave(0.0) - heights.stand


def speed(height: float, g: float = G) -> float:
    """The take-off speed [m/s] of a jump so high [m]."""
    return float(np.sqrt(2.0 * g * height))


def processor_ms(function, times: int = 20) -> float:
    """How long [ms] a call keeps the processor busy, after a first one."""
    function()
    start = time.process_time()
    for _ in range(times):
        function()
    return (time.process_time() - start) / times * 1e3


def controls() -> list[tuple[float, float, Crouch]]:
    """Table 3.1: what the constants of the control do to a wind-up for 0.35 m; its true root is told by the strength curve."""
    root = crouch_depth(ADULT, speed(0.35), rise(ADULT))
    print("Table 3.1  constants of the control, wind-up for 0.35 m (ours: "
          f"{GAINS.proportional}, {GAINS.derivative}); the root is {root:.3f} m deep, and overshoot is measured from there\n"
          "   k_p   k_d  iterations  overshoot cm  depth m  heels up  ends")
    runs = []
    for longest, name in ((GAINS.longest, f"steps of {GAINS.longest * 100:.0f} cm at most, ours"), (UNBOUND, "steps without bound, as in the thesis")):
        print(f"  {name}")
        for k_p, k_d in CONSTANTS:
            found = crouch(ADULT, speed(0.35), rise(ADULT), gains=GAINS._replace(proportional=k_p, derivative=k_d, longest=longest))
            depths = found.history.centre[0, 1] - found.history.centre[:, 1]
            ends = "does not" if not found.converged else "at the root" if abs(found.depth - root) < 0.015 else "at a wrong root"
            if longest < UNBOUND:
                runs.append((k_p, k_d, found))
            print(f"  {k_p:4.2f}  {k_d:4.2f}  {found.iterations:10d}  {max(depths.max() - root, 0.0) * 100:12.1f}  {found.depth:7.3f}"
                  f"  {'yes' if found.feet[:, 4].max() > 0.02 else 'no':>8}  {ends}")
    masses = itertools.count(ADULT.mass + 0.001, 0.001)  # a curve is found once a body
    print(f"  One wind-up: {processor_ms(lambda: crouch(ADULT, speed(0.35), rise(ADULT))):.2f} ms of processor;"
          f" its depth from the strength curve: {processor_ms(lambda: crouch_depth(ADULT, speed(0.35), rise(ADULT)), 200):.3f} ms;"
          f" that curve, once a body: {processor_ms(lambda: strength(Physique(next(masses))), 5):.1f} ms\n")
    return runs


READINGS = tuple((reading, arm) for reading in ("wedge", "printed") for arm in ("constant", "attached"))


def springs() -> list[tuple[str, Crouch]]:
    """Table 3.2: k and r against the bend, by the formulas and on the body, in both readings of force and of arm."""
    print("Table 3.2  bend [deg] of a spring for a force, READINGS' example k r = 705 N, and ours")
    print("  k kN/m    r m   reading     300 N   750 N  1000 N  1200 N")
    for k, r in ((14.1e3, 0.05), (14.1e3, 0.04), (14.1e3, 0.06), (10e3, 0.05), (20e3, 0.05), (STIFFNESS, WIDTH)):
        for reading in ("printed", "wedge"):
            bends = np.degrees(spring_bend(np.array([300.0, 750.0, 1000.0, 1200.0]), Muscle(k, r, reading == "printed")))
            print(f"  {k / 1e3:6.1f}  {r:5.3f}   {reading:8}" + "".join(f"  {b:6.1f}" for b in bends))
    print("  Crouch of the whole body for 0.20 m: k and r varied by strength (k) and by their product with it (r²)")
    print("  k kN/m    r m   reading  arm       depth m  knee deg  hip deg  force BW  springs J  converged")
    poses = []
    for reading, arm in READINGS:
        for k, r in ((0.9, 1.0), (1.0, 1.0), (1.2, 1.0), (1.5, 1.0), (2.0, 1.0), (1.0, 0.95), (1.0, 1.1), (1.0, 1.2)):
            physique = Physique(strength=k * r**2)  # the body feels k r² alone: torque over force
            found = crouch(physique, speed(0.20), rise(physique), reading=reading, arm=arm)
            hip, knee = np.degrees(found.bends[:2])
            print(f"  {k * STIFFNESS / 1e3:6.1f}  {r * WIDTH:5.3f}   {reading:7}  {arm:8}  {found.depth:7.3f}  {knee:8.0f}  {hip:7.0f}"
                  f"  {np.linalg.norm(found.force) / (73 * G):8.2f}  {found.history.work[-1]:9.0f}  {'yes' if found.converged else 'no':>9}")
            if (reading, arm) == READINGS[0] and r == 1.0 and k < 2.0:
                poses.append((f"k = {k * STIFFNESS / 1e3:.1f} kN/m", found))
    print("  The strongest jump straight up, by reading:  " + ",  ".join(
        f"{reading} {arm} {strongest(ADULT, rise(ADULT), G, reading, arm):.2f} m/s" for reading, arm in READINGS))
    print()
    return poses


SOURCES = {"Spine": "38 CFR 4.71, Kurz; over 3 joints", "Neck": "Kurz; over 2 joints", "Head": "as Neck", "Arm": "38 CFR 4.71, Kurz",
           "ForeArm": "38 CFR 4.71", "Hand": "38 CFR 4.71", "UpLeg": "38 CFR 4.71", "Leg": "38 CFR 4.71; sideways ours",
           "Foot": "38 CFR 4.71; loaded 40; turning ours", "Toe": "ours", "Shoulder": "ours"}


def limits() -> None:
    """Table 3.3: the limits of the joints, and where they come from."""
    skeleton = ADULT.skeleton
    found = joint_limits(skeleton)
    print("Table 3.3  joint limits [deg] about X, Y, Z of the joint's frame at T-pose (left side)\n"
          "  joint              x             y             z       source")
    for j, name in enumerate(skeleton.names):
        plain = name.removeprefix("Left")
        if name.startswith("Right") or not np.isfinite(found.lower[j]).all():
            continue
        low, high = np.degrees(found.lower[j]), np.degrees(found.upper[j])
        spans = "".join(f"{a:6.0f} …{b:4.0f}  " for a, b in zip(low, high))
        print(f"  {plain:13}{spans}  {SOURCES.get(plain, 'as Spine')}")
    print()


def heights() -> list[tuple[float, Crouch]]:
    """Crouch, push and force of jumps of several heights, beside what adults do."""
    print("Wind-up and push by height of jump (wanted at 0.3 … 0.4 m: depth 0.28 … 0.38, push-off 0.22 … 0.30 s, peak 2.0 … 2.6)")
    print("  height m  v m/s  depth m  hip  knee  ankle deg  muscles BW  needed BW  springs J  needed J  margin cm | profile: push s  peak BW"
          " | thrust: push s  peak BW")
    found_all = []
    for height in (0.1, 0.2, 0.3, 0.35, 0.4):
        found = crouch(ADULT, speed(height), rise(ADULT))
        pushed = push(np.array([0.0, found.depth + rise(ADULT), 0.0]), np.zeros(3), np.array([0.0, speed(height), 0.0]),
                      np.array([0.0, -G, 0.0]))
        forces = pushed.force(np.linspace(0, pushed.duration, 200))[:, 1] / G
        shot = shoot(ADULT, found, speed(height))
        hip, knee, ankle = np.degrees(found.bends[:3])
        print(f"  {height:8.2f}  {speed(height):5.2f}  {found.depth:7.3f}  {hip:3.0f}  {knee:4.0f}  {ankle - 40:9.0f}"
              f"  {np.linalg.norm(found.force) / (73 * G):10.2f}  {np.linalg.norm(found.required) / (73 * G):9.2f}"
              f"  {found.history.work[-1]:9.0f}  {found.history.needed[-1]:8.0f}  {found.margin * 100:9.1f}"
              f" | {pushed.duration:15.3f}  {forces.max():7.2f} | {shot.duration:14.3f}  {shot.force[:, 1].max() / (73 * G):7.2f}")
        found_all.append((height, found))
    print("\nThe strongest jump of a body: speed, height, and on the Moon")
    for name, physique in BODIES:
        v, moon = strongest(physique, rise(physique)), strongest(physique, rise(physique), 1.62)
        print(f"  {name:8} {physique.mass:5.0f} kg {physique.height:5.2f} m strength {physique.strength:4.2f}:  {v:5.2f} m/s"
              f"  {v * v / (2 * G):5.2f} m   Moon {moon:5.2f} m/s  {moon * moon / 3.24:5.2f} m   deepest {strength(physique).depth[-1]:.3f} m")
    print()
    return found_all


def sampling() -> None:
    """The thesis's sampling beside the control: middle and spread of eight scrambled sequences."""
    wish = speed(0.35)
    found = crouch(ADULT, wish, rise(ADULT))
    print("Wind-up for 0.35 m by control and by sampling (eight seeds: median, least … most)\n"
          "  method          depth m                  balance cm           momentum/wished        ms of processor")
    print(f"  control         {found.depth:5.3f}  {'':15}  {found.history.balance[-1] * 100:5.2f}"
          f"  {'':13}  {'(muscles 0.5 %)':>21}  {processor_ms(lambda: crouch(ADULT, wish, rise(ADULT))):16.2f}")
    for count in (500, 1000, 2000, 4000):
        start = time.process_time()
        best = [sample(ADULT, wish, rise(ADULT), count=count, seed=seed) for seed in range(8)]
        took = (time.process_time() - start) / 8 * 1e3
        columns = [(np.array([b.depth for b in best]), 3), (np.array([b.balance for b in best]) * 100, 2),
                   (np.array([b.momentum[1] for b in best]) / (73 * wish), 3)]
        print(f"  {count:4d} samples  " + "  ".join(f"  {np.median(c):5.{n}f} ({c.min():.{n}f} … {c.max():.{n}f})" for c, n in columns)
              + f"  {took:14.1f}")
    print()


def thrusts() -> list:
    """The thesis's thrust by joint torques beside the force profile that plans use."""
    print("Thrust by joint torques from the crouch that was found for a speed, fully active; and shot to meet that speed straight up\n"
          "  wanted m/s  reached  share | activation  last muscle s  up m/s  forward  push s  peak BW  hip  knee  ankle rad/s  heel deg")
    for wish in (1.4, speed(0.2), speed(0.3), speed(0.35), speed(0.4)):
        found = crouch(ADULT, wish, rise(ADULT))
        full, shot = extend(ADULT, found), shoot(ADULT, found, wish)
        rates = np.abs(np.diff(shot.bends, axis=0)[:-1] / np.diff(shot.times)[:-1, None]).max(0)
        print(f"  {wish:10.2f}  {full.velocity[-1, 1]:7.2f}  {full.velocity[-1, 1] / wish:5.3f} | {shot.activation:10.3f}  {shot.delays[2]:13.3f}"
              f"  {shot.velocity[-1, 1]:6.3f}  {shot.velocity[-1, 0]:7.3f}  {shot.duration:6.3f}  {shot.force[:, 1].max() / (73 * G):7.2f}"
              f"  {rates[0]:3.0f}  {rates[1]:4.0f}  {rates[2]:11.0f}  {np.degrees(shot.turns[-1, 0]):8.0f}")
    wish = speed(0.35)
    found = crouch(ADULT, wish, rise(ADULT))
    profile = push(np.array([0.0, found.depth + rise(ADULT), 0.0]), np.zeros(3), np.array([0.0, wish, 0.0]), np.array([0.0, -G, 0.0]))
    forces = profile.force(np.linspace(0, profile.duration, 200))[:, 1] / G
    print(f"  One shot: {processor_ms(lambda: shoot(ADULT, found, wish)):.2f} ms of processor")
    print("Its readings, from the crouch for 0.35 m (2.62 m/s)\n  thrust                              v up  forward  push-off s  peak BW  work J  gained J")
    print(f"  force profile                      {wish:5.2f}  {0.0:7.2f}  {profile.duration:10.3f}  {forces.max():7.2f}")
    runs = []
    for name, options in (("whole chain, 1/3840 s", dict(dt=1 / 3840)), ("whole chain, 1/960 s", dict(dt=1 / 960)), ("whole chain, 1/240 s", dict(dt=1 / 240)),
                          ("whole chain, all at once", dict(delays=(0, 0, 0))), ("whole chain, explicit Euler", dict(integration="explicit")),
                          ("whole chain, Runge-Kutta 1/240 s", dict(integration="runge-kutta", dt=1 / 240)),
                          ("each joint by itself", dict(inertia="moved")), ("as printed (τ = m a)", dict(inertia="printed", integration="explicit"))):
        run = extend(ADULT, found, **options)
        print(f"  {name:32}  {run.velocity[-1, 1]:5.2f}  {run.velocity[-1, 0]:7.2f}  {run.duration:10.3f}"
              f"  {run.force[:, 1].max() / (73 * G):7.2f}  {run.work:6.0f}  {run.energy:8.0f}{'' if run.extended else '   not extended'}")
        runs.append((name, run))
    for reading, arm in READINGS:
        v = 0.8 * strongest(ADULT, rise(ADULT), G, reading, arm)
        run = extend(ADULT, crouch(ADULT, v, rise(ADULT), reading=reading, arm=arm))
        print(f"  springs {reading}, arm {arm + ',':9} {v:4.2f} m/s {run.velocity[-1, 1]:6.2f}  {run.velocity[-1, 0]:7.2f}  {run.duration:10.3f}"
              f"  {run.force[:, 1].max() / (73 * G):7.2f}  {run.work:6.0f}  {run.energy:8.0f}{'' if run.extended else '   not extended'}")
    print()
    return runs


def draw(folder: Path, runs, poses, by_height, thrusts) -> None:
    """The figures."""
    plt = pyplot()
    figure, (a, b) = plt.subplots(1, 2, figsize=(9, 3.2))
    for k_p, k_d, found in runs:
        if (k_p, k_d) in ((0.05, 0.1), (0.1, 0.1), (0.3, 0.1), (0.75, 0.1), (0.3, 0.9)):
            style = dict(label=f"k_p {k_p}, k_d {k_d}", lw=2.2 if (k_p, k_d) == (0.3, 0.1) else 1.1)
            a.plot(found.history.centre[0, 1] - found.history.centre[:, 1], **style)
            b.plot(found.history.balance * 100, **style)
    a.set(xlabel="iteration", ylabel="depth of the centre of mass [m]", title="Table 3.1: how the constants steer", xlim=(0, 90))
    b.set(xlabel="iteration", ylabel="balance error [cm]", xlim=(0, 90))
    a.legend(fontsize=7)
    figure.savefig(folder / "table_3_1_control.png")
    plt.close(figure)

    figure, (a, b) = plt.subplots(1, 2, figsize=(9, 3.2))
    bends = np.radians(np.linspace(0, 160, 200))
    for k in (20e3, STIFFNESS, 40e3):
        line, = a.plot(np.degrees(bends), spring_force(bends, Muscle(k, WIDTH)), label=f"wedge, k = {k / 1e3:.1f} kN/m")
        a.plot(np.degrees(bends), spring_force(bends, Muscle(k, WIDTH, True)), "--", color=line.get_color())
    a.set(xlabel="bend [deg]", ylabel="spring force [N]", ylim=(0, 7000), title="Springs: wedge (lines), printed (dashes)")
    a.legend(fontsize=7)
    for name, physique in BODIES:
        able = strength(physique)
        b.plot(able.depth, able.force / (physique.mass * G), label=name)
    deep = np.linspace(0.05, 0.4, 100)
    for height in (0.3, 0.35, 0.4):
        b.plot(deep, 1 + height / (deep + rise(ADULT)), "k:", lw=0.8)
        b.annotate(f"needed for {height} m", (deep[30], 1 + height / (deep[30] + rise(ADULT))), fontsize=7)
    b.set(xlabel="depth [m]", ylabel="ground force [body weights]", ylim=(1, 3), title="What bodies can give, what a jump needs")
    b.legend(fontsize=7)
    figure.savefig(folder / "force.png")
    plt.close(figure)

    figure, axes = plt.subplots(1, len(poses), figsize=(2.2 * len(poses), 3.4), sharey=True)
    for axis, (name, found) in zip(axes, poses):
        stick(axis, found)
        axis.set_title(f"{name}\ndepth {found.depth:.2f} m, knee {np.degrees(found.bends[1]):.0f}°", fontsize=8)
    figure.suptitle("Table 3.2: stiffer springs, smaller crouch (0.20 m jump)", y=1.04)
    figure.savefig(folder / "table_3_2_poses.png")
    plt.close(figure)

    figure, (a, b) = plt.subplots(1, 2, figsize=(9, 3.6))
    for height, found in by_height:
        polygon = hull(_corners(found))
        depths = found.history.centre[0, 1] - found.history.centre[:, 1]
        a.plot(depths, found.history.centre[:, 2] * 100, label=f"{height} m")
    for edge in (polygon[:, 1].min(), polygon[:, 1].max()):
        a.axhline(edge * 100, color="k", lw=1.5)
    a.set(xlabel="depth [m]", ylabel="centre of mass, forward [cm]", ylim=(-15, 15),
          title="Balance between heels and toes (black)")
    a.legend(fontsize=7)
    for height, found in by_height:
        b.plot(found.history.required / (73 * G), ":", lw=1)
        b.plot(found.history.force / (73 * G), color=b.lines[-1].get_color(), label=f"{height} m")
    b.set(xlabel="iteration", ylabel="ground force [body weights]", ylim=(1, 4), title="Force error: needed (dots) and given")
    b.legend(fontsize=7)
    figure.savefig(folder / "balance.png")
    plt.close(figure)

    figure, axis = plt.subplots(figsize=(9, 3))
    heights = measures(ADULT)
    for far, up in ((0.6, 0.0), (1.2, 0.0), (1.2, 0.4), (1.5, -1.0)):
        start, end = np.array([0.0, heights.leave(0.0), 0.0]), np.array([0.0, heights.touch(0.0) + up, far])
        airtime = max(least_effort(start, end), 0.3)
        velocity = take_off_velocity(start, end, airtime)
        arc = along(start, velocity, np.linspace(0, airtime, 60))
        axis.plot(arc[:, 2], arc[:, 1], label=f"{far} m far, {up:+.1f} m: {airtime:.2f} s, {np.linalg.norm(velocity):.2f} m/s")
        axis.plot([far - 0.15, far + 0.15], [up, up], "k", lw=2)
    axis.set(aspect="equal", xlabel="forward [m]", ylabel="height [m]", title="Path estimate: centres of mass, least effort")
    axis.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(folder / "path.png")
    plt.close(figure)

    figure, (a, b) = plt.subplots(1, 2, figsize=(9, 3.2))
    name, run = thrusts[0]
    for k, joint in enumerate(("hip", "knee", "ankle")):
        a.plot(run.times, np.degrees(run.bends[:, k]), label=joint)
    a.plot(run.times, np.degrees(run.turns[:, 0]), "--", label="heel's rise")
    a.set(xlabel="time [s]", ylabel="bend [deg]", title="Thrust by joint torques, hip first")
    a.legend(fontsize=7)
    for name, run in thrusts[:1] + thrusts[3:4] + thrusts[6:7]:
        b.plot(run.times, run.force[:, 1] / (73 * G), label=name)
    found = by_height[3][1]
    profile = push(np.array([0.0, found.depth + rise(ADULT), 0.0]), np.zeros(3), np.array([0.0, speed(0.35), 0.0]), np.array([0.0, -G, 0.0]))
    times = np.linspace(0, profile.duration, 100)
    b.plot(times, profile.force(times)[:, 1] / G, "k", label="force profile of the plan")
    b.set(xlabel="time [s]", ylabel="ground force [body weights]", ylim=(0, 3), title="0.35 m")
    b.legend(fontsize=7)
    figure.savefig(folder / "thrust.png")
    plt.close(figure)
    print(f"figures: {', '.join(sorted(p.name for p in folder.glob('*.png')))} in {folder}")


def _corners(found: Crouch) -> np.ndarray:
    placed = forward_kinematics(ADULT.skeleton, found.pelvis, found.rotations)
    heels = found.feet[:, 4] < 0.02
    return sole_corners(ADULT.skeleton, *placed)[standing_corners([heels[0], True, heels[1], True])][:, [0, 2]]


def stick(axis, found: Crouch) -> None:
    """A crouched body from its left, its centre of mass and the ground's force."""
    skeleton = ADULT.skeleton
    positions, _ = forward_kinematics(skeleton, found.pelvis, found.rotations)
    for j, parent in enumerate(skeleton.parents):
        if parent >= 0 and not skeleton.names[j].startswith("Right"):
            axis.plot(*positions[[parent, j]][:, [2, 1]].T, color="0.3", lw=2.5, solid_capstyle="round")
    axis.plot(found.centre[2], found.centre[1], "o", color="tab:red", ms=5)
    force = found.force / (73 * G) * 0.25
    axis.annotate("", (found.centre[2] + force[2], force[1]), (found.centre[2], 0.0), arrowprops=dict(arrowstyle="->", color="tab:blue"))
    axis.axhline(0, color="0.6", lw=1)
    axis.set(aspect="equal", xlim=(-0.6, 0.6), ylim=(-0.05, 1.75))
    axis.grid(False)


def main() -> None:
    """Print the tables; draw the figures if asked."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--plots", type=Path, metavar="FOLDER", help="where the figures go")
    options = parser.parse_args()
    pictures(parser, options.plots)
    runs = controls()
    poses = springs()
    limits()
    by_height = heights()
    sampling()
    thrust = thrusts()
    if options.plots:
        draw(options.plots, runs, poses, by_height, thrust)


if __name__ == "__main__":
    main()
