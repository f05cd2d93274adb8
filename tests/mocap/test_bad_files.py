"""A broken file gives a MotionFileError that names file and line, and never anything else."""

import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_samples import AMC, ASF, BVH

from gambol.controllers.body import Clip
from gambol.controllers.mocap import MotionFileError, load, read_amc, read_asf, read_bvh

BROKEN_BVH = {
    "empty": (lambda t: "", 1, "empty"),
    "blank": (lambda t: " \n\n ", 1, "empty"),
    "another format": (lambda t: "{\"a\": 1}", 1, "'{' where 'HIERARCHY' should stand"),
    "truncated header": (lambda t: t[:t.index("End Site")], 9, "'LeftFoot' of line 6 is still open"),
    "no frames at all": (lambda t: t[:t.index("1 2 3")], 18, "the file ends after 0 frames"),
    "truncated frames": (lambda t: t[:t.index("1.5 2")], 19, "ends after 1 frames, but the header declares 2"),
    "truncated row": (lambda t: t[:t.index(" .5 60.")], 20, "7 values, .* 9 channels; the file ends here"),
    "short row": (lambda t: t.replace("1 2 3 10", "1 2 10"), 19, "8 values, but the header declares 9 channels"),
    "long row": (lambda t: t.replace("1 2 3 10", "1 2 3 4 10"), 19, "10 values, but the header declares 9"),
    "too many rows": (lambda t: t + "1 2 3 4 5 6 7 8 9\n", 21, "more frames than the 2"),
    "nan": (lambda t: t.replace("10 20 30", "10 nan 30"), 19, "value 5 of 9 is 'nan', not a finite number"),
    "infinity": (lambda t: t.replace("10 20 30", "-inf 20 30"), 19, "value 4 of 9 is '-inf'"),
    "overflow": (lambda t: t.replace("10 20 30", "1e999 20 30"), 19, "value 4 of 9 is '1e999'"),
    "comma": (lambda t: t.replace("10 20 30", "10,5 20 30"), 19, "'10,5', not a finite number"),
    "nan offset": (lambda t: t.replace("1 -2 3", "1 nan 3"), 8, "OFFSET of 'LeftFoot' needs 3 numbers"),
    "infinite offset": (lambda t: t.replace("1 -2 3", "1 -2e999 3"), 8, "'-2e999' is not a finite number"),
    "short offset": (lambda t: t.replace("1 -2 3", "1 -2"), 8, "needs 3 numbers, found 2"),
    "no offset": (lambda t: t.replace("\t\tOFFSET 1 -2 3\n", ""), 13, "'LeftFoot' of line 6 has no OFFSET"),
    "zero frames": (lambda t: t.replace("Frames: 2", "Frames: 0"), 17, "zero frames; at least one"),
    "negative frames": (lambda t: t.replace("Frames: 2", "Frames: -2"), 17, "must be a whole number, not '-2'"),
    "a huge claim": (lambda t: t.replace("Frames: 2", "Frames: 10000000000"), 20, "declares 10000000000"),
    "no frame time": (lambda t: t.replace("Frame Time: 0.01\n", ""), 18, "'1' where 'Frame' should stand"),
    "frame time zero": (lambda t: t.replace("0.01", "0"), 18, "must be above zero and at most 2 seconds, not 0"),
    "frame time of years": (lambda t: t.replace("0.01", "1e9"), 18, "at most 2 seconds, not 1e\\+09"),
    "frame time infinite": (lambda t: t.replace("0.01", "inf"), 18, "'inf' is not a finite number"),
    "unknown channel": (lambda t: t.replace("Xposition", "Wposition"), 5, "unknown channel 'Wposition'"),
    "fewer channels": (lambda t: t.replace("CHANNELS 3", "CHANNELS 4"), 9, "declares 4 CHANNELS but names 3"),
    "more channels": (lambda t: t.replace("CHANNELS 3", "CHANNELS 2"), 9, "'Yrotation' is one channel more"),
    "a huge count of channels": (lambda t: t.replace("CHANNELS 3", "CHANNELS 99999999999"), 9, "but names 3"),
    "position twice": (lambda t: t.replace("Yposition", "Xposition"), 5, "'Hips' has Xposition twice"),
    "no channels": (lambda t: t.replace("CHANNELS", "PATHS"), 5, "'PATHS' where JOINT"),
    "missing brace": (lambda t: t.replace("\t}\n}\nMOTION", "}\nMOTION"), 15, "'MOTION' where JOINT, .* 'Hips'"),
    "brace too many": (lambda t: t.replace("\nMOTION", "\n}\nMOTION"), 16, "'}' where MOTION should stand"),
    "brace not opened": (lambda t: t.replace("ROOT Hips\n{", "ROOT Hips\n"), 2, "no '{' after ROOT"),
    "no name": (lambda t: t.replace("JOINT LeftFoot", "JOINT"), 6, "JOINT needs a name"),
    "duplicate joint": (lambda t: t.replace("LeftFoot", "Hips"), 6, "'Hips' was already declared in line 2"),
    "two roots": (lambda t: t.replace("MOTION", "ROOT Other"), 16, "a second ROOT"),
    "no motion": (lambda t: t.replace("MOTION\n", ""), 16, "'Frames:' where MOTION should stand"),
}


