"""Measure what people do: start, stop, turn, change gait, at every phase, and twice ten minutes of restless hands.

    python scripts/measure/changes.py [--quick] [--recordings DIR] [--strips DIR] [--only PART ...] [--set SETTING=VALUE ...] [--heights M ... --rates N ...]

All figures are told from the final pose alone (`_motion.py`): mass centre by segment masses, friction that the ground
must give, joint accelerations over the recordings' own 99th percentile, feet. DIR is the folder of motion capture: the
same figures of its actor's starts, stops, crossings and idles are printed beside ours. --strips draws the ten worst
moments of every part as stick figures. --heights and --rates measure restless hands of bodies so high, stepped so many
times a second, instead.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from _bodies import bodies
from _figures import at_rest, figures, told
from _motion import Motion
from _plots import pictures
from _recorded import recorded
from _strips import draw


from gambol.controllers.contract import Intent
from gambol.controllers.jump import Physique
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Library, Locomotion, Settings
from gambol.controllers.navigation import steer

FPS, STANDARD = 60, Physique().height
PHASES = 24
WISHES = {"rest": (0, 0, 0), "0.7": (0.7, 0, 0), "1.3": (1.3, 0, 0), "1.8": (1.8, 0, 0), "2.5": (2.5, 0, 0), "3.5": (3.5, 0, 0),
          "left": (0, 0, 0.45), "right": (0, 0, -0.45), "back": (-0.6, 0, 0), "spot left": (0, 1.5, 0), "spot right": (0, -1.5, 0),
          "diagonal left": (0.6, 0, 0.35), "diagonal right": (0.6, 0, -0.35)}
SETTLE, AFTER = 5.0, 2.5
"""Seconds before a change, in which a gait comes to be steady, and those after it that are judged."""
PARTS = ("pairs", "sticks", "keys", "steady", "steps", "idle")


@dataclass(frozen=True)
class Bench:
    """What is measured, and how much of it."""

    locomotion: Locomotion
    quick: bool

    def motion(self, states) -> Motion:
        """The motion of states (T of them) of N characters."""
        return Motion(self.locomotion.skeleton, FPS, np.array([s.pose.root for s in states]),
                      np.array([s.pose.rotations for s in states]), self.locomotion.library.accelerations)

    def played(self, state, wishes, dt=1 / FPS):
        """The states after each of some wishes."""
        states = []
        for wish in wishes:
            state, _ = self.locomotion.step(state, Intent(np.asarray(wish, float)), dt)
            states.append(state)
        return states

    def at_all_phases(self, wish):
        """One state of PHASES characters, each at another phase of the same steady gait."""
        steady = self.played(self.locomotion.start(), [wish] * round((SETTLE + 2.5) * FPS))[round(SETTLE * FPS):]
        phase = np.array([s.memory["phase"] for s in steady])
        if np.ptp(phase) < 0.5:  # at rest: any moment
            chosen = [steady[k] for k in np.linspace(0, len(steady) - 1, PHASES).astype(int)]
        else:
            wanted = np.arange(PHASES) / PHASES
            chosen = [steady[int(np.abs((phase - w + 0.5) % 1 - 0.5).argmin())] for w in wanted]
        memory = np.array([s.memory for s in chosen])
        # everyone at the origin, looking the same way
        return replace(self.locomotion.start(memory["ground"]), memory=memory, ground=np.zeros((PHASES, 3)))


    def up_to_speed(self, speed: float) -> float:
        """From where on somebody has a speed straight on [m/s]: nine tenths of it, or what the mass centre of a steady gait falls to, where that is less."""
        state = self.at_all_phases((speed, 0, 0))
        steady = self.motion(self.played(state, [(speed, 0, 0)] * FPS))
        return min(0.9 * speed, steady.com_velocity[5:-5, :, 2].min() - 0.01)


def pairs(bench: Bench):
    """Every pair of wishes at every phase: figures by pair, and the worst moments."""
    print(f"Changes: {PHASES} phases each. Mass centre: lowest speed along the old way (mean, worst phase) m/s · peak acceleration "
          "(median, worst) m/s²\n         · friction over 0.6 / over 1, % of frames · joints over 3×, % of frames; worst · feet apart, least cm")
    worst, everything = [], []
    names = list(WISHES)
    for before in names:
        state = bench.at_all_phases(WISHES[before])
        for after in names:
            if after == before or (bench.quick and (before, after) not in QUICK):
                continue
            states = bench.played(state, [WISHES[before]] * 4 + [WISHES[after]] * round(AFTER * FPS))
            motion = bench.motion(states)
            row = figures(motion)
            everything.append(row)
            lowest = motion.com_velocity[..., 2].min(0)
            a = np.linalg.norm(motion.com_acceleration[..., [0, 2]], axis=-1).max(0)
            print(f"  {before:>14s} → {after:14s} {lowest.mean():5.2f} {lowest.min():5.2f}   {np.median(a):5.1f} {a.max():5.1f}   "
                  f"{row['over06']:5.2f} {row['over1']:5.2f}   {row['joints3']:5.2f} {row['joint']:5.1f}   {row['apart']:5.1f}", flush=True)
            n = int(motion.joints.max((0, 2)).argmax())
            t = int(motion.joints[:, n].max(-1).argmax())
            worst.append((float(motion.joints[t, n].max()), f"{before} → {after}", motion, n, t))
    print("  all: " + told(everything))
    stops(bench)
    return sorted(worst, key=lambda w: -w[0])[:10]


QUICK = {("2.5", "1.3"), ("rest", "1.3"), ("1.3", "rest"), ("2.5", "rest"), ("1.3", "2.5"), ("1.3", "left"), ("1.3", "back"),
         ("rest", "spot left"), ("1.3", "0.7"), ("back", "1.3"), ("left", "right"), ("rest", "2.5"), ("1.3", "diagonal left")}


def stops(bench: Bench) -> None:
    """The three changes that are told by name: a run slowed to a walk, a run stopped, a walk begun."""
    state = bench.at_all_phases((2.8, 0, 0))
    motion = bench.motion(bench.played(state, [(1.3, 0, 0)] * round(3 * FPS)))
    lowest, peak = motion.com_velocity[..., 2].min(0), np.linalg.norm(motion.com_acceleration[..., [0, 2]], axis=-1).max(0)
    print(f"  2.8 → 1.3 m/s: lowest speed {lowest.mean():.2f}, worst {lowest.min():.2f} m/s; peak {np.median(peak):.1f}, worst {peak.max():.1f} m/s²")
    state = bench.at_all_phases((3.0, 0, 0))
    motion = bench.motion(bench.played(state, [(0, 0, 0)] * round(3 * FPS)))
    lowest, peak = motion.com_velocity[..., 2].min(0), np.linalg.norm(motion.com_acceleration[..., [0, 2]], axis=-1).max(0)
    speed = np.linalg.norm(motion.com_velocity[..., [0, 2]], axis=-1)
    stops = np.array([(np.flatnonzero(s > 0.15)[-1] + 1) / FPS for s in speed.T])
    way = motion.com[-1, :, 2] - motion.com[0, :, 2]
    print(f"  3.0 m/s → stop: lowest speed {lowest.mean():.2f}, worst {lowest.min():.2f} m/s; peak {np.median(peak):.1f}, worst {peak.max():.1f} m/s²; "
          f"{stops.mean():.2f} s (slowest {stops.max():.2f}), {way.mean():.2f} m (longest {way.max():.2f}); "
          f"trunk leans {motion.lean[0].mean():+.0f}° before, {motion.lean.mean(1).min():+.0f}° as he brakes, {motion.lean[-1].mean():+.0f}° in the end")
    state = bench.at_all_phases((0, 0, 0))
    motion = bench.motion(bench.played(state, [(1.3, 0, 0)] * round(3 * FPS)))
    peak = np.linalg.norm(motion.com_acceleration[:45][..., [0, 2]], axis=-1).max(0)
    quick = np.argmax(motion.com_velocity[..., 2] > 0.9 * 1.3, axis=0) / FPS
    print(f"  rest → 1.3 m/s: mass centre at 90 % after {quick.mean():.2f} s (slowest {quick.max():.2f}); peak {np.median(peak):.1f}, worst {peak.max():.1f} m/s²")


def hands(rng: np.random.Generator, frames: int, count: int):
    """What restless hands ask for: directions (T, N, 2) in the world [m/s], and headings (T, N) to hold, or NaN.

    A stick (half the hands) or keys: a way is held for 0.3 to 3 s, taken in 0.1 s (keys at once), the run key held or
    let go of meanwhile, at times everything let go of, at times a look held while moving.
    """
    move, face = np.zeros((frames, count, 2)), np.full((frames, count), np.nan)
    for n in range(count):
        keys, at, angle = n % 2 == 0, 0, rng.uniform(-np.pi, np.pi)
        wanted = np.zeros((frames, 2))
        while at < frames:
            until = at + int(np.clip(rng.exponential(70), 18, 200))
            kind = rng.random()
            if kind < 0.25:
                speed = 0.0
            elif kind < 0.75:
                angle = rng.integers(8) * np.pi / 4 if keys else angle + rng.normal() * 0.9
                speed = rng.choice([0.7, 1.3, 1.3, 3.0]) if keys else rng.uniform(0.2, 3.0) if rng.random() < 0.3 else rng.uniform(0.2, 1.4)
            else:  # the run key, on the same way
                speed = 3.0 if rng.random() < 0.5 else 1.3
            wanted[at:until] = speed * np.sin(angle), speed * np.cos(angle)
            if rng.random() < 0.15:
                face[at:until, n] = rng.uniform(-np.pi, np.pi)
            at = until
        if not keys:
            for t in range(1, frames):
                wanted[t] = wanted[t - 1] + (wanted[t] - wanted[t - 1]) * (1 - 2 ** (-1 / FPS / 0.03))
        move[:, n] = wanted
    return move, face


def bursts(rng: np.random.Generator, frames: int, count: int):
    """What hands in a hurry ask for, as `hands`: the eight ways of keys, all or nothing, for 0.15 to 2 s, the run key pressed and let go of,
    the way back, taps of 0.08 to 0.4 s; every third holds a stick instead, in circles and tilted by a fifth to three fifths; every fourth
    holds a look."""
    move, face = np.zeros((frames, count, 2)), np.full((frames, count), np.nan)
    for n in range(count):
        at, run, angle, speeds = 0, False, 0.0, (1.3, 3.0)
        while at < frames:
            kind, seconds, speed, turning = rng.random(), float(np.clip(rng.exponential(0.9), 0.15, 2.0)), speeds[run], 0.0
            if kind < 0.2:
                speed, seconds = 0.0, rng.uniform(0.15, 1.2)
            elif kind < 0.3:
                angle, seconds = angle + rng.integers(8) * np.pi / 4, rng.uniform(0.08, 0.4)
            elif kind < 0.45:
                run = not run
                speed = speeds[run]
            elif kind < 0.55:
                angle += np.pi
            elif kind < 0.8 or n % 3:
                angle += rng.choice([-2, -1, 1, 2]) * np.pi / 4
            elif kind < 0.9:
                speed *= rng.uniform(0.2, 0.6)
            else:
                turning = rng.choice([-1, 1]) * rng.uniform(0.8, 4.0)
            if n % 4 == 3 and rng.random() < 0.2:
                face[at:, n] = angle if np.isnan(face[at, n]) else np.nan
            until = min(at + max(round(seconds * FPS), 1), frames)
            ways = angle + turning * np.arange(until - at) / FPS
            move[at:until, n] = speed * np.stack([np.sin(ways), np.cos(ways)], -1)
            at, angle = until, float(ways[-1])
    return move, face


def keys(bench: Bench):
    """Ten minutes of hands in a hurry."""
    return sticks(bench, bursts, "Hands in a hurry")


def sticks(bench: Bench, asks=hands, name="Hands"):
    """Ten minutes of restless hands: twenty characters for thirty seconds."""
    frames, count = (12 if bench.quick else 30) * FPS, 20
    move, face = asks(np.random.default_rng(13), frames, count)
    state, states = bench.locomotion.start(np.zeros((count, 3))), []
    for t in range(frames):
        wish = steer(state.ground, move[t], face[t], state.velocity[:, 1])
        state, _ = bench.locomotion.step(state, wish, 1 / FPS)
        states.append(state)
    motion = bench.motion(states)
    print(f"{name}: {frames * count // 60 / FPS:.0f} minutes of twenty restless pairs\n  " + told([figures(motion)]))
    moments = sorted(((float(motion.joints[t:t + 30, n].max()), name.lower(), motion, n, t + int(motion.joints[t:t + 30, n].max(-1).argmax()))
                      for n in range(count) for t in range(0, frames - 30, 30)), key=lambda m: -m[0])
    return moments[:10]


def steady(bench: Bench):
    """What is asked against what is got, and the knee at toe-off, at every speed."""
    fastest = float(bench.locomotion.library.velocities[:, 0].max())
    speeds = np.arange(0.1, fastest, 0.1 if not bench.quick else 0.3)
    wish = np.zeros((len(speeds), 3))
    wish[:, 0] = speeds
    state = bench.played(bench.locomotion.start(np.zeros((len(speeds), 3))), [wish] * 5 * FPS)[-1]
    later = bench.played(state, [wish] * 8 * FPS)
    got = np.hypot(*(later[-1].ground - state.ground)[:, :2].T) / 8.0
    off = got - speeds
    print(f"Steady: asked → got, m/s: worst {np.abs(off).max():.3f} at {speeds[np.abs(off).argmax()]:.1f}; over 0.02 at "
          + (", ".join(f"{s:.1f} ({o:+.2f})" for s, o in zip(speeds, off) if abs(o) > 0.02) or "none"))
    wish = np.array([(0.4, 0, 0), (0.7, 0, 0), (1.0, 0, 0), (1.3, 0, 0), (1.5, 0, 0), (1.6, 0, 0), (-0.4, 0, 0), (-0.6, 0, 0), (0, 0, 0.45)])
    motion = bench.motion(bench.played(bench.locomotion.start(np.zeros((len(wish), 3))), [wish] * 9 * FPS)[4 * FPS:])
    knees = [motion.skeleton.index(side + "Leg") for side in ("Left", "Right")]
    print("  knees' acceleration over the recordings' own: " + ", ".join(
        f"{w[0] or w[2]:.1f} m/s {motion.joints[:, n][:, knees].max():.1f}×" for n, w in enumerate(wish)))
    print("  " + told([figures(motion)]))
    return []


def steps(bench: Bench):
    """The same script at 30 and at 144 steps a second."""
    rng = np.random.default_rng(5)
    script = rng.normal(size=(12, 6, 3)) * [1.2, 0.6, 0.2]
    script[::4] = 0.0
    ends = []
    for rate in (30, 144):
        state = bench.locomotion.start(np.zeros((6, 3)))
        for wish in script:
            state = bench.played(state, [wish] * round(1.5 * rate), 1 / rate)[-1]
        ends.append(state.ground)
    apart = np.hypot(*(ends[0] - ends[1])[:, :2].T)
    script = [(1.0, 0, 0), (0, 0, 0), (1.3, 0.5, 0), (0, 0, 0)]
    one = []
    for rate in (30, 144):
        state = bench.locomotion.start()
        for wish in script:
            state = bench.played(state, [wish] * 2 * rate, 1 / rate)[-1]
        one.append(state.ground)
    print(f"Steps: 30 against 144 a second: straight, stop, curve, stop ends {np.hypot(*(one[0] - one[1])[:2]):.3f} m apart; six random "
          f"scripts of 18 s {apart.mean():.3f} m (worst {apart.max():.3f})")
    return []


def idle(bench: Bench):
    """Thirty seconds of nothing to do."""
    motion = bench.motion(bench.played(bench.locomotion.start(np.zeros((4, 3))), [(0, 0, 0)] * 30 * FPS))
    print("Idle, 30 s: " + at_rest(motion))
    return []


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--library", default=DEFAULT_LIBRARY)
    parser.add_argument("--quick", action="store_true", help="a dozen pairs and four minutes of hands")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--recordings", type=Path, help="the folder of motion capture")
    parser.add_argument("--strips", type=Path, help="a folder for the worst moments")
    parser.add_argument("--set", nargs="+", default=[], metavar="NAME=VALUE", help="settings other than the usual")
    parser.add_argument("--heights", nargs="+", type=float, default=[], metavar="M", help="bodies so high instead")
    parser.add_argument("--rates", nargs="+", type=int, default=[], metavar="N", help="stepped so many times a second instead")
    parser.add_argument("--seed", type=int, default=13, help="of their hands")
    arguments = parser.parse_args()
    pictures(parser, arguments.strips)
    library = Library.load(arguments.library)
    try:
        given = Settings(**{name: float(value) for name, _, value in (one.partition("=") for one in arguments.set)})
    except (TypeError, ValueError) as error:
        parser.error(f"--set: needs NAME=VALUE of {', '.join(Settings._fields)} ({error})")
    bench = Bench(Locomotion(library, given), arguments.quick)
    if arguments.heights or arguments.rates:
        bodies(bench.locomotion, arguments.heights or [STANDARD], arguments.rates or [FPS], hands, arguments.seed)
        return
    if arguments.recordings:
        recorded(arguments.recordings, library)
    for part in arguments.only:
        worst = globals()[part](bench)
        if arguments.strips and worst:
            draw(worst, arguments.strips, part)


if __name__ == "__main__":
    main()
