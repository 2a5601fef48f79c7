#!/usr/bin/env python3
"""Whatever is handed to whatever public name, it is of the declared kind, or one sentence says what is wrong: a generated sweep,
in a process that is watched, so that a crash and a call that does not come back are named, too."""
import faulthandler
import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import vibe
from vibe.env import TASKS, Environment, Expert, GoalEnvironment, VectorEnvironment, contract, demonstrations
from vibe.env.settings import CHOICES

SMALL = {"particles": 300, "organs": [("sthenic", 1.0)]}
PATIENCE = 100  # with one call [s]
DUMPS = re.compile(r"incompatible|Invoked with|(?<!vibe)_core|\(arg\d|0x[0-9a-f]{6}|SystemError|Traceback")
SENTENCE = re.compile(r"^['A-Z<\w/?].{20,}[.)'?\w]$")
ENDLESS = []
ENDLESS.append(ENDLESS)
WRONG = [None, float("nan"), float("inf"), -1, 10**30, -1e300, 2.5, True, "", "x", "a\nb: c", "\0", "\udcff", b"\xff", [], ENDLESS,
         [float("nan")] * 3, [[1, 2], [3]], {}, {"a": {1: 2}}, {1: None}, object(), int, np.zeros((2, 0)), np.array("text"), 1j,
         np.full((7, 7), np.inf), np.array([10**400], object), lambda: 0, range(2), np.float32("nan"), np.int64(-1),
         np.datetime64("2026-01-01"), np.ones(3, [("a", float)]), memoryview(b"ab"), iter([1])]
#: numbers that may be below 0, and infinite; texts that any text may be
SIGNED, LASTING, FREE = (*vibe.JOINTS, "around"), ("seconds",), ("file",)
#: what is declared by its keyword alone
KINDS = {**dict.fromkeys(vibe.JOINTS, "float"), **dict.fromkeys((*vibe.BUTTONS, "hold_breath", "reset_mask"), "bool"),
         "pull": "Optional[tuple]", "start": "int", "phase": "int", "varied": "dict"}


def shown(value):
    try:
        return ascii(value)
    except TypeError:  # of nothing
        return type(value).__name__


def fits(kind, name, value):
    """Whether a value of WRONG may be right for an argument of this kind."""
    inner = re.sub(r"^Optional\[(.*)\]$", r"\1", kind)
    if value is None:
        return inner != kind
    if inner in ("int", "float"):
        return isinstance(value, (int, np.integer) if inner == "int" else (int, float, np.number)) and value == value and \
            (value >= 0 or name in SIGNED) and (value != np.inf or name in LASTING)
    if inner in ("bool", "bytes", "str"):
        return isinstance(value, {"bool": (bool, np.bool_), "bytes": bytes, "str": str}[inner]) and (inner != "str" or name in FREE)
    return isinstance(value, dict) and inner.lower().startswith("dict") and not value or inner.startswith("List") and isinstance(value, list) and not value


def arguments(function):
    """Name to kind, as docstring or signature has them."""
    line = (function.__doc__ or "").split("\n", 1)[0]
    found = re.findall(r"(\w+): ((?:[^,\[\]]|\[[^\]]*\])+?)( = [^,]*)?(?=, |$)", line[line.find("(") + 1:line.rfind(") ->")])
    if ") ->" not in line:  # not one of C++
        found = [(name, str(parameter.annotation), f" = {parameter.default}")
                 for name, parameter in inspect.signature(function).parameters.items() if parameter.kind is not parameter.VAR_KEYWORD]
    kinds = {name: (re.sub(r"typing\.|<class '(\w+)'>", r"\1", kind), default) for name, kind, default in found if name != "self"}
    return {name: kind if default != " = None" or "Optional" in kind else f"Optional[{kind}]" for name, (kind, default) in kinds.items()}


