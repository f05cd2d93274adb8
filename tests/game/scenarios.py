"""Scenario files that tests write, and what is asked of every mistake in one."""

import pytest

from gambol.game.scenario.scenario import ScenarioError, load


def written(folder, text):
    """A scenario's file in a folder, from text or bytes."""
    file = folder / "my.toml"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return file


def tells(folder, good, old, new, says):
    """Assert that `good` with `old` made `new` is refused in one line, which names the file and says so."""
    assert old in good
    file = written(folder, good.replace(old, new, 1))
    with pytest.raises(ScenarioError) as error:
        load(file)
    message = str(error.value)
    assert says in message and message.startswith(str(file)) and "\n" not in message
