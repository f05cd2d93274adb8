"""The library's file: what is written comes back, and anything else is refused by name."""

import io
import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import human, rotations as rot
from gambol.controllers.locomotion import Library, LibraryError, Locomotion, fourier
from gambol.controllers.locomotion.library import DURATION, HIPS


@pytest.fixture(scope="session")
def few(library):
    """Nine primitives: enough to read and write, small enough to damage often."""
    keep = np.append(np.arange(8), library.rest)
    return replace(library, primitives=tuple(library.primitives[i] for i in keep), bends={}, accelerations={},
                   velocities=library.velocities[keep], coefficients=library.coefficients[keep])


@pytest.fixture(scope="session")
def sound(few, tmp_path_factory):
    """The bytes of a sound library file."""
    path = tmp_path_factory.mktemp("sound") / "library.npz"
    few.save(path)
    return path.read_bytes()


def assert_same(a, b):
    assert a.skeleton.names == b.skeleton.names and a.primitives == b.primitives and a.provenance == b.provenance
    np.testing.assert_allclose(a.skeleton.offsets, b.skeleton.offsets, atol=1e-12)
    np.testing.assert_array_equal(a.velocities, b.velocities)
    np.testing.assert_array_equal(a.coefficients.astype(np.float32), b.coefficients.astype(np.float32))
    np.testing.assert_array_equal(a.reference, b.reference)
    for name in ("bends", "accelerations"):
        ours, theirs = getattr(a, name), getattr(b, name)
        assert ours.keys() == theirs.keys()
        for key in ours:
            np.testing.assert_array_equal(ours[key], theirs[key])


def test_reading_undoes_writing(library, tmp_path):
    library.save(tmp_path / "again.npz")
    assert_same(Library.load(tmp_path / "again.npz"), library)


@pytest.mark.parametrize("factor", (0.8, 1.13))
def test_other_statures_come_back(few, tmp_path, factor):
    grown = replace(few, skeleton=human().scaled(factor), provenance="größer")
    grown.save(tmp_path / "grown.npz")
    assert_same(Library.load(tmp_path / "grown.npz"), grown)


def test_the_shipped_library_is_sound(library):
    assert np.isfinite(library.coefficients).all() and np.isfinite(library.velocities).all()
    np.testing.assert_allclose(library.reference @ library.reference.transpose(0, 2, 1), np.tile(np.eye(3), (22, 1, 1)), atol=1e-9)
    assert library.primitives[library.rest].family == "rest"
    np.testing.assert_array_equal(library.velocities[library.rest], 0)
    families = [library.family(name) for name in ("walk", "run")]
    np.testing.assert_array_equal(np.sort(np.concatenate(families)), np.arange(len(library.primitives)))
    assert library.rest in families[0] and library.rest not in families[1]
    assert len(library.primitives) >= 68, "what the paper's protocol asks for"
    assert "mocap.cs.cmu.edu" in library.provenance
    for p in library.primitives:
        assert p.clip and p.label and p.period > 0 and p.averaged >= 1 and len(p.events) == 4
        assert p.closure <= np.radians(9 if p.family != "run" else 15)
        assert p.events[0] == 0 and np.all(np.diff(p.events) > 0)


def test_natural_primitives_come_first(library):
    """Mirrored copies only fill gaps."""
    assert np.mean([p.mirrored for p in library.primitives]) < 0.2


def test_the_lengths_of_cycles_are_what_their_series_say(library):
    """The mean of dt/dφ is the period, for those that were not averaged with others."""
    for p, rows in zip(library.primitives, library.coefficients):
        if p.averaged == 1:
            assert rows[0, -1] == pytest.approx(p.period, rel=2e-3)
        assert 0.4 < rows[0, -1] < 2.6


# what is not a library

def refused(data, path):
    path.write_bytes(data)
    with pytest.raises(LibraryError) as caught:
        Library.load(path)
    assert str(path) in str(caught.value)


def test_a_missing_file_says_how_to_build_one(tmp_path):
    with pytest.raises(LibraryError, match=r"none\.npz: no such library; build one with `gambol library build"):
        Locomotion.load(tmp_path / "none.npz")


def test_a_file_of_another_kind_is_called_so(tmp_path):
    (tmp_path / "body.glb").write_bytes(bytes(range(1, 200)))
    with pytest.raises(LibraryError, match=r"body\.glb: not a gait library \(no \.npz file at all\)"):
        Library.load(tmp_path / "body.glb")


