"""Pictures of a clip, drawn as the studio draws them: somebody in patterned clothes among pillars and boxes of all colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from _tracking import Film

from gambol.controllers.tracking.twists import posed
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
        def drawn(warp: LensWarp, figures: tuple[Figure, ...]) -> np.ndarray:
            stage.resize(warp.size)
            return warp.bent(stage.frame(Scene(warp.camera, figures, props)))
        plates, pictures = [drawn(warp, ()) for warp in warps], []
        for pose in film.truth[2:]:
            positions, orientations, _ = posed(film.chain, pose)
            figure = Figure(positions, orientations, body=body)
            pictures.append([drawn(warp, (figure,)) for warp in warps])
    return Shots(pictures, plates)


def spoilt(pictures: Sequence[Sequence[np.ndarray]], seed: int) -> list[list[np.ndarray]]:
    """Pictures with the paper's noise: 15 % of pixels of any colour, and three rectangles."""
    sensor = Sensor(replaced=0.15, rectangles=3, seed=seed)
    return [[sensor.disturbed(picture, c, t, 0.0) for c, picture in enumerate(row)] for t, row in enumerate(pictures)]
