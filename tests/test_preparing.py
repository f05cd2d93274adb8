"""What is compiled beside a game: in which order, and that nobody waits for one who has ended."""

import inspect
import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from gambol.controllers.person import preparing
from gambol.controllers.locomotion import Locomotion


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(preparing, "cache_folder", lambda: tmp_path)
    return tmp_path


@pytest.fixture
def told(monkeypatch, folder):
    """What is compiled, in order, and what is ready by then, without compiling it."""
    order = []
    monkeypatch.setattr(preparing.gc, "disable", lambda: None)

    def noted(name):
        return lambda *about, **more: order.append((name, {path.stem.partition("-")[0] for path in folder.glob("*.ready")}))
    for name in ("feet", "weight", "strength", "rest", "place", "beside", "things", "measures", "rehearse"):
        monkeypatch.setattr(preparing, name, noted(name))
    return order


def done(walker):
    """Everything is compiled."""
    for part in preparing.PARTS:
        preparing._note(part, walker)


def test_a_part_is_ready_once_it_is_compiled_for_that_library(folder):
    walker = Locomotion.load()
    assert not any(preparing.ready(part, walker) for part in preparing.PARTS)
    done(walker)
    assert all(preparing.ready(part, walker) for part in preparing.PARTS)
    walker.library = type("Another", (), {"primitives": walker.library.primitives[:-1]})
    assert preparing.ready("jump", walker) and not preparing.ready("walk", walker)


def test_what_is_compiled_ahead_is_what_a_step_calls(monkeypatch):
    """Kernels are named with what they are told: as many things as they take."""
    told = []
    monkeypatch.setattr(preparing, "_compile", lambda kernel, *like: told.append(
        inspect.signature(getattr(kernel, "py_func", kernel)).bind(*like)))
    preparing.feet(Locomotion.load())
    preparing.rest(Locomotion.load())
    assert len(told) >= 5


def test_walking_is_ready_before_jumping(told, monkeypatch, folder):
    monkeypatch.setattr(preparing.sys, "stdin", io.StringIO("feet\nweight\nstrength\n"))
    preparing.main("person")
    assert told == [("rest", set()), ("place", set()), ("beside", set()), ("weight", set()), ("things", {"walk"}), ("measures", {"walk"}), ("rehearse", {"walk"})]
    assert all(preparing.ready(part, Locomotion.load()) for part in preparing.PARTS)


def test_nobody_waits_for_a_program_that_has_ended(told, monkeypatch):
    monkeypatch.setattr(preparing.sys, "stdin", io.StringIO(""))
    preparing.main("person")
    assert [name for name, _ in told] == ["rest", "place", "beside", "weight", "things", "measures", "rehearse"]


def test_what_comes_ahead_is_said_and_claims_nothing(told, capsys, folder):
    preparing.main("ahead")
    assert capsys.readouterr().out.split() == ["feet", "weight", "strength"] and [name for name, _ in told] == ["feet", "weight", "strength"]
    assert not list(folder.glob("*.ready"))


def test_where_nothing_can_be_kept_nothing_is_ready(monkeypatch):
    monkeypatch.setattr(preparing, "cache_folder", lambda: Path("there is no such folder"))
    walker = Locomotion.load()
    done(walker)
    assert not preparing.ready("walk", walker) and preparing.share() == 0.0


def test_how_far_it_is_grows_and_never_says_that_all_is_done(folder):
    shares = []
    for number in range(2 * preparing.KERNELS):
        shares.append(preparing.share())
        (folder / f"{number}.nbc").touch()
    assert shares[0] == 0.0 and shares == sorted(shares) and shares[-1] < 1.0


def test_programs_are_begun_only_for_what_was_never_compiled_here(folder, monkeypatch):
    begun, walker = [], Locomotion.load()

    class Program:
        stdout = io.StringIO()

    monkeypatch.setattr(preparing, "_program", lambda part, arguments, *pipes: begun.append((part, *arguments)) or Program())
    assert len(preparing.begun(walker, Path("mine.npz"))) == 2 and begun == [("ahead", "mine.npz"), ("person", "mine.npz")]
    done(walker)
    assert preparing.begun(walker) == () and len(begun) == 2


