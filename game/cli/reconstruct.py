"""`gambol reconstruct`: a whole body from a few points, of a recorded clip or of a live stream."""

from __future__ import annotations

import math
import time
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from . import live
from .base import Mistake, Unit, Up, app, learn, of_a_motion_file, plainly, progress_bar, reading_of, say, spared
from .live import SUFFIX, write_take
from .play import watch


@app.command()
@plainly
def reconstruct(clip: Annotated[Path | None, typer.Argument(help="A BVH or AMC file whose points are taken, or the packets of trackers that --keep kept.")] = None,
                points: Annotated[str | None, typer.Option(help="Points on the body, with commas: lwrist,rwrist,lankle,rankle, or a set of the paper, 2 … 6. By default 4, wrists and ankles; of a stream the head, the waist and both feet.")] = None,
                out: Annotated[Path | None, typer.Option("-o", "--out", help="A .bvh file of the motion, or a .glb file of the body in motion; a window shows it by default.")] = None,
                method: Annotated[str | None, typer.Option(help="trackers, the network that ships, by default; ours, learnt from --database, or turning, the same for trackers that tell how they are turned; or one that these are measured against: lpcr, lpca, mousas, nearest, network, ridge, gplvm.")] = None,
                database: Annotated[Path | None, typer.Option("--database", "--network", help="A motion database to learn from, Gambol's own motion by default; or the network, .npz, that gambol database tune taught.")] = None,
                noise: Annotated[float, typer.Option(min=0.0, max=100.0, help="Blur the clip's points by so many centimetres.")] = 0.0,
                seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0,
                turns: Annotated[bool, typer.Option("--turns", help="Tell how the clip's points are turned, too, as trackers of 6 degrees of freedom do.")] = False,
                stream: Annotated[str | None, typer.Option(help="Listen to live trackers instead of reading a clip: osc (VMC protocol, VRChat's trackers).")] = None,
                port: Annotated[int | None, typer.Option(min=1, max=65535, help="Where to listen; 39539 by default.")] = None,
                host: Annotated[str | None, typer.Option(help="Whom to listen to: 127.0.0.1, programs on this machine, by default; 0.0.0.0, trackers on other machines, too.")] = None,
                trackers: Annotated[Path | None, typer.Option("--map", help="A TOML file that says which tracker is on which point.")] = None,
                height: Annotated[float | None, typer.Option(min=0.5, max=2.5, help="Of who wears the trackers, in metres; told from how they stand by default.")] = None,
                calibration: Annotated[Path | None, typer.Option(help="Trackers are worn anyhow, beside their joints: a TOML file of how, read if it is there, else written once one has stood still, and moved.")] = None,
                poses: Annotated[bool, typer.Option("--poses", help="With --calibration: be asked to stand in eight poses, which tells most of how trackers are worn.")] = False,
                seconds: Annotated[float | None, typer.Option(min=0.1, help="Record so long from when somebody has stood still, and wait as long for that, half a minute at least; until Ctrl-C by default.")] = None,
                keep: Annotated[Path | None, typer.Option(help="Keep all packets in this file as they come, so that nothing is lost and they can be tried again.")] = None,
                send: Annotated[list[str] | None, typer.Option(help="Send the body on by the VMC protocol to a program that shows it: HOST:PORT, such as 127.0.0.1:39539; named several times, to each.")] = None,
                window: Annotated[bool, typer.Option("--window", help="Show the body in a window, too, while it is sent on.")] = False,
                up: Up = None, unit: Unit = None) -> None:
    """Make a whole body's motion from the way of two to six points on it."""
    if (clip is None) == (stream is None):
        raise Mistake("reconstruct needs either a motion file or --stream osc")
    if stream not in (None, "osc"):
        raise Mistake(f"--stream {stream!r}: only osc is understood")
    heard_again = clip is not None and clip.suffix.lower() == SUFFIX
    listening = (("--port", port), ("--host", host), ("--keep", keep))
    worn = (("--map", trackers), ("--seconds", seconds), ("--height", height), ("--calibration", calibration), ("--send", send or None))
    recorded = (("--noise", noise or None), ("--seed", seed or None), ("--turns", turns or None))
    for option, given in recorded if stream is not None else listening + (recorded if heard_again else worn):
        if given is not None:
            raise Mistake(f"{option} goes with " + ("a motion file" if (option, given) in recorded else "--stream"))
    of_a_motion_file("CLIP", clip, up, unit)
    if height is not None and calibration is not None:
        raise Mistake("--height and --calibration both say how tall one is: give one of them")
    if poses and (calibration is None or calibration.exists()):
        raise Mistake("--poses goes with --calibration FILE" + (f": {calibration} is there already, and says how trackers are worn" if calibration else ""))
    if points is not None and trackers is not None:
        raise Mistake("--points and --map both say which points there are: give one of them")
    if window and (not send or out is not None or heard_again):
        raise Mistake("--window goes with --stream and --send: without --send a window opens by itself, and none with -o")
    if out is None:
        for option, given in (*recorded, *(() if send and not window else (("--seconds", seconds),))):
            if given is not None:
                raise Mistake(f"{option} goes with -o")
        if heard_again and not send:
            raise Mistake(f"{clip}: packets are heard again into a motion, -o FILE, or for another program, --send HOST:PORT")
    else:
        from ..output import checked

        spared(out, clip)
        checked(out)
        if stream is not None and out.exists():
            raise Mistake(f"{out}: is there already, and nobody does again what a stream was recorded of; name another file")
    if method is not None:
        _known(method)
        _told_turns(method, clip is None or heard_again or turns)
    if database is not None:  # what is wrong with it is best said before anything is learnt
        _sound(database, method)
    if clip is not None and not heard_again:
        names = _named("4" if points is None else points)
        method = method or _usual(names, database, turns)
        if out is None:
            watch(method, names, database, clip=clip, up=up, unit=unit)
        else:
            _clip(clip, names, out, method, database, noise / 100.0, seed, turns, reading_of(up, unit, clip))
        return
    from gambol.controllers.reconstruction.live import read_map, usual_map

    worn_on = read_map(trackers) if trackers is not None else usual_map(() if points is None else _named(points).split(","))
    names = ",".join(worn_on.values())
    method = method or _usual(names, database, True)
    shown = out is None and (not send or window)
    with live.heard(worn_on, clip, port, host, keep, own_time=not shown) as source:
        if shown:
            watch(method, names, database, stream=source, send=send or (), ask=partial(live.stand, source, height, calibration, poses))
            for line in live.another(source):
                say(line)
        else:
            with live.sent(send or ()) as sender:
                live.record(source, lambda skeleton: _controller(method, database, names, skeleton), out, height, seconds, sender, calibration, poses)


