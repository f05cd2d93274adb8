"""Compiled kernels: as fast the second time, wherever the sources lie, and never those of other sources or damaged ones."""

import importlib
import os
import pkgutil
import shutil
import sys
import time
from pathlib import Path

import pytest

from numba.core.dispatcher import Dispatcher

from gambol import controllers
from gambol.controllers import compiled
from gambol.controllers.compiled import cache_places, ingredients

import fresh_process
from fresh_process import Fresh

SOURCE = Path(compiled.__file__).parent


@pytest.fixture
def package(tmp_path):
    """A package of two files with kernels, one calling the other, compiled as ours are."""
    home = tmp_path / "code" / "pack"
    home.mkdir(parents=True)
    (home / "__init__.py").write_text("")
    shutil.copytree(SOURCE, home / "compiled", ignore=shutil.ignore_patterns("__pycache__"))
    (home / "inner.py").write_text("from .compiled import kernel\n\n@kernel\ndef inner(x):\n    return x + 1\n")
    (home / "outer.py").write_text("from .compiled import kernel\nfrom .inner import inner\n\n"
                                   "@kernel(fastmath=True)\ndef outer(x):\n    return 10 * inner(x)\n")
    return home


@pytest.fixture(scope="module", autouse=True)
def server():
    fresh_process.ready()


@pytest.fixture(autouse=True)
def kept(tmp_path, monkeypatch):
    """A folder of the tests' own for what is compiled."""
    monkeypatch.setenv("GAMBOL_CACHE", str(tmp_path / "kept"))
    return tmp_path / "kept"


CALLED = "print(outer(1.0), sum(outer.stats.cache_hits.values()))"


def begun(package, code=CALLED):
    """A new process that has the package and runs some code."""
    return Fresh(f"from pack.outer import outer\nimport pack.compiled as c\n{code}", package.parent,
                 GAMBOL_CACHE=os.environ["GAMBOL_CACHE"])


def call(package, code=CALLED):
    """What some code prints in a new process that has the package."""
    return begun(package, code).said().split()


def folders(kept):
    return sorted(kept.glob("kernels-*"))


def changed(path, before, after):
    """Another text in a file, a second later, or Python's own cache would not see it."""
    text, then = path.read_text(), path.stat().st_mtime_ns + 10**9
    assert before in text
    path.write_text(text.replace(before, after))
    os.utime(path, ns=(then, then))


def test_a_kernel_is_compiled_once_for_all_constants(package):
    (package / "outer.py").write_text("from .compiled import kernel\nfrom .inner import inner\n\n"
                                      "@kernel\ndef outer(x):\n    n = inner(1) + inner(x=2)\n"
                                      "    for _ in range(3):\n        n = inner(n)\n    return n\n")
    assert call(package, "from pack.inner import inner; print(outer(1.0), len(inner.signatures))") == ["8", "1"]


def test_kernels_are_kept_and_found_again(package, kept):
    assert call(package) == ["20.0", "0"]
    first, = folders(kept)
    assert len(list(first.glob("*.nbc"))) == 2 and len(list(first.iterdir())) == 2, "and nothing half written"
    assert call(package) == ["20.0", "1"], "found in the cache"
    assert folders(kept) == [first]


def test_copies_with_other_times_share_one_cache(package, kept, tmp_path):
    """A checkout, an installation and the tests: what counts is what the files hold."""
    call(package)
    other = shutil.copytree(package, tmp_path / "elsewhere" / "pack")
    for n, path in enumerate(other.glob("*.py")):
        os.utime(path, (10.0**9 + n, 10.0**9 + n))
    assert call(other) == ["20.0", "1"]
    assert len(folders(kept)) == 1


def test_a_change_in_another_file_is_seen(package, kept):
    """The callee changes by one byte and the caller does not: numba alone would run the old one."""
    call(package)
    changed(package / "inner.py", "x + 1", "x + 2")
    assert call(package) == ["30.0", "0"]
    assert len(folders(kept)) == 2


RICH = """from collections import namedtuple
import numpy as np
from . import inner as room
from .compiled import kernel

Two = namedtuple("Two", "a b")
TABLE, PAIR = np.array([1.0, 2.0]), Two(3.0, 4.0)
NAMES = ("one", "other")

def plain():
    return 1.0

def made(factor):
    @kernel
    def within(x):
        return x * factor
    return within

within = made(2.0)

@kernel
def helped(x, more=5.0):
    '''Text.'''
    return x + more + 0.0  # a remark

@kernel(fastmath={"nnan"})
def outer(x):
    return outer_of(Two(x, 1.0))

@kernel
def outer_of(two):
    return TABLE[1] + PAIR.b + room.FACTOR * helped(two.a) + within(two.b) + (0.0 if "one" in NAMES else 7.0)
"""


