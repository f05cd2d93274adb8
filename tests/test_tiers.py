"""Which tests are left out unless all are wanted: those that are marked `thorough`, and cases of families that are marked `few`."""

from pathlib import Path
from types import SimpleNamespace

import pytest

import conftest

HERE = Path(__file__).resolve()


class Case:
    """A test, or a case of one, with marks by name."""

    def __init__(self, name, number=0, path=HERE, **marks):
        self.path, self.originalname, self.number, self.marks = path, name, number, marks

    def get_closest_marker(self, name):
        return SimpleNamespace(args=(self.marks[name],)) if name in self.marks else None


def left(*cases, args=("tests",), thorough=False, profile=None):
    """What is run of cases, by name and number, and how many are told to be left out."""
    items, told = list(cases), []
    config = SimpleNamespace(option=SimpleNamespace(thorough=thorough, times=1), args=args, getoption=lambda name: profile,
                             hook=SimpleNamespace(pytest_deselected=lambda items: told.extend(items)))
    conftest.pytest_collection_modifyitems(config, items)
    return [(case.originalname, case.number) for case in items], len(told)


FAMILY = [Case("family", number, few=3) for number in range(9)]
ALL = [Case("plain"), Case("wide", thorough=True), *FAMILY]
WHOLE = [(case.originalname, case.number) for case in ALL]


def test_what_is_thorough_is_left_out_and_of_a_family_a_few_are_tried_first_and_last():
    assert left(*ALL) == ([("plain", 0), ("family", 0), ("family", 4), ("family", 8)], 7)
    assert left(*(Case("one", number, few=1) for number in range(4))) == ([("one", 0)], 3)
    assert left(*(Case("small", number, few=5) for number in range(2))) == ([("small", 0), ("small", 1)], 0)


@pytest.mark.parametrize("more", [{"thorough": True}, {"profile": "seek"}, {"args": (str(HERE),)}, {"args": (f"{HERE}::test_wide[0]",)}])
def test_all_are_run_where_they_are_asked_for(more):
    assert left(*ALL, **more) == (WHOLE, 0)


def test_a_family_is_that_of_one_file():
    other = [Case("family", number, HERE.with_name("other.py"), few=3) for number in range(3)]
    assert left(*FAMILY, *other)[1] == 6