def _known(method: str) -> None:
    from ..world import METHODS

    if method not in METHODS:
        raise Mistake(f"--method {method!r}: there is no such method; choose from {', '.join(METHODS)}")


def _told_turns(method: str, told: bool) -> None:
    from ..world import TURNING

    if method == TURNING and not told:
        raise Mistake(f"--method {TURNING} goes with --turns or --stream: it hears how trackers are turned")


def _sound(file: Path, method: str | None) -> None:
    """DatabaseError or ArraysError for a file that is neither a database nor a network; Mistake for a network with a method that has none."""
    from gambol.controllers.reconstruction.database import Database
    from gambol.controllers.reconstruction.trackers import Network

    from ..world import SHIPPED, taught

    if not taught(file):
        Database.open(file)
        return
    Network.load(file)
    if method not in (None, SHIPPED):
        raise Mistake(f"--network {file}: goes with --method {SHIPPED}; {method} learns from a database")


def _usual(points: str, database: Path | None, turns: bool) -> str:
    from ..world import usual

    return usual(points, database, turns)


def _named(text: str) -> str:
    """Points by name, a set of the paper spelt out. Mistake for a point that there is not."""
    from gambol.controllers.reconstruction import SKELETON, parse

    try:
        return ",".join(parse(text, SKELETON).names)
    except ValueError as error:
        raise Mistake(f"--points {text!r}: {error}") from None


