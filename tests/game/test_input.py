"""Sticks, keys and the pilot."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.input import BINDINGS, Keyboard, Pilot, Wish, dead_zone, help_sheet, pad_pressed, pad_wish
from game.input.bindings import pressed_by
from game.input.devices import INNER, OUTER, trigger
from stand_in import Glide

stick = st.floats(-1, 1)
anything = st.floats(allow_nan=True, allow_infinity=True)


@dataclass(frozen=True)
class Pad:
    left: tuple[float, float] = (0.0, 0.0)
    right: tuple[float, float] = (0.0, 0.0)
    left_trigger: float = -1.0
    right_trigger: float = -1.0
    buttons: frozenset = frozenset()


@given(anything, anything)
def test_any_reading_stays_within_the_unit_circle(x, y):
    a, b = dead_zone(x, y)
    assert math.hypot(a, b) <= 1 + 1e-12


@given(stick, stick)
def test_the_dead_zone_is_radial(x, y):
    a, b = dead_zone(x, y)
    assert abs(a * y - b * x) < 1e-12 and a * x + b * y >= 0
    assert (a, b) == (0, 0) if math.hypot(x, y) <= INNER else math.hypot(a, b) > 0


@given(stick, stick, st.floats(0, 2 * math.pi))
def test_every_direction_is_treated_alike(x, y, turn):
    c, s = math.cos(turn), math.sin(turn)
    a, b = dead_zone(x, y)
    assert dead_zone(c * x - s * y, s * x + c * y) == pytest.approx((c * a - s * b, s * a + c * b), abs=1e-9)


def test_it_starts_at_nothing_and_reaches_everything():
    assert dead_zone(INNER + 1e-9, 0)[0] == pytest.approx(0, abs=1e-6)
    assert dead_zone(OUTER, 0)[0] == pytest.approx(1) and dead_zone(0, -1) == (0, -1)
    assert dead_zone((INNER + OUTER) / 2, 0)[0] == pytest.approx(0.5)


def test_readings_that_are_no_numbers_count_as_rest():
    assert pad_wish(Pad(left=(math.nan, 1.0), right=(math.inf, 0.0), right_trigger=math.nan)) == Wish()
    assert trigger(-1.0) == 0 and trigger(1.0) == 1


@given(st.sets(st.sampled_from([key for row in BINDINGS if row.held for key in row.keys])))
def test_no_keys_are_faster_than_one(keys):
    assert math.hypot(*Keyboard(frozenset(keys)).wish().move) <= 1 + 1e-12


def test_keys_cancel_out_and_let_go():
    board = Keyboard().press("W").press("S").press("LEFT_SHIFT")
    assert board.wish() == Wish(run=1.0)
    assert board.release("S").wish().move == (0.0, 1.0)
    assert board.release("never pressed") == board


def test_a_pad_that_comes_or_goes_does_nothing_by_itself():
    down = Pad(buttons=frozenset({"START"}))
    assert pad_wish(None) == Wish() and pad_pressed(None, down) == () and pad_pressed(down, None) == ()
    assert pad_pressed(Pad(), down) == ("pause",) and pad_pressed(down, down) == ()


def test_the_right_stick_faces_or_turns_the_camera():
    assert pad_wish(Pad(right=(1.0, 0.0))).look == (1.0, 0.0)
    orbiting = pad_wish(Pad(right=(1.0, 0.0), buttons=frozenset({"LB"})))
    assert orbiting.look == (0.0, 0.0) and orbiting.orbit == (-1.0, 0.0)


def test_the_table_is_sound():
    assert len({row.action for row in BINDINGS}) == len(BINDINGS)
    for kind in ("keys", "buttons"):
        names = [name for row in BINDINGS for name in getattr(row, kind)]
        assert len(set(names)) == len(names), f"one of the {kind} does two things"
    assert pressed_by("P") == ("pause",) and pressed_by("W") == () and pressed_by("NOTHING") == ()
    sheet = help_sheet()
    assert len(sheet) <= 20, "the sheet must fit a small window"
    for row in BINDINGS:
        line, = (line for line in sheet if line.startswith(row.help + "  "))
        assert all(key.capitalize() in line for key in row.keys if len(key) == 1)


def command(wish, yaw=0.0, heading=0.0, pilot=Pilot()):
    return pilot.command(wish, yaw, heading, 1 / 60)[1]


@pytest.mark.parametrize(("move", "world"), [((0, 1), (0, 1)), ((-1, 0), (1, 0)), ((1, 0), (-1, 0)), ((0, -1), (0, -1))])
def test_forward_is_away_from_the_camera_and_left_is_left(move, world):
    walk = Pilot().pace.walk
    assert command(Wish(move=move)).velocity == pytest.approx([walk * v for v in world])
    turned = command(Wish(move=move), yaw=math.pi / 2).velocity  # the camera looks along +X
    assert turned == pytest.approx([walk * world[1], -walk * world[0]], abs=1e-12)


def test_paces():
    pace = Pilot().pace
    for wish, speed in ((Wish(move=(0, 1), run=1.0), pace.run), (Wish(move=(0, 1), slow=True), pace.slow),
                        (Wish(move=(0, 0.5)), pace.walk / 2)):
        assert math.hypot(*command(wish).velocity) == pytest.approx(speed)


def test_strafing_keeps_the_heading_it_began_with():
    pilot, first = Pilot().command(Wish(strafe=True), 0.0, 0.4, 1 / 60)
    assert first.facing == 0.4
    pilot, later = pilot.command(Wish(strafe=True, move=(1, 0)), 0.0, 0.9, 1 / 60)
    assert later.facing == 0.4
    pilot, over = pilot.command(Wish(), 0.0, 0.9, 1 / 60)
    assert over.facing is None
    locked, _ = Pilot().toggled().command(Wish(), 0.0, 0.4, 1 / 60)
    _, turned = locked.command(Wish(turn=1.0), 0.0, 0.4, 1.0)
    assert turned.facing == pytest.approx(0.4 + Pilot().pace.turn)


def test_turning_is_on_the_spot_at_rest_and_turns_the_walk_when_walking():
    assert command(Wish(turn=1.0)).turn > 0 and command(Wish(turn=1.0)).swing == 0
    walking = command(Wish(turn=1.0, move=(0, 1)))
    assert walking.turn == 0 and walking.swing > 0


def test_looking_somewhere_faces_there():
    assert command(Wish(look=(-1.0, 0.0))).facing == pytest.approx(math.pi / 2)


def test_a_command_becomes_an_intent():
    state = Glide().start((0, 0, 0))
    assert command(Wish(move=(0, 1))).intent(state).velocity == pytest.approx([1.3, 0, 0])
    assert np.array_equal(command(Wish(turn=1.0)).intent(state).velocity, [0, Pilot().pace.turn, 0])


@given(st.tuples(stick, stick), st.tuples(stick, stick))
def test_two_devices_never_add_up(a, b):
    merged = Wish(move=a).merged(Wish(move=b)).move
    assert math.hypot(*merged) == max(math.hypot(*a), math.hypot(*b))
