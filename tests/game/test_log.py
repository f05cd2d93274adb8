"""The input log: the same game to the bit, whatever cut it short."""

import errno
import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import Clip, human
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.mocap import Reading, write_bvh
from gambol.game.files.paths import OutputError
from gambol.game.input import Wish
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import Log, LogWriter, read
from gambol.game.session.log_lines import LogError
from gambol.game.session.replay import of_library, performer_of, replay, strayed
from gambol.game.session.settings import SETTINGS
from gambol.game.world import Recorded
from logged import GLIDE, play, walk
from stand_in import Glide

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


sticks = st.tuples(st.floats(-1, 1), st.floats(-1, 1))
value = st.sampled_from(SETTINGS).flatmap(lambda s: st.floats(s.low, s.high).map(lambda v: f"{s.name}={v!r}"))
action = st.sampled_from(["pause", "pause", "step", "slowmo", "reset", "join", "strafe_lock", "recentre", "camera_mode"]) \
    | st.integers(1, 400).map(lambda n: f"back={n}") | value
wish = st.builds(Wish, move=sticks, look=st.just((0.0, 0.0)) | sticks, turn=st.floats(-1, 1), run=st.floats(0, 1),
                 slow=st.booleans(), strafe=st.booleans(), orbit=sticks, drag=sticks, zoom=st.floats(-3, 3), pan=sticks,
                 pressed=st.lists(action, max_size=2).map(tuple))
stretch = st.tuples(wish, wish, st.integers(1, 12))


@settings(max_examples=12, deadline=None)
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


def test_whoever_writes_seldom_writes_lines_that_can_be_read(tmp_path):
    play(tmp_path / "a.gambol", walk(700), every=10**6)
    assert len(read(tmp_path / "a.gambol").ticks) == 700


def test_another_library_is_told_before_anything_moves(tmp_path, locomotion):
    path = tmp_path / "a.gambol"
    play(path, walk(10))
    with pytest.raises(LogError, match=r"a\.gambol: was played with another gait library: name it with --library$"):
        of_library(read(path), locomotion)


@pytest.mark.parametrize(("played", "now", "says"), [
    ("kid", "", "was played as the character 'kid': name its file with --character"), ("", "kid", "was played as the mannequin: leave out --character"),
    ("kid", "kid", "was played with another gait library, or another character 'kid': name them with --library and --character")])
def test_another_body_is_told_by_what_is_known_of_it(monkeypatch, played, now, says):
    monkeypatch.setattr(Glide, "body", SimpleNamespace(name=now) if now else None)
    with pytest.raises(LogError) as told:
        of_library(Log(1, "another", played, (), path=Path("a.gambol")), GLIDE)
    assert str(told.value) == f"a.gambol: {says}"


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


def test_a_clip_is_read_again_as_it_was_read(tmp_path):
    """A log names the axis and the unit that were told for its clip."""
    child = human().scaled(0.45)
    write_bvh(Clip("child", child, 1 / 60, np.tile(child.offsets[0], (60, 1)), np.tile([0.0, 0.0, 0.0, 1.0], (60, len(child), 1))), tmp_path / "child.bvh")
    performer = Recorded.load(tmp_path / "child.bvh", GLIDE, Reading.of("y", "cm"))
    writer = LogWriter(tmp_path / "a.gambol", performer, 1, tmp_path / "child.bvh", up="y", unit="cm")
    writer.add((Wish().rounded(),))
    writer.flush()
    log = read(tmp_path / "a.gambol")
    assert (log.up, log.unit) == ("y", "cm")
    np.testing.assert_array_equal(performer_of(log, GLIDE).root, performer.root)
    for name, told in {"b": {"up": "q"}, "c": {"unit": "parsec"}}.items():
        (path := tmp_path / f"{name}.gambol").write_bytes((tmp_path / "a.gambol").read_bytes().replace(b'"up": "y", "unit": "cm"', json.dumps(told)[1:-1].encode()))
        with pytest.raises(LogError, match=f"{name}.gambol: line 1: .*{[*told.values()][0]}"):
            performer_of(read(path), GLIDE)


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
