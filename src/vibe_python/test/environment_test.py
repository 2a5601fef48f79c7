#!/usr/bin/env python3
"""Environments: the same bits alone and side by side, resets as Gymnasium defines them, experts, and what is refused."""
import copy
import importlib.util
import inspect
import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

import vibe
import vibe.env
from vibe.env import BREATHING, TASKS, Environment, Expert, GoalEnvironment, Reach, Task, VectorEnvironment, api, contract, demonstrations
from vibe.env.settings import Settings
from vibe.env.tip import tip_motion

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../scripts"))
import random_actions  # noqa: E402
import rough_use  # noqa: E402

CHECK = """
import numpy as np
import gymnasium
from gymnasium.wrappers.vector import RecordEpisodeStatistics
from vibe.env import TASKS, Environment, Reach, VectorEnvironment, api, contract
assert api.REAL and api.gymnasium is gymnasium and issubclass(Environment, gymnasium.Env)
small = contract.SETTINGS
for name in list(TASKS):
    made = gymnasium.make(f"vibe/{name}-v0", disable_env_checker=True, **small).unwrapped
    print(made.task.name, *contract.broken(name, breathing="slight"))

class Astray(Reach):  # control
    def observe(self):
        return {**super().observe(), "tip": np.zeros((self.count, 2), np.float32)}

print("refused" if any("checker of Gymnasium" in sentence for sentence in contract.broken(Astray)) else "accepted")
wrapped = RecordEpisodeStatistics(VectorEnvironment("Reach", 2, threads=1, **small))
wrapped.reset(seed=1)
for _ in range(201):
    *_, info = wrapped.step(np.zeros((2, 4), np.float32))
    if "episode" in info and info["episode"]["l"].max() == 200:
        print("wrapped")
processes = gymnasium.vector.AsyncVectorEnv([lambda: Environment(**small)] * 2, context="spawn")
(seen, _), (expected, _) = processes.reset(seed=1), VectorEnvironment("Reach", 2, threads=1, **small).reset(seed=1)
print("processes" if all(np.array_equal(seen[name], expected[name]) for name in expected) else "differ")
processes.close()

if api.AutoresetMode is None:  # before 1.1
    modes = {"next_step": {}}
else:
    modes = {name: {"autoreset_mode": api.AutoresetMode[name.upper()]} for name in ("next_step", "same_step", "disabled")}

class Short(Reach):
    seconds = 0.15
    def measures(self, slot):
        return {**super().measures(slot), "place": np.array(self.place[slot])}

def alike(a, b):
    if isinstance(a, dict):
        return set(a) == set(b) and all(alike(a[name], b[name]) for name in a)
    if isinstance(a, tuple) or getattr(a, "dtype", None) == object:
        return type(a) is type(b) and all(alike(x, y) for x, y in zip(a, b))
    return np.array_equal(a, b) and getattr(a, "dtype", None) == getattr(b, "dtype", None)

for mode, setting in modes.items():  # as Gymnasium has several environments side by side
    theirs = gymnasium.vector.SyncVectorEnv([lambda: Environment(Short, **small)] * 2, **setting)
    ours = VectorEnvironment(Short, num_envs=2, threads=1, autoreset=mode, **small)
    first = theirs.reset(seed=3)
    same = alike(first, ours.reset(seed=3))
    for k in range(7):
        actions = np.random.default_rng(k).uniform(-1, 1, (2, 4)).astype(np.float32)
        one, other = theirs.step(actions), ours.step(actions)
        same = same and alike(one, other)
        if mode == "disabled" and (other[2] | other[3]).any():
            options = {"reset_mask": other[2] | other[3]}
            same = same and alike(theirs.reset(options=dict(options)), ours.reset(options=options))
    if not same or alike(one[0], first[0]):
        print("unlike in", mode)
    ours.close()
listed = gymnasium.wrappers.vector.DictInfoToList(VectorEnvironment(Short, 2, threads=1, autoreset="same_step", **small))
listed.reset(seed=1)
infos = [listed.step(np.zeros((2, 4), np.float32))[4] for _ in range(4)]
print(len(infos[0]), infos[0][1]["organ"] == "sthenic 1", any("final_info" in info for pair in infos for info in pair))
made = gymnasium.make_vec("vibe/Reach-v0", num_envs=2, threads=1, **small)
print(type(made).__name__, made.closed, gymnasium.spec("vibe/Bite-v0").max_episode_steps)

import json, os, tempfile
import h5py
from vibe.env import Expert, demonstrations
with tempfile.TemporaryDirectory() as folder:
    environment, file = gymnasium.make("vibe/Reach-v0", action="tip", breathing="slight", **small), os.path.join(folder, "reach.hdf5")
    demonstrations.record(environment, Expert(environment), file, 1, seed=1)
    with h5py.File(file) as found:
        args, demo = json.loads(found["data"].attrs["env_args"]), found["data/demo_0"]
        again = gymnasium.make(args["env_name"], **args["env_kwargs"])
        again.reset(seed=int(demo.attrs["seed"]))
        same = [np.array_equal(again.step(action)[0]["wall"], wall) for action, wall in zip(demo["actions"][:], demo["next_obs/wall"])]
        print("from file", all(same), f"{again.unwrapped.simulation.hash():016x}" == demo.attrs["hash"])
"""
WINDOW = """
import copy, time
import numpy as np
import vibe
from vibe.env import Environment, contract
environment = Environment("Reach", render_mode="human", view="outside", **contract.SETTINGS)
assert environment.render_mode == "human" and copy.deepcopy(environment).render_mode is None
environment.reset(seed=1)
begin = time.monotonic()
for _ in range(5):
    environment.step(np.zeros(4))
assert time.monotonic() - begin > 4 / 20 and environment.render() is None
picture = vibe.picture(environment.simulation, "outside", goal=environment.task.look()["goal"][0])
shown = np.array([[environment._window._photo.get(x, y) for x in range(0, 480, 7)] for y in range(0, 480, 7)])
assert np.array_equal(shown, picture[::7, ::7])
window = vibe.view(environment.simulation, size=32)
assert window.update() and not window.closed
window.close()
assert window.closed and not window.update()
root = environment._window._root
root.after(0, lambda: root.tk.call(*root.protocol("WM_DELETE_WINDOW").split()))  # somebody closes it
environment.step(np.zeros(4))
assert environment._window.closed
environment.close()
try:
    environment.render()
except vibe.Error as error:
    assert "call reset() first" in str(error)
    print("shown")
"""
SMALL = contract.SETTINGS
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../docs/python.md")


