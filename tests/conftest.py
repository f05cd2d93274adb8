"""What all tests share: which examples laws are tried on, and where the recorded motion lies that some of them read.

The examples are the same in every run; `scripts/seek.py` seeks new ones.

The recorded motion is no part of the project.
"""

import gc
import math
import os
import subprocess
import sys
from pathlib import Path

# before anything loads numpy, and for the programs that tests start: tests run side by side on all cores, where threads of
# each that wait for each other cost small matrices forty times what they save
for library in ("OPENBLAS", "MKL", "OMP"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
# nor may numba colour what it says as it compiles: colorama puts back the standard output of an earlier test
os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")
# and though Python may be told to keep no bytecode: the programs that tests start by the dozen would each compile all of our sources
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

import pytest  # noqa: E402
from hypothesis import HealthCheck, is_hypothesis_test, settings  # noqa: E402

from sampling import BATCHES, KINDS  # noqa: E402
from tiers import left_out  # noqa: E402

for name, same, tries in (("gambol", True, 25), ("thorough", True, 100), ("seek", False, 100)):  # a busy machine breaks no law, and fixtures here are values
    settings.register_profile(name, derandomize=same, max_examples=tries, database=None, deadline=None, print_blob=True,
                              suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
settings.load_profile("gambol")

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of shared recordings; the test is skipped where there is none."""
    if not (SHARED / "mocap").is_dir():
        pytest.skip("no ../shared/mocap beside the project: recorded motion is not to be had here")
    return SHARED


@pytest.fixture(params=KINDS)
def kind(request):
    """Of which kind the sampled rotations are."""
    return request.param


@pytest.fixture(params=BATCHES, ids=str)
def batch(request):
    """How many of them there are: the leading axes."""
    return request.param


def pytest_addoption(parser):
    parser.addoption("--times", type=int, default=1, help="try each law on so many times the examples")
    parser.addoption("--thorough", action="store_true", help="try what is marked `thorough` and all cases of what is marked `few`, too, laws on more examples, and films of many people to their ends")


def pytest_configure(config):
    if config.option.thorough:
        settings.load_profile("thorough")
    for mark in ("few(count): all cases tell of one thing and each takes long: so many of them, spread evenly, unless --thorough or its file is named",
                 "thorough: tells more widely of what a quicker test fails for, too, if it breaks: only with --thorough or where its file is named"):
        config.addinivalue_line("markers", mark)


def pytest_collection_modifyitems(config, items):
    every = config.option.thorough or config.getoption("--hypothesis-profile") == "seek"
    if not every:
        gone = left_out(items, config.args)
        config.hook.pytest_deselected(items=[item for item in items if item in gone])
        items[:] = [item for item in items if item not in gone]
    usual, share = settings().max_examples, 1.0 if every else 0.35
    for law in {item.obj for item in items if is_hypothesis_test(getattr(item, "obj", None))}:
        own = law._hypothesis_internal_use_settings
        tries = own.max_examples if own.max_examples == usual else math.ceil(share * own.max_examples)
        law._hypothesis_internal_use_settings = settings(own, max_examples=tries * config.option.times)


def pytest_collection_finish(session):
    """What is collected stays to the end, and steps make few rings: whoever looks for them seldom, and not among that, saves a fiftieth of the time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


def pytest_sessionstart(session):
    """Before tests run on several cores, programs compile what most of them need: else each core would do it for itself."""
    if not getattr(session.config.option, "numprocesses", None) or hasattr(session.config, "workerinput"):
        return
    from gambol.controllers.compiled import cold
    from gambol.controllers.locomotion import Locomotion
    from gambol.controllers.person import preparing

    if cold():
        print("compiling the motion, once: a minute", flush=True)
        for program in (*preparing.begun(Locomotion.load()), subprocess.Popen([sys.executable, "tests/rehearsal.py"], cwd=ROOT)):
            program.wait()
