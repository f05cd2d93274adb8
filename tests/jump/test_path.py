"""The path estimate: one arc from take-off to landing, for every body, place and planet."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.support_polygon import hull, margin
from gambol.controllers.jump.body.ballistics import along
from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.body import landing_feet, measures, soles
from gambol.controllers.jump.controller import Jump

law = settings(max_examples=60, deadline=None)


@law
@given(st.floats(0.0, 1.5), st.floats(-1.0, 0.5), st.floats(1.5, 15.0), st.booleans())
def test_the_arc_ends_where_the_body_lands(jump, standing, running, far, up, g, runs):
    who, state = Jump(gravity=(0.0, -g, 0.0)), running if runs else standing
    place = np.array([state.ground[0], up, state.ground[1] + far])
    way = who.path(who.start_of(state), place, 0.0)
    np.testing.assert_allclose(along(way.leave, way.velocity, way.airtime, way.gravity), way.land, atol=1e-9)
    gone, speed = way.push.moved(np.array(way.push.duration), way.passing)
    np.testing.assert_allclose(way.low + gone, way.leave, atol=1e-9)
    np.testing.assert_allclose(speed, way.velocity, atol=1e-9)
    assert way.airtime > 0.0 and way.wind_up > 0.0 and way.push.duration > 0.0


def test_a_given_airtime_is_kept(jump, standing):
    way = jump.path(jump.start_of(standing), np.array([0.0, 0.0, 0.5]), 0.0, 0.62)
    assert way.airtime == 0.62


def test_more_is_asked_for_more(jump, standing):
    start = jump.start_of(standing)
    speeds = [np.linalg.norm(jump.path(start, np.array([0.0, up, far]), 0.0).velocity)
              for far, up in ((0.3, 0.0), (0.7, 0.0), (1.1, 0.0), (1.1, 0.2), (1.1, 0.4))]
    assert (np.diff(speeds) > 0.0).all()


@given(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-3.1, 3.1))
def test_soles_land_about_the_place(x, z, heading):
    body, place = Physique().tables, np.array([x, 0.4, z])
    np.testing.assert_allclose(soles(landing_feet(place, heading, body), body).mean(0), place, atol=1e-12)


@pytest.mark.parametrize("height", [1.1, 1.741, 2.0])
def test_a_body_s_heights_grow_with_it(height):
    one, adult, size = measures(Physique(73.0, height)), measures(Physique()), height / 1.741
    assert one.stand == pytest.approx(adult.stand * size, rel=1e-3)
    for way in (0.0, 0.1, 0.25):
        assert one.leave(way * size) == pytest.approx(adult.leave(way) * size, rel=1e-3)
        assert one.touch(way * size) == pytest.approx(adult.touch(way) * size, rel=1e-3)
    assert adult.leave(0.0) > adult.stand > adult.touch(0.0) - 0.01  # people touch down about as high as they stand, on their toes


@law
@given(st.floats(0.0, 1.5), st.floats(-0.5, 0.3), st.floats(1.5, 15.0), st.floats(-3.1, 3.1))
def test_a_standing_jumper_pushes_from_under_its_soles(jump, standing, far, up, g, aside):
    """Of a mass where the centre of mass is, in any direction; half of the speeds are beyond what muscles can."""
    who = Jump(gravity=(0.0, -g, 0.0))
    start = who.start_of(standing)
    here = who.middle(start, 0.0)
    way = who.path(start, here + [far * np.sin(aside), up, far * np.cos(aside)], 0.0)
    time = np.linspace(0.0, 0.95, 8) * way.push.duration
    force, place = way.push.force(time), way.low + way.push.moved(time, way.passing)[0]
    lean = force[:, [0, 2]] / force[:, 1:2]
    pressed = place[:, [0, 2]] - lean * place[:, 1:2]
    if np.hypot(*(way.leave - way.stance)[[0, 2]]) < 0.5:  # farther ahead no leg reaches, and it pushes what it can
        corners = soles(start.planted(0.0, who.physique.tables), who.physique.tables)[:, [0, 2]]
        assert np.array([margin(hull(corners), one) for one in pressed]).min() > -0.06
    assert np.linalg.norm(lean, axis=1).max() < 1.0
