"""Filming: every camera draws every frame of a scenario, and the truth is written beside; what is there already is left as it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.tracking.cameras import Lens

from ..files import plain, whole
from ..footage import FootageError, begun, complete, file_of, fingerprint
from ..output import takes, write
from ..scenario import Scenario, run
from ..scene import Scene
from ..world import figures
from .lens_warp import LensWarp
from .sensor import Sensor
from .truth import Stage, Truth, seen_by


@dataclass(frozen=True, eq=False)
class Plan:
    """What is to be filmed. kind: what tells who moves in it from others."""

    scenario: Scenario
    lenses: tuple[Lens, ...]
    sensor: Sensor
    preset: str = "full"
    kind: str = ""

    @property
    def about(self) -> dict[str, Any]:
        """What `footage.json` says of it, before anything is filmed."""
        film = self.scenario
        fates = {lens.name: [self.sensor.fate(c, t) for t in range(film.frames)] for c, lens in enumerate(self.lenses)}
        return {"film": fingerprint(film.model_dump_json(), [(x.name, x.size, x.numbers.tolist()) for x in self.lenses],
                                    self.sensor.model_dump_json(), self.preset, self.kind),
                "title": film.title, "fps": plain(film.fps), "frames": film.frames, "sensor": self.sensor.model_dump(),
                **{what: {name: [t for t, fate in enumerate(mine) if fate == what] for name, mine in fates.items()}
                   for what in ("dropped", "corrupted")}}


def shoot(plan: Plan, folder: str | Path, controller: Any, stage: Any, tell: Callable[[str], None] = lambda line: None) -> Iterator[int]:
    """Film a plan into a folder, with a `gambol.game.hosts.Offscreen`; the number of pictures drawn for each frame as it is done. tell: hears
    of each jump that was not made and each place not reached, in the end.

    FootageError where the folder holds anything else, or a lens can't be drawn; OutputError where nothing can be written.
    """
    film, lenses = plan.scenario, plan.lenses
    try:
        warps = [LensWarp(lens) for lens in lenses]
    except ValueError as fault:
        raise FootageError(str(fault)) from None
    path = begun(folder, lenses, plan.about)
    truth, still, moments = Truth(lenses, ()), None, []
    for frame in run(film, controller):
        people = figures(frame.before, frame.after, frame.alpha)
        truth.people = [c.name for c in frame.after.characters]
        still = still or Stage(lenses, frame.after.props)
        moments.append((frame.before, frame.after, frame.alpha))
        views = [seen_by(lens, one, people) for lens, one in zip(lenses, still.views)]
        truth.add(people, views)
        drawn = 0
        for c, (lens, warp, (mask, depth)) in enumerate(zip(lenses, warps, views)):
            if _there(path, lens, frame.number, plan.sensor.fate(c, frame.number)):
                continue
            _save(file_of(path, lens.name, "depth", frame.number), _millimetres(depth))
            _save(file_of(path, lens.name, "mask", frame.number), mask)
            if plan.sensor.fate(c, frame.number) != "dropped":
                stage.resize(warp.size)
                picture = warp.bent(stage.frame(Scene(warp.camera, people, frame.after.props)))
                _save(file_of(path, lens.name, "frame", frame.number), plan.sensor.disturbed(picture, c, frame.number, frame.time))
            drawn += 1
        yield drawn
    truth.write(path, film.fps)
    write(path / "motion.bvh", takes(moments), plain(film.fps))
    complete(path, truth.people)
    for line in frame.refused:
        tell(line)


def _there(path: Path, lens: Lens, number: int, fate: str) -> bool:
    """Whether all of a camera's frame is there: what is written last comes last."""
    return file_of(path, lens.name, "mask" if fate == "dropped" else "frame", number).exists()


def _millimetres(depth: np.ndarray) -> np.ndarray:
    return np.where(depth < 65.535, np.round(depth * 1000.0), 0).astype(np.uint16)


def _save(path: Path, picture: np.ndarray) -> None:
    from PIL import Image

    with whole(path) as part:
        Image.fromarray(picture).save(part, format="png", compress_level=1)
