"""The command line: ``gambol play``, ``render``, ``library``, ``scenarios``.

A user's mistake gets one clear line and exit code 2; a machine without a display exits with 3.
Everything heavy is imported where it is used, so that help comes at once.
"""

from __future__ import annotations

import functools
import math
import os
import sys
from enum import Enum
from pathlib import Path
from typing import Annotated

import typer

NO_DISPLAY = 3
"""The exit code of `gambol play` where no window can be opened."""

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False,
                  context_settings={"help_option_names": ["-h", "--help"]},
                  help="A real-time human character, driven by gamepad, keyboard or script.")
library_app = typer.Typer(no_args_is_help=True, help="Gait libraries: build one from motion capture, look at one.")
app.add_typer(library_app, name="library")


class Preset(str, Enum):
    """How much light and shadow is drawn."""

    full = "full"
    fast = "fast"


Library = Annotated[Path | None, typer.Option(help="A gait library; the shipped one by default.")]
Wearing = Annotated[Path | None, typer.Option("--character", help="Who to be: a human in a .glb, .gltf or .vrm file; the mannequin by default.")]
Quality = Annotated[Preset, typer.Option(help="Picture quality.")]
Hands = Annotated[Path | None, typer.Option("--bindings", help="Keys and buttons, a .toml file; your own or the shipped ones by default.")]


class Mistake(ValueError):
    """Something wrong in what was typed."""


def plainly(command):
    """The command, with errors that a user can act on as one line instead of a traceback.

    GAMBOL_TRACEBACK=1 in the environment shows the traceback.
    """
    @functools.wraps(command)
    def wrapped(*args, **kwargs):
        try:
            return command(*args, **kwargs)
        except BrokenPipeError:  # whoever read our words has had enough: no mistake, and typer ends quietly
            raise
        except (ValueError, OSError) as error:
            # Gambol's own kinds of ValueError are about what the user gave; a bare one is our bug
            if type(error) is ValueError or os.environ.get("GAMBOL_TRACEBACK"):
                raise
            _say(f"gambol: {error}")
            raise typer.Exit(2) from None
        except KeyboardInterrupt:
            _say("gambol: stopped")
            raise typer.Exit(130) from None
    return wrapped


def _say(text: str) -> None:
    typer.echo(text, err=True)


@app.command()
@plainly
def play(library: Library = None, character: Wearing = None, preset: Quality = Preset.full,
         size: Annotated[str, typer.Option(help="Size of the window.")] = "1280x720",
         bindings: Hands = None,
         players: Annotated[int, typer.Option(min=1, max=2, help="How many play; a second one may also join later.")] = 1,
         record: Annotated[Path | None, typer.Option(help="Keep the input log in this new .gambol file; by default in out/.")] = None,
         replay: Annotated[Path | None, typer.Option(help="Watch an input log; who walks plays on from there.")] = None) -> None:
    """Open the game: WASD or a gamepad moves, F1 shows every control."""
    from .input.remap import load as load_bindings

    pixels, hands = _size(size), load_bindings(bindings)
    controller = _controller(library, character)

    from .hosts import DisplayError, run_window
    from .log import LogWriter, of_library, read
    from .play import Play
    from .studio import OUT, Studio, log_file

    tape = None if replay is None else of_library(read(replay), controller)
    players = players if tape is None else tape.players
    log = LogWriter(log_file(record), controller, players)
    studio = Studio(OUT, [text for option, value in (("--library", library), ("--character", character)) if value
                          for text in (option, str(value))])
    game = Play(controller, players, bindings=hands, log=log, studio=studio, tape=tape)
    try:
        run_window(game, pixels, preset.value)
    except DisplayError as error:
        _say(f"gambol: {error}")
        raise typer.Exit(NO_DISPLAY) from None
    finally:
        game.close()
        if log.begun:
            _say(f"{log.path}: {game.now.number / 60:.0f} s; `gambol play --replay` shows it, `gambol render --replay` films it")
        studio.finish(_say)


