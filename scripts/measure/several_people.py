"""Measure tracking by masks of two who walk past each other, each told where the other stands or only of his own mask, cut by the other's.

    python scripts/measure/several_people.py -o FOLDER [--cameras 0,1,2,3] [--every 1] [--only cross,meet,corners]

The cameras are those of `gambol film`; masks are kept in FOLDER. Errors are of all joints over all frames after the first two.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from gambol.assets import path as asset
from gambol.controllers.person import person
from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.cameras import read_cameras
from gambol.controllers.tracking.twists import posed
from gambol.game.footage import Footage, FootageError, first_poses, read_footage, seen_in
from gambol.game.meshes import surface_of
from gambol.game.scenario import load
from gambol.game.studio import Plan, read_sensor, shoot

WAYS = {"cross": ((-1.8, 0.0, 90), (1.8, 0.0), (0.0, -1.8, 0), (0.0, 1.8)),
        "meet": ((-1.8, 0.0, 90), (1.8, 0.0), (1.8, -0.35, 270), (-1.8, -0.35)),
        "corners": ((-1.4, -1.4, 45), (1.4, 1.4), (1.4, -1.4, 315), (-1.4, 1.4))}
"""Where each of the two begins, x, z [m] and heading [degrees], and where they go; at the corners they are in line with cameras."""
ACTOR = """
[[actors]]
name = "{}"
start = {}
moves = [{{ walk_to = {}, speed = 1.2 }}]
"""


class Blank:
    """A stage that draws nothing: masks alone are looked at."""

    def resize(self, size: tuple[int, int]) -> None:
        self.size = size

    def frame(self, scene) -> np.ndarray:
        return np.zeros((self.size[1], self.size[0], 3), np.uint8)


def filmed(name: str, folder: Path) -> Footage:
    """The masks of two people, made once."""
    try:
        return read_footage(folder / name)
    except FootageError:
        pass
    (folder / f"{name}.toml").write_text(f'title = "{name}"\nduration = 4.0\n' + "".join(
        ACTOR.format(who, list(start), list(end)) for who, start, end in zip("AB", WAYS[name][::2], WAYS[name][1::2])))
    four = asset("cameras", "four.toml")
    for _ in shoot(Plan(load(str(folder / f"{name}.toml")), read_cameras(four), read_sensor(four)), folder / name, person(), Blank()):
        pass
    return read_footage(folder / name)


def errors(film: Footage, who: int, told: bool, cameras: list[int], every: int) -> np.ndarray:
    """How far somebody's joints are off in each frame (T, J) [cm]."""
    surface = surface_of(freedom="full")
    before, now = first_poses(film, surface, who)
    tracker = Tracker(surface, tuple(film.lenses[c] for c in cameras), film.fps / every)
    track, truth, off = tracker.start(now, before if every == 1 else now), film.truth()["joints"][:, who], []
    for number in range(1 + every, film.frames, every):
        seen = seen_in(film, number, who, masks=True)
        track = tracker.step(track, [one if told or one is None else one == 1 for one in (seen[c] for c in cameras)])
        off.append(np.linalg.norm(posed(surface.chain, track.now)[0] - truth[number], axis=-1))
    return 100 * np.array(off)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--cameras", default="0,1,2,3", help="which of the four")
    parser.add_argument("--every", type=int, default=1, help="of so many frames one is seen")
    parser.add_argument("--only", default=",".join(WAYS))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for name in args.only.split(","):
        film = filmed(name, args.out)
        for who, called in enumerate(film.people):
            off = [errors(film, who, told, [int(c) for c in args.cameras.split(",")], args.every) for told in (True, False)]
            print(f"{name}, {called}: " + "; ".join(f"{what} {one.mean():.1f} cm, {one.max():.0f} at worst"
                                                    for what, one in zip(("told of the other", "cut masks"), off)), flush=True)


if __name__ == "__main__":
    main()
