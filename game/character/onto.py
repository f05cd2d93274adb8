"""Motion onto somebody's own file: his skeleton, names, fingers, skin and pictures as they are, and one more animation.

The file's bones are a rig (`gambol.controllers.mocap.Rig`) as its skin was bound, whatever pose it was saved in. Everything else in the file is handed on.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.mocap import Moved, Rig

from . import gltf
from .gltf import CharacterError, Document
from .parts import table
from .surface import bound_world, gathered
from .write import Glb, contact_bits, same_side

UNEVEN = 1e-3
"""A bone's scale may differ by this share between its axes."""
_MIME = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".webp": "image/webp", ".ktx2": "image/ktx2"}


@dataclass(frozen=True, eq=False)
class Rigged:
    """A file with a human's skeleton in it. nodes: (N,) which of its nodes each bone of the rig is; the first bone is the file itself, -1.
    world: (N, 4, 4) the bones as the skin was bound, the file's own unit and axes."""

    document: Document
    rig: Rig
    nodes: np.ndarray
    world: np.ndarray


def rigged(path: str | Path) -> Rigged:
    """The skeleton in a .glb, .gltf or .vrm file, by VRM's table, else by the names that Mixamo, VRM, Unreal and Blender give.

    CharacterError, naming the file and what would be right, if it holds no human's.
    """
    document = gltf.read(path)
    with gltf.sound(document.path), np.errstate(all="ignore"):
        tree = gltf.nodes(document)
        bones = {int(n) for entry in document.list("skins") for n in entry["joints"]}
        if not bones:
            raise CharacterError(f"{document.path}: has no skin, so nothing in it can bend; export a rigged human with its armature")
        for n in list(bones):
            while (n := int(tree.parents[n])) >= 0:
                bones.add(n)
        nodes = [-1, *(n for n in tree.order if n in bones)]
        number = {n: k for k, n in enumerate(nodes)}
        try:
            bound = bound_world(document, tree)
        except np.linalg.LinAlgError:
            raise ValueError(gltf.scaled_to_nothing(tree)) from None
        world = np.concatenate([np.eye(4)[None], bound[nodes[1:]]])
        names, seen = ["(file)"], {"(file)"}
        for n in nodes[1:]:
            names.append(tree.names[n] if tree.names[n] not in seen else f"{tree.names[n]} #{n}")
            seen.add(names[-1])
        scale = np.linalg.norm(world[:, :3, :3], axis=1)
        size = scale.mean(-1)
        for name, sizes, matrix in zip(names, scale, world):
            if not np.ptp(sizes) <= UNEVEN * sizes.mean() or not np.linalg.det(matrix[:3, :3]) > 0.0:
                raise CharacterError(f"{document.path}: its bone {name!r} is scaled unevenly, or mirrored; apply its scale where it was made")
        parents = np.array([-1, *(number.get(int(tree.parents[n]), 0) for n in nodes[1:])])
        listed = {ours: names[number[n]] for ours, n in table(document).items() if n in number}
        try:
            rig = Rig.of(names, parents, world[:, :3, 3], world[:, :3, :3] / size[:, None, None], parts=listed or None, metres=1.0)  # as glTF always is
        except ValueError as error:
            raise CharacterError(f"{document.path}: {error}") from None
        skin = gathered(document, tree, bound, bones).positions @ rig.axes.T
        rig = rig.on_floor(float(skin[:, 1].min()))
    return Rigged(document, rig, np.array(nodes), world)


def write_onto(path: str | Path, onto: Rigged, moved: Moved, contacts: np.ndarray, fps: float = 60.0, name: str = "Motion") -> Path:
    """Write a .glb file that is the rig's own, standing as it was bound, with an animation `name` of the rig's poses (T, ...) at `fps` frames a second, before all others that it has.

    contacts: (T, 4) go along in its `extras`, as `write` has them. OutputError where it can't be written, ValueError for numbers that are not finite.
    """
    glb = _copied(onto.document)
    for bone, node in enumerate(onto.nodes):
        if node >= 0:
            above = np.linalg.inv(onto.world[onto.rig.skeleton.parents[bone]])
            _stand(glb.json["nodes"][node], above @ onto.world[bone])
    rig = onto.rig
    turns = same_side(Rotation.from_matrix(moved.local[:, rig.driven]).as_quat())
    hips = rig.roles.limbs["Hips"]
    parent = rig.skeleton.parents[hips]
    places = moved.hips / np.linalg.norm(onto.world[parent, :3, 0])
    if not (np.isfinite(turns).all() and np.isfinite(places).all()):
        raise ValueError("the motion holds numbers that are not finite")
    times = glb.array(np.arange(len(places)) / fps, bounds=True)
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    for node, way, values in [(onto.nodes[hips], "translation", places), *((onto.nodes[bone], "rotation", turns[:, k]) for k, bone in enumerate(rig.driven))]:
        samplers.append({"input": times, "output": glb.array(values), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": int(node), "path": way}})
    extras = {"fps": fps, "contact_bits": ["left heel", "left ball", "right heel", "right ball"], "contacts": {name: contact_bits(contacts)}}
    glb.json["animations"] = [{"name": name, "channels": channels, "samplers": samplers, "extras": extras}, *glb.json.get("animations", [])]
    return glb.save(path)


def _copied(document: Document) -> Glb:
    """The same file in one piece: its buffers, and pictures that lay beside it, one after the other."""
    glb = Glb()
    glb.json = copy.deepcopy(document.json)
    starts = []
    for data in document.buffers:
        glb.data += b"\0" * (-len(glb.data) % 4)
        starts.append(len(glb.data))
        glb.data += data
    for view in glb.json.get("bufferViews", []):
        view["byteOffset"] = view.get("byteOffset", 0) + starts[view["buffer"]]
        view["buffer"] = 0
    for image in glb.json.get("images", []):
        uri = image.get("uri", "")
        if uri and not uri.startswith("data:"):
            data = gltf.resource(document.path, image.pop("uri"))
            image |= {"mimeType": image.get("mimeType") or _MIME.get(Path(uri).suffix.lower(), "image/png"), "bufferView": glb.view(data)}
    return glb


def _stand(node: dict[str, Any], local: np.ndarray) -> None:
    """Let a node stand in its parent's frame (4, 4), told in the three parts that can be animated."""
    node.pop("matrix", None)
    size = np.linalg.norm(local[:3, :3], axis=0)
    node["translation"], node["scale"] = local[:3, 3].tolist(), size.tolist()
    node["rotation"] = Rotation.from_matrix(local[:3, :3] / size).as_quat().tolist()
