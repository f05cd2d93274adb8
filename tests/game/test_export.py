"""Exported motion, read back by other people's readers: joints, contacts, time, bodies."""

import json
import struct
import sys
from dataclasses import replace
from pathlib import Path

import foreign
import numpy as np
import pytest

from gambol.controllers.body import Pose, human
from gambol.controllers.body.rotations import exp, yaw
from gambol.game.character import load
from gambol.game.files.paths import OutputError
from gambol.game.output import export
from gambol.game.render import skin
from gambol.game.world.world import RATE

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts" / "measure"))

from export import bvh_joints, glb_joints, own_joints  # noqa: E402

RNG = np.random.default_rng(4)


def take(name="Ada", height=1.741, frames=50, **more):
    """Somebody turning all joints by up to a right angle while running around."""
    skeleton = human(height)
    turns = RNG.uniform(-1.0, 1.0, (6, len(skeleton), 3)) * [1.2, 1.2, 1.2]
    times = np.linspace(0.0, 5.0, frames)
    low = np.minimum(times.astype(int), 4)
    share = (times - low)[:, None, None]
    rotations = exp((1 - share) * turns[low] + share * turns[low + 1])
    rotations[:, 0] = yaw(times * 4.0) @ rotations[:, 0]
    roots = np.stack([80.0 * np.sin(times), 1.0 + 0.0 * times, 80.0 * np.cos(times)], 1)
    return export.Take(name, skeleton, tuple(map(Pose, roots, rotations)), RNG.random((frames, 4)) > 0.5, **more)


def described(path):
    data = path.read_bytes()
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


def test_bvh_puts_joints_where_we_have_them(tmp_path):
    one = take()
    file, = export.write(tmp_path / "x.bvh", [one], 30.0)
    read = bvh_joints(file)
    assert max(np.abs(read[name] - at).max() for name, at in own_joints(one).items()) < 1e-5
    assert "Frame Time: 0.0333333333" in file.read_text()


@pytest.mark.parametrize("bodies", [False, True])
def test_glb_puts_everybodys_joints_where_we_have_them(tmp_path, bodies):
    everybody = [take(), take("Béla", height=1.3)]
    if bodies:
        foreign.write(tmp_path / "b.glb", scales={"LeftLeg": 1.1, "RightLeg": 1.1})
        everybody = [replace(one, body=load(tmp_path / "b.glb")) for one in everybody]
    file, = export.write(tmp_path / "x.glb", everybody, 25.0)
    read = glb_joints(file)
    for one in everybody:
        for name, at in own_joints(one).items():
            assert np.abs(read[f"{one.name}/{name}"] - at).max() < 1e-4
    accessors = described(file)["accessors"]
    assert any(a["count"] == 50 and a.get("max") == [np.float32(49 / 25)] for a in accessors), "seconds at 25 a second"


def test_contacts_go_along(tmp_path):
    one = take()
    file = described(export.write(tmp_path / "x.glb", [one], 60.0)[0])
    bits = file["animations"][0]["extras"]["contacts"]["Ada"]
    assert np.array_equal(np.array(bits)[:, None] >> np.arange(4) & 1, one.contacts.astype(int))
    node = next(n for n in file["nodes"] if n["name"] == "Ada")
    assert node["extras"] == {"fps": 60.0, "contacts": bits}


@pytest.mark.parametrize("height", [1.741, 1.2])
def test_the_rest_pose_stands_on_the_floor_in_metres_and_faces_z(tmp_path, height):
    """As other programs show the file before it plays: T-pose, sole at 0, toes towards +Z, left at +X."""
    body = load(export.write(tmp_path / "x.glb", [take(height=height)])[0])
    at = body.levels[0].positions
    assert abs(at[:, 1].min()) < 2e-3 and abs(at[:, 1].max() / height - 1.0) < 0.01
    assert np.abs(body.joints - skin.REST * height / 1.741).max() < 1e-4
    names = [n["name"] for n in described(tmp_path / "x.glb")["nodes"]]
    assert set(skin.STANDARD.names) <= set(names)


def test_rotations_take_the_short_way_between_frames(tmp_path):
    file, = export.write(tmp_path / "x.glb", [take(frames=400)])
    from gambol.game.character import gltf
    document = gltf.read(file)
    for channel in document.json["animations"][0]["channels"]:
        if channel["target"]["path"] == "rotation":
            q = document.accessor(document.json["animations"][0]["samplers"][channel["sampler"]]["output"])
            assert (np.sum(q[1:] * q[:-1], 1) > 0.0).all() and np.allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-6)


