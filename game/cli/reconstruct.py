"""`gambol reconstruct`: a whole body from a few points, of a recorded clip or of a live stream."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from .base import Mistake, app, learn, plainly, progress_bar, say
from .play import watch

FPS = 60
_TELL = 3.0  # s between words about what is waited for


@app.command()
@plainly
def reconstruct(clip: Annotated[Path | None, typer.Argument(help="A BVH or AMC file whose points are taken.")] = None,
                points: Annotated[str | None, typer.Option(help="Points on the body, with commas: lwrist,rwrist,lankle,rankle, or a set of the paper, 2 … 6. 4 by default.")] = None,
                out: Annotated[Path | None, typer.Option("-o", "--out", help="A .bvh file of the motion, or a .glb file of the body in motion; a window shows it by default.")] = None,
                method: Annotated[str, typer.Option(help="ours, or one that it is measured against: lpcr, lpca, mousas, nearest, network, ridge, gplvm.")] = "ours",
                database: Annotated[Path | None, typer.Option(help="A motion database to learn from; Gambol's own motion by default.")] = None,
                noise: Annotated[float, typer.Option(min=0.0, max=100.0, help="Blur the clip's points by so many centimetres.")] = 0.0,
                seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0,
                stream: Annotated[str | None, typer.Option(help="Listen to live trackers instead of reading a clip: osc (VMC protocol, VRChat's trackers).")] = None,
                port: Annotated[int | None, typer.Option(min=1, max=65535, help="Where to listen; 39539 by default.")] = None,
                host: Annotated[str | None, typer.Option(help="Whom to listen to: 127.0.0.1, programs on this machine, by default; 0.0.0.0, trackers on other machines, too.")] = None,
                trackers: Annotated[Path | None, typer.Option("--map", help="A TOML file that says which tracker is on which point.")] = None,
                height: Annotated[float | None, typer.Option(min=0.5, max=2.5, help="Of who wears the trackers, in metres; told from how they stand by default.")] = None,
                seconds: Annotated[float | None, typer.Option(min=0.1, help="Record so long; until Ctrl-C by default.")] = None) -> None:
    """Make a whole body's motion from the way of two to six points on it."""
    if (clip is None) == (stream is None):
        raise Mistake("reconstruct needs either a motion file or --stream osc")
    if stream not in (None, "osc"):
        raise Mistake(f"--stream {stream!r}: only osc is understood")
    live = (("--port", port), ("--host", host), ("--map", trackers), ("--seconds", seconds), ("--height", height))
    recorded = (("--noise", noise or None), ("--seed", seed or None))
    for option, given in live if stream is None else recorded:
        if given is not None:
            raise Mistake(f"{option} goes with " + ("--stream" if stream is None else "a motion file"))
    if points is not None and trackers is not None:
        raise Mistake("--points and --map both say which points there are: give one of them")
    if out is None:
        for option, given in (*recorded, ("--seconds", seconds)):
            if given is not None:
                raise Mistake(f"{option} goes with -o")
    else:
        from ..output import checked

        checked(out)
    method = _known(method)
    if database is not None:  # what is wrong with it is best said before anything is learnt
        from gambol.controllers.reconstruction.database import Database

        Database.open(database)
    if clip is not None:
        names = _named("4" if points is None else points)
        if out is None:
            watch(method, names, database, clip=clip)
        else:
            _clip(clip, names, out, method, database, noise / 100.0, seed)
        return
    from gambol.controllers.reconstruction.live import HOST, PORT, Stream, read_map, usual_map

    worn = read_map(trackers) if trackers is not None else usual_map(() if points is None else _named(points).split(","))
    names = ",".join(worn.values())
    with Stream(worn, port or PORT, HOST if host is None else host, clock=time.monotonic) as source:
        if out is None:
            source.placement = _placement(source, height)
            watch(method, names, database, stream=source)
        else:
            _record(source, _controller(method, database, names), out, height, seconds)


def _known(method: str) -> str:
    from ..world import METHODS

    if method not in METHODS:
        raise Mistake(f"--method {method!r}: there is no such method; choose from {', '.join(METHODS)}")
    return method


def _named(text: str) -> str:
    """Points by name, a set of the paper spelt out. Mistake for a point that there is not."""
    from gambol.controllers.reconstruction import SKELETON, parse

    try:
        return ",".join(parse(text, SKELETON).names)
    except ValueError as error:
        raise Mistake(f"--points {text!r}: {error}") from None


def _controller(method: str, file: Path | None, points: str) -> Any:
    """The controller that follows some points, learnt from a database where it has not been yet."""
    from gambol.controllers.reconstruction import Reconstruction

    from ..world import methods

    learn([(method, points)], file)
    known = methods(file)
    learnt, controls = known(method, points)
    return Reconstruction(learnt, controls, dt=1 / known.database().fps, starts=known.starts(points))


def _clip(path: Path, points: str, out: Path, method: str, file: Path | None, noise: float, seed: int) -> None:
    """Reconstruct a recorded clip from its points, and tell how good that is."""
    import numpy as np

    from gambol.controllers.contract import Intent
    from gambol.controllers.reconstruction.live import Recorded

    clip = _performance(path)
    controller = _controller(method, file, points)
    source = Recorded.of(clip, controller.controls)
    if noise:
        source = source.noisy(noise, np.random.default_rng(seed))
    state = controller.begin(source.points[0], (source.points[1] - source.points[0]) / source.frame_time)
    poses, contacts, spent = [state.pose], [state.contacts], 0.0
    with progress_bar() as bar:
        for number in bar.track(range(1, len(clip)), description=path.name):
            intent = Intent(points=source.at(number * clip.frame_time))
            began = time.perf_counter()
            state, pose = controller.step(state, intent, clip.frame_time)
            spent += time.perf_counter() - began
            poses.append(pose)
            contacts.append(state.contacts)
    _write(out, path.stem, controller.skeleton, poses, contacts)
    for line in _figures(clip, poses):
        typer.echo(line)
    typer.echo(f"{'a frame':24} {1000 * spent / (len(clip) - 1):7.2f} ms")


