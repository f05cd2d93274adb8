"""`gambol render`, `scenarios` and `gallery`: films without a display."""

from __future__ import annotations

import os
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .base import (Library, Mistake, Preset, Quality, Wearing, app, known, learn, overlays_of, person_of, pixels_of, plainly,
                   progress_bar, rate_of, replayed, say, say_doubts, say_refused)
from .motion import write_motion


@app.command()
@plainly
def render(scenario: Annotated[str | None, typer.Argument(help="A shipped scenario (see `gambol scenarios`) or a .toml file.")] = None, *,
           out: Annotated[str, typer.Option("-o", "--out", help="A .mp4, .webm or .gif film, a folder for PNG frames, or a .bvh file of the motion.")],
           replay: Annotated[Path | None, typer.Option(help="Film this input log instead of a scenario, from where its player saw it; rings and ways that he saw come with --overlay jump,path.")] = None,
           start: Annotated[float | None, typer.Option("--from", min=0.0, help="Where in the log to begin, in seconds.")] = None,
           end: Annotated[float | None, typer.Option("--to", min=0.0, help="Where in the log to end, in seconds.")] = None,
           size: Annotated[str | None, typer.Option(help="Width x height in pixels; the scenario's by default, 1920x1080 of a log.")] = None,
           fps: Annotated[str | None, typer.Option(help="Frames a second, 29.97, too; the scenario's by default, 60 of a log, 25 of a GIF.")] = None,
           preset: Annotated[Preset | None, typer.Option(help="Picture quality; full by default.")] = None,
           overlay: Annotated[str | None, typer.Option(help="What to draw, with commas: mesh, skeleton, contacts, trail, path, jump, balance, forces, points, errors, cameras.")] = None,
           library: Library = None, character: Wearing = None,
           background: Annotated[bool, typer.Option("--background", hidden=True, help="Yield to other programs; print progress as lines.")] = False) -> None:
    """Film a scenario or an input log without a display, or write a scenario's motion as BVH."""
    if (scenario is None) == (replay is None):
        raise Mistake("render needs either a scenario or --replay LOG")
    if background and hasattr(os, "nice"):
        os.nice(15)
    rate = rate_of(fps)
    if rate is None and out.lower().endswith(".gif"):
        from ..output import GIF_RATE

        rate = Fraction(GIF_RATE)
    if replay is not None:
        if out.lower().endswith(".bvh"):
            raise Mistake(f"{out}: a log is filmed; name a .mp4, .webm or .gif file, or a folder for PNG frames")
        known(replay)
        _film_log(replay, start, end, out, pixels_of(size or "1920x1080"), rate or Fraction(60), preset, overlay,
                  person_of(library, character), background)
        return
    for option, given in (("--from", start), ("--to", end)):
        if given is not None:
            raise Mistake(f"{option} goes with --replay")

    from ..scenario import scenario as scenarios
    from ..session import SUFFIX

    assert scenario is not None  # for there is no log
    if scenario.lower().endswith(SUFFIX):
        raise Mistake(f"{scenario}: is an input log; film it by --replay {scenario}")
    film = scenarios.load(scenario)
    say_doubts(scenario, film)
    film = film if rate is None else film.at_fps(rate)
    if out.lower().endswith(".bvh"):
        for option, given in (("--size", size), ("--preset", preset), ("--overlay", overlay)):
            if given is not None:
                raise Mistake(f"{option} means nothing for {out}: BVH holds the motion, not pictures of it")
        write_motion(film, out, person_of(library, character))
        return
    from ..output import recorder
    from ..scenario import overlays, scenes

    film = film if size is None else film.at_size(pixels_of(size))
    shown = None if overlay is None else overlays(overlays_of(overlay))
    target = recorder(out, film.size, film.fps)  # a name that can't be is told of before anything is learnt
    controller = person_of(library, character)
    learn(film.wanted, film.database)
    refused: dict[str, None] = {}

    def drawn():
        for frame, made in scenes(film, controller, shown):
            refused.update(dict.fromkeys(frame.refused))
            yield made
    _draw(drawn(), film.frames, film.title, target, film.size, film.fps, preset, background)
    say_refused(refused)


def _film_log(file: Path, start: float | None, end: float | None, out: str, size: tuple[int, int], fps: Fraction,
              preset: Preset | None, overlay: str | None, controller, background: bool) -> None:
    from ..app import filmed, frames
    from ..output import recorder
    from ..scenario import overlays

    log, controller = replayed(file, controller)
    first, last = start or 0.0, log.duration if end is None else min(end, log.duration)
    if not first < last:
        raise Mistake(f"{file} has {log.duration:.1f} s: nothing lies from {first:g} s" + ("" if end is None else f" to {end:g} s"))
    shown = overlays(overlays_of(overlay or "mesh"))

    def stray() -> None:
        say(f"gambol: {file} was played with another version of Gambol, which walks another way: "
            "the film is not quite what was played")
    _draw(filmed(log, controller, fps, first, last, shown, stray), frames(log, fps, first, last), file.name,
          recorder(out, size, fps), size, fps, preset, background)


