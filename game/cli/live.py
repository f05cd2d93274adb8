"""Points from trackers that people wear: heard over the network or again from a file, recorded, and sent on."""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import set_poses
from .base import Mistake, say

FPS = 60
SUFFIX = ".packets"
_BEHIND, _SENDING_BEHIND = 10.0, 0.5  # s by which frames of a take, and frames that are sent on, may come late before some are left out
_TELL = 3.0  # s between words about what is waited for
_VAST = 3.0  # m from their middle no body's points are
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
        with Stream(worn, port or PORT, HOST if host is None else host, clock=_clock(), log=log, own_time=own_time) as source:
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


def _clock() -> Any:
    """What packets are timed by as they come."""
    return time.monotonic


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
    with _stoppable() as stop:
        try:
            stand(source, height, calibration, posing, wait=None if seconds is None else max(seconds, _WAITED))
            known, told, stood = None, [], True
            stop.gently = _live(source)
            say("recording; Ctrl-C ends it" if out is not None else "sending; Ctrl-C ends it")
            state = None
            for now in _times(source, seconds, sender is not None, skipped, stop):
                seen = source.at(now)
                met |= np.isfinite(seen).all(-1)
                if source.worn is not None and source.worn.known is not known:
                    if known is not None:
                        moved(source, calibration)
                    known = source.worn.known
                    reconstruction = controller(source.worn.skeleton)
                    someone = Supervisor({"locomotion": walker, "reconstruction": reconstruction})
                if not told and _live(source) and (told := another(source)):
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
    unmet = [] if met.all() else [f"nothing was heard of {', '.join(_missing(source, met))}"]
    for line in unmet + _amiss(source) if unmet or source.rivals else ():
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


def _twice(source: Any) -> str:
    return f"two programs send the same trackers, from {' and '.join(source.rivals)}: close one of them, or give its trackers other names"


@dataclass
class Stop:
    """gently: whether what was heard until somebody ends it is still worked through; at: when [s] that was."""

    gently: bool = False
    at: float = math.inf


def _times(source: Any, seconds: float | None, paced: bool, skipped: list[float], stop: Stop | None = None) -> Iterator[float]:
    """Times [s] to ask a source at, FPS a second: as they come, or those of a file, where they need not be waited for. paced: whether somebody sees
    each as it comes. skipped: where times [s] are put that were left out. stop: when somebody ends it."""
    length = getattr(source, "duration", None)
    if length is None:
        yield from _ticks(seconds, _SENDING_BEHIND if paced else _BEHIND, skipped, stop or Stop())
        return
    number, began, last = 0, time.monotonic(), length if seconds is None else min(length, source.told_until + seconds)
    while (now := source.told_until + 1 / FPS) <= last:
        if paced:
            time.sleep(max(0.0, began + number / FPS - time.monotonic()))
        number += 1
        yield now


def stand(source: Any, height: float | None, calibration: Path | None = None, posing: bool = False, tell: Callable[[Any], None] | None = None,
          say: Callable[[str], None] = say, wait: float | None = None) -> None:
    """Tell the source where floor and body are: as somebody does who stands still, and if a file is named how trackers are worn, too: as it says if
    it is there; else it is written then. posing: whether set poses are asked for. tell, say: who
    hears what is asked for (`app.Asked`), each time, and what is known, in words. wait: for how long [s] at most; Mistake if nobody has stood still by then."""
    from gambol.controllers.reconstruction.calibration import load, save

    if calibration is not None and calibration.exists():
        source.worn = load(calibration, source.controls)
        say(source.worn.said(source.controls.names))
        if tell is None and _live(source):
            _met(source, say, wait)
        return
    if calibration is not None and not calibration.parent.is_dir():
        raise Mistake(f"{calibration}: there is no folder {calibration.parent}")
    _stood(source, height, calibration is not None, posing, tell, say, wait)
    if source.worn is not None and calibration is not None:
        say(source.worn.said(source.controls.names))
        save(calibration, source.worn)
    elif calibration is not None:
        say(f"{calibration}: not written: trackers are calibrated that all tell how they are turned, on hips, head, hands and feet")


def moved(source: Any, calibration: Path | None) -> None:
    """Say what five seconds of moving told, and keep it."""
    from gambol.controllers.reconstruction.calibration import save

    say(source.worn.said(source.controls.names))
    if calibration is not None:
        save(calibration, source.worn)
        say(f"{calibration}: written; with it nobody need stand still the next time")


def _stood(source: Any, height: float | None, calibrating: bool, posing: bool, tell: Callable[[Any], None] | None, say: Callable[[str], None],
           wait: float | None) -> None:
    """Wait until somebody who wears the trackers stands still; where they sit is told, too, if it is asked for."""
    import numpy as np

    from gambol.controllers.reconstruction.calibration import CalibrationNetwork, Wearer, calibratable
    from gambol.controllers.reconstruction.live import Standing, placed

    live = _live(source)
    if live:
        say(f"listening at {source.host}, port {source.port}: stand upright for a second, in T-pose or with the arms down")
    standing, told, began = Standing(), -_TELL / 2, None
    times = _times(source, None, True, [])
    for now in times:
        began = now if began is None else began
        seen = source.at(now)
        if tell is not None:
            from ..app import Asked

            tell(Asked("stand upright for a second, in T-pose or with the arms down"))
        standing = standing.watch(now, seen, source.turns)
        if standing.place is not None:
            try:
                placement = placed(standing.place, source.controls, height, standing.turn)
                if calibrating and (turn := standing.turn) is not None and calibratable(source.controls, turn):
                    worn = set_poses.worn(source, placement, standing.place, turn, times, tell, say) if posing else None
                    source.worn = worn or Wearer.standing(source.controls, placement, standing.place, turn, CalibrationNetwork.load())
                source.placement = placement
                return
            except ValueError as error:
                say(str(error))
                standing, told = Standing(), now
        over = live and wait is not None and now - began > wait
        if over or now - told > _TELL:
            missing = _missing(source, np.isfinite(seen).all(-1))
            if over:
                why = f"nothing is heard of {', '.join(missing)}" if missing else _vast(seen)
                raise Mistake(f"nobody has stood still for {wait:g} s" + (f": {why}" if why else "")
                              + "".join(f"; {line}" for line in _amiss(source)))
            say(f"waiting for {', '.join(missing)}" if missing else _vast(seen) or "waiting for somebody who stands still")
            for line in _amiss(source):
                say(line)
            told = now
    raise Mistake("nobody stands still in these packets, upright, in T-pose or with the arms down")


