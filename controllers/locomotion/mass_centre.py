"""A gait's mass centre goes as feet can push it: straight on while none stands, and around a curve while one does.

Recorded strides of turning runs are no whole cycles, and what closes them bends the mass centre's way where there is
nothing to push on. The hips are shifted so that friction is in bounds again, and the feet stay where they are.
"""

from __future__ import annotations

import numpy as np

from ..body import (anatomy, centre_of_mass, forward_kinematics, human, local_rotations, pole_of, rotations as rot,
                    two_bone_turns)
from . import fourier
from .library import DURATION, HIPS, LABELS

GRAVITY = 9.81
FRICTION = 0.45
"""The most that the ground gives sideways over what it gives upward: a little less than shoes have …"""
LIGHTEST = 0.1
"""… where nothing stands, over this share of the weight: recorded flights are no exact parabolas."""
ROUNDS = 40
INSTANTS = 128


def pushable(samples: np.ndarray, reference: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """One cycle's channels (S, D), as `channels` has them, its hips shifted along the floor so that its mass centre asks for
    no more friction than FRICTION on a way of constant velocity (3,) forward, turning, lateral [m/s, rad/s]. Feet stay."""
    skeleton = human()
    count = len(samples)
    local = reference @ rot.exp(samples[:, :HIPS].reshape(count, -1, 3))
    hips = samples[:, HIPS:LABELS]
    positions, orientations = forward_kinematics(skeleton, hips, local)
    shift = _shift(centre_of_mass(anatomy(skeleton), positions, orientations), samples[:, DURATION], velocity)
    if np.abs(shift).max() < 1e-4:
        return samples
    moved = hips + np.stack([np.real(shift), np.zeros(count), np.imag(shift)], -1)
    there, orientations = forward_kinematics(skeleton, moved, local)
    for side in ("Left", "Right"):
        hip, knee, foot = (skeleton.index(side + name) for name in ("UpLeg", "Leg", "Foot"))
        limb = there[:, hip], there[:, knee], there[:, foot]
        pole = pole_of(*limb) + 0.02 * orientations[:, hip, :, 2]
        upper, lower = two_bone_turns(*limb, positions[:, foot], pole)
        orientations[:, hip], orientations[:, knee] = upper @ orientations[:, hip], lower @ orientations[:, knee]
    result = samples.copy()
    chart = rot.log(np.swapaxes(reference, -1, -2) @ local_rotations(skeleton, orientations))
    result[:, :HIPS], result[:, HIPS:LABELS] = chart.reshape(count, -1), moved
    return result


def _shift(centre: np.ndarray, duration: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """How far to shift a mass centre (S, 3) [m] whose phase runs at dt/dφ = duration (S,): x + iz (S,) in the ground frame.

    With places along the floor as x + iz, a frame of velocity V = v_l + i v_f that turns by ω sees the acceleration
    u″ − 2iω u′ − ω²u − iωV, which is one number for each harmonic.
    """
    phase = np.arange(len(duration)) / len(duration)
    time = fourier.evaluate(fourier.fit(duration[:, None]), phase)[:, 0]
    time = np.concatenate([[0.0], np.cumsum(0.5 * (time + np.roll(time, -1)))]) / len(duration)
    period = time[-1]
    instants = np.arange(INSTANTS) / INSTANTS * period
    u, height = (np.interp(instants, time, np.append(x, x[0])) for x in (centre[:, 0] + 1j * centre[:, 2], centre[:, 1]))
    k = np.fft.fftfreq(INSTANTS, 1 / INSTANTS)
    inner = np.abs(k) <= fourier.HARMONICS
    rate = 2 * np.pi * k / period
    u, rise = np.fft.fft(u) * inner, np.fft.ifft(-rate**2 * np.fft.fft(height) * inner).real
    most = FRICTION * np.maximum(GRAVITY + rise, LIGHTEST * GRAVITY)
    share = most / most.mean()
    gain = -(rate - velocity[1]) ** 2 * inner
    gain[0] = 1.0
    mean = -velocity[1] ** 2 * u[0] / INSTANTS - 1j * velocity[1] * (velocity[2] + 1j * velocity[0])
    wanted = gain * u
    wanted[0] = mean * INSTANTS
    wanted = np.fft.ifft(wanted)
    for _ in range(ROUNDS):
        wanted = wanted * np.minimum(1.0, most / np.maximum(np.abs(wanted), 1e-9))
        wanted = np.fft.ifft(np.fft.fft(wanted + (mean - wanted.mean()) * share) * inner)
    shifted = np.fft.fft(wanted) * inner / np.where(inner, gain, 1.0)
    shifted[0] = u[0]
    change = np.fft.ifft(shifted - u)
    return np.interp(time[:-1], np.append(instants, period), np.append(change, change[0]))
