"""Two people in a film: whoever is followed by masks is told where the other one stands."""

import numpy as np
from film_set import CAMERAS, Drawing
from scenarios import written
from stand_in import Glide

from gambol.controllers.tracking.cameras import read_cameras
from gambol.controllers.tracking.silhouettes import HIDDEN
from gambol.game.footage import read_footage, seen_in
from gambol.game.scenario.scenario import load
from gambol.game.studio import Plan, Sensor, shoot

SCENARIO = """
title = "Two"
duration = 0.1
fps = 30
[[actors]]
name = "Ann"
[[actors]]
name = "Bob"
start = [0.3, 0.3, 0]
"""


def test_masks_say_where_others_stand(tmp_path):
    (tmp_path / "c.toml").write_text(CAMERAS)
    list(shoot(Plan(load(written(tmp_path, SCENARIO)), read_cameras(tmp_path / "c.toml"), Sensor()), tmp_path / "out", Glide(), Drawing()))
    film = read_footage(tmp_path / "out")
    for lens, ann, bob in zip(film.lenses, seen_in(film, 0, 0, True), seen_in(film, 0, 1, True)):
        people = film.picture(lens.name, "mask", 0)
        assert set(np.unique(people)) == {0, 1, 2}
        for who, mask in enumerate((ann, bob), 1):
            np.testing.assert_array_equal(mask, np.where(people == who, 1, np.where(people > 0, HIDDEN, 0)))
