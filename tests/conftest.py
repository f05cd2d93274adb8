"""What all tests share: no law is timed, and where the recorded motion lies that some of them read.

The recorded motion is no part of the project.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("gambol", deadline=None)  # a busy machine breaks no law
settings.load_profile("gambol")
for library in ("OPENBLAS", "OMP"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")  # threads cost small matrices far more than they save

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared"
REHEARSALS = ("-m", "gambol.controllers.jump.warm_up"), ("tests/rehearsal.py",)


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of shared recordings; the test is skipped where there is none."""
    if not (SHARED / "mocap").is_dir():
        pytest.skip("no ../shared/mocap beside the project: recorded motion is not to be had here")
    return SHARED


def pytest_sessionstart(session):
    """Before tests run on several cores, two programs compile what most of them need: else each core would do it for itself."""
    from gambol.controllers.compiled import cold

    if getattr(session.config.option, "numprocesses", None) and not hasattr(session.config, "workerinput") and cold():
        print("compiling the motion, once: a minute", flush=True)
        for program in [subprocess.Popen([sys.executable, *one], cwd=ROOT) for one in REHEARSALS]:
            program.wait()
