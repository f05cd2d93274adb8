"""The truth beside the pictures: who covers which pixel and how far off, joints in space and in every picture, contacts, motion."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.body import human
from gambol.controllers.tracking.cameras import Lens
from gambol.controllers.tracking.silhouettes import View, rendered

from ..files import plain, whole
from ..render import dressed
from ..scene import Figure, Prop
from ..meshes import posed_meshes, solid_meshes

COCO: tuple[tuple[str, str | None], ...] = (
    ("nose", None), ("left_eye", None), ("right_eye", None), ("left_ear", None), ("right_ear", None), ("left_shoulder", "LeftArm"),
    ("right_shoulder", "RightArm"), ("left_elbow", "LeftForeArm"), ("right_elbow", "RightForeArm"), ("left_wrist", "LeftHand"),
    ("right_wrist", "RightHand"), ("left_hip", "LeftUpLeg"), ("right_hip", "RightUpLeg"), ("left_knee", "LeftLeg"),
    ("right_knee", "RightLeg"), ("left_ankle", "LeftFoot"), ("right_ankle", "RightFoot"))
"""COCO's 17 points and our joints; a skeleton has no face."""
_BONES = [[16, 14], [14, 12], [17, 15], [15, 13], [12, 13], [6, 12], [7, 13], [6, 7], [6, 8], [7, 9], [8, 10], [9, 11]]
INSIDE = 0.25
"""A joint lies no deeper than that under its own skin [m]; what is nearer is in front of it."""


class Stage:
    """What stands still in a film, as every camera sees it: floor and solids."""

    def __init__(self, lenses: Sequence[Lens], props: Sequence[Prop]):
        self.views = [_still(lens, props) for lens in lenses]


@dataclass
class Truth:
    """What is collected of a film, frame by frame, for `write`."""

    lenses: Sequence[Lens]
    people: Sequence[str]
    joints: list[np.ndarray] = field(default_factory=list)
    orientations: list[np.ndarray] = field(default_factory=list)
    contacts: list[np.ndarray] = field(default_factory=list)
    pixels: list[np.ndarray] = field(default_factory=list)
    boxes: list[np.ndarray] = field(default_factory=list)

    def add(self, figures: Sequence[Figure], views: Sequence[tuple[np.ndarray, np.ndarray]]) -> None:
        """A frame: its figures, and of each camera mask and depth. Joints are those of the bodies that are seen."""
        figures = dressed(figures)
        self.joints.append(np.stack([f.positions for f in figures]))
        self.orientations.append(np.stack([f.orientations for f in figures]))
        self.contacts.append(np.stack([f.contacts for f in figures]))
        seen = [_seen(lens, figures, mask, depth) for lens, (mask, depth) in zip(self.lenses, views)]
        self.pixels.append(np.stack([s[0] for s in seen]))
        self.boxes.append(np.stack([s[1] for s in seen]))

    def write(self, folder: Path, fps: Fraction) -> None:
        """truth.npz, and coco.json of each camera."""
        arrays: dict[str, Any] = {
            "joints": np.stack(self.joints), "orientations": np.stack(self.orientations), "contacts": np.stack(self.contacts),
            "pixels": np.stack(self.pixels), "boxes": np.stack(self.boxes), "names": np.array(human().names), "people": np.array(self.people),
            "fps": np.array(plain(fps))}
        with whole(folder / "truth.npz") as part:
            with open(part, "wb") as file:
                np.savez_compressed(file, **arrays)
        for c, lens in enumerate(self.lenses):
            with whole(folder / lens.name / "coco.json") as part:
                part.write_text(json.dumps(self._coco(c, lens)), "utf-8")

    def _coco(self, c: int, lens: Lens) -> dict[str, Any]:
        images = [{"id": t, "file_name": f"frame_{t:05d}.png", "width": lens.size[0], "height": lens.size[1]} for t in range(len(self.joints))]
        notes = []
        for t, (pixels, boxes) in enumerate(zip(self.pixels, self.boxes)):
            for person in range(len(self.people)):
                left, top, right, bottom, area = (int(v) for v in boxes[c, person])
                if not area:
                    continue
                points = coco_points(pixels[c, person])
                notes.append({"id": len(notes) + 1, "image_id": t, "category_id": 1, "iscrowd": 0, "area": area, "track_id": person + 1,
                              "bbox": [left, top, right - left, bottom - top], "num_keypoints": int((points[:, 2] > 0).sum()),
                              "keypoints": [round(float(v), 2) for v in points.ravel()]})
        return {"images": images, "annotations": notes, "categories": [{
            "id": 1, "name": "person", "supercategory": "person", "keypoints": [name for name, _ in COCO], "skeleton": _BONES}]}