def test_several_characters_have_a_bvh_each(tmp_path):
    files = export.write(tmp_path / "x.bvh", [take("Ada"), take("Bob")])
    assert [f.name for f in files] == ["x-Ada.bvh", "x-Bob.bvh"] and all(f.is_file() for f in files)


class Stage:
    """A world, as far as the export looks at it: somebody at x, by number of frames."""

    def __init__(self, *people):
        from types import SimpleNamespace as S
        self.characters = [S(name=name, controller=S(skeleton=human(), body=None), tint=(1, 1, 1), state=S(
            pose=Pose(np.array([x, 1.0, 0.0]), np.broadcast_to(np.eye(3), (22, 3, 3))), contacts=np.ones(4, bool)))
            for name, x in people]


def test_who_joins_later_waits_where_they_appear():
    ada, both = Stage(("Ada", 0.0)), Stage(("Ada", 1.0), ("Bob", 5.0))
    one, other = export.takes([(ada, ada, 1.0), (ada, both, 0.5), (both, both, 1.0)])
    assert [pose.root[0] for pose in one.poses] == [0.0, 0.5, 1.0]
    assert [pose.root[0] for pose in other.poses] == [5.0] * 3 and len(other.contacts) == 3


@pytest.mark.parametrize("fps", [24.0, 60.0, 100.0])
def test_moments_are_sampled_at_any_rate(fps):
    """Somebody who moves a metre a tick is at time × RATE metres, whatever the frame rate."""
    class SessionState:
        def __init__(self, tick):
            self.before, self.after = Stage(("Ada", max(tick - 1.0, 0.0))), Stage(("Ada", float(tick)))

        def fraction(self, alpha):
            return alpha
    one, = export.takes(export.sampled((SessionState(tick) for tick in range(61)), fps))
    assert len(one.poses) == fps + 1
    assert np.allclose([pose.root[0] for pose in one.poses], np.arange(fps + 1) * RATE / fps)


def test_what_cannot_be_written_is_said(tmp_path):
    with pytest.raises(OutputError, match="nothing was played"):
        export.write(tmp_path / "x.glb", [])
    with pytest.raises(OutputError, match=".bvh or .glb"):
        export.write(tmp_path / "x.fbx", [take()])
    broken = take()
    broken.poses[3].root[0] = np.nan
    with pytest.raises(ValueError, match="finite"):
        export.write(tmp_path / "x.glb", [broken])
    assert not list(tmp_path.glob("*"))


def test_the_key_keeps_what_was_played_since_the_last_reset(tmp_path):
    from stand_in import Glide

    from gambol.game.app.app import Play
    from gambol.game.app.capture import Capture

    game = Play(Glide(), capture=Capture(tmp_path))
    for tick in range(50):
        if tick == 30:
            game.do("reset")
        game.tick(1 / RATE)
    game.do("export")
    game.kept.capture.finish(lambda line: None)
    file, = tmp_path.glob("*.glb")
    assert any(file.name in text for text in game.kept.notices)
    frames = len(described(file)["animations"][0]["extras"]["contacts"]["Player 1"])
    assert 15 <= frames <= 21


def test_the_commands_write_what_they_are_asked_for(tmp_path, monkeypatch):
    from stand_in import Glide
    from typer.testing import CliRunner

    from gambol.game import cli

    def said(*words):
        done = CliRunner().invoke(cli.app, list(map(str, words)))
        return done.exit_code, done.output
    assert said("character", "-o", tmp_path / "kid.glb", "--height", 1.2, "--child", 1)[0] == 0
    assert abs(load(tmp_path / "kid.glb").levels[0].positions[:, 1].max() - 1.2) < 0.01
    code, text = said("character", "-o", tmp_path / "x.glb", "--height", 12)
    assert code == 2 and "height 12" in text
    code, text = said("export", "demo", "-o", tmp_path / "x.glb", "--character", tmp_path / "none.glb")
    assert code == 2 and "none.glb: can't be read" in text
    monkeypatch.setattr("gambol.controllers.person.person", lambda *_: Glide())
    assert said("export", "start_stop", "-o", tmp_path / "x.glb", "--fps", 10)[0] == 0
    assert described(tmp_path / "x.glb")["animations"][0]["extras"]["fps"] == 10
    code, text = said("export", "start_stop", "-o", tmp_path / "x.fbx")
    assert code == 2 and ".bvh or .glb" in text