def _met(source: Any, say: Callable[[str], None], wait: float | None) -> None:
    """Wait until any tracker is heard, where it is known how they are worn. wait: as in `stand`."""
    import numpy as np

    say(f"listening at {source.host}, port {source.port}")
    told = began = None
    for now in _times(source, None, True, []):
        began, told = (now, now - _TELL / 2) if began is None or told is None else (began, told)
        there = np.isfinite(source.at(now)).all(-1)
        if there.any():
            return
        if wait is not None and now - began > wait:
            raise Mistake("; ".join([f"nothing is heard of {', '.join(_missing(source, there))} for {wait:g} s", *_amiss(source)]))
        if now - told > _TELL:
            for line in (f"waiting for {', '.join(_missing(source, there))}", *_amiss(source)):
                say(line)
            told = now


def _live(source: Any) -> bool:
    """Whether a source is heard as it comes, and is no file of packets."""
    return not hasattr(source, "duration")


def _vast(points: Any) -> str:
    """That points (n, 3) are farther from each other than a body's, as they are in another unit than the protocol's; "" where they are not."""
    import numpy as np

    apart = float(np.linalg.norm(points - np.mean(points, 0), axis=-1).max())
    return f"trackers are {apart:.0f} m from their middle, as no body's are: they must be sent in metres" if apart > _VAST else ""


def _missing(source: Any, there: Any) -> list[str]:
    """The names of the points that are not there. there: (n,) bool."""
    return [name.partition("+")[0] for name, is_there in zip(source.controls.names, there) if not is_there]


def _amiss(source: Any) -> list[str]:
    """What is wrong with what is heard, or why nothing is: a line for each."""
    from gambol.controllers.reconstruction import NAMES

    lines = [_twice(source)] if source.rivals else []
    if source.about and not source.heard:
        lines.append(f"what comes is about {source.about}, and of no tracker: let the program send /VMC/Ext/Tra/Pos and Hmd/Pos, or /tracking/trackers")
    elif _live(source) and not source.heard and source.local:
        lines.append("nobody was heard on this machine; trackers on another one need --host 0.0.0.0")
    left = [name for name in source.unknown if name in NAMES]
    if left:
        every = ",".join([*(name.partition("+")[0] for name in source.controls.names), *left])
        lines.append(f"heard, but left out: {', '.join(left)}; --points {every} takes them in, or lines in --map")
    if len(left) < len(source.unknown):
        lines.append(f"on no point: {', '.join(name for name in source.unknown if name not in left)}; --map says where they are")
    return lines


def another(source: Any) -> list[str]:
    """A line where the calibration that was kept seems to be of somebody of another size."""
    if (seems := getattr(source.worn, "seems", None)) is None:
        return []
    return [f"the calibration is of somebody {source.worn.known.height:.2f} m tall; whoever wears the trackers seems to be {seems:.2f} m, or never stands "
            "upright: to name another file by --calibration, and stand anew, tells how they are worn"]


def _ticks(seconds: float | None, behind: float, skipped: list[float], stop: Stop) -> Iterator[float]:
    """Times [s] of a steady clock, FPS a second, each when it has come; where they come later than by `behind` [s], the next one is now. They go on to when somebody stops it."""
    began, number, told = time.monotonic(), 0, False
    while seconds is None or number < round(seconds * FPS):
        due = began + number / FPS
        late = time.monotonic() - due
        if late > behind and stop.at == math.inf:
            skipped.append(late)
            began, due = began + late, due + late
        if due > stop.at:
            return
        if stop.at < math.inf and not told and late > 1.0:
            say(f"{late:.0f} s of what was heard are still to come; Ctrl-C again leaves them out")
            told = True
        time.sleep(max(0.0, -late))
        yield due
        number += 1


@contextmanager
def _stoppable() -> Iterator[Stop]:
    """Whoever ends the program from outside ends it like Ctrl-C does: gently, where that is wished, unless it is the second time."""
    asked = Stop()

    def stop(*_: Any) -> None:
        if not asked.gently or asked.at < math.inf:
            raise KeyboardInterrupt
        asked.at = time.monotonic()
    kinds = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = [signal.signal(kind, stop) for kind in kinds]
    try:
        yield asked
    finally:
        for kind, handler in zip(kinds, before):
            signal.signal(kind, handler)


def write_take(out: Path, name: str, skeleton: Any, poses: list, contacts: list) -> None:
    """Write a recorded take, and say so."""
    import numpy as np

    from ..output import Take, write

    for path in write(out, [Take(name, skeleton, tuple(poses), np.stack(contacts))], FPS):
        say(f"{path}: {len(poses)} frames, {len(poses) / FPS:.1f} s")
