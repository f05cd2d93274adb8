"""The methods that reconstruct, by name: each learnt from a database the first time that it is asked for.

What takes long lies on disk afterwards. A program that must not wait has it learnt by another one (`Learning`).
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gambol.controllers.compiled import cache_folder

if TYPE_CHECKING:  # what reconstructs is loaded by the functions that need it: a game without a study starts without
    from gambol.controllers.reconstruction import ControlPoints
    from gambol.controllers.reconstruction.database import Database
    from gambol.controllers.reconstruction.following import Beginning, Starts

METHODS = ("trackers", "ours", "turning", "lpcr", "lpca", "mousas", "nearest", "network", "ridge", "gplvm")
"""The network that ships, for any trackers; ours, learnt from a database; the same for trackers that tell how they are turned; local PCR (Liu 2011); local PCA (Chai & Hodgins 2005); Mousas 2014 mended; the nearest recording; a small network;
ridge regression; SGPLVM (Grochow 2004)."""
TINTS = {"trackers": (0.12, 0.42, 0.10), "ours": (0.03, 0.36, 0.33), "turning": (0.02, 0.26, 0.42),
         "lpcr": (0.62, 0.05, 0.36), "lpca": (0.86, 0.50, 0.02),
         "mousas": (0.28, 0.20, 0.70), "nearest": (0.40, 0.42, 0.08), "network": (0.06, 0.30, 0.72),
         "ridge": (0.60, 0.18, 0.10), "gplvm": (0.55, 0.36, 0.24)}
"""The colour of each, linear RGB: of its body, its ghost and its line in the legend."""
NAMES = {"trackers": "trackers", "ours": "ours", "turning": "ours, turning", "lpcr": "local PCR", "lpca": "local PCA", "mousas": "Mousas mended", "nearest": "nearest",
         "network": "network", "ridge": "ridge", "gplvm": "SGPLVM"}
"""What each is called in the picture."""
SHIPPED = "trackers"
"""The one that needs no database."""
TURNING = "turning"
"""The one that is learnt for trackers which tell how they are turned."""
NETWORK = ".npz"
"""A file that ends so is somebody's own network, which `gambol database tune` taught, in the place of a database."""
KERNELS = 28
"""So many kernels are compiled for the one that ships, about, beside those of a person: for those only who ask how far it is."""
READY = "points.ready"
"""A file beside the kernels once all of them are there."""
PROGRESS = re.compile(r"(.+): (\d+) of (\d+)")

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is, and of how much."""


class Methods:
    """The methods over one database; Gambol's own motion where no file is named, or a network is.

    DatabaseError for a file that is no database, ArraysError for one that is no network, once it is needed.
    """

    def __init__(self, file: str | Path | None = None):
        self.file = None if file is None else Path(file)
        self._known: dict[tuple[str, str], Any] = {}
        self._starts: dict[str, Starts] = {}
        self._database: Database | None = None

    def knows(self, name: str, points: str) -> bool:
        """Whether a method for some points is ready at once."""
        return (name, points) in self._known

    def __call__(self, name: str, points: str, progress: Progress | None = None) -> tuple[Any, ControlPoints]:
        """A method of `METHODS` and the points that it follows, as `controls.parse` has them.

        ValueError, saying what there is, for others.
        """
        if name not in METHODS:
            raise ValueError(f"no method {name!r}: there are {', '.join(METHODS)}")
        from gambol.controllers.reconstruction import SKELETON, parse

        controls = parse(points, SKELETON)
        if (name, points) not in self._known:
            if name == SHIPPED:
                self._known[name, points] = shipped(controls, self.network)
            else:
                if name != TURNING:
                    self.starts(name, points)
                self._known[name, points] = learnt(name, self.database(progress), controls, progress)
        return self._known[name, points], controls

    def starts(self, name: str, points: str) -> Beginning:
        """Where a method begins from such points alone."""
        from gambol.controllers.reconstruction import SKELETON, parse
        from gambol.controllers.reconstruction.following import Starts

        if name in (SHIPPED, TURNING):
            return self(name, points)[0]
        if points not in self._starts:
            self._starts[points] = Starts.of(self.database(), parse(points, SKELETON))
        return self._starts[points]

    @property
    def network(self) -> Path | None:
        """The file of somebody's own network."""
        return self.file if taught(self.file) else None

    def frame_time(self, name: str) -> float:
        """Seconds between a method's frames."""
        return 1 / 60 if name == SHIPPED else 1 / self.database().fps

    def database(self, progress: Progress | None = None) -> Database:
        """What they learn from."""
        from gambol.controllers.reconstruction.database import Database, default_database

        if self._database is None:
            told = progress or _silent
            told("the database", 0, 1)
            self._database = default_database() if self.file is None or taught(self.file) else Database.open(self.file)
            told("the database", 1, 1)
        return self._database


@lru_cache
def methods(file: str | Path | None = None) -> Methods:
    """The methods over a database, the same ones for the same file."""
    return Methods(file)


def learnt(name: str, database: Database, controls: ControlPoints, progress: Progress | None = None) -> Any:
    """A method of `METHODS`, ready: nothing of it is compiled or read later. Rivals as they are best on recorded takes."""
    from gambol.controllers.reconstruction.evaluation import baseline
    from gambol.controllers.reconstruction.ours import ours, turning

    own = {"ours": ours, TURNING: turning}
    method = own[name](database, controls, progress=progress) if name in own else baseline(name, database, controls)
    rehearse(method, controls)
    return method


