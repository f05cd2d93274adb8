"""New processes that have numba already: to start Python and load numba takes a second, to part from one that has takes none.

Each begins with none of the code that a test wrote, as a new Python would.
"""

import atexit
import multiprocessing
import os
import sys
from multiprocessing import forkserver
from pathlib import Path

import numba

numba.njit(lambda x: x)(1.0)  # what numba loads when it first compiles

FORKS = "forkserver" in multiprocessing.get_all_start_methods()


def ready() -> None:
    """The process that others part from, with the path of this one."""
    if FORKS:
        multiprocessing.set_forkserver_preload([__name__])
        before = os.environ.get("PYTHONPATH")
        os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), *([before] if before else [])])
        forkserver.ensure_running()
        os.environ.pop("PYTHONPATH") if before is None else os.environ.update(PYTHONPATH=before)


class Fresh:
    """Code that runs in a folder, in a new process with some variables of the environment."""

    def __init__(self, code: str, folder: Path, **environment: str):
        self._said, self._fault = (folder / f"{id(self)}.{name}" for name in ("out", "err"))
        start = multiprocessing.get_context("forkserver" if FORKS else "spawn")
        self._process = start.Process(target=_run, args=(code, str(folder), environment, self._said, self._fault))
        self._process.start()

    def said(self) -> str:
        """What it printed, once it has ended; AssertionError with its traceback where it failed."""
        self._process.join()
        assert self._process.exitcode == 0, self._fault.read_text()
        return self._said.read_text()


def _run(code, folder, environment, said, fault):
    for stream, path in ((sys.stdout, said), (sys.stderr, fault)):
        with open(path, "w") as file:
            os.dup2(file.fileno(), stream.fileno())
    os.chdir(folder)
    os.environ.update(environment)
    sys.path.insert(0, folder)
    exec(compile(code, "a new process", "exec"), {"__name__": "__main__"})
    sys.stdout.flush()
    atexit._run_exitfuncs()  # which a forked process would pass over
