"""Where a track through footage begins: whom it follows, what cameras saw of them, and their first poses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.mocap import JUDGED, Reading, retarget
from gambol.controllers.tracking import ClickError, Tracker, clicked, exchanged, read_clicks
from gambol.controllers.tracking.silhouettes import Surface, of_person
from gambol.controllers.tracking.twists import Configuration, fitted

from ..meshes import surface_of
from .footage import Footage, FootageError

AGAIN = 4
"""So often a rough first pose is fitted to the first frame."""


def person_in(footage: Footage, name: str | None) -> int:
    """The number of a person, the first by default. FootageError where nobody is called that."""
    if not footage.people:
        raise FootageError(f"{footage.path}: shows nobody")
    if name is None:
        return 0
    if name not in footage.people:
        raise FootageError(f"{footage.path}: shows no {name}; it has {', '.join(footage.people)}")
    return footage.people.index(name)


def first_poses(footage: Footage, surface: Surface, person: int = 0, motion: Path | None = None,
                reading: Reading = JUDGED) -> tuple[Configuration, Configuration]:
    """The poses of the first two frames, by a motion file, read so, else by the truth. FootageError, MotionFileError where there are none."""
    chain = surface.chain
    if motion is not None:
        clip = reading.load(motion)
        if clip.skeleton.names != chain.skeleton.names:
            try:
                clip = retarget(clip)
            except ValueError as fault:
                raise FootageError(f"{motion}: {fault}") from None
        if len(clip) < 2:
            raise FootageError(f"{motion}: holds one frame; a track begins with two")
        clip = clip.resample(float(footage.fps)).slice(0, 2)
        track = fitted(chain, clip.root, clip.rotations)
    else:
        truth = footage.truth()
        try:
            names = [str(name) for name in truth["names"]]
            turned, at = truth["orientations"][:2, person].astype(float), truth["joints"][:2, person].astype(float)
        except (KeyError, IndexError):
            turned, at, names = np.zeros(0), np.zeros(0), []
        if names != list(chain.skeleton.names) or turned.shape != (2, len(names), 3, 3) or not np.isfinite(turned).all():
            raise FootageError(f"{footage.path / 'truth.npz'}: does not say where somebody is in the first two frames; name a motion file")
        local = turned.copy()
        for j, parent in enumerate(chain.skeleton.parents):
            if parent >= 0:
                local[:, j] = np.swapaxes(turned[:, parent], -1, -2) @ turned[:, j]
        track = fitted(chain, at[:, 0], Rotation.from_matrix(local.reshape(-1, 3, 3)).as_matrix().reshape(local.shape))
    return Configuration(track.root[0], track.angles[0]), Configuration(track.root[1], track.angles[1])


def clicked_pose(footage: Footage, clicks: Path, level: str = "middle") -> tuple[Surface, Configuration]:
    """A body and its pose in the first frame, by a .toml file of joints in pictures. ClickError for one that says nothing sound."""
    seen = read_clicks(clicks, footage.lenses)
    try:
        chain, pose = clicked(footage.lenses, seen)
    except ClickError as fault:
        raise ClickError("; ".join([f"{clicks}: {fault}", *exchanged(footage.lenses, seen)])) from None
    return surface_of(chain.skeleton, "full", level=level), pose


def exchanged_clicks(footage: Footage, clicks: Path) -> list[str]:
    """A line for each pair of joints that whoever clicked seems to have exchanged. ClickError as of `clicked_pose`."""
    return [f"{clicks}: {line}" for line in exchanged(footage.lenses, read_clicks(clicks, footage.lenses))]


def settled(footage: Footage, tracker: Tracker, pose: Configuration, person: int = 0, masks: bool = False) -> Configuration:
    """A first pose that was given roughly, as the first frame has it: fitted to it again and again."""
    seen = seen_in(footage, 0, person, masks)
    for _ in range(AGAIN):
        pose = tracker.step(tracker.start(pose), seen).now
    return pose


def seen_in(footage: Footage, number: int, person: int = 0, masks: bool = False) -> list[np.ndarray | None]:
    """What each camera saw in a frame: pictures (H, W, 3) uint8, or masks of a person, (H, W) bool, or int8
    where others are seen, too; None of what was dropped."""
    out: list[np.ndarray | None] = []
    for lens in footage.lenses:
        if masks:
            found = footage.picture(lens.name, "mask", number)
            out.append(None if found is None else of_person(found, person))
            continue
        shown = footage.picture(lens.name, "frame", number)
        if shown is not None and (shown.dtype != np.uint8 or shown.shape[2:] not in ((), (3,))):
            raise FootageError(f"{footage.file(lens.name, 'frame', number)}: needs 8 bits of red, green and blue, or of grey")
        out.append(shown)
    return out
