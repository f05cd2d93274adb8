"""glTF 2.0 files as arrays: the JSON, the buffers behind it, accessors and the tree of nodes.

Read without a library: the ones there are hand out the same JSON as classes, take seconds over
long animations, and leave accessors to the caller. What is wrong with a file is said in one line.
"""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from gambol.controllers.files import ordinary, printable, reason

LARGEST = 256 << 20
"""The largest file that is read [bytes]."""
SUFFIXES = (".glb", ".gltf", ".vrm")
TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""numpy's name of each component type."""
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_PACKED = {"KHR_draco_mesh_compression": "Draco", "EXT_meshopt_compression": "meshopt"}


class CharacterError(ValueError):
    """A file that nobody can be made of, and what would be right."""


@contextmanager
def sound(path: Path) -> Iterator[None]:
    """What goes wrong inside because the file breaks glTF's rules becomes a CharacterError that names it."""
    try:
        yield
    except CharacterError:
        raise
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, struct.error, RecursionError) as error:
        what = f"misses {error}" if isinstance(error, KeyError) else str(error)
        raise CharacterError(f"{path}: not sound glTF 2.0 ({what}); export it again as GLB") from error


@dataclass(frozen=True, eq=False)
class Document:
    """A glTF file. json: its description. buffers: the bytes that it refers to."""

    path: Path
    json: dict
    buffers: tuple[bytes, ...]

    def list(self, kind: str) -> list[dict]:
        """All of one kind (nodes, meshes, …), none if there are none."""
        return self.json.get(kind, [])

    def view(self, index: int) -> memoryview:
        """The bytes of a buffer view."""
        view = self.json["bufferViews"][index]
        start, length = view.get("byteOffset", 0), view["byteLength"]
        data = memoryview(self.buffers[view["buffer"]])
        if start < 0 or length < 0 or start + length > len(data):
            raise ValueError(f"buffer view {index} ends beyond its buffer")
        return data[start:start + length]

    def accessor(self, index: int) -> np.ndarray:
        """An accessor's values (count, width); normalised integers as floats."""
        entry = self.json["accessors"][index]
        kind, width, count = np.dtype(TYPES[entry["componentType"]]), WIDTHS[entry["type"]], entry["count"]
        if not 0 <= count <= 10_000_000:
            raise ValueError(f"accessor {index} counts {count}")
        out = np.zeros((count, width), kind)
        if "bufferView" in entry:
            out = self._strided(entry["bufferView"], entry.get("byteOffset", 0), kind, count, width).copy()
        if "sparse" in entry:
            part = entry["sparse"]
            where, what = part["indices"], part["values"]
            at = self._strided(where["bufferView"], where.get("byteOffset", 0),
                               np.dtype(TYPES[where["componentType"]]), part["count"], 1)[:, 0]
            out[at] = self._strided(what["bufferView"], what.get("byteOffset", 0), kind, part["count"], width)
        if entry.get("normalized") and kind.kind in "iu":
            return np.maximum(out / float(np.iinfo(kind).max), -1.0)
        return out

    def _strided(self, view: int, offset: int, kind: np.dtype, count: int, width: int) -> np.ndarray:
        data, size = self.view(view), kind.itemsize * width
        stride = self.json["bufferViews"][view].get("byteStride", size)
        if offset < 0 or stride < size or (count and offset + stride * (count - 1) + size > len(data)):
            raise ValueError(f"an accessor reads beyond buffer view {view}")
        return np.ndarray((count, width), kind, data, offset, (stride, kind.itemsize))


def read(path: str | Path) -> Document:
    """Read a .glb, .gltf or .vrm file. CharacterError, naming it, for anything that is not sound glTF 2.0."""
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise CharacterError(f"{path}: can't be worn; name a {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]} file")
    data = _bytes(path)
    with sound(path):
        text, binary = _chunks(path, data) if data[:4] == b"glTF" or path.suffix.lower() != ".gltf" else (data, None)
        described = json.loads(text)
        if str(described["asset"]["version"]).split(".")[0] != "2":
            raise CharacterError(f"{path}: is glTF {described['asset']['version']}; export it as glTF 2.0")
        for extension in described.get("extensionsRequired", []):
            if extension in _PACKED:
                raise CharacterError(f"{path}: its mesh is packed with {_PACKED[extension]}; "
                                     "export it without mesh compression")
        buffers = tuple(_buffer(path, entry, binary if k == 0 else None)
                        for k, entry in enumerate(described.get("buffers", [])))
    return Document(path, described, buffers)


