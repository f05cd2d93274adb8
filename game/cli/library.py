"""`gambol library`: build a gait library from motion capture, look at one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from .base import Mistake, Unit, Up, app, plainly, progress_bar, reading_of, say

library = typer.Typer(no_args_is_help=True, help="Gait libraries: build one from motion capture, look at one.")
app.add_typer(library, name="library")


@library.command()
@plainly
def build(folder: Annotated[Path, typer.Argument(help="A folder of BVH or ASF/AMC files.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The library file to write.")] = Path("library.npz"),
          recipe: Annotated[Path | None, typer.Option(help="A TOML recipe: which files for which gait.")] = None,
          up: Up = None, unit: Unit = None) -> None:
    """Cut gait cycles out of motion capture and make a library of them."""
    from gambol.controllers.locomotion import build_library

    from ..files import named, output_file

    output_file(out, ".npz")
    reading = reading_of(up, unit)
    with progress_bar() as bar:
        tasks = {}

        def progress(what: str, done: int, total: int) -> None:
            if what not in tasks:
                tasks[what] = bar.add_task(what)
            bar.update(tasks[what], completed=done, total=total)

        made, notes = build_library(folder, recipe, progress=progress, reading=reading)
    with named(out):
        made.save(out)

    from gambol.controllers.locomotion import report as in_words

    for line in [*notes, *in_words(made), str(out)]:
        say(line)


@library.command()
@plainly
def report(file: Annotated[Path | None, typer.Argument(help="A library file; the shipped one by default.")] = None,
           picture: Annotated[Path | None, typer.Option(help="Draw the coverage into this PNG, too.")] = None,
           primitives: Annotated[bool, typer.Option("--primitives", help="List every primitive and its clip.")] = False) -> None:
    """What a library covers, and where its primitives come from."""
    from gambol.controllers.locomotion import DEFAULT_LIBRARY, Library as GaitLibrary

    made = GaitLibrary.load(file or DEFAULT_LIBRARY)

    from gambol.controllers.locomotion import picture as draw, report as in_words

    from ..files import output_file, whole

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
            with whole(picture) as part:
                draw(made, part)
        except ImportError:
            raise Mistake('--picture needs matplotlib: .venv/bin/pip install -e ".[report]"') from None
        say(str(picture))
