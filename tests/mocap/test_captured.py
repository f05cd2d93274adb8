"""Motion as it was captured: joints where the performer's are, on a skeleton of their own lengths."""

from dataclasses import replace

import numpy as np
import pytest
from test_retarget import walk

from gambol.controllers.body import Skeleton
from gambol.controllers.mocap import captured

SIZE, LONGER = 1.1, 1.15


def test_a_performer_of_other_proportions_is_found():
    """Somebody a tenth larger than ours, with longer forearms beside: their own lengths, and joints where they are."""
    clip = walk()
    mine = clip.skeleton
    offsets = SIZE * mine.offsets
    offsets[[mine.index(side + "Hand") for side in ("Left", "Right")]] *= LONGER
    theirs = replace(clip, skeleton=Skeleton(mine.names, mine.parents, offsets, mine.end_parents, SIZE * mine.end_offsets), root=SIZE * clip.root)
    found = captured([theirs])
    ratio = np.linalg.norm(found.skeleton.offsets, axis=-1)[1:] / np.linalg.norm(mine.offsets, axis=-1)[1:]
    expected = np.where([name.endswith("Hand") for name in mine.names[1:]], SIZE * LONGER, SIZE)
    legs = [j for j, name in enumerate(mine.names[1:]) if name.endswith(("Hand", "ForeArm", "Leg", "Foot"))]
    assert ratio[legs] == pytest.approx(expected[legs], rel=0.01)
    places, _ = theirs.kinematics()
    hand = mine.index("LeftHand")
    assert found.known[hand] and np.allclose(found.positions[:, hand], places[:, hand]) and np.isnan(found.positions[:, ~found.known]).all()
