"""Model the mannequin and write assets/character/mannequin.npz.

    python scripts/build/mannequin.py [--fast]

Everything is made here, from numbers in scripts/character: no scan, no foreign model.
--fast: a coarse grid and no simplification, to look at a change quickly.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from character import binding, shape, surface

from gambol import assets
from gambol.game.render import Mesh, pack

TRIANGLES = {"near": 19000, "middle": 7500, "far": 3200}
"""How many each level of detail gets, the finest first."""
FINE = {"near": 0.0105, "middle": 0.0160, "far": 0.0240}
"""The length of their edges [m] where the shape needs it most not."""


def finished(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    """The mesh with its normals, openness and skin weights."""
    normals = shape.gradient(vertices)
    joints, weights = binding.bound(vertices, faces)
    return Mesh(vertices, normals, faces, joints, weights, surface.openness(vertices, normals), vertices)


def main() -> None:
    fast = "--fast" in sys.argv
    began = time.perf_counter()
    vertices, faces = surface.marched(0.013 if fast else 0.0064)
    print(f"marching cubes: {len(faces)} triangles, {time.perf_counter() - began:.1f} s")
    stored = {}
    for level, wanted in TRIANGLES.items():
        if not fast:
            vertices, faces = surface.collapsed(vertices, faces, wanted, FINE[level])
            vertices = surface.relaxed(vertices, faces)
        stored |= pack(finished(vertices, faces), level)
        print(f"{level}: {len(vertices)} vertices, {len(faces)} triangles, {time.perf_counter() - began:.1f} s")
    path = assets.path("character", "mannequin.npz")
    np.savez_compressed(path, **stored)
    print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
