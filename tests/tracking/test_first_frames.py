"""What is not known of a film's first frames: where somebody is, by clicks, and how tall and wide they are."""

import numpy as np
import pytest
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.body import human
from gambol.controllers.tracking import ClickError, Tracker, clicked, exchanged, fitted_shape, read_clicks
from gambol.controllers.tracking.cameras import ring
from gambol.controllers.tracking.silhouettes import shaped
from gambol.controllers.tracking.twists import chain_of, posed

LENSES = ring(3, 4.0, 1.5, (0.0, 1.0, 0.0), (640, 480), 0.7)
JOINTS = [f"{side}{part}" for side in ("Left", "Right") for part in ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "Toe")] + ["Neck", "Head"]


def clicks_of(chain, where, rng=None):
    positions, _, _ = posed(chain, where)
    return {lens.name: {name: tuple(lens.project(positions[chain.skeleton.index(name)])[0] + (0 if rng is None else rng.normal(size=2) * 3))
                        for name in JOINTS} for lens in LENSES}


@pytest.mark.parametrize("height", [1.5, 1.95])
def test_clicks_tell_pose_and_stature(height):
    chain = chain_of(human(height), "paper")
    where = stride(chain, 0.2)
    found, pose = clicked(LENSES, clicks_of(chain, where, np.random.default_rng(0)), "paper")
    assert found.skeleton.offsets[0, 1] / chain.skeleton.offsets[0, 1] == pytest.approx(1.0, abs=0.02)
    ours, true = posed(found, pose)[0], posed(chain, where)[0]
    named = [chain.skeleton.index(name) for name in JOINTS]
    assert np.linalg.norm(ours - true, axis=-1)[named].mean() < 0.03


def test_clicks_are_read_and_mistakes_told(tmp_path):
    file = tmp_path / "c.toml"

    def fails(text, *words):
        file.write_text(text)
        with pytest.raises(ClickError) as told:
            read_clicks(file, LENSES)
        assert all(word in str(told.value) for word in ("c.toml", *words)) and "\n" not in str(told.value)
    file.write_text("width = 1280\n[cam01]\nLeftArm = [100, 50.5]\n")
    assert read_clicks(file, LENSES) == {"cam01": {"LeftArm": (50.0, 25.25)}}
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes().replace(b"\n", b"\r\n"))  # as Windows' editors write it
    assert read_clicks(file, LENSES) == {"cam01": {"LeftArm": (50.0, 25.25)}}
    fails("[cam09]\n", "cam09", "cam01")
    fails("[cam01]\nElbow = [1, 2]\n", "Elbow", "LeftForeArm")
    fails("[cam01]\nLeftArm = [1]\n", "cam01.LeftArm", "x and y")
    fails("[cam01]\nLeftArm = [nan, 1]\n", "cam01.LeftArm")
    fails("[cam01]\nLeftArm = [1, 481]\n", "cam01.LeftArm", "640 × 480", "width")
    fails("width = 320\n[cam01]\nLeftArm = [321, 1]\n", "cam01.LeftArm", "320 × 240")
    fails("width = 3\n", "width")
    fails("[cam01\n")
    file.unlink()
    with pytest.raises(ClickError, match="c.toml"):
        read_clicks(file, LENSES)
    with pytest.raises(ClickError, match="0 joints are seen by two cameras"):
        clicked(LENSES, {"cam01": {"LeftArm": (1.0, 2.0)}})


@pytest.mark.few(1)
@pytest.mark.parametrize("share", [0.5, 0.8, 1.25])
def test_clicks_of_pictures_of_another_size_tell_no_body(share):
    """They lie in the pictures, and a body can be found for them: it hangs where nobody is."""
    chain = chain_of(human(), "paper")
    told = clicks_of(chain, stride(chain, 0.2))
    with pytest.raises(ClickError, match="no body has joints where they were clicked"):
        clicked(LENSES, {camera: {joint: (share * x, share * y) for joint, (x, y) in table.items()} for camera, table in told.items()}, "paper")


@pytest.mark.parametrize("joint", ["LeftFoot", "RightHand"])
def test_a_click_that_slipped_is_named(joint):
    chain = chain_of(human(), "paper")
    told = clicks_of(chain, stride(chain, 0.2))
    told["cam02"][joint] = (5.0, 5.0)
    with pytest.raises(ClickError, match=f"cam02.{joint} is .* from where the other clicks have it"):
        clicked(LENSES, told, "paper")


def mirrored(clicks, parts, cameras):
    """Left and right exchanged of some parts in some cameras."""
    other = {f"{one}{part}": f"{two}{part}" for part in parts for one, two in (("Left", "Right"), ("Right", "Left"))}
    return {camera: {other.get(joint, joint) if camera in cameras else joint: at for joint, at in seen.items()} for camera, seen in clicks.items()}


ARMS, LEGS = ("Arm", "ForeArm", "Hand"), ("UpLeg", "Leg", "Foot", "Toe")


@pytest.mark.parametrize("seed", range(3))
def test_left_and_right_exchanged_are_found(seed):
    chain = chain_of(human(1.5 + 0.15 * seed), "paper")
    told = clicks_of(chain, stride(chain, 0.1 + 0.2 * seed), np.random.default_rng(seed))
    everywhere = [lens.name for lens in LENSES]
    assert exchanged(LENSES, told) == []
    for parts, words in ((ARMS + LEGS, "all of left and right"), (ARMS, "LeftArm and RightArm"), (LEGS, "LeftUpLeg and RightUpLeg"),
                         (ARMS[1:], "LeftForeArm and RightForeArm"), (ARMS[2:], "LeftHand and RightHand"), (LEGS[1:], "LeftLeg and RightLeg")):
        line, = exchanged(LENSES, mirrored(told, parts, everywhere))
        assert words in line
    for parts in (ARMS + LEGS, ARMS, ARMS[1:], LEGS, LEGS[2:]):  # in one camera alone
        lines = exchanged(LENSES, mirrored(told, parts, everywhere[1:2]))
        assert lines and all(line.startswith("cam0") and line.partition(" and ")[0].partition("Left")[2] in parts for line in lines)


def test_a_shape_is_as_tall_and_as_wide_as_asked():
    body = stick_body()
    tall = shaped(body, 1.2)
    np.testing.assert_allclose(tall.vertices, 1.2 * body.vertices, atol=1e-9)
    np.testing.assert_allclose(tall.chain.skeleton.offsets, 1.2 * body.chain.skeleton.offsets)
    wide = shaped(body, 1.0, 1.5)
    leg = body.chain.skeleton.index("LeftLeg")
    mine = body.bones[:, 0] == leg
    for axis, much in ((0, 1.5), (1, 1.0), (2, 1.5)):  # a shin is upright at T-pose
        assert np.ptp(wide.vertices[mine, axis]) == pytest.approx(much * np.ptp(body.vertices[mine, axis]), rel=0.05)
    with pytest.raises(ValueError, match="girth: needs"):
        shaped(body, 1.0, 9.0)


def test_stature_and_girth_are_found_from_silhouettes():
    true = stick_body()
    frames = [masks(true, stride(true.chain, t / 60), cameras(128)) for t in range(3)]
    wrong = Tracker(shaped(true, 1.05, 0.85), cameras(128), 60.0)
    found = fitted_shape(wrong, stride(true.chain, 0.0), stride(true.chain, -1 / 60), frames)
    assert 1.05 * found.stature == pytest.approx(1.0, abs=0.012) and 0.85 * found.girth == pytest.approx(1.0, abs=0.08)
    assert found.overlap > found.before + 0.05
