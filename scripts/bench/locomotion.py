"""Time the walking controller: the blend alone and whole steps, for one character and for crowds.

    python scripts/bench/locomotion.py

"blend" is locate + weights + series + kinematics, as other runtimes time sampling, blending and
local-to-model; beside it, measured in the same run, the same work in numpy with scipy. "step" is
the whole controller: command, correction, root, foot lock, inverse kinematics. "threads" is the
blend with the crowd split over all cores (the kernels release the interpreter's lock).
"""

from __future__ import annotations

import os
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import HIPS, LABELS, SCALE, Blender, Locomotion, fourier


def best(call, seconds: float = 1.0) -> float:
    """The least time of one call [s], over about `seconds`."""
    call()
    least, until = np.inf, time.perf_counter() + seconds
    while time.perf_counter() < until:
        start = time.perf_counter()
        call()
        least = min(least, time.perf_counter() - start)
    return least


def numpy_blend(locomotion: Locomotion):
    """The same blend in plain numpy and scipy, over any batch: the named alternative."""
    library, members = locomotion.library, locomotion.library.family("walk")
    mesh = Delaunay(library.velocities[members] / SCALE)
    coefficients = library.coefficients[members].astype(np.float32)
    reference = library.reference.astype(np.float32)

    def blend(wish, phase):
        simplex = mesh.find_simplex(wish / SCALE)
        transform = mesh.transform[simplex]
        b = np.einsum("nij,nj->ni", transform[:, :3], wish / SCALE - transform[:, 3])
        b = np.concatenate([b, 1 - b.sum(1, keepdims=True)], 1).astype(np.float32)
        basis = fourier.basis(phase).astype(np.float32)
        row = np.einsum("nv,nk,nvkd->nd", b, basis, coefficients[mesh.simplices[simplex]], optimize=True)
        chart = row[:, :HIPS].reshape(len(row), -1, 3)
        local = reference @ Rotation.from_rotvec(chart).as_matrix().astype(np.float32)
        return forward_kinematics(library.skeleton, row[:, HIPS:LABELS], local)
    return blend


def main() -> None:
    locomotion = Locomotion.load()
    rng = np.random.default_rng(0)
    blender = Blender(locomotion)
    reference = numpy_blend(locomotion)
    cores = os.cpu_count() or 1
    pool = ThreadPoolExecutor(cores)
    print(f"{'characters':>10s}  {'blend':>9s}  {'numpy':>9s}  {'ratio':>6s}  {'threads':>9s}  {'step':>9s}   microseconds a character")
    for count in (1, 100, 10_000):
        wish = rng.uniform([0.2, -0.5, -0.1], [1.0, 0.5, 0.1], (count, 3))
        phase = rng.uniform(0, 1, count).astype(np.float32)
        simplex = np.zeros(count, np.int64)
        output = blender.output(count)
        ours = best(lambda: blender(wish, phase, simplex, output))
        theirs = best(lambda: reference(wish, phase))
        parts = [slice(k * count // cores, (k + 1) * count // cores) for k in range(cores)]

        def threaded():
            list(pool.map(lambda p: blender(wish[p], phase[p], simplex[p], tuple(o[p] for o in output)), parts))
        threads = best(threaded) if count >= 1000 else float("nan")
        state, intent = locomotion.start(np.zeros((count, 3))), Intent(wish)
        for _ in range(90):
            state, _ = locomotion.step(state, intent, 1 / 60)
        step = best(lambda: locomotion.step(state, intent, 1 / 60))
        ours, theirs, threads, step = (t / count * 1e6 for t in (ours, theirs, threads, step))
        print(f"{count:10d}  {ours:9.2f}  {theirs:9.2f}  {theirs / ours:5.1f}x  {threads:9.2f}  {step:9.2f}")
    positions, expected = blender(wish, phase, simplex, output)[0], reference(wish, phase)[0]
    print(f"largest difference of a joint between the two: {np.abs(positions - expected).max() * 1000:.3f} mm")


if __name__ == "__main__":
    main()
