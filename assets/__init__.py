"""What Gambol ships beside its code: shaders, the gait library, the character, scenarios."""

from pathlib import Path

FOLDER = Path(__file__).parent
"""The folder of the shipped assets."""


def path(*parts: str) -> Path:
    """The path of a shipped asset, for example ``path("library", "default.npz")``."""
    return FOLDER.joinpath(*parts)
