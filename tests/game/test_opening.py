"""The first start: a picture at once, a walk as soon as it is compiled, and no jump before its turn."""

import io

import numpy as np
import pytest
from hands import FRAME, press, release, text, wait
from stand_in import Glide

from gambol.controllers.jump import Jump
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.supervisor import Supervisor
from gambol.game.app import preparing as beside
from gambol.game.app.app import Play
from gambol.game.hosts import KeyEvent
from gambol.game.app.opening import STROLL, Opening
from gambol.game.app.preparing import Preparing
from gambol.game.session.input_log import LogWriter, read
from gambol.game.world.course import COURSE
from gambol.game.world.primitive import nearest


class Program:
    """A program that compiles until it is told how it ended."""

    def __init__(self):
        self.code, self.stdout, self.ended = None, io.StringIO(), False

    def poll(self):
        return self.code

    def terminate(self):
        self.ended = True

    def wait(self):
        return self.code


@pytest.fixture
def preparing(monkeypatch):
    """Nothing is compiled yet; two programs are at it."""
    ready = set()
    monkeypatch.setattr(beside.preparing, "ready", lambda part, walker: part in ready)
    monkeypatch.setattr(beside.preparing, "share", lambda: 0.4)
    preparing = Preparing(None, (Program(), Program()))
    preparing.compiled = ready
    return preparing


def compiled(preparing, play, code=0):
    """The jump is compiled, and loaded into the game."""
    for program in preparing.programs:
        program.code = code
    play.tick(0.0)
    preparing.loading.join()


def test_a_picture_comes_before_anything_is_compiled(preparing):
    made = []
    opening = Opening(lambda: made.append(1), preparing)
    opening.tick(0.1)
    scene = opening.scene((640, 360))
    assert scene.props == COURSE and not scene.figures and not made
    assert scene.text == ("Preparing to walk, for the first time here … 40 %",)


def test_somebody_walks_while_one_waits():
    """By a primitive of the library: on the floor, at its speed, along its arc."""
    walker = Locomotion.load()
    opening = Opening(lambda: pytest.fail("nothing is ready"), Preparing(walker, (Program(),)))
    assert not opening.scene((640, 360)).figures
    places = []
    for _ in range(60):
        opening.time += 0.1
        places.append(opening.scene((640, 360)).figures[0].positions)
    places = np.array(places)
    number = nearest(walker.library, STROLL)
    v_f, omega, v_l = walker.library.velocities[number]
    ground = places[:, 0][:, [0, 2]]
    speed = np.linalg.norm(np.diff(ground, axis=0), axis=-1) / 0.1
    assert speed.mean() == pytest.approx(np.hypot(v_f, v_l), rel=0.1) and 0.4 < abs(omega) < 0.8
    assert -0.05 < places[..., 1].min() < 0.1 and np.ptp(places[:, 0, 1]) < 0.15
    assert np.linalg.norm(ground, axis=-1).max() < 2.5 * v_f / abs(omega)


def test_who_walks_while_one_waits_stays_in_the_picture():
    """All round, every joint, even in a square window."""
    walker = Locomotion.load()
    opening = Opening(lambda: pytest.fail("nothing is ready"), Preparing(walker, (Program(),)))
    opening.scene((640, 640))
    round_trip = 2 * np.pi / abs(walker.library.velocities[nearest(walker.library, STROLL)][1])
    for opening.time in np.linspace(0.0, round_trip, 50):
        scene = opening.scene((640, 640))
        camera = scene.camera
        ahead = camera.target - camera.eye
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, (0.0, 1.0, 0.0))
        right /= np.linalg.norm(right)
        seen = scene.figures[0].positions - camera.eye
        across = np.stack([seen @ right, seen @ np.cross(right, ahead)]) / (seen @ ahead)
        assert (seen @ ahead).min() > 1.0 and np.abs(across).max() < np.tan(0.5 * camera.fov), opening.time


def test_who_does_not_want_to_wait_leaves(preparing):
    opening = Opening(lambda: pytest.fail("nobody waits for a game"), preparing)
    opening.handle(KeyEvent("W", True))
    assert not opening.done
    opening.handle(KeyEvent("ESCAPE", True))
    assert opening.done
    opening.close()
    assert all(program.ended for program in preparing.programs)


