"""The shipped library and its controller, loaded once, and what they were played through."""

import pytest

from controllers.locomotion import Library, Locomotion
from controllers.locomotion.controller import DEFAULT_LIBRARY


@pytest.fixture(scope="session")
def library():
    return Library.load(DEFAULT_LIBRARY)


@pytest.fixture(scope="session")
def locomotion(library):
    return Locomotion(library)
