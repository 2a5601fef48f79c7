"""PPO: advantages against their definition, what it learns, and that training goes on where it was stopped."""

import json
import os
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

try:
    import torch
except ImportError:
    torch = None

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import ppo  # noqa: E402


class Pointing:
    """Stands in for VectorEnvironment: the reward is largest where the action points to the goal; one step, four slots."""

    num_envs, action_space, single_observation_space = 4, mock.Mock(shape=(4, 3)), ("to_goal", "wrench")

    def __init__(self, *_, sign=1, **__):
        self.random, self.sign = np.random.default_rng(3), sign

    def reset(self, seed=None):
        self.goal = self.random.uniform(-0.03, 0.03, (4, 3))
        return self.seen(), {}

    def seen(self):
        return {"to_goal": self.goal.astype(np.float32), "wrench": np.zeros((4, 6), np.float32)}

    def step(self, actions):
        reward = -self.sign * ((actions - self.goal / 0.03) ** 2).sum(1)
        self.reset()
        over = np.ones(4, bool)
        return self.seen(), reward, over, ~over, {}


@unittest.skipIf(torch is None, "python3-torch is not installed")
class PpoTest(unittest.TestCase):
    def test_advantages_are_discounted_sums_of_temporal_differences(self):
        random = np.random.default_rng(1)
        reward, value = random.normal(size=(2, 5))
        ended, after = [False, False, True, False, False], 0.7
        kept = [(None, None, None, torch.tensor([v]), torch.tensor([r]), torch.tensor([e]))
                for r, v, e in zip(reward, value, ended)]
        found = [float(a) for a in ppo.advantages_of(kept, torch.tensor([after]))[0]]
        following = list(value[1:]) + [after]
        differences = [r + ppo.DISCOUNT * n * (not e) - v for r, v, n, e in zip(reward, value, following, ended)]
        factor = ppo.DISCOUNT * ppo.TRACE
        wanted = [differences[0] + factor * differences[1] + factor**2 * differences[2],
                  differences[1] + factor * differences[2], differences[2], differences[3] + factor * differences[4],
                  differences[4]]
        np.testing.assert_allclose(found, wanted, rtol=1e-6)

    def rewards(self, folder, sign, minutes):
        """Of the rounds of a short training."""
        file = os.path.join(folder, f"policy{sign}.npz")
        clock = iter(range(10**6))
        options = mock.Mock(policy=file, start=None, task=None, seed=1, slots=4, threads=1, breathing=None, minutes=minutes)
        with mock.patch.object(ppo, "VectorEnvironment", lambda *a, **k: Pointing(sign=sign)), \
                mock.patch.object(ppo.time, "monotonic", lambda: next(clock)), mock.patch.object(ppo.learn, "show"):
            ppo.train(options)  # a round takes a second of this clock
        with open(file[:-4] + ".jsonl", encoding="utf-8") as lines:
            return [json.loads(line) for line in lines]

    def test_it_learns_what_is_rewarded_and_goes_on(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch("builtins.print"):
            rows = self.rewards(folder, 1, 0.5)
            self.assertGreater(rows[-1]["reward"], 0.6 * rows[0]["reward"])  # negative
            wrong = self.rewards(folder, -1, 0.2)  # control: the opposite is rewarded
            self.assertGreater(wrong[-1]["reward"], wrong[0]["reward"])
            on = self.rewards(folder, 1, 0.6)
            self.assertEqual([row["round"] for row in on], list(range(1, len(on) + 1)))
            self.assertGreater(len(on), len(rows))
            self.assertGreater(on[len(rows)]["reward"], 0.8 * rows[0]["reward"])  # not from the beginning
            policy = ppo.learn.Cloned(os.path.join(folder, "policy1.npz"))
            self.assertEqual(policy.action({"to_goal": np.zeros(3), "wrench": np.zeros(6)}).shape, (3,))


if __name__ == "__main__":
    unittest.main()