@app.command()
@plainly
def bindings(file: Hands = None,
             write: Annotated[Path | None, typer.Option(help="Write them into this new .toml file instead.")] = None) -> None:
    """Print the keys, buttons and sticks in force, as a file to edit."""
    from .input.remap import as_toml, load
    from .output import named, output_file

    text = as_toml(load(file))
    if write is None:
        typer.echo(text, nl=False)
        return
    if write.exists():
        raise Mistake(f"{write}: is there already; name another file")
    with named(output_file(write, ".toml")):
        write.write_text(text, encoding="utf-8")
    _say(str(write))


@app.command()
@plainly
def render(scenario: Annotated[str | None, typer.Argument(help="A shipped scenario (see `gambol scenarios`) or a .toml file.")] = None,
           out: Annotated[str, typer.Option("-o", "--out", help="A .mp4 film, a folder for PNG frames, or a .bvh file of the motion.")] = ...,
           replay: Annotated[Path | None, typer.Option(help="Film this input log instead of a scenario, as its player saw it.")] = None,
           start: Annotated[float | None, typer.Option("--from", min=0.0, help="Where in the log to begin, in seconds.")] = None,
           end: Annotated[float | None, typer.Option("--to", min=0.0, help="Where in the log to end, in seconds.")] = None,
           size: Annotated[str | None, typer.Option(help="Width x height in pixels; the scenario's by default, 1920x1080 of a log.")] = None,
           fps: Annotated[int | None, typer.Option(min=1, max=240, help="Frames a second; the scenario's by default, 60 of a log.")] = None,
           preset: Annotated[Preset | None, typer.Option(help="Picture quality; full by default.")] = None,
           overlay: Annotated[str | None, typer.Option(help="What to draw, with commas: mesh, skeleton, contacts, trail, path.")] = None,
           library: Library = None, character: Wearing = None,
           background: Annotated[bool, typer.Option("--background", hidden=True, help="Yield to other programs; print progress as lines.")] = False) -> None:
    """Film a scenario or an input log without a display, or write a scenario's motion as BVH."""
    if (scenario is None) == (replay is None):
        raise Mistake("render needs either a scenario or --replay LOG")
    if background and hasattr(os, "nice"):
        os.nice(15)
    if replay is not None:
        if out.lower().endswith(".bvh"):
            raise Mistake(f"{out}: a log is filmed; name a .mp4 file or a folder for PNG frames")
        _film_log(replay, start, end, out, _size(size or "1920x1080"), fps or 60, preset, overlay, _controller(library, character),
                  background)
        return
    for option, given in (("--from", start), ("--to", end)):
        if given is not None:
            raise Mistake(f"{option} goes with --replay")

    from . import scenario as scenarios

    film = scenarios.load(scenario)
    film = film if fps is None else film.at_fps(fps)
    if out.lower().endswith(".bvh"):
        for option, given in (("--size", size), ("--preset", preset), ("--overlay", overlay)):
            if given is not None:
                raise Mistake(f"{option} means nothing for {out}: BVH holds the motion, not pictures of it")
        _write_motion(film, out, _controller(library, character))
        return
    from .film import scenes
    from .shots import overlays

    film = film if size is None else film.at_size(_size(size))
    shown = None if overlay is None else overlays(_overlays(overlay))
    controller = _controller(library, character)
    _draw((scene for _, scene in scenes(film, controller, shown)), film.frames, film.title, out, film.size, film.fps,
          preset, background)


def _film_log(file: Path, start: float | None, end: float | None, out: str, size: tuple[int, int], fps: int,
              preset: Preset | None, overlay: str | None, controller, background: bool) -> None:
    from .log import of_library, read
    from .shots import overlays
    from .views import filmed, frames

    log = read(file)
    start, end = start or 0.0, log.duration if end is None else min(end, log.duration)
    if not start < end:
        raise Mistake(f"{file} has {log.duration:.1f} s: nothing lies from {start:g} to {end:g} s")
    shown = overlays(_overlays(overlay or "mesh"))
    of_library(log, controller)

    def stray() -> None:
        _say(f"gambol: {file} was played with another version of Gambol, which walks another way: "
             "the film is not quite what was played")
    _draw(filmed(log, controller, fps, start, end, shown, stray), frames(log, fps, start, end), file.name, out, size, fps,
          preset, background)


