"""The policy that is cloned: its gradients, and what it learns; the episodes of an evaluation are kept."""

import glob
import json
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import learn  # noqa: E402

OWN = """
from vibe.env import Reach
from vibe.env.expert import Reaching
LIMIT = 1e-4
class Slow(Reaching):
    gain = 1
class Own(Reach):
    "To the goal."
    name = "Own"
    tolerance = LIMIT
    def judge(self, before, after):
        judged = super().judge(before, after)
        return judged
    def expert(self, seed):
        return Slow()
"""


class Cloning(unittest.TestCase):
    def test_gradients_are_slopes(self):
        random = np.random.default_rng(1)
        parts = [np.zeros(3), np.ones(3)] + [random.normal(size=size) for size in ((3, 5), 5, (5, 4), 4, (4, 2), 2)]
        rows, wanted = random.normal(size=(7, 3)), random.normal(size=(7, 2))

        def loss():
            return 0.5 * ((learn.forward(parts, rows)[-1] - wanted) ** 2).sum() / len(rows)

        values = learn.forward(parts, rows)
        for part, slope in zip(parts[2:], learn.gradients(parts, values, values[-1] - wanted)):
            at = tuple(0 for _ in part.shape)
            before = loss()
            part[at] += 1e-6
            self.assertAlmostEqual((loss() - before) / 1e-6, slope[at], delta=1e-4)
            part[at] -= 1e-6

    def test_learns_a_function_and_not_from_wrong_pairs(self):
        random = np.random.default_rng(2)
        rows = random.uniform(-1, 1, (2000, 2))
        wanted = np.stack([rows[:, 0] * rows[:, 1], rows[:, 0] ** 2], axis=1)
        error = []
        for taught in (wanted, random.permutation(wanted)):
            parts = learn.fit(rows[:1500], taught[:1500], epochs=15, batch=32, rate=5e-3)
            error.append(np.sqrt(np.mean((learn.forward(parts, rows[1500:])[-1] - wanted[1500:]) ** 2)))
        self.assertLess(error[0], 0.05)
        self.assertGreater(error[1], 0.2)


