"""What a frame of a body from points costs, and which of its parts take how much: `Reconstruction.step`, as live trackers and `gambol reconstruct` have it.

    python scripts/measure/reconstruction_frame.py ../shared/mocap/cmu/14/14_02.amc … [--frames 500] [--noise CM]

One thread, in its own time: what others on the machine take is not in it. A cell is the median and, in brackets, what one frame in a hundred is beyond, in times
of the median of the method alone (the network that ships and its solve, `Trackers.step`), which is told the same points frame by frame between the
frames that are counted. Parts are medians of a second run, by the clock, each without the parts within it, in times of what the method's three take there. The first
frames are left out.
"""

from __future__ import annotations

import argparse
import gc
import math
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

for library in ("OPENBLAS", "OMP", "MKL", "NUMBA"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import Clip
from gambol.controllers.contract import Intent
from gambol.controllers.mocap import hinged, load, retarget
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.following import Gate
from gambol.controllers.reconstruction.footing import Footing
from gambol.controllers.reconstruction.live import Recorded
from gambol.controllers.reconstruction.trackers import Network, Trackers
from reconstruction_figures import table

FPS, WARM = 60.0, 20
METHOD = ("the network", "its solve, filters", "feet that stand")
SETS = tuple((points, turning) for turning in (False, True) for points in ("3", "4", "6"))


@dataclass
class Parts:
    """Times the parts of a frame, each without those within it. spent: [ns] by part, of the frame so far."""

    spent: dict[str, int] = field(default_factory=dict)
    _open: list[int] = field(default_factory=list)

    def of(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The same function, timed."""
        def timed(*args: Any, **named: Any) -> Any:
            self._open.append(0)
            began = time.perf_counter_ns()  # a thread's own time takes longer to tell than some of the parts
            try:
                return function(*args, **named)
            finally:
                took = time.perf_counter_ns() - began
                self.spent[part] = self.spent.get(part, 0) + took - self._open.pop()
                if self._open:
                    self._open[-1] += took
        return timed

    def watch(self, follower: type) -> None:
        """Time all parts from now on; there is no way back. follower: its class."""
        room = sys.modules[Reconstruction.__module__]
        for part, owner, names in (
                ("points and turns as they come", Reconstruction, ("_seen", "_turns")), ("the gate of points", Gate, ("named", "confusable", "admit", "told")),
                (METHOD[0], Network, ("predict",)), (METHOD[1], Trackers, ("step",)), (METHOD[2], Footing, ("told", "step")),
                ("exchanged numbers", follower, ("doubted",)), ("the pose that is shown", follower, ("shown",)), ("feet out of the floor", room, ("above",)),
                ("ground frame, contacts", room, ("driven",)), ("leaps, motion, what fades", Reconstruction, ("step",))):
            for name in names:
                setattr(owner, name, self.of(part, getattr(owner, name)))


def performance(path: str, frames: int) -> Clip:
    """A clip on the standard body, at most so many frames of it."""
    clip = hinged(retarget(load(path))).resample(FPS)
    return clip.slice(0, min(len(clip), frames))


def seen(clip: Clip, points: str, turning: bool, noise: float) -> Recorded:
    """Its points, which may be noisy [m]."""
    source = Recorded.of(clip, parse(points, SKELETON), turning)
    return source.noisy(noise, np.random.default_rng(0)) if noise else source


def run(network: Network, source: Recorded, parts: Parts | None) -> tuple[list[int], list[int], list[dict[str, int]]]:
    """Of each frame [ns]: all of it, the method alone, and its parts where they are timed."""
    method, dt = Trackers(network, source.controls, 1 / FPS), 1 / FPS
    controller = Reconstruction(method, source.controls, dt=dt, starts=method, far=math.inf)
    turns = source.turns if source.turns is not None else [None] * len(source.points)
    state = controller.begin(source.points[0], turns=turns[0])
    memory, whole, alone, told = method.begin(*method.find(source.points[0], None, turns[0])), [], [], []
    gc.disable()
    for points, turned in zip(source.points[1:], turns[1:]):
        intent = Intent(points=points, turns=turned)
        if parts is not None:
            parts.spent.clear()
        began = time.thread_time_ns()
        state, _ = controller.step(state, intent, dt)
        whole.append(time.thread_time_ns() - began)
        if parts is not None:
            told.append(dict(parts.spent))
            continue
        began = time.thread_time_ns()
        memory, _ = method.step(memory, points, turned)
        alone.append(time.thread_time_ns() - began)
    gc.enable()
    return whole[WARM:], alone[WARM:], told[WARM:]


def cell(times: np.ndarray, unit: float) -> str:
    """Median and 99th percentile in units."""
    return f"{np.median(times) / unit:.2f} ({np.percentile(times, 99) / unit:.2f})"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clips", nargs="+", help="BVH or AMC files")
    parser.add_argument("--frames", type=int, default=500, help="of each clip, at most")
    parser.add_argument("--noise", type=float, default=0.0, help="[cm] on each coordinate")
    given = parser.parse_args()
    network, rows = Network.load(), {}
    clips = [performance(path, given.frames) for path in given.clips]
    told = {which: [seen(clip, *which, given.noise / 100.0) for clip in clips] for which in SETS}
    for some in told.values():
        runs = [run(network, source, None) for source in some]
        whole, alone = (np.concatenate([one[kind] for one in runs]) for kind in (0, 1))
        rows.setdefault("the method alone, ms", []).append(cell(alone, 1e6))
        rows.setdefault("**the whole frame**", []).append(f"**{cell(whole, float(np.median(alone)))}**")
    parts = Parts()
    parts.watch(type(Reconstruction(Trackers(network, parse("4", SKELETON)), parse("4", SKELETON)).follower))
    for some in told.values():
        found = [frame for source in some for frame in run(network, source, parts)[2]]
        unit = np.median([sum(frame.get(part, 0) for part in METHOD) for frame in found])
        for part in dict.fromkeys(part for frame in found for part in frame):
            rows.setdefault(part, []).append(f"{np.median([frame.get(part, 0) for frame in found]) / unit:.2f}")
    print(f"{len(given.clips)} clips, times of the method alone: median (99th percentile); of parts the median\n")
    print(table(["", *(f"{points} that turn" if turning else f"{points} points" for points, turning in SETS)], [[part, *cells] for part, cells in rows.items()]))


if __name__ == "__main__":
    main()
