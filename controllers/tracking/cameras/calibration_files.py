"""Calibration files: OpenCV's numbers in TOML (as Anipose and Pose2Sim keep them), and Qualisys's text, which is XML.

In TOML every table with a `size` is a camera: `matrix`, `distortions`, `rotation` (Rodrigues' vector) and `translation`,
world to camera; or, to place one by hand, `eye`, `target` and `fov` [degrees]. `metadata.up` says which axis is up in the
file's world, "y" by default; ours is Y, and z-up files are turned. Qualisys has millimetres, Z up, the camera's axes as
rows, its y up and its z backwards, and counts pixels in 64ths.
"""

from __future__ import annotations

import tomllib
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...body import exp, log
from ...files import contents, printable, reason, tables, whole
from .pinhole import Lens, looking_at

LARGEST = 4 << 20
"""The largest file that is read [bytes]."""
MOST = 64
"""So many cameras at most."""
SUBPIXELS = 64.0
"""Qualisys's units in a pixel."""
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""A Z-up world's coordinates into ours."""
FLIPPED = np.diag([1.0, -1.0, -1.0])
"""Qualisys's camera axes into OpenCV's."""
_MATRIX, _PLACED = ("matrix", "rotation", "translation"), ("eye", "target", "fov")
_KNOWN = {"name", "size", "distortions", "fisheye", *_MATRIX, *_PLACED}


class CalibrationError(ValueError):
    """A calibration that can't be used: the file, the camera, the field, and what would be right."""


def read_cameras(path: str | Path) -> tuple[Lens, ...]:
    """The cameras of a file. CalibrationError, in one line, for anything that is no calibration."""
    path = Path(path)
    if path.suffix.lower() == ".toml":
        made = _read_toml(path)
    else:
        made = _read_qualisys(path)
    if not made:
        raise CalibrationError(f"{path}: has no camera in it")
    if len(made) > MOST:
        raise CalibrationError(f"{path}: {len(made)} cameras are too many; {MOST} at most")
    names = [lens.name for lens in made]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise CalibrationError(f"{path}: cameras need different names; twice: {', '.join(twice)}")
    return tuple(made)


def write_opencv(cameras: Sequence[Lens], path: str | Path) -> None:
    """Write cameras as TOML, in our world. OSError where it can't be written."""
    def row(values) -> str:
        return "[" + ", ".join(repr(float(v)) for v in values) + "]"
    lines = []
    for lens in cameras:
        k1, k2, p1, p2, k3 = lens.distortion
        lines += [f'["{lens.name}"]', f'name = "{lens.name}"', f"size = [{lens.size[0]}, {lens.size[1]}]",
                  f"matrix = [{', '.join(row(r) for r in lens.matrix)}]", f"distortions = {row((k1, k2, p1, p2, k3))}",
                  f"rotation = {row(log(lens.rotation))}", f"translation = {row(lens.translation)}", "fisheye = false", ""]
    lines += ["[metadata]", 'up = "y"', ""]
    with whole(path) as part:
        part.write_text("\n".join(lines), "utf-8")