class Evaluation(unittest.TestCase):
    def test_the_interval_contains_the_share(self):
        rows = [{"is_success": k < 9, "time": 1.0, "max_force": 2.0} for k in range(10)]
        self.assertEqual(learn.table_row("x", rows), "| x | 90 % | 60 to 98 % | 1.0 | 2.0 |")

    def test_episodes_that_are_known_are_not_run_again(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "episodes.jsonl")
            with open(file, "w") as out:
                for seed in range(3):
                    out.write(json.dumps({"policy": "random", "conditions": "Reach, as here", "seed": seed, "is_success": False,
                                          "time": 10.0, "max_force": 1.0}) + "\n")
                out.write('{"policy": "random", "cond')  # of a run that was killed
            options = ["learn.py", "evaluate", "random", "--episodes", file, "--seeds"]
            with mock.patch.object(learn, "episode", None), mock.patch.object(learn, "conditions") as conditions:
                for words, seeds in (("Reach, as here", "3"), ("Reach, as here", "4"), ("Reach, of another version", "3")):
                    conditions.return_value = words
                    with mock.patch.object(sys, "argv", [*options, seeds]):
                        if words == "Reach, as here" and seeds == "3":
                            learn.main()
                            continue
                        with self.assertRaises(TypeError):  # an episode, which cannot be called
                            learn.main()

    def test_the_version_of_the_simulator_is_part_of_what_is_kept(self):
        options = mock.Mock(breathing=None)
        with mock.patch.object(learn, "HELD_OUT", [("sthenic", 1.0)]):
            first = learn.conditions(options, "Reach")
            self.assertEqual(first, learn.conditions(options, "Reach"))
            with mock.patch.object(learn, "STEP_PERIOD", 1 / 20):
                self.assertNotEqual(first.rsplit(" ", 1)[1], learn.conditions(options, "Reach").rsplit(" ", 1)[1])

    def test_a_task_that_has_changed_has_other_episodes(self):
        """Each change is of one place of its module; the last one ends episodes with their first action."""
        changes = (("", ""), ("tolerance = LIMIT", "tolerance = 0.02"), ("LIMIT = 1e-4", "LIMIT = 0.02"), ("gain = 1", "gain = 2"),
                   ("return judged", "return judged[0], judged[1] | True"), ("tolerance = LIMIT", "seconds = 0.05"))
        with tempfile.TemporaryDirectory() as folder:
            words = [self.said_of(folder, OWN.replace(*change)) for change in changes]
            self.assertEqual(words[0], self.said_of(folder, OWN))  # control
        for said in zip(*words):
            self.assertEqual(len(set(said)), len(changes))

    @staticmethod
    def said_of(folder, source):
        """What conditions() and policy_of() say in a process of its own, which imports a module `own` of this source."""
        with open(os.path.join(folder, "own.py"), "w", encoding="utf-8") as out:
            out.write(source)
        asked = ("import types, learn; learn.HELD_OUT = [('sthenic', 1.0)]; learn.SETTINGS = {'own:Own': {'particles': 300}}\n"
                 "print(learn.conditions(types.SimpleNamespace(breathing=None), 'own:Own')); print(learn.policy_of('expert', 'own:Own')[2])")
        path = os.pathsep.join([folder, os.path.dirname(learn.__file__), os.environ.get("PYTHONPATH", "")])
        return subprocess.run([sys.executable, "-B", "-c", asked], env={**os.environ, "PYTHONPATH": path}, check=True, text=True,
                              stdout=subprocess.PIPE).stdout.splitlines()

    def test_numbers_of_a_task_count_wherever_they_come_from(self):
        task = learn.Environment("Reach", particles=300).task
        first = learn.digest_of(task)
        with mock.patch.object(type(task), "tolerance", 0.5 * task.tolerance):
            self.assertNotEqual(learn.digest_of(task), first)
        self.assertEqual(learn.digest_of(task), first)

    def test_a_policy_knows_its_task_and_what_it_sees(self):
        random = np.random.default_rng(3)
        seen = {"seen": random.normal(size=1), "wrench": random.normal(size=6), "depth": random.normal(size=(2, 3))}
        inputs = learn.inputs_of("Inspect", seen)
        self.assertEqual(inputs, ["wrench", "depth", "seen"])
        parts = [np.zeros(13), learn.least_of(seen, inputs), random.normal(size=(13, 4)), np.zeros(4)]
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "policy.npz")
            learn.store(file, "Inspect", inputs, parts)
            policy, task, _ = learn.policy_of(file, None)
            self.assertEqual((task, policy.inputs), ("Inspect", inputs))
            row = np.concatenate([seen["wrench"] / ([1.0] * 3 + [0.05] * 3), seen["depth"].ravel() / 0.02, seen["seen"] / 0.1])
            np.testing.assert_allclose(policy.action(seen), np.clip(row @ parts[2], -1, 1), rtol=1e-5)
            with self.assertRaisesRegex(learn.Error, "is a policy of Inspect"):
                learn.policy_of(file, "Reach")

    def test_a_button_that_is_rarely_pressed_is_learnt(self):
        """One that is pressed only where an input is above 2, in 1 of 250 rows beside it; without balance it stays up."""
        rows = np.random.default_rng(3).uniform(0, 2.008, (5000, 1))
        wanted = np.column_stack([0.1 * rows[:, 0], np.where(rows[:, 0] > 2, 1.0, -1.0)])
        some = learn.balanced(wanted)
        self.assertEqual(set(some), set(range(5000)), "every row stays")
        self.assertAlmostEqual(np.mean(wanted[some, 1] > 0), 0.2, delta=0.05)
        where = [[1.0], [2.006]]
        pressed = [learn.forward(learn.fit(rows[of], wanted[of], 10), np.array(where))[-1][:, 1] > 0 for of in (some, slice(None))]
        self.assertEqual([list(one) for one in pressed], [[False, True], [False, False]])
        self.assertEqual(list(learn.balanced(wanted[:, :1])), list(range(5000)), "no buttons")

    def test_the_policies_that_come_with_it_fit_their_tasks(self):
        files = sorted(glob.glob(os.path.join(os.path.dirname(learn.__file__), "policies", "*.npz")))
        self.assertEqual(len(files), 4)
        for file in files:
            policy = learn.Cloned(file)
            space = learn.Environment(policy.task, particles=300, organs=[("sthenic", 1.0)], **learn.SETTINGS.get(policy.task, {}))
            sizes = [np.prod(space.observation_space[name].shape) for name in policy.inputs]
            self.assertEqual((sum(sizes), space.action_space.shape[0]), (len(policy.parts[0]), len(policy.parts[-1])), file)

    def test_what_cannot_be_read_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "policy.npz")
            with open(file, "w", encoding="utf-8") as out:
                out.write("no policy")
            for name in (file, os.path.join(folder, "none.npz")):
                with self.assertRaisesRegex(SystemExit, "cannot be read as a policy"), \
                        mock.patch.object(sys, "argv", ["learn.py", "evaluate", name, "--episodes", os.path.join(folder, "e")]):
                    learn.main()

    def test_workers_find_what_is_found_here(self):
        try:
            from distributed import LocalCluster
            from vibe_sessions import cohort_dask  # noqa: F401
        except ImportError:
            self.skipTest("python3-distributed or vibe_sessions is not installed")
        with LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as cluster, \
                mock.patch.object(learn, "episode", lambda *asked: {"seen": asked}):
            found = dict(learn.on_workers(cluster.scheduler_address, "random", "Bite", "slight", [3, 5]))
        self.assertEqual(found, {seed: {"seen": ("random", "Bite", "slight", seed)} for seed in (3, 5)})


if __name__ == "__main__":
    unittest.main()
