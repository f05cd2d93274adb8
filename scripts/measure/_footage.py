"""Pictures of a clip, drawn as the studio draws them: somebody in patterned clothes among pillars and boxes of all colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from _tracking import Film, silhouette

from gambol.controllers.tracking.segmentation import segmented
from gambol.controllers.tracking.silhouettes import contour_of
from gambol.controllers.tracking.twists import Configuration, posed
from gambol.game.hosts import Offscreen
from gambol.game.render import Body, mannequin
from gambol.game.scene import Box, Figure, Pillar, Prop, Scene
from gambol.game.studio import LensWarp, Sensor

SIZE = 512
"""Of the clothes' picture [pixels]."""


def clothed(seed: int = 7) -> Body:
    """The mannequin in a chequered shirt, dark trousers and bare arms, painted from the front."""
    body, rng = mannequin(), np.random.default_rng(seed)
    low, high = body.levels[0].paint.min(0), body.levels[0].paint.max(0)
    y, x = (np.linspace(high[1], low[1], SIZE)[:, None], np.linspace(low[0], high[0], SIZE)[None])
    picture = np.empty((SIZE, SIZE, 3))
    picture[:] = (200, 155, 125)
    tall = high[1] - low[1]
    chequers = ((np.floor(x / 0.05) + np.floor(y / 0.05)) % 2)[..., None]
    shirt = (np.abs(x) < 0.42) & (y > low[1] + 0.55 * tall) & (y < low[1] + 0.84 * tall)
    picture[shirt] = (chequers * (150, 70, 60) + (1 - chequers) * (200, 180, 160))[shirt]
    trousers = (y < low[1] + 0.55 * tall) & (np.abs(x) < 0.35)
    picture[trousers] = (60, 65, 85)
    picture[(y < low[1] + 0.05 * tall) & (np.abs(x) < 0.35)] = (35, 30, 30)
    picture[(y > low[1] + 0.93 * tall) & (np.abs(x) < 0.3)] = (60, 40, 30)
    picture += rng.normal(size=(SIZE // 8, SIZE // 8, 1)).repeat(8, 0).repeat(8, 1) * 8
    layer = np.concatenate([np.clip(picture, 0, 255), np.full((SIZE, SIZE, 1), 255)], -1).astype(np.uint8)[None]

    def painted(mesh):
        u, v = (mesh.paint[:, 0] - low[0]) / (high[0] - low[0]), (high[1] - mesh.paint[:, 1]) / tall
        return replace(mesh, paint=np.stack([u, v, np.zeros_like(u)], 1).astype(np.float32))
    return replace(body, levels=tuple(painted(mesh) for mesh in body.levels), pictures=layer)


def clutter(film: Film, seed: int = 3) -> tuple[Prop, ...]:
    """Pillars and boxes of all colours behind the cameras' far sides, none of them in the way."""
    rng = np.random.default_rng(seed)
    eyes = np.stack([lens.eye for lens in film.lenses])
    middle = eyes.mean(0)
    away = float(np.hypot(*(eyes - middle)[:, [0, 2]].T).max())
    out: list[Prop] = []
    for k in range(40):
        angle, radius = rng.uniform(0, 2 * np.pi), away * rng.uniform(1.15, 2.2)
        x, z = middle[0] + radius * np.cos(angle), middle[2] + radius * np.sin(angle)
        tint = tuple(rng.uniform(0.03, 0.6, 3))
        if k % 3:
            size = rng.uniform(0.4, 2.4, 3)
            out.append(Box((x, 0.5 * size[1], z), tuple(size), rng.uniform(0, 3), tint))
        else:
            out.append(Pillar((x, 0.0, z), rng.uniform(0.1, 0.4), rng.uniform(1.0, 3.0), tint))
    return tuple(out)


@dataclass(frozen=True, eq=False)
class Shots:
    """Pictures [frame][camera] (H, W, 3) uint8 from the film's third frame on, and each camera's with nobody in it."""

    pictures: list[list[np.ndarray]]
    plates: list[np.ndarray]


def shots(film: Film) -> Shots:
    """A clip's pictures, without a fault."""
    body, props = clothed(), clutter(film)
    warps = [LensWarp(lens) for lens in film.lenses]
    with Offscreen((16, 16), "full") as stage:
        plates, pictures = [], [[] for _ in film.truth[2:]]
        for warp in warps:  # one after the other: another size is a new set of buffers
            stage.resize(warp.size)
            plates.append(warp.bent(stage.frame(Scene(warp.camera, (), props))))
            for row, pose in zip(pictures, film.truth[2:]):
                positions, orientations, _ = posed(film.chain, pose)
                row.append(warp.bent(stage.frame(Scene(warp.camera, (Figure(positions, orientations, body=body),), props))))
    return Shots(pictures, plates)


def spoilt(pictures: Sequence[Sequence[np.ndarray]], seed: int) -> list[list[np.ndarray]]:
    """Pictures with the paper's noise: 15 % of pixels of any colour, and three rectangles."""
    sensor = Sensor(replaced=0.15, rectangles=3, seed=seed)
    return [[sensor.disturbed(picture, c, t, 0.0) for c, picture in enumerate(row)] for t, row in enumerate(pictures)]


def contours(film: Film, pictures: Sequence[Sequence[np.ndarray]], poses: Sequence[Configuration], frames: Sequence[int]) -> np.ndarray:
    """A picture (H, W, 3) of pictures with the true contour, green, the segmentation's, blue, and the model's, red: a row a frame."""
    half, rows = 110, []
    for t in frames:
        row = []
        for lens, seen in zip(film.lenses, pictures[t - 2]):
            true, ours = (silhouette(film, lens, pose) for pose in (film.truth[t], poses[t]))
            shown = seen.copy()
            for mask, colour in ((segmented(seen, ours).mask, (60, 140, 255)), (true, (0, 255, 0)), (ours, (255, 40, 40))):
                x, y = contour_of(mask).pixels.astype(int).T
                shown[y, x] = colour
            x, y = contour_of(true).pixels.mean(0).astype(int)
            row.append(np.pad(shown, ((half, half), (half, half), (0, 0)))[y:y + 2 * half, x:x + 2 * half].repeat(2, 0).repeat(2, 1))
        rows.append(np.concatenate(row, 1))
    return np.concatenate(rows)
