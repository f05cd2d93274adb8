"""The house rules: controllers know no window, importing opens nothing, and every room says what it is for."""

import ast
import importlib
import re
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = sorted(p for wing in ("controllers", "game", "assets", "scripts", "tests") for p in (ROOT / wing).rglob("*.py")
                 if "__pycache__" not in p.parts)
WINGS = ("controllers", "game")
MODULES = [p for p in SOURCES if p.relative_to(ROOT).parts[0] in WINGS]


@cache
def parsed(path):
    """The source of a module as a tree."""
    return ast.parse(path.read_text("utf-8"))


@cache
def imports(path):
    """The imports of a module, wherever they stand: they are statements, so that no expression is looked into, which would take most of the time."""
    found, todo = [], [parsed(path)]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            found.append(node)
        todo += [inner for name in ("body", "orelse", "finalbody", "handlers", "cases") for inner in getattr(node, name, ())]
    return found


def dotted(path):
    """The name that a module is imported by."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(("gambol", *(parts[:-1] if parts[-1] == "__init__" else parts)))


FIRST = "gambol.game.world.world", "gambol.game.scenario.film", "gambol.game.app.app", "gambol.game.cli", "gambol.game.render", "gambol.game.hosts"
"""What whoever plays, films or draws imports."""


@cache
def loaded():
    """The modules that a new process without a display has loaded: with all of the controllers, and with what the game is begun by. That all else can
    be imported, too, where whatever would open a window or a context is made to fail first.
    """
    names = [dotted(p) for p in MODULES if not dotted(p).endswith("__main__")]
    library, theatre = ([name for name in names if name.startswith(f"gambol.{wing}")] for wing in WINGS)
    assert library and theatre
    done = subprocess.run([sys.executable, "-c", (
        "import importlib, sys\n"
        f"for n in {library}: importlib.import_module(n)\n"
        "print(*sys.modules)\n"
        f"for n in {FIRST}: importlib.import_module(n)\n"
        "print(*sys.modules)\n"
        "def never(*a, **k): raise AssertionError('opened at import')\n"
        "import glfw, moderngl\n"
        "glfw.init = glfw.create_window = moderngl.create_context = moderngl.create_standalone_context = never\n"
        f"for n in {theatre}: importlib.import_module(n)\n")], cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return [set(line.split()) for line in done.stdout.splitlines()]


def test_controllers_know_no_window_and_no_game():
    assert {"gambol.controllers.locomotion.step", "gambol.controllers.mocap.bvh"} <= loaded()[0]
    foreign = {"moderngl", "glfw", "game", "imgui_bundle", "OpenGL", "av", "PIL", "matplotlib", "tkinter"}
    assert not foreign & {name.split(".")[0] for name in loaded()[0]}


def test_importing_the_game_opens_no_window_and_no_context_and_loads_nothing_that_would():
    """No window, no GL: importing any of this must be safe on a machine without a display."""
    assert "gambol.game.hosts" in loaded()[1]
    assert not {"glfw", "moderngl", "av"} & loaded()[1]


def test_imports_run_one_way():
    """Game → controllers, never back; told from the sources, whatever is imported when."""
    for path in MODULES:
        if dotted(path).startswith("gambol.controllers"):
            for node in imports(path):
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else \
                    [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
                assert not any(n.split(".")[0] in ("game", "moderngl", "glfw") for n in names), path


NAMES = {dotted(p) for p in MODULES}


@cache
def taken(path):
    """What of ours a module takes, whenever it does: the module that it names, and the name that it takes from there."""
    own, found = dotted(path), []
    room = own if path.name == "__init__.py" else own.rpartition(".")[0]
    for node in imports(path):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names if alias.name in NAMES]
        elif isinstance(node, ast.ImportFrom):
            above = room.split(".")[:len(room.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*above, node.module] if node.module else above)
            found += [(source, alias.name) for alias in node.names if f"{source}.{alias.name}" in NAMES or source in NAMES]
    return found


def imported(path):
    """Those of our modules that a module imports."""
    return [f"{source}.{name}" if f"{source}.{name}" in NAMES else source for source, name in taken(path)]


PACKAGES = {dotted(p) for p in MODULES if p.name == "__init__.py"}
PLAN = {
    "controllers": {
        "compiled": "",
        "files": "",
        "body": "compiled",
        "contract": "body",
        "jump.body": "compiled body",
        "mocap": "compiled files body",
        "reconstruction.live": "files body",
        "navigation": "compiled body contract",
        "navigation.obstacles": "compiled",
        "navigation.routes": "compiled navigation.obstacles",
        "navigation.levels": "contract navigation.obstacles navigation.planning navigation.routes",
        "navigation.thinking": "body contract navigation.levels navigation.obstacles navigation.planning navigation.routes",
        "navigation.crowd": "compiled contract navigation.routes",
        "navigation.passing": "compiled body navigation.obstacles navigation.routes",
        "navigation.planning": "compiled files body navigation.obstacles navigation.routes",
        "navigation.identification": "files body navigation.planning",
        "reconstruction": "body contract driven",
        "driven": "body contract",
        "supervisor": "body contract navigation navigation.passing",
        "jump.muscles": "compiled jump.body",
        "jump.prior": "compiled files body jump.body mocap",
        "jump": "body contract navigation.passing",
        "tracking": "body contract driven files",
        "tracking.twists": "compiled body",
        "tracking.cameras": "compiled files body",
        "tracking.silhouettes": "compiled body tracking.twists tracking.cameras",
        "tracking.pose": "compiled body tracking.twists tracking.cameras tracking.silhouettes",
        "tracking.rivals": "tracking.twists",
        "tracking.segmentation": "compiled tracking.silhouettes",
        "locomotion": "compiled files body contract mocap navigation navigation.passing navigation.routes",
        "scaled": "body contract navigation",
        "jump.motion": "compiled body jump.body navigation navigation.passing jump.muscles jump.prior",
        "jump.reach": "body contract navigation jump.body jump.motion jump.muscles jump.prior",
        "jump.starting": "body contract navigation jump.body jump.motion jump.reach",
        "jump.asking": "contract navigation jump.body jump.motion jump.muscles jump.reach jump.starting",
        "struck": "compiled body contract mocap navigation navigation.passing jump jump.body jump.motion jump.prior",
        "reconstruction.database": "compiled files body contract mocap supervisor jump locomotion",
        "person": "compiled body contract jump.body navigation navigation.crowd navigation.passing navigation.planning supervisor jump.muscles jump locomotion scaled struck",
        "reconstruction.neighbours": "compiled reconstruction.database",
        "reconstruction.regression": "compiled body reconstruction.neighbours",
        "reconstruction.baselines": "body reconstruction.database reconstruction.neighbours reconstruction.regression",
        "reconstruction.following": "compiled contract body reconstruction.database reconstruction.regression reconstruction.footing",
        "reconstruction.footing": "compiled body",
        "reconstruction.ours": ("compiled body reconstruction.database reconstruction.neighbours reconstruction.regression "
                                "reconstruction.baselines reconstruction.following reconstruction.footing"),
        "reconstruction.trackers": ("compiled files body contract reconstruction.database reconstruction.regression reconstruction.baselines "
                                    "reconstruction.ours reconstruction.footing"),
        "reconstruction.calibration": ("compiled files body reconstruction.regression reconstruction.baselines reconstruction.trackers "
                                       "reconstruction.live"),
        "reconstruction.evaluation": ("body mocap reconstruction.database reconstruction.regression reconstruction.baselines "
                                      "reconstruction.ours"),
    },
    "game": {
        "scene": "",
        "files": "",
        "render": "scene",
        "character": "scene files render",
        "input": "scene files",
        "camera": "scene input",
        "hosts": "scene render input",
        "meshes": "scene render",
        "footage": "files meshes",
        "world": "scene render meshes input footage",
        "explain": "scene input world",
        "session": "scene files input camera world explain",
        "hud": "scene hosts world explain session",
        "scenario": "scene files footage input camera world explain session hud",
        "output": "scene files render character input world explain session scenario",
        "studio": "scene files render meshes footage world scenario output",
        "app": "scene files render input camera hosts world explain session hud output",
        "cli": "scene files meshes footage character input hosts world session scenario output studio app",
    },
}
"""The house plan: which room may use which others of its wing; the game may use every room of the controllers.

