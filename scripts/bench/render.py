"""How long a frame takes offscreen: p50 and p99 for both presets, one and ten characters, and beside rivals.

    python scripts/bench/render.py [--frames 120] [--size 1280x720] [--renderers]

Each frame moves the figures, draws them and reads the picture back, as a film does. One character stands
close and is drawn with its finest mesh; ten are drawn as the preset would. The processor time, summed over
all cores, tells what a frame costs where other programs were running too.

--renderers installs pyrender and aitviewer into environments of their own, in the system's folder for temporary
files, and has them draw the same mesh of the same pose, with floor and shadows, at the same size, in turns
with Gambol. Their pictures lie beside them.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import time
import venv
from dataclasses import replace
from pathlib import Path

import numpy as np

from gambol.controllers.body import exp, forward_kinematics, human, yaw
from gambol.game.hosts import Offscreen
from gambol.game.render import mannequin, preset, skin
from gambol.game.scene import Camera, Figure, Scene

RIVALS = {"pyrender": (["pyrender", "numpy<2"], "its mesh still, floor, 1 shadow map, 4 samples"),
          "aitviewer": (["aitviewer"], "its mesh moving, floor, 2 shadow maps, 4 samples")}
"""What each needs installed, and what it draws."""
OURS = {"full": "moving, floor, soft shadows, occlusion, 4 samples",
        "fast": "moving, floor, shadows, occlusion, 1 sample"}
ROUNDS = 3
WARM_UP = 10


def stroll(count: int, time_s: float) -> tuple[Figure, ...]:
    """`count` figures that swing arms and legs, in rows before the camera."""
    skeleton = human()
    figures = []
    for n in range(count):
        swing = np.sin(6.0 * time_s + n)
        turns = np.zeros((len(skeleton), 3))
        for side, sign in (("Left", 1.0), ("Right", -1.0)):
            turns[skeleton.index(f"{side}Arm")] = 0.0, 0.0, -1.25 * sign
            turns[skeleton.index(f"{side}UpLeg")] = -0.5 * sign * swing, 0.0, 0.0
            turns[skeleton.index(f"{side}Leg")] = 0.4 + 0.4 * sign * swing, 0.0, 0.0
        rotations = exp(turns)
        rotations[0] = yaw(0.4 * n)
        root = np.array([(n % 5 - (2 if count > 1 else 0)) * 1.1, 0.98, -1.3 * (n // 5)])
        positions, orientations = forward_kinematics(skeleton, root, rotations)
        figures.append(Figure(positions, orientations, tint=(0.7 - 0.05 * n, 0.4, 0.2 + 0.05 * n)))
    return tuple(figures)


def camera(count: int) -> Camera:
    """Where `count` figures are seen from."""
    return Camera(np.array([1.0, 1.4, 2.8] if count == 1 else [1.6, 1.6, 5.2]), np.array([0.0, 0.95, 0.0]))


def measured(size: tuple[int, int], name: str, count: int, frames: int) -> tuple[np.ndarray, float, str]:
    """Milliseconds (frames,) of draw and read together, after a warm-up, processor time a frame, what drew."""
    chosen = preset(name) if count > 1 else replace(preset(name), detail=(1.0, 1.0))  # the finest mesh
    out, times = np.empty((size[1], size[0], 4), np.uint8), []
    with Offscreen(size, chosen) as host:
        for n in range(frames + WARM_UP):
            if n == WARM_UP:
                spent = time.process_time()
            scene = Scene(camera(count), stroll(count, n / 60.0), text=("Gambol",))
            began = time.perf_counter()
            host.frame(scene, out)
            times.append(time.perf_counter() - began)
        spent = 1000.0 * (time.process_time() - spent) / frames
        return 1000.0 * np.array(times[WARM_UP:]), spent, host.context.info["GL_RENDERER"]


def show(name: str, took, spent: float, about: str) -> None:
    print(f"{name:22} p50 {np.percentile(took, 50):6.1f} ms  p99 {np.percentile(took, 99):6.1f} ms  "
          f"processor {spent:6.1f} ms  {about}", flush=True)


def mesh_frames(file: Path, size: tuple[int, int], frames: int) -> None:
    """Save what rivals draw: the mannequin's finest mesh, posed for each frame."""
    body, view, vertices = mannequin(), camera(1), []
    near = body.levels[0]
    for n in range(frames + WARM_UP):
        figure = stroll(1, n / 60.0)[0]
        motion = skin.motions(figure.positions[None], figure.orientations[None], np.ones(1), body.joints)[0]
        vertices.append(skin.skinned(near.positions, near.joints, near.weights, motion))
    np.savez(file, vertices=np.array(vertices, np.float32), triangles=near.triangles.astype(np.int32), eye=view.eye,
             target=view.target, fov=view.fov, size=np.array(size), frames=frames)


