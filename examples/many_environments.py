"""A thousand Gymnasium environments at once: one call steps all bodies, and those whose episode is over begin anew.

    python examples/many_environments.py --count 1000

Needs Gymnasium: pip install gymnasium
"""

import argparse
import time

import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion

RATE, TICKS = 60, 6
"""Steps of the motion a second, and how many of them one action lasts."""
FASTEST = np.array([3.0, 2.0, 0.6])
"""What an action of 1 asks for: forward [m/s], turning [rad/s], to the left [m/s]."""
ARRIVED, FARTHEST, LONGEST = 0.4, 6.0, 200
"""A goal is reached this near [m], lies at most this far, and is given up after so many actions."""


class ReachMany(VectorEnv):
    """So many bodies, each on its way to a goal of its own.

    actions: (N, 3) forward, turning, to the left, -1 … 1. observations: (N, 5): the goal, to the left and ahead [m]; the velocity.
    rewards: (N,) metres nearer, and 1 for arriving. Whoever is done begins anew in the next step, whose action he does not hear.
    """

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}

    def __init__(self, count):
        self.num_envs, self.walker = count, Locomotion.load()
        self.single_action_space, self.single_observation_space = Box(-1.0, 1.0, (3,), np.float32), Box(-100.0, 100.0, (5,), np.float32)
        self.action_space, self.observation_space = (batch_space(one, count) for one in (self.single_action_space, self.single_observation_space))

    def reset(self, *, seed=None, options=None):
        """All of them at rest, each with a goal somewhere."""
        super().reset(seed=seed)
        self.state, self.goals = self._begun(self.num_envs)
        self.ages, self.over = np.zeros(self.num_envs, int), np.zeros(self.num_envs, bool)
        return self._seen(), {}

    def step(self, actions):
        """A tenth of a second of everybody."""
        before, anew = self._far(), self.over
        wishes = np.clip(actions, -1.0, 1.0) * FASTEST * ~anew[:, None]
        for _ in range(TICKS):
            self.state, _ = self.walker.step(self.state, Intent(wishes), 1 / RATE)
        if anew.any():
            fresh, self.goals[anew] = self._begun(anew.sum())
            self.state = self.state.put(anew, fresh)
        self.ages = np.where(anew, 0, self.ages + 1)
        arrived = (self._far() < ARRIVED) & ~anew
        late = (self.ages >= LONGEST) & ~arrived
        self.over = arrived | late
        return self._seen(), np.where(anew, 0.0, before - self._far() + arrived), arrived, late, {}

    def _begun(self, count):
        """States of so many who stand in the middle, and their goals (count, 2) x, z [m]."""
        headings, ways = self.np_random.uniform(-np.pi, np.pi, (2, count))
        far = self.np_random.uniform(1.5, FARTHEST, count)
        zero = np.zeros(count)
        return self.walker.start(np.stack([zero, zero, headings], -1)), far[:, None] * np.stack([np.sin(ways), np.cos(ways)], -1)

    def _far(self):
        return np.linalg.norm(self.goals - self.state.ground[:, :2], axis=-1)

    def _seen(self):
        (aside, along), heading = (self.goals - self.state.ground[:, :2]).T, self.state.ground[:, 2]
        cosine, sine = np.cos(heading), np.sin(heading)
        return np.column_stack([cosine * aside - sine * along, sine * aside + cosine * along, self.state.velocity]).astype(np.float32)


def by_hand(seen):
    """Actions (N, 3) of a policy of three lines: turn to the goal, and walk the faster the more it lies ahead."""
    bearing = np.arctan2(seen[:, 0], seen[:, 1])
    return np.stack([np.maximum(np.cos(bearing), 0.0) * 0.5, np.clip(2.0 * bearing / FASTEST[1], -1.0, 1.0), np.zeros(len(seen))], -1)


def main(count=1000, actions=100, seed=1):
    """Play so many actions with the policy written by hand; episodes that ended, and how many of them arrived."""
    env = ReachMany(count)
    seen, _ = env.reset(seed=seed)
    ended, reached, begun = 0, 0, time.perf_counter()
    for _ in range(actions):
        seen, _, arrived, late, _ = env.step(by_hand(seen))
        ended, reached = ended + int((arrived | late).sum()), reached + int(arrived.sum())
    took = time.perf_counter() - begun
    print(f"{count} at once: {ended} episodes, {reached} arrived; {count * actions / took:.0f} actions a second")
    return ended, reached


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--actions", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    main(**vars(parser.parse_args()))
