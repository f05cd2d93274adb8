"""`gambol database`: motion databases from motion capture, for reconstruction to learn from."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated

import typer

from .base import Mistake, Unit, Up, app, plainly, progress_bar, reading_of, say

database = typer.Typer(no_args_is_help=True, help="Motion databases: build one from motion capture, look at one, teach a network from one.")
app.add_typer(database, name="database")

_KEPT = 250
"""Batches between two checkpoints."""


@database.command()
@plainly
def build(folder: Annotated[Path, typer.Argument(help="A folder of BVH or ASF/AMC files.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The .gambolmotion file to write.")] = Path("database.gambolmotion"),
          fps: Annotated[float, typer.Option(min=1.0, max=1000.0, help="Frames a second.")] = 60.0,
          mirrors: Annotated[bool, typer.Option("--mirrors/--no-mirrors", help="Add the mirror image of every take.")] = True,
          up: Up = None, unit: Unit = None) -> None:
    """Put every motion file of a folder onto one skeleton, into one file."""
    from gambol.controllers.reconstruction.database import SUFFIX, build as build_database

    from ..files import named, output_file

    output_file(out, SUFFIX)
    reading = reading_of(up, unit)
    with progress_bar() as bar, named(out):
        task = bar.add_task("reading", total=None)
        made = build_database(folder, out, fps=fps, mirrors=mirrors, reading=reading,
                              progress=lambda done, total: bar.update(task, completed=done, total=total))
    for problem in made.problems:
        say(problem)
    if made.problems:
        say(f"{len(made.problems)} files or folders left out")
    for line in _in_words(made.database):
        say(line)


@database.command()
@plainly
def tune(file: Annotated[Path, typer.Argument(help="A .gambolmotion file of one's own motion, 60 frames a second.")],
         out: Annotated[Path, typer.Option("-o", "--out", help="The .npz file to write: one's own network.")] = Path("network.npz"),
         batches: Annotated[int, typer.Option(min=10, max=1_000_000, help="How much is learnt; 1000 take some minutes on one core.")] = 1000,
         share: Annotated[float, typer.Option(min=0.0, max=1.0, help="How much of it is used: 0 is the network as it was; the more, the less it knows of others' motion.")] = 0.5,
         seed: Annotated[int, typer.Option(min=0, help="Of what is drawn.")] = 0,
         network: Annotated[Path | None, typer.Option(help="The network to go on from; the one that ships by default.")] = None) -> None:
    """Teach the network for trackers one's own motion; cut off, it goes on from its last checkpoint."""
    from gambol.controllers.reconstruction.database import FPS, Database
    from gambol.controllers.reconstruction.trackers import SHIPPED, Moments, Network, Tuner

    from ..files import named, output_file, whole

    output_file(out, ".npz")
    opened, began = Database.open(file), Network.load(network or SHIPPED)
    if opened.fps != FPS:
        raise Mistake(f"{file}: has {opened.fps:g} frames a second; a network is taught from {FPS:g}: gambol database build FOLDER --fps {FPS:g}")
    if not opened.sound.any():
        raise Mistake(f"{file}: has no sound frame to learn from")
    tuner = Tuner(began, Moments.of(opened), batches, seed, share)
    checkpoint = out.with_name(f"{out.stem}-learning{out.suffix}")
    if checkpoint.exists():
        tuner.resume(checkpoint)
        say(f"{checkpoint}: going on from batch {tuner.batch}")
    with progress_bar() as bar, named(out):
        task = bar.add_task("learning", total=batches, completed=tuner.batch)
        tuner.learn(checkpoint, _KEPT, lambda done, total, loss: bar.update(task, completed=done))
        with whole(out) as own:
            tuner.network().save(own)
    checkpoint.unlink(missing_ok=True)
    say(f"{out}: taught from {len(opened):,} frames; gambol reconstruct --network {out}")


@database.command()
@plainly
def report(file: Annotated[Path, typer.Argument(help="A .gambolmotion file.")],
           takes: Annotated[bool, typer.Option("--takes", help="List every take.")] = False) -> None:
    """What a database holds."""
    from gambol.controllers.reconstruction.database import Database

    opened = Database.open(file)
    for line in _in_words(opened):
        typer.echo(line)
    if takes:
        for take in opened.takes:
            if not take.mirrored:
                unsound = int((~opened.sound[take.start:take.stop]).sum())
                typer.echo(f"{take.action:6} {(take.stop - take.start) / opened.fps:7.1f} s  {take.clip}, {take.subject}"
                           + (f", {unsound} frames unsound" if unsound else ""))


def _in_words(opened) -> list[str]:
    """A database in some lines."""
    seconds = Counter()
    for take in opened.takes:
        seconds[take.action] += (take.stop - take.start) / opened.fps
    subjects = {take.subject for take in opened.takes}
    unsound = sum(int((~opened.sound[take.start:take.stop]).sum()) for take in opened.takes)
    size, images = opened.path.stat().st_size, sum(take.mirrored for take in opened.takes)
    return [f"{opened.path}: {len(opened):,} frames at {opened.fps:g} a second, {size / 1e6:.0f} MB",
            f"{len(opened.takes)} takes, {images} of them mirror images; {len(subjects)} subject{'s' * (len(subjects) != 1)}",
            f"{unsound:,} frames are unsound and never used",
            ", ".join(f"{action} {length / 60:.1f} min" for action, length in seconds.most_common())]