def test_a_program_runs_in_a_process_of_its_own_wherever_one_is(tmp_path, monkeypatch, capfd):
    """And Ctrl+C is for who began it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gambol.py").write_text("raise RuntimeError('not ours')")
    program = preparing._program("ahead", ("there is no such library",), None, None)
    assert sys.platform == "win32" or os.getpgid(program.pid) != os.getpgid(0)
    assert program.wait() == 1
    assert "LibraryError: there is no such library" in capfd.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="has no groups of processes")
def test_a_program_ends_with_who_began_it():
    begins = """if True:
        import subprocess, sys
        from gambol.controllers.person import preparing
        begun = subprocess.Popen
        preparing.subprocess.Popen = lambda words, **more: begun([sys.executable, "-c", "import time; time.sleep(60)"], **more)
        preparing._program("person", (), None, None)
        raise KeyboardInterrupt
    """  # whoever still runs holds its output, which is read to the end
    subprocess.run([sys.executable, "-c", begins], capture_output=True, timeout=30)


PLAYED = '''
import sys
from types import SimpleNamespace
import numpy as np
from gambol.controllers.contract import Goal, Intent, Leap, Strike, but
from gambol.controllers.person import person, rehearse
from gambol.game.scenario import film, load

def loaded():
    return {name for name in sys.modules if name.partition(".")[0] in ("gambol", "scipy")}

def compiled():
    return {f"{name}.{key}": len(value.signatures) for name, module in list(sys.modules.items()) if name.startswith("gambol")
            for key, value in list(vars(module).items()) if isinstance(getattr(value, "signatures", None), list)}

def played(intent, steps, state=None):
    state = somebody.start() if state is None else state
    for k in range(steps):
        state, _ = somebody.step(state, intent(k, state), 1 / 60)
    return state

somebody = person()
rehearse(somebody)
box = SimpleNamespace(centre=(0.0, 0.15, 3.0), size=(3.0, 0.3, 3.0), heading=0.0)
wall = SimpleNamespace(centre=(0.6, 1.0, 1.0), size=(0.2, 2.0, 3.0), heading=0.0)
rooms = [SimpleNamespace(centre=(x, 0.5, z), size=(0.6, 1.0, 0.6), heading=0.3 * x) for x, z in ((-1.5, 2.0), (0.0, 2.5), (1.2, 2.0), (-0.6, 4.0), (0.8, 4.2))]
block = SimpleNamespace(centre=(0.0, 0.3, 2.0), size=(2.0, 0.6, 1.5), heading=0.0)
before, parts = compiled(), loaded()
run = played(lambda k, s: Intent(np.array([3.2, 0.0, 0.0])), 150)
place = np.array([run.ground[0], 0.0, run.ground[1] + 2.0])
played(lambda k, s: Intent(np.array([3.2, 0.0, 0.0]), leap=Leap(place) if k < 40 and s.active != "jump" else None), 100, run)
played(lambda k, s: Intent(np.array([1.2, 0.3, 0.0]), around=(box, wall)), 150)
played(lambda k, s: Intent(leap=Leap(np.array([0.0, 0.0, 0.9])) if k < 20 else None), 90)
played(lambda k, s: Intent(strike=Strike((250.0, 0.0)) if k == 5 else None), 200)
played(lambda k, s: Intent(goal=Goal((1.0, 3.0), 1.0), around=(box,)), 200)
played(lambda k, s: Intent(goal=Goal((0.0, 5.2)), around=rooms), 60)
played(lambda k, s: Intent(goal=Goal((0.0, 2.0)), around=(block,)), 200)
late = loaded() - parts
for act, _ in zip(film.acts(load("together"), somebody), range(60)):
    pass
after = compiled()
print(*sorted(late | {name for name in after if after[name] != before.get(name, 0)}))
'''


@pytest.mark.skipif(bool(os.environ.get("NUMBA_DISABLE_JIT")), reason="nothing is compiled here")
def test_nothing_that_was_prepared_halts_a_game():
    """A program that has rehearsed compiles, or loads, nothing more as somebody walks past things, runs, leaps, lands at a run, is struck and goes somewhere: past
    things, onto a block and among others."""
    told = subprocess.run([sys.executable, "-c", PLAYED], capture_output=True, text=True, timeout=600)
    assert (told.returncode, told.stdout.split()) == (0, []), told.stderr[-600:] + told.stdout
