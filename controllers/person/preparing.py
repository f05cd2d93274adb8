"""Compiling what a person needs, once, in programs beside a game, which finds it on disk afterwards.

One program, `main("person")`, compiles all of a walk, then of a jump and of walks to goals. Three lumps of it come from another, `main("ahead")`,
which it hears on its standard input, so that two cores walk in half the time: what places feet, what weighs a body, and how strong it is.
Compiling holds the interpreter's lock: threads would not do.
"""

from __future__ import annotations

import atexit
import gc
import os
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path as File
from types import SimpleNamespace
from typing import Any

import numba
import numpy as np

from ..body import Pose, anatomy, centre_in_pose, forward_kinematics
from ..compiled import cache_folder, cache_home
from ..contract import Intent
from ..jump import Jump, rehearse
from ..jump.body import measures
from ..jump.muscles import strength
from ..locomotion import COLUMNS, SCRATCH, Locomotion, memory_dtype, step
from ..navigation import Path, clearance, floors_at, follow, room, slide
from ..navigation.crowd import avoid
from ..navigation.passing import NEAR, drawn_in, slow_kernel, walls_of, way_kernel
from ..struck import Struck, rehearse as rehearse_strike

PARTS = ("walk", "jump")
KERNELS = 402
"""So many kernels are compiled for both parts, about: for those only who ask how far it is."""


BOX = SimpleNamespace(centre=(0.0, 1.0, 0.6), size=(2.0, 2.0, 0.2), heading=0.0)
POST = SimpleNamespace(foot=(0.2, 0.0, 0.3), radius=0.1, height=2.0)
"""What stands about somebody for whom it is compiled."""
LATE = "scipy.ndimage", "scipy.optimize", "scipy.sparse.csgraph"
"""What rolls, leaps off a run and ways over several levels load, as a game starts without."""


def begun(walker: Locomotion, library: File | None = None) -> tuple[subprocess.Popen, ...]:
    """The programs that compile a person, begun: the one to wait for first; none where everything was compiled before.

    library: the walker's file, None for the shipped one.
    """
    if all(ready(part, walker) for part in PARTS):
        return ()
    arguments = () if library is None else (str(library),)
    ahead = _program("ahead", arguments, subprocess.DEVNULL, subprocess.PIPE)
    person = _program("person", arguments, ahead.stdout, None)
    assert ahead.stdout is not None  # it is a pipe
    ahead.stdout.close()
    return person, ahead


def _program(part: str, arguments: tuple[str, ...], heard: Any, said: Any) -> subprocess.Popen:
    code = f"import sys; from {__package__} import preparing; preparing.main(*sys.argv[1:])"
    # Ctrl-C is for whoever began it, who ends it; what was compiled by then is kept
    apart: Any = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP} if sys.platform == "win32" else {"process_group": 0}
    program = subprocess.Popen([sys.executable, "-P", "-c", code, part, *arguments], stdin=heard, stdout=said, **apart,
                               env=os.environ | {"GAMBOL_CACHE": str(cache_home()), "OPENBLAS_NUM_THREADS": "1"})
    atexit.register(program.terminate)  # which does nothing to one that has ended
    return program


def ready(part: str, walker: Locomotion) -> bool:
    """Whether all that a part needs, with a walker's library, was compiled here before."""
    return _mark(part, walker).exists()


def share() -> float:
    """How much of everything is compiled, about: 0 … 0.99."""
    return min(sum(1 for _ in cache_folder().glob("*.nbc")) / KERNELS, 0.99)


def _mark(part: str, walker: Locomotion):
    """A character's memory, and with it every kernel of a step, is as long as the library has primitives."""
    length = f"-{len(walker.library.primitives)}" if part == "walk" else ""
    return cache_folder() / f"{part}{length}.ready"


def _note(part: str, walker: Locomotion) -> None:
    try:
        _mark(part, walker).touch()
    except OSError:  # nothing can be kept
        pass


def feet(walker: Locomotion) -> None:
    """Compile what places the feet: half of a step."""
    memory, body, legs, places, turns, local, dt = _some(walker)
    ahead = step.room_to_plan(memory["weights"].size, len(local))
    _compile(step.place_feet, memory, body, legs, ahead, walker.settings.clearance, np.zeros((0, 9)), 0.0, np.zeros((4, 2)), places, turns, local,
             dt, np.zeros((5, 3, 3)))


