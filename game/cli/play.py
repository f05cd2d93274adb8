"""`gambol play` and `gambol bindings`: the game and its controls."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from .base import (Library, Mistake, Preset, Quality, Wearing, app, body_of, in_body, known, learn, person_of, pixels_of, plainly, reading_of, replayed,
                   say, say_forgets, unswept)

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
         replay: Annotated[Path | None, typer.Option(help="Watch an input log; who walks plays on from there.")] = None,
         cameras: Annotated[bool, typer.Option("--cameras", help="Four cameras see you, and a tracker moves a body beside you; Z: with its penalty on jitter or without.")] = False,
         footage: Annotated[Path | None, typer.Option(help="A folder of footage, of `gambol film` or `gambol footage`: the first who is seen in it moves as a tracker makes them, and is whom you watch.")] = None,
         network: Annotated[Path | None, typer.Option(help="A network that gambol database tune taught, .npz, in the place of the one that ships.")] = None,
         send: Annotated[list[str] | None, typer.Option(help="Send whoever you play on by the VMC protocol to a program that shows them: HOST:PORT, such as 127.0.0.1:39539; named several times, to each.")] = None,
         crowd: Annotated[int, typer.Option(min=0, max=50, help="So many passers-by walk about, past each other and you.")] = 0,
         hints: Annotated[bool | None, typer.Option("--hints/--no-hints", show_default=False, help="Show the hints of the first minute again, or none; by default those that were never followed.")] = None) -> None:
    """Open the game: WASD or a gamepad moves, F1 shows every control."""
    pixels, hands, body = pixels_of(size), _hands(bindings), body_of(character)
    sending = None
    if send:
        from ..app import Sending

        sending = Sending(*send)
    if network is not None:
        _own(network, replay)
    if replay is not None:  # what can't be is told of before anything is compiled
        known(replay)
    with unswept():
        from gambol.controllers.locomotion import Locomotion
        from gambol.controllers.person import person, preparing

        walker = Locomotion.load(library)
        programs = preparing.begun(walker, library)  # while the rest is loaded
        if programs:
            say_forgets()

        from ..app import OUT, Capture, Opening, Play, Preparing, Teacher, log_file
        from ..session import LogWriter
        from ..world import methods

    controller = in_body(person(walker), body)
    tape, clip, database = None, None, network
    if replay is not None:
        tape, controller = replayed(replay, controller)
        players, clip, database = tape.players, tape.clip or None, tape.database or None
    elif footage is not None:
        from ..footage import lost_frames
        from ..world import Filmed

        if players != 1 or character is not None:
            raise Mistake("--footage: shows one person, in the mannequin: leave out " + ("--players" if players != 1 else "--character"))
        controller, clip = Filmed.load(footage, controller), footage
        for line in lost_frames(controller.footage):
            say(f"gambol: {line}")
    log = LogWriter(log_file(record), controller, players, clip, database, up=tape and tape.up, unit=tape and tape.unit)
    capture = Capture(OUT, [text for option, value in (("--library", library), ("--character", character)) if value
                          for text in (option, str(value))])
    beside = Preparing(walker, programs)

    if cameras:
        from ..world import tracker_ready

        say("making the tracker ready: a minute, the first time")
        tracker_ready()

    def begun() -> Play:
        game = Play(controller, players, bindings=hands, log=log, capture=capture, tape=tape, learnt=methods(database),
                    preparing=beside, teacher=None if hints is False else Teacher.ready(hands, afresh=bool(hints)), sending=sending)
        if cameras and tape is None:
            game.do("track")
        if crowd and tape is None:
            game.do(f"crowd={crowd}")
        return game
    show(Opening(begun, beside), pixels, preset, log, capture, sending)


def _hands(file: Path | None) -> Any:
    """The keys and buttons of a file, or the user's own; keys that do two things are told of. BindingsError."""
    from ..input import load, shared, user_file

    found = load(file)
    for line in shared(found):
        say(f"gambol: {file or user_file()}: {line}")
    return found