@pytest.fixture
def rich(package):
    """A package whose kernels name all kinds of things."""
    (package / "outer.py").write_text(RICH)
    with (package / "inner.py").open("a") as inner:
        inner.write("\nFACTOR = 10.0\n")
    assert call(package) == ["68.0", "0"]
    return package


@pytest.mark.parametrize("before, after", (
    ("# a remark", "# another"), ("Text.", "Other words."), ("\ndef plain", "\n\n\n\ndef plain"), ("return 1.0", "return 2.0"), ("def plain():", "def other(name):")))
def test_what_makes_no_other_code_compiles_nothing(rich, kept, before, after):
    """A comment, a docstring, lines above it, another function: a kernel is taken over from the sources before."""
    changed(rich / "outer.py", before, after)
    assert call(rich) == ["68.0", "1"] and len(folders(kept)) == 2
    shutil.rmtree(folders(kept)[0])
    assert call(rich) == ["68.0", "1"], "and is kept with the new ones, when the old ones go"


@pytest.mark.parametrize("name, before, after, says", (
    ("outer", "np.array([1.0, 2.0])", "np.array([1.0, 3.0])", "69.0"), ("outer", "Two(3.0, 4.0)", "Two(3.0, 5.0)", "69.0"),
    ("outer", '"a b"', '"b a"', None), ("outer", "more=5.0", "more=6.0", "78.0"), ("outer", "made(2.0)", "made(3.0)", "69.0"),
    ("outer", '("one", "other")', '("none", "other")', "75.0"), ("outer", "+ 0.0  #", "+ 1.0  #", "78.0"), ("outer", "x * factor", "x + factor", "69.0"),
    ("outer", "nnan", "ninf", "68.0"), ("inner", "FACTOR = 10.0", "FACTOR = 20.0", "128.0")))
def test_what_makes_other_code_compiles_it(rich, name, before, after, says):
    """A constant's value, fields in another order, a callee's default, what a function closes over, an option, a constant of another module."""
    changed(rich / f"{name}.py", before, after)
    now = call(rich)
    assert now[1] == "0" and now[0] == (says or now[0])


def test_what_a_named_tuple_holds_counts_where_one_is_told(rich):
    """Its type is named alike whatever its fields are called."""
    told = "from pack.outer import Two, outer_of; print(outer_of(Two(1.0, 1.0)), sum(outer_of.stats.cache_hits.values()))"
    before = call(rich, told)
    changed(rich / "outer.py", "# a remark", "# another")
    assert call(rich, told) == [before[0], "1"]
    changed(rich / "outer.py", '"a b"', '"b a"')
    assert call(rich, told)[1] == "0"


def test_what_cannot_be_told_goes_with_all_sources(rich):
    """A class of ours may hold anything."""
    changed(rich / "outer.py", "room.FACTOR", "Kind.FACTOR.value")
    changed(rich / "outer.py", "from . import inner as room", "import enum\n\nclass Kind(enum.IntEnum):\n    FACTOR = 10")
    first = call(rich)
    assert call(rich) == [first[0], "1"]
    changed(rich / "outer.py", "# a remark", "# another")
    assert call(rich) == [first[0], "0"]


def test_what_our_own_kernels_are_made_of_can_be_told():
    """Else all of those, and their callers, would be compiled for every change of any source."""
    for module in pkgutil.walk_packages(controllers.__path__, f"{controllers.__name__}."):
        importlib.import_module(module.name)
    kernels = {value for name, module in list(sys.modules.items()) if name.startswith(controllers.__name__)
               for value in vars(module).values() if isinstance(value, Dispatcher)}
    assert len(kernels) > 400 and len({ingredients.ingredients(kernel, ()) for kernel in kernels}) == len(kernels)


