"""How far joints are off when other readers read what Gambol exports: BVH and GLB, over a scenario.

    python scripts/measure/export.py [--scenario demo] [--character my.glb] [--onto my.glb|my.bvh]

GLB: pygltflib reads the file, and 4 × 4 matrices down its node tree place the joints. BVH:
upc-pymotion reads and places them. Both against Gambol's own forward kinematics; --onto: all bones of
that file, against where its rig says that they are.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np


def glb_joints(path: Path) -> dict[str, np.ndarray]:
    """World positions (T, 3) [m] of every animated node by "actor/joint", as pygltflib finds them."""
    from pygltflib import GLTF2
    from scipy.spatial.transform import Rotation

    file = GLTF2().load(str(path))
    blob = file.binary_blob()

    def values(index):
        accessor = file.accessors[index]
        view = file.bufferViews[accessor.bufferView]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        start = view.byteOffset + (accessor.byteOffset or 0)
        return np.frombuffer(blob, np.float32, accessor.count * width, start).reshape(-1, width).astype(float)

    tracks = {}
    for channel in file.animations[0].channels:
        sampler = file.animations[0].samplers[channel.sampler]
        tracks[channel.target.node, channel.target.path] = values(sampler.output)
        frames = len(tracks[channel.target.node, channel.target.path])
    out: dict[str, np.ndarray] = {}

    def visit(number, above, actor):
        node = file.nodes[number]
        local = np.tile(np.eye(4), (frames, 1, 1))
        local[:, :3, 3] = tracks.get((number, "translation"), np.array(node.translation or [0.0, 0.0, 0.0]))
        turn = tracks.get((number, "rotation"), np.array([node.rotation or [0.0, 0.0, 0.0, 1.0]]))
        local[:, :3, :3] = Rotation.from_quat(np.broadcast_to(turn, (frames, 4))).as_matrix() * (node.scale or [1.0, 1.0, 1.0])
        if node.matrix:
            local[:] = np.reshape(node.matrix, (4, 4)).T
        world = above @ local
        out[f"{actor}/{node.name}"] = world[:, :3, 3]
        for child in node.children or []:
            visit(child, world, actor)
    for top in file.scenes[file.scene].nodes:
        if file.nodes[top].skin is None:
            visit(top, np.tile(np.eye(4), (frames, 1, 1)), file.nodes[top].name)
    return out


def bvh_joints(path: Path) -> dict[str, np.ndarray]:
    """World positions (T, 3) [m] of every joint by name, as upc-pymotion finds them in centimetres."""
    from pymotion.io.bvh import BVH
    from pymotion.ops.skeleton import fk_quat

    file = BVH()
    file.load(str(path))
    turns, places, parents, offsets, _, _ = file.get_data()
    at, _ = fk_quat(turns, places[:, 0, :], offsets, parents)
    return {name: at[:, k] / 100.0 for k, name in enumerate(file.data["names"])}


def own_joints(take) -> dict[str, np.ndarray]:
    """World positions (T, 3) [m] of the joints of a take (`gambol.game.output.export.Take`) by name."""
    from gambol.controllers.body import forward_kinematics
    from gambol.game.render import worn

    at, turned = forward_kinematics(take.skeleton, np.stack([pose.root for pose in take.poses]).astype(float),
                                    np.stack([pose.rotations for pose in take.poses]).astype(float))
    if take.body is not None:
        at = worn(take.body, at, turned)[0]
    return {name: at[:, k] for k, name in enumerate(take.skeleton.names)}


def timed(call, times: int = 100) -> float:
    """The median time of a call [s]."""
    from time import perf_counter

    spent = []
    for _ in range(times):
        start = perf_counter()
        call()
        spent.append(perf_counter() - start)
    return float(np.median(spent))


def main() -> None:
    from dataclasses import replace

    from gambol.controllers.locomotion import Locomotion
    from gambol.game.character import load
    from gambol.game.output import export
    from gambol.game.scenario import film, scenario

    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--scenario", default="demo")
    options.add_argument("--character", type=Path)
    options.add_argument("--onto", type=Path)
    options = options.parse_args()
    played = scenario.load(options.scenario)
    takes = export.takes((f.before, f.after, f.alpha) for f in film.run(played, Locomotion.load(None)))
    with tempfile.TemporaryDirectory() as folder:
        files = export.write(Path(folder) / "x.bvh", takes, played.fps)
        off = [np.abs(read - own_joints(take)[name]).max() for take, file in zip(takes, files)
               for name, read in bvh_joints(file).items() if name in take.skeleton]
        print(f"BVH  {len(takes)} characters, {len(takes[0].poses)} frames: at most {1000 * max(off):.5f} mm off")
        if options.character:
            body = load(options.character)
            takes = [replace(take, body=body) for take in takes]
        file, = export.write(Path(folder) / "x.glb", takes, played.fps)
        read = glb_joints(file)
        off = [np.abs(read[f"{take.name}/{name}"] - at).max() for take in takes for name, at in own_joints(take).items()]
        print(f"GLB  {len(takes)} characters, {len(takes[0].poses)} frames: at most {1000 * max(off):.5f} mm off; "
              f"{file.stat().st_size / 1e6:.1f} MB")
        if options.onto:
            onto, take, kind = export.rig_in(options.onto), takes[0], export.suffix_onto(options.onto)
            file = export.write_onto(Path(folder) / f"y{kind}", onto, take, played.fps)
            places, names = export.on_rig(onto, take).places, onto.rig.skeleton.names
            if kind == ".bvh":  # pymotion takes any unit for centimetres
                read = {name: 100.0 * onto.scale * at @ onto.axes.T for name, at in bvh_joints(file).items()}
                off = [np.abs(read[name] - places[:, bone]).max() for bone, name in enumerate(names)]
            else:
                read = glb_joints(file)
                top = next(iter(read)).partition("/")[0]
                off = [np.abs(read[f"{top}/{name}"] - places[:, bone]).max() for bone, name in enumerate(names) if bone]
            print(f"onto {options.onto.name}: {len(off)} bones, {len(take.poses)} frames: at most {1000 * max(off):.5f} mm off; "
                  f"{1000 * timed(lambda: onto.rig.pose(take.skeleton, take.poses[0].root, take.poses[0].rotations)):.2f} ms a pose")


if __name__ == "__main__":
    main()
