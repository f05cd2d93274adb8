"""A page of the docs for every room, made of its docstrings whenever the docs are built (a hook of MkDocs).

The sources are read, never imported: building the docs needs neither OpenGL nor a compiled kernel.
"""

from __future__ import annotations

import ast
import shutil
import tempfile
from pathlib import Path

from mkdocs.plugins import event_priority
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[3]
WINGS = ("controllers", "game")
PAGE = """# {title}

`{path}`

::: gambol.{name}
"""
INDEX = """# Rooms

A room hands out its public names at its door; here they are, with what their docstrings say. [The house](../house.md) says
where everything is.

{rooms}
"""


def rooms() -> dict[str, Path]:
    """Doors by dotted name, without the `gambol.` in front: of every folder, and files that stand beside the folders of a wing."""
    found = {}
    for wing in WINGS:
        doors = [path for path in (ROOT / wing).rglob("__init__.py") if path.parent != ROOT / wing]
        single = [path for path in (ROOT / wing).glob("*.py") if path.name != "__init__.py"]
        for path in doors + single:
            place = path.parent if path.name == "__init__.py" else path.with_suffix("")
            found[".".join(place.relative_to(ROOT).parts)] = path
    return dict(sorted(found.items()))


def says(path: Path) -> str:
    """The first sentence of a module's docstring."""
    text = " ".join((ast.get_docstring(ast.parse(path.read_text("utf-8"))) or "").split("\n\n")[0].split())
    return text.split(". ")[0].rstrip(".") + "."


@event_priority(100)  # before mkdocstrings looks where the sources are
def on_config(config):
    """Let the sources be found under the names that they are installed by, and put the rooms into the menu."""
    config.extra["sources"] = kept = tempfile.TemporaryDirectory(prefix="gambol_docs_")  # gone when the docs are built
    sources = Path(kept.name)
    for wing in WINGS:
        for path in (ROOT / wing).rglob("*.py"):
            copy = sources / "gambol" / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
    (sources / "gambol" / "__init__.py").write_text("")
    config.plugins["mkdocstrings"].config.handlers["python"]["paths"] = [str(sources)]
    menu = next(entry for entry in config.nav if "Rooms" in entry)
    menu["Rooms"] = ["api/index.md", *({name: f"api/{name}.md"} for name in rooms())]
    return config


def on_files(files, config):
    """The pages themselves, none of which lies on disk."""
    lines = []
    for name, path in rooms().items():
        page = PAGE.format(title=name, path=path.relative_to(ROOT).as_posix(), name=name)
        files.append(File.generated(config, f"api/{name}.md", content=page))
        lines.append(f"- [`{name}`]({name}.md): {says(path)}")
    files.append(File.generated(config, "api/index.md", content=INDEX.format(rooms="\n".join(lines))))
    return files
