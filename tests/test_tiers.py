"""Which tests are left out unless all are wanted: those that are marked `thorough`, and cases of families that are marked `few`."""

from pathlib import Path
from types import SimpleNamespace

import pytest
from tiers import left_out

HERE = Path(__file__).resolve()


class Case:
    """A test, or a case of one, with marks by name."""

    def __init__(self, name, number=0, path=HERE, **marks):
        self.path, self.originalname, self.number, self.marks = path, name, number, marks

    def get_closest_marker(self, name):
        return SimpleNamespace(args=(self.marks[name],)) if name in self.marks else None


def run(*cases, named=("tests",)):
    """What is run of cases, by name and number."""
    gone = left_out(cases, named)
    return [(case.originalname, case.number) for case in cases if case not in gone]


FAMILY = [Case("family", number, few=3) for number in range(9)]
ALL = [Case("plain"), Case("wide", thorough=True), *FAMILY]


def test_what_is_thorough_is_left_out_and_of_a_family_a_few_are_tried_first_and_last():
    assert run(*ALL) == [("plain", 0), ("family", 0), ("family", 4), ("family", 8)]
    assert run(*(Case("one", number, few=1) for number in range(4))) == [("one", 0)]
    assert run(*(Case("small", number, few=5) for number in range(2))) == [("small", 0), ("small", 1)]


@pytest.mark.parametrize("named", [str(HERE), f"{HERE}::test_wide[0]"])
def test_a_file_that_is_named_runs_whole(named):
    assert len(run(*ALL, named=(named,))) == len(ALL)


def test_a_family_is_that_of_one_file():
    other = [Case("family", number, HERE.with_name("other.py"), few=3) for number in range(3)]
    assert len(run(*FAMILY, *other)) == 6
