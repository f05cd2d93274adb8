"""Motion onto somebody's own file: his bones stand where he is drawn, and all else in it is as it was."""

import foreign
import numpy as np
import pytest
from test_export import described, take
from typer.testing import CliRunner

from gambol.controllers.body import forward_kinematics
from gambol.game import cli
from gambol.game.character import Actor, Build, CharacterError, gltf, joints_of, load, rigged, tailored, write
from gambol.game.files.paths import OutputError
from gambol.game.output import chosen, write_onto
from gambol.game.render import skin, worn
from test_character import RIGS, edited

NAMES = {key: rig.get("name", foreign.mixamo) for key, rig in RIGS.items()}


def at_frame(path, frame):
    """The tree of a file's nodes as its first animation has them at a frame."""
    document = gltf.read(path)
    motion = document.json["animations"][0]
    for channel in motion["channels"]:
        values = document.accessor(motion["samplers"][channel["sampler"]]["output"])
        document.json["nodes"][channel["target"]["node"]][channel["target"]["path"]] = values[frame].tolist()
    return gltf.nodes(document)


@pytest.mark.parametrize("rig", RIGS)
def test_his_bones_stand_where_he_is_drawn(tmp_path, rig):
    one = take(frames=4)
    foreign.write(tmp_path / "x.glb", **RIGS[rig])
    file = write_onto(tmp_path / "y.glb", rigged(tmp_path / "x.glb"), one, 30.0)
    at, turned = forward_kinematics(one.skeleton, np.stack([p.root for p in one.poses]), np.stack([p.rotations for p in one.poses]))
    drawn = worn(load(tmp_path / "x.glb"), at, turned)[0]
    for frame in (0, 3):
        tree = at_frame(file, frame)
        found = np.stack([tree.world[tree.names.index(NAMES[rig](name)), :3, 3] for name in skin.STANDARD.names])
        assert np.abs(found - drawn[frame]).max() < 4e-3
    names = [document["name"] for document in described(file)["nodes"]]
    assert names == [document["name"] for document in described(tmp_path / "x.glb")["nodes"]]


def test_it_stands_as_it_was_bound_and_all_else_is_handed_on(tmp_path):
    """A picture that lay beside the file comes into it, an animation that it had comes second, contacts go along."""
    foreign.write(tmp_path / "x.glb", fingers=True, saved=dict(LeftUpLeg=(-40, 0, 0), RightArm=(0, 0, 60)))
    (tmp_path / "skin.png").write_bytes(b"a picture")

    def more(json_):
        json_["images"] = [{"uri": "skin.png"}]
        json_["animations"] = [{"name": "Old", "channels": [], "samplers": []}]
        json_["extras"] = {"mine": [1, 2]}
    edited(tmp_path / "x.glb", more)
    one, onto = take(frames=3), rigged(tmp_path / "x.glb")
    file = described(write_onto(tmp_path / "y.glb", onto, one, 30.0))
    before = described(tmp_path / "x.glb")
    assert [a["name"] for a in file["animations"]] == ["Ada", "Old"] and file["extras"] == {"mine": [1, 2]}
    assert file["meshes"] == before["meshes"] and file["skins"] == before["skins"] and file["scenes"] == before["scenes"]
    bits = file["animations"][0]["extras"]["contacts"]["Ada"]
    assert np.array_equal(np.array(bits)[:, None] >> np.arange(4) & 1, one.contacts.astype(int))
    (tmp_path / "skin.png").unlink()
    document = gltf.read(tmp_path / "y.glb")
    assert bytes(document.view(document.json["images"][0]["bufferView"])) == b"a picture" and document.json["images"][0]["mimeType"] == "image/png"
    for k in range(len(before["accessors"])):
        assert np.array_equal(document.accessor(k), onto.document.accessor(k))
    tree = gltf.nodes(document)
    for bone, node in enumerate(onto.nodes[1:], 1):
        assert np.allclose(tree.world[node], onto.world[bone], atol=1e-6)
    finger = tree.names.index("mixamorig:LeftHandIndex1")
    assert np.allclose(at_frame(tmp_path / "y.glb", 2).local[finger], tree.local[finger], atol=1e-9), "fingers stay on their hand"


def test_a_smaller_rig_goes_as_much_less_far(tmp_path):
    foreign.write(tmp_path / "x.glb", unit=0.6)
    one = take(frames=3)
    onto = rigged(tmp_path / "x.glb")
    assert abs(onto.rig.height / 1.741 - 1.0) < 0.01, "the file's unit is his own matter"
    file = write_onto(tmp_path / "y.glb", onto, one)
    hips = at_frame(file, 2).world[1, :3, 3]
    assert np.abs(hips - one.poses[2].root).max() < 0.02


@pytest.mark.parametrize("height", [0.5, 0.7, 1.0, 3.0])
def test_our_own_bodies_of_all_sizes_are_rigs(tmp_path, height):
    """glTF is in metres, however short a leg is."""
    body = tailored(Build(height=height))
    rig = rigged(write(tmp_path / "x.glb", [Actor("x", body, joints_of(body))])).rig
    assert rig.unit == 1.0 and rig.height == pytest.approx(height, rel=0.03)


def test_what_nothing_moves_on_is_told(tmp_path):
    foreign.write(tmp_path / "x.glb")

    def uneven(json_):
        json_["nodes"][0] = {"name": "Armature", "scale": [1, 2, 1], "children": json_["nodes"][0]["children"]}
    for change, said in ((uneven, "scaled unevenly"), (lambda j: [n.update(name=f"b{k}") for k, n in enumerate(j["nodes"])], "not a human we know"),
                         (lambda j: j.pop("skins"), "has no skin")):
        foreign.write(tmp_path / "z.glb")
        edited(tmp_path / "z.glb", change)
        with pytest.raises(CharacterError, match=f"z.glb: .*{said}"):
            rigged(tmp_path / "z.glb")
    with pytest.raises(OutputError, match="nobody is called 'Cy' here; there are Ada, Bob"):
        chosen([take(), take("Bob")], "Cy")
    assert chosen([take(), take("Bob")], None).name == "Ada"


def test_the_command_moves_a_file_or_says_why_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    foreign.write(tmp_path / "me.glb", name=foreign.unreal)
    (tmp_path / "go.toml").write_text('title = "x"\nduration = 0.3\nfps = 10\n[[actors]]\nname = "A"\n[[actors]]\nname = "B"\nstart = [3, 0, 0]\n')

    def export(*words):
        done = CliRunner().invoke(cli.app, ["export", "go.toml", *words])
        return done.exit_code, done.output
    code, said = export("-o", "out.glb", "--onto", "me.glb", "--actor", "B")
    assert code == 0 and "out.glb: 3 frames" in said
    tree = at_frame(tmp_path / "out.glb", 0)
    assert abs(tree.world[tree.names.index("pelvis"), 0, 3] - 3.0) < 0.1, "B's motion"
    assert described(tmp_path / "out.glb")["animations"][0]["name"] == "B"
    for words, told in ((("-o", "me.glb", "--onto", "me.glb"), "would be overwritten"), (("-o", "me.glb", "--character", "me.glb"), "would be overwritten"),
                        (("-o", "o.bvh", "--onto", "me.glb"), "ends in .glb"),
                        (("-o", "o.glb", "--onto", "go.toml"), "no rig is read from it"), (("-o", "o.glb", "--onto", "me.glb", "--actor", "C"), "there are A, B"),
                        (("-o", "o.glb", "--actor", "A"), "--onto")):
        code, said = export(*words)
        assert code == 2 and told in said.replace("\n", " ") and not (tmp_path / "o.glb").exists(), words