A room is a folder with a door, its `__init__`, or a single file that stands beside such folders. Files within a
room, and within the rooms in it, use each other freely.
"""
BESIDE = 5
"""At most so many files stand beside folders."""


def room_of(name):
    """The innermost folder that a module is in; itself where it stands beside the rooms of a wing."""
    folder = name if name in PACKAGES else name.rpartition(".")[0]
    return name if folder.count(".") == 1 else folder


def within(inner, outer):
    return inner == outer or inner.startswith(outer + ".")


def test_rooms_use_what_the_plan_says():
    """No more, so that what a room stands on stays small, and no less, so that the plan is true."""
    found = {wing: {} for wing in PLAN}
    for path in MODULES:
        wing, here = path.relative_to(ROOT).parts[0], room_of(dotted(path))
        if here == f"gambol.{wing}":
            continue
        used = {room_of(name) for name in imported(path) if name not in (f"gambol.{w}" for w in WINGS)}
        found[wing].setdefault(here, set()).update(
            room for room in used if within(room, f"gambol.{wing}") and not within(room, here) and not within(here, room))
    short = {wing: {room.removeprefix(f"gambol.{wing}."): {u.removeprefix(f"gambol.{wing}.") for u in used}
                    for room, used in rooms.items()} for wing, rooms in found.items()}
    assert short == {wing: {room: set(used.split()) for room, used in rooms.items()} for wing, rooms in PLAN.items()}


def test_the_plan_has_no_circle():
    for rooms in PLAN.values():
        tuple(TopologicalSorter({room: used.split() for room, used in rooms.items()}).static_order())  # or CycleError


OUTSIDE = [p for p in SOURCES if p.relative_to(ROOT).parts[0] != "tests"]


def test_nothing_reaches_past_a_door():
    """What is outside a room takes what it needs from the room's door; tests alone may look into it."""
    assert not [f"{dotted(path)} takes {source}" for path in OUTSIDE for source, _ in taken(path)
                if source != room_of(source) and not within(dotted(path), room_of(source))]