def _own(network: Path, replay: Path | None) -> None:
    """ArraysError for a file that is no network; Mistake for another kind of file, and where a log says which one it is."""
    from gambol.controllers.reconstruction.trackers import Network

    from ..world import taught

    if replay is not None:
        raise Mistake("--network: goes without --replay: a log says which network it needs")
    if not taught(network):
        raise Mistake(f"--network {network}: is no .npz file that `gambol database tune` wrote")
    Network.load(network)


def show(game: Any, pixels: tuple[int, int], preset: Preset, log: Any = None, capture: Any = None, sending: Any = None) -> None:
    """Run a game, or what opens one, in a window until it is over; exit code NO_DISPLAY where none can be opened."""
    with unswept():
        from ..hosts import DisplayError, run_window

    try:
        run_window(game, pixels, preset.value)
    except DisplayError as error:
        say(f"gambol: {error}")
        raise typer.Exit(NO_DISPLAY) from None
    finally:
        game.close()
        if log is not None and log.begun:
            named = f" {shlex.join((str(log.path), *capture.options))}" if capture is not None and capture.options else ""
            say(f"{log.path}: {log.ticks / 60:.0f} s; `gambol play --replay{named}` shows it, `gambol render --replay{named}` films it")
        if capture is not None:
            capture.finish(say)
        if sending is not None and sending.lost:
            say(f"{sending.lost} frames could not be sent")


def watch(method: str, points: str, database: Path | None = None, clip: Path | None = None, stream: Any = None, up: str | None = None, unit: str | None = None,
          size: str = "1280x720", preset: Preset = Preset.full, send: Sequence[str] = (), ask: Any = None) -> None:
    """Open the game on a reconstruction from points: of whoever is played, of a clip, or of a stream's.

    send: HOST:PORT of each program that the body is sent on to. up, unit: how the clip is to be read (`reading_of`). stream: a `gambol.controllers.reconstruction.live.sources.Source` of these points, placed where the first player's would be.
    ask: asks whoever wears the stream's trackers how they stand (`live.stand`), in the window, before the game begins.
    """
    from gambol.controllers.reconstruction import SETS

    points = next((name for name, some in SETS.items() if points == ",".join(some)), points)
    pixels, hands = pixels_of(size), _hands(None)
    reading = reading_of(up, unit, clip)
    # beside what ships nobody waits for others to be learnt
    wanted = tuple(dict.fromkeys([method, *(() if stream is not None or method == "trackers" else ("lpcr", "lpca"))]))
    controller = person_of(None)
    learn([(name, points) for name in wanted], database)

    from ..app import OUT, Asking, Capture, Play, Sending, log_file
    from ..session import Comparison, LogWriter
    from ..world import Recorded, methods

    performer = controller if clip is None else Recorded.load(clip, controller, reading)
    log = LogWriter(log_file(None), performer, 1, clip, database, up=up, unit=unit)
    capture = Capture(OUT)
    sending = Sending(*send) if send else None

    def begun() -> Play:
        game = Play(performer, bindings=hands, log=log, capture=capture, learnt=methods(database), stream=stream, sending=sending)
        game.open(Comparison(wanted, points))
        return game

    def asked(tell: Any, told: Any) -> None:
        def both(text: str) -> None:
            say(text)
            told(text)
        ask(tell=tell, say=both)
    show(begun() if ask is None else Asking(asked, begun), pixels, preset, log, capture, sending)


@app.command()
@plainly
def bindings(file: Hands = None,
             write: Annotated[Path | None, typer.Option(help="Write them into this new .toml file instead.")] = None) -> None:
    """Print the keys, buttons and sticks in force, as a file to edit."""
    from ..files import output_file, whole
    from ..input import as_toml

    text = as_toml(_hands(file))
    if write is None:
        typer.echo(text, nl=False)
        return
    if write.exists():
        raise Mistake(f"{write}: is there already; name another file")
    with whole(output_file(write, ".toml")) as part:
        part.write_text(text, encoding="utf-8")
    say(str(write))
