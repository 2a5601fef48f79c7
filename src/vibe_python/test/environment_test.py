#!/usr/bin/env python3
"""Environments: the same bits alone and side by side, resets as Gymnasium defines them, experts, and what is refused."""
import os
import tempfile
import unittest

import numpy as np

import vibe
from vibe.env import TASKS, Environment, Expert, VectorEnvironment, api, demonstrations, organs

SMALL = {"particles": 300, "organs": [("sthenic", 1.0)]}


def equal(a, b):
    return set(a) == set(b) and all(np.array_equal(a[name], b[name]) for name in a)


def row(parts, slot):
    return {name: value[slot] for name, value in parts.items()}


class EnvironmentTest(unittest.TestCase):
    def actions(self, environment, seed, count):
        random = np.random.default_rng(seed)
        return random.uniform(-1, 1, (count,) + environment.action_space.shape).astype(np.float32)

    def test_spaces_hold_what_comes(self):
        for name in TASKS:
            environment = Environment(name, camera=(16, 12, 1.7), **SMALL)
            seen, _ = environment.reset(seed=3)
            for action in [None] + list(self.actions(environment, 1, 4)):
                if action is not None:
                    self.assertTrue(environment.action_space.contains(action))
                    seen, reward, terminated, truncated, info = environment.step(action)
                    self.assertTrue(np.isfinite(reward))
                    self.assertEqual((type(terminated), type(truncated)), (bool, bool))
                self.assertTrue(environment.observation_space.contains(seen), name)
            self.assertIn("is_success", info)
            environment.close()

    def test_same_seed_same_episode_in_any_batch(self):
        alone = []
        for seed in (5, 6, 7):
            environment = Environment("Reach", **SMALL)
            seen = [environment.reset(seed=seed)[0]]
            rewards = []
            for action in self.actions(environment, seed, 15):
                now, reward, over, *_ = environment.step(action)
                self.assertFalse(over)
                seen.append(now)
                rewards.append(reward)
            alone.append((seen, rewards))
            environment.close()
        self.assertFalse(equal(alone[0][0][0], alone[1][0][0]))  # control: another seed is another episode
        for threads in (1, 2):
            organs.organ(*SMALL["organs"][0], SMALL["particles"]).goals.clear()  # as in another process
            together = VectorEnvironment("Reach", 3, threads=threads, **SMALL)
            seen, _ = together.reset(seed=5)
            actions = np.stack([self.actions(environment, seed, 15) for seed in (5, 6, 7)], 1)
            for k in range(16):
                for slot in range(3):
                    self.assertTrue(equal(row(seen, slot), alone[slot][0][k]), (threads, k, slot))
                if k < 15:
                    seen, rewards, *_ = together.step(actions[k])
                    self.assertEqual(list(rewards), [alone[slot][1][k] for slot in range(3)])
            together.close()

    def test_autoreset(self):
        class Short(TASKS["Reach"]):
            seconds = 0.1

        for mode in ("next_step", "same_step"):
            environment = VectorEnvironment(Short, 2, threads=1, autoreset=mode, **SMALL)
            environment.reset(seed=1)
            still = np.zeros((2, 4), np.float32)
            _, _, _, truncated, _ = environment.step(still)
            self.assertFalse(truncated.any())
            seen, _, _, truncated, info = environment.step(still)
            self.assertTrue(truncated.all())
            if mode == "same_step":
                self.assertFalse(equal(row(seen, 0), info["final_obs"][0]))
                self.assertEqual(list(info["_final_obs"]), [True, True])
            else:
                following, reward, _, truncated, info = environment.step(still + 1)
                self.assertFalse(truncated.any())
                self.assertEqual(list(reward), [0, 0])
                self.assertEqual(list(info["time"]), [0, 0])
            environment.close()

    def test_experts_reach(self):
        for mode in ("joints", "tip"):
            environment = Environment("Reach", action=mode, **SMALL)
            expert = Expert(environment)
            self.assertEqual([demonstrations.episode(environment, expert, seed)[1] for seed in range(3)], [True] * 3)
            still = type("Still", (), {"reset": lambda s: None, "action": lambda s, o: 0 * environment.action_space.high})
            self.assertFalse(demonstrations.episode(environment, still(), 0)[1])  # control

    def test_trainees_mark(self):
        environment = Environment("Mark", **SMALL)
        self.assertTrue(demonstrations.episode(environment, Expert(environment), 1)[1])

    def test_demonstrations_are_laid_out_as_robomimic_reads_them(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("python3-h5py is not installed")
        environment = Environment("Reach", **SMALL)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "reach.hdf5")
            self.assertEqual(demonstrations.record(environment, Expert(environment), file, 2), (2, 2))
            with h5py.File(file) as found:
                demo = found["data/demo_1"]
                steps = demo.attrs["num_samples"]
                self.assertEqual(demo["actions"].shape, (steps, 4))
                self.assertEqual(demo["dones"][-1], 1)
                np.testing.assert_array_equal(demo["obs/tip"][1:], demo["next_obs/tip"][:-1])
                self.assertEqual(found["data"].attrs["total"], sum(d.attrs["num_samples"] for d in found["data"].values()))

    def test_refusals(self):
        environment = Environment("Reach", **SMALL)
        still = np.zeros(4)
        for sentence, call in (("call reset", lambda: environment.step(still)),
                               ("no task 'Fly'", lambda: Environment("Fly")),
                               ("'action' is 'force'", lambda: Environment("Reach", action="force")),
                               ("'organs' is empty", lambda: Environment("Reach", organs=[]))):
            with self.assertRaisesRegex(vibe.Error, sentence):
                call()
        environment.reset(seed=1)
        for sentence, action in ((r"shape \(1, 3\)", np.zeros(3)), ("not finite", still + np.nan)):
            with self.assertRaisesRegex(vibe.Error, sentence):
                environment.step(action)
        environment.close()
        for call in (lambda: environment.step(still), environment.reset):
            with self.assertRaisesRegex(vibe.Error, "is closed"):
                call()

    def test_the_checker_of_gymnasium(self):
        if not api.REAL:
            self.skipTest("gymnasium is not installed")
        from gymnasium.utils.env_checker import check_env

        for name in TASKS:
            check_env(Environment(name, **SMALL), skip_render_check=True)


if __name__ == "__main__":
    unittest.main()