def installed(name: str, folder: Path) -> Path | None:
    """The Python of an environment with a rival in it, or None, having said why."""
    python, done = folder / "bin" / "python", folder / "installed"
    if not done.exists():
        print(f"installing {name} into {folder}", flush=True)
        venv.create(folder, with_pip=True)
        run = subprocess.run([python, "-m", "pip", "install", "-q", *RIVALS[name][0]], capture_output=True, text=True)
        if run.returncode:
            print(f"{name} can't be installed here: {(run.stderr.strip().splitlines() or ['pip gave no reason'])[-1]}")
            return None
        done.touch()
    return python


def rival(name: str, python: Path, scene: Path) -> tuple[list[float], float] | None:
    """Milliseconds of each frame and processor time a frame, or None, having said why."""
    script = Path(__file__).parents[1] / "renderers" / f"{name}_frames.py"
    run = subprocess.run([python, script, scene, scene.with_name(f"{name}.png")], capture_output=True, text=True)
    if run.returncode:
        print(f"{name} can't draw here: {(run.stderr.strip().splitlines() or ['it gave no reason'])[-1]}")
        return None
    said = json.loads(run.stdout.splitlines()[-1])
    return said["took"], said["processor"]


def beside_rivals(size: tuple[int, int], frames: int) -> None:
    """Measure in turns, so that what else the machine does hits all alike."""
    folder = Path(tempfile.gettempdir()) / "gambol-rivals"
    pythons = {name: installed(name, folder / name) for name in RIVALS}
    scene = folder / "scene.npz"
    mesh_frames(scene, size, frames)
    took: dict[str, list] = {}
    for _ in range(ROUNDS):
        for name in OURS:
            took.setdefault(name, []).append(measured(size, name, 1, frames)[:2])
        for name, python in pythons.items():
            if python and (result := rival(name, python, scene)):
                took.setdefault(name, []).append(result)
    medians = {}
    for name, rounds in took.items():
        times, spent = np.concatenate([r[0] for r in rounds]), float(np.median([r[1] for r in rounds]))
        medians[name] = float(np.median(times)), spent
        show(f"Gambol {name}" if name in OURS else name, times, spent, OURS.get(name) or RIVALS[name][1])
    for name in set(medians) - set(OURS):
        print(f"{name} takes " + ", ".join(
            f"{medians[name][0] / medians[ours][0]:.1f} × the time ({medians[name][1] / medians[ours][1]:.1f} × the "
            f"processor time) of {ours}" for ours in OURS))


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--frames", type=int, default=120)
    options.add_argument("--size", default="1280x720", type=lambda s: tuple(map(int, s.split("x"))))
    options.add_argument("--renderers", action="store_true", help="measure pyrender and aitviewer too")
    options = options.parse_args()
    print(f"{options.size[0]}×{options.size[1]}, {len(mannequin().levels[0].triangles)} triangles in the finest mesh")
    for count in (1, 10):
        for name in OURS:
            took, spent, draws = measured(options.size, name, count, options.frames)
            show(f"{name}, {count} character{'s' * (count > 1)}", took, spent, draws)
    if options.renderers:
        beside_rivals(options.size, max(options.frames // ROUNDS, 5))


if __name__ == "__main__":
    main()
