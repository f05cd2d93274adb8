"""The input log: the same game to the bit, whatever cut it short; and one clear line for what is no log."""

import errno
import json
import os
import signal
import subprocess
import sys
import tempfile
import tracemalloc
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.locomotion import Locomotion
from gambol.game.files.paths import OutputError
from gambol.game.input import Wish
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.log_lines import LogError
from gambol.game.session.replay import of_library, replay, strayed
from gambol.game.session.log_lines import escaped
from gambol.game.session.settings import SETTINGS
from gambol.game.session.state import opening
from gambol.game.session.tick import Timeline
from stand_in import Glide

ROOT = Path(__file__).parents[2]
GLIDE = Glide()


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


def play(path, ticks, controller=GLIDE, players=1, every=45, clip=None):
    """Play wishes into a log; the moments after each tick."""
    timeline, writer, moments = Timeline(opening(controller, players)), LogWriter(path, controller, players, clip), []
    for number, wishes in enumerate(ticks, 1):
        wishes = tuple(wish.rounded() for wish in wishes[:len(timeline.now.players)])
        timeline.advance(wishes)
        writer.add(wishes)
        moments.append(timeline.now)
        if number % every == 0:
            writer.flush(timeline.now)
    writer.flush(timeline.now)
    writer.close()
    return moments


def walk(count, seed=0):
    rng = np.random.default_rng(seed)
    return [(Wish(move=tuple(rng.uniform(-1, 1, 2)), drag=tuple(rng.normal(size=2))),) for _ in range(count)]


sticks = st.tuples(st.floats(-1, 1), st.floats(-1, 1))
value = st.sampled_from(SETTINGS).flatmap(lambda s: st.floats(s.low, s.high).map(lambda v: f"{s.name}={v!r}"))
action = st.sampled_from(["pause", "pause", "step", "slowmo", "reset", "join", "strafe_lock", "recentre", "camera_mode"]) \
    | st.integers(1, 400).map(lambda n: f"back={n}") | value
wish = st.builds(Wish, move=sticks, look=st.just((0.0, 0.0)) | sticks, turn=st.floats(-1, 1), run=st.floats(0, 1),
                 slow=st.booleans(), strafe=st.booleans(), orbit=sticks, drag=sticks, zoom=st.floats(-3, 3), pan=sticks,
                 pressed=st.lists(action, max_size=2).map(tuple))
stretch = st.tuples(wish, wish, st.integers(1, 12))


@settings(max_examples=20, deadline=None)
@given(st.lists(stretch, min_size=1, max_size=10), st.sampled_from([1, 2]))
def test_a_log_replays_to_the_bit_whatever_the_hands_did(locomotion, stretches, players):
    """Rewinds, resets, joins, settings, slow motion and cameras among it; every number of every state."""
    ticks = []
    for first, second, count in stretches:
        ticks.append((first, second))
        ticks += [(Wish(move=first.move, look=first.look, run=first.run), Wish(move=second.move))] * count
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.gambol"
        played = play(path, ticks, locomotion, players)
        log = of_library(read(path), locomotion)
    assert len(log.ticks) == len(ticks) and log.prints
    again = list(replay(log, locomotion))[1:]
    for a, b in zip(played, again, strict=True):
        assert (a.number, a.paused, a.slow, a.phase, a.after.number) == (b.number, b.paused, b.slow, b.phase, b.after.number)
        for x, y in zip(a.after.characters, b.after.characters, strict=True):
            assert all(x.state.memory[name].tobytes() == y.state.memory[name].tobytes() for name in x.state.memory.dtype.names)
            assert x.controller.settings == y.controller.settings
            assert np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
        for p, q in zip(a.players, b.players, strict=True):
            assert np.array_equal(p.camera.view().eye, q.camera.view().eye) and p.pilot == q.pilot
            assert np.isfinite(p.camera.view().eye).all()
        assert not strayed(log, b)


def test_wherever_a_log_is_cut_what_is_left_plays(tmp_path):
    path, ticks = tmp_path / "a.gambol", walk(150)
    moments = play(path, ticks)
    data = path.read_bytes()
    whole = read(path)
    first = data.index(b"\n", data.index(b"\n") + 1) + 1
    for cut in [*range(first, len(data), 211), len(data) - 1]:
        path.write_bytes(data[:cut])
        log = read(path)
        assert log.ticks == whole.ticks[:len(log.ticks)] and len(log.ticks) % 45 == 0
        *_, last = replay(log, GLIDE)
        assert fingerprint(last) == fingerprint(moments[len(log.ticks) - 1])
    for tail in (b"\0" * 100, b"\0" * 100 + b"\n", b"12345678 rubbish\n"):
        path.write_bytes(data + tail)
        assert read(path).ticks == whole.ticks


@pytest.mark.parametrize("place", [0.2, 0.5, 0.8])
def test_damage_in_the_middle_is_told_with_its_line(tmp_path, place):
    path = tmp_path / "a.gambol"
    play(path, walk(600))
    data = bytearray(path.read_bytes())
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
    ({"character": "\x9b2J"}, "character"), ({"clip": 7}, "clip: needs a name"), ({"clip": "a\0b"}, "clip"), ({"database": ["x"]}, "database")])
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


