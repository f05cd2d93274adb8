"""A folder of films with a page to look at them: every scenario with its poster and its figures.

Each film leaves three files beside `index.html`: NAME.mp4, NAME.png and NAME.json, which says what
the film was made of. The page is written anew after every film, so a run that is stopped leaves a
page of what there is; films that are made of the same again are not made again.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from html import escape
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from gambol.assets import path as asset

from ..explain import Quality, quality_of
from ..files import output_folder, whole
from ..scenario import Scenario, ScenarioError, load, locate, scenes, worlds
from ..session import digest
from ..world import DT, RATE
from .recorder import recorder

PAGE = "index.html"
FORMAT = 1
"""Goes up when what is measured or kept about a film changes."""


@dataclass(frozen=True)
class Figures:
    """What was measured of everybody in a run, at the simulation's own rate.

    drift, worst_drift: of standing points [m], on average and at most, over `stances` stances. skate:
    the part of standing points' frames that slid, 0 … 1. sunk: below the floor [m]. top_speed [m/s],
    distance [m]: of whoever was fastest, went farthest. real_time: how many times faster than the
    clock one core simulated it.
    """

    stances: int = 0
    drift: float = 0.0
    worst_drift: float = 0.0
    skate: float = 0.0
    sunk: float = 0.0
    top_speed: float = 0.0
    distance: float = 0.0
    real_time: float = 0.0


@dataclass(frozen=True)
class Entry:
    """A film in a gallery. key: of all that it was made of."""

    name: str
    key: str
    title: str
    under: str
    duration: float
    size: tuple[int, int]
    actors: int
    figures: Figures = field(default_factory=Figures)


@dataclass(frozen=True, eq=False)
class Plan:
    """A film to be made, unless it is `fresh`: there already and made of the same."""

    name: str
    film: Scenario
    key: str
    fresh: bool


def plan(names: Sequence[str], folder: str | Path, controller: Any, preset: str,
         size: tuple[int, int] | None = None, force: bool = False) -> tuple[Plan, ...]:
    """What making the films of some scenarios takes; names: of shipped ones, or .toml files.

    ScenarioError for a scenario that cannot be used or two of one name, OutputError for a folder that
    can't be written.
    """
    folder = Path(folder)
    made, files = [], {}
    for given in dict.fromkeys(names):
        film, file = load(given), locate(given)
        if files.setdefault(file.stem, file) != file:
            raise ScenarioError(f"{file}: its film would have the same name as that of {files[file.stem]}; rename one of them")
        film = film if size is None else film.at_size(size)
        words = (file.read_text("utf-8"), digest(controller), f"{film.size}", preset, version("gambol"), f"{FORMAT}", *_stamps(film.files))
        key = hashlib.sha256("\0".join(words).encode()).hexdigest()[:16]
        old = _entry(folder / f"{file.stem}.json")
        fresh = not force and old is not None and old.key == key and all(
            (folder / f"{file.stem}{suffix}").is_file() for suffix in (".mp4", ".png"))
        made.append(Plan(file.stem, film, key, fresh))
    output_folder(folder)  # made only now: a name mistyped leaves nothing behind
    return tuple(made)


def _stamps(paths: Sequence[Path]) -> list[str]:
    """What tells that a file, or one in a folder, is another than it was: its name, size and time."""
    files = [file for path in paths for file in (sorted(path.rglob("*")) if path.is_dir() else (path,)) if file.is_file()]
    return [f"{file} {file.stat().st_size} {file.stat().st_mtime_ns}" for file in files]


def make(plan: Plan, folder: str | Path, controller: Any, stage: Any, drawn: Callable[[], None] = lambda: None,
         tell: Callable[[str], None] = lambda line: None) -> Entry:
    """Make one film with its poster and figures, and the page that shows it too.

    stage: draws scenes as frames of the film's size, as `gambol.game.hosts.Offscreen`. drawn: is called
    after every frame. tell: hears of each jump that was not made and each place not reached. OutputError where something can't be written.
    """
    folder, film, poster = Path(folder), plan.film, None
    moment = 0.5 * film.duration if film.poster is None else film.poster
    with recorder(str(folder / f"{plan.name}.mp4"), film.size, film.fps) as target:
        for frame, seen in scenes(film, controller):
            picture = stage.frame(seen)
            target.write(picture)
            if poster is None and (frame.time >= moment - 0.5 / film.fps or frame.number == film.frames - 1):
                poster = picture[..., :3].copy()
            drawn()
    assert poster is not None  # a film has a frame at least
    for line in frame.refused:
        tell(line)
    _save_poster(poster, folder / f"{plan.name}.png")
    entry = Entry(plan.name, plan.key, film.title, film.under, film.duration, film.size, len(film.actors),
                  figures(film, controller))
    _write(folder / f"{plan.name}.json", json.dumps(asdict(entry), indent=1, ensure_ascii=False) + "\n")
    write_page(folder)
    return entry


def figures(film: Scenario, controller: Any) -> Figures:
    """Run a scenario without drawing it, and measure everybody in it."""
    next(islice(worlds(film, controller), 1, None))  # whatever is compiled is compiled before the clock runs
    ticks = round(film.duration * RATE)
    started = time.perf_counter()
    run = list(islice(worlds(film, controller), ticks + 1))
    took = time.perf_counter() - started
    quality, speed, distance = Quality(), 0.0, 0.0
    for who in range(len(film.actors)):
        quality = quality.merged(quality_of(run, who))
        ground = np.stack([world.characters[who].state.ground[:2] for world in run])
        steps = np.linalg.norm(np.diff(ground, axis=0), axis=-1)
        distance = max(distance, float(steps.sum()))
        # over half a second, so that it is the walker's speed and not that of a swaying chest
        window = min(RATE // 2, ticks)
        across = np.linalg.norm(ground[window:] - ground[:-window], axis=-1)
        speed = max(speed, float(across.max()) / (window * DT))
    return Figures(quality.stances, quality.drift, quality.worst_drift, quality.skate, quality.sunk,
                   speed, distance, film.duration / took)


def entries(folder: str | Path) -> tuple[Entry, ...]:
    """The films that a gallery has: what shows most first, then by name."""
    folder, first = Path(folder), ("demo", "corridor")
    found = [entry for file in sorted(folder.glob("*.json")) if (entry := _entry(file)) is not None
             and all((folder / f"{entry.name}{suffix}").is_file() for suffix in (".mp4", ".png"))]
    return tuple(sorted(found, key=lambda e: (first.index(e.name) if e.name in first else len(first), e.name)))


def write_page(folder: str | Path) -> Path:
    """Write the page of what a gallery has; where it is."""
    folder = Path(folder)
    shown = entries(folder)
    page = Template(asset("gallery", "page.html").read_text("utf-8")).substitute(
        count=f"{len(shown)} film" + ("" if len(shown) == 1 else "s"),
        minutes=_clock(sum(entry.duration for entry in shown)) + " min", version=escape(version("gambol")),
        films="\n".join(map(_film, shown)), rows="\n".join(map(_row, shown)))
    _write(folder / PAGE, page)
    return folder / PAGE


def _film(entry: Entry) -> str:
    name, (width, height) = escape(entry.name, quote=True), entry.size
    people = "" if entry.actors == 1 else f" · {entry.actors} people"
    under = f"<p>{escape(entry.under)}</p>" if entry.under else ""
    return (f'<article id="{name}"><video controls preload="none" playsinline poster="{name}.png" src="{name}.mp4" '
            f'width="{width}" height="{height}"></video>'
            f"<h2>{escape(entry.title)}</h2>{under}<small>{_clock(entry.duration)}{people}</small></article>")


def _row(entry: Entry) -> str:
    f, name = entry.figures, escape(entry.name, quote=True)
    cells = (f"{f.top_speed:.1f}", f"{f.distance:.0f}", f"{f.stances}", f"{1e3 * f.drift:.1f}", f"{1e3 * f.worst_drift:.0f}",
             f"{100 * f.skate:.1f}", f"{1e3 * f.sunk:.1f}", f"{f.real_time:.0f}×")
    return (f'<tr><th scope="row"><a href="#{name}">{escape(entry.title)}</a></th>'
            + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


_ENTRY = TypeAdapter(Entry)


def _entry(file: Path) -> Entry | None:
    """What a film's JSON says; None where it says nothing sound."""
    try:
        return replace(_ENTRY.validate_json(file.read_bytes()), name=file.stem)
    except (OSError, ValidationError):
        return None


def _save_poster(picture: np.ndarray, file: Path) -> None:
    from PIL import Image

    with whole(file) as part:
        Image.fromarray(picture).save(part, format="png")


def _write(file: Path, text: str) -> None:
    """Write a file that appears whole or not at all."""
    with whole(file) as part:
        part.write_text(text, encoding="utf-8")
