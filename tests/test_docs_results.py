"""The page of results can be read: a row has one idea, a command, and no history; what commands print is cut to what matters."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
LONGEST = 165
"""So many characters a cell of the tables has at most."""


def rows():
    """Cells of all rows of the tables of results, without their heads."""
    for line in (DOCS / "results.md").read_text("utf-8").splitlines():
        if line.startswith("| ") and not line.startswith("| figure |"):
            yield [cell.strip() for cell in line.strip().strip("|").split("|")]


def test_rows_are_short_and_name_their_command():
    told = list(rows())
    assert len(told) > 150
    for row in told:
        assert len(row) == 4, row
        figure, wanted, measured, printed = row
        assert max(map(len, (figure, wanted, measured))) <= LONGEST, figure
        assert re.fullmatch(r"(?:`(?:scripts/|gambol )[^`]+`(?:, )?)+", printed), figure


def test_rows_tell_no_history():
    """What a figure was belongs in the changes."""
    for figure, _, measured, _ in rows():
        assert not re.search(r"\b(?:before|was|were|since)\b", measured), figure


@pytest.mark.parametrize("page", sorted((DOCS / "results").glob("*.md")), ids=lambda page: page.stem)
def test_what_commands_print_is_cut_to_what_matters(page):
    """And the command stands right above it."""
    text = page.read_text("utf-8")
    for before, block in re.findall(r"([^\n]*)\n\n```\n(.*?)^```", text, re.M | re.S):
        assert before.startswith("    $ "), before
        assert block.count("\n") <= 75, before
