"""Paths of scripts: walked as far as they go, wherever they end, and hops over what is low."""

import math

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.game.input.moves import Move
from gambol.game.input.script import Script
from gambol.game.scenario import film
from gambol.game.scenario.scenario import ScenarioError, load
from scenarios import written

FPS = 60


@pytest.mark.few(2)
@pytest.mark.parametrize("points", [
    ((0.0, 2.0), (2.0, 2.0), (2.0, 0.0), (0.0, 0.0)),  # ends where it begins
    ((0.0, 1.0), (0.0, 4.0), (3.0, 4.0), (0.0, 1.0)),  # passes its own end
    ((0.0, 3.0), (0.0, 0.1)),  # goes back the same way
    ((0.0, 2.0), (1.0, 3.0), (3.0, 3.0)),
])
def test_a_path_is_walked_to_its_end_past_all_its_points(points):
    walker = Locomotion.load()
    script, state, way = Script((Move(math.inf, points=points, speed=1.2),)), walker.start(), []
    length = sum(math.dist(a, b) for a, b in zip(((0.0, 0.0), *points), points))
    while not script.done and len(way) < FPS * (length / 1.2 + 10.0):
        script, intent = script.step(state, 1 / FPS)
        state, _ = walker.step(state, intent, 1 / FPS)
        way.append(state.ground[:2])
    assert script.done
    for point in points:
        assert np.hypot(*(np.array(way) - point).T).min() < 0.5, point
    assert math.dist(state.ground[:2], points[-1]) < 0.25


HOPS = """
title = "Hops"
duration = {duration}
[[props]]
centre = [0, {middle}, 1.9]
size = [3, {high}, 2.2]
[[actors]]
name = "A"
moves = [{{ hops = 4, ahead = 0.5 }}, {{ stop = true, for = 0.5 }}]
"""


@pytest.mark.few(1)
@pytest.mark.parametrize("high, up", [(0.15, True), (0.7, False)])
def test_hops_go_up_a_kerb_and_end_before_a_wall(tmp_path, high, up):
    text = HOPS.format(duration=5, middle=high / 2, high=high)
    *_, frame = film.run(load(written(tmp_path, text)), person())
    state = frame.after.characters[0].state
    if up:
        assert not frame.refused and state.floor == pytest.approx(high) and state.ground[1] == pytest.approx(2.0, abs=0.15)
    else:
        assert len(frame.refused) == 1 and state.floor == 0.0


@pytest.mark.parametrize("line, says", [
    ("strikes = [{ at = 9, impulse = 50, towards = 0 }]", r"actors\[0\].strikes\[0\].at: comes 9 s after he enters; he is there for 5 s"),
    ("moves = [{ walk_to = [1, 2, 3] }]", "walk_to: needs 2 at most, has 3"),
    ("moves = [{ walk_to = [1, 2], speed = 0.02 }]", "speed: input should be greater than or equal to 0.1, got 0.02"),
])
def test_what_nobody_can_mean_is_told(tmp_path, line, says):
    with pytest.raises(ScenarioError, match=says):
        load(written(tmp_path, f'title = "A"\nduration = 5\n[[actors]]\nname = "A"\n{line}\n'))
    with pytest.raises(ScenarioError, match=r"actors\[0\].moves: is a list of tables: each begins with \[\[actors.moves\]\]"):
        load(written(tmp_path, 'title = "A"\nduration = 5\n[[actors]]\nname = "A"\nmoves = { walk_to = [0, 5] }\n'))
    with pytest.raises(ScenarioError, match=r"actors\[0\].moves\[0\]: needs a table, { name = value, … }, got 'walk'"):
        load(written(tmp_path, 'title = "A"\nduration = 5\n[[actors]]\nname = "A"\nmoves = ["walk"]\n'))
    with pytest.raises(ScenarioError, match=r"actors: is a list of tables: each begins with \[\[actors\]\]"):
        load(written(tmp_path, 'title = "A"\nduration = 5\n[actors]\nname = "A"\n'))