@pytest.mark.parametrize("fault", BROKEN_BVH)
def test_broken_bvh(tmp_path, fault):
    change, line, message = BROKEN_BVH[fault]
    check(tmp_path / "walk.bvh", change(BVH), line, message)


BROKEN_AMC = {
    "empty": (lambda t: "", 1, "empty"),
    "zero frames": (lambda t: t[:t.index("1\nroot")], 3, "zero frames"),
    "no frame number": (lambda t: t.replace("1\nroot", "root"), 4, "'root' where the number of the first frame"),
    "truncated frame": (lambda t: t[:t.index("shin -2.5")], 11, "within frame 2, before bone 'shin'"),
    "truncated row": (lambda t: t[:t.index(" 6.1e-015")], 10, "'thigh' needs 3 values"),
    "short row": (lambda t: t.replace("41 -51", "41"), 10, "'thigh' needs 3 values"),
    "long row": (lambda t: t.replace("41 -51", "41 -51 7"), 10, "'thigh' needs 3 values"),
    "nan": (lambda t: t.replace("41 -51", "nan -51"), 10, "'nan' among the values of bone 'thigh'"),
    "another bone": (lambda t: t.replace("thigh 41", "thumb 41"), 10, "'thumb' where bone 'thigh' should stand"),
    "a longer name": (lambda t: t.replace("thigh 41", "thighs 41"), 10, "'thighs' where bone 'thigh'"),
    "unknown bone": (lambda t: t.replace("thigh 40", "tail 40"), 6, "'tail' is not in the skeleton"),
    "bone twice": (lambda t: t.replace("shin 25", "thigh 1 2 3"), 7, "'thigh' comes twice"),
    "bone missing": (lambda t: t.replace("shin 25\n", ""), 6, "the first frame lacks bone 'shin'"),
    "more channels than the skeleton's": (lambda t: t.replace("shin 25", "shin 25 30"), 7,
                                          r"2 values, but 1 channels \(rx\)"),
    "not text": (lambda t: t.replace("thigh 41", "\udcff\udcfe 41"), 10, "where bone 'thigh' should stand"),
}


@pytest.mark.parametrize("fault", BROKEN_AMC)
def test_broken_amc(tmp_path, fault):
    change, line, message = BROKEN_AMC[fault]
    (tmp_path / "walk.asf").write_text(ASF)
    check(tmp_path / "walk.amc", change(AMC), line, message)


BROKEN_ASF = {
    "empty": (lambda t: "", 1, "empty"),
    "another format": (lambda t: BVH, 1, "'HIERARCHY' before any section"),
    "truncated": (lambda t: t[:t.index(":hierarchy")], 39, "no :hierarchy section"),
    "truncated bone": (lambda t: t[:t.index("  end\n  begin\n     id 2")], 23, "no :hierarchy section"),
    "bone without end": (lambda t: t.replace("  end\n  begin\n     id 2", "  begin\n     id 2"), 24,
                         "begun in line 14 has no end"),
    "no length": (lambda t: t.replace("     length 7\n", ""), 31, "begun in line 25 has no length"),
    "nan": (lambda t: t.replace("length 7", "length nan"), 29, "'nan' is not a finite number"),
    "short direction": (lambda t: t.replace("0 -1 0", "0 -1"), 17, "direction needs 3 numbers, found 2"),
    "unknown channel": (lambda t: t.replace("dof rx ry rz", "dof rx ry rw"), 20, "channel 'rw'"),
    "axis order": (lambda t: t.replace("30 XYZ", "30 XYY"), 19, "not 'XYY'"),
    "unit of angle": (lambda t: t.replace("angle deg", "angle gon"), 7, "deg or rad, not 'gon'"),
    "unit of length": (lambda t: t.replace("length 0.5", "length 0"), 6, "must be above zero"),
    "bone twice": (lambda t: t.replace("name shin", "name thigh"), 25, "a second bone 'thigh'"),
    "unknown in hierarchy": (lambda t: t.replace("shin toe", "shin tail"), 44, "names 'tail', which :bonedata"),
    "a circle": (lambda t: t.replace("root thigh", "toe thigh"), 14, "'thigh' has no way to the root"),
    "two parents": (lambda t: t.replace("shin toe", "shin toe thigh"), 44, "'thigh' has a place in the hierarchy"),
    "left out": (lambda t: t.replace("    shin toe\n", ""), 33, "bone 'toe' has no way to the root"),
}


@pytest.mark.parametrize("fault", BROKEN_ASF)
def test_broken_asf(tmp_path, fault):
    change, line, message = BROKEN_ASF[fault]
    (tmp_path / "walk.amc").write_text(AMC)
    check(tmp_path / "walk.asf", change(ASF), line, message, tmp_path / "walk.amc")


