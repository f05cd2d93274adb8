"""Bodies from points in the window: keys, hands, streams, and where they stand in the picture."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gambol.game.app.app import Play
from gambol.game.app.point_picking import project
from gambol.game.app.views import scenes
from gambol.game.camera import Follow, between
from gambol.game.hosts.events import KeyEvent, MouseMove, Scroll
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session.comparison import Comparison
from gambol.game.session.state import opening
from gambol.game.session.tick import Timeline
from gambol.game.world.world import DT
from steady import no_database, walker  # noqa: F401, fixtures
from studies import game, ticks


def test_keys_open_hold_and_leave(walker):
    play = game(walker)
    play.handle(KeyEvent("X", True))
    ticks(play, 3)
    assert play.now.comparison is not None and [one.name for one in play.now.after.characters[1:]] == ["trackers"], "what ships"
    play.do("study_ghosts")
    ticks(play, 2)
    assert [one.name for one in play.now.after.characters[1:]] == ["trackers", "ours"]
    scene = play.scene((1280, 720))
    assert scene.ink is not None and len(scene.figures) == 3
    play.do("study_hands")
    ticks(play, 2)
    pins = play.now.comparison.pins
    camera, aspect = play.held_points.camera, play.held_points.aspect
    number = 0
    x, y = project(camera, aspect, np.array(pins[number]))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("LEFT_BUTTON", True))
    assert play.held_points.grip is not None and play.held_points.grip.number == number
    play.handle(MouseMove(float(x), float(y) - 0.1, 0.0, -0.1))
    ticks(play, 2)
    up = play.now.comparison.pins[number]
    assert up[1] > pins[number][1] + 0.2 and play.now.comparison.pins[1:] == pins[1:]
    before = play.now.players[0].camera.distance
    play.handle(Scroll(0.0, 5.0))
    ticks(play, 2)
    deeper = project(camera, aspect, np.array(play.now.comparison.pins[number]))[2]
    assert deeper > project(camera, aspect, np.array(up))[2] + 0.3 and play.now.players[0].camera.distance == before
    play.handle(KeyEvent("LEFT_BUTTON", False))
    held = play.now.comparison.pins[number]
    play.handle(MouseMove(0.1, 0.9, 0.0, 0.0))
    ticks(play, 3)
    assert play.now.comparison.pins[number] == held  # released, it stays
    x, y = project(play.held_points.camera, aspect, np.array(held))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("U", True))
    ticks(play, 2)
    assert play.now.comparison.pins[number] is None
    play.handle(KeyEvent("ESCAPE", True))
    ticks(play, 2)
    assert play.now.comparison.pins is None and not play.done
    play.handle(KeyEvent("ESCAPE", True))
    assert play.done


def test_a_stream_holds_the_points(walker):
    class Somebody:
        worn = None
        turns = np.full((4, 3, 3), np.nan)

        def at(self, time):
            return np.array([[0.4, 1.0, 0.3], [np.nan] * 3, [0.1, 0.07, 0.0], [-0.1, 0.07, 0.0]])
    play = game(walker, stream=Somebody())
    play.held_points.methods("trackers", "4")
    play.open(Comparison(points="4"))
    ticks(play, 5)
    play.do("study")
    ticks(play, 2)
    assert play.now.comparison is None
    play.do("study")  # the same points again
    ticks(play, 5)
    assert play.now.comparison.pins[1] is None
    assert play.now.comparison.pins[0] == pytest.approx(np.array([0.4, 1.0, 0.3]) + play.now.comparison.beside, abs=1e-4)
    play.do("study_points")
    play.do("study_hands")
    ticks(play, 3)
    assert play.now.comparison.points == "4" and play.now.comparison.pins is not None  # they are the stream's
    play.do("quit")
    assert play.done


def test_where_players_share_the_picture_bodies_stand_within_the_first_ones_part_and_not_in_the_other(walker):
    def placed(players):
        timeline = Timeline(opening(walker, players))
        timeline.advance((Wish(pressed=("study=ours@6",)), *[Wish()] * (players - 1)))
        performer, *others, body = timeline.now.after.characters
        at = np.array([project(timeline.now.players[0].view(1.0), 8.0 / 9.0, body.state.pose.root + [dx, 0.0, 0.0])[0] for dx in (-0.35, 0.35)])
        return at, min(math.dist(body.state.ground[:2], one.state.ground[:2]) for one in (performer, *others))
    alone, apart = placed(1)
    assert alone.max() > 8.0 / 9.0 and apart > 1.3, "half of the picture is not enough for this, and need not be"
    shared, apart = placed(2)
    assert shared.min() > 0.0 and shared.max() < 8.0 / 9.0 and apart > 0.8


def test_the_legend_lies_in_the_first_player_s_part_and_lines_keep_off_it(walker):
    game = Play(walker, players=2)
    game.do("study=ours@6")
    for _ in range(3):
        game.tick(DT)
        first, second = game.scene((640, 360))
    reach = first.ink.vertices["place"][:, 0]
    assert first.ink.size == (640, 360) and reach.max() <= 320 and first.taken == (320 - reach.min(), first.ink.vertices["place"][:, 1].max())
    assert second.ink is None and second.taken == (0.0, 0.0)
    assert not len(game.scene((200, 150))[0].ink.vertices), "none where it has no room"
    game.close()


def test_a_body_beside_that_goes_through_what_stands_there_is_faint_and_nobody_else_is(walker):
    play = game(walker)
    play.do("study")
    ticks(play, 3)
    moment = play.now
    x, _, z = moment.after.characters[1].state.pose.root

    def covers(*props):
        camera = Follow.behind(np.zeros(3), yaw=0.0)
        seen = replace(moment, after=replace(moment.after, props=props))
        return [one.cover for one in scenes(seen, 1.0, (between(camera, camera, 1.0),), play.showing.overlays)[0].figures[:2]]
    assert covers() == [1.0, 1.0]
    own, other = covers(Box((float(x), 1.0, float(z)), (0.6, 2.0, 0.6)))
    assert own == 1.0 and other == pytest.approx(0.3)
    beside = [covers(Box((float(x + far), 1.0, float(z)), (0.2, 2.0, 0.2)))[1] for far in (0.1, 0.15, 0.2, 0.25, 0.35)]
    assert beside == sorted(beside) and beside[0] < 0.5 and beside[-1] == 1.0
