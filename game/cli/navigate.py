"""`gambol navigate`: how people walk to goals."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from .base import Library, Mistake, app, plainly, progress_bar, say

navigate = typer.Typer(no_args_is_help=True, help="Walking to goals: the weights that people walk by.")
app.add_typer(navigate, name="navigate")


@navigate.callback()
def _group() -> None:
    pass


@navigate.command()
@plainly
def fit(file: Annotated[Path, typer.Argument(help="Recorded walks to goals, an .npz file: name, start, goal, xy, heading if known.")],
        out: Annotated[Path | None, typer.Option("-o", "--out", help="Write the fitted weights into this TOML file.")] = None,
        picture: Annotated[Path | None, typer.Option(help="Draw people's walks and planned ones into this PNG.")] = None,
        folds: Annotated[int, typer.Option(min=2, max=50, help="So many parts of the walks are left out in turn.")] = 5,
        trials: Annotated[int, typer.Option(min=10, max=10000, help="So many sets of weights are tried in each fit.")] = 150,
        library: Library = None) -> None:
    """Find the weights with which planned walks are most like recorded ones, and tell it on walks left out."""
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.navigation.identification import (fit as fitted_to, left_out, likeness, picture as draw, planned_like, read_paths,
                                                              straight)
    from gambol.controllers.navigation.planning import FREE, HUMAN, PUBLISHED, in_toml

    from ..files import output_file, whole

    paths = read_paths(file)
    if folds > len(paths):
        raise Mistake(f"--folds {folds}: there are only {len(paths)} walks in {file}")
    for path, suffix in ((out, ".toml"), (picture, ".png")):
        if path:
            output_file(path, suffix)
    limits = Locomotion.load(library).walk.half_spaces()
    with progress_bar() as bar:
        task = bar.add_task("fitting", total=(folds + 1) * trials)
        made = fitted_to(paths, limits, trials=trials, progress=lambda done: bar.update(task, completed=done))
        unseen, each = left_out(paths, limits, folds, trials=trials, progress=lambda done: bar.update(task, completed=trials + done))
        bar.update(task, completed=(folds + 1) * trials)

    typer.echo(f"{len(paths)} walks; velocities within what the library walks. At the same share of the way:")
    typer.echo(f"{'':30} {'distance':>9} {'heading':>8} {'turning at most':>16}   forward turning lateral  facing")
    typer.echo(f"{'straight line':30} {straight(paths).mean():7.3f} m")
    rows = [("published weights, no limits", PUBLISHED, likeness(paths, planned_like(paths, PUBLISHED, FREE))),
            ("published weights", PUBLISHED, None), ("shipped weights", HUMAN, None), ("fitted, all walks", made, None),
            (f"fitted, walks left out ({folds}×)", None, unseen)]
    for name, weights, like in rows:
        distance, heading, turning = (like or likeness(paths, planned_like(paths, weights, limits))).means()
        told = "" if weights is None else "   " + " ".join(f"{value:7.4g}" for value in weights[1:])
        typer.echo(f"{name:30} {distance:7.3f} m {math.degrees(heading):7.1f}° {turning:10.2f} rad/s{told}")
    if out:
        notes = (f"Weights of walking to a goal, fitted by `gambol navigate fit` to {len(paths)} walks in {file.name}: mean distance\n"
                 f"{unseen.means()[0]:.3f} m on walks left out.")
        with whole(out) as part:
            part.write_text(in_toml(made, notes), "utf-8")
        say(str(out))
    if picture:
        try:
            with whole(picture) as part:
                draw(paths, {"published": planned_like(paths, PUBLISHED, limits), "fitted": planned_like(paths, made, limits)}, part)
        except ImportError:
            raise Mistake('--picture needs matplotlib: .venv/bin/pip install -e ".[report]"') from None
        say(str(picture))