def _performance(path: Path) -> Any:
    """A motion file at 60 frames a second on the standard human. MotionFileError, naming it, if it can't be used."""
    from gambol.controllers.mocap import MotionFileError, load, retarget

    clip = load(path)
    if len(clip) < 4:
        raise MotionFileError(f"{path}: {len(clip)} frames are too few; a performance needs 4")
    try:
        return retarget(clip).resample(FPS)
    except ValueError as error:
        raise MotionFileError(f"{path}: {error}") from None


def _figures(clip: Any, poses: list) -> list[str]:
    """How far the poses are from a clip's, in some lines."""
    import numpy as np

    from gambol.controllers.body import forward_kinematics
    from gambol.controllers.reconstruction.evaluation import angle_error, jitter, position_error

    rotations = np.stack([pose.rotations for pose in poses])
    found = forward_kinematics(clip.skeleton, np.stack([pose.root for pose in poses]), rotations)[0]
    truth = clip.kinematics()[0]
    away, turned = 100 * position_error(found, truth), np.degrees(angle_error(rotations, clip.rotations))
    restless = jitter(truth, clip.frame_time)
    lines = [f"{'joints in the world':24} {away.mean():7.2f} cm, {away.max():.1f} at most",
             f"{'joint angles':24} {turned.mean():7.2f}°, {turned.max():.1f} at most"]
    return lines + ([f"{'jitter over the clip’s':24} {jitter(found, clip.frame_time) / restless:7.2f}"] if restless > 0.0 else [])


def _record(source: Any, controller: Any, out: Path, height: float | None, seconds: float | None) -> None:
    """Record what a stream says until the time is up or somebody stops it; what there is by then is written."""
    import numpy as np

    from gambol.controllers.contract import Intent
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.reconstruction import towards
    from gambol.controllers.supervisor import Supervisor

    someone = Supervisor({"locomotion": Locomotion.load(), "reconstruction": controller})
    someone.step(someone.start(), Intent(), 1 / FPS)  # whatever compiles does so before anybody stands and waits
    poses, contacts, lost = [], [], 0
    with _stoppable():
        try:
            source.placement = _placement(source, height)
            say("recording; Ctrl-C ends it")
            state = None
            for now in _ticks(seconds):
                seen = source.at(now)
                if state is None:
                    if np.isnan(seen).all():  # silent since they stood still: there is nothing to begin with yet
                        continue
                    state = someone.enter(controller.begin(seen), Intent())
                intent = Intent(towards(state, seen), points=seen)
                state, pose = someone.step(state, intent, 1 / FPS)
                lost += someone.active(state)[0] != "reconstruction"
                poses.append(pose)
                contacts.append(state.contacts)
        except KeyboardInterrupt:
            pass
        finally:
            if poses:
                _write(out, out.stem, someone.skeleton, poses, contacts)
    if not poses:
        raise Mistake(f"{out}: nothing was recorded")
    if lost:
        say(f"for {lost / FPS:.1f} s there was nothing to follow")
    if source.broken:
        say(f"{source.broken} packets were broken and left out")


def _placement(source: Any, height: float | None) -> Any:
    """Wait until somebody who wears the trackers stands still, and tell from it where floor and body are."""
    import numpy as np

    from gambol.controllers.reconstruction.live import Standing, placed

    names = source.controls.names
    say(f"listening at {source.host}, port {source.port}: stand upright for a second, in T-pose or with the arms down")
    standing, told = Standing(), -_TELL / 2
    for now in _ticks(None):
        seen = source.at(now)
        standing = standing.watch(now, seen)
        if standing.place is not None:
            try:
                return placed(standing.place, source.controls, height)
            except ValueError as error:
                say(str(error))
                standing, told = Standing(), now
        if now - told > _TELL:
            missing = [name for name, there in zip(names, np.isfinite(seen).all(-1)) if not there]
            say(f"waiting for {', '.join(missing)}" if missing else "waiting for somebody who stands still")
            if not source.heard and source.local:
                say("nobody was heard on this machine; trackers on another one need --host 0.0.0.0")
            if source.unknown:
                say(f"on no point: {', '.join(source.unknown)}; --map says where they are")
            told = now


def _ticks(seconds: float | None) -> Iterator[float]:
    """Times [s] of a steady clock, FPS a second, each when it has come."""
    began, number = time.monotonic(), 0
    while seconds is None or number < round(seconds * FPS):
        due = began + number / FPS
        time.sleep(max(0.0, due - time.monotonic()))
        yield due
        number += 1


@contextmanager
def _stoppable() -> Iterator[None]:
    """Whoever ends the program from outside ends it like Ctrl-C does."""
    def stop(*_: Any) -> None:
        raise KeyboardInterrupt
    kinds = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = [signal.signal(kind, stop) for kind in kinds]
    try:
        yield
    finally:
        for kind, handler in zip(kinds, before):
            signal.signal(kind, handler)


def _write(out: Path, name: str, skeleton: Any, poses: list, contacts: list) -> None:
    import numpy as np

    from ..output import Take, write

    for path in write(out, [Take(name, skeleton, tuple(poses), np.stack(contacts))], FPS):
        say(f"{path}: {len(poses)} frames, {len(poses) / FPS:.1f} s")
