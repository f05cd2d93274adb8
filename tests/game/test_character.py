"""Anybody's GLB humans become bodies that stand, walk and reach as ours do; what is no human is refused in one line."""

import json
import struct

import foreign
import numpy as np
import pytest

from gambol.game.character import Build, BuildError, CharacterError, load, tailored
from gambol.game.render import skin
from gambol.game.render.mesh import mannequin
from gambol.game.render.wear import leg_length, worn

STRIDE = foreign.figure(LeftUpLeg=(-28, 0, 0), LeftLeg=(12, 0, 0), LeftFoot=(14, 0, 0), RightUpLeg=(16, 0, 0),
                        RightLeg=(32, 0, 0), LeftArm=(0, 0, -70), RightForeArm=(0, 40, 0))
LANKY = {"LeftLeg": 1.2, "RightLeg": 1.2, "LeftFoot": 0.85, "RightFoot": 0.85, "LeftForeArm": 1.3, "RightForeArm": 1.3,
         "Head": 1.4}
RIGS = {
    "Mixamo in centimetres, Z up": dict(unit=0.01, turn=(-90, 0, 0), fingers=True),
    "VRM facing backwards": dict(name=foreign.vrm, turn=(0, 180, 0)),
    "Blender, arms down": dict(name=foreign.rigify, pose=dict(foreign.A_POSE, LeftArm=(0, 0, -80), RightArm=(0, 0, 80))),
    "Unreal, saved in mid-stride": dict(name=foreign.unreal, saved=dict(LeftUpLeg=(-40, 0, 0), RightUpLeg=(30, 0, 0),
                                                                        RightArm=(0, 0, 60))),
    "our own names, T-pose": dict(name=str, pose={}),
}


@pytest.mark.parametrize("rig", RIGS.values(), ids=RIGS)
def test_a_human_is_the_same_in_anybodys_rig(tmp_path, rig):
    """Joints where ours are, and flesh where the mannequin has it, but for what linear skinning loses in the armpits."""
    foreign.write(tmp_path / "x.glb", **rig)
    body = load(tmp_path / "x.glb")
    assert np.abs(body.joints - skin.REST).max() < 2e-3
    away = np.linalg.norm(body.levels[0].positions - mannequin().levels[2].positions, axis=1)
    assert np.percentile(away, 90) < 9e-3 and away.max() < 0.05
    assert np.allclose(body.levels[0].weights.sum(1), 1.0, atol=1e-5)


@pytest.mark.parametrize("version", [0, 1])
def test_vrm_tells_its_joints_by_a_table(tmp_path, version):
    bones = {"Hips": "hips", "Spine": "spine", "Spine1": "chest", "Spine2": "upperChest", "Neck": "neck", "Head": "head"}
    parts = {"Shoulder": "Shoulder", "Arm": "UpperArm", "ForeArm": "LowerArm", "Hand": "Hand", "UpLeg": "UpperLeg",
             "Leg": "LowerLeg", "Foot": "Foot", "Toe": "Toes"}
    bones |= {side + ours: side.lower() + theirs for side in ("Left", "Right") for ours, theirs in parts.items()}

    def table(glb):
        node = {bones[name]: k for k, name in enumerate(skin.STANDARD.names, 1)}
        for number in node.values():
            glb.json["nodes"][number]["name"] = "bone"
        glb.json["extensions"] = {"VRMC_vrm": {"humanoid": {"humanBones": {b: {"node": n} for b, n in node.items()}}}} \
            if version else {"VRM": {"humanoid": {"humanBones": [{"bone": b, "node": n} for b, n in node.items()]}}}
    foreign.write(tmp_path / "x.vrm.glb", change=table)
    (tmp_path / "x.vrm.glb").rename(tmp_path / "x.vrm")
    assert np.abs(load(tmp_path / "x.vrm").joints - skin.REST).max() < 2e-3


def test_fingers_follow_their_hand(tmp_path):
    foreign.write(tmp_path / "x.glb", fingers=True)
    mesh = load(tmp_path / "x.glb").levels[0]
    fingers = mesh.positions[:, 0] > 0.83
    main = np.take_along_axis(mesh.joints, mesh.weights.argmax(1)[:, None], 1)[fingers, 0]
    assert set(main) == {skin.NAMES.index("LeftHand")}


