"""Somebody else's body walks as large as it is."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Strike
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor
from gambol.game.character import Build, tailored
from gambol.game.render.mesh import mannequin
from gambol.game.render.wear import leg_length
from gambol.game.world.embodied import Embodied, sized
from gambol.game.world.world import DT, Character, World, figures


@pytest.fixture(scope="module")
def walking():
    return Locomotion.load(None)


def walked(controller, speed, steps=90):
    world = World((Character("A", controller, controller.start(ground=(1.0, 2.0, 0.5))),))
    for _ in range(steps):
        before, world = world, world.step([Intent(np.array([speed, 0.2, 0.0]))])
    return before, world


def test_in_the_standard_body_nothing_changes(walking):
    (_, plain), (_, own) = walked(walking, 1.2), walked(Embodied.of(walking, mannequin()), 1.2)
    a, b = plain.characters[0].state, own.characters[0].state
    assert np.array_equal(a.pose.rotations, b.pose.rotations) and np.array_equal(a.ground, b.ground)


def test_a_child_takes_a_childs_steps_where_it_is(walking):
    child = Embodied.of(walking, tailored(Build(height=1.1, child=1.0)))
    assert 0.5 < child.factor < 0.65
    before, world = walked(child, 0.8)
    state = world.characters[0].state
    assert abs(state.velocity[0] - 0.8) < 0.1, "it goes as fast as it is asked to"
    start = child.start(ground=(1.0, 2.0, 0.5))
    assert np.allclose(start.ground, [1.0, 2.0, 0.5]) and start.pose.root[1] < 0.65
    drawn, = figures(before, world, 1.0)
    assert drawn.body is child.body and abs(leg_length(drawn.positions) / leg_length(child.body.joints) - 1.0) < 0.02
    moved = np.linalg.norm(world.characters[0].state.ground[:2] - before.characters[0].state.ground[:2])
    assert abs(moved / DT - np.hypot(*state.velocity[[0, 2]])) < 0.15


def test_a_body_in_another_unit_is_fitted(walking):
    from dataclasses import replace
    assert Embodied.of(walking, replace(mannequin(), joints=mannequin().joints * 100.0)).factor == 1.0


def test_another_body_is_struck_turns_and_stops_as_the_standard_one():
    """A push moves it by the impulse over its own mass; it turns from rest by the same steps; and it is as soon at rest."""
    somebody = person()
    bodies = {factor: {name: sized(one, factor) for name, one in somebody.parts.items()} for factor in (1.0, 0.8)}
    times, turned = {}, {}
    for factor, parts in bodies.items():
        controller = Supervisor(parts)
        assert parts["struck"].physique.mass == pytest.approx(73.0 * factor**3)
        state, _ = controller.step(controller.start(), Intent(strike=Strike((0.0, 60.0 * factor**3.5))), DT)
        assert state.active == "struck" and state.velocity[0] > 0.3 * factor**0.5
        state = controller.start()
        for _ in range(200):
            state, _ = controller.step(state, Intent(np.array([1.2 * factor**0.5, 0.0, 0.0])), DT * factor**0.5)
        for step in range(200):
            state, _ = controller.step(state, Intent(), DT * factor**0.5)
            times[factor] = step
            if np.abs(state.velocity[0]) < 0.02 * factor**0.5:
                break
        state, speed = controller.start(), np.array([0.0, 2.0 * factor**-0.5, 0.0])
        for _ in range(60):
            state, _ = controller.step(state, Intent(speed, towards=np.array([2.0, 0.0])), DT * factor**0.5)
        turned[factor] = state.ground[2]
    assert abs(times[1.0] - times[0.8]) <= 2 and turned[0.8] == pytest.approx(turned[1.0], abs=0.02)
