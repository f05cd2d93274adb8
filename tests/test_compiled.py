"""Compiled kernels: as fast the second time, and never those of other sources."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gambol.controllers import compiled

SOURCE = Path(compiled.__file__)


@pytest.fixture
def package(tmp_path):
    """A package of two files with kernels, one calling the other, compiled as ours are."""
    home = tmp_path / "pack"
    home.mkdir()
    (home / "__init__.py").write_text("")
    shutil.copy(SOURCE, home / "compiled.py")
    (home / "inner.py").write_text("from .compiled import kernel\n\n@kernel\ndef inner(x):\n    return x + 1\n")
    (home / "outer.py").write_text("from .compiled import kernel\nfrom .inner import inner\n\n"
                                   "@kernel(fastmath=True)\ndef outer(x):\n    return 10 * inner(x)\n")
    return home


def call(package, code="print(outer(1.0), sum(outer.stats.cache_hits.values()))"):
    """What some code prints in a new process that has the package."""
    done = subprocess.run([sys.executable, "-c", f"from pack.outer import outer\nimport pack.compiled as c\n{code}"],
                          cwd=package.parent, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def folders(package):
    return sorted(p.name for p in (package / "__pycache__").glob("kernels-*"))


def test_a_kernel_is_compiled_once_for_all_constants(package):
    (package / "outer.py").write_text("from .compiled import kernel\nfrom .inner import inner\n\n"
                                      "@kernel\ndef outer(x):\n    n = inner(1) + inner(x=2)\n"
                                      "    for _ in range(3):\n        n = inner(n)\n    return n\n")
    assert call(package, "from pack.inner import inner; print(outer(1.0), len(inner.signatures))") == ["8", "1"]


def touch(path, text):
    """Rewrite a file so that its time differs, as an editor would."""
    before = path.stat().st_mtime_ns
    path.write_text(text)
    os.utime(path, ns=(before + 10**9, before + 10**9))


def test_kernels_are_kept_and_found_again(package):
    assert call(package) == ["20.0", "0"]
    first = folders(package)
    assert len(first) == 1 and list((package / "__pycache__" / first[0]).rglob("*.nbi"))
    assert call(package) == ["20.0", "1"], "found in the cache"
    assert folders(package) == first


def test_a_change_in_another_file_is_seen(package):
    """The callee changes and the caller does not: numba alone would run the old one."""
    call(package)
    touch(package / "inner.py", (package / "inner.py").read_text().replace("x + 1", "x + 2"))
    assert call(package) == ["30.0", "0"]
    assert len(folders(package)) == 2


def test_folders_that_nobody_used_for_a_day_go_and_younger_ones_stay(package):
    """A younger one may belong to a program that still compiles into it."""
    call(package)
    first, = folders(package)
    touch(package / "inner.py", (package / "inner.py").read_text().replace("x + 1", "x + 2"))
    call(package)
    assert first in folders(package)
    aged(package / "__pycache__" / first)
    touch(package / "inner.py", (package / "inner.py").read_text().replace("x + 2", "x + 3"))
    call(package)
    assert first not in folders(package)


def aged(folder):
    """A folder as if nobody had touched it for two days."""
    then = time.time() - 2 * 86400.0
    os.utime(folder, (then, then))


def names(package, *changes):
    """The name of the cache folder before and after each change."""
    found = [call(package, "print(c.cache_folder().name)")[0]]
    for change in changes:
        change()
        found.append(call(package, "print(c.cache_folder().name)")[0])
    return found


def test_the_folder_is_named_after_all_sources(package):
    deep = package / "room" / "deep.py"

    def add():
        deep.parent.mkdir()
        deep.write_text("")
    found = names(package, add, lambda: touch(deep, "# same length"), lambda: touch(deep, "# SAME length"), deep.unlink)
    assert len(set(found[:4])) == 4, "added, changed in length, changed in time"
    assert found[4] == found[0], "and taken away again"


def test_what_is_no_source_does_not_matter(package):
    before, after = names(package, lambda: (package / "notes.txt").write_text("x"))
    assert before == after


def test_another_numba_has_another_folder(package):
    one, = call(package, "print(c.cache_folder().name)")
    other, = call(package, "c.numba.__version__ = 'other'; c.cache_folder.cache_clear(); print(c.cache_folder().name)")
    assert one != other


def test_installations_that_cant_be_written_to_keep_their_kernels_at_home_apart(package, tmp_path):
    """Each clears what is old of its own, and nothing of another."""
    other = shutil.copytree(package, tmp_path / "elsewhere" / "pack")
    home = tmp_path / "home"

    def cached(package):
        found, = call(package, f"""
c.os.access = lambda *a: False
c.Path.home = lambda: c.Path({str(home)!r})
c.cache_folder.cache_clear()
c.cache_folder().mkdir(parents=True, exist_ok=True)
print(c.cache_folder())""")
        return Path(found)
    mine, theirs = cached(package), cached(other)
    assert mine.is_dir() and theirs.is_dir() and mine != theirs
    assert home / ".cache" / "gambol" in mine.parents and home / ".cache" / "gambol" in theirs.parents
    aged(mine)
    aged(theirs)
    touch(package / "inner.py", "# another\n" + (package / "inner.py").read_text())
    newer = cached(package)
    assert newer.is_dir() and not mine.exists() and theirs.is_dir()


def test_the_setting_of_others_is_left_as_it_was(package):
    assert call(package, "import numba; print(repr(numba.config.CACHE_DIR))") == ["''"]
