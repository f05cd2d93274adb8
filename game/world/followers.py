"""Following points: who is driven by points on somebody else's body, what is lost of them, and how far off it is.

A performer has control points; a follower's controller is told where they are, and nothing else. What a follower
does is the performer's motion, so that every joint of it can be compared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from gambol.controllers.body import STATURE, Pose
from gambol.controllers.contract import CharacterState, Intent
from gambol.controllers.navigation import floor_at
from gambol.controllers.supervisor import Supervisor

from .embodied import Embodied
from .learnt_methods import Methods
from .performers import walker_of

if TYPE_CHECKING:  # what reconstructs is loaded by the functions that need it: a game without a study starts without
    from gambol.controllers.reconstruction import ControlPoints

KEPT = 240
"""How many steps of errors are remembered."""
OVER = 30
"""Over so many steps the errors that are told are averaged."""


@dataclass(frozen=True, eq=False)
class Hidden:
    """Some points are not seen. which: (n,) bool. start, end: [s]."""

    which: np.ndarray
    start: float
    end: float


@dataclass(frozen=True, eq=False)
class Follows:
    """How a character follows points.

    method: whose reconstruction it is, by name. controls: n points. performer: the character who has them; "" where
    somebody else, hands or a stream, says where they are, in `Intent.points`. beside: (3,) [m] from the performer's
    points to those that are followed. noise: standard deviation [m]. seed: of the noise. turning: whether how they are turned
    is seen, too.
    """

    method: str
    controls: ControlPoints
    performer: str = ""
    beside: np.ndarray = field(default_factory=lambda: np.zeros(3))
    hidden: tuple[Hidden, ...] = ()
    noise: float = 0.0
    seed: int = 0
    turning: bool = False

    def there(self, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
        """Where the points (n, 3) [m] of a performer's body are, had none been lost, as they are followed."""
        return self.controls.on(positions, orientations) + self.beside

    def seen(self, positions: np.ndarray, orientations: np.ndarray, time: float) -> np.ndarray:
        """What is seen of them at a time [s]: (n, 3) [m], NaN where one is hidden. The same for the same time."""
        points = self.there(positions, orientations)
        if self.noise > 0.0:
            rng = np.random.default_rng((self.seed, round(1000.0 * time)))
            points = points + rng.normal(scale=self.noise, size=points.shape)
        points[self.unseen(time)] = np.nan
        return points

    def turns(self, orientations: np.ndarray, time: float) -> np.ndarray | None:
        """How the joints of a performer's points are turned (n, 3, 3) at a time [s], NaN where one is hidden; None where that is not seen."""
        if not self.turning:
            return None
        turns = np.array(orientations[self.controls.joints], float)
        turns[self.unseen(time)] = np.nan
        return turns

    def unseen(self, time: float) -> np.ndarray:
        """Which points (n,) are hidden at a time [s]."""
        lost = np.zeros(len(self.controls), bool)
        for hidden in self.hidden:
            if hidden.start <= time + 1e-9 < hidden.end:
                lost |= hidden.which
        return lost


@dataclass(frozen=True)
class Errors:
    """How far off a follower is [m]: on the average of all joints, and in the worst of them, which is `joint`.

    points: its control points from those that are seen; NaN where none is.
    """

    mean: float
    worst: float
    joint: str
    points: float


def errors(follows: Follows, found: tuple[np.ndarray, np.ndarray], truth: np.ndarray | None,
           seen: np.ndarray) -> np.ndarray:
    """The errors of one moment (4,): mean and worst over joints [m], the worst one's number, points' residual [m].

    found: positions (J, 3) and orientations (J, 3, 3) of the follower. truth: (J, 3) of the performer; None where
    there is none. seen: (n, 3) the points that are followed, NaN where unseen. The mean is `metrics.position_error`.
    """
    away = np.linalg.norm(follows.controls.on(*found) - seen, axis=-1)
    away = away[np.isfinite(away)]
    residual = float(away.mean()) if len(away) else math.nan
    if truth is None:
        return np.array([math.nan, math.nan, -1.0, residual])
    return np.append(joint_errors(found[0], truth + follows.beside)[:3], residual)


def joint_errors(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """The errors of one moment (4,), as `errors` has them, of joints (J, 3) [m] that should be at `truth`; of no points."""
    from gambol.controllers.reconstruction import JOINTS
    from gambol.controllers.reconstruction.evaluation import position_error

    apart = np.linalg.norm(found[JOINTS] - truth[JOINTS], axis=-1)
    worst = int(np.argmax(apart))
    return np.array([float(position_error(found[None], truth[None])[0]), apart[worst], float(JOINTS[worst]), math.nan])


def carried(follows: Follows, state: CharacterState, truth: np.ndarray, around: Sequence[Any]) -> CharacterState:
    """A follower's state on the floor that its performer stands over, which may have changed.

    That is the lower one of those below the ankles: a foot that is not over a box yet is not in it. While the follower
    walks by itself it stays on its own floor. truth: (J, 3) [m] of the performer. around: props.
    """
    if state.active != "reconstruction":
        return state
    from gambol.controllers.reconstruction import SKELETON

    ankles = truth[[SKELETON.index("LeftFoot"), SKELETON.index("RightFoot")]]
    floor = min(floor_at(x, z, around, y) for x, y, z in ankles)
    return replace(state, floor=floor + float(follows.beside[1]))


def lately(told: np.ndarray) -> Errors | None:
    """The errors (N, 4) of the last steps, averaged over `OVER` of them; None before there are any."""
    recent = told[-OVER:]
    if not len(recent):
        return None
    from gambol.controllers.reconstruction import SKELETON

    def mean(column):
        known = column[np.isfinite(column)]
        return float(known.mean()) if len(known) else math.nan
    joints = recent[:, 2][recent[:, 2] >= 0].astype(int)
    # the joint that was the worst for most of the time
    joint = SKELETON.names[np.bincount(joints).argmax()] if len(joints) else ""
    return Errors(mean(recent[:, 0]), mean(recent[:, 1]), joint, mean(recent[:, 3]))


def follower_of(performer: Any, name: str, points: str, methods: Methods) -> Supervisor:
    """A controller that follows points on a body like a performer's, and walks where it has none.

    performer: the performer's controller. name, points: of one of the methods.
    """
    from gambol.controllers.reconstruction import SKELETON, Reconstruction

    method, controls = methods(name, points)
    someone = walker_of(performer)
    walker = someone.parts.get("locomotion", someone)
    height = STATURE * float(performer.skeleton.offsets[0, 1] / SKELETON.offsets[0, 1])
    controllers = {"locomotion": walker, "reconstruction": Reconstruction(
        method, controls, height, starts=methods.starts(name, points))}
    if isinstance(performer, Embodied):
        return Embodied(controllers, performer.body, performer.factor)
    return Supervisor(controllers)


def beginning(controller: Supervisor, performer: CharacterState, beside: np.ndarray) -> CharacterState:
    """The state of a follower that stands and moves as its performer does, `beside` (3,) [m] it."""
    def moved(pose: Pose) -> Pose:
        return Pose(np.asarray(pose.root, float) + beside, pose.rotations)
    x, _, z = beside
    state = CharacterState(performer.ground + [x, z, 0.0], performer.velocity, moved(performer.pose), performer.contacts,
                           None, float(performer.floor) + float(beside[1]),
                           None if performer.previous is None else moved(performer.previous), performer.elapsed)
    return controller.enter(state, Intent())