def rest(walker: Locomotion) -> None:
    """Compile what a step needs before it places the feet."""
    memory, body, legs, places, turns, local, dt = _some(walker)
    _, _, walk, run, table, changes, _, start, turning, _ = walker.tables
    settings, row, three = walker.settings, np.zeros(COLUMNS, np.float32), np.zeros(3)
    _compile(step._weigh, memory, settings, dt, walk, run, table, changes, row, np.zeros(4), three, three, three)
    _compile(step.shape_command, memory, three, dt, dt, settings, table, walk, run, legs.stance, three, three)
    _compile(step.plan_footholds, memory, settings, walk, table, turning, body, legs, step.room_to_plan(memory["weights"].size, len(local)),
             True, dt)
    _compile(step.blend_series, memory, settings, table, row, legs, dt)
    _compile(step.turned_row, memory, turning, dt, row)
    _compile(step.pose_kernel, body, row, local, places, turns, np.zeros(SCRATCH, np.float32))
    _compile(step.begin_turn, memory, turning, three, row)
    _compile(step.lead_turn, memory, turning, dt, dt)
    _compile(step.start_kernel, memory, start, three, dt)
    _compile(step.add_start, memory, start, row)
    _compile(step.follow_command, memory, dt)


def place(walker: Locomotion) -> None:
    """Compile, or load, a step as a whole, and what places a body to be drawn."""
    pose = walker.start().pose
    for root in (pose.root, np.asarray(pose.root, float)):
        for turns in (pose.rotations, np.asarray(pose.rotations, float)):
            forward_kinematics(walker.skeleton, root, turns)


def weight(walker: Locomotion) -> None:
    """Compile, or load, what weighs a body as it stands."""
    turns = np.tile(np.eye(3, dtype=np.float32), (len(walker.skeleton), 1, 1))
    centre_in_pose(anatomy(walker.skeleton), walker.skeleton, Pose(np.zeros(3, np.float32), turns))


def beside(walker: Locomotion) -> tuple[Any, Any]:
    """Compile, or load, a step beside things, which a game's first one is. One, and its pose."""
    return walker.step(walker.start(), Intent(np.array([1.0, 0.0, 0.0]), around=(BOX, POST)), 1.0 / 60.0)


def things(walker: Locomotion) -> None:
    """Compile, or load, what keeps somebody who walks from what stands about and from others, and what sets him down at a run."""
    clearance(np.zeros((1, 3)), (BOX, POST))
    floors_at(np.zeros((1, 2)), (BOX, POST))
    slide(np.zeros(2), np.array([0.0, 1.0]), 0.0, (BOX, POST))
    room(np.zeros(2), 0.0, (BOX, POST))
    walls = walls_of((BOX, POST))
    slow_kernel(walls, 0.0, 0.0, 0.0, 0.0, np.array([0.0, 1.0]), NEAR, 0.0, 1.0, 0.0)
    way_kernel(walls, 0.0, 0.0, 0.0, np.array([0.0, 1.0]), NEAR, 1.0, np.empty(3))
    follow(Path(np.array([[0.0, 0.0], [0.0, 1.0]])), np.zeros(3), np.float64(0.0), 1.0)
    grounds = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    avoid(grounds[:, :2], np.zeros((2, 2)), np.ones((2, 2)), 0.3, (BOX, POST), grounds[:, 2])
    state, pose = beside(walker)
    intent = Intent(np.array([1.0, 0.0, 0.0]), around=(BOX, POST))
    drawn_in(walker.skeleton, pose, state.ground, (BOX, POST))
    walker.enter(replace(state, memory=None, contacts=np.arange(4) < 2, velocity=np.array([2.0, 0.0, 0.0]), previous=pose, elapsed=1.0 / 60.0), intent)


def goals() -> None:
    """Compile, or load, what plans a way to a goal, over several levels and by leaps, too."""
    from ..navigation import planning  # loads what a game starts without

    planning.rehearse()
    for name in LATE:
        import_module(name)


def _some(walker: Locomotion) -> tuple[Any, ...]:
    """What the parts of a step are told of: a character's memory, its body and legs, places and turns of joints, a pose,
    a time."""
    joints = len(walker.skeleton)
    turns = np.zeros((joints, 3, 3), np.float32)
    memory = np.zeros(1, memory_dtype(len(walker.library.primitives)))[0]
    return memory, *walker.tables[:2], np.zeros((joints, 3), np.float32), turns, turns, 1.0 / 60.0


def _compile(kernel: Any, *like: Any) -> None:
    """Compile a kernel for arguments like these, without running it."""
    if hasattr(kernel, "compile"):  # a plain function has none, where compiling is switched off
        kernel.compile(tuple(numba.typeof(one) for one in like))


def main(part: str, library: str = "") -> None:
    """Compile what a person needs, or, of that, what comes "ahead"."""
    gc.disable()  # a compiler makes millions of small things that stay: to look for garbage takes a sixth of its time
    walker, jump = Locomotion.load(library or None), Jump()
    if part == "ahead":
        feet(walker)
        print("feet", flush=True)
        weight(walker)
        print("weight", flush=True)
        strength(jump.physique)
        print("strength", flush=True)
        return
    rest(walker)
    sys.stdin.readline()  # the other program has the feet, or has ended
    place(walker)
    beside(walker)
    sys.stdin.readline()  # and the weight
    weight(walker)
    _note("walk", walker)
    things(walker)
    measures(jump.physique)
    sys.stdin.readline()  # and the strength
    rehearse(jump)
    rehearse_strike(Struck())
    goals()
    _note("jump", walker)
