"""The house rules: controllers know no window, importing opens nothing, and every room says what it is for."""

import ast
import importlib
import re
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCES = sorted(p for wing in ("controllers", "game", "assets", "scripts", "tests") for p in (ROOT / wing).rglob("*.py")
                 if "__pycache__" not in p.parts)
WINGS = ("controllers", "game")
MODULES = [p for p in SOURCES if p.relative_to(ROOT).parts[0] in WINGS]


@cache
def parsed(path):
    """The source of a module as a tree."""
    return ast.parse(path.read_text("utf-8"))


def dotted(path):
    """The name that a module is imported by."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(("gambol", *(parts[:-1] if parts[-1] == "__init__" else parts)))


def in_a_fresh_interpreter(code):
    """What some code prints, line by line, in a new process without a display."""
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_controllers_know_no_window_and_no_game():
    names = [dotted(p) for p in MODULES if dotted(p).startswith("gambol.controllers")]
    loaded = in_a_fresh_interpreter(f"import importlib, sys\nfor n in {names}: importlib.import_module(n)\n"
                                    "print(*sys.modules)")
    assert {"gambol.controllers.locomotion.step", "gambol.controllers.mocap.bvh"} <= set(loaded)
    foreign = {"moderngl", "glfw", "game", "imgui_bundle", "OpenGL", "av", "PIL", "matplotlib", "tkinter"}
    assert not foreign & {name.split(".")[0] for name in loaded}


def test_importing_the_game_opens_no_window_and_no_context():
    """Whatever would open one is made to fail first."""
    names = [dotted(p) for p in MODULES if dotted(p).startswith("gambol.game") and not dotted(p).endswith("__main__")]
    assert names
    in_a_fresh_interpreter(
        "import importlib\n"
        "def never(*a, **k): raise AssertionError('opened at import')\n"
        "import glfw, moderngl\n"
        "glfw.init = glfw.create_window = moderngl.create_context = moderngl.create_standalone_context = never\n"
        f"for n in {names}: importlib.import_module(n)\n")


def test_imports_run_one_way():
    """Game → controllers, never back; told from the sources, whatever is imported when."""
    for path in MODULES:
        if dotted(path).startswith("gambol.controllers"):
            for node in ast.walk(parsed(path)):
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else \
                    [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
                assert not any(n.split(".")[0] in ("game", "moderngl", "glfw") for n in names), path


def imported(path):
    """Those of our modules that a module imports, whenever it does."""
    own, names = dotted(path), {dotted(p) for p in MODULES}
    room = own if path.name == "__init__.py" else own.rpartition(".")[0]
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in names)
        elif isinstance(node, ast.ImportFrom):
            above = room.split(".")[:len(room.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*above, node.module] if node.module else above)
            yield from (name for alias in node.names
                        if (name := f"{source}.{alias.name}" if f"{source}.{alias.name}" in names else source) in names)


def room_of(name):
    """The folder within a wing that a module is in; itself where it stands in the wing."""
    parts = name.split(".")
    return ".".join(parts[:2])


@pytest.mark.parametrize("level", [str, room_of])
def test_nothing_imports_what_imports_it(level):
    """No ring of modules, nor of rooms, however late they import each other."""
    needs = {}
    for path in MODULES:
        here = level(dotted(path))
        needs.setdefault(here, set()).update({level(name) for name in imported(path)} - {here, *WINGS})
    assert "gambol.controllers.body" in needs["gambol.controllers.supervisor"] and "gambol.game.session.tick" in needs["gambol.game.app.play"]
    tuple(TopologicalSorter(needs).static_order())  # raises CycleError, which names the ring


ABSOLUTE = re.compile(r"""["'\s(=](/(?:home|work|Users|root|tmp|mnt|opt|srv|data|var)/|[A-Z]:\\\\)""")


def test_no_file_knows_a_machine():
    """No absolute path of anybody's disk in sources, recipes and scenarios."""
    files = [*SOURCES, *(ROOT / "assets").rglob("*.toml"), *(ROOT / "assets").rglob("*.md"), *ROOT.glob("*.toml"), *ROOT.glob("*.md")]
    mine = Path(__file__).resolve()
    found = [f"{path.relative_to(ROOT)}:{number}" for path in files if path.resolve() != mine
             for number, line in enumerate(path.read_text("utf-8").splitlines(), 1)
             if ABSOLUTE.search(line) or str(ROOT) in line]
    assert not found


def test_a_machines_path_would_be_seen():
    for line in ('path = "/home/someone/x"', "open('/srv/somewhere')", r'p = "C:\\Users"', "see /Users/me/file"):
        assert ABSOLUTE.search(line)
    for line in ("# metres/second", "https://host/home/", "a / b", '"../shared/mocap"'):
        assert not ABSOLUTE.search(line)


@pytest.mark.parametrize("path", MODULES, ids=dotted)
def test_every_module_says_what_it_is_for(path):
    tree = parsed(path)
    assert ast.get_docstring(tree), "no docstring"


@pytest.mark.parametrize("path", MODULES, ids=dotted)
def test_public_functions_and_classes_say_what_they_do(path):
    tree = parsed(path)
    silent = [node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)
              and not node.name.startswith("_") and not ast.get_docstring(node)]
    assert not silent


ROOMS = [p for p in MODULES if p.name == "__init__.py"]


@pytest.mark.parametrize("path", ROOMS, ids=dotted)
def test_rooms_hand_out_what_they_promise(path):
    room = importlib.import_module(dotted(path))
    names = getattr(room, "__all__", ())
    assert len(set(names)) == len(names)
    assert all(hasattr(room, name) for name in names)


@pytest.mark.parametrize("path", ROOMS, ids=dotted)
def test_rooms_promise_what_they_import(path):
    """Whatever an `__init__` imports from its own files is in `__all__`: nothing is handed out by accident."""
    names = [alias.asname or alias.name for node in parsed(path).body
             if isinstance(node, ast.ImportFrom) and node.level for alias in node.names]
    assert set(names) <= set(getattr(importlib.import_module(dotted(path)), "__all__", ()))