def test_proportions_are_kept_and_soles_stand_where_the_figures_do(tmp_path):
    rest = foreign.write(tmp_path / "x.glb", scales=LANKY)
    body = load(tmp_path / "x.glb")
    assert np.abs(body.joints - rest).max() < 2e-3
    at, turned, scale = worn(body, STRIDE.positions[None], STRIDE.orientations[None])
    parents = skin.STANDARD.parents[1:]
    bones = np.linalg.norm(at[0, 1:] - at[0, parents], axis=-1)
    assert np.allclose(bones, scale * np.linalg.norm(body.joints[1:] - body.joints[parents], axis=-1), atol=1e-9)
    for side in ("Left", "Right"):
        foot = skin.STANDARD.index(f"{side}Foot")
        sole = at[0, foot] - turned[0, foot] @ [0.0, scale[0] * body.joints[foot, 1], 0.0]
        wanted = STRIDE.positions[foot] - STRIDE.orientations[foot] @ [0.0, skin.REST[foot, 1], 0.0]
        assert np.linalg.norm(sole - wanted) < 1e-3
    assert np.abs(turned[0, foot] - STRIDE.orientations[foot]).max() < 1e-12


def test_our_own_body_is_worn_as_it_is():
    at, turned, scale = worn(mannequin(), STRIDE.positions[None], STRIDE.orientations[None])
    assert np.abs(at - STRIDE.positions).max() < 1e-4 and abs(scale[0] - 1.0) < 1e-9
    assert np.abs(turned - STRIDE.orientations).max() < 2e-3  # the knee keeps a hair short of straight


def test_a_file_in_any_unit_is_worn_in_the_figures_size(tmp_path):
    foreign.write(tmp_path / "x.glb", unit=37.0)
    at, _, _ = worn(load(tmp_path / "x.glb"), STRIDE.positions[None], STRIDE.orientations[None])
    assert abs(leg_length(at[0]) - leg_length(STRIDE.positions)) < 2e-3


def test_colours_and_pictures_come_along(tmp_path):
    import io

    from PIL import Image

    def coloured(glb):
        packed = io.BytesIO()
        Image.new("RGB", (8, 8), (200, 30, 40)).save(packed, "png")
        image = glb.add("images", {"mimeType": "image/png", "bufferView": glb.view(packed.getvalue())})
        glb.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": glb.add("textures", {"source": image})}}})
        primitive = glb.json["meshes"][0]["primitives"][0]
        count = glb.json["accessors"][primitive["attributes"]["POSITION"]]["count"]
        primitive["attributes"]["TEXCOORD_0"] = glb.array(np.full((count, 2), 0.5))
        primitive["material"] = 0
    foreign.write(tmp_path / "x.glb", change=coloured)
    body = load(tmp_path / "x.glb")
    assert body.pictures.shape[0] == 1 and np.abs(body.pictures[0, 4, 4, :3].astype(int) - [200, 30, 40]).max() <= 1
    assert set(body.levels[0].paint[:, 2]) == {0.0}
    foreign.write(tmp_path / "y.glb")
    assert set(load(tmp_path / "y.glb").levels[0].paint[:, 2]) == {-1.0}, "no colour of its own: the tint"


def edited(path, change):
    """The same file with its JSON changed."""
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    described = json.loads(data[20:20 + size])
    change(described)
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size:]
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) + struct.pack("<I4s", len(text), b"JSON")
                     + text + rest)


def renamed(described):
    for node in described["nodes"]:
        node["name"] = "bone"


def flattened(described):
    for number in described["scenes"][0]["nodes"]:
        described["nodes"][number].pop("matrix", None)
        described["nodes"][number]["scale"] = [0.0, 0.0, 0.0]


def exchanged(described):
    for node in described["nodes"]:
        name = node.get("name", "")
        node["name"] = name.replace("Left", "@").replace("Right", "Left").replace("@", "Right")


FAULTS = {
    "no skin": (lambda d: [d.pop("skins"), [n.pop("skin", 0) for n in d["nodes"]]], "no skin"),
    "no names": (renamed, "no human"),
    "external buffer": (lambda d: d["buffers"][0].update(uri="body.bin"), "body.bin"),
    "a path upwards": (lambda d: d["buffers"][0].update(uri="../body.bin"), "not beside it"),
    "packed": (lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]), "Draco"),
    "old": (lambda d: d["asset"].update(version="1.0"), "glTF 1.0"),
    "a joint that is not there": (lambda d: d["skins"][0]["joints"].append(999), "skin 0 has node 999 for a joint, and there are"),
    "a node scaled to nothing": (flattened, "scaled to nothing"),
    "left and right exchanged": (exchanged, "toes point backward"),
    "a ring of nodes": (lambda d: d["nodes"][5].update(children=[1]), "not sound"),
    "an accessor too long": (lambda d: d["accessors"][1].update(count=10**6), "beyond buffer"),
    "a huge count": (lambda d: d["accessors"][1].update(count=10**12), "counts"),
    "no mesh": (lambda d: [n.pop("mesh", 0) for n in d["nodes"]], "no triangles"),
    "lists for tables": (lambda d: d.update(nodes={"a": 1}), "not sound"),
    "one place": (lambda d: [n.update(matrix=[0.0] * 16) for n in d["nodes"] if "matrix" in n], "x.glb"),
}


