"""The examples of laws: the same in every run, and others where somebody seeks them."""

import os
import subprocess
import sys
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

ROOT = Path(__file__).parents[1]
LAWS = '''
from hypothesis import given, settings, strategies as st
@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_nearly_always(number):
    assert number % 200
@given(st.integers(0, 2**32 - 1))
def test_always(number):
    assert number >= 0
def test_no_law():
    assert False
'''


def seek(tmp_path, *arguments):
    (tmp_path / "test_laws.py").write_text(LAWS)
    found = subprocess.run([sys.executable, "scripts/seek.py", "-n", "0", "--rounds", "1", *arguments, "-p", "tests.conftest", str(tmp_path)],
                           cwd=ROOT, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": os.pathsep.join((str(ROOT), str(ROOT / "tests")))})
    return found.returncode, found.stdout


def test_a_law_that_is_none_is_found_and_shown_again(tmp_path):
    code, said = seek(tmp_path, "--seed", "7", "--times", "20")
    assert code == 1 and said.endswith("laws broken in 1 rounds: 1\n")
    told, = (line for line in said.splitlines() if "test_nearly_always fails 1 times: python -m pytest" in line)
    assert "--hypothesis-seed=7 " in told and "--times=20 " in told


def test_no_law_broken_is_told_by_the_exit_code_and_other_tests_are_not_run(tmp_path):
    code, said = seek(tmp_path, "-k", "not nearly")
    assert code == 0 and said.endswith("laws broken in 1 rounds: 0\n") and "1 passed" in said


def examples():
    tried = []

    @given(st.integers(0, 2**32 - 1))
    def law(number):
        tried.append(number)
    law()
    return tried


def test_examples_are_the_same_in_every_run(request):
    asked = request.config.getoption("--hypothesis-profile") == "seek"
    assert (examples() == examples()) != asked