def _controller(method: str, file: Path | None, points: str, skeleton: Any = None) -> Any:
    """The controller that follows some points, learnt from a database where it has not been yet. skeleton: the performer's, for methods that know
    bodies of other proportions. Wherever a performer went unseen, he is found again."""
    from dataclasses import replace

    from gambol.controllers.reconstruction import Reconstruction

    from ..world import SHIPPED, methods

    learn([(method, points)], file)
    known = methods(file)
    learnt, controls = known(method, points)
    if skeleton is not None and method == SHIPPED:
        own = replace(learnt, skeleton=skeleton)
        return Reconstruction(own, controls, dt=known.frame_time(method), starts=own, skeleton=skeleton, far=math.inf)
    return Reconstruction(learnt, controls, dt=known.frame_time(method), starts=known.starts(method, points), far=math.inf)


def _clip(path: Path, points: str, out: Path, method: str, file: Path | None, noise: float, seed: int, turning: bool, reading: Any) -> None:
    """Reconstruct a recorded clip from its points, and from how they are turned, and tell how good that is."""
    import numpy as np

    from gambol.controllers.contract import Intent
    from gambol.controllers.reconstruction.live import Recorded

    from ..world import SHIPPED, TURNING, performance

    if turning and method not in (SHIPPED, TURNING):
        raise Mistake(f"--turns goes with a method that hears them, --method trackers or turning; {method} has points alone")
    clip = performance(path, reading)
    controller = _controller(method, file, points)
    source = Recorded.of(clip, controller.controls, turning)
    if noise:
        source = source.noisy(noise, np.random.default_rng(seed))
    state = controller.begin(source.points[0], (source.points[1] - source.points[0]) / source.frame_time, turns=source.turned_at(0.0))
    poses, contacts, spent = [state.pose], [state.contacts], 0.0
    with progress_bar() as bar:
        for number in bar.track(range(1, len(clip)), description=path.name):
            now = number * clip.frame_time
            intent = Intent(points=source.at(now), turns=source.turned_at(now))
            began = time.perf_counter()
            state, pose = controller.step(state, intent, clip.frame_time)
            spent += time.perf_counter() - began
            poses.append(pose)
            contacts.append(state.contacts)
    write_take(out, path.stem, controller.skeleton, poses, contacts)
    for line in _figures(clip, poses, controller.controls):
        typer.echo(line)
    typer.echo(f"{'a frame':24} {1000 * spent / (len(clip) - 1):7.2f} ms")


def _figures(clip: Any, poses: list, controls: Any) -> list[str]:
    """How far the poses are from a clip's, and its points on them from those that they were told, in some lines."""
    import numpy as np

    from gambol.controllers.body import forward_kinematics
    from gambol.controllers.reconstruction.evaluation import angle_error, jitter, position_error

    rotations = np.stack([pose.rotations for pose in poses])
    found, turns = forward_kinematics(clip.skeleton, np.stack([pose.root for pose in poses]), rotations)
    apart = 100 * np.linalg.norm(controls.on(found, turns) - controls.extract(clip), axis=-1)
    truth = clip.kinematics()[0]
    away, turned = 100 * position_error(found, truth), np.degrees(angle_error(rotations, clip.rotations))
    restless = jitter(truth, clip.frame_time)
    lines = [f"{'its points in the world':24} {apart.mean():7.2f} cm, {apart.max():.1f} at most",
             f"{'joints in the world':24} {away.mean():7.2f} cm, {away.max():.1f} at most",
             f"{'joint angles':24} {turned.mean():7.2f}°, {turned.max():.1f} at most"]
    shakes = jitter(found, clip.frame_time)
    shaken = 1000 * shakes * clip.frame_time ** 3 / math.sqrt(20.0)  # third differences of white noise are √20 times as large
    return lines + ([f"{'jitter over the clip’s':24} {shakes / restless:7.2f}, as noise of {shaken:.1f} mm makes it"] if restless > 0.0 else [])
