"""Your own controller: somebody who waves when asked to, and walks on afterwards.

A controller answers four questions: how well it could act now (`precondition`), how it takes over (`enter`), what
comes next (`step`), and whether it goes on (`status`). The supervisor asks all of them and lets the best one act.

    python examples/own_controller.py -o wave.mp4
"""

import argparse
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import Pose, exp, human, log, settle
from gambol.controllers.contract import CharacterState, Controller, Intent, Status
from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor

RATE = 60
HALFLIFE = 0.12
"""How fast what the body did before fades [s]."""
SLOW = 0.15
"""Who moves faster than this [m/s] has no hand to spare."""


@dataclass(frozen=True, eq=False)
class Asked(Intent):
    """An intent that can also ask for a wave."""

    wave: bool = False


@dataclass(frozen=True, eq=False)
class Memory:
    """What the controller remembers. time: [s] since it began. held: the pose that it took over. wanted: whether somebody
    still wants it. offset, rate: (J, 3) how far the body is from where it should be, as rotation vectors, and how that changes."""

    time: float
    held: Pose
    wanted: bool
    offset: np.ndarray
    rate: np.ndarray


class Wave(Controller):
    """Lifts the right arm and waves, for as long as it is asked for; everything else stays as it was."""

    skeleton = human()

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """Better than walking (0.5), for one who stands still and is asked to."""
        still = np.hypot(state.velocity[0], state.velocity[2]) < SLOW and not np.any(intent.velocity)
        return 0.8 if still and intent.leap is None and getattr(intent, "wave", False) else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """Take pose and motion over as they are: how far they are from ours is an offset that will fade."""
        now = np.asarray(state.pose.rotations, float)
        rate = np.zeros((len(now), 3))
        if state.previous is not None and state.elapsed > 0.0:
            rate = log(np.swapaxes(state.previous.rotations, -1, -2) @ now) / state.elapsed
        offset = log(np.swapaxes(self.goal(now, 0.0), -1, -2) @ now)
        return replace(state, memory=Memory(0.0, state.pose, True, offset, rate), velocity=np.zeros(3))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """The goal of this moment, and what is left of the offset on top."""
        before = state.memory
        offset, rate = settle(before.offset, before.rate, HALFLIFE, dt)
        after = replace(before, time=before.time + dt, offset=offset, rate=rate, wanted=self.precondition(state, intent) > 0.0)
        pose = Pose(before.held.root, self.goal(np.asarray(before.held.rotations, float), after.time) @ exp(offset))
        return replace(state, pose=pose, memory=after), pose

    def status(self, state: CharacterState) -> Status:
        """Done as soon as nobody wants it any more: walking then takes the arm down."""
        return Status("running" if state.memory.wanted else "done")

    def goal(self, held: np.ndarray, time: float) -> np.ndarray:
        """Local rotations (J, 3, 3): those it took over, but for an arm that is up and a hand that waves."""
        at, made = self.skeleton.index, held.copy()
        swing = 0.4 * np.sin(2 * np.pi * 1.6 * time)
        made[at("RightArm")] = exp(np.array([0.0, 0.0, 0.1]))                       # out to the side, a little down
        made[at("RightForeArm")] = exp(np.array([0.0, 0.0, swing - 1.9])) @ exp(np.array([-1.4, 0.0, 0.0]))   # up, palm ahead
        made[at("RightHand")] = exp(np.array([0.0, 0.6 * swing, 0.0]))
        return made


def waving_person() -> Supervisor:
    """A person who can wave, too."""
    return Supervisor({**person().parts, "wave": Wave()})


def wishes(seconds):
    """An intent for every step: walk, stand, wave, and walk on."""
    for tick in range(round(seconds * RATE)):
        part = tick / (seconds * RATE)
        walks = part < 0.25 or part > 0.8
        yield Asked(np.array([1.0 if walks else 0.0, 0.0, 0.0]), wave=0.45 < part < 0.8)


def main(seconds=8.0, out=None):
    """Play it, and film it into `out`; who was on duty, step by step, and the poses."""
    somebody = waving_person()
    state, duty, poses = somebody.start(), [], []
    for intent in wishes(seconds):
        state, pose = somebody.step(state, intent, 1 / RATE)
        if not duty or duty[-1] != state.active:
            print(f"{len(duty) / RATE:4.1f} s  {state.active}: {state.memory.why}")
        duty.append(state.active)
        poses.append(pose)
    if out:
        film(poses, somebody.skeleton, out)
    return duty, poses


def film(poses, skeleton, out, size=(640, 480)):
    """Draw poses into a film, without a display."""
    from gambol.controllers.body import forward_kinematics
    from gambol.game.hosts import Offscreen
    from gambol.game.output import recorder
    from gambol.game.scene import Camera, Figure, Scene

    with Offscreen(size, "fast") as stage, recorder(out, size, RATE) as target:
        for pose in poses:
            middle = np.array([pose.root[0], 1.0, pose.root[2]])
            camera = Camera(middle + [-1.2, 0.3, 3.0], middle)
            target.write(stage.frame(Scene(camera, (Figure(*forward_kinematics(skeleton, pose.root, pose.rotations)),))))
    print(f"{out}: {len(poses)} frames")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("-o", "--out", help="a .mp4 file")
    main(**vars(parser.parse_args()))
