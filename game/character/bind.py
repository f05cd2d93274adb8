"""Any human with a skin, in any pose and proportions, as a body around our joints at T-pose.

The limbs are turned the shortest way from the file's pose (T, A or any other) onto the T-pose's
directions and keep their lengths; what hangs on fingers, hair or twist joints follows the nearest
joint of ours; twist is spread again along forearms, upper arms and thighs.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gambol.controllers.mocap import complete, to_t_pose, upright

from ..render import Body, Mesh, leg_length, skin
from . import gltf, materials
from .gltf import CharacterError, Document, Nodes
from .parts import parts
from .surface import Surface, bound_world, gathered, unit

MIDDLE, FAR = 0.016, 0.034
"""Cells in which the coarser levels merge vertices, over the length of the legs."""
_SIDES = ("Left", "Right")
_INDEX = {name: k for k, name in enumerate(skin.NAMES)}


def load(path: str | Path) -> Body:
    """The body in a .glb, .gltf or .vrm file, sole on the floor, facing +Z.

    CharacterError, naming the file and what would be right, if it holds no human with a skin.
    """
    document = gltf.read(path)
    with gltf.sound(document.path), np.errstate(all="ignore"):  # what is not finite is found and named
        tree = gltf.nodes(document)
        skins = document.list("skins")
        if not skins:
            raise CharacterError(f"{document.path}: has no skin, so nothing in it can bend; export a rigged human "
                                 "with its armature")
        joints = {int(n) for entry in skins for n in entry["joints"]}
        found = parts(document, tree, joints)
        try:
            world = bound_world(document, tree)
            surface = gathered(document, tree, world, joints)
        except np.linalg.LinAlgError:
            raise ValueError(gltf.scaled_to_nothing(tree)) from None
        try:
            turn = upright({name: world[n, :3, 3] for name, n in found.items()})
        except ValueError as error:
            raise CharacterError(f"{document.path}: {error}") from None
        standing = complete({name: turn @ world[n, :3, 3] for name, n in found.items()})
        return _body(document, tree, surface, found, turn, standing)


def _body(document: Document, tree: Nodes, surface: Surface, found: dict[str, int], turn: np.ndarray,
          standing: dict[str, np.ndarray]) -> Body:
    names, parents = skin.STANDARD.names, skin.STANDARD.parents
    here = np.stack([standing[name] for name in names])
    turns = to_t_pose(standing)
    joints = here.copy()
    for j, parent in enumerate(parents[1:], 1):
        joints[j] = joints[parent] + turns[parent] @ (here[j] - here[parent])
    weights = _collapsed(tree, surface, found)
    at = surface.positions @ turn.T
    normals = surface.normals @ turn.T
    posed, faced = np.zeros_like(at), np.zeros_like(at)
    own = weights[:, :len(names)].copy()
    for k in range(len(names), len(skin.NAMES)):
        own[:, skin.AT[k]] += weights[:, k]
    for j in range(len(names)):
        mine = np.flatnonzero(own[:, j])
        share = own[mine, j, None]
        posed[mine] += share * ((at[mine] - here[j]) @ turns[j].T + joints[j])
        faced[mine] += share * (normals[mine] @ turns[j].T)
    if not weights[:, len(names):].any():
        _spread(weights, posed, joints)
    feet = own[:, [names.index(s + part) for s in _SIDES for part in ("Foot", "Toe")]].sum(1) > 0.5
    floor = posed[feet, 1].min() if feet.any() else posed[:, 1].min()
    shift = np.array([joints[0, 0], floor, joints[0, 2]])
    layers, which = materials.pictures(document)
    uv = materials.placed(document, surface.uv, surface.material)
    paint = np.concatenate([uv, which[surface.material][:, None]], 1)
    four = np.argpartition(-weights, 4, 1)[:, :4]
    share = np.take_along_axis(weights, four, 1)
    whole = Mesh((posed - shift).astype(np.float32), unit(faced).astype(np.float32), surface.triangles.astype(np.uint32),
                 four.astype(np.uint8), (share / share.sum(1, keepdims=True)).astype(np.float32),
                 np.clip(surface.open, 0.0, 1.0).astype(np.float32), paint.astype(np.float32))
    legs = float(leg_length(joints))
    levels = whole, clustered(whole, MIDDLE * legs), clustered(whole, FAR * legs)
    return Body(document.path.stem, levels, joints - shift, layers, materials.two_sided(document))


def _collapsed(tree: Nodes, surface: Surface, found: dict[str, int]) -> np.ndarray:
    """Weights (V, 30) on our joints: every node hands its own to the nearest one above that is ours."""
    number = {n: _INDEX[name] for name, n in found.items()}
    ours = np.zeros(len(tree.parents), int)
    for n in tree.order:
        ours[n] = number.get(n, ours[tree.parents[n]] if tree.parents[n] >= 0 else 0)
    out = np.zeros((len(surface.positions), len(skin.NAMES)))
    rows = np.arange(len(out))
    for k in range(surface.bones.shape[1]):
        out[rows, ours[surface.bones[:, k]]] += surface.weights[:, k]  # a row meets each column once
    return out


def _spread(weights: np.ndarray, at: np.ndarray, joints: np.ndarray) -> None:
    """Share the limbs' weights (V, 30), in place, with the helpers that keep twisted flesh round."""
    for side in _SIDES:
        for part, child, first, second in (("Arm", "ForeArm", 0.05, 0.85), ("UpLeg", "Leg", 0.10, 0.85),
                                           ("ForeArm", "Hand", 0.0, 0.50)):
            bone, end = _INDEX[side + part], _INDEX[side + child]
            line = joints[end] - joints[bone]
            along = (at - joints[bone]) @ line / (line @ line)
            mine = weights[:, bone].copy()
            turned = _ramp(along, first, second)
            weights[:, _INDEX[f"{side}{part}0"]] = mine * (1.0 - turned)
            weights[:, bone] = mine * turned
            if part == "ForeArm":
                late = _ramp(along, 0.45, 0.95)
                weights[:, _INDEX[f"{side}ForeArm1"]] = mine * turned * late
                weights[:, bone] = mine * turned * (1.0 - late)


