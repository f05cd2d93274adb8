"""The figures of a motion, and how they are told in a line."""

from __future__ import annotations

import numpy as np

from _motion import Motion


def figures(motion: Motion) -> dict[str, float]:
    """The figures of one motion."""
    worst = motion.joints.max(-1)
    walking = ~motion.running
    slips = {name: (100 * (motion.friction[who] > 0.6).mean(), 100 * (motion.friction[who] > 1.0).mean()) if who.any() else (0.0, 0.0)
             for name, who in (("walk", walking), ("run", ~walking))}
    drift = motion.drift()
    scuffs = motion.scuffs()
    return dict(frames=worst.size, walk06=slips["walk"][0], walk1=slips["walk"][1], run06=slips["run"][0], run1=slips["run"][1],
                runs=float((~walking).mean()), over06=100 * (motion.friction > 0.6).mean(), over1=100 * (motion.friction > 1.0).mean(),
                joints3=100 * (worst[walking] > 3).mean() if walking.any() else 0.0, joint=float(worst[walking].max(initial=0.0)),
                joint_run=float(worst[~walking].max(initial=0.0)), apart=100 * float(motion.apart.min()),
                near=100 * float((motion.apart < 0.07).mean()), drift=100 * float(drift.mean()) if len(drift) else 0.0,
                air=motion.in_the_air(), drift_worst=100 * float(drift.max(initial=0.0)), scuffs=100 * float(scuffs.mean()) if len(scuffs) else 0.0,
                com=float(np.linalg.norm(motion.com_acceleration[..., [0, 2]], axis=-1).max()))


def told(rows, flies: bool = True) -> str:
    """Some motions' figures in one line. flies: whether for how long nobody touches the floor is told; of recordings it isn't, whose floor is a centimetre or two off."""
    frames, runs = (np.array([r[k] for r in rows], float) for k in ("frames", "runs"))

    def mean(name, weights=frames):
        return float(np.average([r[name] for r in rows], weights=weights + 1e-9))

    def most(name):
        return max(r[name] for r in rows)

    walking, running = frames * (1.0 - runs), frames * runs
    return (f"friction over 0.6, over 1: walking {mean('walk06', walking):.2f}, {mean('walk1', walking):.2f} %, running "
            f"{mean('run06', running):.1f}, {mean('run1', running):.1f} % · joints over 3× walking {mean('joints3'):.2f} %, worst "
            f"{most('joint'):.1f}× (runs {most('joint_run'):.1f}×) · drift a stance {mean('drift'):.2f} cm, worst {most('drift_worst'):.1f} · feet apart "
            f"{min(r['apart'] for r in rows):.1f} cm, under 7 cm in {mean('near'):.2f} % · scuffs {mean('scuffs'):.1f} % of swings above 1 m/s · "
            f"mass centre's peak {most('com'):.1f} m/s²" + (f" · in the air {most('air'):.2f} s at most" if flies else ""))


def at_rest(motion: Motion) -> str:
    """How the mass centre travels."""
    flat = motion.com[..., [0, 2]]
    every = motion.com[::motion.rate // 5][..., [0, 2]]
    return (f"mass centre within {100 * np.ptp(flat, axis=0).max(-1).mean():.1f} cm, its way "
            f"{100 * np.linalg.norm(np.diff(every, axis=0), axis=-1).sum(0).mean():.0f} cm")
