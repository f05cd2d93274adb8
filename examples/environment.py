"""A Gymnasium environment: learn, or write by hand, what to ask of a body so that it reaches a goal.

What is learnt here is where to go, not how to walk: the action is a velocity, and Gambol finds the motion.

    python examples/environment.py --episodes 3

Needs Gymnasium: pip install gymnasium
"""

import argparse

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion

RATE, TICKS = 60, 6
"""Steps of the motion a second, and how many of them one action lasts."""
FASTEST = np.array([3.0, 2.0, 0.6])
"""What an action of 1 asks for: forward [m/s], turning [rad/s], to the left [m/s]."""
ARRIVED, FARTHEST = 0.4, 6.0
"""A goal is reached this near [m]; it lies at most this far from the start."""
LONGEST = 200
"""Actions of an episode at most."""
WIDE = 100.0
"""No figure of an observation is larger; nobody gets so far in an episode [m]."""


class Reach(gymnasium.Env):
    """Walk to a goal. An action is held for a tenth of a second.

    action: (3,) forward, turning, to the left, -1 … 1. observation: (5 + 3 J,): the goal, to the left and ahead [m]; the
    velocity; where the J joints are, in the character's own frame [m]. reward: metres nearer, and 1 for arriving.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": RATE // TICKS}

    def __init__(self, render_mode=None, size=(480, 360)):
        self.render_mode, self.size = render_mode, size
        self.walker = Locomotion.load()
        self.action_space = Box(-1.0, 1.0, (3,), np.float32)
        self.observation_space = Box(-WIDE, WIDE, (5 + 3 * len(self.walker.skeleton),), np.float32)
        self.stage = None

    def reset(self, *, seed=None, options=None):
        """Somebody at rest in the middle, and a goal somewhere."""
        super().reset(seed=seed)
        self.state = self.walker.start((0.0, 0.0, self.np_random.uniform(-np.pi, np.pi)))
        far, way = self.np_random.uniform(1.5, FARTHEST), self.np_random.uniform(-np.pi, np.pi)
        self.goal = far * np.array([np.sin(way), np.cos(way)])
        return self._seen(), {}

    def step(self, action):
        """A tenth of a second with one wish."""
        before = self._far()
        intent = Intent(np.clip(action, -1.0, 1.0) * FASTEST)
        for _ in range(TICKS):
            self.state, _ = self.walker.step(self.state, intent, 1 / RATE)
        arrived = self._far() < ARRIVED
        return self._seen(), before - self._far() + float(arrived), arrived, False, {"distance": self._far()}

    def render(self):
        """A picture (H, W, 3) from behind, drawn without a display."""
        if self.render_mode != "rgb_array":
            return None
        from gambol.game.hosts import Offscreen
        from gambol.game.scene import Camera, Figure, Goal, Scene

        if self.stage is None:
            self.stage = Offscreen(self.size, "fast")
        x, z, heading = self.state.ground
        camera = Camera(np.array([x - 3.5 * np.sin(heading), 2.0, z - 3.5 * np.cos(heading)]), np.array([x, 0.9, z]))
        goal = Goal((self.goal[0], 0.0, self.goal[1]), ARRIVED)
        return self.stage.frame(Scene(camera, (Figure(*self._joints()),), (goal,)))[..., :3].copy()

    def close(self):
        """Give the graphics card back."""
        if self.stage is not None:
            self.stage.release()
            self.stage = None

    def _joints(self):
        return forward_kinematics(self.walker.skeleton, self.state.pose.root, self.state.pose.rotations)

    def _far(self):
        return float(np.hypot(*(self.goal - self.state.ground[:2])))

    def _seen(self):
        x, z, heading = self.state.ground
        cosine, sine = np.cos(heading), np.sin(heading)

        def own(places):  # x, z in the world → to the left, ahead
            aside, along = places[..., 0] - x, places[..., 1] - z
            return np.stack([cosine * aside - sine * along, sine * aside + cosine * along], -1)
        joints = self._joints()[0]
        body = np.insert(own(joints[:, [0, 2]]), 1, joints[:, 1], axis=-1)
        return np.concatenate([own(self.goal), self.state.velocity, body.ravel()]).astype(np.float32)


gymnasium.register("gambol/Reach-v0", entry_point=Reach, max_episode_steps=LONGEST)


def by_hand(seen):
    """A policy of three lines: turn to the goal, and walk the faster the more it lies ahead."""
    bearing = np.arctan2(seen[0], seen[1])
    return np.array([max(np.cos(bearing), 0.0) * 0.5, np.clip(2.0 * bearing / FASTEST[1], -1.0, 1.0), 0.0], np.float32)


def main(episodes=3, seed=1):
    """Play some episodes with the policy written by hand; how long each took [s], and whether it arrived."""
    env, done = gymnasium.make("gambol/Reach-v0"), []
    for number in range(episodes):
        seen, _ = env.reset(seed=seed + number)
        total, actions, arrived, late = 0.0, 0, False, False
        while not (arrived or late):
            seen, reward, arrived, late, told = env.step(by_hand(seen))
            total, actions = total + reward, actions + 1
        done.append((actions * TICKS / RATE, arrived))
        print(f"episode {number + 1}: {'arrived' if arrived else 'gave up'} after {done[-1][0]:.1f} s, "
              f"{told['distance']:.2f} m off, reward {total:.2f}")
    env.close()
    return done


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--episodes", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    main(**vars(parser.parse_args()))
