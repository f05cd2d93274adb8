"""`gambol film`: calibrated cameras film a scenario, and the truth lies beside."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .base import Library, Mistake, Quality, Preset, Wearing, app, learn, person_of, plainly, progress_bar, say


@app.command()
@plainly
def film(scenario: Annotated[str, typer.Argument(help="A shipped scenario (see `gambol scenarios`) or a .toml file.")],
         out: Annotated[Path, typer.Option("-o", "--out", help="The folder for pictures and truth; what is there of the same film is gone on with.")],
         cameras: Annotated[Path, typer.Option(help="The cameras: a .toml file, or a calibration of Qualisys's.")],
         width: Annotated[int | None, typer.Option(min=16, max=8192, help="Pictures so wide, all cameras scaled; as calibrated by default.")] = None,
         fps: Annotated[int | None, typer.Option(min=1, max=240, help="Frames a second; the scenario's by default.")] = None,
         preset: Quality = Preset.full, library: Library = None, character: Wearing = None) -> None:
    """Film a scenario with calibrated cameras: pictures, and masks, depth, joints, contacts and motion as they truly are."""
    from gambol.controllers.tracking.cameras import read_cameras

    from ..hosts import GraphicsError, Offscreen
    from ..scenario import scenario as scenarios
    from ..studio import Plan, read_sensor, shoot

    lenses, sensor = read_cameras(cameras), read_sensor(cameras)
    lenses = lenses if width is None else tuple(lens.scaled(width) for lens in lenses)
    run = scenarios.load(scenario)
    run = run if fps is None else run.at_fps(fps)
    controller = person_of(library, character)
    learn(run.wanted, run.database)
    made = 0
    try:
        with Offscreen((16, 16), preset.value) as stage, progress_bar() as bar:
            plan = Plan(run, lenses, sensor, preset.value, f"{controller.kind} {character or ''}")
            for drawn in bar.track(shoot(plan, out, controller, stage), run.frames, description=run.title):
                made += drawn
    except GraphicsError as error:
        raise Mistake(str(error)) from None
    kept = run.frames * len(lenses) - made
    say(f"{out}: {len(lenses)} cameras, {run.frames} frames" + (f"; {kept} pictures were there already" if kept else ""))
