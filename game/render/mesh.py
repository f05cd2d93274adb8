"""Characters' meshes: as they lie on disk, and as the graphics card wants them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol import assets

from . import skin

POSITION_UNIT = 1.0 / 16384.0
"""What one step of a stored position measures [m]."""
LEVELS = ("near", "middle", "far")
"""The meshes of a body, the finest first."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A skinned mesh at T-pose.

    positions, normals: (V, 3) [m], unit. triangles: (T, 3), counter-clockwise from outside.
    joints, weights: (V, 4) into `skin.NAMES`, summing to 1. open: (V,) how open each vertex is to
    the sky, 0 … 1. paint: (V, 3) where its colour is looked up: the place on the standard
    mannequin [m], or u, v and the layer of its body's pictures.
    """

    positions: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    joints: np.ndarray
    weights: np.ndarray
    open: np.ndarray
    paint: np.ndarray

    def interleaved(self) -> bytes:
        """All vertices: position 3f, normal 3f, joints 4u1, weights 4 normalised u1, openness f, paint 3f."""
        layout = np.dtype([("position", "f4", 3), ("normal", "f4", 3), ("joints", "u1", 4),
                           ("weights", "u1", 4), ("open", "f4"), ("paint", "f4", 3)])
        rows = np.empty(len(self.positions), layout)
        rows["position"], rows["normal"], rows["joints"] = self.positions, self.normals, self.joints
        rows["weights"], rows["open"], rows["paint"] = np.round(self.weights * 255), self.open, self.paint
        return rows.tobytes()


@dataclass(frozen=True, eq=False)
class Body:
    """Somebody to be: meshes around joints at T-pose, sole on the floor, in the body's own size.

    levels: the mesh at each of `LEVELS`. joints: (22, 3) [m] the standard human's joints in it.
    pictures: None for the mannequin's two-tone paint, else (L, S, S, 4) uint8, sRGB and opacity,
    the layers that `Mesh.paint` looks up (a layer below 0 is the figure's tint).
    thin: whether its surfaces are seen from both sides. Compared and hashed as an object.
    """

    name: str
    levels: tuple[Mesh, ...]
    joints: np.ndarray
    pictures: np.ndarray | None = None
    thin: bool = False


def pack(mesh: Mesh, level: str) -> dict[str, np.ndarray]:
    """The arrays of one level as they are stored: small integers."""
    whole = np.floor(mesh.weights * 255).astype(int)
    # hand the steps lost by rounding down to the largest weight, so that they still sum to 255
    whole[np.arange(len(whole)), mesh.weights.argmax(1)] += 255 - whole.sum(1)
    kind = np.uint16 if len(mesh.positions) < 65536 else np.uint32
    return {f"{level}_{name}": value for name, value in {
        "positions": np.round(mesh.positions / POSITION_UNIT).astype(np.int16),
        "normals": np.round(mesh.normals * 127).astype(np.int8), "triangles": mesh.triangles.astype(kind),
        "joints": mesh.joints.astype(np.uint8), "weights": whole.astype(np.uint8),
        "open": np.round(mesh.open * 255).astype(np.uint8)}.items()}


@lru_cache
def mannequin() -> Body:
    """Gambol's own character. FileNotFoundError if it was not built."""
    with np.load(assets.path("character", "mannequin.npz")) as file:
        return Body("Mannequin", tuple(_unpacked(file, level) for level in LEVELS), skin.REST)


def _unpacked(file, level: str) -> Mesh:
    stored = {name: file[f"{level}_{name}"] for name in
              ("positions", "normals", "triangles", "joints", "weights", "open")}
    positions = (stored["positions"] * POSITION_UNIT).astype(np.float32)
    normals = stored["normals"] / np.linalg.norm(stored["normals"].astype(np.float32), axis=1, keepdims=True)
    return Mesh(positions, normals.astype(np.float32), stored["triangles"].astype(np.uint32), stored["joints"],
                (stored["weights"] / 255.0).astype(np.float32), (stored["open"] / 255.0).astype(np.float32), positions)
