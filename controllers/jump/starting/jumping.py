"""What a jumper remembers while he plays a plan, and where he was left meanwhile."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...contract import CharacterState, Leap
from ..motion import PLANT, Plan
from ..reach import Onward

NEAR = 1e-6
"""Who is no farther from where he was left than this [m, rad] is there."""
SPRINGS = 0.05
"""So long after the lowest point of a landing [s] another leap may still go off from there."""


@dataclass(frozen=True, eq=False)
class Jumping:
    """What a jumper remembers. time: [s] since the plan began. fault: what was struck in mid-air, from where the
    plan is a fall. hits: how often. shift: (3,) x, z [m] of the ground frame from under the centre of mass, and its heading's [rad] from the plan's, as that began. asked: what is
    not to be asked again until it was let go; refused: why the leap that was to follow can't be made, onward: with what that is gone on with being found out.
    stood: (4,) where it was left, see `stands`."""

    plan: Plan
    time: float = 0.0
    fault: str = ""
    hits: int = 0
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    asked: Leap | None = None
    refused: str = ""
    onward: Onward | None = None
    stood: np.ndarray | None = None

    @staticmethod
    def begun(made: Plan, state: CharacterState, asked: Leap | None = None, fault: str = "", hits: int = 0) -> Jumping:
        """The memory of one who begins a plan in a state."""
        return Jumping(made, 0.0, fault, hits, np.asarray(state.ground, float) - [*made.centres[0, [0, 2]], made.path.heading], asked, stood=stands(state))

    @property
    def rebounds(self) -> bool:
        """Whether its legs give to a landing on both feet, or on one to hop on, so that another leap could go off from there."""
        made = self.plan
        return not self.fault and not made.rolls and (made.path.lands is None or made.path.hops) and made.touch_down + PLANT <= self.time < made.lowest + SPRINGS

    @property
    def rises(self) -> bool:
        """Whether it comes up again from a landing on both feet, and may go down into a crouch from there."""
        made = self.plan
        return not self.fault and not made.rolls and made.path.lands is None and made.lowest <= self.time

    @property
    def landed(self) -> bool:
        """Whether the feet have come down."""
        return self.time >= self.plan.touch_down


def stands(state: CharacterState) -> np.ndarray:
    """Where (4,) somebody is: x, z [m], heading [rad], and how high his floor [m]."""
    return np.array([*np.asarray(state.ground, float), float(state.floor)])


def stayed(stood: np.ndarray | None, state: CharacterState) -> None:
    """Nothing, if somebody is where (4,) a motion left him that was planned in the world. ValueError where he was set elsewhere meanwhile."""
    if stood is not None and not (np.abs(stands(state) - stood) <= NEAR).all():
        raise ValueError("who jumps, falls or stumbles can't be set elsewhere, as that was planned where he is: start him there anew, or wait until he walks")
