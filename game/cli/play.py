"""`gambol play` and `gambol bindings`: the game and its controls."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .base import Library, Mistake, Preset, Quality, Wearing, app, person_of, pixels_of, plainly, say

Hands = Annotated[Path | None, typer.Option("--bindings", help="Keys and buttons, a .toml file; your own or the shipped ones by default.")]
NO_DISPLAY = 3
"""The exit code of `gambol play` where no window can be opened."""


@app.command()
@plainly
def play(library: Library = None, character: Wearing = None, preset: Quality = Preset.full,
         size: Annotated[str, typer.Option(help="Size of the window.")] = "1280x720",
         bindings: Hands = None,
         players: Annotated[int, typer.Option(min=1, max=2, help="How many play; a second one may also join later.")] = 1,
         record: Annotated[Path | None, typer.Option(help="Keep the input log in this new .gambol file; by default in out/.")] = None,
         replay: Annotated[Path | None, typer.Option(help="Watch an input log; who walks plays on from there.")] = None) -> None:
    """Open the game: WASD or a gamepad moves, F1 shows every control."""
    from ..input.remap import load as load_bindings

    pixels, hands = pixels_of(size), load_bindings(bindings)
    controller = person_of(library, character)

    from ..hosts import DisplayError, run_window
    from ..log import LogWriter, of_library, read
    from ..play import Play
    from ..studio import OUT, Studio, log_file

    tape = None if replay is None else of_library(read(replay), controller)
    players = players if tape is None else tape.players
    log = LogWriter(log_file(record), controller, players)
    studio = Studio(OUT, [text for option, value in (("--library", library), ("--character", character)) if value
                          for text in (option, str(value))])
    game = Play(controller, players, bindings=hands, log=log, studio=studio, tape=tape)
    try:
        run_window(game, pixels, preset.value)
    except DisplayError as error:
        say(f"gambol: {error}")
        raise typer.Exit(NO_DISPLAY) from None
    finally:
        game.close()
        if log.begun:
            say(f"{log.path}: {game.now.number / 60:.0f} s; `gambol play --replay` shows it, `gambol render --replay` films it")
        studio.finish(say)


@app.command()
@plainly
def bindings(file: Hands = None,
             write: Annotated[Path | None, typer.Option(help="Write them into this new .toml file instead.")] = None) -> None:
    """Print the keys, buttons and sticks in force, as a file to edit."""
    from ..input.remap import as_toml, load
    from ..output import named, output_file

    text = as_toml(load(file))
    if write is None:
        typer.echo(text, nl=False)
        return
    if write.exists():
        raise Mistake(f"{write}: is there already; name another file")
    with named(output_file(write, ".toml")):
        write.write_text(text, encoding="utf-8")
    say(str(write))
