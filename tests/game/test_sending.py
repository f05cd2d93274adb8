"""What is played is sent on as it moves: whom a program that listens hears of, and how sure."""

import socket
from types import SimpleNamespace

import pytest
from pythonosc.osc_packet import OscPacket
from typer.main import get_command

from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.live import SenderError

from gambol.game import hosts
from gambol.game.cli import app, live
from gambol.game.cli.base import Preset
from gambol.game.cli.play import show
from gambol.game.hosts import KeyEvent
from gambol.game.app import Play, Sending
from gambol.game.app.sending import shown
from gambol.game.world import Character, Follows, World
from stand_in import Glide


@pytest.fixture
def listener():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as heard:
        heard.bind(("127.0.0.1", 0))
        heard.settimeout(5.0)
        yield heard


def said(listener):
    """The messages of one frame, by address; of bones, those of the root alone."""
    messages = [timed.message for timed in OscPacket(listener.recv(65536)).messages]
    return {m.address: m.params for m in messages if m.address != "/VMC/Ext/Bone/Pos"} | {"bones": [m for m in messages if m.address == "/VMC/Ext/Bone/Pos"]}


def test_whoever_is_played_is_sent_frame_by_frame(listener):
    game = Play(Glide(), sending=Sending(f"127.0.0.1:{listener.getsockname()[1]}"))
    game.handle(KeyEvent("W", True))
    for _ in range(3):
        game.tick(1 / 60)
    frames = [said(listener) for _ in range(3)]
    assert [frame["/VMC/Ext/T"][0] for frame in frames] == pytest.approx([1 / 60, 2 / 60, 3 / 60])
    assert all(len(frame["bones"]) > 20 and frame["/VMC/Ext/Blend/Val"][1] == 1.0 for frame in frames)
    ground = game.now.after.characters[0].state.ground
    assert frames[-1]["/VMC/Ext/Root/Pos"][1:4] == pytest.approx([-ground[0], 0.0, ground[1]], abs=1e-6)
    assert ground[1] > 0.0 and game.sending.lost == 0
    game.close()
    game.sending.send(game.now.after)  # nobody listens any more, and nothing breaks
    assert game.sending.lost == 1


def test_every_program_that_is_named_is_sent_to_once(listener):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        other.settimeout(5.0)
        first, second = (f"127.0.0.1:{one.getsockname()[1]}" for one in (listener, other))
        with live.sent([first, second, first]) as sender:
            one = Character("P", Glide(), Glide().start())
            sender.send(one.controller.skeleton, one.state.pose, one.state.ground, 0.5, 1.0)
        assert [said(each)["/VMC/Ext/T"][0] for each in (listener, other)] == [0.5, 0.5]
        listener.setblocking(False)
        with pytest.raises(BlockingIOError):
            listener.recv(8)
    for command in ("play", "reconstruct"):  # as they are named on the command line
        named = next(one for one in get_command(app).commands[command].params if one.name == "send")
        assert named.multiple


def test_a_body_made_of_points_goes_before_its_performer():
    player, follower = (Character(name, Glide(), Glide().start()) for name in ("P", "F"))
    assert shown(World((player, follower))) is player
    follower = Character("F", Glide(), Glide().start(), follows=Follows("ours", parse("4", SKELETON), "P"))
    assert shown(World((player, follower))) is follower


def test_an_address_that_is_none_is_told():
    with pytest.raises(SenderError, match="HOST:PORT"):
        Sending("127.0.0.1:port")


@pytest.mark.parametrize("lost", [0, 3])
def test_frames_that_could_not_be_sent_are_told_after_a_game(lost, monkeypatch, capsys):
    monkeypatch.setattr(hosts, "run_window", lambda *_: None, raising=False)
    show(SimpleNamespace(close=lambda: None), (8, 8), Preset.fast, sending=SimpleNamespace(lost=lost))
    assert ("3 frames could not be sent" in capsys.readouterr().err) == bool(lost)