def forms(array):
    """The same numbers as other arrays."""
    array = np.asarray(array, float)
    wide = np.zeros([2 * n for n in array.shape])
    wide[tuple(np.s_[::2] for _ in array.shape)] = array
    fixed = array.copy()
    fixed.flags.writeable = False
    return {"big-endian": array.astype(">f8"), "strided": wide[tuple(np.s_[::2] for _ in array.shape)], "fixed": fixed,
            "Fortran": np.asfortranarray(array), "list": array.tolist(), "objects": list(array), "reversed": array[::-1][::-1]}


class Sweep:
    """Each call is told before it is made, "> CALL", and what is wrong with it after it, "! CALL: WHAT"."""

    def __init__(self, folder):
        self.calls = self.refused = 0
        os.chdir(folder)  # a wrong name of a file may be a right one
        os.environ.pop("DISPLAY", None)
        self.model = vibe.load(geometry={"particles": 300}, breathing={}, render_surface=False)
        self.simulation = vibe.Simulation(self.model)
        self.simulation.step()
        self.anatomy = vibe.Anatomy(self.simulation)
        place = self.anatomy.at(0.5, 0)
        closed = vibe.Simulation(self.model)
        closed.close()
        self.nothing = [getattr(vibe, name).__new__(getattr(vibe, name)) for name in vibe.__all__
                        if isinstance(getattr(vibe, name), type) and getattr(vibe, name) is not vibe.Error]
        self.wrong = [*WRONG, closed, *self.nothing, [self.nothing[-2]]]
        protocol = "name: short\ngoals:\n  - insufflate\n"
        self.valid = {
            "model": self.model, "simulation": self.simulation, "trainee": vibe.Trainee(self.model, protocol),
            "simulations": [self.simulation], "snapshot": self.simulation.snapshot(), "joints": np.zeros(7), "buttons": np.zeros((1, 6)),
            "steps": 1, "threads": 1, "seconds": 0.05, "file": os.path.join(folder, "state"), "name": "scope_tip",
            "along": 0.5, "around": 0.0, "triangle": place[0], "weight": place[1], "triangles": [[place[0]]],
            "weights": [[place[1]]], "bites": np.eye(3), "printed": False, "position": np.zeros(3), "direction": np.ones(3),
            "start": np.zeros(7), "width": 8, "height": 8, "field_of_view": 1.0, "normals": True, "prepared": True,
            "seed": 1, "metrics": True, "impedance": True, "protocol": protocol, "novice": 0.5, "other_model": True, "bytes": b"x",
            "scene": vibe.DEFAULT_SCENE, "size": 8, "view": "outside", "goal": np.zeros(3), "pose": np.eye(4), "lamp": 0.1,
            "colour": True, "tool": True,
        }

    def call(self, where, function, *given, takes=False, errors=(vibe.Error, TypeError, ValueError), **keywords):
        """takes: whether it may work. Returns whether it did."""
        self.calls += 1
        print(f"> {where}", flush=True)
        faulthandler.dump_traceback_later(PATIENCE, exit=True)
        try:
            function(*given, **keywords)
            if not takes:
                print(f"! {where}: nothing is said")
            return True
        except errors as error:
            text = str(error).replace("a\nb: c", "?")  # which was given
            if AttributeError not in errors and (DUMPS.search(text) or not SENTENCE.match(text)):
                print(f"! {where}: {text!r}")
        except Exception as error:  # pylint: disable=broad-except
            print(f"! {where}: {type(error).__name__}: {error}")
        finally:
            faulthandler.cancel_dump_traceback_later()
        self.refused += 1
        return False

    def each(self, where, function, valid, kinds):
        """One argument after the other is wrong, while the others are right; and too many, none, and one that there is not."""
        for name, kind in kinds.items():
            for value in self.wrong:
                self.call(f"{where}({name}={shown(value):.40})", function, takes=fits(kind, name, value), **{**valid, name: value})
        for many in ((-1,) * 9, (self.nothing[0],), (self.model,) * 20):
            self.call(f"{where}{shown(many):.60}", function, *many)
        self.call(f"{where}(surely_not=1)", function, surely_not=object(), **valid)

    def alike(self, where, function, valid):
        """Arrays of another form are the same numbers."""
        for name, value in valid.items():
            if not isinstance(value, (np.ndarray, list)) or name == "simulations":
                continue
            known = function(**valid)
            for form, other in forms(value).items():
                print(f"> {where}({name}: {form})", flush=True)
                try:
                    np.testing.assert_equal(function(**{**valid, name: other}), known)
                except Exception as error:  # pylint: disable=broad-except
                    print(f"! {where}({name}: {form}): {type(error).__name__}: {' '.join(str(error).split())}")

    def function(self, where, function, kinds=None, **valid):
        kinds = arguments(function) if kinds is None else kinds
        valid = {**{name: self.valid[name] for name in kinds if name in self.valid}, **valid}
        self.each(where, function, valid, kinds)
        if where not in ("view", "Simulation.load", "Trainee.next") and not where.startswith("Script"):
            self.alike(where, function, valid)

    # --- parts

    def functions(self):
        objects = {"Simulation": self.simulation, "Model": self.model, "Trainee": self.valid["trainee"],
                   "Snapshot": self.valid["snapshot"], "Anatomy": self.anatomy}
        self.simulation.save(self.valid["file"])
        for name in vibe.__all__:
            thing = getattr(vibe, name)
            if isinstance(thing, type) and thing is not vibe.Error:
                made = {"Script": {"file": "name: s\nsteps:\n  - {at: 0 s, insertion: 0}\n"}}.get(name, {})
                self.each(name, thing, {**{key: self.valid[key] for key in arguments(thing.__init__) if key in self.valid}, **made},
                          arguments(thing.__init__))
                self.members(name, thing, objects.get(name))
            elif callable(thing) and thing is not vibe.Error and name != "load":
                self.function(name, thing, **({"joints": np.zeros((1, 7))} if name == "step_all" else {}))

    def members(self, name, kind, found):
        for label, member in vars(kind).items():
            if isinstance(member, property):
                self.call(f"{name}.{label}.fget", member.fget, 3)
                for nothing in self.nothing:
                    self.call(f"{name}.{label} of nothing", member.fget, nothing)
            elif found is not None and not label.startswith("_") and label != "close":
                self.function(f"{name}.{label}", getattr(found, label))
                for nothing in self.nothing:
                    self.call(f"{name}.{label} of nothing", member, nothing)
        for label in ("tip_posse", "x", "triangles", "name"):
            self.call(f"{name}.{label} = 1", setattr, found, label, 1, errors=(AttributeError,))
            self.call(f"del {name}.{label}", delattr, found, label, errors=(AttributeError,))

    def closed(self):
        simulation = vibe.Simulation(self.model)
        simulation.close()
        for label, member in vars(vibe.Simulation).items():
            if not label.startswith("_") and label not in ("close", "closed"):
                valid = {} if isinstance(member, property) else {name: self.valid[name] for name in arguments(member) if name in self.valid}
                self.call(f"{label} when closed", lambda label=label, valid=valid: getattr(simulation, label)(**valid))
        for name, function in (("observe_all", vibe.observe_all), ("Anatomy", lambda them: vibe.Anatomy(them[0])),
                               ("picture", lambda them: vibe.picture(them[0]))):
            self.call(f"{name} when closed", function, [simulation])

    def lists(self):
        for wrong in (None, 7, "simulation", self.model):
            for place, rows in (("first", [wrong, self.simulation]), ("last", [self.simulation, wrong]), ("only", [wrong])):
                count = len(rows)
                for name, function, further in (("observe_all", vibe.observe_all, ()),
                                                ("wall_points", vibe.wall_points, (np.zeros((count, 1)), np.ones((count, 1, 3)))),
                                                ("step_all", vibe.step_all, (np.zeros((count, 7)), np.zeros((count, 6)), 1, 1))):
                    self.call(f"{name} of a list, {place} {shown(wrong):.40}", function, rows, *further)

    def scenes(self):
        small = {"geometry": {"particles": 100}, "render_surface": False}
        for value in self.wrong:
            for keywords, kind in (({"scene": value}, ""), ({"mesh": value}, "Optional[]"), ({"gas": {"initial_pressure": value}}, ""),
                                   ({"geometry": {"particles": value}}, ""), ({"seed": value}, "int"), ({"no_section": value}, "")):
                takes = fits(kind, "", value) or "gas" in keywords and isinstance(value, (int, float, np.integer)) and value in (-1, 2.5)
                self.call(f"load({shown(keywords):.60})", vibe.load, takes=takes, **{**small, **keywords})

    def inputs(self):
        start = self.simulation.snapshot()
        kinds = {word: KINDS.get(word, "") for word in vibe.JOINTS + vibe.BUTTONS + ("joints", "buttons", "pull", "hold_breath")}
        self.each("step", self.simulation.step, {}, kinds)
        for name, value in (("joints", np.linspace(0, 0.1, 7)), ("buttons", np.eye(6)[5])):
            hashes = set()
            for value in (value, *forms(value).values()):
                self.simulation.restore(start)
                self.simulation.step(**{name: value})
                hashes.add(self.simulation.hash())
            if len(hashes) > 1:
                print(f"! step({name}): arrays of another form are other numbers")

    def environments(self):
        picture = {"camera": (8, 8, 1.0), "pictures": ["depth"]}
        given = {"task": "Reach", **SMALL, **picture, "action": "tip", "along": (0.4, 0.5), "around": (-1, 1), "render_mode": "rgb_array"}
        for kind in (Environment, GoalEnvironment, VectorEnvironment):
            further = {"count": 2, "threads": 1} if kind is VectorEnvironment else {}
            kinds = {name: part for name, part in arguments(kind.__init__).items() if name not in ("tolerance", "scene", "vary")}
            self.each(kind.__name__, lambda *given, kind=kind, **settings: kind(*given, **settings).close(), {**given, **further}, kinds)
            environment = kind(**given, **further)
            environment.reset(seed=1)
            still = np.zeros((2, 3) if further else 3)
            known = {"seed": 1, "options": None, "action": still, "actions": still, "snapshot": environment.snapshot(),
                     "achieved_goal": np.zeros(3), "desired_goal": np.zeros((2, 3)), "info": None}
            for label, member in inspect.getmembers(kind, inspect.isfunction):
                if label.startswith("_") or member.__module__ not in ("vibe.env.environment", "vibe.env.goals") or label.startswith("close"):
                    continue
                kinds = {name: part for name, part in arguments(member).items() if name not in ("info",)}
                self.each(f"{kind.__name__}.{label}", getattr(environment, label), {name: known[name] for name in kinds}, kinds)
            self.choices(kind.__name__, environment, further)
            environment.reset(seed=1)
            environment.step(still)
            environment.close()

    def choices(self, where, environment, further):
        for name in (*CHOICES, *(["reset_mask"] if further else [])):
            for value in self.wrong:
                self.call(f"{where}.reset({name}: {shown(value):.40})", environment.reset, takes=fits(KINDS.get(name, ""), name, value),
                          options={name: value})

    def settings(self):
        """Those whose values are tried on a scene, which takes longer."""
        for name, keyword in (("tolerance", ""), ("scene", "Optional[dict]"), ("vary", "Optional[dict]")):
            for value in self.wrong:
                takes = fits("Optional[float]" if name == "tolerance" else keyword, name, value) and value not in (2.5, True)
                self.call(f"Environment({name}={shown(value):.40})", lambda **given: Environment(**SMALL, **given), takes=takes, **{name: value})
        for value in self.wrong:
            for given in ({"scene": {"gas": value}}, {"scene": {"geometry": value}}, {"vary": {"gas.regulated_pressure": value}},
                          {"vary": {"gas.regulated_pressure": ("uniform", value, 1300)}}, {"vary": {"tissue.law": ("choice", value)}}):
                takes = value is None and given == {"scene": {"gas": None}} or isinstance(value, dict) and not value and "scene" in given or \
                    isinstance(value, float) and value == 2.5 and "uniform" in str(given)
                self.call(f"Environment({shown(given):.60})", lambda given=given: Environment(**SMALL, **given), takes=takes)

    def policies(self):
        environment = Environment(**SMALL)
        environment.reset(seed=1)
        expert = Expert(environment)
        expert.reset()
        self.each("Expert", Expert, {"environment": environment}, arguments(Expert.__init__))
        self.each("Expert.action", expert.action, {}, arguments(expert.action))
        record = {"environment": environment, "policy": expert, "file": "demos.hdf5", "episodes": 1, "seed": 1}
        self.each("record", demonstrations.record, record, {**dict.fromkeys(record, ""), "file": "str"})
        for name, function in (("replay", demonstrations.replay), ("environment_of", demonstrations.environment_of)):
            self.each(name, function, {"file": "no.hdf5"}, {"file": "str"})
        self.each("broken", contract.broken, {"task": "Reach"}, {"task": "", "actions": ""})


