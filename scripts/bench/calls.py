"""What each call costs that an importer makes: median and 95th percentile [ms] of processor time, everything compiled before.

    python scripts/bench/calls.py
"""

import time

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Goal, Intent, Leap
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import forecast, person, rehearse
from gambol.game.scene import Box


def main(times=60):
    """Print a row for each call."""
    somebody, walker = person(), Locomotion.load()
    rehearse(somebody)
    crowd, walks = walker.start(np.zeros((100, 3))), Intent(np.array([1.2, 0.2, 0.0]))
    beside = Intent(walks.velocity, around=tuple(Box((x, 0.5, z), (1.0, 1.0, 1.0)) for x in range(4, 24, 4) for z in range(0, 40, 4)))
    jump, standing = somebody.parts["jump"], somebody.start()
    for _ in range(10):
        standing, _ = somebody.step(standing, Intent(), 1 / 60)
    states = {"person": somebody.start(), "beside": somebody.start(), "goal": somebody.start(), "crowd": crowd}
    goal = Intent(goal=Goal((0.0, 8.0)))

    def stepped(name, who, intent):
        states[name], pose = who.step(states[name], intent, 1 / 60)
        return pose
    place = iter(np.linspace(0.9, 1.2, 10 * times))
    calls = {
        "start": lambda: somebody.start(),
        "step, a person": lambda: stepped("person", somebody, walks),
        "step, a person among 50 boxes": lambda: stepped("beside", somebody, beside),
        "step, on the way to a goal": lambda: stepped("goal", somebody, goal),
        "step, a hundred walkers": lambda: stepped("crowd", walker, walks),
        "forward_kinematics": lambda: forward_kinematics(somebody.skeleton, standing.pose.root, standing.pose.rotations),
        "forecast, 1 s": lambda: forecast(somebody, standing, walks),
        "survey, an arc to draw": lambda: jump.survey(jump.start_of(standing), np.array([0.0, 0.0, next(place)]), 0.0),
        "refusal, whether a leap can be made": lambda: somebody.refusal(standing, Intent(leap=Leap((0.0, 0.0, next(place))))),
    }
    for name, call in calls.items():
        call()
        took = []
        for _ in range(times):
            begun = time.process_time()
            call()
            took.append(1e3 * (time.process_time() - begun))
        print(f"{name:40s} {np.median(took):7.2f} {np.percentile(took, 95):7.2f} ms", flush=True)


if __name__ == "__main__":
    main()