def _ramp(t, low, high):
    u = np.clip((t - low) / (high - low), 0.0, 1.0)
    return u * u * (3.0 - 2.0 * u)


def clustered(mesh: Mesh, cell: float) -> Mesh:
    """A coarser mesh: the vertices in each cube of `cell` [m] become one; slivers go.

    Vertices that look up other pictures, or far-off places in one, stay apart over one place, so
    that colours are not mixed and nothing cracks.
    """
    place = _numbered(np.floor(mesh.positions / cell))
    look = np.floor(mesh.paint * [16.0, 16.0, 1.0])
    _, first, vertex = np.unique(_numbered(np.concatenate([place[:, None], look], 1)), return_index=True,
                                 return_inverse=True)
    count = np.bincount(place)[:, None]
    middle, normals = np.zeros((len(count), 3)), np.zeros((len(count), 3))
    np.add.at(middle, place, mesh.positions)
    np.add.at(normals, place, mesh.normals)
    triangles = vertex[mesh.triangles]
    corners = place[first][triangles]
    kept = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    triangles = triangles[kept]
    triangles = triangles[np.unique(_numbered(triangles), return_index=True)[1]]
    if not len(triangles):
        return mesh
    at, members = place[first], np.bincount(vertex)[:, None]
    paint = np.stack([np.bincount(vertex, column) for column in mesh.paint.T.astype(float)], 1) / members
    return Mesh((middle / count)[at].astype(np.float32), unit(normals)[at].astype(np.float32), triangles.astype(np.uint32),
                mesh.joints[first], mesh.weights[first], mesh.open[first], paint.astype(np.float32))


def _numbered(rows: np.ndarray) -> np.ndarray:
    """A number (N,) from 0 for each different row of whole numbers (N, K)."""
    number = np.zeros(len(rows), np.int64)
    for column in rows.T.astype(np.int64):
        column = np.clip(column - column.min(initial=0), 0, 1 << 31)
        number = np.unique(number * (column.max(initial=0) + 1) + column, return_inverse=True)[1]
    return number
