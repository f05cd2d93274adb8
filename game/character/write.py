"""GLB out: a skinned body with the standard human's joints, at rest or with its motion.

Metres, Y up, facing +Z, as glTF wants it. The twist helpers are written as joints of their own, so
that forearms stay round under the linear skinning of other programs.
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..files import output_file, whole
from ..render import Body, Mesh, skin
from ..scene import TINT
from .twotone import cut

FLOAT, USHORT, UINT, UBYTE = 5126, 5123, 5125, 5121
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_DARK = np.array([0.045, 0.049, 0.058])


@dataclass(frozen=True, eq=False)
class Motion:
    """What a body does, frame by frame. hips: (T, 3) [m]. turns: (T, 30, 4) local rotations of
    `skin.NAMES`, (x, y, z, w). contacts: (T, 4) bool, left heel, left ball, right heel, right ball."""

    hips: np.ndarray
    turns: np.ndarray
    contacts: np.ndarray


@dataclass(frozen=True, eq=False)
class Actor:
    """Somebody in a file. joints: (30, 3) [m] at T-pose. scale: of the body's mesh. tint: linear RGB."""

    name: str
    body: Body
    joints: np.ndarray
    scale: float = 1.0
    tint: Sequence[float] = TINT
    motion: Motion | None = None


class Glb:
    """A file in the making: the JSON and the bytes behind it."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "Gambol"}, "scene": 0}
        self.data = bytearray()

    def add(self, kind: str, entry: dict) -> int:
        """Append an entry (a node, a mesh, …); its number."""
        entries = self.json.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def view(self, data: bytes, **more) -> int:
        """Append bytes as a buffer view, on a multiple of four."""
        self.data += b"\0" * (-len(self.data) % 4)
        start = len(self.data)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": start, "byteLength": len(data), **more})

    def array(self, values: np.ndarray, component: int = FLOAT, bounds: bool = False, target: int | None = None) -> int:
        """Append an accessor of values (N,) or (N, width)."""
        kind = {FLOAT: "<f4", USHORT: "<u2", UINT: "<u4", UBYTE: "u1"}[component]
        values = np.ascontiguousarray(values, kind).reshape(len(values), -1)
        entry = {"bufferView": self.view(values.tobytes(), **({"target": target} if target else {})),
                 "componentType": component, "count": len(values), "type": _TYPES[values.shape[1]]}
        if bounds:
            entry |= {"min": values.min(0).tolist(), "max": values.max(0).tolist()}
        return self.add("accessors", entry)

    def save(self, path: str | Path) -> Path:
        """Write the file; it appears whole or not at all. OutputError where it can't be written."""
        path = output_file(path, ".glb")
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + b"\0" * (-len(self.data) % 4)
        with whole(path) as part, open(part, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)
        return path


def joints_of(body: Body, scale: float = 1.0) -> np.ndarray:
    """The places (30, 3) [m] of a body's joints and helpers at T-pose."""
    return body.joints[skin.AT] * scale


def write(path: str | Path, actors: Sequence[Actor], fps: float = 60.0) -> Path:
    """Write actors, and their motions at `fps` frames a second, into one GLB.

    Contacts go along as custom data: `extras` of the animation and of each actor's node hold the
    frame rate and, for each frame, the bits 1 left heel, 2 left ball, 4 right heel, 8 right ball.
    OutputError where it can't be written, ValueError for numbers that are not finite.
    """
    glb, roots, channels, samplers, extras = Glb(), [], [], [], {}
    times = {}
    for actor in actors:
        top, nodes = _joints(glb, actor)
        roots += [top, _mesh(glb, actor, nodes)]
        if actor.motion is not None:
            count = len(actor.motion.hips)
            if count not in times:
                times[count] = glb.array(np.arange(count) / fps, bounds=True)
            _tracks(glb, actor.motion, nodes, times[count], channels, samplers)
            bits = contact_bits(actor.motion.contacts)
            glb.json["nodes"][top]["extras"] = {"fps": fps, "contacts": bits}
            extras[actor.name] = bits
    if channels:
        glb.add("animations", {"name": "Motion", "channels": channels, "samplers": samplers, "extras": {
            "fps": fps, "contact_bits": ["left heel", "left ball", "right heel", "right ball"], "contacts": extras}})
    glb.add("scenes", {"nodes": roots})
    return glb.save(path)


def _joints(glb: Glb, actor: Actor) -> tuple[int, list[int]]:
    """Nodes of the actor and its 30 joints."""
    parents = skin.PARENTS
    offsets = actor.joints - np.where(parents[:, None] < 0, 0.0, actor.joints[parents])
    first = len(glb.json.get("nodes", [])) + 1
    numbers = [first + k for k in range(len(skin.NAMES))]
    top = glb.add("nodes", {"name": actor.name, "children": [first]})
    for k, name in enumerate(skin.NAMES):
        node = {"name": name, "translation": offsets[k].tolist()}
        children = [numbers[c] for c in np.flatnonzero(parents == k)]
        glb.add("nodes", node | ({"children": children} if children else {}))
    return top, numbers


