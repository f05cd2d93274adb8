"""The shipped library and its controller, loaded once, and what they were played through."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Library, Locomotion
from gambol.controllers.locomotion.controller import DEFAULT_LIBRARY

from playing import WISHES, hold, play, whims


@pytest.fixture(scope="session")
def library():
    return Library.load(DEFAULT_LIBRARY)


@pytest.fixture(scope="session")
def locomotion(library):
    return Locomotion(library)


@pytest.fixture(scope="session")
def whimsical(locomotion):
    """Twelve characters for fifteen seconds, their wishes changed at a whim."""
    return play(locomotion, whims(np.random.default_rng(5), 15, 12))


@pytest.fixture(scope="session")
def steadily(locomotion):
    """WISHES, each held for sixteen seconds."""
    return play(locomotion, hold(16, *WISHES))