class SweepTest(unittest.TestCase):
    def watched(self, *parts):
        """What a process says that hands over what is wrong."""
        child = subprocess.run([sys.executable, "-X", "faulthandler", os.path.abspath(__file__), "sweep", *parts], check=False,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        lines = child.stdout.splitlines()
        last = next((line for line in reversed(lines) if line.startswith("> ")), "")
        self.assertEqual(child.returncode, 0, f"{last}\n{child.stderr[-3000:]}")
        return [line for line in lines if line.startswith("! ")], list(map(int, lines[-1].split()))

    def test_whatever_is_handed_over_is_taken_as_declared_or_answered_with_a_sentence(self):
        faults, (calls, refused) = self.watched("functions", "closed", "lists", "scenes", "inputs", "environments", "settings", "policies")
        self.assertEqual(faults, [])
        self.assertGreater(calls, 5000)
        self.assertGreater(refused, 0.9 * calls)  # control: the sweep hands over what does not fit

    def test_silence_dumps_crashes_and_patience_are_told(self):
        faults, _ = self.watched("silent")
        self.assertEqual([fault.split(":")[0] for fault in faults], ["! silent", "! short", "! other"])
        for part in ("crashing", "waiting"):
            with self.assertRaisesRegex(AssertionError, f"> {part}"):
                self.watched(part)

    def test_what_is_given_and_taken_is_named(self):
        model = vibe.load(geometry={"particles": 300}, render_surface=False)
        simulation = vibe.Simulation(model)
        for call, given, taken in ((lambda: simulation.run(float("nan")), "nan", "steps: int"),
                                   (lambda: simulation.step(-1), "-1", "kwargs"),
                                   (lambda: vibe.Simulation(model, seed=-1), "seed=-1", "seed: "),
                                   (lambda: simulation.snapshot(prepared=1.0), "prepared=1.0", "prepared: bool"),
                                   (lambda: vibe.Model(3), "Model", "vibe.load"),
                                   (lambda: vibe.Simulation(vibe.Model.__new__(vibe.Model)), "vibe.Model", "by __new__"),
                                   (lambda: vibe.Script("first.yaml"), "first.yaml", "cannot be opened"),
                                   (lambda: vibe.load(3), "'scene' is 3", "name of a file")):
            with self.assertRaises((vibe.Error, TypeError)) as refusal:
                call()
            self.assertIn(given, str(refusal.exception))
            self.assertIn(taken, str(refusal.exception))


class Control(Sweep):
    """What the sweep has to tell."""

    def silent(self):
        def dump(text):
            raise ValueError(text)

        self.call("silent", int)
        self.call("short", dump, "no")
        self.call("other", lambda: {}["no"])
        self.call("right", dump, "'x' is 3; give a text instead of it.")

    def crashing(self):
        self.call("crashing", os.abort)

    def waiting(self):
        global PATIENCE  # pylint: disable=global-statement
        PATIENCE = 0.5
        self.call("waiting", __import__("time").sleep, 100)


if __name__ == "__main__":
    if sys.argv[1:2] == ["sweep"]:
        with tempfile.TemporaryDirectory() as place:
            sweep = Control(place)
            for part in sys.argv[2:]:
                getattr(sweep, part)()
            os.chdir("/")
        print(sweep.calls, sweep.refused)
    else:
        unittest.main()
