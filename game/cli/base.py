"""What all commands share: the app, its options and its manners."""

from __future__ import annotations

import functools
import gc
import math
import os
import re
from collections.abc import Iterable, Sequence
from contextlib import contextmanager
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, get_args, get_type_hints

import typer

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False,
                  context_settings={"help_option_names": ["-h", "--help"]},
                  help="A real-time human character, driven by gamepad, keyboard or script.")


def _told(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"gambol {version('gambol')}")
        raise typer.Exit


@app.callback()
def _common(version: Annotated[bool, typer.Option("--version", is_eager=True, callback=_told,
                                                  help="Say which version this is, and leave.")] = False) -> None:
    pass


class Preset(StrEnum):
    """How much light and shadow is drawn."""

    full = "full"
    fast = "fast"


Library = Annotated[Path | None, typer.Option(help="A gait library; the shipped one by default.")]
Wearing = Annotated[Path | None, typer.Option("--character", help="Who to be: a human in a .glb, .gltf or .vrm file; the mannequin by default.")]
Quality = Annotated[Preset, typer.Option(help="Picture quality.")]
Up = Annotated[str | None, typer.Option("--up", help="Which axis of motion files points up: x, y, z, -x, -y or -z; judged by the body in them by default.")]
Unit = Annotated[str | None, typer.Option("--unit", help="The unit of motion files, of .amc files their skeleton's: m, dm, cm, mm, ft, in or a number of metres; judged by the body's legs by default.")]


class Mistake(ValueError):
    """Something wrong in what was typed."""


def plainly(command):
    """The command, with errors that a user can act on as one line instead of a traceback.

    GAMBOL_TRACEBACK=1 in the environment shows the traceback.
    """
    @functools.wraps(command)
    def wrapped(*args, **kwargs):
        try:
            _check_finite(command, kwargs)
            return command(*args, **kwargs)
        except BrokenPipeError:  # whoever read our words has had enough: no mistake, and typer ends quietly
            raise
        except (ValueError, OSError) as error:
            # Gambol's own kinds of ValueError are about what the user gave; a bare one is our bug
            if type(error) is ValueError or os.environ.get("GAMBOL_TRACEBACK"):
                raise
            say(f"gambol: {error}")
            raise typer.Exit(2) from None
        except KeyboardInterrupt:
            say("gambol: stopped")
            raise typer.Exit(130) from None
    return wrapped


def _check_finite(command: Any, given: dict[str, Any]) -> None:
    """Mistake for an option with a bound that is no finite number: nan is on no side of it, and inf is beyond none."""
    for name, value in given.items():
        if isinstance(value, float) and not math.isfinite(value):
            option = get_args(get_type_hints(command, include_extras=True)[name])[-1]
            if option.min is not None:  # others are judged where they are used
                said = [word for word in (f"--{name}", option.default, *(option.param_decls or ())) if str(word).startswith("--")]
                raise Mistake(f"{said[-1]} {value}: needs a finite number")


@contextmanager
def unswept():
    """Nobody looks for garbage meanwhile: while modules are loaded there is none, and to look takes an eighth of the time."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()  # nor is it looked for among them later
        gc.enable()


def say(text: str) -> None:
    """Tell the user something that is no result: it goes to the standard error."""
    typer.echo(text, err=True)


def say_forgets() -> None:
    """Tell, before what takes long, that it will take as long the next time, where nothing can be kept."""
    from gambol.controllers.compiled import forgets

    if why := forgets():
        say(f"gambol: {why}")


def say_refused(refused: Iterable[str]) -> None:
    """Tell what a scenario asked for that nobody could do, and why."""
    for line in refused:
        say(f"gambol: {line}")


def say_doubts(file: str, film: Any) -> None:
    """Tell what a scenario hardly means."""
    from ..scenario import doubts

    for line in doubts(film):
        say(f"gambol: {file}: {line}")


def person_of(library: Path | None, character: Path | None = None) -> Any:
    """Who moves, with a gait library (the shipped one by default), in a character's body if one is named; all of it
    is compiled first, where it never was."""
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.person import person, preparing, rehearse

    walker, body = Locomotion.load(library), body_of(character)
    programs = preparing.begun(walker, library)
    if programs:
        say_forgets()
        say("compiling the motion, once: a minute")
    for program in programs:
        program.wait()
    somebody = person(walker)
    rehearse(somebody)
    return in_body(somebody, body)


def body_of(character: Path | None) -> Any:
    """The body in a character's file, read before anything takes time; None where none is named."""
    if character is None:
        return None
    from ..character import load

    return load(character)


