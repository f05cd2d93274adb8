"""Actors who are told where to be and avoid each other: nobody touches anybody, all arrive."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load
from scenarios import written

SCENARIO = """
title = "Among others"
duration = 14
avoid = true
[[props]]
centre = [0.0, 0.5, 1.6]
size = [0.6, 1.0, 0.6]
[[actors]]
name = "A"
start = [-3.5, 0, 90]
moves = [{ go_to = [3.5, 0.2], heading = 0 }]
[[actors]]
name = "B"
start = [3.5, 0, -90]
moves = [{ go_to = [-3.5, 0], heading = 180 }]
[[actors]]
name = "C"
start = [0, -3.5, 0]
moves = [{ go_to = [0, 3.5] }]
[[actors]]
name = "D"
start = [-1.5, 0.1, 180]
moves = [{ for = 20, stop = true }]
"""


def played(tmp_path, text):
    scenario, trails = load(written(tmp_path, text)), []
    for act in film.acts(scenario, Locomotion.load()):
        trails.append([one.state.ground for one in act.world.characters])
        if act.world.time >= scenario.duration or all(script.done for script in act.scripts[:3]):
            return act, np.array(trails)


@pytest.mark.thorough
def test_those_who_go_to_goals_avoid_each_other_and_arrive(tmp_path):
    act, trails = played(tmp_path, SCENARIO)
    places = trails[:, :, :2]
    apart = np.linalg.norm(places[:, :, None] - places[:, None], axis=-1) + 9.0 * np.eye(4)
    assert apart.min() > 0.44, "bodies of 0.22 m"
    for who, goal in enumerate(((3.5, 0.2), (-3.5, 0.0), (0.0, 3.5))):
        assert np.hypot(*(places[-1, who] - goal)) < 0.03 and act.scripts[who].done and not act.scripts[who].refused
    assert np.abs(places[:, 3] - places[0, 3]).max() < 0.4, "who stands is gone round"


def test_alone_a_goal_is_walked_to_as_without_others(tmp_path):
    alone = SCENARIO[:SCENARIO.index('[[actors]]\nname = "B"')]
    _, with_manners = played(tmp_path, alone)
    _, without = played(tmp_path, alone.replace("avoid = true", ""))
    assert np.array_equal(with_manners, without)


@pytest.mark.thorough
def test_the_two_at_the_corner_would_meet_and_pass_without_a_script():
    def met(avoid, until):
        nearest = np.inf
        for act in film.acts(load("corridor_free").model_copy(update={"avoid": avoid}), Locomotion.load()):
            one, other = (character.state.ground for character in act.world.characters)
            nearest = min(nearest, np.hypot(*(one - other)[:2]))
            if act.world.time >= until:
                return act, nearest
    act, nearest = met(True, load("corridor_free").duration)
    assert nearest > 0.5 and all(script.done and not script.refused for script in act.scripts)
    one, other = (character.state.ground for character in act.world.characters)
    assert one[1] > 10 and other[1] < 1, "both get where they were going"
    assert met(False, 6.0)[1] < 0.3, "they would meet"


LEAP = """
title = "A leap"
duration = 14
avoid = true
props = [{ centre = [0, 0.3, 0], size = [2, 0.6, 5] }, { centre = [0, 0.3, 5.9], size = [2, 0.6, 5] }]
[[actors]]
name = "A"
start = [0, -2, 0]
moves = [{ go_to = [0.2, 7.0] }]
[[actors]]
name = "B"
start = [0, 4.3, 180]
moves = [{ for = 5, stop = true }, { go_to = [-0.5, 8.0] }, { for = 30, stop = true }]
"""


def test_nobody_leaps_where_another_stands(tmp_path):
    leapt, scenario = None, load(written(tmp_path, LEAP))
    for act in film.acts(scenario, person()):
        one, other = (character.state for character in act.world.characters)
        if act.world.time < 5.0:
            assert np.hypot(other.ground[0], other.ground[1] - 4.3) < 0.05, "the box on which one stands pushes nobody off"
        if leapt is None and one.active == "jump":
            leapt = act.world.time
            assert np.hypot(other.ground[0], other.ground[1] - 4.3) > 0.5, "he waits until the place is free"
        if act.world.time > 14 or act.scripts[0].done:
            break
    assert leapt is not None and leapt > 5.0 and np.hypot(*(one.ground[:2] - [0.2, 7.0])) < 0.1
