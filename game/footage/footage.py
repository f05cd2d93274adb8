"""A folder of footage: a folder of pictures for each camera, `cameras.toml`, the truth, and `footage.json`, which says what it is."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.files import contents, printable, reason
from gambol.controllers.tracking.cameras import CalibrationError, Lens, read_cameras, write_opencv

from ..files import frame_rate, named, output_folder, whole

ABOUT, CAMERAS, TRUTH = "footage.json", "cameras.toml", "truth.npz"
KINDS = ("frame", "mask", "depth")
"""What there is of each frame: the picture, who is where (0 nobody, 1 the first, …), and how far [mm], 0 for nothing."""
VERSION = 1
FASTEST = 1000
"""Cameras take no more frames a second."""
UNSEEN = 0.3
"""So long [s] may no camera see somebody."""


class FootageError(ValueError):
    """Footage that can't be made or used: which file or field, and what would be right."""


@dataclass(frozen=True, eq=False)
class Footage:
    """A folder of footage. people: whom it shows. dropped, corrupted: camera → numbers of its frames. lost: (camera, kind) → numbers of frames whose
    pictures are not there, though they should be: see `checked`."""

    path: Path
    lenses: tuple[Lens, ...]
    fps: Fraction
    frames: int
    people: tuple[str, ...]
    dropped: dict[str, tuple[int, ...]]
    corrupted: dict[str, tuple[int, ...]]
    lost: Mapping[tuple[str, str], tuple[int, ...]] = field(default_factory=dict)

    def file(self, camera: str, kind: str, number: int) -> Path:
        """Where a camera's frame is, one of `KINDS`."""
        return file_of(self.path, camera, kind, number)

    def picture(self, camera: str, kind: str, number: int) -> np.ndarray | None:
        """A frame, (H, W, 3) uint8, a mask, (H, W) uint8, or depths, (H, W) float32 [m], infinite for nothing; None for a dropped frame, and a lost one."""
        from PIL import Image, UnidentifiedImageError

        path = self.file(camera, kind, number)
        if number in self.dropped.get(camera, ()) and kind == "frame" or number in self.lost.get((camera, kind), ()):
            return None
        try:
            with Image.open(path) as image:
                made = np.asarray(image)
        except (OSError, UnidentifiedImageError, ValueError, SyntaxError) as fault:
            raise FootageError(f"{path}: {reason(fault)}") from None
        size = next(lens.size for lens in self.lenses if lens.name == camera)
        if made.shape[:2] != size[::-1]:
            raise FootageError(f"{path}: {made.shape[1]} × {made.shape[0]} pixels, but {camera} has {size[0]} × {size[1]}")
        if kind == "depth":
            return np.where(made == 0, np.float32(np.inf), made.astype(np.float32) / 1000.0)
        return made

    def truth(self) -> dict[str, np.ndarray]:
        """What `Truth` wrote, by name."""
        try:
            with np.load(self.path / TRUTH) as file:
                return dict(file)
        except FileNotFoundError:
            raise FootageError(f"{self.path}: does not say where somebody is in the first frame, as only what virtual cameras filmed does "
                               f"({TRUTH}): say it with --start, a .toml file of where joints are seen, or a motion file") from None
        except (OSError, ValueError, EOFError, KeyError) as fault:
            raise FootageError(f"{self.path / TRUTH}: {reason(fault)}") from None


def checked(footage: Footage, masks: bool = False) -> Footage:
    """The footage, with a picture of its camera's size, or a mask, of every frame that was neither dropped nor is `lost`, which is filled in.

    FootageError, naming file or frames, for another picture, and where too much is lost: all of a camera, of a first frame, or of so many frames
    after each other that nobody can tell where somebody went meanwhile.
    """
    from PIL import Image, UnidentifiedImageError

    kind = "mask" if masks else "frame"
    lost, there = dict(footage.lost), np.zeros(footage.frames, bool)
    for lens in footage.lenses:
        gone, missing = () if masks else footage.dropped.get(lens.name, ()), []
        for number in (n for n in range(footage.frames) if n not in gone):
            path = footage.file(lens.name, kind, number)
            if not path.exists():
                missing.append(number)
                continue
            there[number] = True
            try:
                with Image.open(path) as image:  # its head alone
                    size = image.size
            except (OSError, UnidentifiedImageError, ValueError, SyntaxError) as fault:
                raise FootageError(f"{path}: {reason(fault)}") from None
            if size != lens.size:
                raise FootageError(f"{path}: {size[0]} × {size[1]} pixels, but {lens.name} has {lens.size[0]} × {lens.size[1]}")
        if missing:
            if len(missing) + len(gone) == footage.frames:
                raise FootageError(f"{footage.file(lens.name, kind, missing[0])}: is not there, nor is any {kind} of {lens.name}")
            lost[lens.name, kind] = tuple(missing)
    blind, longest = runs(np.flatnonzero(~there)), max(round(UNSEEN * footage.fps), 1)
    if lost:
        for first, last in blind:
            if first == 0:
                raise FootageError(f"{footage.path}: no camera has the first {kind}, and a track begins with it")
            if last - first >= longest:
                raise FootageError(f"{footage.path}: no camera has {kind}s {first} to {last}: where somebody went meanwhile, for more than "
                                   f"{UNSEEN:g} s, nobody can tell")
    return replace(footage, lost=lost)


