"""The films that ship: each is made once, and all laws look at that one run."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
import pytest

from gambol.controllers.navigation import floor_at
from gambol.controllers.person import person
from gambol.controllers.reconstruction.database import store
from gambol.controllers.reconstruction.ours import combined
from gambol.controllers.reconstruction.ours.networks import learn
from gambol.game.camera.line_of_sight import blocked
from gambol.game.input.making import jumping
from gambol.game.scenario import doubts, film
from gambol.game.scenario.scenario import Scenario, load, shipped
from gambol.game.scene.scene import Overlays
from gambol.game.world import RATE, Watches
from gambol.game.world.learnt_methods import methods
from stand_in import same

CROWD, BEGINNING, MOST = 8, 0.8, 4.0
"""More people than that cost as much as all other films together: of them the first seconds are enough, and of others these, unless tests are to be thorough."""
WHOLE = "jump_course", "narrow_door"
"""… but all of those that have most in them, and that a law of their own looks at."""
AGAIN = "crossing", "go_across", "jump_course", "medley"
"""Films of each kind that is made twice in any case: walks, leaps, goals, people who avoid each other. Other tests look at those who follow points or are tracked."""
OWN = "test_the_demo_goes_as_it_is_told", "test_the_two_in_the_corridor_meet_and_pass"
NOTHING = "nothing to step on"
COMPARED = 15
"""Every so many steps two runs are held against each other."""


def compared(scenario):
    """For how long [s] a film is made again: all that was made of the medley, and the beginnings of the others."""
    if any(actor.tracks is not None for actor in scenario.actors):
        return 0.75
    few = 2.5 if len(scenario.actors) <= 4 else 1.25 if len(scenario.actors) <= 20 else 1.0
    return scenario.duration if scenario.title == load("medley").title else 1.0 if scenario.followers else few


@dataclass(frozen=True)
class Was:
    """One of a film at one moment: where, on which floor, and whether in a jump."""

    ground: tuple[float, float, float]
    floor: float
    jumps: bool


@dataclass(frozen=True, eq=False)
class Made:
    """What came of a film. steps: who was there in each step, and how. moments: some worlds of its beginning. seen, lost: how often each shot and view
    was looked at, and how often it did not show whom it is about."""

    scenario: Scenario
    steps: list[dict[str, Was]]
    moments: list
    seen: Counter
    lost: Counter
    refused: set[str]
    fell: set[str]
    hidden: list


@pytest.fixture(scope="module")
def walker():
    return person()


@pytest.fixture(scope="module", params=shipped())
def made(request, walker):
    """A film, seen four times a second.

    Who follows points walks after them: what makes a body of them plays no part, and costs a hundred times as much. Nor do overlays.
    """
    scenario, steps, moments = load(request.param).at_fps(4), [], []
    own = {test.callspec.params["made"] for test in request.session.items if test.path == request.path and test.originalname in OWN}
    whole = request.config.option.thorough or request.param in WHOLE or request.param in own
    long = scenario.duration if whole else min(scenario.duration, MOST) if len(scenario.actors) <= CROWD else BEGINNING
    run, few = film.acts, compared(scenario)

    def heard(*asked):
        for act in run(*asked):
            world = act.world
            steps.append({one.name: Was(tuple(map(float, one.state.ground)), float(one.state.floor), jumping(one.state) is not None)
                          for one in world.characters if one.there(world.number)})
            if world.number % COMPARED == 0 and world.time <= few:
                moments.append(world)
            yield act

    lost, seen, refused, fell, hidden = Counter(), Counter(), set(), set(), []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(film, "follower_of", lambda performer, *_: walker)
        patch.setattr(film, "tracked_of", lambda *_: walker)
        patch.setattr(Watches, "sighting", lambda *_: None)
        patch.setattr(film, "acts", heard)
        for frame, scenes in film.scenes(scenario, walker, Overlays()):
            if frame.time >= long:
                break
            shot = [s for s in scenario.shots if s.at <= frame.time][-1]
            refused.update(frame.refused)
            fell.update(one.name for one in frame.after.characters if NOTHING in one.state.refused)
            for view, (table, scene) in enumerate(zip(shot.cameras, scenes, strict=True)):
                if blocked(scene.camera.eye, scenario.stage(), 0.0) is not None or scene.camera.eye[1] <= 0.1:
                    hidden.append((shot.at, view, frame.time))
                aspect = scene.part[2] * scenario.size[0] / (scene.part[3] * scenario.size[1])
                inside = {}
                for actor, figure in zip(frame.after.characters, scene.figures, strict=True):
                    x, y = in_picture(figure.positions[0] * [1, 0.1, 1], scene.camera, aspect)  # the feet
                    inside[actor.name] = figure.opacity > 0.0 and max(abs(x), abs(y)) <= 1
                # a shot of a place is about anybody who is there
                for there in [inside[name] for name in table.names] or [any(inside.values())]:
                    seen[shot.at, view] += 1
                    lost[shot.at, view] += not there
    return Made(scenario, steps, moments, seen, lost, refused, fell, hidden)


def in_picture(point, camera, aspect):
    """Where a point is seen: −1 … 1 across and up, if it is in the picture."""
    forward = (camera.target - camera.eye) / np.linalg.norm(camera.target - camera.eye)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    way = point - camera.eye
    half = np.tan(0.5 * camera.fov) * (way @ forward)
    return way @ right / (half * aspect), way @ np.cross(right, forward) / half


def of(name):
    """A law of one film: the run that the other laws look at."""
    return pytest.mark.parametrize("made", [name], indirect=True, scope="module")


def test_shipped_films_show_whom_they_are_about(made):
    """In every shot and view, whoever it is about is in the picture; a camera is never in a prop; nothing is refused but what is to be, and nobody steps into nothing."""
    assert not made.hidden
    assert made.seen and all(made.lost[one] <= 0.1 * made.seen[one] for one in made.seen), {one: (made.lost[one], made.seen[one]) for one in made.lost}
    assert len(made.refused) == (made.scenario.title == load("narrow_door").title), made.refused
    assert list(doubts(made.scenario)) == []
    assert not made.fell


@pytest.fixture(scope="module")
def hasty(tmp_path_factory):
    """Networks learn for a moment only, and lie apart from those that serve."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(combined, "learn", lambda samples, progress, **_: learn(samples, 1, 300, (64,), progress))
        patch.setattr(store, "cache_folder", lambda: tmp_path_factory.getbasetemp() / "hasty" / "kernels")
        methods.cache_clear()
        yield
        methods.cache_clear()


