"""Play five minutes by synthetic hands, keep the log, replay it, and tell whether it is the same to the bit.

    python scripts/measure/replay.py [--minutes 5] [--library FILE]

Hands on a keyboard tap and hold keys; hands on a pad push noisy sticks that never rest, both at
once. Both rewind, play on from the past, tune, pause, turn the camera. Printed for each: the size of
the log, whether every state of the replay equals what was played, and the time both took. Then, how
many simulation steps lie between an input and a pose that differs from what it would have been.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from gambol.controllers.locomotion import Locomotion
from gambol.game.app import Play
from gambol.game.hosts import KeyEvent, MouseMove, PadState
from gambol.game.session import LogWriter, SessionState, of_library, read, replay

FRAME = 1.0 / 60.0
TAPS = ("TAB", "C", "V", "V", "V", "R")
AT = {12: "P", 13: "P", 14: "K", 15: "K", 16: "K", 17: "K"}
"""What is tapped in which second of twenty: a pause, and slow motion and back."""


def keyboard(game: Play, rng: np.random.Generator, frame: int, down: set[str]) -> None:
    """What two hands on keys and mouse do in one frame."""
    for key in ("W", "W", "A", "S", "D", "LEFT_SHIFT", "Q", "E", "F", "LEFT_BUTTON"):
        if rng.random() < 0.02:
            pressed = key not in down
            (down.add if pressed else down.discard)(key)
            game.handle(KeyEvent(key, pressed))
    if "LEFT_BUTTON" in down:
        game.handle(MouseMove(0.5, 0.5, *(0.01 * rng.normal(size=2))))


def pad(game: Play, rng: np.random.Generator, frame: int, sticks: list) -> None:
    """What thumbs do in one frame: they follow changing aims, and tremble."""
    if frame % 40 == 0 or not sticks:
        sticks[:] = [sticks[0] if sticks else np.zeros(4), rng.uniform(-1.0, 1.0, 4)]
    sticks[0] = sticks[0] + 0.15 * (sticks[1] - sticks[0])
    seen = np.clip(sticks[0] + 0.01 * rng.normal(size=4), -1.0, 1.0)
    buttons = frozenset(b for b, at in (("LB", 0), ("LT", 300), ("B", 700)) if frame // 100 % 10 == at // 100)
    game.handle(PadState("Thumbs", (*seen, -1.0, float(seen[0])), buttons))


def both(game: Play, rng: np.random.Generator, frame: int) -> None:
    """What either does now and then: rewind, play on, tune, change the camera, pause, start again."""
    second = frame % 60 == 0
    if second and frame // 60 % 20 in (7, 8):
        game.handle(KeyEvent("BACKSPACE", frame // 60 % 20 == 7))
    if second and frame // 60 % 20 == 9:
        game.do("resume")
    keys = [AT.get(frame // 60 % 20)] if second else []
    if second and rng.random() < 0.2:
        keys.append(TAPS[rng.integers(len(TAPS))])
    for key in filter(None, keys):
        game.handle(KeyEvent(key, True))
        game.handle(KeyEvent(key, False))
    if second and rng.random() < 0.2:
        game.do(f"locomotion.acceleration={rng.uniform(2.0, 8.0):.3f}")


def bits(moment: SessionState) -> tuple[bytes, ...]:
    """All that is known of everybody, as bytes."""
    return tuple(part for character in moment.after.characters for state in (character.state,) for part in (
        *(np.ascontiguousarray(state.memory[name]).tobytes() for name in state.memory.dtype.names),
        state.pose.root.tobytes(), state.pose.rotations.tobytes())) + tuple(
        player.camera.view().eye.tobytes() for player in moment.players)


def played(hands, controller: Locomotion, path: Path, frames: int) -> tuple[float, list[int]]:
    """Play into a log. The seconds it took, and a hash of every moment."""
    game, rng = Play(controller, log=LogWriter(path, controller, 1)), np.random.default_rng(4)
    held = set() if hands is keyboard else []
    hashes, began = [hash(bits(game.now))], time.perf_counter()
    for frame in range(frames):
        hands(game, rng, frame, held)
        both(game, rng, frame)
        game.tick(FRAME)
        if len(hashes) <= game.now.number:
            hashes.append(hash(bits(game.now)))
    took = time.perf_counter() - began
    game.close()
    return took, hashes


def steps_to_pose(controller: Locomotion, event) -> int:
    """How many steps after an event the pose first differs from that of a game without it."""
    one, other = Play(controller), Play(controller)
    for game in (one, other):
        for _ in range(30):
            game.tick(FRAME)
    one.handle(event)
    for steps in range(1, 100):
        one.tick(FRAME)
        other.tick(FRAME)
        if any(a != b for a, b in zip(bits(one.now)[-3:-1], bits(other.now)[-3:-1])):
            return steps
    return -1


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--minutes", type=float, default=5.0)
    options.add_argument("--library", type=Path)
    options = options.parse_args()
    controller = Locomotion.load(options.library)
    frames = round(options.minutes * 3600)
    for hands in (keyboard, pad):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "hands.gambol"
            took, hashes = played(hands, controller, path, frames)
            began = time.perf_counter()
            log = of_library(read(path), controller)
            again = [hash(bits(moment)) for moment in replay(log, controller)]
            replayed = time.perf_counter() - began
            backs = sum(action.startswith("back=") for tick in log.ticks for wish in tick for action in wish.pressed)
            print(f"{hands.__name__:9} {options.minutes:g} min: {len(log.ticks)} ticks, {len(set(hashes))} moments that "
                  f"differ, {backs} rewinds, log "
                  f"{path.stat().st_size / 1000:.1f} kB; bit-identical: {'yes' if again == hashes else 'NO'}; "
                  f"played in {took:.1f} s, replayed in {replayed:.1f} s ({replayed / len(log.ticks) * 1000:.2f} ms a tick)")
    for name, event in (("key", KeyEvent("W", True)), ("stick", PadState("Thumbs", (0.0, -1.0, 0.0, 0.0, -1.0, -1.0)))):
        print(f"{name} to changed pose: {steps_to_pose(controller, event)} simulation step(s)")


if __name__ == "__main__":
    main()
