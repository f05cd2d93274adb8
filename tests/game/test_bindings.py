"""The table of keys and buttons, files that change it, and the sheet that shows it."""

import math
import os
from dataclasses import replace

import glfw
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from gambol.game.app.hints import remember
from gambol.game.cli import app
from gambol.game.hosts.events import PadState
from gambol.game.input import DEFAULT, HOLDING, JOINING, REWOUND, Keyboard, Mouse, Sticks, help_sheet, key_names, remap
from gambol.game.input.remap import BindingsError, as_toml, clashes, load, remapped, shared, user_file


def read(tmp_path, text):
    file = tmp_path / "mine.toml"
    file.write_text(text, encoding="utf-8")
    return load(file)


def test_keys_and_buttons_are_those_of_glfw():
    keys = {name[4:] for name in dir(glfw) if name.startswith("KEY_")} - {"UNKNOWN", "LAST"}
    assert key_names.KEYS == keys | key_names.MOUSE
    order = {"LEFT_BUMPER": "LB", "RIGHT_BUMPER": "RB", "LEFT_THUMB": "LS", "RIGHT_THUMB": "RS", "DPAD_UP": "UP",
             "DPAD_RIGHT": "RIGHT", "DPAD_DOWN": "DOWN", "DPAD_LEFT": "LEFT"}
    for number, button in enumerate(key_names.PAD_BUTTONS):
        theirs = next((k for k, v in order.items() if v == button), button)
        assert getattr(glfw, f"GAMEPAD_BUTTON_{theirs}") == number


def test_the_shipped_table_is_sound():
    actions = [row.action for row in DEFAULT]
    assert len(set(actions)) == len(actions)
    for row in DEFAULT:
        assert set(row.keys) <= key_names.KEYS and set(row.buttons) <= key_names.BUTTONS
        assert row.mode in ("", HOLDING, JOINING, REWOUND) and DEFAULT.row(row.action) is row
    assert not clashes(DEFAULT, "keys") and not clashes(DEFAULT, "buttons")
    assert DEFAULT.pressed_by("P") == ("pause",) and DEFAULT.pressed_by("W") == () and DEFAULT.pressed_by("NOTHING") == ()
    assert [row.action for row in DEFAULT.rows_of("SPACE")] == ["jump"]
    with pytest.raises(KeyError):
        DEFAULT.row("fly")


def test_a_file_changes_only_what_it_names(tmp_path):
    mine = read(tmp_path, """
        keys.forward = ["i", "KEY_UP"]
        keys.film = []
        buttons.slow = "lt"
        buttons.strafe = ["B"]
        sticks.curve = 2
        mouse.invert_y = true
    """)
    assert mine.row("forward").keys == ("I", "UP") and mine.row("film").keys == () and mine.row("slow").buttons == ("LT",)
    assert mine.sticks == Sticks(curve=2.0) and mine.mouse == Mouse(invert_y=True)
    assert mine.row("pause") == DEFAULT.row("pause") and read(tmp_path, "") == DEFAULT


@pytest.mark.parametrize(("text", "said"), [
    ('keys.run = ["SHIFT"]', "keys.run: there is no key 'SHIFT'; did you mean LEFT_SHIFT or RIGHT_SHIFT?"),
    ('buttons.run = ["R9"]', "buttons.run: there is no button 'R9'"),
    ('keys.pauze = "P"', "keys.pauze: there is no such action; did you mean pause?"),
    ('keys.zoom = "Z"', "keys.zoom: no key can do that"),
    ('keys.pause = "R"', "keys.pause: R already does 'reset'"),
    ('keys.pause = "W"', "keys.pause: W already does 'forward'"),
    ('buttons.step = "X"', "buttons.step: X already does 'rewind'"),
    ('keys.forward = "I"\nkeys.back = "i"', "keys.back: I already does 'forward'"),
    ('buttons.turn_right = "LEFT"', "buttons.turn_right: LEFT already does 'turn_left'"),
    ("keys.forward = [3]", "keys.forward: needs names of keys in quotes"),
    ("keys = 3", "keys: needs to be a table"),
    ("[mouze]", "mouze: unknown; choose from keys, buttons, sticks, mouse"),
    ("sticks.dead_zon = 0.1", "sticks.dead_zon: unknown; choose from walk, dead_zone"),
    ("sticks.dead_zone = nan", "sticks.dead_zone: input should be a finite number"),
    ("sticks = {dead_zone = 0.6, full = 0.5}", "sticks: dead_zone = 0.6 needs to be less than full = 0.5"),
    ('sticks.walk = "middle"', "sticks.walk: input should be 'left' or 'right'"),
    ("keys = [", "not TOML"),
])
def test_a_faulty_file_is_told_by_name_and_place(tmp_path, text, said):
    with pytest.raises(BindingsError) as error:
        read(tmp_path, text)
    assert said in str(error.value) and str(error.value).startswith(str(tmp_path / "mine.toml"))


def test_no_file_a_folder_and_no_text(tmp_path):
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    for file in (tmp_path / "none.toml", tmp_path, tmp_path / "bytes.toml"):
        with pytest.raises(BindingsError, match=file.name):
            load(file)


def test_what_lasts_may_share_a_key_and_so_may_two_modes(tmp_path):
    assert read(tmp_path, 'keys.slow = "F"').row("slow").keys == ("F",)  # F also keeps facing
    assert read(tmp_path, 'keys.resume = "P"').pressed_by("P", mode=REWOUND) == ("resume",)