def coco_points(pixels: np.ndarray) -> np.ndarray:
    """COCO's points (17, 3), x, y and 0 not given, 1 hidden, 2 seen, of a person's joints (J, 3) in a picture."""
    out, skeleton = np.zeros((len(COCO), 3)), human()
    for k, (_, joint) in enumerate(COCO):
        if joint is not None and pixels[skeleton.index(joint), 2] > 0:
            out[k] = pixels[skeleton.index(joint)]
    return out


def seen_by(lens: Lens, still: View, figures: Sequence[Figure]) -> tuple[np.ndarray, np.ndarray]:
    """Who covers each pixel, (H, W) uint8, 0 for nobody, 1 for the first, and how far what is seen there is, (H, W) float32 [m]."""
    view, ends = View(still.depth.copy(), still.triangles.copy(), still.box), [0]
    meshes = posed_meshes(figures)
    for figure, (vertices, triangles, closed) in zip(figures, meshes):
        ends.append(ends[-1] + len(triangles))
        if figure.opacity >= 1.0:
            view = rendered(lens, vertices, triangles, view, closed, ends[-2])
    mask = np.searchsorted(np.array(ends), view.triangles, "right").astype(np.uint8)
    mask[view.triangles < 0] = 0
    return mask, view.depth


def _still(lens: Lens, props: Sequence[Prop]) -> View:
    """Floor and solids; none of their triangles has a number."""
    width, height = lens.size
    grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).astype(float)
    rays = lens.directions(grid)
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.where(rays[..., 1] * lens.eye[1] < 0, -lens.eye[1] / rays[..., 1], np.inf)
        depth = (far * (rays @ lens.rotation[2])).astype(np.float32)
    view = View(np.where(np.isnan(depth), np.float32(np.inf), depth), np.full((height, width), -1, np.int32), (0, 0, 0, 0))
    for vertices, triangles, closed in solid_meshes(props):
        view = rendered(lens, vertices, triangles, view, closed)
    view.triangles[:] = -1
    return view


def _seen(lens: Lens, figures: Sequence[Figure], mask: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joints (P, J, 3), x, y and 0 outside, 1 hidden, 2 seen, and boxes (P, 5), left, top, right, bottom and area."""
    joints = np.stack([f.positions for f in figures])
    pixels, deep = lens.project(joints)
    out = np.concatenate([pixels, np.zeros((*deep.shape, 1))], -1)
    at = np.round(np.clip(pixels, -1e6, 1e6)).astype(int)
    inside = (deep > 0) & np.all((at >= 0) & (at < lens.size), -1)
    boxes = np.zeros((len(figures), 5))
    for person, figure in enumerate(figures):
        mine = mask == person + 1
        rows, columns = np.flatnonzero(mine.any(1)), np.flatnonzero(mine.any(0))
        if len(rows):
            boxes[person] = columns[0], rows[0], columns[-1] + 1, rows[-1] + 1, np.count_nonzero(mine)
        if figure.opacity < 1.0:
            continue
        for j in np.flatnonzero(inside[person]):
            x, y = at[person, j]
            shown = mask[y, x] == person + 1 and deep[person, j] - depth[y, x] < INSIDE
            out[person, j, 2] = 2.0 if shown else 1.0
    return out, boxes