def task_table():
    """The tasks of the library as the table of docs/python.md."""
    rows = ["| task | goal | rewarded | observed besides | action | rate, length |", "|---|---|---|---|---|---|"]
    for name, task in TASKS.items():
        further = "; ".join(f"`{key}` {shape}: {words}" for key, (shape, words) in task.further.items()).replace(",)", ")")
        action = f"{len(task.joints)} joints" + (f", {len(vibe.BUTTONS)} buttons" if task.buttons else "") + (
            ', or `action="tip"`: 3 velocities' if task.moves_tip_only() else "")
        rows.append(f"| `{name}` | {task.summary()} | {task.reward} | {further or '-'} | {action} | {task.rate} Hz, {task.seconds:g} s |")
    return "\n".join(rows) + "\n"


def equal(a, b):
    return set(a) == set(b) and all(np.array_equal(a[name], b[name]) for name in a)


def row(parts, slot):
    return {name: value[slot] for name, value in parts.items()}


class Restless(Reach):
    """Counts its steps in single precision, draws in them, and may be broken off."""

    further = {"steps": ((1,), "taken")}
    breaks = False

    def begun(self, slot):
        super().begun(slot)
        self.steps = getattr(self, "steps", np.zeros((self.count, 1), np.float32))
        self.steps[slot] = 0

    def judge(self, before, after):
        if self.breaks:
            raise KeyboardInterrupt
        self.steps += 1
        return np.array([random.uniform() for random in self.random]), np.zeros(self.count, bool)

    def observe_further(self, seen):
        return {"steps": self.steps}


