"""Set Gambol up with what its tests need, if need be, and read its sources: ruff's rules, and pyright's types.

    python3 scripts/check.py
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import _setup

WINGS = ("controllers", "game", "assets")


def main() -> int:
    _setup.ready("test")
    return _setup.run("-m", "ruff", "check", folder=_setup.ROOT) or types()


def types() -> int:
    """Whether the types are sound, of sources that lie as they are imported: pyright follows neither links nor import hooks."""
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder).resolve() / "gambol"
        for wing in WINGS:
            shutil.copytree(_setup.ROOT / wing, home / wing, ignore=lambda at, names: [
                name for name in names if name == "__pycache__" or (Path(at, name).is_file() and not name.endswith((".py", ".typed")))])
        shutil.copy(_setup.ROOT / "gambol" / "__main__.py", home)
        shutil.copy(_setup.ROOT / "pyproject.toml", folder)
        told = subprocess.run([str(_setup.PYTHON), "-m", "pyright", "--pythonpath", str(_setup.PYTHON), "--project", folder],
                              stdout=subprocess.PIPE, text=True)
        print(told.stdout.replace(f"{home}/", "").replace(f"{home}\\", ""), end="", flush=True)
        return told.returncode


if __name__ == "__main__":
    sys.exit(main())
