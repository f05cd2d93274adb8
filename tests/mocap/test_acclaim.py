"""Acclaim: bones at rest stand where the ASF puts them, and turn as C·M·C⁻¹."""

import numpy as np
import pytest
from hypothesis import given, settings
from motion_samples import AMC, ASF, seeds
from scipy.spatial.transform import Rotation

from gambol.controllers.body import end_positions
from gambol.controllers.mocap import MotionFileError, read_amc, read_asf

METRE = 0.0254 / 0.5


@pytest.fixture
def chain(tmp_path):
    (tmp_path / "01.asf").write_text(ASF)
    (tmp_path / "01_01.amc").write_text(AMC)
    return tmp_path


def about(order, angles):
    """Turns about fixed axes, the first named first."""
    turn = np.eye(3)
    for axis, angle in zip(order, angles):
        turn = Rotation.from_euler(axis, angle, degrees=True).as_matrix() @ turn
    return turn


def words(values):
    return " ".join(repr(float(value)) for value in values)


def test_bones_at_rest_stand_where_the_file_puts_them(chain):
    body = read_asf(chain / "01.asf")
    skeleton = body.skeleton
    assert skeleton.names == ("root", "thigh", "shin", "toe")
    assert body.dofs == (("tx", "ty", "tz", "rx", "ry", "rz"), ("rx", "ry", "rz"), ("rx",), ())
    assert body.metre == pytest.approx(METRE)
    np.testing.assert_allclose(skeleton.offsets, np.array([[0, 0, 0], [0, 0, 0], [0, -8, 0], [4.2, -5.6, 0]]) * METRE)
    np.testing.assert_allclose(skeleton.end_offsets, [[0, 0, 2 * METRE]])
    np.testing.assert_allclose(body.axes[1], about("xyz", (10, 20, 30)), atol=1e-12)


def test_joints_turn_in_their_own_axes(chain):
    clip = read_amc(chain / "01_01.amc")
    assert len(clip) == 2 and clip.frame_time == 1 / 120
    np.testing.assert_allclose(clip.root, np.array([[1, 2, 3], [1.5, 2, 3]]) * METRE)
    np.testing.assert_allclose(clip.rotations[0, 0], about("xyz", (10, 20, 30)), atol=1e-12)
    axes = about("xyz", (10, 20, 30))
    np.testing.assert_allclose(clip.rotations[0, 1], axes @ about("xyz", (40, -50, 60)) @ axes.T, atol=1e-12)
    axes = about("zyx", (20, 0, 0))
    np.testing.assert_allclose(clip.rotations[1, 2], axes @ about("x", [-2.5]) @ axes.T, atol=1e-12)
    np.testing.assert_array_equal(clip.rotations[:, 3], np.broadcast_to(np.eye(3), (2, 3, 3)))


@settings(max_examples=30, deadline=None)
@given(seed=seeds)
def test_any_axes_and_orders(tmp_path_factory, seed):
    """The chain's toe is where the product of C·M·C⁻¹ puts it."""
    rng = np.random.default_rng(seed)
    order = "".join(rng.permutation(list("xyz")))
    dofs = [f"r{axis}" for axis in rng.permutation(list("xyz"))]
    frame, turn, shin = rng.uniform(-180, 180, (3, 3))
    folder = tmp_path_factory.mktemp("acclaim")
    (folder / "a.asf").write_text(ASF.replace("axis 10 20 30 XYZ", f"axis {words(frame)} {order}")
                                  .replace("dof rx ry rz", "dof " + " ".join(dofs)))
    (folder / "a.amc").write_text(f"1\nroot 0 0 0 0 0 0\nshin {words(shin[:1])}\nthigh {words(turn)}\n")
    clip = read_amc(folder / "a.amc")
    axes = about(order, [frame["xyz".index(axis)] for axis in order])
    thigh = axes @ about([dof[1] for dof in dofs], turn) @ axes.T
    tilt = about("z", [20])
    shin = thigh @ tilt @ about("x", shin[:1]) @ tilt.T
    positions, orientations = clip.kinematics()
    toe = end_positions(clip.skeleton, positions, orientations)[0, 0]
    expected = thigh @ [0, -8, 0] + shin @ [4.2, -5.6, 0] + shin @ [0, 0, 2]
    np.testing.assert_allclose(toe, expected * METRE, atol=1e-12)


def test_radians_read_the_same(chain):
    degrees = read_amc(chain / "01_01.amc")
    amc = AMC.replace(":DEGREES", ":RADIANS").replace("40 -50 60", words(np.radians([40, -50, 60])))
    (chain / "01_02.amc").write_text(amc)
    radians = read_amc(chain / "01_02.amc")
    np.testing.assert_allclose(radians.quaternions[0, 1], degrees.quaternions[0, 1], atol=1e-12)


def test_the_skeleton_is_found_or_named(chain):
    amc = chain / "01_01.amc"
    (chain / "02.asf").write_text(ASF.replace("length 8", "length 9"))
    assert read_amc(amc).skeleton.offsets[2, 1] == pytest.approx(-8 * METRE)
    assert read_amc(amc, chain / "02.asf").skeleton.offsets[2, 1] == pytest.approx(-9 * METRE)
    assert read_amc(amc, read_asf(chain / "02.asf"), fps=60).frame_time == 1 / 60
    amc.rename(chain / "other.amc")
    with pytest.raises(MotionFileError, match="2 .asf files beside it"):
        read_amc(chain / "other.amc")


def test_windows_line_ends(chain):
    plain = read_amc(chain / "01_01.amc")
    for name, text in (("01.asf", ASF), ("01_01.amc", AMC)):
        (chain / name).write_bytes(text.replace("\n", "\r\n").encode())
    np.testing.assert_array_equal(read_amc(chain / "01_01.amc").quaternions, plain.quaternions)