@pytest.mark.parametrize("made", [name if name in AGAIN else pytest.param(name, marks=pytest.mark.thorough) for name in shipped()], indirect=True, scope="module")
def test_a_film_is_the_same_to_the_bit(made, hasty):
    """Made again by somebody else who is loaded anew; films of those who follow others, or are tracked, twice, with the methods that serve."""
    scenario, last = made.scenario, made.moments[-1].number

    def again():
        return [world for world, _ in zip(film.worlds(scenario, person()), range(last + 1)) if world.number % COMPARED == 0]

    assert last >= min(compared(scenario) - 0.5, MOST - 1.0) * RATE
    followed = scenario.followers or any(actor.tracks is not None for actor in scenario.actors)
    for one, other in zip(again() if followed else made.moments, again(), strict=True):
        assert same(one, other)


@pytest.mark.thorough
@of("demo")
def test_the_demo_goes_as_it_is_told(made):
    """Every jump is made, nobody walks through anybody or off a platform, and all are where the film needs them."""
    apart, jumped, stage = [], set(), made.scenario.stage()
    for number, people in enumerate(made.steps):
        if {"B", "C"} <= set(people):
            apart.append(np.hypot(*np.subtract(people["B"].ground, people["C"].ground)[:2]))
        jumped |= {(name, round(one.floor, 2)) for name, one in people.items() if one.jumps}
        for name, one in people.items():
            assert one.jumps or floor_at(*one.ground[:2], stage) == pytest.approx(one.floor), f"{name} stands on nothing at {number / RATE:.2f} s"
    assert len(apart) > 450 and min(apart) > 0.8
    assert {("A", 0.3), ("A", 0.6), ("A", 0.0), ("P", 0.0), ("Child", 0.0), ("Adult", 0.0), ("Moon", 0.0)} <= jumped
    assert np.linalg.norm(np.subtract(made.steps[-1]["A"].ground[:2], [19.4, 35.2])) < 0.4, "in front of the last camera"


@of("corridor")
def test_the_two_in_the_corridor_meet_and_pass(made):
    a, b = (np.array([people[name].ground[:2] for people in made.steps]) for name in made.steps[0])
    assert np.linalg.norm(a - b, axis=1).min() > 0.8, "nobody is walked through"
    assert a[-1, 1] > 10 and b[-1, 1] < 0, "both get where they were going"
    met = np.argmax(a[:, 1] > b[:, 1])
    assert a[met, 0] < -0.3 < 0.3 < b[met, 0], "A has stepped aside"
    assert np.abs(np.diff(b, axis=0)[met - 30:met]).max() * 60 < 0.1, "B waits while A passes"
    assert np.all(np.abs(a[:, 0]) < 1.1)