def lost_frames(footage: Footage) -> list[str]:
    """A line for each camera some of whose pictures are not there."""
    return [f"{footage.path / camera}: {len(numbers)} of {footage.frames} {kind}s are not there: "
            + ", ".join(str(first) if first == last else f"{first}–{last}" for first, last in runs(numbers))
            for (camera, kind), numbers in footage.lost.items()]


def runs(numbers: Sequence[int] | np.ndarray) -> list[tuple[int, int]]:
    """Growing numbers as (first, last) of those that follow each other."""
    found: list[tuple[int, int]] = []
    for number in map(int, numbers):
        found[-1:] = [(found[-1][0], number)] if found and number == found[-1][1] + 1 else [*found[-1:], (number, number)]
    return found


def file_of(folder: Path, camera: str, kind: str, number: int) -> Path:
    """Where a camera's frame is, one of `KINDS`."""
    return folder / camera / f"{kind}_{number:05d}.png"


def fingerprint(*told: Any) -> str:
    """What tells one film from another."""
    return hashlib.sha256(repr(told).encode()).hexdigest()[:16]


def begun(folder: str | Path, lenses: Sequence[Lens], about: dict[str, Any]) -> Path:
    """A folder for footage, made, or gone on with where the same film was begun there. about: its JSON-able facts, `film` among
    them, which tells it from others.

    FootageError where another film, or anything else, is there; OutputError where nothing can be written.
    """
    folder = output_folder(folder)
    known = _read(folder) if (folder / ABOUT).exists() else None
    if known is None and any(folder.iterdir()):
        raise FootageError(f"{folder}: is not empty, and no footage was begun in it; name another folder")
    if known is not None and known.get("film") != about["film"]:
        raise FootageError(f"{folder}: holds another film, or other cameras or disturbances; name another folder")
    for lens in lenses:
        output_folder(folder / lens.name)
    with named(folder):
        write_opencv(lenses, folder / CAMERAS)
    with whole(folder / ABOUT) as part:
        part.write_text(json.dumps({"version": VERSION, **about}, indent=1), "utf-8")
    return folder


def complete(path: Path, people: Sequence[str], **more: Any) -> None:
    """Say that all of some footage is there, and whom it shows. more: facts that were not known when it was begun."""
    told = json.loads((path / ABOUT).read_text("utf-8"))
    with whole(path / ABOUT) as part:
        part.write_text(json.dumps({**told, **more, "people": list(people), "complete": True}, indent=1), "utf-8")


def read_footage(folder: str | Path) -> Footage:
    """The footage in a folder. FootageError, in one line, for anything else."""
    folder = Path(folder)
    told = _read(folder)
    if told.get("complete") is not True:
        raise FootageError(f"{folder}: was not filmed to its end; the same command goes on with it")
    try:
        lenses = read_cameras(folder / CAMERAS)
    except CalibrationError as fault:
        raise FootageError(str(fault)) from None
    names = {lens.name for lens in lenses}

    def lists(field: str) -> dict[str, tuple[int, ...]]:
        value = told.get(field, {})
        if not isinstance(value, dict) or not set(value) <= names or not all(
                isinstance(one, list) and all(type(n) is int and n >= 0 for n in one) for one in value.values()):
            raise FootageError(f"{folder / ABOUT}: {field}: needs lists of frames by camera; film it anew")
        return {name: tuple(one) for name, one in value.items()}
    if type(told.get("frames")) is not int or not 1 <= told["frames"] <= 10**7:
        raise FootageError(f"{folder / ABOUT}: frames: needs a whole number from 1 to {10**7}; film it anew")
    try:
        fps = frame_rate(told.get("fps"), FASTEST)
    except ValueError as fault:
        raise FootageError(f"{folder / ABOUT}: fps: {fault}; film it anew") from None
    people = told.get("people")
    if not isinstance(people, list) or not all(isinstance(name, str) for name in people):
        raise FootageError(f"{folder / ABOUT}: people: needs a list of names; film it anew")
    return Footage(folder, lenses, fps, told["frames"], tuple(people), lists("dropped"), lists("corrupted"))


def _read(folder: Path) -> dict[str, Any]:
    file = folder / ABOUT
    if folder.is_dir() and not file.exists():
        raise FootageError(f"{folder}: holds no footage; gambol film and gambol footage make some")
    try:
        told = json.loads(contents(file, 64 << 20))
    except OSError as fault:
        raise FootageError(f"{file}: {reason(fault)}") from None
    except (ValueError, RecursionError) as fault:
        raise FootageError(f"{file}: no footage: {printable(str(fault))}") from None
    if not isinstance(told, dict) or told.get("version") != VERSION:
        raise FootageError(f"{file}: no footage of this version; film it anew")
    return told