def test_a_key_that_does_two_things_is_told_of(tmp_path):
    assert not shared(DEFAULT)
    mine = tmp_path / "mine.toml"
    mine.write_text('keys.run = ["I", "I"]\nkeys.strafe = "I"\nbuttons.slow = "RT"')
    said = CliRunner().invoke(app, ["bindings", "--bindings", str(mine)])
    assert said.exit_code == 0 and said.stderr.splitlines() == [
        f"gambol: {mine}: keys.run and keys.strafe share I: it does both", f"gambol: {mine}: buttons.run and buttons.slow share RT: it does both"]


some = st.lists(st.sampled_from(sorted(key_names.KEYS)), max_size=3, unique=True).map(tuple)


@given(st.dictionaries(st.sampled_from([row.action for row in DEFAULT if row.can_have("keys")]), some, max_size=4),
       st.floats(0, 0.5), st.booleans())
def test_the_printed_table_is_read_back(tmp_path_factory, keys, inner, flag):
    table = replace(remapped(DEFAULT, keys, {}), sticks=Sticks(walk="right", dead_zone=inner), mouse=Mouse(invert_x=flag))
    file = tmp_path_factory.mktemp("bindings") / "printed.toml"
    file.write_text(as_toml(table), encoding="utf-8")
    if clashes(table):
        with pytest.raises(BindingsError, match="already does"):
            load(file)
    else:
        assert load(file) == table


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_who_has_no_home_has_what_is_shipped(tmp_path, monkeypatch, system):
    """As in a container whose user is a mere number."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)
    monkeypatch.setattr(remap, "user_file", lambda: user_file({}, system))
    assert load() == DEFAULT and as_toml(DEFAULT)
    remember(user_file({}, system).with_name("hints.toml"), {"walk"})
    assert not list(tmp_path.iterdir())


def test_a_users_own_file_is_found(tmp_path, monkeypatch):
    assert user_file({"XDG_CONFIG_HOME": str(tmp_path)}, "linux") == tmp_path / "gambol" / "bindings.toml"
    assert user_file({"APPDATA": str(tmp_path)}, "win32") == tmp_path / "gambol" / "bindings.toml"
    for system in ("linux", "darwin", "win32"):
        assert user_file({"XDG_CONFIG_HOME": "not/absolute"}, system).is_absolute()
    for name in ("XDG_CONFIG_HOME", "APPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    assert load() == DEFAULT
    user_file().parent.mkdir(parents=True)
    user_file().write_text('keys.pause = "O"')
    assert load().row("pause").keys == ("O",)


def test_the_command_prints_and_writes_what_is_in_force(tmp_path):
    def run(*words):
        return CliRunner().invoke(app, ["bindings", *map(str, words)])
    mine, out = tmp_path / "mine.toml", tmp_path / "new" / "out.toml"
    mine.write_text('keys.pause = "O"')
    printed = run("--bindings", mine)
    assert printed.exit_code == 0 and 'pause          = ["O"]' in printed.stdout
    assert run("--bindings", mine, "--write", out).exit_code == 0 and load(out) == load(mine)
    again = run("--write", out)
    assert again.exit_code == 2 and "is there already" in again.stderr and load(out) == load(mine)
    mine.write_text('keys.pause = "R"')
    faulty = run("--bindings", mine)
    assert faulty.exit_code == 2 and "R already does 'reset'" in faulty.stderr


def lines(sheet):
    return {line.cells[0]: line for table in sheet.tables for line in table}


def test_the_sheet_shows_the_table_in_force():
    shown = lines(help_sheet(remapped(DEFAULT, {"pause": ("O", "PAGE_UP")}, {"pause": ()})))
    assert shown["pause"].cells == ("pause", "O Page up", "")
    for row in DEFAULT:
        assert row.help in shown
    swapped = lines(help_sheet(replace(DEFAULT, sticks=Sticks(walk="right"))))
    assert swapped["walk"].cells[2] == "right stick" and swapped["turn the camera"].cells[2] == "LB + left stick"


def test_the_sheet_lights_what_is_held():
    def lit(*args, **more):
        return {name for name, line in lines(help_sheet(DEFAULT, *args, **more)).items() if line.lit}
    assert lit() == set() and lit(Keyboard(frozenset({"W", "P"}))) == {"walk", "pause"}
    start = PadState("Pad", (0, -1, 0, 0, -1, 1), frozenset({"START"}))
    assert lit(pads=(start,)) == {"walk", "run", "pause"} and "pause" not in lit(pads=(start,), rewound=True)
    assert "a second player joins" in lit(pads=(PadState("First"), start))


def test_the_sheet_shows_every_pad_as_it_reads():
    pad = PadState("Stick", (0.5, 1.0, math.nan, 0.0, 1.0, -1.0), frozenset({"A", "UP"}), slot=2)
    shown, = help_sheet(DEFAULT, pads=(None, None, pad), players=2).pads
    assert shown.caption == "Stick: player 2" and shown.dials[0].at == (0.5, -1.0) and shown.dials[1].at == (0.0, 0.0)
    assert [bar.filled for bar in shown.bars] == [1.0, 0.0]
    assert {lamp.label for row in shown.lamps for lamp in row if lamp.lit} == {"A", "↑"}
    assert sum(map(len, shown.lamps)) == len(key_names.PAD_BUTTONS)
    assert "no pad" in help_sheet(DEFAULT, pads=(None,)).note
    assert "player 2 waits" in help_sheet(DEFAULT, players=2).note