class EnvironmentTest(unittest.TestCase):
    def actions(self, environment, seed, count):
        random = np.random.default_rng(seed)
        return random.uniform(-1, 1, (count,) + environment.action_space.shape).astype(np.float32)

    def test_every_task_keeps_the_contract(self):
        for name in TASKS:
            self.assertEqual(contract.broken(name, actions=15, camera=(16, 12, 1.7)), [])
        first, second = (Environment("Reach", **SMALL).reset(seed=seed)[0] for seed in (5, 6))  # control
        self.assertFalse(equal(first, second))

    def test_what_a_task_does_not_keep_is_said(self):
        class Wrong(Reach):
            calls = 0

            def judge(self, before, after):
                Wrong.calls += 1
                reward, success = super().judge(before, after)
                return reward + self.error(reward), success

        def of(**members):
            return "; ".join(contract.broken(type("Astray", (Wrong,), {"error": lambda *_: 0, **members})))

        self.assertEqual(of(), "")
        wrong_shape = {"further": {"more": ((2,), "")}, "observe_further": lambda self, seen: {"more": seen["tip"]}}
        for sentence, members in (("the reward is nan", {"error": lambda *_: np.nan}),
                                  ("the same seed gives another", {"error": lambda *_: Wrong.calls}),
                                  ("beside others is another", {"error": lambda self, _: self.count}),
                                  ("'more' is not of its space", wrong_shape),
                                  ("'more' is not in the space", {**wrong_shape, "further": {}}),
                                  ("does not end in time", {"advance": lambda self, actions: (
                                      *Reach.advance(self, actions)[:2], np.zeros(self.count, bool))})):
            self.assertIn(sentence, of(**members))

    def test_the_page_has_the_table_that_is_made_from_the_tasks(self):
        with open(PAGE, encoding="utf-8") as file:
            page = file.read()
        before, rest = page.split("<!-- tasks: begin -->\n")
        table, after = rest.split("<!-- tasks: end -->\n")
        if "VIBE_UPDATE_DOCS" in os.environ:
            with open(PAGE, "w", encoding="utf-8") as file:
                file.write(f"{before}<!-- tasks: begin -->\n{task_table()}<!-- tasks: end -->\n{after}")
            self.skipTest(f"wrote {PAGE}")
        self.assertEqual(table, task_table(), f"run with VIBE_UPDATE_DOCS=1 to write {PAGE}")
        for name, task in TASKS.items():
            self.assertIn(f"{name:11}{task.summary()}", vibe.env.__doc__)

    def test_breathing_moves_the_goal_as_the_diaphragm_and_episodes_begin_in_different_phases(self):
        rate, amplitude = BREATHING["strong"]
        for breathing in ("strong", None):
            environment = Environment("Reach", breathing=breathing, **SMALL)
            goals, first = [], environment.reset(seed=2)[0]["goal"]
            for _ in range(round(20 / rate)):
                goals.append(environment.task.look()["goal"][0])
                environment.task.advance(np.zeros((1, 4)))
            moved = np.ptp(np.array(goals), axis=0)
            if breathing is None:  # control
                self.assertLess(moved.max(), 1e-4)
                continue
            self.assertGreater(moved[2], 0.6 * amplitude)
            self.assertLess(moved[2], 1.1 * amplitude)
            np.testing.assert_allclose(goals[0], environment.task.look()["goal"][0], atol=5e-4)  # a breath later
            np.testing.assert_array_equal(first, environment.reset(seed=2)[0]["goal"])
            phases = {(environment.reset(seed=seed), round(environment.simulation.time * rate % 1, 3))[1]
                      for seed in range(20)}
            self.assertGreater(len(phases), 4)

    def test_waves_move_the_wall_and_episodes_begin_in_their_phases(self):
        moved = {}
        for motion in ("strong", None):
            environment = Environment("Reach", motion=motion, **SMALL)
            info = environment.reset(seed=2)[1]
            self.assertEqual(info["organ"], "sthenic 1" + (", strong motion" if motion else ""))
            phases = [(environment.reset(seed=seed), environment.simulation.motion["wave_phase"])[1] for seed in range(12)]
            antrum, first = environment.simulation.model.region == 3, environment.simulation.positions
            environment.task.advance(np.zeros((1, 4)))
            moved[motion] = abs(environment.simulation.positions - first)[antrum].max()
            self.assertEqual(len(set(np.round(phases, 3))) > 3, motion is not None)
            self.assertTrue(equal(environment.reset(seed=3)[0], environment.reset(seed=3)[0]))
        self.assertGreater(moved["strong"], 5 * moved[None])
        with self.assertRaisesRegex(vibe.Error, "use 'motion'"):
            Environment("Reach", motion="slight", vary={"motion.wave_speed": ("uniform", 1e-3, 2e-3)})

    def test_settings_have_names_types_and_defaults(self):
        task = {name for name, parameter in inspect.signature(Task.__init__).parameters.items() if parameter.kind is parameter.KEYWORD_ONLY}
        self.assertEqual({*Settings.__annotations__}, task - {"threads"})
        for kind in (Environment, VectorEnvironment, GoalEnvironment):
            shown = inspect.signature(kind).parameters
            self.assertLess({*Settings.__annotations__}, {*shown})
            self.assertEqual((shown["particles"].default, shown["particles"].annotation), (1000, int))
            for name in shown:
                if shown[name].kind is not shown[name].VAR_KEYWORD and name not in ("render_mode", "num_envs"):
                    self.assertRegex(f"{Environment.__doc__} {VectorEnvironment.__doc__}", rf"\b{name}\b")

    def test_a_window_shows_episodes_to_people(self):
        self.assertEqual([kind.metadata["render_modes"] for kind in (Environment, VectorEnvironment)], [["rgb_array", "human"], ["rgb_array"]])
        with mock.patch.dict(os.environ), self.assertRaisesRegex(vibe.Error, "No window can be opened .*; set DISPLAY|install python3-tk"):
            os.environ.pop("DISPLAY", None)
            Environment("Reach", render_mode="human", **SMALL)
        if not shutil.which("xvfb-run") or not importlib.util.find_spec("tkinter"):
            self.skipTest("xvfb-run or tkinter is not installed")
        shown = subprocess.run(["xvfb-run", "-a", sys.executable, "-c", WINDOW], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               check=False)
        self.assertEqual((shown.returncode, shown.stdout), (0, "shown\n"), shown.stderr)

    def test_longer_steps_are_fewer_and_move_the_wall_alike(self):
        goals = {}
        for period, steps in ((None, 1), (1 / 20, 1), (1 / 60, 3)):
            environment = Environment("Reach", step_period=period, **SMALL)
            environment.reset(seed=4)
            begin = environment.simulation.steps
            goals[period] = np.array([environment.step(action)[0]["goal"] for action in self.actions(environment, 1, 10)])
            self.assertEqual(environment.simulation.steps - begin, 10 * steps)
        np.testing.assert_array_equal(goals[None], goals[1 / 20])
        np.testing.assert_allclose(goals[None], goals[1 / 60], atol=1e-3)
        for wrong in (0.03, 0.1, 0, -0.05, float("nan"), "fast"):
            with self.assertRaisesRegex(vibe.Error, "'step_period' is .*whole part of an action of 1/20 s"):
                Environment("Reach", step_period=wrong)

    def test_autoreset(self):
        class Short(Reach):
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

    def test_random_actions_give_finite_numbers(self):
        few = {name: TASKS[name] for name in ("Reach", "Inspect", "Mark", "Bite", "SutureSet")}
        with mock.patch.multiple(random_actions, ORGANS=SMALL["organs"], TASKS=few):
            self.assertEqual(random_actions.one_round(0, 300, 40), (4 * 40 + 4 * 2 * 40, []))
        self.assertEqual(random_actions.faults("seen", {"a": np.ones(3), "b": np.array([1, np.nan])}), ["seen.b"])  # control
        self.assertAlmostEqual(random_actions.growth([3, 4, 5], [7, 8, 9]), 2)

    def test_rough_use(self):
        class Forgetful:  # control
            restore = staticmethod(lambda snapshot: None)
            __getattr__ = staticmethod(lambda name: getattr(environment.simulation, name))

        environment, random = Environment("Reach", **SMALL), np.random.default_rng(1)
        environment.reset(seed=1)
        for use in (rough_use.snapshots, rough_use.views, rough_use.two_threads, rough_use.threads, rough_use.fork):
            self.assertEqual(use(environment.simulation, random), [], use.__name__)
        self.assertEqual(rough_use.snapshots(Forgetful(), random), ["snapshots have different futures"])

    def test_what_a_reset_chooses_is_not_drawn(self):
        environment = Environment("Reach", breathing="slight", render_mode="rgb_array", max_episode_steps=3, **SMALL)
        first = environment.reset(seed=3)[0]
        options = {"organ": ("j", 1.0), "start": 2, "goal": (0.5, 0.1), "phase": 3}
        seen, info = environment.reset(seed=3, options=options)
        self.assertEqual((info["organ"], environment.task.place[0]), ("j 1, slight breathing", (0.5, 0.1)))
        self.assertFalse(equal(seen, first))
        self.assertTrue(equal(seen, environment.reset(seed=4, options=options)[0]))
        self.assertTrue(equal(first, environment.reset(seed=3)[0]))
        self.assertEqual([environment.step(np.zeros(4))[3] for _ in range(3)], [False, False, True])
        self.assertEqual(environment.render().shape, (480, 480, 3))
        self.assertTrue(environment._repr_png_().startswith(b"\x89PNG"))
        together = VectorEnvironment("Reach", 2, threads=1, breathing="slight", **SMALL)
        found = together.reset(seed=5, options={**options, "reset_mask": np.array([True, True])})[0]
        self.assertTrue(equal(row(found, 0), seen) and equal(row(found, 1), seen))
        with self.assertRaisesRegex(vibe.Error, "'reset_mask' is .*at least one of them True"):
            together.reset(options={"reset_mask": np.zeros(2, bool)})

    def test_a_child_makes_its_own(self):
        environment = Environment("Reach", **SMALL)
        environment.reset(seed=1)
        environment.close()
        child = os.fork()
        if child == 0:
            own = Environment("Reach", **SMALL)
            own.reset(seed=1)
            own.step(np.zeros(4))
            os._exit(0)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)

    def test_the_tip_moves_as_damped_least_squares(self):
        random = np.random.default_rng(3)
        for _ in range(20):
            jacobian, turn, speed, limits = random.normal(size=(6, 4)), np.eye(4), random.normal(size=3), random.uniform(0.1, 1, 4)
            turn[:3, :3] = np.linalg.qr(random.normal(size=(3, 3)))[0]
            scaled = jacobian[:3] * limits
            wanted = scaled.T @ np.linalg.solve(scaled @ scaled.T + 4e-6 * np.eye(3), turn[:3, :3] @ speed)
            np.testing.assert_allclose(tip_motion(jacobian, turn, speed, limits), wanted / max(1, abs(wanted).max()), rtol=1e-6, atol=1e-9)

    def test_what_varies_is_drawn_by_the_seed_and_belongs_to_the_state(self):
        vary = {"tissue.young_modulus": ("uniform", 6e4, 1.6e5), "gas.regulated_pressure": ("choice", ["8 mmHg", "12 mmHg"]),
                "action.noise": ("uniform", 0.1, 0.2)}
        environment = Environment("Reach", vary=vary, **SMALL)

        def future(one, seed=5):
            return [one.step(action)[0] for action in self.actions(one, seed, 4)]

        first, info = environment.reset(seed=1)
        self.assertEqual(set(info["varied"]), set(vary))
        rows = future(environment)
        self.assertTrue(equal(first, environment.reset(seed=1)[0]))
        snapshot = environment.snapshot()
        self.assertTrue(all(map(equal, rows, future(environment))))
        again = Environment("Reach", vary=vary, **SMALL)
        again.restore(snapshot)
        self.assertTrue(all(map(equal, rows, future(again))))
        self.assertEqual(environment.reset()[1], again.reset()[1])
        self.assertNotEqual(info["varied"], environment.reset(seed=2)[1]["varied"])  # control
        chosen = environment.reset(seed=1, options={"varied": {"gas.regulated_pressure": 900.0}})[1]["varied"]
        self.assertEqual(chosen, {**info["varied"], "gas.regulated_pressure": 900.0})
        self.assertAlmostEqual(environment.simulation.pressure, 900, delta=5)
        together = VectorEnvironment("Reach", 2, threads=1, vary=vary, **SMALL)
        self.assertTrue(equal(first, row(together.reset(seed=[3, 1])[0], 1)))
        together.step(np.stack([self.actions(environment, 6, 1)[0], self.actions(environment, 5, 1)[0]]))
        self.assertTrue(equal(rows[0], row(together.task.observe(), 1)))

    def test_an_action_arrives_late(self):
        moved = {}
        for delay in (0.0, 0.1):
            environment = Environment("Reach", vary={"action.delay": ("uniform", delay, delay)}, **SMALL)
            joints = [environment.reset(seed=1)[0]["joints"][1]] + [environment.step([0, 1, 0, 0])[0]["joints"][1] for _ in range(4)]
            moved[delay] = list(np.diff(joints) > 0.01)
        self.assertEqual(moved, {0.0: [True] * 4, 0.1: [False, False, True, True]})

    def test_organs_may_be_scene_files_and_goals_have_settings(self):
        environment = Environment("Reach", particles=300, organs=["package://vibe_core/scenes/stomach_j.yaml"], tolerance=0.05,
                                  scene={"gas": {"regulated_pressure": 900}}, along=(0.5, 0.5), around=(0, 0))
        environment.reset(seed=1)
        self.assertAlmostEqual(environment.simulation.pressure, 900, delta=5)
        self.assertEqual(environment.task.place[0], (0.5, 0))
        self.assertEqual(environment.task.tolerance, 0.05)

    def test_values_of_the_scene_are_added_to_those_of_the_task(self):
        environment = Environment("StopBleeding", scene={"bleeding": {"mild_probability": 0.0, "brisk_rate": 1e-7}}, **SMALL)
        self.assertEqual(environment.task.variation.scene["bleeding"], {**environment.task.sections["bleeding"], "brisk_rate": 1e-7})

    def test_each_slot_moves_with_the_speeds_of_its_own_scope(self):
        urdf = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../vibe_description/urdf/scope.urdf")
        with tempfile.TemporaryDirectory() as folder:
            with open(urdf, encoding="utf-8") as file:
                slow = re.sub(r'(<joint name="insertion".*?velocity=)"[^"]*"', r'\1"0.05"', file.read(), flags=re.S)
            with open(os.path.join(folder, "slow.urdf"), "w", encoding="utf-8") as file:
                file.write(slow)
            vary = {"scope.urdf": ("choice", [urdf, os.path.join(folder, "slow.urdf")])}
            together, alone = VectorEnvironment("Bite", 4, vary=vary, **SMALL), Environment("Bite", vary=vary, **SMALL)
            # the first slot has the slow scope: a fast target for a slow one would change nothing
            first = next(seed for seed in range(20) if "slow" in alone.reset(seed=seed)[1]["varied"]["scope.urdf"])
            together.reset(seed=first)
            actions = np.zeros((4, *together.single_action_space.shape))
            actions[:, 0] = -1
            seen = [together.step(actions)[0] for _ in range(3)][-1]
            self.assertEqual(len(set(map(str, together.task.variation.values))), 2)  # control: both were drawn
            for slot in range(4):
                alone.reset(seed=first + slot)
                self.assertTrue(equal([alone.step(actions[slot])[0] for _ in range(3)][-1], row(seen, slot)), slot)

    def test_a_step_that_is_broken_off_ends_the_episodes(self):
        for environment, shape in ((Environment(Restless, **SMALL), (4,)), (VectorEnvironment(Restless, 2, **SMALL), (2, 4))):
            environment.reset(seed=1)
            environment.step(np.zeros(shape))
            snapshot, environment.task.breaks = environment.snapshot(), True
            with self.assertRaises(KeyboardInterrupt):
                environment.step(np.zeros(shape))
            environment.task.breaks = False
            with self.assertRaisesRegex(vibe.Error, "broken off"):
                environment.step(np.zeros(shape))
            environment.restore(snapshot)
            environment.step(np.zeros(shape))

    def test_observations_stay_as_they_were(self):
        environment = Environment(Restless, **SMALL)
        first = environment.reset(seed=1)[0]
        second = environment.step(np.zeros(4))[0]
        self.assertEqual((first["steps"][0], second["steps"][0]), (0, 1))
        second["steps"][0] = 77
        self.assertEqual(environment.step(np.zeros(4))[0]["steps"][0], 2)

    def test_a_task_may_draw_in_its_steps(self):
        environment = Environment(Restless, **SMALL)
        environment.reset(seed=1)
        environment.step(np.zeros(4))
        futures, snapshot = [], environment.snapshot()
        for one, again in ((environment, False), (copy.deepcopy(environment), False), (environment, True)):
            if again:
                one.restore(snapshot)
            rewards = [one.step(np.zeros(4))[1] for _ in range(3)]
            one.reset()
            futures.append([*rewards, *one.task.place[0], one.step(np.zeros(4))[1]])
        self.assertEqual(futures, futures[:1] * 3)

    def test_snapshots_of_other_numbers_are_refused_and_nothing_changes(self):
        one, two, three = Environment("Reach", **SMALL), VectorEnvironment("Reach", 2, **SMALL), VectorEnvironment("Reach", 3, **SMALL)
        for environment in (one, two, three):
            environment.reset(seed=1)
        for here, there in ((one, two), (two, one), (two, three), (three, two)):
            kept = here.snapshot()["episodes"]["taken"]
            with self.assertRaisesRegex(vibe.Error, "The snapshot is of an environment with the (kind|number)"):
                here.restore(there.snapshot())
            np.testing.assert_array_equal(here.snapshot()["episodes"]["taken"], kept)
            here.step(np.zeros(here.action_space.shape))

    def test_copies_draw_the_same_actions(self):
        environment = Environment("Reach", **SMALL)
        environment.reset(seed=1)
        environment.action_space.seed(3)
        others = copy.deepcopy(environment), pickle.loads(pickle.dumps(environment))
        for action in [environment.action_space.sample()]:
            for other in others:
                np.testing.assert_array_equal(other.action_space.sample(), action)

    def test_a_set_counts_with_seven_bites_as_u_and_where_it_was_asked_for(self):
        environment = Environment("SutureSet", **SMALL)
        environment.reset(seed=1)
        task, goal = environment.task, environment.task.look()["goal"][0]

        def succeeds(bites=7, technique="u", stage="cinched", away=0.0):
            places = goal + [away, 0, 0] + 0.03 * np.resize([[0, 1, 0], [0, -1, 0]], (bites, 3))  # each farther than 20 mm
            thread = {"stage": stage, "technique": technique, "bites": places}
            task.events = [[mock.Mock(kind="cinched")]]
            with mock.patch.object(task, "simulation", [mock.Mock(threads=lambda: [thread])]):
                return bool(task.judge(task.seen, task.seen)[1][0])

        task.seen = task.look()
        self.assertTrue(succeeds() and succeeds(bites=8) and succeeds(away=0.015))
        for wrong in ({"bites": 6}, {"technique": "z"}, {"stage": "open"}, {"away": 0.025}):
            self.assertFalse(succeeds(**wrong), wrong)

    def test_what_a_caller_does_to_his_settings_later_is_no_setting(self):
        scene, values = {"tissue": {"density": 1000}}, [900.0]
        environment = Environment("Reach", scene=scene, vary={"foundation.stiffness": ("choice", values)}, **SMALL)
        kept = repr((environment._settings, environment.task.variation.scene, environment.task.variation.vary))
        scene["tissue"]["density"], values[0] = 3000, 7.0
        self.assertEqual(repr((environment._settings, environment.task.variation.scene, environment.task.variation.vary)), kept)

    def test_equal_settings_are_equal_however_they_are_written(self):
        written = [{"particles": 300, "organs": (("sthenic", 0.92),)}, {"organs": [["sthenic", 0.92]], "particles": np.int64(300), "action": "joints"}]
        environments = [Environment("Reach", **settings) for settings in written]
        seen = environments[0].reset(seed=1)[0]
        self.assertTrue(equal(environments[1].restore(environments[0].snapshot())[0], seen))

    def test_no_joint_leaves_the_box_of_observations(self):
        environment = Environment("Mark", **SMALL)
        environment.reset(seed=1)
        limits = np.array([limits[:2] for limits in environment.simulation.model.joint_limits.values()])
        self.assertEqual(limits.shape, (len(vibe.JOINTS), 2))
        self.assertLess(np.abs(limits).max(), environment.observation_space["joints"].high.min())

    def test_goals_in_the_form_of_hindsight(self):
        environment, plain = GoalEnvironment(**SMALL), Environment(**SMALL)
        environment.reset(seed=3), plain.reset(seed=3)
        expert, achieved, desired, rewards, over = Expert(environment), [], [], [], False
        expert.reset()
        seen = environment.task.observe()
        while not over:
            action = expert.action(row(seen, 0))
            found, reward, over, truncated, _ = environment.step(action)
            self.assertEqual(over, plain.step(action)[2])
            self.assertIn(found, environment.observation_space)
            seen, over = environment.task.observe(), over or truncated
            achieved.append(found["achieved_goal"]), desired.append(found["desired_goal"]), rewards.append(reward)
        self.assertEqual(rewards, [-1] * (len(rewards) - 1) + [0])
        np.testing.assert_array_equal(environment.compute_reward(achieved, desired, {}), rewards)
        np.testing.assert_array_equal(environment.compute_reward(achieved[-3:], achieved[-1], {})[-1], 0)  # in hindsight
        self.assertEqual(environment.compute_reward(achieved[0], desired[0], {}).shape, ())
        self.assertEqual(list(environment.compute_truncated(achieved, desired, {})), [False] * len(rewards))
        np.testing.assert_array_equal(found["observation"][:10], np.concatenate([seen["joints"][0], seen["tip"][0]]))
        with self.assertRaisesRegex(vibe.Error, "The task Mark does not end at a place"):
            GoalEnvironment("Mark", **SMALL)

    def test_experts_reach(self):
        for mode in ("joints", "tip"):
            environment = Environment("Reach", action=mode, **SMALL)
            expert = Expert(environment)
            self.assertEqual([demonstrations.episode(environment, expert, seed)[1] for seed in range(1, 4)], [True] * 3)
            still = type("Still", (), {"reset": lambda s: None, "action": lambda s, o: 0 * environment.action_space.high})
            self.assertFalse(demonstrations.episode(environment, still(), 0)[1])  # control

    def test_experts_inspect(self):
        environment = Environment("Inspect", **SMALL)
        self.assertTrue(demonstrations.episode(environment, Expert(environment), 0)[1])
        self.assertLess(environment.task.best_force[0], 5)
        with self.assertRaisesRegex(vibe.Error, "no expert for the task Inspect with action='tip'"):
            Expert(Environment("Inspect", action="tip", **SMALL))

    def test_trainees_mark_and_experts_retract_cinch_and_stop_bleeding(self):
        for task in ("Mark", "Retract", "Cinch", "StopBleeding"):
            environment = Environment(task, **SMALL)
            self.assertTrue(demonstrations.episode(environment, Expert(environment), 1)[1], task)

    def test_demonstrations_are_laid_out_as_robomimic_reads_them(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("python3-h5py is not installed")
        environment = Environment("Reach", **SMALL)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "reach.hdf5")
            for episodes in (1, 2):  # it goes on
                self.assertEqual(demonstrations.record(environment, Expert(environment), file, episodes, seed=1), (episodes, episodes))
            with self.assertRaisesRegex(vibe.Error, "of other settings"):
                demonstrations.record(environment, Expert(environment), file, 3, seed=2)
            with h5py.File(file) as found:
                demo = found["data/demo_1"]
                steps = demo.attrs["num_samples"]
                self.assertEqual(demo["actions"].shape, (steps, 4))
                self.assertEqual(demo["dones"][-1], 1)
                np.testing.assert_array_equal(demo["obs/tip"][1:], demo["next_obs/tip"][:-1])
                self.assertEqual(found["data"].attrs["total"], sum(d.attrs["num_samples"] for d in found["data"].values()))

    def test_refusals(self):
        environment, other = Environment("Reach", **SMALL), Environment("Reach", breathing="slight", **SMALL)
        other.reset(seed=1)
        late = Environment("Reach", vary={name: ("uniform", 0, 0.1) for name in ("action.delay", "action.noise")}, **SMALL)
        together, density = VectorEnvironment("Reach", 2, autoreset="disabled", **SMALL), {"tissue.density": ("uniform", 900, 1100)}
        still = np.zeros(4)
        for sentence, call in (("call reset", lambda: environment.step(still)),
                               ("no task 'Fly'", lambda: Environment("Fly")),
                               ("no task 'Fly'", lambda: Environment("vibe.env:Fly")),
                               ("'nowhere:Fly' cannot be had", lambda: Environment("nowhere:Fly")),
                               ("vibe.env.tasks has a task 'Reach'", lambda: type("Mine", (Reach,), {"name": "Reach"})),
                               ("'action' is 'force'", lambda: Environment("Reach", action="force")),
                               ("'organs' is empty", lambda: Environment("Reach", organs=[])),
                               ("did you mean 'particles'", lambda: Environment("Reach", particle=300)),
                               ("without a camera", lambda: Environment("Reach", pictures=["colour"])),
                               ("No episode has begun", lambda: environment.simulation),
                               ("'options' has no 'gaol'; it may choose", lambda: environment.reset(options={"gaol": 1})),
                               ("'options' is 7", lambda: environment.reset(options=7)),
                               ("'start' is 4", lambda: environment.reset(options={"start": 4})),
                               ("'goal' is", lambda: environment.reset(options={"goal": 0.5})),
                               ("does not breathe", lambda: environment.reset(options={"phase": 0})),
                               ("with the settings", lambda: environment.restore(other.snapshot())),
                               ("give one of snapshot", lambda: environment.restore(7)),
                               ("without render_mode", other.render),
                               ("acts in an Environment", lambda: Expert(VectorEnvironment("Reach", 2, **SMALL))),
                               ("expert has not begun", lambda: Expert(environment).action({})),
                               ("tissue.young: is not a known key", lambda: Environment("Reach", vary={"tissue.young": ("uniform", 1, 2)})),
                               ("'-1' is out of range", lambda: Environment("Reach", vary={"tissue.density": ("uniform", -1, 900)})),
                               ("use 'organs'", lambda: Environment("Reach", vary={"geometry.scale": ("uniform", 1, 2)})),
                               ("use 'breathing'", lambda: Environment("Reach", scene={"breathing": {}}, breathing="slight")),
                               ("'vary' has 'action.dealy'", lambda: Environment("Reach", vary={"action.dealy": ("uniform", 0, 1)})),
                               ("this is a GoalEnvironment", lambda: demonstrations.record(GoalEnvironment(**SMALL), None, "/nowhere/a.hdf5", 1)),
                               ("'vary' is 7", lambda: Environment("Reach", vary=7)),
                               ("'action.delay' of 'vary' is", lambda: Environment("Reach", vary={"action.delay": ("normal", 0, 1)})),
                               ("'scene' is 'a.yaml'", lambda: Environment("Reach", scene="a.yaml")),
                               ("has no tolerance", lambda: Environment("Inspect", tolerance=1e-3)),
                               ("'tolerance' is 1", lambda: Environment("Reach", tolerance=1)),
                               ("'-140000.0' is out of range", lambda: Environment("Reach", vary={"tissue.young_modulus": ("normal", 1e5, 8e4)})),
                               ("'scene' takes 'tissue' away", lambda: Environment("Reach", scene={"tissue": None}, vary=density)),
                               ("'tolerance' is int", lambda: Environment("Reach", tolerance=10**400)),
                               ("'along' is", lambda: Environment("Reach", along=(False, True))),
                               ("reaches none of 100 goals", Environment("Reach", along=(0.97, 1), around=(2.8, 3.1), **SMALL).reset),
                               ("that has never begun", lambda: together.reset(options={"reset_mask": [True, False]})),
                               *((f"'{name}' of 'varied' is", lambda name=name, value=value: late.reset(options={"varied": {name: value}}))
                                 for name in ("action.delay", "action.noise") for value in (-0.1, np.nan, np.inf, 1e9, "a", None)),
                               ("which does not vary", lambda: environment.reset(options={"varied": {"a.b": 1}})),
                               ("'varied' is 3", lambda: environment.reset(options={"varied": 3})),
                               ("'rate' of the task", lambda: Environment(type("Mine", (Reach,), {"rate": 0}))),
                               ("'along' is", lambda: Environment(type("Mine", (Reach,), {"along": (0.6, 0.4)})))):
            with self.assertRaisesRegex(vibe.Error, sentence):
                call()
        environment.reset(seed=1)
        for sentence, action in ((r"shape \(3,\); give one of the shape \(4,\)", np.zeros(3)), ("not finite", still + np.nan),
                                 ("The action is .*numbers from -1 to 1", still + 1j), ("The action is", ["0"] * 4)):
            with self.assertRaisesRegex(vibe.Error, sentence):
                environment.step(action)
        together = VectorEnvironment("Reach", 2, threads=1, **SMALL)
        together.reset(seed=1)
        for one, action in ((environment, still), (together, np.zeros((2, 4)))):
            one.close()
            for call in (lambda one=one, action=action: one.step(action), one.reset):
                with self.assertRaisesRegex(vibe.Error, "is closed"):
                    call()

    def test_the_checker_of_gymnasium(self):
        """With the package that is installed, or that of a newer Debian, unpacked for the test only."""
        with tempfile.TemporaryDirectory() as folder:
            if not api.REAL:
                unpack = os.path.join(os.path.dirname(os.path.abspath(__file__)), "unpack_gymnasium.sh")
                subprocess.run(["bash", unpack], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
                if not os.path.isdir(os.path.join(folder, "usr")):
                    self.skipTest("gymnasium is not installed, and python3-gymnasium of a newer Debian cannot be reached")
            path = os.pathsep.join([*sys.path, os.path.join(folder, "usr/lib/python3/dist-packages")])
            checked = subprocess.run([sys.executable, "-B", "-c", CHECK], env={**os.environ, "PYTHONPATH": path},
                                     stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(checked.returncode, 0, checked.stdout)
        self.assertEqual(checked.stdout.split(), [*TASKS, "refused", "wrapped", "processes", "2", "True", "True", "VectorEnvironment", "False", "5400",
                                                    "from", "file", "True", "True"],
                         checked.stdout)


if __name__ == "__main__":
    unittest.main()