def _mesh(glb: Glb, actor: Actor, nodes: list[int]) -> int:
    """The node of the actor's skinned mesh."""
    mesh, groups = _parts(glb, actor)
    joints = np.where(mesh.weights > 0.0, mesh.joints, 0)
    attributes = {"POSITION": glb.array(mesh.positions * actor.scale, bounds=True, target=34962),
                  "NORMAL": glb.array(mesh.normals, target=34962),
                  "JOINTS_0": glb.array(joints, UBYTE, target=34962),
                  "WEIGHTS_0": glb.array(mesh.weights, target=34962),
                  "_OPEN": glb.array(mesh.open, target=34962)}
    pictured = [m for _, m in groups if "baseColorTexture" in glb.json["materials"][m]["pbrMetallicRoughness"]]
    placed = {"TEXCOORD_0": glb.array(mesh.paint[:, :2], target=34962)} if pictured else {}
    primitives = [{"attributes": attributes | (placed if material in pictured else {}), "material": material,
                   "indices": glb.array(triangles.reshape(-1), UINT if len(mesh.positions) > 65535 else USHORT, target=34963)}
                  for triangles, material in groups if len(triangles)]
    inverse = np.broadcast_to(np.eye(4), (len(nodes), 4, 4)).copy()
    inverse[:, 3, :3] = -actor.joints  # column after column, as glTF stores matrices
    entry = {"joints": nodes, "skeleton": nodes[0], "inverseBindMatrices": glb.array(inverse.reshape(-1, 16))}
    return glb.add("nodes", {"name": f"{actor.name} mesh", "skin": glb.add("skins", entry),
                             "mesh": glb.add("meshes", {"name": actor.body.name, "primitives": primitives})})


def _parts(glb: Glb, actor: Actor) -> tuple[Mesh, list[tuple[np.ndarray, int]]]:
    """The finest mesh, and its triangles by material."""
    mesh, tint = actor.body.levels[0], np.array(actor.tint, float)
    if actor.body.pictures is None:
        mesh, dark = cut(mesh)
        return mesh, [(mesh.triangles[~dark], _plain(glb, "Suit", tint, 0.7, tint=True)),
                      (mesh.triangles[dark], _plain(glb, "Trim", _DARK + 0.05 * tint, 0.4))]
    layers = np.round(mesh.paint[mesh.triangles[:, 0], 2]).astype(int)
    return mesh, [(mesh.triangles[layers == k], _plain(glb, "Suit", tint, 0.7, tint=True) if k < 0 else
                   _pictured(glb, actor.body.pictures[k], k, actor.body.thin)) for k in np.unique(layers)]


def _plain(glb: Glb, name: str, colour: np.ndarray, rough: float, tint: bool = False) -> int:
    entry = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*np.clip(colour, 0.0, 1.0).tolist(), 1.0],
                                                    "metallicFactor": 0.0, "roughnessFactor": rough}}
    return glb.add("materials", entry | ({"extras": {"tint": True}} if tint else {}))


def _pictured(glb: Glb, pixels: np.ndarray, layer: int, thin: bool) -> int:
    from PIL import Image

    entry: dict[str, Any] = {"name": f"Picture {layer}", "doubleSided": thin}
    if (pixels == pixels[0, 0]).all():
        colour = [*((pixels[0, 0, :3] / 255.0) ** 2.2).tolist(), 1.0]
        return glb.add("materials", entry | {"pbrMetallicRoughness": {
            "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.7}})
    packed = io.BytesIO()
    Image.fromarray(pixels).save(packed, format="png")
    image = glb.add("images", {"mimeType": "image/png", "bufferView": glb.view(packed.getvalue())})
    entry["pbrMetallicRoughness"] = {"baseColorTexture": {"index": glb.add("textures", {"source": image})},
                                     "metallicFactor": 0.0, "roughnessFactor": 0.7}
    return glb.add("materials", entry | ({"alphaMode": "MASK"} if pixels[..., 3].min() < 128 else {}))


def contact_bits(contacts: np.ndarray) -> list[int]:
    """Contacts (T, 4) as one number a frame: 1 left heel, 2 left ball, 4 right heel, 8 right ball."""
    return (np.asarray(contacts, int) @ [1, 2, 4, 8]).tolist()


def same_side(turns: np.ndarray) -> np.ndarray:
    """Quaternions (T, ..., 4), of q and -q, which turn alike, the one on the side of the one before: else they are blended the long way round."""
    turns = np.array(turns, float)
    flips = np.sum(turns[1:] * turns[:-1], -1) < 0.0
    turns[1:] *= np.where(np.cumsum(flips, 0) % 2 == 1, -1.0, 1.0)[..., None]
    return turns


def _tracks(glb: Glb, motion: Motion, nodes: list[int], times: int, channels: list, samplers: list) -> None:
    turns = same_side(motion.turns)
    if not (np.isfinite(turns).all() and np.isfinite(motion.hips).all()):
        raise ValueError("the motion holds numbers that are not finite")
    for node, path, values in [(nodes[0], "translation", motion.hips),
                               *((node, "rotation", turns[:, k]) for k, node in enumerate(nodes))]:
        samplers.append({"input": times, "output": glb.array(values), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