def test_a_folder_is_no_library(tmp_path):
    with pytest.raises(LibraryError, match=str(tmp_path.name)):
        Library.load(tmp_path)


def packed(**arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def single(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


@pytest.mark.parametrize("data", (
    b"", b"PK", b"not a library at all\n" * 9, single(np.eye(3)), packed(a=np.eye(3)),
    packed(about=np.zeros(3, np.uint8)), packed(about=np.frombuffer(b"[1, 2]", np.uint8)),
    packed(about=np.frombuffer(b'{"height": 1.0, "primitives": []}', np.uint8)), single(np.array([{}], object))),
    ids=("empty", "two bytes", "text", "array", "foreign arrays", "zeros", "list", "no primitives", "pickle"))
def test_foreign_files_are_refused_by_name(data, tmp_path):
    refused(data, tmp_path / "foreign.npz")


@settings(max_examples=60, deadline=None)
@given(share=st.floats(0, 1, exclude_max=True))
def test_truncated_files_are_refused_by_name(sound, tmp_path, share):
    refused(sound[:int(share * len(sound))], tmp_path / "short.npz")


@settings(max_examples=150, deadline=None)
@given(changes=st.lists(st.tuples(st.one_of(st.integers(0, 400), st.integers(-700, -1), st.integers(0, 10**6)),
                                  st.integers(0, 255)), min_size=1, max_size=4))
def test_damaged_files_are_refused_by_name_or_hold_sound_arrays(sound, tmp_path, changes):
    """Single bytes changed at the front, in the table of contents at the end, or anywhere."""
    data = bytearray(sound)
    for at, value in changes:
        data[at % len(data)] = value
    path = tmp_path / "damaged.npz"
    path.write_bytes(data)
    try:
        library = Library.load(path)
    except LibraryError as error:
        assert str(path) in str(error)
    else:
        assert np.isfinite(library.coefficients).all() and library.velocities.shape == (9, 3)


@pytest.mark.parametrize("name, change", (
    ("velocities", lambda a: a[:-1]), ("velocities", lambda a: a.astype(complex)), ("velocities", lambda a: a * np.nan),
    ("reference", lambda a: a[:-1]), ("reference", lambda a: a * np.inf), ("coefficients", lambda a: a[0]),
    ("coefficients", lambda a: a[:, :, :-1]), ("coefficients", lambda a: a[:, :-1]), ("coefficients", lambda a: a[:-1]),
    ("coefficients", lambda a: np.where(a == a.max(), np.nan, a)), ("coefficients", lambda a: np.array("x"))))
def test_arrays_that_do_not_fit_are_refused_by_name(sound, tmp_path, name, change):
    with np.load(io.BytesIO(sound)) as file:
        arrays = dict(file)
    arrays[name] = change(arrays[name])
    refused(packed(**arrays), tmp_path / "misfit.npz")


@pytest.mark.parametrize("edit", (
    lambda about: about.pop("height"), lambda about: about.update(height="tall"), lambda about: about.update(height=None),
    lambda about: about["primitives"].pop(), lambda about: about["primitives"][0].pop("clip"),
    lambda about: about["primitives"][0].update(colour="red"), lambda about: about["primitives"][-1].update(family="walk"),
    lambda about: about.update(primitives={"a": 1})))
def test_descriptions_that_do_not_fit_are_refused_by_name(sound, tmp_path, edit):
    with np.load(io.BytesIO(sound)) as file:
        arrays = dict(file)
    about = json.loads(bytes(arrays["about"]))
    edit(about)
    refused(packed(**arrays | {"about": np.frombuffer(json.dumps(about).encode(), np.uint8)}), tmp_path / "misfit.npz")


def test_hands_turn_as_smoothly_as_arms_swing(library):
    """No marker that was lost for a frame twitches a wrist in any primitive: at 43 rad/s one did."""
    phase = np.arange(256) / 256
    rows = fourier.evaluate(np.asarray(library.coefficients, float), phase)
    hands = [library.skeleton.index(side + "Hand") for side in ("Left", "Right")]
    local = rot.exp(rows[..., :HIPS].reshape(*rows.shape[:2], -1, 3)[:, :, hands])
    turned = rot.log(np.swapaxes(local, -1, -2) @ np.roll(local, -1, axis=1))
    rates = np.linalg.norm(turned, axis=-1) / (rows[..., DURATION] / 256)[..., None]
    assert rates[np.arange(len(rates)) != library.rest].max() < 9.0
