"""What bones people are likely to have: fitted to performers' skeletons, read with care, and heard where set poses are told of."""

import numpy as np
import pytest

from gambol.controllers.body import Skeleton, exp, forward_kinematics
from gambol.controllers.files import ArraysError
from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.calibration import BONES, JOINTS, POSES, WORN, LikelyBones, Stood, fitted, load_bones, save_bones

HEAD, NECK = (SKELETON.index(name) for name in ("Head", "Neck"))


def body(offsets):
    return Skeleton(SKELETON.names, SKELETON.parents, offsets, SKELETON.end_parents, SKELETON.end_offsets)


def people(seed, count=8, neck=0.08):
    """Performers of all sizes whose heads sit on necks that begin so much lower [m] than ours."""
    rng = np.random.default_rng(seed)
    offsets = SKELETON.offsets * (1.0 + 0.02 * rng.normal(size=(count, len(SKELETON), 1)))
    offsets[:, NECK, 1] -= neck
    offsets[:, HEAD, 1] += neck
    return [body(some * size) for some, size in zip(offsets, rng.uniform(0.9, 1.1, count), strict=True)]


def test_a_performer_nobody_was_fitted_to_is_likelier_than_one_of_another_kind():
    likely = LikelyBones.of({"low": people(1), "few": people(2, 2, -0.2)})
    assert likely.names == ("low", "Gambol") and list(likely.people) == [8, 5]
    other = LikelyBones.of({"low": people(3)})
    inverse = np.linalg.inv(likely.spread)
    near, far = ((mean - likely.means[0]) @ inverse @ (mean - likely.means[0]) for mean in other.means)
    assert near < 0.1 * far


def test_sizes_are_no_matter():
    some, larger = people(4), [body(1.2 * one.offsets) for one in people(4)]
    assert np.allclose(LikelyBones.of({"a": some}).means, LikelyBones.of({"a": larger}).means, atol=0.1)  # over a centimetre; soles are as thick on all


def test_poses_tell_bones_nearer_where_people_are_known():
    """The head's neck begins 8 cm lower than ours; no tracker tells more of it than a nod."""
    them = people(5)[0]
    asked = np.array(list(POSES.values()))
    rotations = asked @ exp(np.radians(2.0) * np.random.default_rng(5).normal(size=(*asked.shape[:2], 3)))
    rotations[:, 0] = np.eye(3)
    positions, turns = forward_kinematics(them, np.zeros((len(asked), 3)), rotations)
    toes = positions[:, [SKELETON.index("LeftToe"), SKELETON.index("RightToe")], 1].min(-1)
    places, turns = positions[:, JOINTS] - [0.0, 1.0, 0.0] * toes[:, None, None], turns[:, JOINTS]
    stood = Stood.of(places[:1], turns[:1], np.ones((1, len(WORN)), bool))
    away = []
    for neck in (0.08, 0.0):
        known = fitted(stood, places, turns, range(len(POSES)), LikelyBones.of({"known": people(6, neck=neck)}))
        away.append(np.linalg.norm(known.bones / known.stood.scale[0] - them.offsets, axis=-1)[[NECK, HEAD]])
    assert (away[0] < 0.6 * away[1]).all()


def test_what_ships_is_read_and_what_is_written_is_read_again(tmp_path):
    shipped = load_bones()
    assert {"Acclaim", "cgspeed", "Gambol"} == set(shipped.names) and shipped.people.min() >= 5
    save_bones(tmp_path / "b.npz", LikelyBones.of({"low": people(1)}))
    assert load_bones(tmp_path / "b.npz").names == ("low", "Gambol")


def test_a_table_that_is_damaged_is_named(tmp_path):
    with np.load(BONES) as file:
        whole = {name: file[name] for name in file.files}
    for name, wrong, words in (("spread", -whole["spread"], "normal"), ("means", whole["means"][:, :-1], "means"), ("version", np.array(7), "version")):
        np.savez(tmp_path / f"{name}.npz", **(whole | {name: wrong}))
        with pytest.raises(ArraysError, match=f"{name}.npz.*{words}"):
            load_bones(tmp_path / f"{name}.npz")


def test_few_performers_tell_nothing():
    with pytest.raises(ValueError, match="no family of 5"):
        LikelyBones.of({"low": people(1, 3)})
