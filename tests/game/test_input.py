"""Sticks, keys and the pilot."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.game.hosts.events import PadState
from gambol.game.input import (DEFAULT, JOINING, REWOUND, Keyboard, Pilot, Sticks, Wish, devices, drivers, mode_of,
                               player_of, wheel_wish)
from gambol.game.input.key_names import PAD_BUTTONS
from gambol.game.input.remap import remapped
from stand_in import Glide

INNER, OUTER = DEFAULT.sticks.dead_zone, DEFAULT.sticks.full
stick = st.floats(-1, 1)
anything = st.floats(allow_nan=True, allow_infinity=True)


def dead_zone(x, y, sticks=DEFAULT.sticks):
    return devices.dead_zone(x, y, sticks)


def pad_wish(pad, bindings=DEFAULT):
    return devices.pad_wish(pad, bindings)


def pad_pressed(before, after, bindings=DEFAULT, mode=""):
    return devices.pad_pressed(before, after, bindings, mode)


def wishes(keyboard, pads, players):
    return devices.wishes(keyboard, pads, players, DEFAULT)


def mouse_wish(dx, dy, keyboard, captured=False):
    return devices.mouse_wish(dx, dy, keyboard, DEFAULT, captured)


def pad(left=(0.0, 0.0), right=(0.0, 0.0), triggers=(-1.0, -1.0), *buttons, slot=0):
    return PadState("Pad", (*left, *right, *triggers), frozenset(buttons), slot)


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


@given(st.floats(0.25, 4), st.floats(0, 0.5), st.floats(0.01, 1), st.floats(0.01, 1))
def test_any_curve_rises_from_nothing_to_everything(curve, inner, a, b):
    sticks = Sticks(curve=curve, dead_zone=inner, full=0.9)
    low, high = (dead_zone(v, 0, sticks)[0] for v in sorted((a, b)))
    assert 0 <= low <= high <= 1
    assert dead_zone(0.9, 0, sticks)[0] == pytest.approx(1) and dead_zone(inner, 0, sticks) == (0, 0)


def test_a_curve_is_finer_in_the_middle():
    middle = (INNER + OUTER) / 2
    assert dead_zone(0, middle, replace(DEFAULT.sticks, curve=2.0))[1] == pytest.approx(0.25)


def test_readings_that_are_no_numbers_count_as_rest():
    assert pad_wish(pad((math.nan, 1.0), (math.inf, 0.0), (math.inf, math.nan))) == Wish()
    assert devices.trigger(-1.0, DEFAULT.sticks) == 0 and devices.trigger(1.0, DEFAULT.sticks) == 1


@given(st.tuples(*[anything] * 6), st.sets(st.sampled_from(PAD_BUTTONS)))
def test_whatever_a_pad_says_is_a_wish_in_bounds(axes, buttons):
    wish = pad_wish(PadState("Pad", axes, frozenset(buttons)))
    for v in (wish.move, wish.look, wish.orbit):
        assert math.hypot(*v) <= 1 + 1e-12
    assert 0 <= wish.run <= 1 and abs(wish.turn) <= 1


@given(st.sets(st.sampled_from([key for row in DEFAULT if row.held for key in row.keys])))
def test_no_keys_are_faster_than_one(keys):
    assert math.hypot(*Keyboard(frozenset(keys)).wish(DEFAULT).move) <= 1 + 1e-12


def test_keys_cancel_out_and_let_go():
    board = Keyboard().press("W").press("S").press("LEFT_SHIFT")
    assert board.wish(DEFAULT) == Wish(run=1.0)
    assert board.release("S").wish(DEFAULT).move == (0.0, 1.0)
    assert board.release("never pressed") == board


def test_a_pad_that_comes_or_goes_does_nothing_by_itself():
    down = pad((0, 0), (0, 0), (-1, -1), "START")
    assert pad_wish(None) == Wish() and pad_pressed(None, down) == () and pad_pressed(down, None) == ()
    assert pad_pressed(pad(), down) == ("pause",) and pad_pressed(down, down) == ()


def test_the_right_stick_faces_or_turns_the_camera():
    assert pad_wish(pad(right=(1.0, 0.0))).look == (1.0, 0.0)
    turning = pad((0, 0), (1.0, 0.0), (-1, -1), "LB")
    assert pad_wish(turning).look == (0.0, 0.0) and pad_wish(turning).orbit == (-1.0, 0.0)
    inverted = replace(DEFAULT, sticks=Sticks(invert_x=True))
    assert pad_wish(turning, inverted).orbit == (1.0, 0.0)


def test_sticks_can_be_swapped():
    swapped = replace(DEFAULT, sticks=Sticks(walk="right"))
    assert pad_wish(pad((1.0, 0.0), (0.0, -1.0)), swapped) == pad_wish(pad((0.0, -1.0), (1.0, 0.0)))


def test_triggers_are_buttons_that_also_tell_how_far():
    assert 0.4 < pad_wish(pad(triggers=(-1.0, 0.0))).run < 0.6 and pad_wish(pad(triggers=(1.0, -1.0))).strafe
    other = remapped(DEFAULT, {}, {"run": ("LT",), "strafe": ("X",), "pause": ("RT",), "forward": ("UP",), "rewind": ()})
    assert pad_wish(pad(triggers=(1.0, -1.0)), other).run == 1.0
    assert pad_wish(pad((0, 0), (0, 0), (-1, -1), "X", "UP"), other) == Wish(strafe=True, move=(0.0, 1.0))
    assert pad_pressed(pad(), pad(triggers=(-1.0, 1.0)), other) == ("pause",)
    held = [devices.pad_held(p, "rewind", DEFAULT) for p in (pad((0, 0), (0, 0), (-1, -1), "X"), pad(), None)]
    assert held == [True, False, False]


def test_remapped_keys_walk_and_the_old_ones_do_not():
    other = remapped(DEFAULT, {"forward": ("I",)}, {})
    assert Keyboard(frozenset("I")).wish(other).move == (0, 1) and Keyboard(frozenset("W")).wish(other).move == (0, 0)


@given(st.lists(st.booleans(), max_size=4), st.integers(1, 3))
def test_every_pad_drives_one_player_and_company_gets_the_last(there, players):
    pads = tuple(pad(slot=i) if here else None for i, here in enumerate(there))
    shared = drivers(pads, players)
    plugged = [i for i, here in enumerate(there) if here]
    assert len(shared) == players and sorted(sum(shared, ())) == plugged
    assert all(len(slots) <= 1 for slots in shared[1:])
    if plugged and players > 1:
        assert any(plugged[-1] in slots for slots in shared[1:]), "a pad is worth more to whom has no keyboard"
    for slot in plugged:
        assert slot in shared[player_of(slot, pads, players)]


def test_alone_everything_drives_and_with_company_each_has_their_own():
    board, north, east = Keyboard(frozenset("A")), pad((0.0, -1.0)), pad((1.0, 0.0), slot=1)
    assert [w.move for w in wishes(Keyboard(), (north, None), 1)] == [(0, 1)]
    assert [w.move for w in wishes(Keyboard(), (None, east), 1)] == [(1, 0)]
    assert [w.move for w in wishes(board, (north,), 2)] == [(-1, 0), (0, 1)]
    assert [w.move for w in wishes(Keyboard(), (north, east), 2)] == [(0, 1), (1, 0)]
    assert [w.move for w in wishes(board, (), 2)] == [(-1, 0), (0, 0)]
    assert wishes(Keyboard(), (north, pad((math.nan, 0.0), slot=1)), 2)[1] == Wish()


def test_what_a_press_means_depends_on_the_mode():
    two = (None, pad(), pad(slot=2))
    assert mode_of(1, two, 1) == "" and mode_of(2, two, 1) == mode_of(None, two, 1) == JOINING
    assert mode_of(2, two, 2) == mode_of(None, two, 2) == "" and mode_of(1, two, 1, rewound=True) == REWOUND
    start = pad((0, 0), (0, 0), (-1, -1), "START")
    assert [pad_pressed(pad(), start, mode=m) for m in ("", JOINING, REWOUND)] == [("pause",), ("join",), ("resume",)]
    assert DEFAULT.pressed_by("J", mode=JOINING) == ("join",) and DEFAULT.pressed_by("P", mode=JOINING) == ("pause",)


def test_the_mouse_turns_while_it_drags_or_is_captured():
    drag, free = Keyboard(frozenset({"LEFT_BUTTON"})), Keyboard()
    assert mouse_wish(0.1, 0.2, free) == Wish() and mouse_wish(math.nan, 0.1, drag) == Wish()
    left, up = mouse_wish(0.25, 0.25, drag).drag
    assert (left, up) == (-1.0, 1.0) and mouse_wish(0.25, 0.25, free, captured=True).drag == (left, up)
    assert mouse_wish(0.1, 0.2, Keyboard(frozenset({"MIDDLE_BUTTON"}))) == Wish(pan=(0.1, -0.2))
    assert wheel_wish(2.0).zoom == 2.0 and wheel_wish(math.nan) == Wish() and wheel_wish(1e9).zoom <= 10


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