def check(path, text, line, message, opened=None):
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(MotionFileError, match=message) as caught:
        load(opened or path)
    assert str(caught.value).startswith(f"{path}, line {line}: ")


def test_what_is_no_file(tmp_path):
    for path, message in ((tmp_path / "none.bvh", "no such file"), (tmp_path / "none.amc", "no such file"),
                          (tmp_path / "a.txt", "'.txt' is no motion file: .bvh and .amc are read$"),
                          (tmp_path / "a.FBX", "'.fbx' is no motion file: .* are read; export it as BVH"), (tmp_path / "a.asf", "are read; name the .amc file that goes with it"), (tmp_path, "is a folder: name a .bvh or .amc file"),
                          (tmp_path / "nul\0.bvh", "can't be opened")):
        with pytest.raises(MotionFileError, match=message):
            load(path)
    for read in (read_bvh, read_amc, read_asf):
        with pytest.raises(MotionFileError, match="is a directory"):
            read(tmp_path)
    (tmp_path / "a.amc").write_text(AMC)
    with pytest.raises(MotionFileError, match="a.amc: no .asf files beside it; put its skeleton there"):
        load(tmp_path / "a.amc")
    with pytest.raises(MotionFileError, match="none.asf: there is no such file"):
        load(tmp_path / "a.amc", asf=tmp_path / "none.asf")


def test_what_is_no_text(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_bytes(BVH.replace("LeftFoot", "F\xfc\xdf").encode("latin-1"))
    with pytest.raises(MotionFileError, match="line 6: byte 0xfc is not UTF-8 text; save the file as plain text"):
        read_bvh(path)
    path.write_bytes(BVH.encode("utf-16"))
    with pytest.raises(MotionFileError, match="line 1: byte 0xff is not UTF-8"):
        read_bvh(path)


def test_a_claim_costs_nothing(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text(BVH.replace("Frames: 2", "Frames: 10000000000"))
    with pytest.raises(MotionFileError):  # what this imports is no cost of the claim
        read_bvh(path)
    tracemalloc.start()
    with pytest.raises(MotionFileError):
        read_bvh(path)
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()


def test_very_deep_trees(tmp_path):
    """A chain longer than Python's own stack is read, or refused, but nothing breaks."""
    path = tmp_path / "a.bvh"
    depth = 3000
    joints = "".join(f"JOINT j{i} {{ OFFSET 0 1 0 CHANNELS 1 Xrotation " for i in range(depth))
    path.write_text(f"HIERARCHY ROOT r {{ OFFSET 0 0 0 {joints} {'}' * (depth + 1)} MOTION Frames: 1\n"
                    f"Frame Time: 1\n{'0 ' * depth}\n")
    assert len(read_bvh(path).skeleton) == depth + 1


@st.composite
def mutated(draw, text: str) -> bytes:
    """A good file cut short, with bytes replaced, pieces dropped, repeated or swapped."""
    data = text.encode()
    for _ in range(draw(st.integers(1, 3))):
        a, b = sorted(draw(st.lists(st.integers(0, len(data)), min_size=2, max_size=2)))
        b = min(b, a + 40)
        way = draw(st.sampled_from(["cut", "drop", "repeat", "bytes", "word", "shuffle"]))
        if way == "cut":
            data = data[:a]
        elif way == "drop":
            data = data[:a] + data[b:]
        elif way == "repeat":
            data = data[:b] + data[a:]
        elif way == "bytes":
            data = data[:a] + draw(st.binary(max_size=4)) + data[b if draw(st.booleans()) else a:]
        elif way == "word":
            words = data.split(b" ")
            words[draw(st.integers(0, len(words) - 1))] = draw(st.sampled_from(
                [b"", b"nan", b"-1", b"1e999", b"99999999999999999999", b"{", b"}", b"JOINT", b"End", b"MOTION",
                 b"0", b":root", b":hierarchy", b"begin", b"end", b"root", b"thigh", b"dof", b"\n", b"\xff"]))
            data = b" ".join(words)
        else:
            lines = data.split(b"\n")
            i, j = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
            lines[i], lines[j] = lines[j], lines[i]
            data = b"\n".join(lines)
    return data


@settings(max_examples=200, deadline=None)
@given(data=mutated(BVH))
def test_no_other_error_from_bvh(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp()
    attempt(folder / "fuzz.bvh", data, scale=1.0)


@settings(max_examples=150, deadline=None)
@given(asf=st.one_of(st.just(ASF.encode()), mutated(ASF)), amc=st.one_of(st.just(AMC.encode()), mutated(AMC)))
def test_no_other_error_from_acclaim(tmp_path_factory, asf, amc):
    folder = tmp_path_factory.getbasetemp()
    (folder / "fuzz.asf").write_bytes(asf)
    attempt(folder / "fuzz.amc", amc, asf=folder / "fuzz.asf", scale=1.0)


def attempt(path, data, **given):
    path.write_bytes(data)
    try:
        clip = load(path, **given)
    except MotionFileError as error:
        assert "fuzz." in str(error)
    else:
        assert isinstance(clip, Clip) and len(clip) > 0