def _bytes(path: Path) -> bytes:
    try:
        if ordinary(path).stat().st_size > LARGEST:
            raise CharacterError(f"{path}: holds {path.stat().st_size >> 20} MiB; a character has at most "
                                 f"{LARGEST >> 20} MiB: export it with smaller pictures and a lighter mesh")
        return path.read_bytes()
    except OSError as error:
        raise CharacterError(f"{path}: can't be read: {reason(error)}") from error


def _chunks(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the binary chunk of a GLB container."""
    if data[:4] != b"glTF":
        raise CharacterError(f"{path}: is not a GLB file; it has to start with the letters glTF")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise CharacterError(f"{path}: is GLB version {version}; export it as glTF 2.0")
    if length > len(data):
        raise CharacterError(f"{path}: is cut short: {len(data)} of {length} bytes are there; copy it again")
    found, at = {}, 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        if at + 8 + size > length:
            raise CharacterError(f"{path}: is cut short in the chunk at byte {at}; copy it again")
        found.setdefault(kind, data[at + 8:at + 8 + size])
        at += 8 + size
    return found[0x4E4F534A], found.get(0x004E4942)


def _buffer(path: Path, entry: dict, binary: bytes | None) -> bytes:
    if "uri" not in entry:
        data = binary
        if data is None:
            raise CharacterError(f"{path}: has no binary chunk for its buffer; export it as GLB")
    else:
        data = resource(path, entry["uri"])
    if len(data) < entry["byteLength"]:
        raise CharacterError(f"{path}: a buffer is cut short: {len(data)} of {entry['byteLength']} bytes; copy it again")
    return data


def resource(path: Path, uri: str) -> bytes:
    """What a URI in the file at `path` refers to: data written into it, or a file beside it."""
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2])
    beside = Path(unquote(uri))
    if "://" in uri or beside.is_absolute() or ".." in beside.parts:
        raise CharacterError(f"{path}: refers to {uri}, which is not beside it; export it as one GLB file")
    if not (path.parent / beside).is_file():
        raise CharacterError(f"{path}: needs {uri} beside it, which is not there; export it as one GLB file")
    return _bytes(path.parent / beside)


@dataclass(frozen=True, eq=False)
class Nodes:
    """The tree of nodes. parents: (N,) -1 for roots. world: (N, 4, 4) as the file stands.
    order: (N,) node numbers, parents first, depth first."""

    names: tuple[str, ...]
    parents: np.ndarray
    local: np.ndarray
    world: np.ndarray
    order: tuple[int, ...]


def nodes(document: Document) -> Nodes:
    """The tree of a document's nodes. ValueError where it is none."""
    entries = document.list("nodes")
    parents = np.full(len(entries), -1)
    for number, entry in enumerate(entries):
        for child in entry.get("children", []):
            if parents[child] >= 0:
                raise ValueError(f"node {child} has two parents")
            parents[child] = number
    local = np.stack([_local(entry) for entry in entries]) if entries else np.zeros((0, 4, 4))
    if not np.isfinite(local).all():
        raise ValueError("a node's transform is not finite")
    for number, skin in enumerate(document.list("skins")):
        none = [joint for joint in skin["joints"] if not 0 <= joint < len(entries)]
        if none:
            raise ValueError(f"skin {number} has node {none[0]} for a joint, and there are {len(entries)} nodes")
    world, order = local.copy(), []
    stack = [n for n in reversed(range(len(entries))) if parents[n] < 0]
    while stack:
        n = stack.pop()
        order.append(n)
        if parents[n] >= 0:
            world[n] = world[parents[n]] @ local[n]
        stack += reversed(entries[n].get("children", []))
    if len(order) != len(entries):
        raise ValueError("its nodes hang on each other in a ring")
    return Nodes(tuple(str(e.get("name", f"node {n}")) for n, e in enumerate(entries)), parents, local, world, tuple(order))


def scaled_to_nothing(tree: Nodes) -> str:
    """Which node leaves nothing of what hangs on it, for where a transform had to be inverted."""
    flat = np.flatnonzero(np.abs(np.linalg.det(tree.local[:, :3, :3])) < 1e-24)
    return f"node {flat[0]}, {printable(tree.names[flat[0]])!r}, is scaled to nothing" if len(flat) else "a skin's inverse bind matrix is flat"


def _local(entry: dict) -> np.ndarray:
    if "matrix" in entry:
        return np.array(entry["matrix"], float).reshape(4, 4).T
    x, y, z, w = np.array(entry.get("rotation", (0, 0, 0, 1)), float)
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    out = np.eye(4)
    out[:3, :3] = turn * np.array(entry.get("scale", (1, 1, 1)), float)
    out[:3, 3] = entry.get("translation", (0, 0, 0))
    return out