def _draw(scenes, frames: int, title: str, target, size: tuple[int, int], fps: Fraction, preset: Preset | None,
          background: bool) -> None:
    """Draw scenes into a film or a folder, by a `gambol.game.output.recorder.Recorder`."""
    from ..hosts import GraphicsError, Offscreen

    try:
        with Offscreen(size, (preset or Preset.full).value) as stage, target, progress_bar() as bar:
            if background or not bar.console.is_terminal:  # a bar that nobody sees move tells nothing
                scenes = _told(scenes, frames, 1 if background else max(frames // 10, 1))
            else:
                scenes = bar.track(scenes, frames, description=title)
            for scene in scenes:
                target.write(stage.frame(scene))
    except BaseException as error:
        if target.count:
            say(f"gambol: what was drawn so far is in {target.part}")
        if isinstance(error, GraphicsError):
            raise Mistake(str(error)) from None
        raise
    say(f"{target.path}: {frames} frames, {float(frames / fps):g} s, {target.picture[0]} × {target.picture[1]}"
        + ("" if target.picture == size else ": films have even sides"))


@app.command()
@plainly
def strip(scenario: Annotated[str, typer.Argument(help="A shipped scenario or a .toml file.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The .png picture.")],
          count: Annotated[int, typer.Option("-n", min=2, max=60, help="How many poses.")] = 12,
          start: Annotated[float | None, typer.Option("--from", min=0.0, help="The first one, in seconds; the first jump by default.")] = None,
          end: Annotated[float | None, typer.Option("--to", min=0.0, help="The last one, in seconds.")] = None,
          actor: Annotated[str | None, typer.Option(help="Whose; a row for each actor by default.")] = None,
          size: Annotated[str | None, typer.Option(help="Width x height in pixels; 2400 wide and 480 a row by default.")] = None,
          overlay: Annotated[str, typer.Option(help="What to draw, with commas.")] = "mesh,jump,balance",
          library: Library = None, character: Wearing = None) -> None:
    """Draw a motion as a strip of poses, one picture beside the other."""
    from PIL import Image

    from ..files import output_file, whole
    from ..hosts import GraphicsError, Offscreen
    from ..output import strip as poses
    from ..scenario import overlays, scenario as scenarios

    output_file(out, ".png")
    if start is not None and end is not None and not start < end:
        raise Mistake(f"--from {start:g} --to {end:g}: nothing lies between")
    film = scenarios.load(scenario)
    say_doubts(scenario, film)
    rows = len(film.actors) if actor is None else 1
    pixels = (2400, min(480 * rows, 8192)) if size is None else pixels_of(size)
    controller = person_of(library, character)
    learn(film.wanted, film.database)
    refused: dict[str, None] = {}
    made = poses(film, controller, count, overlays(overlays_of(overlay)), pixels,
                 start, end, actor, lambda line: refused.setdefault(line))
    try:
        with Offscreen(pixels, Preset.full.value) as stage, whole(out) as part:
            Image.fromarray(stage.frame(made)[..., :3]).save(part)
    except GraphicsError as error:
        raise Mistake(str(error)) from None
    say(f"{out}: {count} poses, {pixels[0]} × {pixels[1]}")
    say_refused(refused)


def _told(scenes, frames: int, every: int):
    """The scenes, with a line of progress for `every` so many: whoever began this in the background reads them."""
    for number, scene in enumerate(scenes, 1):
        if number % every == 0:
            say(f"{number} of {frames}")
        yield scene


@app.command()
@plainly
def scenarios(fields: Annotated[bool, typer.Option("--fields", help="Print all that a scenario may say instead.")] = False) -> None:
    """List the scenarios that come with Gambol."""
    from ..scenario import described, load, shipped

    if fields:
        typer.echo(described())
        return

    for name in shipped():
        film = load(name)
        people = "1 actor" if len(film.actors) == 1 else f"{len(film.actors)} actors"
        typer.echo(f"{name:14} {film.duration:4g} s  {people:8}  {film.title}")


@app.command()
@plainly
def gallery(names: Annotated[list[str] | None, typer.Argument(help="Shipped scenarios or .toml files; all shipped ones by default.")] = None,
            out: Annotated[Path, typer.Option("-o", "--out", help="The folder for the page and its films.")] = Path("gallery"),
            size: Annotated[str | None, typer.Option(help="Width x height in pixels; each scenario's by default.")] = None,
            preset: Quality = Preset.full,
            library: Library = None,
            force: Annotated[bool, typer.Option("--force", help="Make films anew that are up to date.")] = False) -> None:
    """Film all scenarios into a folder, with a page of posters, films and figures."""
    from ..files import output_folder
    from ..output import PAGE, make, plan, write_page
    from ..scenario import load, shipped

    for name in names or ():  # what can't be is told of before anything is compiled
        load(name)
    output_folder(out)
    controller = person_of(library)
    plans = plan(names or shipped(), out, controller, preset.value, None if size is None else pixels_of(size), force)
    todo = [one for one in plans if not one.fresh]
    for one in todo:
        say_doubts(one.name, one.film)
        learn(one.film.wanted, one.film.database)
    write_page(out)

    from ..hosts import GraphicsError, Offscreen

    done, refused = 0, dict[str, None]()

    def told(name: str, line: str) -> None:
        refused[f"{name}: {line}"] = None
    try:
        with progress_bar() as bar:
            task = bar.add_task("", total=sum(one.film.frames for one in todo), visible=bool(todo))
            for one in todo:
                bar.update(task, description=one.film.title)
                with Offscreen(one.film.size, preset.value) as stage:
                    make(one, out, controller, stage, lambda: bar.advance(task), partial(told, one.name))
                done += 1
    except GraphicsError as error:
        raise Mistake(str(error)) from None
    finally:
        kept = len(plans) - len(todo)
        say(f"{out / PAGE}: {done} of {len(todo)} films made" + (f", {kept} up to date" if kept else ""))
        say_refused(refused)
