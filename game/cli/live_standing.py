"""Where floor and body are, and how trackers are worn: by somebody who stands still for a second, or as a file knows it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import set_poses
from .base import Mistake, say
from .live_clock import times

_TELL = 3.0  # s between words about what is waited for
_VAST = 3.0  # m from their middle no body's points are


def stand(source: Any, height: float | None, calibration: Path | None = None, posing: bool = False, tell: Callable[[Any], None] | None = None,
          say: Callable[[str], None] = say, wait: float | None = None) -> None:
    """Tell the source where floor and body are: as somebody does who stands still, and if a file is named how trackers are worn, too: as it says if
    it is there; else it is written then. posing: whether set poses are asked for. tell, say: who
    hears what is asked for (`app.Asked`), each time, and what is known, in words. wait: for how long [s] at most; Mistake if nobody has stood still by then."""
    from gambol.controllers.reconstruction.calibration import load, save

    if calibration is not None and calibration.exists():
        source.worn = load(calibration, source.controls)
        say(source.worn.said(source.controls.names))
        if tell is None and is_live(source):
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

    live = is_live(source)
    if live:
        say(f"listening at {source.host}, port {source.port}: stand upright for a second, in T-pose or with the arms down")
    standing, told, began = Standing(), -_TELL / 2, None
    ticking = times(source, None, True, [])
    for now in ticking:
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
                    worn = set_poses.worn(source, placement, standing.place, turn, ticking, tell, say) if posing else None
                    source.worn = worn or Wearer.standing(source.controls, placement, standing.place, turn, CalibrationNetwork.load())
                source.placement = placement
                return
            except ValueError as error:
                say(str(error))
                standing, told = Standing(), now
        over = live and wait is not None and now - began > wait
        if over or now - told > _TELL:
            unheard = missing(source, np.isfinite(seen).all(-1))
            if over:
                why = f"nothing is heard of {', '.join(unheard)}" if unheard else _vast(seen)
                raise Mistake(f"nobody has stood still for {wait:g} s" + (f": {why}" if why else "")
                              + "".join(f"; {line}" for line in amiss(source)))
            say(f"waiting for {', '.join(unheard)}" if unheard else _vast(seen) or "waiting for somebody who stands still")
            for line in amiss(source):
                say(line)
            told = now
    raise Mistake("nobody stands still in these packets, upright, in T-pose or with the arms down")


def _met(source: Any, say: Callable[[str], None], wait: float | None) -> None:
    """Wait until any tracker is heard, where it is known how they are worn. wait: as in `stand`."""
    import numpy as np

    say(f"listening at {source.host}, port {source.port}")
    told = began = None
    for now in times(source, None, True, []):
        began, told = (now, now - _TELL / 2) if began is None or told is None else (began, told)
        there = np.isfinite(source.at(now)).all(-1)
        if there.any():
            return
        if wait is not None and now - began > wait:
            raise Mistake("; ".join([f"nothing is heard of {', '.join(missing(source, there))} for {wait:g} s", *amiss(source)]))
        if now - told > _TELL:
            for line in (f"waiting for {', '.join(missing(source, there))}", *amiss(source)):
                say(line)
            told = now


def is_live(source: Any) -> bool:
    """Whether a source is heard as it comes, and is no file of packets."""
    return not hasattr(source, "duration")


def _vast(points: Any) -> str:
    """That points (n, 3) are farther from each other than a body's, as they are in another unit than the protocol's; "" where they are not."""
    import numpy as np

    apart = float(np.linalg.norm(points - np.mean(points, 0), axis=-1).max())
    return f"trackers are {apart:.0f} m from their middle, as no body's are: they must be sent in metres" if apart > _VAST else ""


def missing(source: Any, there: Any) -> list[str]:
    """The names of the points that are not there. there: (n,) bool."""
    return [name.partition("+")[0] for name, is_there in zip(source.controls.names, there) if not is_there]


def amiss(source: Any) -> list[str]:
    """What is wrong with what is heard, or why nothing is: a line for each."""
    from gambol.controllers.reconstruction import NAMES

    lines = [_twice(source)] if source.rivals else []
    if source.about and not source.heard:
        lines.append(f"what comes is about {source.about}, and of no tracker: let the program send /VMC/Ext/Tra/Pos and Hmd/Pos, or /tracking/trackers")
    elif is_live(source) and not source.heard and source.local:
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


def _twice(source: Any) -> str:
    return f"two programs send the same trackers, from {' and '.join(source.rivals)}: close one of them, or give its trackers other names"
