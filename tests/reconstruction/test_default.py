"""Gambol's own motion is made once, and anew when what makes it has changed, not when anything else has."""

import shutil

import numpy as np

from gambol.controllers.reconstruction.database import default as module
from gambol.controllers.reconstruction.database.database import Writer
from gambol.controllers.reconstruction.pose_vector import WIDTH


def test_it_is_made_again_only_when_its_sources_change(tmp_path, monkeypatch):
    made = []

    def write(path):
        made.append(path)
        with Writer(path) as writer:
            writer.add("own/walk", "Gambol", "walk", np.zeros((40, WIDTH)), np.ones(40, bool))
    sources = tmp_path / "controllers"
    shutil.copytree(module._CONTROLLERS, sources, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(module, "_CONTROLLERS", sources)
    monkeypatch.setattr(module, "write_own", write)
    monkeypatch.setattr(module, "folder", lambda: tmp_path / "learnt")
    first = module.default_database()
    again = module.default_database()
    assert len(made) == 1 and np.array_equal(first.frames, again.frames)
    (sources / "reconstruction" / "ours" / "combined.py").write_text("# no motion comes of this\n")
    module.default_database()
    assert len(made) == 1
    (sources / "locomotion" / "step.py").write_text("# but all of it of this\n")
    module.default_database()
    assert len(made) == 2 and len(list((tmp_path / "learnt").iterdir())) == 2