def test_few_files_stand_beside_folders():
    for folder in {path.parent for path in SOURCES if "tests" not in path.relative_to(ROOT).parts}:
        rooms = [p for p in folder.iterdir() if p.is_dir() and any(p.glob("*.py"))]
        files = [p.name for p in folder.glob("*.py") if p.name != "__init__.py"]
        assert not rooms or len(files) <= BESIDE, f"{folder.relative_to(ROOT)}: {files}"


def test_no_two_files_are_called_the_same_in_a_wing():
    """But for what every method has."""
    for wing in WINGS:
        names = [path.stem for path in MODULES if path.relative_to(ROOT).parts[0] == wing and path.name not in ("__init__.py", "__main__.py")]
        twice = {name for name in names if names.count(name) > 1}
        assert twice <= {"controller"}


def test_nobody_guesses_what_a_controller_has():
    """What the game asks of a controller is in the contract, with a null answer."""
    guesses = [(path, node) for path in MODULES if re.search(r"\b(get|has)attr\(", path.read_text("utf-8")) for node in ast.walk(parsed(path))
               if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("getattr", "hasattr")]
    assert not [f"{dotted(path)}: {ast.unparse(node)}" for path, node in guesses
                if re.search(r"(controller|performer|someone|state\.memory)$", ast.unparse(node.args[0]))]


def test_nothing_imports_what_imports_it():
    """No ring of modules, however late they import each other."""
    wings = {f"gambol.{wing}" for wing in WINGS}
    needs = {dotted(path): set(imported(path)) - {dotted(path)} - wings for path in MODULES if path.name != "__init__.py"}
    assert "gambol.controllers.body" in needs["gambol.controllers.supervisor"]
    tuple(TopologicalSorter({m: {n for n in used if n in needs} for m, used in needs.items()}).static_order())  # or CycleError


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


def test_every_module_says_what_it_is_for():
    assert not [dotted(path) for path in MODULES if not ast.get_docstring(parsed(path))]


def test_public_functions_and_classes_say_what_they_do():
    assert not [f"{dotted(path)}.{node.name}" for path in MODULES for node in parsed(path).body
                if isinstance(node, ast.FunctionDef | ast.ClassDef)
                and not node.name.startswith("_") and not ast.get_docstring(node)
                and "overload" not in map(ast.unparse, node.decorator_list)]  # which only says types again


ROOMS = [p for p in MODULES if p.name == "__init__.py"]


def promised(path):
    """A room, and what its `__all__` says that it hands out."""
    room = importlib.import_module(dotted(path))
    return room, list(getattr(room, "__all__", ()))


def test_rooms_hand_out_what_they_promise():
    for path in ROOMS:
        room, names = promised(path)
        assert len(set(names)) == len(names), dotted(path)
        assert not [name for name in names if not hasattr(room, name)], dotted(path)


def test_rooms_promise_what_they_import():
    """Whatever an `__init__` imports from its own files is in `__all__`: nothing is handed out by accident."""
    for path in ROOMS:
        names = [alias.asname or alias.name for node in parsed(path).body
                 if isinstance(node, ast.ImportFrom) and node.level for alias in node.names]
        assert set(names) <= set(promised(path)[1]), dotted(path)
