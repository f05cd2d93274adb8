"""Watching somebody: virtual cameras whose silhouettes of a performer, good or spoilt, are all that a tracker is told.

Cameras may stand, or go along with whom they watch. What they see follows from the performer's pose and the number of the step, so
that it is the same whenever it is asked for.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from gambol.controllers.body import Skeleton
from gambol.controllers.contract import Sighting
from gambol.controllers.supervisor import Supervisor

from .embodied import Embodied
from .performers import walker_of

if TYPE_CHECKING:  # what tracks is loaded by the functions that need it: a game without cameras starts without
    from gambol.controllers.tracking import Tracking, Watching
    from gambol.controllers.tracking.cameras import Lens
    from gambol.controllers.tracking.silhouettes import Surface

AWAY, HIGH, VIEW = 4.0, 1.3, 0.56
"""How far cameras of a rig are from whom they watch, how high [m], and what they see [rad]."""
CARRIAGE = 100.0
"""How firmly a tracker of poor silhouettes draws arms to how people carry them [1/rad²]."""
MAJORITY = 5
"""A pixel is what most of so many by so many are, where pixels are wrong: so much a segmentation makes good."""


@dataclass(frozen=True, eq=False)
class Watches:
    """How a character is tracked. performer: whom cameras see, by name. lenses: the cameras, round the world's origin.

    surface: what is seen of the performer. every: steps of the world between two frames. along: they go along with the
    performer. beside: (3,) [m] from the performer to the tracked body. wrong: share of pixels that are wrong; rectangles: full
    or empty, in every frame; corrupted: share of frames that show something else. seed: of all that.
    """

    performer: str
    lenses: tuple[Lens, ...]
    surface: Surface
    every: int = 2
    along: bool = True
    beside: np.ndarray = field(default_factory=lambda: np.zeros(3))
    wrong: float = 0.0
    rectangles: int = 0
    corrupted: float = 0.0
    seed: int = 0

    def due(self, number: int) -> bool:
        """Whether the cameras take a frame at a step of the world."""
        return number % self.every == 0

    def place(self, positions: np.ndarray) -> np.ndarray:
        """Where the cameras' middle is (3,) [m] for a performer's joints (J, 3)."""
        return np.array([positions[0, 0], 0.0, positions[0, 2]]) if self.along else np.zeros(3)

    def sighting(self, positions: np.ndarray, orientations: np.ndarray, number: int) -> Sighting:
        """What they see of a performer's joints (J, 3) [m], (J, 3, 3) at a step of the world: masks."""
        from gambol.controllers.tracking.silhouettes import rendered, skinned

        place = self.place(positions)
        vertices = skinned(self.surface, np.ascontiguousarray(positions - place), np.ascontiguousarray(orientations, float))
        masks = [rendered(lens, vertices, self.surface.triangles).mask for lens in self.lenses]
        rng = np.random.default_rng((self.seed, number // self.every))
        if rng.random() < self.corrupted:
            masks = [np.roll(mask[:, ::-1], rng.integers(-mask.shape[1] // 8, mask.shape[1] // 8 + 1, 2), (0, 1)) for mask in masks]
        return Sighting([self._spoilt(mask, rng) for mask in masks], place)

    def _spoilt(self, mask: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        if not self.wrong and not self.rectangles:
            return mask
        out, (height, width) = mask.copy(), mask.shape
        for _ in range(self.rectangles):
            w, h = rng.integers(max(width // 40, 1), max(width // 8, 2), 2)
            x, y = rng.integers(0, width), rng.integers(0, height)
            out[y:y + h, x:x + w] = rng.random() < 0.5
        if self.wrong:
            from scipy.ndimage import uniform_filter

            out ^= rng.random(out.shape, np.float32) < self.wrong
            return uniform_filter(out.astype(np.float32), MAJORITY) > 0.5
        return out


@lru_cache
def rig(count: int = 4, width: int = 320) -> tuple[Lens, ...]:
    """So many cameras in a circle about the origin, with pictures so wide."""
    from gambol.controllers.tracking.cameras import ring

    return ring(count, AWAY, HIGH, (0.0, 0.95, 0.0), (width, width * 3 // 4), VIEW)


def watches_of(performer: str, skeleton: Skeleton, cameras: int = 4, width: int = 320, **more) -> Watches:
    """Cameras in a circle round a performer in the mannequin. more: as `Watches` has it."""
    from ..meshes import surface_of

    return Watches(performer, rig(cameras, width), surface_of(skeleton, "full"), **more)


def tracked_of(performer: Any, watches: Watches, rate: float, penalty: bool = True) -> Supervisor:
    """A controller that tracks whom cameras see, on a coarser mesh than they see, and walks where they see nobody.

    performer: the performer's controller. rate: of the world [1/s]. penalty: on jitter.
    """
    from gambol.controllers.tracking import Tracker, TrackerSettings, Tracking

    from ..meshes import surface_of

    surface = surface_of(watches.surface.chain.skeleton, "full", level="middle")
    someone = walker_of(performer)
    tracker = Tracker(surface, watches.lenses, rate / watches.every, TrackerSettings(penalty=penalty, carriage=CARRIAGE, restarts=True))
    controllers = {"locomotion": someone.parts.get("locomotion", someone), "tracking": Tracking(tracker, watches.beside)}
    return Embodied(controllers, performer.body, performer.factor) if isinstance(performer, Embodied) else Supervisor(controllers)


def tracker_ready() -> None:
    """Compile all that tracking takes, and load it: two frames of the mannequin at rest."""
    from gambol.controllers.body import human
    from gambol.controllers.tracking import Tracker
    from gambol.controllers.tracking.twists import posed

    from ..meshes import surface_of

    watches = watches_of("", human())
    tracker = Tracker(surface_of(human(), "full", level="middle"), watches.lenses)
    pose = tracker.surface.chain.rest()
    state = tracker.start(pose)
    for number in range(2):
        state = tracker.step(state, watches.sighting(*posed(tracker.surface.chain, pose)[:2], number).pictures)


def tracking_of(tracked: Any) -> tuple[Tracking, Watching | None]:
    """The part of a tracked character's controller that tracks, and what it remembers while it is on duty."""
    from gambol.controllers.tracking import Watching

    memory = tracked.state.memory.memory
    return tracked.controller.parts["tracking"], memory if isinstance(memory, Watching) else None


def switched(controller: Any) -> Any:
    """The controller of a tracked character with its penalty on jitter off, or on again."""
    tracking, other = controller.parts["tracking"], copy(controller)
    other.parts = {**controller.parts, "tracking": tracking.tuned(replace(tracking.settings, penalty=not tracking.settings.penalty))}
    return other


def tracked_vertices(tracking: Tracking, watching: Watching, place: np.ndarray) -> np.ndarray:
    """Where the model's vertices (V, 3) [m] are in the cameras' own frame, for cameras that are `place` (3,) away."""
    from gambol.controllers.tracking.silhouettes import skinned
    from gambol.controllers.tracking.twists import posed

    surface = tracking.tracker.surface
    positions, orientations, _ = posed(surface.chain, watching.track.now)
    return skinned(surface, positions - place, orientations)
