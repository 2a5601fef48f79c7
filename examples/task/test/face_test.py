"""The task keeps what every task keeps; turning to the place is rewarded and succeeds, keeping still does not."""

import os
import sys
import unittest

import numpy as np

from vibe.env import Environment, contract

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))


def turning(environment):
    """Shares of the joint speeds that turn the view to the place: least squares of the two rates across the view."""
    simulation = environment.simulation
    to_tip = simulation.tip_pose[:3, :3].T
    apart = to_tip @ (environment.task.current()["goal"][0] - simulation.tip_pose[:3, 3])
    rates = (to_tip @ (simulation.jacobian * environment.task.speeds)[3:])[1:]
    wanted = 4 * np.cross([1, 0, 0], apart / np.linalg.norm(apart))[1:]
    shares = rates.T @ np.linalg.solve(rates @ rates.T + 0.01 * np.eye(2), wanted)
    return shares / max(1.0, np.abs(shares).max())


def episode(environment, policy, seed):
    """Sum of the rewards, and whether it succeeded."""
    environment.reset(seed=seed)
    total, over, info = 0.0, False, {}
    while not over:
        _, reward, terminated, truncated, info = environment.step(policy(environment))
        total, over = total + reward, terminated or truncated
    return total, info["is_success"]


class FaceTest(unittest.TestCase):
    def test_it_keeps_what_every_task_keeps(self):
        self.assertEqual(contract.broken("face:Face"), [])

    def test_turning_to_the_place_succeeds_and_keeping_still_does_not(self):
        environment = Environment("face:Face", **contract.SETTINGS)
        for seed in range(3):
            total, success = episode(environment, turning, seed)
            self.assertTrue(success)
            self.assertGreater(total, 10)
            total, success = episode(environment, lambda _: np.zeros(4), seed)
            self.assertFalse(success)
            self.assertLess(total, 1)


if __name__ == "__main__":
    unittest.main()