def test_the_game_begins_as_soon_as_one_can_walk(preparing):
    opening = Opening(lambda: Play(Glide(), preparing=preparing), preparing)
    opening.tick(0.1)
    assert opening.game is None
    preparing.compiled.add("walk")
    opening.tick(0.1)
    assert opening.scene((640, 360)).figures
    assert "Preparing jumps … 40 %" in opening.scene((640, 360)).text
    opening.handle(KeyEvent("W", True))
    opening.tick(0.5)
    assert opening.game.now.after.characters[0].state.ground[1] > 0.1
    opening.handle(KeyEvent("F11", True))
    assert opening.full_screen == opening.game.full_screen


def test_nothing_of_a_jump_is_asked_before_somebody_aims(preparing):
    """How long a body can be in the air takes half a minute to compile: the game stood still for it, in its own thread."""
    class Unready(Jump):
        longest = property(lambda self: pytest.fail("halts the game"))
    play = Play(Supervisor({"locomotion": Locomotion.load(), "jump": Unready()}), preparing=preparing)
    for key in ("W", "SPACE"):  # who wants to jump is told that it is being prepared
        press(play, key)
        wait(play, 10 * FRAME)
        play.scene((640, 360))
    assert play.now.after.characters[0].state.ground[1] > 0.02


def test_a_jump_that_is_not_ready_is_refused_with_a_word_and_no_log_has_it(preparing, tmp_path):
    controller = Glide()
    play = Play(controller, log=LogWriter(tmp_path / "log.gambol", controller, 1), preparing=preparing)
    press(play, "SPACE")
    wait(play, 10 * FRAME)
    assert text(play).count("no jump yet") == 1
    assert play.now.players[0].aim.held == 0.0
    release(play, "SPACE")
    wait(play, 1 * FRAME)
    compiled(preparing, play)
    assert "Preparing" not in text(play)
    before = play.now.number
    press(play, "SPACE")
    wait(play, 10 * FRAME)
    play.close()
    logged = [wishes[0].jump for wishes in read(tmp_path / "log.gambol").ticks]
    assert not any(logged[:before]) and all(logged[before:]) and len(logged) == before + 10


def test_a_push_before_its_answer_is_ready_is_refused_with_a_word(preparing):
    """Its first one compiled for half a minute, in the game's own thread."""
    class Unready(Glide):
        def step(self, state, intent, dt):
            assert intent.strike is None, "halts the game"
            return super().step(state, intent, dt)
    play = Play(Unready(), preparing=preparing)
    press(play, "M")
    wait(play, 10 * FRAME)
    assert text(play).count("no push yet") == 1


@pytest.mark.parametrize("code", (1, -9))
def test_what_nobody_could_compile_is_left_to_the_game(preparing, code):
    opening = Opening(lambda: Play(Glide(), preparing=preparing), preparing)
    for program in preparing.programs:
        program.code = code
    opening.tick(0.1)
    opening.tick(0.1)
    preparing.loading.join()
    assert opening.game.jumps


def test_a_log_that_may_jump_waits(preparing, tmp_path):
    """And goes on to the bit."""
    controller = Glide()
    first = Play(controller, log=LogWriter(tmp_path / "log.gambol", controller, 1))
    press(first, "W")
    wait(first, 30 * FRAME)
    first.close()
    play = Play(controller, tape=read(tmp_path / "log.gambol"), preparing=preparing)
    wait(play, 20 * FRAME)
    assert play.now.number == 0
    compiled(preparing, play)
    wait(play, 30 * FRAME)
    assert np.array_equal(play.now.after.characters[0].state.ground, first.now.after.characters[0].state.ground)


def test_where_everything_was_compiled_before_nothing_is_waited_for(monkeypatch):
    monkeypatch.setattr(beside.preparing, "ready", lambda part, walker: True)
    preparing = Preparing(None)
    assert preparing.walks and preparing.said == ()
    play = Play(Glide(), preparing=preparing)
    compiled_at_once = Opening(lambda: play, preparing)
    compiled_at_once.tick(0.0)
    compiled_at_once.tick(0.0)
    preparing.loading.join()
    assert play.jumps
