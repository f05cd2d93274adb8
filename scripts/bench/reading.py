"""How many frames a second the motion readers take in, beside an independent BVH reader.

    python scripts/bench/reading.py [FOLDER]

FOLDER holds .bvh and .amc files; by default the shared recordings, or made-up files where there
are none. Every file is read from start to rotations; the other reader (upc-pymotion) up to its
quaternions, too. Each takes the best of three rounds over the same files, in this one run.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, human
from gambol.controllers.mocap import read_amc, read_bvh, write_bvh

SHARED = Path(__file__).resolve().parents[3] / "shared" / "mocap"


def made_up(folder: Path, frames: int = 5000) -> None:
    """Write one long BVH file of the standard human, and an Acclaim chain with as many joints."""
    rng = np.random.default_rng(0)
    body = human()
    turns = Rotation.from_rotvec(rng.normal(0, 0.5, (frames, len(body), 3)))
    write_bvh(Clip("made up", body, 1 / 120, rng.normal(0, 1, (frames, 3)), turns.as_quat()), folder / "made_up.bvh")
    names = body.names[1:]
    bones = "".join(f"begin\nname {name}\ndirection 0 1 0\nlength 1\naxis 0 0 20 XYZ\ndof rx ry rz\nend\n"
                    for name in names)
    chain = "\n".join(f"{parent} {child}" for parent, child in zip(("root", *names), names))
    (folder / "made_up.asf").write_text(":root\norder TX TY TZ RX RY RZ\n:bonedata\n" + bones
                                        + f":hierarchy\nbegin\n{chain}\nend\n")
    values = rng.normal(0, 30, (frames, len(names) + 2, 3))
    row = "root %g %g %g %g %g %g\n" + "".join(f"{name} %g %g %g\n" for name in names)
    (folder / "made_up.amc").write_text("".join(f"{t}\n" + row % tuple(frame.ravel())
                                                for t, frame in enumerate(values, 1)))


def rate(read, files: list[Path], rounds: int = 3) -> tuple[int, float]:
    """Frames in all files, and the best rate [frames/s] of some rounds over them."""
    frames = sum(read(path) for path in files[:2])  # compile, and fill the disk's cache
    best = np.inf
    for _ in range(rounds):
        start = time.perf_counter()
        frames = sum(read(path) for path in files)
        best = min(best, time.perf_counter() - start)
    return frames, frames / best


def other_reader(path: Path) -> int:
    """Frames read by upc-pymotion."""
    from pymotion.io.bvh import BVH
    other = BVH()
    other.load(str(path))
    return len(other.get_data()[0])


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else SHARED
    with tempfile.TemporaryDirectory() as temporary:
        if not folder.is_dir():
            folder = Path(temporary)
            made_up(folder)
        bvh, amc = (sorted(folder.rglob(f"*.{ending}")) for ending in ("bvh", "amc"))
        for name, read, files in (("BVH", read_bvh, bvh), ("AMC", read_amc, amc)):
            if files:
                longest = max(files, key=lambda path: path.stat().st_size)
                frames, all_files = rate(lambda path: len(read(path)), files)
                length, one_file = rate(lambda path: len(read(path)), [longest])
                print(f"{name}: {len(files)} files, {frames:,} frames: {all_files:,.0f} frames/s; "
                      f"the longest alone, {length:,} frames: {one_file:,.0f} frames/s")
        few = bvh[::max(1, len(bvh) // 12)]  # the other reader is slow
        if few:
            try:
                frames, theirs = rate(other_reader, few, rounds=1)
            except ImportError:
                print("BVH, upc-pymotion: not installed")
                return
            _, ours = rate(lambda path: len(read_bvh(path)), few)
            print(f"BVH, {len(few)} files, {frames:,} frames: ours {ours:,.0f}, upc-pymotion {theirs:,.0f} "
                  f"frames/s: {ours / theirs:.0f} times as fast")


if __name__ == "__main__":
    main()