def write_qualisys(cameras: Sequence[Lens], path: str | Path) -> None:
    """Write cameras as Qualisys's text, in millimetres, Z up. OSError where it can't be written."""
    root = ElementTree.Element("calibration", source="gambol", type="regular")
    group = ElementTree.SubElement(root, "cameras")
    for lens in cameras:
        camera = ElementTree.SubElement(group, "camera", active="1", serial=lens.name, viewrotation="0")
        width, height = lens.size
        ElementTree.SubElement(camera, "fov_video", left="0", top="0", right=str(width - 1), bottom=str(height - 1))
        turn, eye = FLIPPED @ lens.rotation @ Y_UP, 1000.0 * Y_UP.T @ lens.eye
        ElementTree.SubElement(camera, "transform", {**{f"r{i + 1}{k + 1}": repr(float(turn[i, k])) for i in range(3) for k in range(3)},
                                                     **dict(zip("xyz", (repr(float(v)) for v in eye)))})
        m, (k1, k2, p1, p2, k3) = lens.matrix, lens.distortion
        numbers = {"centerPointU": m[0, 2] * SUBPIXELS, "centerPointV": m[1, 2] * SUBPIXELS, "focalLengthU": m[0, 0] * SUBPIXELS,
                   "focalLengthV": m[1, 1] * SUBPIXELS, "radialDistortion1": k1, "radialDistortion2": k2, "radialDistortion3": k3,
                   "tangentalDistortion1": p1, "tangentalDistortion2": p2, "skew": 0.0, "sensorMinU": 0.0, "sensorMinV": 0.0,
                   "sensorMaxU": (width - 1) * SUBPIXELS, "sensorMaxV": (height - 1) * SUBPIXELS}
        ElementTree.SubElement(camera, "intrinsic", {name: repr(float(value)) for name, value in numbers.items()})
    with whole(path) as part:
        ElementTree.ElementTree(root).write(part, encoding="ascii", xml_declaration=True)


def _read_toml(path: Path) -> list[Lens]:
    try:
        found = tables(path, LARGEST)
    except UnicodeDecodeError as fault:
        raise CalibrationError(f"{path}: not UTF-8 text (byte {fault.start})") from None
    except OSError as fault:
        raise CalibrationError(f"{path}: {reason(fault)}") from None
    except tomllib.TOMLDecodeError as fault:
        raise CalibrationError(f"{path}: not TOML: {fault}") from None
    about = found.get("metadata", {})
    up = about.get("up", "y") if isinstance(about, Mapping) else None
    if up not in ("y", "z"):
        raise CalibrationError(f'{path}: metadata.up: needs "y" or "z"')
    made = []
    for key, table in found.items():
        if not isinstance(table, Mapping) or "size" not in table:
            if key not in ("metadata", "sensor"):
                raise CalibrationError(f"{path}: {printable(key)}: is no camera; one is a table with size, and matrix, rotation and "
                                       "translation, or eye, target and fov")
            continue
        try:
            made.append(_of_table(key, table, up))
        except ValueError as fault:
            raise CalibrationError(f"{path}: {printable(key)}.{fault}") from None
    return made


def _of_table(key: str, table: Mapping[str, Any], up: str) -> Lens:
    """ValueError, FIELD: WHAT, for what is no camera."""
    strange = [name for name in table if name not in _KNOWN]
    if strange:
        raise ValueError(f"{printable(strange[0])}: there is no such field; a camera has {', '.join(sorted(_KNOWN))}")
    name = table.get("name", key)
    if not isinstance(name, str) or not name or not all(c.isalnum() or c in "-_" for c in name) or len(name) > 40:
        raise ValueError("name: folders are named after it, so it needs letters, digits, - and _, 40 at most")
    if table.get("fisheye", False) is not False:
        raise ValueError("fisheye: such lenses are not known here; needs false")
    size = _numbers(table, "size", (2,))
    if np.any(size != np.round(size)):
        raise ValueError("size: needs whole numbers of pixels")
    distortion = np.zeros(5)
    if "distortions" in table:
        count = len(table["distortions"]) if isinstance(table["distortions"], list) else 0
        if count not in (4, 5):
            raise ValueError("distortions: needs 4 or 5 numbers, k1, k2, p1, p2 and k3")
        distortion[:count] = _numbers(table, "distortions", (count,))
    turn = Y_UP.T if up == "z" else np.eye(3)
    pixels = int(size[0]), int(size[1])
    if any(field in table for field in _PLACED):
        if any(field in table for field in _MATRIX):
            raise ValueError("eye: a camera has either eye, target and fov, or matrix, rotation and translation")
        eye, target = (turn.T @ _numbers(table, field, (3,)) for field in ("eye", "target"))
        return looking_at(name, pixels, eye, target, float(np.radians(_numbers(table, "fov", ()))), distortion)
    rotation = exp(_numbers(table, "rotation", (3,)))
    return Lens(name, pixels, _numbers(table, "matrix", (3, 3)), rotation @ turn, _numbers(table, "translation", (3,)), distortion)


