"""What tests of the game share: nothing is compiled beside them."""

import pytest

from gambol.controllers.person import preparing


@pytest.fixture(autouse=True)
def prepared(monkeypatch):
    """Whoever opens a game finds everything compiled, so that no program is started for it."""
    monkeypatch.setattr(preparing, "ready", lambda part, walker: True)
