"""Playing a controller through wishes, and what is told from the motion that comes out."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, forward_kinematics
from gambol.controllers.body.contact import contact_points
from gambol.controllers.body.ground_frame import relative
from gambol.controllers.contract import Intent

FPS = 60
WISHES = ((1.0, 0, 0), (0.5, 0, 0), (1.3, 0, 0), (0.9, 0.6, 0), (0.9, -0.6, 0), (0, 0, 0.4), (0, 0, -0.4), (0.5, 0, 0.35),
          (0.5, 0, -0.35), (-0.5, 0, 0), (0, 1.2, 0), (0, -1.2, 0), (0.4, 0.8, 0), (2.5, 0, 0), (3.0, 0.3, 0))


@dataclass
class Motion:
    """T frames of N characters: grounds (T, N, 3), roots (T, N, 3), rotations (T, N, J, 3, 3), positions
    (T, N, J, 3) and contact points (T, N, 4, 3) in the world; the states they come from; the wishes."""

    ground: np.ndarray
    root: np.ndarray
    rotations: np.ndarray
    positions: np.ndarray
    orientations: np.ndarray
    points: np.ndarray
    states: list
    wish: np.ndarray

    def clip(self, n, skeleton, name, start=0):
        """The motion of one character as a clip."""
        quaternions = Rotation.from_matrix(self.rotations[start:, n]).as_quat()
        return Clip(name, skeleton, 1 / FPS, self.root[start:, n], quaternions)


def play(locomotion, wish, ground=None, dt=1 / FPS):
    """The motion of N characters from rest through wishes (T, N, 3)."""
    wish = np.asarray(wish, float)
    state = locomotion.start(np.zeros(wish.shape[1:]) if ground is None else ground)
    states, roots, rotations = [], [], []
    for w in wish:
        state, pose = locomotion.step(state, Intent(w), dt)
        states.append(state)
        roots.append(pose.root)
        rotations.append(pose.rotations)
    root, rotations = np.array(roots, float), np.array(rotations, float)
    positions, orientations = forward_kinematics(locomotion.skeleton, root, rotations)
    points = contact_points(locomotion.skeleton, positions, orientations)
    return Motion(np.array([s.ground for s in states]), root, rotations, positions, orientations, points, states, wish)


def hold(seconds, *wishes):
    """Constant wishes (T, N, 3) of as many characters."""
    return np.broadcast_to(np.array(wishes, float), (round(seconds * FPS), len(wishes), 3))


def whims(rng, seconds, count):
    """Wishes (T, N, 3) that change at a whim, every third of a second to every three: any way, or a stop, or a run."""
    frames = round(seconds * FPS)
    wish = np.zeros((frames, count, 3))
    for n in range(count):
        at = 0
        while at < frames:
            until = at + int(rng.integers(20, 180))
            kind = rng.random()
            if kind < 0.65:
                wish[at:until, n] = rng.normal(size=3) * [0.8, 0.8, 0.35]
            elif kind < 0.80:
                wish[at:until, n] = rng.uniform(1.9, 3.5), rng.normal() * 0.4, 0
            at = until
    return wish


def mean_velocity(ground):
    """Mean (v_f, ω, v_l) (..., 3) of ground frames (T, ..., 3) from frame to frame."""
    step = relative(ground[:-1], ground[1:])
    step[..., 2] = (step[..., 2] + np.pi) % (2 * np.pi) - np.pi
    return step.mean(0)[..., [1, 2, 0]] * FPS
