"""What all tests share: no law is timed, and where the recorded motion lies that some of them read.

The recorded motion is no part of the project.
"""

import os
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("gambol", deadline=None)  # a busy machine breaks no law
settings.load_profile("gambol")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # threads cost small matrices far more than they save

SHARED = Path(__file__).resolve().parents[1].parent / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of shared recordings; the test is skipped where there is none."""
    if not (SHARED / "mocap").is_dir():
        pytest.skip("no ../shared/mocap beside the project: recorded motion is not to be had here")
    return SHARED