def in_body(somebody: Any, body: Any) -> Any:
    """Somebody in a body; as they are where there is none."""
    from ..world import Embodied

    return somebody if body is None else Embodied.of(somebody, body)


def learn(wanted: Sequence[tuple[str, str]], database: str | Path | None = None) -> None:
    """Have methods, (name, points) each, learnt by another program where they were not yet, told of as it goes; and read them."""
    if not wanted:
        return
    from ..world import SHIPPED, Learning, methods

    known = methods(database)
    wanted = [one for one in wanted if one[0] != SHIPPED and not known.knows(*one)]
    if not wanted:
        return
    say_forgets()
    with progress_bar() as bar:
        if not bar.console.is_terminal:
            say("learning to make bodies of a few points: a minute, or some minutes of a large database for trackers that turn")
        tasks: dict[str, Any] = {}

        def progress(what: str, done: int, total: int) -> None:
            if what not in tasks:
                tasks[what] = bar.add_task(what)
            bar.update(tasks[what], completed=done, total=total)
        learning = Learning(wanted, None if database is None else Path(database), progress)
        try:
            learning.wait()
        except BaseException:
            learning.stop()
            raise
    if learning.fault:
        raise Mistake(learning.fault)
    for name, points in wanted:
        known(name, points)


def reading_of(up: str | None, unit: str | None, file: Path | None = None) -> Any:
    """How motion files are to be read; how one is that is judged to be as few are, is told. Mistake for an axis or a unit that there is not."""
    from gambol.controllers.mocap import Reading

    try:
        reading = Reading.of(up)
    except ValueError as error:
        raise Mistake(f"--up: {error}") from None
    try:
        reading = Reading.of(up, unit)
    except ValueError as error:
        raise Mistake(f"--unit: {error}") from None
    if file is not None and (doubt := reading.doubt(file)):
        say(f"gambol: {doubt}; --up and --unit say otherwise")
    return reading


def of_a_motion_file(option: str, file: Path | None, up: str | None, unit: str | None) -> None:
    """Mistake for an axis or a unit where there is no motion file."""
    if (up, unit) != (None, None) and (file is None or file.suffix.lower() not in (".bvh", ".amc")):
        raise Mistake(f"{'--up' if up is not None else '--unit'} goes with {option}, a .bvh or .amc file")


def spared(out: Path, file: Path | None, option: str = "") -> None:
    """Mistake where a result would take the place of the file that it is made of: nobody has that twice. option: which one names the file."""
    if file is not None and out.exists() and file.exists() and out.samefile(file):
        raise Mistake(f"{option} {file}: would be overwritten; give -o another name".lstrip())


def known(file: Path) -> None:
    """Read an input log before anything takes time. LogError for one that can't be read."""
    from ..session import read

    read(file)


def replayed(file: Path, controller: Any) -> tuple[Any, Any]:
    """An input log and who moves in it; what its comparisons need is learnt. LogError for one that can't be played."""
    from ..session import of_library, performer_of, read, wanted

    log = read(file)
    performer = performer_of(log, controller)
    of_library(log, performer)
    learn(wanted(log.ticks), log.database or None)
    return log, performer


def pixels_of(text: str) -> tuple[int, int]:
    """Width and height from "WIDTHxHEIGHT". Mistake for anything else."""
    width, _, height = text.lower().replace(" ", "").replace("×", "x").partition("x")
    if not (re.fullmatch("[0-9]{2,4}", width) and re.fullmatch("[0-9]{2,4}", height) and 16 <= int(width) <= 8192 and 16 <= int(height) <= 8192):
        raise Mistake(f"--size {text!r}: needs width x height in pixels, from 16 to 8192, such as 1280x720")
    return int(width), int(height)


def rate_of(text: str | None) -> Fraction | None:
    """Frames a second. Mistake for anything else."""
    from ..files import frame_rate

    try:
        return None if text is None else frame_rate(text)
    except ValueError as fault:
        raise Mistake(f"--fps: {fault}") from None


def overlays_of(text: str) -> list[str]:
    """Overlays from their names with commas; bodies too, unless bones take their place. Mistake for others."""
    from ..scene import OVERLAYS

    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in OVERLAYS:
            raise Mistake(f"--overlay {name!r}: there is no such overlay; choose from {', '.join(OVERLAYS)}")
    return names if "mesh" in names or "skeleton" in names else ["mesh", *names]


def cores() -> int:
    """How many cores this program may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def progress_bar() -> Any:
    """A bar for work that takes a while."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    return Progress(TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
                    console=Console(stderr=True))
