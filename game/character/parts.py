"""Which node of a file is which joint of ours: by VRM's humanoid table, else by name."""

from __future__ import annotations

import numpy as np

from gambol.controllers.body import Skeleton
from gambol.controllers.mocap import NoHuman, Roles, plain, roles

from ..render import skin
from .gltf import CharacterError, Document, Nodes

_VRM = {"hips": "Hips", "spine": "Spine", "chest": "Spine1", "upperChest": "Spine2", "neck": "Neck", "head": "Head"}
_VRM |= {f"{side.lower()}{theirs}": side + ours for side in ("Left", "Right") for theirs, ours in (
    ("Shoulder", "Shoulder"), ("UpperArm", "Arm"), ("LowerArm", "ForeArm"), ("Hand", "Hand"),
    ("UpperLeg", "UpLeg"), ("LowerLeg", "Leg"), ("Foot", "Foot"), ("Toes", "Toe"))}
_NEEDED = ("Hips", "Head", *(side + limb for side in ("Left", "Right")
                             for limb in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm")))


def parts(document: Document, tree: Nodes, joints: set[int]) -> dict[str, int]:
    """Node number by our joint's name; spine, neck, clavicles, hands and toes may be missing.

    joints: the nodes that skins bend. CharacterError, naming what is missing, if they make no human.
    """
    found = table(document)
    if not found:
        if set(skin.STANDARD.names) <= {tree.names[n] for n in joints}:
            return {tree.names[n]: n for n in sorted(joints, reverse=True) if tree.names[n] in skin.NAMES}
        found = _by_name(document, tree, joints)
    missing = [name for name in _NEEDED if name not in found]
    if missing:
        raise CharacterError(f"{document.path}: no human: its VRM table misses {', '.join(missing)}")
    if "Spine1" in found and "Spine2" not in found:  # the last of the trunk carries the arms
        found["Spine2"] = found.pop("Spine1")
    elif "Spine" in found and "Spine2" not in found:
        found["Spine2"] = found.pop("Spine")
    return found


def table(document: Document) -> dict[str, int]:
    """Node number by our joint's name, as VRM's table has it; empty where the file has none."""
    extensions = document.json.get("extensions", {})
    new = extensions.get("VRMC_vrm", {}).get("humanoid", {}).get("humanBones", {})
    old = extensions.get("VRM", {}).get("humanoid", {}).get("humanBones", [])
    pairs = [(bone, entry["node"]) for bone, entry in new.items()] or [(entry["bone"], entry["node"]) for entry in old]
    count = len(document.list("nodes"))
    return {_VRM[bone]: node for bone, node in pairs if bone in _VRM and 0 <= node < count}


def _by_name(document: Document, tree: Nodes, joints: set[int]) -> dict[str, int]:
    above = set(joints)
    for n in joints:
        while (n := int(tree.parents[n])) >= 0:
            above.add(n)
    # parents first under one root; equal names are told apart, or a skeleton would refuse them
    order = [n for n in tree.order if n in above]
    place = {n: k for k, n in enumerate(order, 1)}
    names, seen = ["(file)"], set()
    for n in order:
        name = tree.names[n] if tree.names[n] not in seen and tree.names[n] != "(file)" else f"{tree.names[n]} #{n}"
        seen.add(name)
        names.append(name)
    parents = np.array([-1, *(place.get(int(tree.parents[n]), 0) for n in order)])
    skeleton = Skeleton(tuple(names), parents, np.zeros((len(names), 3)), np.zeros(0, int), np.zeros((0, 3)))
    try:
        known = roles(skeleton)
    except NoHuman as error:
        some = ", ".join(names[1:9]) + (", …" if len(names) > 9 else "")
        raise CharacterError(f"{document.path}: no human that can be told by its joints' names ({some}): no {', '.join(error.missing)}; wanted are names "
                             "as Mixamo, VRM, Unreal or Blender's rigs give: Hips, LeftUpLeg, LeftArm, Head, …") from None
    number = dict(known.limbs)
    if plain(skeleton.names[number["Hips"]]) not in ("hips", "hip", "pelvis"):
        number["Hips"] = _fork(skeleton, number["LeftUpLeg"], number["RightUpLeg"])
    number |= _trunk(known, number["Hips"])
    return {name: order[k - 1] for name, k in number.items() if k > 0}


def _trunk(known: Roles, hips: int) -> dict[str, int]:
    chain = [j for j in known.trunk if j > hips]
    out = {"Spine2": chain[-1]} if chain else {}
    for i, j in enumerate(chain[:-1]):
        out.setdefault(("Spine", "Spine1", "Spine1")[3 * i // len(chain)], j)
    if len(known.neck) > 1:
        out["Neck"] = known.neck[0]
    return out


def _fork(skeleton: Skeleton, a: int, b: int) -> int:
    """The lowest joint above both."""
    def above(joint):
        path = [joint]
        while path[-1] >= 0:
            path.append(int(skeleton.parents[path[-1]]))
        return path
    others = above(b)
    return next(j for j in above(a) if j in others)