def _numbers(table: Mapping[str, Any], field: str, shape: tuple[int, ...]) -> np.ndarray:
    what = " × ".join(map(str, shape)) + " finite numbers" if shape else "a finite number"
    if field not in table:
        raise ValueError(f"{field}: is missing; needs {what}")
    try:
        value = np.array(table[field], float)
    except (TypeError, ValueError, OverflowError):
        value = np.zeros((0, 0))
    if value.shape != shape or not np.isfinite(value).all() or np.abs(value).max() > 1e7:
        raise ValueError(f"{field}: needs {what}")
    return value


def _read_qualisys(path: Path) -> list[Lens]:
    try:
        data = contents(path, LARGEST)
    except OSError as fault:
        raise CalibrationError(f"{path}: {reason(fault)}") from None
    if b"<!" in data.replace(b"<!--", b""):  # entities that grow without end
        raise CalibrationError(f"{path}: no calibration: has a document type, which Qualisys never writes")
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError, RecursionError) as fault:
        raise CalibrationError(f"{path}: neither a .toml file nor Qualisys's XML: {printable(str(fault), 100)}") from None
    made = []
    for number, camera in enumerate(root.iter("camera"), 1):
        name = camera.get("serial") or f"cam{number:02d}"
        name = "".join(c if c.isalnum() or c in "-_" else "_" for c in name)[:40]
        if camera.get("active", "1") == "0":
            continue
        try:
            made.append(_of_element(name, camera))
        except ValueError as fault:
            raise CalibrationError(f"{path}: camera {name}: {fault}") from None
    return made


def _of_element(name: str, camera: ElementTree.Element) -> Lens:
    """ValueError for what is missing in it."""
    def of(part: str, field: str, spare: float | None = None) -> float:
        element = camera.find(part)
        text = None if element is None else element.get(field)
        if text is None and spare is not None:
            return spare
        try:
            value = float(text or "")
        except ValueError:
            value = float("nan")
        if not np.isfinite(value) or abs(value) > 1e9:
            raise ValueError(f"{part}.{field}: {'is missing' if text is None else printable(text)}; needs a finite number")
        return value
    size = tuple(int(of("fov_video", high) - of("fov_video", low)) + 1 for high, low in (("right", "left"), ("bottom", "top")))
    turn = np.array([[of("transform", f"r{i}{k}") for k in (1, 2, 3)] for i in (1, 2, 3)])
    eye = Y_UP @ np.array([of("transform", axis) for axis in "xyz"]) / 1000.0
    rotation = FLIPPED @ turn @ Y_UP.T
    left, top = of("fov_video", "left"), of("fov_video", "top")
    matrix = np.array([[of("intrinsic", "focalLengthU"), of("intrinsic", "skew", 0.0), of("intrinsic", "centerPointU")],
                       [0.0, of("intrinsic", "focalLengthV"), of("intrinsic", "centerPointV")], [0, 0, SUBPIXELS]]) / SUBPIXELS
    matrix[:2, 2] -= left, top
    u, _, vt = np.linalg.svd(rotation)  # printed with few digits
    if np.abs(u @ vt - rotation).max() > 1e-3:
        raise ValueError("transform: r11 … r33 are no rotation")
    distortion = [of("intrinsic", f"{kind}Distortion{k}", 0.0) for kind, k in
                  (("radial", 1), ("radial", 2), ("tangental", 1), ("tangental", 2), ("radial", 3))]
    return Lens(name, (size[0], size[1]), matrix, u @ vt, -(u @ vt) @ eye, np.array(distortion))
