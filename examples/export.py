"""Take motion elsewhere: write what two people do as GLB and as BVH, and read both back with other people's readers.

Blender opens either; the GLB also holds the bodies, and which foot stands when.

    python examples/export.py out

Reading back needs pip install pygltflib upc-pymotion
"""

import argparse
from pathlib import Path

import numpy as np

from gambol.controllers.contract import Intent
from gambol.controllers.person import person
from gambol.game.output import takes, write
from gambol.game.world import DT, RATE, Character, World


def played(seconds):
    """Pairs of worlds, before and after each step: Ada walks a curve, Ben walks beside her."""
    somebody = person()
    world = World((Character("Ada", somebody, somebody.start((0.0, 0.0, 0.0))),
                   Character("Ben", somebody, somebody.start((1.2, 0.0, 0.0)))))
    wishes = Intent(np.array([1.2, 0.3, 0.0])), Intent(np.array([1.0, 0.2, 0.0]))
    while world.time < seconds - 0.5 * DT:
        before, world = world, world.step(wishes)
        yield before, world, 1.0


def main(folder="out", seconds=4.0):
    """Write the files and read them; for each file what another program found in it."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    done = takes(played(seconds))
    found = {}
    for file in [*write(folder / "walk.glb", done, RATE), *write(folder / "walk.bvh", done, RATE)]:
        found[file.name] = read_glb(file) if file.suffix == ".glb" else read_bvh(file)
        print(f"{file}: {found[file.name]}")
    return found


def read_glb(file):
    """What pygltflib sees: joints of each skin, and seconds of animation."""
    from pygltflib import GLTF2

    seen = GLTF2().load(str(file))
    times = {sampler.input for animation in seen.animations for sampler in animation.samplers}
    return {"joints": [len(skin.joints) for skin in seen.skins],
            "seconds": max(seen.accessors[i].max[0] for i in times)}


def read_bvh(file):
    """What pymotion sees: joints, frames, and how far the root went [m]; BVH counts in centimetres."""
    from pymotion.io.bvh import BVH

    seen = BVH()
    seen.load(str(file))
    _, places, _, _, _, _ = seen.get_data()
    way = np.linalg.norm(np.diff(places[:, 0, [0, 2]], axis=0), axis=-1).sum() / 100.0
    return {"joints": sum("End" not in name for name in seen.data["names"]), "frames": len(places), "metres": round(float(way), 2)}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="?", default="out")
    parser.add_argument("--seconds", type=float, default=4.0)
    main(**vars(parser.parse_args()))
