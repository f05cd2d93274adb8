"""What is no log, or one no longer, is read or refused in one clear line."""

import json
import os
import tempfile
import tracemalloc
import zlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.game.files.paths import OutputError
from gambol.game.session.input_log import read
from gambol.game.session.log_lines import LogError, escaped
from gambol.game.session.replay import replay
from gambol.game.session.settings import SETTINGS
from logged import GLIDE, play, walk


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A log of ten seconds."""
    path = tmp_path_factory.mktemp("log") / "a.gambol"
    play(path, walk(600))
    return path.read_bytes()


@pytest.mark.parametrize("place", [0.2, 0.5, 0.8])
def test_damage_in_the_middle_is_told_with_its_line(whole, tmp_path, place):
    path, data = tmp_path / "a.gambol", bytearray(whole)
    at = int(place * len(data))
    data[at] = data[at] ^ 0x40
    path.write_bytes(data)
    line = data[:at].count(b"\n") + 1
    with pytest.raises(LogError, match=f"a.gambol: line {line} is damaged, .* s into the log"):
        read(path)


@pytest.mark.parametrize(("content", "says"), [
    (b"", "line 1: not an input log"), (b"\x89PNG\r\n\x1a\n", "line 1: not an input log"), (b"[1, 2]\n", "not an input log"),
    (b'{"gambol": "input log", "format": 9, "library": "", "character": "", "players": 1}\n', "a log of format 9; this Gambol reads format 1"),
    (b'{"gambol": "input log", "format": 1, "library": "", "character": "", "players": 7}\n', "line 1: players: needs a whole number from 1 to 2, not 7"),
    (b'{"gambol": "input log", "format": 1, "library": "", "character": "", "players": 1}\n', "nothing was played yet")])
def test_what_is_no_log_is_refused_in_one_line(tmp_path, content, says):
    path = tmp_path / "a.gambol"
    path.write_bytes(content)
    with pytest.raises(LogError, match=says) as error:
        read(path)
    assert str(path) in str(error.value) and "\n" not in str(error.value)
    for wrong in (tmp_path / "none.gambol", tmp_path):
        with pytest.raises(LogError, match=str(wrong)):
            read(wrong)


HEAD = {"gambol": "input log", "format": 1, "library": "", "character": "", "players": 1}


def written(path, blocks, head=HEAD):
    """A log whose checksums are right, whatever its blocks claim. blocks: fields, and bytes of controls, of each line."""
    packer, lines = zlib.compressobj(9), [json.dumps(head).encode()]
    for fields, controls in blocks:
        data = packer.compress(json.dumps(fields).encode() + b"\n" + controls) + packer.flush(zlib.Z_SYNC_FLUSH)
        lines.append(b"%08x %s" % (zlib.crc32(data), escaped(data)))
    path.write_bytes(b"\n".join(lines) + b"\n")
    return path


BLOCK = ([3, 1, None, []], bytes(96))


@pytest.mark.parametrize(("head", "says"), [
    ({"players": 1.0}, "players: needs a whole number from 1 to 2, not 1.0"), ({"players": True}, "players: .* not true"),
    ({"players": None}, "players"), ({"players": [1]}, "players: .* not a list"), ({"players": 10**300}, "players: .*…"),
    ({"format": True}, "a log of format true"), ({"format": "\x1b[2J"}, "a log of format .*u001b"), ({"format": {}}, "a log of format a table"),
    ({"library": 1}, "library: needs a name"), ({"library": "x" * 65}, "library: needs a name of at most 64 letters"),
    ({"character": None}, "character: needs a name"), ({"character": "Bob\nand Eve"}, "character: needs a name"),
    ({"character": "\x9b2J"}, "character"), ({"clip": 7}, "clip: needs a name"), ({"clip": "a\0b"}, "clip"), ({"database": ["x"]}, "database"),
    ({"up": 1}, "up"), ({"unit": "x" * 41}, "unit: needs a name of at most 40 letters")])
def test_every_field_of_the_head_is_checked(tmp_path, head, says):
    path = written(tmp_path / "a.gambol", [BLOCK], HEAD | head)
    with pytest.raises(LogError, match=f"a.gambol: line 1: {says}") as error:
        read(path)
    assert str(error.value).removeprefix(str(path)).isprintable() and len(str(error.value)) < 400


@pytest.mark.parametrize(("fields", "controls", "says"), [
    ([5_000_000, 0, None, []], 0, "ticks: needs a whole number from 1 to 600, not 5000000"),
    ([0, 1, None, []], 0, "ticks"), ([-3, 1, None, []], 96, "ticks"), ([3.0, 1, None, []], 96, "ticks: .* not 3.0"),
    ([True, 1, None, []], 32, "ticks"), ([3, 0, None, []], 0, "players"), ([3, 3, None, []], 288, "players"),
    ([3, 1.0, None, []], 96, "players: .* not 1.0"), ([3, 1, -1, []], 96, "fingerprint"), ([3, 1, 1.5, []], 96, "fingerprint"),
    ([3, 1, 2**32, []], 96, "fingerprint"), ([3, 1, None, []], 95, "3 ticks need 96 bytes of controls, not 95"),
    ([600, 2, None, []], 2_000_000, "unpacks to 1 MiB or more"), ([3, 1, None, {}], 96, "actions: needs a list"),
    ([3, 1, None, [[0, 0]]], 96, "actions"), ([3, 1, None, [[3, 0, []]]], 96, "actions: there is no tick 3 of player 0 in its 3"),
    ([3, 1, None, [[0, 1, []]]], 96, "no tick 0 of player 1"), ([3, 1, None, [[0, 0, "pause"]]], 96, "actions: tick 0 needs"),
    ([3, 1, None, [[0, 0, [7]]]], 96, "actions"), ([3, 1, None, [[0, 0, ["pause"] * 1001]]], 96, "actions"),
    ([3, 1, None, [[0, 0, ["x" * 4001]]]], 96, "actions"), ([3, 1, None, [[0, 0, ["\x1b]0;hi\x07"]]]], 96, "actions"),
    ([3, 1, None], 96, "needs ticks, players, fingerprint and actions"), ({}, 96, "needs ticks")])
def test_every_field_of_a_block_is_checked_and_bounded(tmp_path, fields, controls, says):
    """A checksum that is right says nothing: a hundred bytes made five million ticks once."""
    path = written(tmp_path / "a.gambol", [BLOCK, (fields, bytes(controls))])
    tracemalloc.start()
    try:
        with pytest.raises(LogError, match=f"a.gambol: line 3: .*{says}.*; delete it and what follows"):
            read(path)
        assert tracemalloc.get_traced_memory()[1] < 20e6
    finally:
        tracemalloc.stop()


def test_a_log_is_so_long_and_so_large_at_most(tmp_path, monkeypatch):
    monkeypatch.setattr("gambol.game.session.input_log.LONGEST", 100)
    path = written(tmp_path / "a.gambol", [([60, 1, None, []], bytes(60 * 32))] * 2)
    with pytest.raises(LogError, match="a.gambol: line 3: with it the log is longer than"):
        read(path)
    with pytest.raises(OutputError, match="b.gambol: is .* hours long"):
        play(tmp_path / "b.gambol", walk(150))
    assert len(read(tmp_path / "b.gambol").ticks) == 90
    monkeypatch.setattr("gambol.game.session.input_log.LARGEST", 1 << 20)
    with open(path, "ab") as file:
        file.truncate(3 << 20)
    with pytest.raises(LogError, match="a.gambol: holds 3 MiB; 1 MiB are read at most"):
        read(path)


values = st.recursive(st.none() | st.booleans() | st.integers(-10**20, 10**20) | st.floats() | st.text(max_size=8),
                      lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3), max_leaves=6)
fields = st.lists(values, max_size=5) | st.tuples(st.integers(-1, 700), st.integers(-1, 3), values, values).map(list) | values
heads = st.dictionaries(st.sampled_from(sorted(HEAD)), values, max_size=2).map(lambda changes: HEAD | changes) | values


@settings(max_examples=150, deadline=None, derandomize=True)
@given(heads | st.just(HEAD), st.lists(st.tuples(fields, st.integers(0, 5000).map(bytes)), max_size=3))
def test_whatever_a_log_claims_it_is_read_or_refused_in_one_line(head, blocks):
    with tempfile.TemporaryDirectory() as folder:
        refused_in_one_line(written(Path(folder) / "a.gambol", [BLOCK, *blocks], head))


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    """The bytes of a log."""
    path = tmp_path_factory.mktemp("log") / "a.gambol"
    play(path, walk(60), every=20)
    return path.read_bytes()


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.data())
def test_whatever_happened_to_its_bytes_a_log_is_read_or_refused_in_one_line(played, data):
    with tempfile.TemporaryDirectory() as folder:
        path, content = Path(folder) / "a.gambol", bytearray(played)
        for _ in range(data.draw(st.integers(1, 4))):
            at, stop = sorted(data.draw(st.tuples(*[st.integers(0, len(content))] * 2)))
            content[at:min(stop, at + 20)] = data.draw(st.binary(max_size=6) | st.just(b"[" * 5000) | st.just(b"9" * 5000) | st.just(b"\n"))
        path.write_bytes(content)
        refused_in_one_line(path, False)


def refused_in_one_line(path, plays=True):
    """Read a log, and play it if it can be read: nothing but a LogError, in one line, comes of it."""
    try:
        log = read(path)
        for _ in replay(log, GLIDE) if plays else log.ticks:
            pass
    except LogError as error:
        assert str(error).startswith(f"{path}: ") and str(error).isprintable() and len(str(error)) < 1200


@settings(max_examples=120, deadline=None, derandomize=True)
@given(st.text(max_size=12) | st.tuples(st.sampled_from(["back", "pins", "pin", *(s.name for s in SETTINGS), "nobody.knows"]),
                                        st.text(max_size=12) | st.from_regex(r"[-+]?[0-9]{1,30}(e[0-9]{1,4})?", fullmatch=True)
                                        | st.sampled_from(["²", "٣", "nan", "inf", "-inf", "1" * 3000, "0/0/0", "hold", "9:1/2/3"])
                                        ).map("=".join))
def test_whatever_was_pressed_is_played_or_refused_in_one_line(action):
    with tempfile.TemporaryDirectory() as folder:
        refused_in_one_line(written(Path(folder) / "a.gambol", [BLOCK, ([3, 1, None, [[1, 0, [action]]]], bytes(96))]))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="only where there are pipes with names")
def test_no_pipe_or_device_is_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.gambol")
    for path, what in ((tmp_path / "a.gambol", "pipe"), (Path("/dev/zero"), "device")):
        with pytest.raises(LogError, match=f"{path}: is a {what}, not a file"):
            read(path)
