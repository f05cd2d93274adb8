"""`gambol film`: calibrated cameras film a scenario, and the truth lies beside. `gambol track`: somebody's motion from such footage."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .base import Library, Mistake, Preset, Quality, Unit, Up, app, cores, learn, of_a_motion_file, person_of, plainly, progress_bar, rate_of, reading_of, say, say_doubts, say_refused, spared
from .film_jobs import Job, at_once, count_of, frames, jobs_of, on_cluster


@app.command()
@plainly
def film(scenarios: Annotated[list[str], typer.Argument(metavar="SCENARIO…", help="Shipped scenarios (see `gambol scenarios`) or .toml files.")],
         out: Annotated[Path, typer.Option("-o", "--out", help="The folder for pictures and truth, of several films a folder each in it; what is there of the same film is gone on with.")],
         cameras: Annotated[Path | None, typer.Option(help="The cameras: a .toml file, or a calibration of Qualisys's; four round the origin by default.")] = None,
         width: Annotated[int | None, typer.Option(min=16, max=8192, help="Pictures so wide, all cameras scaled; as calibrated by default.")] = None,
         fps: Annotated[str | None, typer.Option(help="Frames a second, 29.97, too; the scenario's by default.")] = None,
         seeds: Annotated[int, typer.Option(min=0, max=10_000, help="Film each so many times, with other noise; once, with the file's seed, by default.")] = 0,
         workers: Annotated[int | None, typer.Option(min=1, max=256, help="How many programs film at once; as many as there are cores by default.")] = None,
         cluster: Annotated[str | None, typer.Option(help="The address of a Dask cluster that films instead, on the same disk.")] = None,
         preset: Quality = Preset.full, library: Library = None,
         character: Annotated[list[Path] | None, typer.Option("--character", help="Who is in it: a human in a .glb, .gltf or .vrm file; named several times, a film of each.")] = None) -> None:
    """Film scenarios with calibrated cameras: pictures, and masks, depth, joints, contacts and motion as they truly are."""
    from gambol.assets import path as asset
    from gambol.controllers.tracking.cameras import read_cameras

    from ..hosts import GraphicsError
    from ..scenario import scenario as tables
    from ..studio import read_sensor

    rate = rate_of(fps)
    cameras = asset("cameras", "four.toml") if cameras is None else cameras
    lenses = read_cameras(cameras)
    read_sensor(cameras)  # told of before anything is drawn
    people: list[Path | None] = list(character or [None])
    names = [name if name in tables.shipped() else str(tables.locate(name).absolute()) for name in scenarios]
    jobs = jobs_of(names, out, seeds, people, cameras=str(Path(cameras).absolute()), width=width, fps=rate, preset=preset.value,
                   library=None if library is None else str(library.absolute()))
    for name in dict.fromkeys(names):
        say_doubts(name, tables.load(name))
    for job in jobs:
        run = tables.load(job.scenario)
        learn(run.wanted, run.database)
    for person in people:
        person_of(library, person)  # compiled once, and told of
    total, made, begun = sum(map(count_of, jobs)), 0, time.perf_counter()
    many = workers or min(cores(), len(jobs))
    refused: dict[str, None] = {}

    def told(job: Job, line: str) -> None:
        refused[line if len(jobs) == 1 else f"{Path(job.folder).name}: {line}"] = None
    try:
        with progress_bar() as bar:
            if cluster is None and many == 1:
                for job in jobs:
                    for drawn in bar.track(frames(job, partial(told, job)), count_of(job), description=Path(job.folder).name):
                        made += drawn
            else:
                task = bar.add_task(f"{len(jobs)} films", total=total)
                for job, drawn, lines in on_cluster(jobs, cluster) if cluster is not None else at_once(jobs, many):
                    made += drawn
                    for line in lines:
                        told(job, line)
                    bar.advance(task, count_of(job))
    except GraphicsError as error:
        raise Mistake(str(error)) from None
    spent, kept = time.perf_counter() - begun, total * len(lenses) - made
    say(f"{out}: {'' if len(jobs) == 1 else f'{len(jobs)} films, '}{len(lenses)} cameras, {total} frames"
        + (f", {made / len(lenses) / spent:.2f} a second" if made else "") + (f"; {kept} pictures were there already" if kept else ""))
    say_refused(refused)


@app.command()
@plainly
def footage(films: Annotated[list[Path], typer.Argument(help="A film of each camera, in their order or named after them.")],
            cameras: Annotated[Path, typer.Option(help="Their calibration: a .toml file, or Qualisys's.")],
            out: Annotated[Path, typer.Option("-o", "--out", help="The folder for the pictures.")],
            width: Annotated[int | None, typer.Option(min=16, max=8192, help="Pictures so wide; as calibrated by default.")] = None,
            name: Annotated[str, typer.Option(help="Whom they show.")] = "somebody") -> None:
    """Make footage of real films, for `gambol track`."""
    from gambol.controllers.tracking.cameras import read_cameras

    from ..studio import imported

    lenses = read_cameras(cameras)
    with progress_bar() as bar:
        count = sum(1 for _ in bar.track(imported(films, lenses, out, width, name), description=out.name))
    say(f"{out}: {len(lenses)} cameras, {count} frames of {name}")


@app.command()
@plainly
def track(footage: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that `gambol film` or `gambol footage` made.")],
          out: Annotated[Path, typer.Option("-o", "--out", help="The motion: a .bvh or .glb file.")],
          person: Annotated[str | None, typer.Option(help="Whom to follow; the first by default.")] = None,
          start: Annotated[Path | None, typer.Option(help="A motion file whose first two frames are the poses to begin with, or a .toml file of where joints are seen in the first; the truth's by default.")] = None,
          fit: Annotated[int, typer.Option(min=0, max=60, help="Find stature and girth in so many frames first, where --start says where joints are seen.")] = 6,
          masks: Annotated[bool, typer.Option("--masks", help="Follow the true masks instead of the pictures.")] = False,
          lag: Annotated[int, typer.Option(min=0, max=60, help="Look so many frames ahead before a pose is settled: calmer, and nearer to the truth.")] = 0,
          overlay: Annotated[Path | None, typer.Option(help="A .mp4 film, or a folder, of the contours found, blue, and the model's, red.")] = None,
          up: Up = None, unit: Unit = None) -> None:
    """Follow somebody through what calibrated cameras filmed, without markers: the motion as a file."""
    from contextlib import nullcontext

    import numpy as np

    from gambol.controllers.body import STATURE, human
    from gambol.controllers.tracking import Tracker, TrackerSettings, fitted_shape
    from gambol.controllers.tracking.twists import local_turns

    from ..files import plain
    from ..meshes import surface_of
    from ..output import Take, checked, recorder, write
    from ..footage import checked as complete
    from ..footage import clicked_pose, exchanged_clicks, first_poses, lost_frames, person_in, read_footage, seen_in, settled
    from ..studio import error_of, followed, late, overlaid

    of_a_motion_file("--start", start, up, unit)
    spared(out, start, "--start")
    film = read_footage(footage)
    if film.frames < 2:
        raise Mistake(f"{footage}: holds one frame; a track begins with two")
    film = complete(film, masks)
    if masks and overlay is not None:
        film = complete(film)
    for line in lost_frames(film):
        say(f"gambol: {line}; what others saw, and how somebody moved before, tells of them")
    who, clicks = person_in(film, person), start is not None and start.suffix.lower() == ".toml"
    checked(out, [film.people[who]])
    if clicks and start is not None:
        surface, pose = clicked_pose(film, start)
        for line in exchanged_clicks(film, start):
            say(f"gambol: {line}")
        if fit:
            say("finding how tall and how wide somebody is: a minute")
            shape = fitted_shape(Tracker(surface, film.lenses, float(film.fps)), pose, pose,
                                 [seen_in(film, number, who, masks) for number in range(min(fit, film.frames))])
            surface = shape.surface
            say(f"{surface.chain.skeleton.offsets[0, 1] / human().offsets[0, 1] * STATURE:.2f} m tall, {shape.girth:.2f} times as wide as the "
                f"mannequin; silhouettes overlap by {100 * shape.before:.0f} and then {100 * shape.overlap:.0f} %")
        poses = [settled(film, Tracker(surface, film.lenses, float(film.fps)), pose, who, masks)]
    else:
        surface = surface_of(freedom="full")
        poses = list(first_poses(film, surface, who, start, reading_of(up, unit, start)))
    tracker, known = Tracker(surface, film.lenses, float(film.fps), TrackerSettings(lag=lag)), len(poses)
    drawn = None if overlay is None else overlaid(film, surface, known - 1, poses[-1])
    with (nullcontext() if drawn is None or overlay is None else recorder(overlay, (drawn.shape[1], drawn.shape[0]), film.fps)) as tape, progress_bar() as bar:
        tracks = bar.track(followed(film, tracker, tuple(poses), who, masks), film.frames - known, description=film.people[who])
        for number, pose in enumerate(late(tracker, tracks), known):
            poses.append(pose)
            if tape is not None:
                tape.write(overlaid(film, surface, number, pose))
    turned = [local_turns(surface.chain, pose) for pose in poses]
    files = write(out, [Take(film.people[who], surface.chain.skeleton, tuple(turned), np.zeros((len(poses), 4), bool))], plain(film.fps))
    off = error_of(film, surface, poses, who)
    say(f"{files[0]}: {len(poses)} frames of {film.people[who]}" + (
        "" if off is None else f"; joints {100 * off.mean():.1f} cm from the truth, {100 * off.max():.0f} at worst"))
