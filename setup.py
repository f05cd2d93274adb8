"""The folders at the top are installed as `gambol.controllers`, `gambol.game` and `gambol.assets`, and what `python -m gambol` runs as `gambol`; the rest is in pyproject.toml."""

from setuptools import find_packages, setup

WINGS = ("controllers", "game", "assets")
setup(packages=["gambol", *(f"gambol.{room}" for room in find_packages(include=[name for wing in WINGS for name in (wing, f"{wing}.*")]))],
      package_dir={f"gambol.{wing}": wing for wing in WINGS})
