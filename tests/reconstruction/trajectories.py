"""Made-up motion: smooth, human-like in its ranges, and never twice the same."""

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, forward_kinematics
from gambol.controllers.reconstruction import pose_vector as chart
from gambol.controllers.reconstruction.database.database import Database, Writer

KINDS = 4


def frames(rng, count, kind):
    """Frames (count, WIDTH): a few shared rhythms, mixed as the kind of motion does, at a take's own pace."""
    mix = np.random.default_rng(kind).normal(0, 0.15, (8, chart.WIDTH))
    phase = np.cumsum(rng.uniform(0.05, 0.12) + 0.01 * rng.normal(size=count))[:, None]
    rhythms = np.concatenate([np.sin(phase * h + a) for h in (1, 2) for a in (0, 1.3)]
                             + [np.cumsum(rng.normal(0, 0.01, (count, 4)), 0)], 1)
    made = rhythms @ mix
    made[:, chart.HEIGHT] += 0.95
    return made


def database(path, takes=12, count=250, seed=0, mirrors=True) -> Database:
    """A database of made-up takes."""
    rng = np.random.default_rng(seed)
    with Writer(path, mirrors=mirrors) as writer:
        for number in range(takes):
            writer.add(f"clip{number}", f"subject{number % 3}", "walk", frames(rng, count, number % KINDS), np.ones(count, bool))
    return Database.open(path)


def calm_database(path) -> Database:
    """A small database of such motion at a third of its pace, so that it accelerates like a body."""
    rng = np.random.default_rng(0)
    with Writer(path, mirrors=False) as writer:
        for number in range(6):
            quick = frames(rng, 90, number % KINDS)
            slow = np.stack([np.interp(np.arange(0, 89, 1 / 3), np.arange(90), column) for column in quick.T], -1)
            slow[:, chart.YAW_RATE:] /= 3.0
            writer.add(f"clip{number}", "nobody", "walk", slow, np.ones(len(slow), bool))
    return Database.open(path)


def clip(seed, count=60, fps=60.0, name="made up"):
    """A clip of the standard human that moves every joint, anywhere, facing anywhere."""
    rng = np.random.default_rng(seed)
    track = np.concatenate([rng.uniform(-50, 50, 2), rng.uniform(-3, 3, 1)])
    made, tracks = frames(rng, count, seed % KINDS), []
    for frame in made:
        track = chart.advance(track, frame, 1 / fps)
        tracks.append(track)
    root, rotations = chart.decode(made, np.array(tracks))
    return Clip(name, chart.SKELETON, 1 / fps, root, Rotation.from_matrix(rotations).as_quat())


def played(method, performance, points, start):
    """Joint positions (T, J, 3) that a method makes of points (T, n, 3) from frame `start` on."""
    memory, found = method.begin(performance[0][:start], performance[1][:start]), []
    for seen in points[start:]:
        memory, pose = method.step(memory, seen)
        found.append(forward_kinematics(chart.SKELETON, pose.root, pose.rotations)[0])
    assert np.isfinite(found).all()
    return np.stack(found)