def test_whoever_writes_seldom_writes_lines_that_can_be_read(tmp_path):
    play(tmp_path / "a.gambol", walk(700), every=10**6)
    assert len(read(tmp_path / "a.gambol").ticks) == 700


values = st.recursive(st.none() | st.booleans() | st.integers(-10**20, 10**20) | st.floats() | st.text(max_size=8),
                      lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3), max_leaves=6)
fields = st.lists(values, max_size=5) | st.tuples(st.integers(-1, 700), st.integers(-1, 3), values, values).map(list) | values
heads = st.dictionaries(st.sampled_from(sorted(HEAD)), values, max_size=2).map(lambda changes: HEAD | changes) | values


@settings(max_examples=300, deadline=None, derandomize=True)
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


@settings(max_examples=300, deadline=None, derandomize=True)
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


@settings(max_examples=200, deadline=None, derandomize=True)
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


def test_another_library_is_told_before_anything_moves(tmp_path, locomotion):
    path = tmp_path / "a.gambol"
    play(path, walk(10))
    with pytest.raises(LogError, match="as the mannequin, and with another gait library.*--library and --character"):
        of_library(read(path), locomotion)


def test_a_replay_that_goes_another_way_is_noticed(tmp_path):
    path = tmp_path / "a.gambol"
    play(path, walk(100))
    assert any(strayed(read(path), moment) for moment in replay(read(path), Glide(halflife=0.2)))


def test_nothing_is_written_before_there_is_something_and_nothing_overwritten(tmp_path):
    path = tmp_path / "new" / "a.gambol"
    LogWriter(path, GLIDE, 1).flush()
    assert not path.parent.exists()
    play(path, walk(3))
    before = path.read_bytes()
    with pytest.raises(OutputError, match="a.gambol: can't be written"):
        play(path, walk(3))
    assert path.read_bytes() == before


def test_a_long_log_is_small(tmp_path):
    """A minute on noisy sticks, and a minute on keys."""
    rng = np.random.default_rng(1)
    goals = np.repeat(rng.uniform(-1, 1, (90, 4)), 40, axis=0)
    drift = np.cumsum(0.15 * (goals - np.roll(goals, 1, axis=0)), axis=0).clip(-1, 1) + 0.01 * rng.normal(size=goals.shape)
    pad = [Wish(move=(a, b), look=(c, d), run=abs(a)) for a, b, c, d in drift]
    keys = [Wish(move=(round(a), round(b))) for a, b, _, _ in goals]
    for name, wishes in (("pad", pad), ("keys", keys)):
        writer = LogWriter(tmp_path / f"{name}.gambol", GLIDE, 1)
        for number, wish in enumerate(wishes, 1):
            writer.add((wish.rounded(),))
            if number % 45 == 0:
                writer.flush()
        writer.close()
    assert (tmp_path / "pad.gambol").stat().st_size < 20_000 and (tmp_path / "keys.gambol").stat().st_size < 4_000


GAME = '''
import sys, time
sys.path.insert(0, "tests/game")
from stand_in import Glide
from gambol.game.hosts.events import KeyEvent
from gambol.game.session.input_log import LogWriter
from gambol.game.app.app import Play
game = Play(Glide(), log=LogWriter(sys.argv[1], Glide(), 1))
game.handle(KeyEvent("W", True))
while True:
    game.tick(1 / 60)
    print(game.now.number, flush=True)
    time.sleep(0.002)
'''


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="only where a process can be killed outright")
def test_a_kill_costs_less_than_a_second_of_the_log(tmp_path):
    path = tmp_path / "a.gambol"
    process = subprocess.Popen([sys.executable, "-c", GAME, str(path)], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    number = 0
    while number < 200:
        number = int(process.stdout.readline())
    os.kill(process.pid, signal.SIGKILL)
    number = max([number, *(int(line) for line in process.stdout.read().split()[:-1])])
    process.wait()
    log = read(path)
    assert number - 60 <= len(log.ticks)
    *_, last = replay(log, GLIDE)
    assert last.after.characters[0].state.ground[1] > 2.0


def test_a_disk_that_takes_half_of_a_line_ends_the_log_before_it(tmp_path):
    """What is in it plays, whatever is added afterwards."""
    writer, wish = LogWriter(tmp_path / "a.gambol", Glide(), 1), Wish().rounded()
    for _ in range(3):
        writer.add([wish])
        writer.flush()
    whole = writer.path.stat().st_size

    class Full:
        def __init__(self, file):
            self.file = file

        def write(self, data):
            if not (left := whole + 7 - self.file.tell()):
                raise OSError(errno.ENOSPC, "No space left on device")
            return self.file.write(data[:left])

        def __getattr__(self, name):
            return getattr(self.file, name)

    writer._file, file = Full(writer._file), writer._file
    for _ in range(2):
        writer.add([wish])
        with pytest.raises(OutputError, match="No space left|has ended"):
            writer.flush()
        writer._file = file  # there is room again, but a part is missing
    writer.close()
    assert len(read(writer.path).ticks) == 3