@pytest.mark.parametrize("fault, said", FAULTS.values(), ids=FAULTS)
def test_what_is_no_character_is_refused_in_one_line(tmp_path, fault, said):
    path = tmp_path / "x.glb"
    foreign.write(path)
    edited(path, fault)
    with pytest.raises(CharacterError) as error:
        load(path)
    assert str(error.value).startswith(str(path)) and said in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("share", [0.0, 0.001, 0.3, 0.999])
def test_a_torn_file_is_refused(tmp_path, share):
    path = tmp_path / "x.glb"
    foreign.write(path)
    data = path.read_bytes()
    path.write_bytes(data[:int(len(data) * share)])
    with pytest.raises(CharacterError, match="GLB|short|sound"):
        load(path)


def test_other_files_are_refused(tmp_path):
    (tmp_path / "x.glb").write_text("solid cube")
    for name in ("x.glb", "missing.glb", "x.fbx", ""):
        with pytest.raises(CharacterError):
            load(tmp_path / name)


BUILDS = [Build(), Build(1.2, child=1.0), Build(1.9, weight=1.0, shoulders=1.3), Build(1.6, weight=-1.0, hips=1.2)]


@pytest.mark.parametrize("build", BUILDS, ids=str)
def test_a_body_is_as_tall_as_asked_stands_on_the_floor_and_bends_where_its_joints_are(build):
    body = tailored(build)
    for mesh in body.levels:
        assert abs(mesh.positions[:, 1].min()) < 0.004 and abs(mesh.positions[:, 1].max() - build.height) < 0.012
    mesh = body.levels[0]
    for joint, reach in (("LeftLeg", 0.11), ("RightForeArm", 0.10), ("LeftFoot", 0.10), ("Neck", 0.14)):
        near = np.linalg.norm(mesh.positions - body.joints[skin.STANDARD.index(joint)], axis=1)
        around = near < reach * build.height
        middle = mesh.positions[around].mean(0)
        assert np.linalg.norm(middle - body.joints[skin.STANDARD.index(joint)]) < 0.05 * build.height
    assert np.array_equal(body.levels[0].paint, mannequin().levels[0].paint)


def volume(mesh):
    a, b, c = (mesh.positions[mesh.triangles[:, i]].astype(float) for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0


def test_weight_adds_volume_and_a_child_has_a_large_head():
    litres = [1000 * volume(tailored(Build(weight=w)).levels[1]) for w in (-1.0, 0.0, 1.0)]
    assert litres[0] < 0.85 * litres[1] and litres[2] > 1.25 * litres[1]

    def share(body):
        return (body.levels[0].positions[:, 1].max() - body.joints[skin.STANDARD.index("Head"), 1]) / body.joints[0, 1]
    assert share(tailored(Build(child=1.0))) > 1.25 * share(tailored(Build()))


def test_the_standard_build_is_the_mannequin_itself():
    assert np.abs(tailored(Build(height=float(mannequin().levels[0].positions[:, 1].max()))).levels[0].positions
                  - mannequin().levels[0].positions).max() < 2e-3


def test_the_mannequin_is_modelled_around_any_skeleton():
    """Bones of another length, in any pose and roll: the body's are in proportion."""
    from gambol.controllers.body import Skeleton

    longer = {"LeftLeg": 1.2, "RightLeg": 1.2, "LeftForeArm": 0.8, "RightForeArm": 0.8}
    offsets = skin.STANDARD.offsets * [[longer.get(n, 1.0)] for n in skin.STANDARD.names]
    rolled = np.roll(offsets, 1, axis=1) * 100.0
    body = tailored(Build(), Skeleton(skin.STANDARD.names, skin.STANDARD.parents, rolled, np.zeros(0, int), np.zeros((0, 3))))

    def bone(a, b, at=body.joints):
        return np.linalg.norm(at[skin.STANDARD.index(a)] - at[skin.STANDARD.index(b)])
    for a, b, factor in (("LeftUpLeg", "LeftLeg", 1.2), ("LeftArm", "LeftForeArm", 0.8)):
        wanted = bone(a, b, skin.REST) / bone("LeftLeg", "LeftFoot", skin.REST) * factor
        assert abs(bone(a, b) / bone("LeftLeg", "LeftFoot") / wanted - 1.0) < 1e-6


@pytest.mark.parametrize("wrong", [dict(height=0.1), dict(weight=2.0), dict(child=float("nan")), dict(hips=0.0)])
def test_a_build_that_nobody_has_is_refused(wrong):
    with pytest.raises(BuildError, match=next(iter(wrong))):
        Build(**wrong)
