"""`gambol export` and `character`: motion and bodies for other programs."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any

import typer

from .base import Library, Mistake, Unit, Up, Wearing, app, known, learn, of_a_motion_file, person_of, plainly, progress_bar, rate_of, reading_of, replayed, say, say_doubts, say_refused, spared


@app.command()
@plainly
def export(what: Annotated[str, typer.Argument(help="A shipped scenario, a .toml file of one, or an input log (.gambol).")],
           out: Annotated[Path, typer.Option("-o", "--out", help="A .glb file (bodies, motion, contacts) or a .bvh file (motion).")],
           fps: Annotated[str | None, typer.Option(help="Frames a second, 29.97, too; the scenario's by default, 60 of a log.")] = None,
           onto: Annotated[Path | None, typer.Option(help="Your own rigged human: -o moves on his bones. Of a .glb, .gltf or .vrm a copy with skin and names, of a .bvh or .amc a .bvh.")] = None,
           actor: Annotated[str | None, typer.Option(help="Whose motion goes --onto a file; the first one's by default.")] = None,
           up: Up = None, unit: Unit = None, library: Library = None, character: Wearing = None) -> None:
    """Write the motion of a scenario or an input log for other programs."""
    from ..output import checked, sampled, takes
    from ..session import SUFFIX, replay

    rate = rate_of(fps)
    checked(out)
    if actor is not None and onto is None:
        raise Mistake("--actor: says whose motion goes --onto a file; without it everybody's is written")
    of_a_motion_file("--onto", onto, up, unit)
    spared(Path(out), character, "--character")
    rig = _rig(onto, out, up, unit) if onto is not None else None
    if not what.lower().endswith(SUFFIX):
        from ..scenario import scenario as scenarios

        film = scenarios.load(what)
        say_doubts(what, film)
        if actor is not None and actor not in [one.name for one in film.actors]:
            raise Mistake(f"--actor: nobody in {what} is called {actor!r}; there are {', '.join(one.name for one in film.actors)}")
        write_motion(film if rate is None else film.at_fps(rate), out, person_of(library, character), rig, actor)
        return
    known(Path(what))
    log, controller = replayed(Path(what), person_of(library, character))
    with progress_bar() as bar:
        moments = bar.track(replay(log, controller), len(log.ticks) + 1, description=log.path.name)
        done = takes(sampled(moments, rate or 60))
    for path in _written(out, done, rate or 60, rig, actor):
        say(f"{path}: {len(done[0].poses)} frames, {log.duration:.1f} s")


def _rig(onto: Path, out: Path, up: str | None, unit: str | None) -> Any:
    """The rig in a file, and whether the motion on it can be written."""
    from ..files import output_file
    from ..output import rig_in, suffix_onto

    rig = rig_in(onto, reading_of(up, unit, onto if suffix_onto(onto) == ".bvh" else None))
    output_file(out, suffix_onto(onto))
    spared(out, onto, "--onto")
    return rig


def _written(out: str | Path, done: list, fps: Fraction | int, rig: Any, actor: str | None) -> list[Path]:
    from ..files import plain
    from ..output import chosen, write, write_onto

    return write(out, done, plain(fps)) if rig is None else [write_onto(out, rig, chosen(done, actor), plain(fps))]


def write_motion(film: Any, out: str | Path, controller: Any, rig: Any = None, actor: str | None = None) -> None:
    """Write the motion of a scenario, told of as it goes; onto a rig, if one is given, an actor's."""
    from ..output import checked, takes
    from ..scenario import run

    checked(out, [one.name for one in film.actors] if rig is None else ())
    learn(film.wanted, film.database)
    refused: dict[str, None] = {}

    def moments():
        for frame in run(film, controller):
            refused.update(dict.fromkeys(frame.refused))
            yield frame.before, frame.after, frame.alpha
    with progress_bar() as bar:
        done = takes(bar.track(moments(), film.frames, description=film.title))
    for path in _written(out, done, film.fps, rig, actor):
        say(f"{path}: {film.frames} frames, {film.duration:g} s")
    say_refused(refused)


@app.command()
@plainly
def character(out: Annotated[Path, typer.Option("-o", "--out", help="The .glb file to write.")],
              height: Annotated[float, typer.Option(help="Height in metres.")] = 1.741,
              weight: Annotated[float, typer.Option(help="From -1, slim, over 0 to 1, heavy.")] = 0.0,
              child: Annotated[float, typer.Option(help="From 0, grown up, to 1, the proportions of a child of six.")] = 0.0,
              shoulders: Annotated[float, typer.Option(help="Their width over the usual.")] = 1.0,
              hips: Annotated[float, typer.Option(help="Their width over the usual.")] = 1.0,
              skeleton: Annotated[Path | None, typer.Option(help="Take the lengths of bones from this BVH or ASF/AMC file.")] = None,
              up: Up = None, unit: Unit = None) -> None:
    """Make a mannequin of any size and build, as a GLB with skin and joints."""
    from ..character import Actor, Build, joints_of, tailored, write
    from ..files import output_file

    output_file(out, ".glb")
    bones, build = None, Build(height, weight, child, shoulders, hips)
    of_a_motion_file("--skeleton", skeleton, up, unit)
    if skeleton is not None:
        bones = reading_of(up, unit, skeleton).load(skeleton).skeleton
    try:
        body = tailored(build, bones, out.stem)
    except ValueError as error:
        raise Mistake(f"--skeleton {skeleton}: {error}") from None
    write(out, [Actor(out.stem, body, joints_of(body))])
    say(f"{out}: {height:g} m, {len(body.levels[0].triangles)} triangles; `gambol play --character {out}` wears it")