@pytest.mark.parametrize("damage", (lambda data: b"", lambda data: data[:3], lambda data: data[:len(data) // 2],
                                    lambda data: b"garbage" * 1000, lambda data: data[:-100] + bytes(100),
                                    lambda data: b"\0\0\0\0"),
                         ids=("emptied", "torn off at once", "torn in two", "garbage", "a block of zeros", "only zeros"))
def test_what_is_damaged_is_compiled_anew(package, kept, damage):
    call(package)
    files = sorted(folders(kept)[0].glob("*.nbc"))
    for path in files:
        path.write_bytes(damage(path.read_bytes()))
    assert call(package) == ["20.0", "0"], "not found, and not fatal"
    assert call(package) == ["20.0", "1"], "and whole again"
    assert sorted(folders(kept)[0].glob("*.nbc")) == files


def test_several_programs_may_compile_the_same_at_once(package, kept):
    programs = [begun(package) for _ in range(4)]
    assert all(program.said().startswith("20.0") for program in programs)
    assert len(list(folders(kept)[0].iterdir())) == 2
    assert call(package) == ["20.0", "1"]


def test_where_nothing_can_be_kept_it_runs_all_the_same(package, kept, tmp_path):
    """And leaves nothing behind."""
    kept.write_text("a file stands where the folder should be")
    folder, *ran = call(package, f"print(c.cache_home())\n{CALLED}")
    assert ran == ["20.0", "0"] and not Path(folder).exists()


@pytest.mark.parametrize("home, says", [("file/cache", "file/cache: can't be written, so what is compiled"), ("~", "you have no home folder, so what is compiled")])
def test_where_nothing_can_be_kept_it_is_told(monkeypatch, tmp_path, home, says):
    """Else a minute goes in every start, and nobody knows why; and no folder is called ~."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    monkeypatch.setattr(cache_places, "cache_home", cache_places.cache_home.__wrapped__)
    monkeypatch.setattr(cache_places, "usual_home", lambda: tmp_path / home if home != "~" else Path("~/.cache/gambol"))
    assert says in compiled.forgets() and "GAMBOL_CACHE" in compiled.forgets()
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    monkeypatch.setattr(cache_places, "usual_home", lambda: tmp_path / "new")
    assert compiled.forgets() == ""


def test_a_full_disk_keeps_nothing_and_ends_nothing(package, kept):
    assert call(package, f"import os\ndef full(*paths): raise OSError(28, 'no space left')\nos.replace = full\n{CALLED}") == [
        "20.0", "0"]
    assert list(folders(kept)[0].iterdir()) == []


def versions(package, kept, count):
    """The folders of so many versions of the sources, of which all but the last were used days ago, the first first."""
    found = []
    for n in range(count):
        changed(package / "inner.py", f"x + {n + 1}", f"x + {n + 2}")
        call(package)
        found += [folder for folder in folders(kept) if folder not in found]
    for n, folder in enumerate(found[:-1]):
        then = time.time() - (20 - n) * 86400.0
        os.utime(folder, (then, then))
    return found


def test_old_versions_that_nobody_used_go_but_for_the_last_few(package, kept):
    found = versions(package, kept, 5)
    call(package)
    assert set(folders(kept)) == set(found[-3:])


def test_versions_that_were_used_today_stay(package, kept):
    """One may belong to a program that still runs; and to use one is enough, nothing need be compiled for it."""
    found = versions(package, kept, 5)
    for n in range(5, 1, -1):  # back to the first version
        changed(package / "inner.py", f"x + {n + 1}", f"x + {n}")
    assert call(package)[1] == "1"
    assert found[0] in folders(kept)


def names(package, *changes):
    """The name of the cache folder before and after each change."""
    found = [call(package, "print(c.cache_folder().name)")[0]]
    for change in changes:
        change()
        found.append(call(package, "print(c.cache_folder().name)")[0])
    return found


def test_the_folder_is_named_after_all_sources(package):
    deep, moved = package / "room" / "deep.py", package / "room" / "deeper.py"

    def add():
        deep.parent.mkdir()
        deep.write_text("")
    found = names(package, add, lambda: deep.write_text("# same length"), lambda: deep.write_text("# SAME length"),
                  lambda: deep.rename(moved), moved.unlink)
    assert len(set(found[:5])) == 5, "added, changed in length, changed in content, renamed"
    assert found[5] == found[0], "and taken away again"


def test_what_is_no_source_does_not_matter(package):
    before, after = names(package, lambda: (package / "notes.txt").write_text("x"))
    assert before == after


def test_another_numba_has_another_folder(package):
    one, = call(package, "print(c.cache_folder().name)")
    other, = call(package, "import pack.compiled.cache_places as p; p.TOOLS = 'other'; c.cache_folder.cache_clear(); print(c.cache_folder().name)")
    assert one != other


@pytest.mark.parametrize("platform, places, expected", (
    ("linux", {}, "~/.cache/gambol"),
    ("linux", {"XDG_CACHE_HOME": "/cache/mine"}, "/cache/mine/gambol"),
    ("linux", {"XDG_CACHE_HOME": "relative"}, "~/.cache/gambol"),
    ("darwin", {}, "~/Library/Caches/gambol"),
    ("win32", {"LOCALAPPDATA": "/C/Local"}, "/C/Local/gambol"),
    ("win32", {"GAMBOL_CACHE": "/D/mine"}, "/D/mine"),
    ("linux", {"GAMBOL_CACHE": "~/mine"}, "~/mine"),
))
def test_it_lies_where_programs_keep_such_things(monkeypatch, platform, places, expected):
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "GAMBOL_CACHE"):
        monkeypatch.delenv(name, raising=False)
    for name, place in places.items():
        monkeypatch.setenv(name, place)
    monkeypatch.setattr(cache_places.sys, "platform", platform)
    assert cache_places.usual_home() == Path(expected).expanduser()


def test_the_setting_of_others_is_left_as_it_was(package):
    assert call(package, "import numba; print(repr(numba.config.CACHE_DIR))") == ["''"]