def taught(file: str | Path | None) -> bool:
    """Whether a file is named like somebody's own network, not like a database."""
    return file is not None and Path(file).suffix.lower() == NETWORK


def shipped(controls: ControlPoints, own: Path | None = None) -> Any:
    """The method that ships, for some points, ready. own: the file of somebody's own network in its place. ArraysError if that is none."""
    from gambol.controllers.reconstruction.trackers import Network, Trackers

    method = Trackers(Network.load() if own is None else Network.load(own), controls)
    rehearse(method, controls)
    with suppress(OSError):  # nothing can be kept
        (cache_folder() / READY).touch()
    return method


def compiled() -> bool:
    """Whether the method that ships, of any points, was compiled here before: it is then ready in half a second."""
    return (cache_folder() / READY).exists()


def usual(points: str, file: str | Path | None = None, turns: bool = False) -> str:
    """The method that is taken where none is named: what ships, or is taught, where all the points are on or beside joints that it knows
    and no database is given, else ours, or what hears turns if they are told."""
    from gambol.controllers.reconstruction import SKELETON, parse
    from gambol.controllers.reconstruction.trackers import SLOTS

    if (file is None or taught(file)) and set(parse(points, SKELETON).joints) <= set(SLOTS):
        return SHIPPED
    return TURNING if turns else "ours"


def _silent(what: str, done: int, total: int) -> None:
    pass


def rehearse(method: Any, controls: ControlPoints) -> None:
    """Some frames, of nobody and of who stands in the floor, so that what they compile or load halts no game."""
    from gambol.controllers.body import forward_kinematics
    from gambol.controllers.reconstruction import SKELETON, encode
    from gambol.controllers.reconstruction.following import above

    still = np.broadcast_to(np.eye(3), (1, len(SKELETON), 3, 3))
    memory, pose = method.begin(*encode(SKELETON.offsets[:1], still, 1 / 60)), None
    nobody, there = np.full((len(controls), 3), np.nan), controls.on(*forward_kinematics(SKELETON, SKELETON.offsets[0], still[0]))
    for points in (nobody, nobody, there, there):
        memory, pose = method.step(memory, points)
    above(SKELETON, pose, *forward_kinematics(SKELETON, pose.root, pose.rotations), floor=float(np.nanmean(there[:, 1])))


class Learning:
    """Another program that learns methods, (name, points) each, so that this one finds them on disk.

    said: how far it is, in words. ships: whether all of them only have to be compiled.
    """

    def __init__(self, wanted: Sequence[tuple[str, str]], file: Path | None = None, progress: Progress | None = None):
        arguments = [f"{name}@{points}" for name, points in wanted]
        command = [sys.executable, "-P", "-m", "gambol.game.world.learnt_methods", str(file or ""), *arguments]
        self.said, self._told, self.ships = "", progress or _silent, all(name == SHIPPED for name, _ in wanted)
        # small matrices are learnt many times faster on one thread, and the game keeps the other cores
        self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                         stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
                                         env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                                                           "PYTHONIOENCODING": "utf-8"})
        self._complaints: deque[str] = deque(maxlen=20)
        self._readers = [threading.Thread(target=read, daemon=True) for read in (self._listen, self._complain)]
        for reader in self._readers:
            reader.start()

    def _listen(self) -> None:
        assert self._process.stdout is not None  # it is a pipe
        for line in self._process.stdout:
            if found := PROGRESS.fullmatch(line.strip()):
                done, total = int(found[2]), int(found[3])
                self.said = f"{found[1]} {100 * done // max(total, 1)} %"
                self._told(found[1], done, total)

    def _complain(self) -> None:
        assert self._process.stderr is not None  # it is a pipe, and a full one would stop the program
        self._complaints.extend(self._process.stderr)

    @property
    def so_far(self) -> str:
        """How far it is, in words; what only compiles tells how much there is of it."""
        if self.said or not self.ships:
            return self.said
        share = sum(1 for _ in cache_folder().glob("gambol.controllers.reconstruction.*.nbc")) / KERNELS
        return f"{100 * min(share, 0.99):.0f} %"

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self._process.poll() is not None

    @property
    def fault(self) -> str:
        """Why it ended without having learnt everything; empty if it has."""
        if not self._process.returncode:
            return ""
        for reader in self._readers:
            reader.join(1.0)
        lines = [line.strip() for line in self._complaints if line.strip()]
        return lines[-1] if lines else f"learning ended with code {self._process.returncode}"

    def wait(self) -> None:
        """Until it has ended."""
        self._process.wait()

    def stop(self) -> None:
        """End it early."""
        self._process.terminate()
        self._process.wait()


def main(file: str, *wanted: str) -> None:
    """Learn "NAME@POINTS" each, and print how far it is."""
    told = {}

    def progress(what: str, done: int, total: int) -> None:
        share = 100 * done // max(total, 1)
        if told.get(what) != share:
            told[what] = share
            print(f"{what}: {done} of {total}", flush=True)
    for one in wanted:
        name, _, points = one.partition("@")
        methods(file or None)(name, points, progress)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (ValueError, OSError) as error:  # whoever began it reads the line
        sys.exit(str(error))