def _draw(scenes, frames: int, title: str, out: str, size: tuple[int, int], fps: int, preset: Preset | None,
          background: bool) -> None:
    """Draw scenes into a film or a folder."""
    from .recorder import recorder

    target = recorder(out, size, fps)

    from .hosts import GraphicsError, Offscreen

    try:
        with Offscreen(size, (preset or Preset.full).value) as stage, target, _progress() as bar:
            for scene in _told(scenes, frames) if background else bar.track(scenes, frames, description=title):
                target.write(stage.frame(scene))
    except BaseException as error:
        if target.count:
            _say(f"gambol: what was drawn so far is in {target.part}")
        if isinstance(error, GraphicsError):
            raise Mistake(str(error)) from None
        raise
    _say(f"{target.path}: {frames} frames, {frames / fps:g} s, {size[0]} × {size[1]}")


def _told(scenes, frames: int):
    """The scenes, with a line of progress for each: whoever began this in the background reads them."""
    for number, scene in enumerate(scenes, 1):
        _say(f"{number} of {frames}")
        yield scene


def _write_motion(film, out: str | Path, controller) -> None:
    from .export import checked, takes, write
    from .film import run

    checked(out, [actor.name for actor in film.actors])
    with _progress() as bar:
        done = takes((frame.before, frame.after, frame.alpha)
                     for frame in bar.track(run(film, controller), film.frames, description=film.title))
    for path in write(out, done, film.fps):
        _say(f"{path}: {film.frames} frames, {film.duration:g} s")


@app.command()
@plainly
def export(what: Annotated[str, typer.Argument(help="A shipped scenario, a .toml file of one, or an input log (.gambol).")],
           out: Annotated[Path, typer.Option("-o", "--out", help="A .glb file (bodies, motion, contacts) or a .bvh file (motion).")],
           fps: Annotated[int | None, typer.Option(min=1, max=240, help="Frames a second; the scenario's by default, 60 of a log.")] = None,
           library: Library = None, character: Wearing = None) -> None:
    """Write the motion of a scenario or an input log for other programs."""
    from .export import checked, sampled, takes, write
    from .log import SUFFIX, of_library, read, replay

    checked(out)
    if not what.lower().endswith(SUFFIX):
        from . import scenario as scenarios

        film = scenarios.load(what)
        _write_motion(film if fps is None else film.at_fps(fps), out, _controller(library, character))
        return
    log, controller = read(what), _controller(library, character)
    of_library(log, controller)
    with _progress() as bar:
        moments = bar.track(replay(log, controller), len(log.ticks) + 1, description=log.path.name)
        done = takes(sampled(moments, fps or 60))
    for path in write(out, done, fps or 60):
        _say(f"{path}: {len(done[0].poses)} frames, {log.duration:.1f} s")


@app.command()
@plainly
def character(out: Annotated[Path, typer.Option("-o", "--out", help="The .glb file to write.")],
              height: Annotated[float, typer.Option(help="Height in metres.")] = 1.741,
              build: Annotated[float, typer.Option(help="From -1, slim, over 0 to 1, heavy.")] = 0.0,
              child: Annotated[float, typer.Option(help="From 0, grown up, to 1, the proportions of a child of six.")] = 0.0,
              shoulders: Annotated[float, typer.Option(help="Their width over the usual.")] = 1.0,
              hips: Annotated[float, typer.Option(help="Their width over the usual.")] = 1.0,
              skeleton: Annotated[Path | None, typer.Option(help="Take the lengths of bones from this BVH or ASF/AMC file.")] = None) -> None:
    """Make a mannequin of any size and build, as a GLB with skin and joints."""
    from .character import Actor, Build, joints_of, tailored, write
    from .output import output_file

    output_file(out, ".glb")
    bones = None
    if skeleton is not None:
        from controllers.mocap import load

        bones = load(skeleton).skeleton
    body = tailored(Build(height, build, child, shoulders, hips), bones, out.stem)
    write(out, [Actor(out.stem, body, joints_of(body))])
    _say(f"{out}: {height:g} m, {len(body.levels[0].triangles)} triangles; `gambol play --character {out}` wears it")


