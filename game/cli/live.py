"""Points from trackers that people wear: heard over the network or again from a file, recorded, and sent on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .base import Mistake, say
from .live_clock import FPS, clock, stoppable, times
from .live_standing import amiss, another, is_live, missing, moved, stand

SUFFIX = ".packets"
_WAITED = 30.0  # s that are waited at least for somebody to stand still, where the time is limited


@contextmanager
def heard(worn: Mapping[str, str], packets: Path | None, port: int | None, host: str | None, keep: Path | None,
          own_time: bool) -> Iterator[Any]:
    """The trackers of a file of packets, or those that send now, all of whose packets are kept in another file. own_time: whether they are asked by
    the system's clock, as `record` does."""
    from gambol.controllers.reconstruction.live import HOST, PORT, PacketLog, Replayed, Stream

    if packets is not None:
        yield Replayed(worn, packets)
        return
    log = None if keep is None else PacketLog(keep)
    try:
        with Stream(worn, port or PORT, HOST if host is None else host, clock=clock(), log=log, own_time=own_time) as source:
            yield source
    finally:
        if log is not None:
            log.close()
            say(log.fault or f"{keep}: all packets; gambol reconstruct {keep} -o FILE hears them again")


@contextmanager
def sent(to: Sequence[str]) -> Iterator[Any]:
    """A sender to programs that show bodies; None where nobody asks for one."""
    if not to:
        yield None
        return
    from gambol.controllers.reconstruction.live import Senders

    sender = Senders(to)
    try:
        yield sender
    finally:
        sender.close()


def record(source: Any, controller: Callable[[Any], Any], out: Path | None, height: float | None, seconds: float | None, sender: Any = None,
           calibration: Path | None = None, posing: bool = False) -> None:
    """Record what trackers say until the time is up or somebody stops it; what there is by then is written.

    controller: makes one for a skeleton, or None for the standard one. out: None to keep nothing. sender: whom each frame is sent to. calibration, posing: see `stand`.
    """
    import numpy as np

    from gambol.controllers.body import Pose
    from gambol.controllers.contract import Intent
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.reconstruction import towards
    from gambol.controllers.supervisor import Supervisor

    from ..app import sure

    reconstruction, walker = controller(None), Locomotion.load()
    someone = Supervisor({"locomotion": walker, "reconstruction": reconstruction})
    someone.step(someone.start(), Intent(), 1 / FPS)  # whatever compiles does so before anybody stands and waits
    poses, contacts, lost, skipped, met = [], [], 0, [], np.zeros(len(source.controls.names), bool)
    stood = False
    with stoppable() as stop:
        try:
            stand(source, height, calibration, posing, wait=None if seconds is None else max(seconds, _WAITED))
            known, told, stood = None, [], True
            stop.gently = is_live(source)
            say("recording; Ctrl-C ends it" if out is not None else "sending; Ctrl-C ends it")
            state = None
            for now in times(source, seconds, sender is not None, skipped, stop):
                seen = source.at(now)
                met |= np.isfinite(seen).all(-1)
                if source.worn is not None and source.worn.known is not known:
                    if known is not None:
                        moved(source, calibration)
                    known = source.worn.known
                    reconstruction = controller(source.worn.skeleton)
                    someone = Supervisor({"locomotion": walker, "reconstruction": reconstruction})
                if not told and is_live(source) and (told := another(source)):
                    say(*told)
                if state is None:
                    if np.isnan(seen).all():  # silent since they stood still: there is nothing to begin with yet
                        continue
                    state = someone.enter(reconstruction.begin(seen, turns=source.turns), Intent())
                intent = Intent(towards(state, seen), points=seen, turns=source.turns)
                state, pose = someone.step(state, intent, 1 / FPS)
                lost += someone.active(state)[0] != "reconstruction"
                if sender is not None:
                    size = _size(source)
                    sender.send(reconstruction.skeleton.scaled(size), Pose(size * pose.root, pose.rotations), state.ground * [size, size, 1.0], now, sure(state))
                if out is not None:
                    poses.append(pose)
                    contacts.append(state.contacts)
        except KeyboardInterrupt:
            pass
        finally:
            if poses and out is not None:
                size = _size(source)
                write_take(out, out.stem, reconstruction.skeleton.scaled(size), [Pose(size * pose.root, pose.rotations) for pose in poses], contacts)
    if not stood:
        raise Mistake("it was ended before anybody had stood still, upright, in T-pose or with the arms down: nothing was recorded")
    unmet = [] if met.all() else [f"nothing was heard of {', '.join(missing(source, met))}"]
    for line in unmet + amiss(source) if unmet or source.rivals else ():
        say(line)
    for line in another(source):
        say(line)
    if not poses and out is not None:
        raise Mistake(f"{out}: nothing was recorded")
    if lost:
        say(f"for {lost / FPS:.1f} s there was nothing to follow")
    if skipped:
        say(f"this machine was too slow: {sum(skipped):.1f} s were left out")
    if source.broken:
        say(f"{source.broken} packets were broken and left out")
    if source.foreign:
        say(f"{source.foreign} packets of another machine than the first were left out")
    if sender is not None and sender.lost:
        say(f"{sender.lost} frames could not be sent")


def _size(source: Any) -> float:
    """How large whoever wears the trackers is over the body that follows: what is recorded and sent on is as large as he is, and goes as far."""
    return 1.0 / float(source.placement.scale if source.worn is None else source.worn.known.stood.scale[0])


def write_take(out: Path, name: str, skeleton: Any, poses: list, contacts: list) -> None:
    """Write a recorded take, and say so."""
    import numpy as np

    from ..output import Take, write

    for path in write(out, [Take(name, skeleton, tuple(poses), np.stack(contacts))], FPS):
        say(f"{path}: {len(poses)} frames at {FPS:g} a second, {len(poses) / FPS:.1f} s")
