"""A jump of nobody, which compiles the jump's kernels."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from ..body import Pose
from ..contract import CharacterState, Intent, Leap
from .body import measures
from .controller import Jump
from .motion import Stands, changes, heels_down, rolled
from .reach import touch

BLOCK = SimpleNamespace(centre=(0.0, 0.5, 0.8), size=(1.0, 1.0, 0.2), heading=0.0)
"""What stands in its way."""


def rehearse(jump: Jump) -> None:
    """Plan and step a jump off a T-pose, so that what it compiles or loads does not halt a game."""
    skeleton = jump.skeleton
    pose = Pose(skeleton.offsets[0].copy(), np.tile(np.eye(3), (len(skeleton), 1, 1)))
    state = CharacterState(np.zeros(3), np.zeros(3), pose, np.ones(4, bool), None, 0.0, pose, 1.0 / 60.0)
    intent = Intent(leap=Leap(np.array([0.0, 0.0, 0.5])))
    begun = jump.enter(state, intent)
    jump.step(begun, intent, 1.0 / 60.0)
    rolled(jump.physique, begun.memory.plan)
    touch(jump.physique, begun.memory.plan, (BLOCK,))
    start, ahead = jump.start_of(state), np.array([0.0, 0.0, 1.0])  # what is asked besides of who goes
    changes(jump.physique, Stands(start.centre, ahead, start.feet, 0), ahead, ahead, 0.0, -float(jump.gravity[1]))
    heels_down(start.centre[None], start.feet[None], jump.physique.tables, 0.0)
    measures(jump.physique)  # found once a body

