#!/usr/bin/env python3
"""Whatever is handed to whatever function, it works or says in one sentence what is wrong: a generated sweep."""
import os
import re
import tempfile
import unittest

import numpy as np

import vibe
from vibe.env import Environment, VectorEnvironment

SMALL = {"particles": 300, "organs": [("sthenic", 1.0)]}
DUMPS = re.compile(r"incompatible|Invoked with|(?<!vibe)_core|\(arg\d|0x[0-9a-f]{6}|SystemError|Traceback")
WRONG = [None, float("nan"), float("inf"), -1, 10**30, -1e300, 2.5, True, "", "x", "a\nb: c", "\0", "\udcff", b"\xff", [],
         [float("nan")] * 3, [[1, 2], [3]], {}, {"a": {1: 2}}, object(), int, np.zeros((2, 0)), np.array("text"),
         np.full((7, 7), np.inf), np.array([10**400], object), lambda: 0]


def parameters(function, name):
    """Their names, as the docstring has them."""
    line = (function.__doc__ or "").split("\n", 1)[0]
    return [word for word in re.findall(r"(\w+): ", line.split(" -> ")[0]) if word != "self"]


class SweepTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.before = os.getcwd()
        os.chdir(cls.folder.name)  # a wrong name of a file may be a right one
        cls.model = vibe.load(geometry={"particles": 300}, render_surface=False)
        cls.simulation = vibe.Simulation(cls.model)
        cls.simulation.step()
        place = vibe.Anatomy(cls.simulation).at(0.5, 0)
        cls.trainee = vibe.Trainee(cls.model, "name: short\ngoals:\n  - insufflate\n")
        cls.valid = {
            "model": cls.model, "simulation": cls.simulation, "trainee": cls.trainee, "simulations": [cls.simulation],
            "snapshot": cls.simulation.snapshot(), "joints": np.zeros(7), "buttons": np.zeros((1, 6)), "steps": 1,
            "threads": 1, "seconds": 0.05, "file": os.path.join(cls.folder.name, "state"), "name": "scope_tip",
            "along": 0.5, "around": 0.0, "triangle": place[0], "weight": place[1], "triangles": [[place[0]]],
            "weights": [[place[1]]], "bites": np.eye(3), "printed": False, "position": np.zeros(3), "direction": np.ones(3),
            "start": np.zeros(7), "width": 8, "height": 8, "field_of_view": 1.0, "normals": True, "prepared": True,
            "seed": 1, "metrics": True, "impedance": True, "protocol": "name: short\ngoals:\n  - insufflate\n",
            "novice": 0.5, "other_model": True, "bytes": b"x", "scene": vibe.DEFAULT_SCENE, "overrides": "", "mesh": "",
        }
        cls.script = "name: s\nsteps:\n  - {at: 0 s, insertion: 0}\n"

    @classmethod
    def tearDownClass(cls):
        os.chdir(cls.before)
        cls.folder.cleanup()

    def check(self, where, call, *arguments, **keywords):
        """@returns the sentence, or None if it worked."""
        try:
            call(*arguments, **keywords)
            return None
        except (vibe.Error, TypeError, ValueError) as error:
            text = str(error).replace("a\nb: c", "?")  # which was given
        except Exception as error:  # pylint: disable=broad-except
            with self.subTest(where):
                self.fail(f"{type(error).__name__}: {error}")
            return None
        with self.subTest(where):
            self.assertNotRegex(text, DUMPS)
            self.assertRegex(text, r"^['A-Z<\w/?].{20,}[.)'\w]$")
        return text

    def sweep(self, where, function, usual=()):
        """One argument after the other is wrong, while the others are right; and too many, and none."""
        names = parameters(function, where)
        refused = 0
        for wrong in names:
            for value in WRONG:
                keywords = {name: self.valid[name] for name in names if name in self.valid and name not in ("mesh",)}
                if where.startswith("step_all"):
                    keywords["joints"] = np.zeros((1, 7))
                keywords[wrong] = value
                refused += self.check(f"{where}({wrong}={value!r:.40})", function, **keywords) is not None
        for arguments in ((-1,) * 9, (float("nan"),), (self.model,) * 20):
            self.check(f"{where}{arguments!r:.60}", function, *arguments)
        self.check(f"{where}(surely_not=1)", function, surely_not=object())
        return refused

    def test_every_function(self):
        swept = refused = 0
        objects = {"Simulation": self.simulation, "Model": self.model, "Trainee": self.trainee,
                   "Snapshot": self.valid["snapshot"], "Anatomy": vibe.Anatomy(self.simulation)}
        for name in vibe.__all__ + ["_build_model"]:
            thing = getattr(vibe, name)
            if isinstance(thing, type):
                for label, member in vars(thing).items():
                    bound = getattr(objects.get(name, thing), label, None)
                    if isinstance(member, property):
                        self.check(f"{name}.{label}.fget", member.fget, 3)
                    elif callable(bound) and not label.startswith("_") and label != "close":
                        refused += self.sweep(f"{name}.{label}", bound)
                        swept += 1
                if hasattr(thing, "__init__") and not issubclass(thing, Exception):
                    thing.__init__.__doc__ and self.sweep(name, thing)
                    self.assertIsNotNone(self.check(name, thing, 3, 3, 3))
            elif callable(thing):
                refused += self.sweep(name, thing)
                swept += 1
        self.assertGreater(swept, 25)
        self.assertGreater(refused, 500)  # control: the sweep hands over what does not fit

    def test_every_scene(self):
        refused = 0
        for value in WRONG:
            for keywords in ({"scene": value}, {"mesh": value}, {"gas": {"initial_pressure": value}},
                             {"geometry": {"particles": value}}, {"seed": value}, {"no_section": value}):
                small = {"geometry": {"particles": 100}, "render_surface": False}
                refused += self.check(f"load({keywords!r:.60})", vibe.load, **{**small, **keywords}) is not None
        self.assertGreater(refused, 5 * len(WRONG))

    def test_every_input(self):
        for word in vibe.JOINTS + vibe.BUTTONS + ("joints", "buttons", "pull", "no_word"):
            for value in WRONG:
                self.check(f"step({word}={value!r:.40})", self.simulation.step, **{word: value})
        for value in WRONG:
            self.check(f"step({value!r:.40})", self.simulation.step, value)

    def test_what_is_given_and_taken_is_named(self):
        for call, given, taken in ((lambda: self.simulation.run(float("nan")), "nan", "steps: int"),
                                   (lambda: self.simulation.step(-1), "-1", "kwargs"),
                                   (lambda: vibe.Simulation(self.model, seed=-1), "seed=-1", "seed: "),
                                   (lambda: vibe.Model(3), "Model", "vibe.load"),
                                   (lambda: vibe.Script("first.yaml"), "first.yaml", "cannot be opened"),
                                   (lambda: vibe.load(3), "'scene' is 3", "name of a file")):
            with self.assertRaises((vibe.Error, TypeError)) as refusal:
                call()
            self.assertIn(given, str(refusal.exception))
            self.assertIn(taken, str(refusal.exception))

    def test_environments(self):
        settings = {"task": "Reach", "particles": 300, "organs": SMALL["organs"], "action": "tip", "threads": 1,
                    "camera": None, "render_mode": None, "count": 1, "autoreset": "disabled", "breathing": None,
                    "pictures": ["depth"], "step_period": 0.05}
        for name in settings:
            for value in WRONG:
                for kind in (Environment, VectorEnvironment):
                    if kind is Environment and name in ("count", "autoreset"):
                        continue
                    given = {k: v for k, v in settings.items() if kind is not Environment or k not in ("count", "autoreset")}
                    given = {k: v for k, v in given.items() if kind is Environment or k != "render_mode"}
                    self.check(f"{kind.__name__}({name}={value!r:.40})", lambda: kind(**{**given, name: value}).close())
        for environment, still in ((Environment("Reach", **SMALL), np.zeros(4)),
                                   (VectorEnvironment("Reach", 2, **SMALL), np.zeros((2, 4)))):
            for value in WRONG:
                self.check(f"reset(seed={value!r:.40})", environment.reset, seed=value)
                self.check(f"reset(options={value!r:.40})", environment.reset, options=value)
            environment.reset(seed=1)
            for value in WRONG:
                self.check(f"step({value!r:.40})", environment.step, value)
            environment.reset(seed=1)
            environment.step(still)


if __name__ == "__main__":
    unittest.main()
