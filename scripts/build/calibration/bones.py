"""Fit what bones people are likely to have to performers' skeletons, and write assets/reconstruction/bones.npz.

    python scripts/build/calibration/bones.py FOLDER

FOLDER: motion files in folders by source and performer, as in `large.tar.xz` and all beside it (CONTRIBUTING.md). Skeletons of CMU's Acclaim files, of
cgspeed's BVH of others of CMU's, and of each other source are a family each. It takes half a minute.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gambol.controllers.files import whole
from gambol.controllers.reconstruction.calibration import BONES, LikelyBones, save_bones
from gambol.controllers.reconstruction.evaluation import performers


def main() -> None:
    """Fit, and write what was fitted."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--out", type=Path, default=BONES, help="where to")
    options = parser.parse_args()
    try:
        found = performers(options.folder)
        likely = LikelyBones.of({name: list(people.values()) for name, people in found.items()})
    except ValueError as error:
        sys.exit(str(error))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as own:
        save_bones(own, likely)
    for name, people in found.items():
        print(f"{name}: {len(people)} performers: {' '.join(people)}")


if __name__ == "__main__":
    main()