@app.command()
@plainly
def scenarios() -> None:
    """List the scenarios that come with Gambol."""
    from .scenario import load, shipped

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
    from .gallery import PAGE, make, plan, write_page
    from .scenario import shipped

    controller = _controller(library)
    plans = plan(names or shipped(), out, controller, preset.value, None if size is None else _size(size), force)
    todo = [one for one in plans if not one.fresh]
    write_page(out)

    from .hosts import GraphicsError, Offscreen

    done = 0
    try:
        with _progress() as bar:
            task = bar.add_task("", total=sum(one.film.frames for one in todo), visible=bool(todo))
            for one in todo:
                bar.update(task, description=one.film.title)
                with Offscreen(one.film.size, preset.value) as stage:
                    make(one, out, controller, stage, lambda: bar.advance(task))
                done += 1
    except GraphicsError as error:
        raise Mistake(str(error)) from None
    finally:
        kept = len(plans) - len(todo)
        _say(f"{out / PAGE}: {done} of {len(todo)} films made" + (f", {kept} up to date" if kept else ""))


@library_app.command()
@plainly
def build(folder: Annotated[Path, typer.Argument(help="A folder of BVH or ASF/AMC files.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The library file to write.")] = Path("library.npz"),
          recipe: Annotated[Path | None, typer.Option(help="A TOML recipe: which files for which gait.")] = None) -> None:
    """Cut gait cycles out of motion capture and make a library of them."""
    from controllers.locomotion.build import build_library

    from .output import named, output_file

    output_file(out, ".npz")
    with _progress() as bar:
        tasks = {}

        def progress(what: str, done: int, total: int) -> None:
            if what not in tasks:
                tasks[what] = bar.add_task(what)
            bar.update(tasks[what], completed=done, total=total)

        made, notes = build_library(folder, recipe, progress=progress)
    with named(out):
        made.save(out)

    from controllers.locomotion.coverage import report as in_words

    for line in [*notes, *in_words(made), str(out)]:
        _say(line)


@library_app.command()
@plainly
def report(file: Annotated[Path | None, typer.Argument(help="A library file; the shipped one by default.")] = None,
           picture: Annotated[Path | None, typer.Option(help="Draw the coverage into this PNG, too.")] = None,
           primitives: Annotated[bool, typer.Option("--primitives", help="List every primitive and its clip.")] = False) -> None:
    """What a library covers, and where its primitives come from."""
    from controllers.locomotion import DEFAULT_LIBRARY
    from controllers.locomotion import Library as GaitLibrary

    made = GaitLibrary.load(file or DEFAULT_LIBRARY)

    from controllers.locomotion.coverage import picture as draw
    from controllers.locomotion.coverage import report as in_words

    from .output import named, output_file

    if picture:
        output_file(picture, ".png")
    for line in in_words(made):
        typer.echo(line)
    if primitives:
        typer.echo(f"{'primitive':34} {'v_f':>6} {'ω':>6} {'v_l':>6} {'closure':>8}  clip")
        for one, (v_f, omega, v_l) in zip(made.primitives, made.velocities):
            typer.echo(f"{one.label:34} {v_f:6.2f} {omega:6.2f} {v_l:6.2f} {math.degrees(one.closure):7.1f}°  "
                       f"{one.clip} at {one.start:.2f} s{', mirrored' if one.mirrored else ''}"
                       f"{f', mean of {one.averaged}' if one.averaged > 1 else ''}")
    if picture:
        try:
            with named(picture):
                draw(made, picture)
        except ImportError:
            raise Mistake('--picture needs matplotlib: .venv/bin/pip install -e ".[report]"') from None
        _say(str(picture))


def _controller(library: Path | None, character: Path | None = None):
    from controllers.person import person

    if character is None:
        return person(library)
    from .character import load
    from .embodied import Embodied

    return Embodied.of(person(library), load(character))


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit() and 16 <= int(width) <= 8192 and 16 <= int(height) <= 8192):
        raise Mistake(f"--size {text!r}: needs width x height in pixels, from 16 to 8192, such as 1280x720")
    return int(width), int(height)


def _overlays(text: str) -> list[str]:
    from .shots import OVERLAYS

    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in OVERLAYS:
            raise Mistake(f"--overlay {name!r}: there is no such overlay; choose from {', '.join(OVERLAYS)}")
    return names if "mesh" in names or "skeleton" in names else ["mesh", *names]


def _progress():
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    return Progress(TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
                    console=Console(stderr=True))


def main() -> None:
    """The `gambol` command."""
    app()


if __name__ == "__main__":
    sys.exit(main())
