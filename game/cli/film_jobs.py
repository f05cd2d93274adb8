"""Many films at once: scenarios, seeds and bodies as jobs, each a folder of its own, done here, on all cores, or by a Dask cluster.

A job is plain names and numbers, and what it makes depends on nothing else: the same files wherever it is done.
"""

from __future__ import annotations

import itertools
import signal
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Any

from .base import Mistake


@dataclass(frozen=True)
class Job:
    """A film to make. scenario: a name or a file. folder: for its pictures. seed: of what goes wrong; the file's where None."""

    scenario: str
    folder: str
    cameras: str
    width: int | None
    fps: Fraction | None
    preset: str
    library: str | None
    character: str | None
    seed: int | None


def jobs_of(scenarios: Sequence[str], out: Path, seeds: int, characters: Sequence[Path | None], **same: Any) -> list[Job]:
    """A job for each scenario, seed and body; a single one has the folder itself. Mistake for two of one name."""
    made = []
    for scenario, seed, body in itertools.product(scenarios, range(seeds) if seeds else [None], characters):
        parts = [Path(scenario).stem, *([] if seed is None else [f"seed{seed}"]), *([body.stem] if body and len(characters) > 1 else [])]
        made.append(Job(scenario, str(out.absolute().joinpath("_".join(parts))), seed=seed, character=None if body is None else str(body.absolute()), **same))
    if len(made) == 1:
        return [Job(**{**vars(made[0]), "folder": str(out.absolute())})]
    twice = [one.folder for one in made if sum(other.folder == one.folder for other in made) > 1]
    if twice:
        raise Mistake(f"{Path(twice[0]).name}: two films would be called so; rename a file")
    return made


def frames(job: Job, tell: Callable[[str], None]) -> Iterator[int]:
    """Make a job's film: how many pictures were drawn for each frame, as it is done. tell: see `shoot`."""
    from gambol.controllers.tracking.cameras import read_cameras

    from ..hosts import Offscreen
    from ..scenario import load
    from ..studio import Plan, read_sensor, shoot

    lenses, sensor = read_cameras(job.cameras), read_sensor(job.cameras)
    lenses = lenses if job.width is None else tuple(lens.scaled(job.width) for lens in lenses)
    sensor = sensor if job.seed is None else sensor.model_copy(update={"seed": job.seed})
    run = load(job.scenario)
    run = run if job.fps is None else run.at_fps(job.fps)
    controller = somebody(job.library, job.character)
    with Offscreen((16, 16), job.preset) as stage:
        yield from shoot(Plan(run, lenses, sensor, job.preset, f"{controller.kind} {'' if job.character is None else Path(job.character).name}"),
                         job.folder, controller, stage, tell)


@lru_cache(4)
def somebody(library: str | None, character: str | None) -> Any:
    """Who moves, with a gait library, in a character's body: loaded once for many films."""
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.person import person

    from .base import body_of, in_body

    return in_body(person(Locomotion.load(library)), body_of(None if character is None else Path(character)))


def count_of(job: Job) -> int:
    """How many frames a job's film has."""
    from ..scenario import load

    run = load(job.scenario)
    return (run if job.fps is None else run.at_fps(job.fps)).frames


def done(job: Job) -> tuple[Job, int, list[str]]:
    """A job done: it, how many pictures were drawn, and what nobody could do."""
    refused: list[str] = []
    return job, sum(frames(job, refused.append)), refused


def at_once(jobs: Sequence[Job], workers: int) -> Iterator[tuple[Job, int, list[str]]]:
    """Jobs done by so many programs, in the order in which they end. Whatever goes wrong ends all of them."""
    from concurrent.futures import ProcessPoolExecutor, as_completed  # slow to load, and no game films so
    from multiprocessing import get_context

    # Ctrl-C ends a worker without a word: whoever sent it hears of it from here
    with ProcessPoolExecutor(min(workers, len(jobs)), get_context("spawn"), signal.signal, (signal.SIGINT, signal.SIG_DFL)) as crew:
        waiting = [crew.submit(done, job) for job in jobs]
        try:
            for one in as_completed(waiting):
                yield one.result()
        except BaseException:
            crew.shutdown(cancel_futures=True)
            raise


def on_cluster(jobs: Sequence[Job], address: str) -> Iterator[tuple[Job, int, list[str]]]:
    """Jobs done by a Dask cluster whose workers see the same disk. Mistake where there is none."""
    try:
        from distributed import Client
        from distributed import as_completed as ended
    except ImportError:
        raise Mistake('--cluster needs Dask: .venv/bin/pip install -e ".[cluster]"') from None
    try:
        client = Client(address, timeout="10s")
    except (OSError, ValueError, TimeoutError) as fault:
        raise Mistake(f"--cluster {address}: no Dask cluster answers there: {str(fault).splitlines()[0] if str(fault) else type(fault).__name__}") from None
    with client:
        for one in ended(client.map(done, jobs, pure=False)):
            yield one.result()
