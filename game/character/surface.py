"""All triangles of a file in one mesh: places, normals, picture coordinates, and the nodes they hang on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .gltf import CharacterError, Document, Nodes

MOST_VERTICES = 1_000_000


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles of a whole file, in its world at the bind pose.

    positions, normals: (V, 3). triangles: (T, 3). uv: (V, 2). material: (V,) number, -1 for none.
    open: (V,) how open to the sky, 0 … 1. bones, weights: (V, K) node numbers and what they weigh.
    """

    positions: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray
    material: np.ndarray
    open: np.ndarray
    bones: np.ndarray
    weights: np.ndarray


def bound_world(document: Document, tree: Nodes) -> np.ndarray:
    """The nodes' transforms (N, 4, 4) as the skins were bound, whatever pose the file was saved in."""
    world, fixed = tree.world.copy(), {}
    for k in sorted(range(len(document.list("skins"))), key=lambda k: -len(document.json["skins"][k]["joints"])):
        skin = document.json["skins"][k]
        if "inverseBindMatrices" not in skin:
            continue
        bind = np.linalg.inv(inverse_binds(document, k))
        rank = {n: i for i, n in enumerate(tree.order)}
        top = min(range(len(bind)), key=lambda i: rank[skin["joints"][i]])
        node = skin["joints"][top]
        carry = fixed.get(node, world[node]) @ np.linalg.inv(bind[top])
        for node, matrix in zip(skin["joints"], bind):
            fixed.setdefault(node, carry @ matrix)
    for n in tree.order:
        if n in fixed:
            world[n] = fixed[n]
        elif tree.parents[n] >= 0:
            world[n] = world[tree.parents[n]] @ tree.local[n]
    return world


def inverse_binds(document: Document, skin: int) -> np.ndarray:
    """A skin's inverse bind matrices (J, 4, 4)."""
    entry = document.json["skins"][skin]
    if "inverseBindMatrices" not in entry:
        return np.broadcast_to(np.eye(4), (len(entry["joints"]), 4, 4))
    matrices = document.accessor(entry["inverseBindMatrices"]).reshape(-1, 4, 4).swapaxes(1, 2).astype(float)
    if len(matrices) < len(entry["joints"]) or not np.isfinite(matrices).all():
        raise ValueError(f"skin {skin} has unsound inverse bind matrices")
    if np.abs(np.linalg.det(matrices)).min() < 1e-18:
        raise ValueError(f"skin {skin} flattens a joint")
    return matrices[:len(entry["joints"])]


def gathered(document: Document, tree: Nodes, world: np.ndarray, joints: set[int]) -> Surface:
    """Every triangle that a skin bends or that hangs on one of its joints. CharacterError if there is none."""
    found, count = [], 0
    for number, node in enumerate(document.list("nodes")):
        if "mesh" not in node or not ("skin" in node or _hangs(tree, number, joints)):
            continue
        for primitive in document.json["meshes"][node["mesh"]]["primitives"]:
            if primitive.get("mode", 4) == 4 and "POSITION" in primitive["attributes"]:
                found.append(_primitive(document, primitive, node.get("skin"), number, world))
                count += len(found[-1].positions)
                if count > MOST_VERTICES:
                    raise CharacterError(f"{document.path}: has more than {MOST_VERTICES} vertices; "
                                         "export a lighter mesh")
    if not sum(len(part.triangles) for part in found):
        raise CharacterError(f"{document.path}: its skin bends no triangles; export the mesh with its rig")
    width = max(part.bones.shape[1] for part in found)
    starts = np.cumsum([0, *(len(part.positions) for part in found)])
    stacked = {name: np.concatenate([getattr(part, name) for part in found])
               for name in ("positions", "normals", "uv", "material", "open")}
    widened = {name: np.concatenate([np.pad(getattr(part, name), ((0, 0), (0, width - part.bones.shape[1])))
                                     for part in found]) for name in ("bones", "weights")}
    return Surface(triangles=np.concatenate([part.triangles + s for part, s in zip(found, starts)]), **stacked, **widened)


def _hangs(tree, number, joints):
    while number >= 0:
        if number in joints:
            return True
        number = int(tree.parents[number])
    return False


def _primitive(document, primitive, skin, node, world) -> Surface:
    attributes = primitive["attributes"]
    at = document.accessor(attributes["POSITION"]).astype(float)
    count = len(at)
    faces = document.accessor(primitive["indices"])[:, 0] if "indices" in primitive else np.arange(count)
    faces = faces[:len(faces) // 3 * 3].reshape(-1, 3).astype(np.int64)
    if faces.size and faces.max() >= count:
        raise ValueError("a triangle names a vertex that is not there")
    if not np.isfinite(at).all():
        raise ValueError("a vertex is not at a finite place")
    normals = document.accessor(attributes["NORMAL"]).astype(float) if "NORMAL" in attributes else smooth(at, faces)
    if skin is None:
        bones, weights = np.full((count, 1), node), np.ones((count, 1))
        at, normals = _moved(at, normals, world[node])
    else:
        own = np.array(document.json["skins"][skin]["joints"])
        sets = sorted(name for name in attributes if name.startswith("JOINTS_"))
        local = np.concatenate([document.accessor(attributes[name]) for name in sets], 1).astype(np.int64)
        weights = np.concatenate([document.accessor(attributes[name.replace("JOINTS", "WEIGHTS")]) for name in sets], 1)
        weights = np.where(np.isfinite(weights), np.maximum(weights, 0.0), 0.0).astype(float)
        local[weights == 0.0] = 0
        if local.max(initial=0) >= len(own):
            raise ValueError("a vertex hangs on a joint that its skin has not")
        weights[weights.sum(1) == 0.0, 0] = 1.0
        weights /= weights.sum(1, keepdims=True)
        bones = own[local]
        matrices = world[own] @ inverse_binds(document, skin)
        at, normals = _moved(at, normals, np.einsum("vk,vkij->vij", weights, matrices[local]))
    if "TEXCOORD_0" in attributes:
        uv = document.accessor(attributes["TEXCOORD_0"])[:, :2]
    else:
        uv = np.zeros((count, 2))
    open_ = document.accessor(attributes["_OPEN"])[:, 0] if "_OPEN" in attributes else np.ones(count)
    if not len(at) == len(normals) == len(uv) == len(open_) == len(bones):
        raise ValueError("a mesh's attributes differ in length")
    used, faces = np.unique(faces, return_inverse=True)  # primitives often share one set of vertices
    return Surface(at[used], normals[used], faces.reshape(-1, 3), uv[used],
                   np.full(len(used), primitive.get("material", -1)), open_[used], bones[used], weights[used])


def _moved(at, normals, matrix):
    turned = np.einsum("...ij,...j->...i", np.linalg.inv(matrix[..., :3, :3]).swapaxes(-1, -2), normals)
    return np.einsum("...ij,...j->...i", matrix[..., :3, :3], at) + matrix[..., :3, 3], unit(turned)


def unit(v: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) of length 1; those of none point up."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.where(length > 1e-12, v / np.maximum(length, 1e-12), [0.0, 1.0, 0.0])


def smooth(at: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Unit normals (V, 3) of vertices: those of the triangles around, by their area."""
    a, b, c = (at[faces[:, i]] for i in range(3))
    face, out = np.cross(b - a, c - a), np.zeros_like(at)
    for i in range(3):
        np.add.at(out, faces[:, i], face)
    return unit(out)
