#!/usr/bin/env python3
"""The module vibe: the bits of the programs in C++, arrays, snapshots, forces, pictures, and what is refused."""
import ast
import copy
import gc
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy as np

import vibe

HERE = os.path.dirname(os.path.abspath(__file__))
SMALL = {"geometry": {"particles": 300}, "render_surface": False}


def headless():
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        program = os.path.join(prefix, "lib/vibe_core/vibe_headless")
        if os.access(program, os.X_OK):
            return program
    return None


class Worlds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = vibe.load(**SMALL)

    @staticmethod
    def other():
        """A simulation of another model."""
        return vibe.Simulation(vibe.load(geometry={"kind": "sphere", "particles": 100}))

    def simulation(self, **settings):
        return vibe.Simulation(self.model, **settings)

    def pressed(self):
        """The tip is driven into the wall."""
        simulation = self.simulation()
        simulation.run(200, insertion=0.3, tip_up_down=0.6, insufflate=True)
        return simulation


class BitsTest(Worlds):
    def test_hash_is_that_of_the_program(self):
        program = headless()
        if program is None:
            self.skipTest("vibe_headless is not built")
        model = vibe.load()
        for script, maker in (("demo/grabs.yaml", lambda m, f: vibe.Script(f)), ("first.yaml", vibe.Trainee)):
            file = "package://vibe_core/trainees/" + script
            said = subprocess.run([program, "--quiet", "--duration", "3", "--script", file], check=True,
                                  stdout=subprocess.PIPE, text=True).stdout
            simulation = vibe.Simulation(model)
            simulation.follow(maker(model, file), seconds=3)
            self.assertEqual(said.strip(), f"state hash: {simulation.hash():016x}", script)
            simulation.step()
            self.assertNotEqual(said.strip(), f"state hash: {simulation.hash():016x}")

    def test_calls_differ_in_nothing(self):
        one, many = self.simulation(), self.simulation(threads=2)
        for _ in range(20):
            one.step(insertion=0.05, insufflate=True)
        many.run(20, insertion=0.05, insufflate=True)
        self.assertEqual(one.hash(), many.hash())
        self.assertEqual(one.steps, 20)

    def test_inputs_stay_in_force(self):
        simulation = self.simulation()
        simulation.step(insertion=0.02, helix_grab=True)
        simulation.step(rotation=0.1)
        self.assertEqual(simulation.input["insertion"], 0.02)
        self.assertTrue(simulation.input["helix_grab"])


class ArraysTest(Worlds):
    def test_views_follow_and_outlive(self):
        simulation = self.simulation()
        x, heat, triangles = simulation.x, simulation.heat, self.model.triangles
        before = x.copy()
        simulation.run(10, insufflate=True)
        self.assertFalse(np.array_equal(before, x))
        for view, column in ((x, 0), (simulation.y, 1), (simulation.z, 2)):
            np.testing.assert_array_equal(view, simulation.positions[:, column])
        np.testing.assert_array_equal(simulation.vz, simulation.velocities[:, 2])
        last = x.copy()
        simulation.close()
        del simulation
        gc.collect()
        np.testing.assert_array_equal(last, x)
        self.assertEqual((heat.shape, heat.dtype), ((300,), np.float32))
        self.assertEqual(triangles.max(), 299)

    def test_views_cannot_be_written(self):
        for view in (self.simulation().x, self.model.triangles, self.model.region, self.model.mass):
            with self.assertRaises(ValueError):
                view[0] = 0
            with self.assertRaises(ValueError):
                view.flags.writeable = True

    def test_views_show_what_is_restored(self):
        simulation = self.simulation()
        x, start = simulation.x, simulation.snapshot()
        first = x.copy()
        simulation.run(10, insufflate=True)
        simulation.restore(start)
        np.testing.assert_array_equal(first, x)
        simulation.run(10, insufflate=True)
        simulation.reset()
        np.testing.assert_array_equal(first, x)
        simulation.step()
        np.testing.assert_array_equal(simulation.positions[:, 0], x)

    def test_normals_point_out_of_the_lumen(self):
        normals, positions = self.simulation().normals, self.model.rest_positions
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-12)
        corner = positions[self.model.triangles]
        volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6
        self.assertGreater(volume, 0)
        self.assertGreater(np.mean(np.einsum("ij,ij->i", normals, positions - positions.mean(0)) > 0), 0.8)


class SnapshotTest(Worlds):
    def test_futures_are_equal(self):
        simulation = self.pressed()
        copies = [simulation.snapshot(), simulation.snapshot(prepared=True)]
        copies.append(pickle.loads(pickle.dumps(copies[0])))
        copies.append(vibe.Snapshot(copies[0].to_bytes()))
        simulation.run(5)
        hashed = simulation.hash()
        for copy in copies:
            other = self.simulation()
            other.restore(copy)
            self.assertNotEqual(other.hash(), hashed)
            other.run(5, **{k: v for k, v in simulation.input.items() if k != "pull"})
            self.assertEqual(other.hash(), hashed)

    def test_without_impedance_the_rest_is_the_same(self):
        simulations = [self.simulation(impedance=wanted) for wanted in (True, False)]
        for simulation in simulations:
            simulation.run(100, insertion=0.3, tip_up_down=0.6, insufflate=True)
        self.assertIsNotNone(simulations[0].impedance())
        self.assertIsNone(simulations[1].impedance())
        for view in ("x", "vy", "wrench"):
            np.testing.assert_array_equal(getattr(simulations[0], view), getattr(simulations[1], view))

    def test_of_another_model_is_refused(self):
        snapshot = self.simulation().snapshot()
        other = self.other()
        hashed = other.hash()
        for wrong in (snapshot, vibe.Snapshot(b""), vibe.Snapshot(snapshot.to_bytes()[:-9])):
            with self.assertRaises(vibe.Error):
                other.restore(wrong)
        self.assertEqual(other.hash(), hashed)

    def test_of_a_scene_with_other_values_is_taken_on_request(self):
        simulation = self.pressed()
        snapshot = simulation.snapshot()
        for section, values in (("tissue", {"young_modulus": 5e4}), ("gas", {"regulated_pressure": "8 mmHg"}), ("gravity", None),
                                ("breathing", {}), ("scope", {"friction": 0.2})):
            other = vibe.Simulation(vibe.load(geometry={"particles": 300}, **{section: values}))
            hashes = set()
            for wrong in (snapshot, pickle.loads(pickle.dumps(snapshot))):
                with self.assertRaisesRegex(vibe.Error, "same organ but of a scene with other values"):
                    other.restore(wrong)
                other.restore(wrong, other_model=True)
                hashes.add(other.hash())  # not that of the simulation, whose contacts are kept for its scene only
                for view in ("positions", "velocities", "joints", "wrench", "strain", "heat", "time"):
                    np.testing.assert_array_equal(getattr(other, view), getattr(simulation, view))
            self.assertEqual(len(hashes), 1)
            other.step()
        same = vibe.Simulation(vibe.load(geometry={"particles": 300}, seed=7, name="renamed", render_surface=True))
        same.restore(snapshot)  # control
        self.assertEqual(same.hash(), simulation.hash())


class ToolTest(Worlds):
    def test_contacts_make_up_the_wrench(self):
        simulation = self.pressed()
        contacts = simulation.contacts()
        self.assertGreater(len(contacts["link"]), 0)
        force = simulation.tip_pose[:3, :3] @ simulation.wrench[:3]
        self.assertGreater(np.linalg.norm(force), 0.01)
        np.testing.assert_allclose(contacts["force"].sum(0), force, atol=1e-9)
        self.assertEqual({len(rows) for rows in contacts.values()}, {len(contacts["link"])})
        self.assertTrue(np.all(contacts["normal_force"] >= 0))
        parts = contacts["tangential_force"] - contacts["normal_force"][:, None] * contacts["normal"]
        np.testing.assert_allclose(parts, contacts["force"], atol=1e-12)

    def test_contacts_lie_on_the_wall(self):
        simulation = self.pressed()
        contacts, positions, triangles = simulation.contacts(), simulation.positions, self.model.triangles
        for k in np.flatnonzero(np.array(contacts["kind"]) == "contact"):
            nodes = contacts["nodes"][k][contacts["nodes"][k] >= 0]
            weights = contacts["weights"][k][:len(nodes)]
            np.testing.assert_allclose(weights @ positions[nodes], contacts["point"][k], atol=1e-9)
            self.assertLessEqual(set(nodes), set(triangles[contacts["triangle"][k]]))
            self.assertEqual(contacts["region"][k], self.model.region[nodes[np.argmax(weights)]])

    def test_what_belongs_to_the_last_step_goes_with_it(self):
        simulation = self.pressed()
        snapshot = simulation.snapshot()
        for replace in (simulation.reset, lambda: simulation.restore(snapshot)):
            simulation.restore(snapshot)
            simulation.step()
            self.assertGreater(len(simulation.contacts()["link"]), 0)
            self.assertIsNotNone(simulation.impedance())
            replace()
            self.assertEqual(len(simulation.contacts()["link"]), 0)
            self.assertIsNone(simulation.impedance())

    def test_walls_and_threads_are_told_on_request(self):
        simulation = self.pressed()
        hashed = simulation.hash()
        walls, threads = simulation.wall_contacts(), simulation.thread_contacts()
        self.assertEqual(walls["nodes"].shape, walls["weights"].shape)
        np.testing.assert_allclose(walls["weights"].sum(1), 0, atol=1e-9)
        self.assertEqual((threads["force"].shape, threads["bite"].shape), ((0, 3), (0,)))
        self.assertEqual(simulation.hash(), hashed)

    def test_kinematics_go_both_ways(self):
        joints = np.array([0.1, 0.3, 0.4, -0.2, 0, 0, 0])
        pose = self.model.forward_kinematics(joints)
        found = self.model.inverse_kinematics(pose[:3, 3], pose[:3, 0], np.array([0.08, 0, 0, 0, 0, 0, 0]))
        np.testing.assert_allclose(self.model.forward_kinematics(found)[:3, 3], pose[:3, 3], atol=1e-4)


class ProcedureTest(Worlds):
    def test_measures_have_units(self):
        simulation = self.pressed()
        measures, units = simulation.measures(), vibe.measure_units()
        self.assertEqual(set(measures), set(units))
        self.assertGreater(measures["max_force"], 0)
        self.assertEqual(units["max_force"], "N")

    def test_techniques_are_recognised(self):
        u = np.array([[0, 2, 0], [0, 1, 0], [0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0.0]])
        self.assertEqual(vibe.recognise_technique(u)["technique"], "u")
        self.assertEqual(vibe.recognise_technique(u[[0, 3, 6, 1, 4]])["technique"] == "u", False)

    def test_places_go_both_ways(self):
        anatomy = vibe.Anatomy(self.simulation())
        triangle, weight = anatomy.at(0.5, 0.2)
        self.assertAlmostEqual(anatomy.along(triangle, weight), 0.5, delta=0.02)
        self.assertAlmostEqual(anatomy.around(triangle, weight), 0.2, delta=0.1)


class RefusalTest(Worlds):
    def refused(self, sentence, call, *arguments, **keywords):
        with self.assertRaisesRegex(vibe.Error, sentence):
            call(*arguments, **keywords)

    def test_input(self):
        simulation = self.simulation()
        hashed = simulation.hash()
        self.refused("no input 'insert'", simulation.step, insert=0.1)
        self.refused(r"shape \(2,\).*\(7,\)", simulation.step, joints=[1, 2])
        self.refused("'insertion' is not finite", simulation.step, insertion=float("nan"))
        self.refused("'joints' holds a value that is not finite", simulation.step, joints=[np.inf] * 7)
        self.refused("'joints' is not an array of numbers", simulation.step, joints=["a"] * 7)
        self.refused("'insertion' is not a number", simulation.step, insertion="deep")
        self.refused("is a button", simulation.step, insufflate=2)
        self.refused("'pull' is not a pair", simulation.step, pull=(1, 2, 3))
        self.refused("whole number from 0 to 299", simulation.step, pull=(300, (0, 0, 0)))
        self.refused("holds one simulation twice", vibe.observe_all, [simulation, simulation])
        self.refused("'steps' is negative", simulation.run, -1)
        self.assertEqual(simulation.hash(), hashed)

    def test_a_breath_is_held_where_there_is_one(self):
        still, breathing = (vibe.Simulation(vibe.load(geometry={"particles": 100}, breathing=section)) for section in (None, {}))
        before = still.hash()
        self.refused("The scene 'stomach' does not breathe; load one with a section motion or breathing.", still.step, hold_breath=True)
        self.assertEqual(still.hash(), before)
        still.step(**still.input)  # control: not to hold it is right everywhere
        breathing.step(hold_breath=True)
        self.assertTrue(breathing.input["hold_breath"])

    def test_a_gravity_that_does_not_act_is_a_warning(self):
        left = {"geometry": {"particles": 100}, "gravity": {"acceleration": [0, 9.81, 0]}}
        with self.assertWarnsRegex(UserWarning, "set foundation.carries_weight: false") as caught:
            vibe.load(**left)
        self.assertEqual(os.path.basename(caught.filename), os.path.basename(__file__))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            vibe.load(foundation={"carries_weight": False}, **left)
            vibe.load()

    def test_scenes(self):
        self.refused("did you mean 'particles'", vibe.load, geometry={"particle": 300})
        self.refused("out of range", vibe.load, geometry={"particles": 3})
        self.refused("not finite", vibe.load, tissue={"density": float("nan")})
        self.refused("cannot be opened", vibe.load, "/nowhere.yaml")
        self.refused("give numbers, texts", vibe.load, geometry={"particles": object()})
        self.refused(r"^load\(\): tissue: is in every scene", vibe.load, tissue=None)
        self.refused(r"^load\(\): scope: is what 'helix' needs", vibe.load, scope=None)
        self.refused(os.path.join(os.getcwd(), "m.obj") + " does not exist", vibe.load,
                     geometry={"kind": "mesh", "file": "m.obj", "unit": "1 mm", "landmarks": {
                         name: [0, 0, k] for k, name in enumerate(("oesophagus", "fundus", "incisura", "pylorus"))}})
        for section in ("breathing", "gravity", "gas"):
            self.assertNotIn(f"\n{section}:", vibe.load(geometry={"particles": 300}, **{section: None}).scene)
        self.assertIn("\ngravity:", self.model.scene)  # control

    def test_a_surface_file_becomes_the_organ(self):
        model, places = self.model, 1e3 * self.model.rest_positions  # written in mm
        cardia, pylorus = (places[model.region == k][0] for k in (0, 4))
        fundus = places[model.region == 1][np.linalg.norm(places[model.region == 1] - pylorus, axis=1).argmax()]
        incisura = next(places[k] for t in model.triangles for k in t if {2, 3} <= set(model.region[t]) and model.wall[k] == 3)
        marks = {"oesophagus": cardia, "fundus": fundus, "incisura": incisura, "pylorus": pylorus}
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "organ.obj")
            np.savetxt(file, places, "v %.9g %.9g %.9g")
            with open(file, "a") as out:
                np.savetxt(out, model.triangles + 1, "f %d %d %d")
            self.refused("landmarks cannot be guessed", vibe.load, mesh=file)
            with open(file + ".landmarks.yaml", "w") as out:
                out.write("unit: 1 mm\nlandmarks: " + str({name: list(map(float, place)) for name, place in marks.items()}).replace("'", ""))
            found = vibe.load(mesh=file, **SMALL)
        self.assertEqual(found.mesh_report, "")  # nothing was guessed
        self.assertAlmostEqual(found.area.sum() / model.area.sum(), 1, delta=0.05)
        simulation = vibe.Simulation(found)
        simulation.run(5)
        self.assertAlmostEqual(simulation.volume / self.simulation().volume, 1, delta=0.02)
        self.refused("no such surface file", vibe.load, mesh=file)

    def test_closed(self):
        simulation = self.simulation()
        simulation.close()
        simulation.close()
        for call in (simulation.step, simulation.hash, simulation.snapshot, lambda: simulation.x):
            self.refused("is closed", call)

    def test_two_threads(self):
        simulation = self.simulation()
        runner = threading.Thread(target=simulation.run, args=(1000,), kwargs={"insertion": 0.1, "insufflate": True})
        runner.start()
        sentences = set()
        while runner.is_alive() and not sentences:
            try:
                simulation.hash()
            except vibe.Error as error:
                sentences.add(str(error))
        runner.join()
        self.assertIn("in use by another thread", sentences.pop())
        self.assertEqual(simulation.steps, 1000)

    def test_what_cannot_be_pickled_says_what_can(self):
        for thing, remedy in ((self.simulation(), "pickle its snapshot"), (self.model, "call vibe.load")):
            for copied in (pickle.dumps, copy.copy):
                with self.assertRaisesRegex(TypeError, remedy):
                    copied(thing)

    def test_a_trainee_of_another_model(self):
        trainee = vibe.Trainee(self.model, "name: short\ngoals:\n  - insufflate\n")
        other = self.other()
        self.refused("another model", other.follow, trainee)

    def test_after_a_fork(self):
        simulation = self.simulation()
        simulation.run(5, insufflate=True)
        child = os.fork()
        if child == 0:
            status = 1
            try:
                simulation.step()
            except vibe.Error as error:
                own = vibe.Simulation(self.model)
                own.run(5, insufflate=True)
                status = 0 if "another process" in str(error) else 2
                del own
            del simulation
            gc.collect()
            os._exit(status)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)
        simulation.step()


    def test_threads_that_step_while_the_program_ends(self):
        program = ("import threading, time, numpy as np, vibe; model = vibe.load(geometry={'particles': 300})\n"
                   "def step(s):\n  while True: s.step(); vibe.step_all([s], np.zeros((1, 7)), np.zeros((1, 6)), 40, 2); s.run(40)\n"
                   "for k in range(3): threading.Thread(target=step, args=(vibe.Simulation(model),), daemon=True).start()\n"
                   "time.sleep(0.2)")
        for _ in range(4):
            ended = subprocess.run([sys.executable, "-c", program], stderr=subprocess.PIPE, text=True, check=False, timeout=300)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_what_the_loader_says_is_a_sentence(self):
        folder = os.path.dirname(vibe.__file__)
        with tempfile.TemporaryDirectory() as place:
            shutil.copytree(folder, os.path.join(place, "second"))
            shutil.copytree(folder, os.path.join(place, "bare"), ignore=shutil.ignore_patterns("_core*"))
            interpreter = ("import _xxsubinterpreters as i, sys\n"
                           "i.run_string(i.create(), f'import sys; sys.path[:0] = {sys.path!r}; import vibe')")
            for program, sentence in (("import vibe, second", "Another copy of vibe is loaded"), ("import bare", "no module vibe._core for this"),
                                      (interpreter, "in the main interpreter of a process only")):
                made = subprocess.run([sys.executable, "-c", program], env={**os.environ, "PYTHONPATH": os.pathsep.join([place, *sys.path])},
                                      stderr=subprocess.PIPE, text=True, check=False, timeout=100)
                self.assertIn(sentence, made.stderr)
        self.assertIn("take its folder off LD_LIBRARY_PATH", vibe._unloadable(ImportError("version `GLIBCXX_3.4.30' not found")))

    def test_numpy_2_is_refused_by_a_module_that_does_not_know_it(self):
        header = "/usr/include/pybind11/detail/common.h"  # of the pybind11 that it was built with
        with open(header, encoding="utf-8") if os.path.exists(header) else tempfile.TemporaryFile("r") as file:
            version = [int(number) for number in re.findall(r"PYBIND11_VERSION_M(?:AJ|IN)OR (\d+)", file.read())]
        if not version or version >= [2, 12]:
            self.skipTest("pybind11 is not Debian 12's")
        with tempfile.TemporaryDirectory() as place:
            os.mkdir(os.path.join(place, "numpy"))
            for number, found in (("2.1.0", True), ("1.26.0", False)):
                with open(os.path.join(place, "numpy/__init__.py"), "w", encoding="utf-8") as file:
                    file.write(f"__version__ = '{number}'\n")
                made = subprocess.run([sys.executable, "-B", "-c", "import vibe"], stderr=subprocess.PIPE, text=True, check=False,
                                      env={**os.environ, "PYTHONPATH": os.pathsep.join([place, *sys.path])}, timeout=100)
                self.assertEqual("was built for numpy 1, and numpy 2.1.0 is found" in made.stderr, found, made.stderr)

    def test_an_interrupt_is_heard_within_some_steps(self):
        simulation = self.simulation()
        for call in (lambda: vibe.step_all([simulation], np.zeros((1, 7)), np.zeros((1, 6)), 10**9, 1),
                     lambda: simulation.run(10**9), lambda: [vibe.load(geometry={"particles": 1000}, seed=k) for k in range(10**6)]):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            before = signal.signal(signal.SIGALRM, signal.default_int_handler)
            try:
                with self.assertRaises(KeyboardInterrupt):
                    call()
            finally:
                signal.signal(signal.SIGALRM, before)
        simulation.step()


class StubsTest(unittest.TestCase):
    @unittest.skipIf("asan" in os.environ.get("LD_PRELOAD", ""), "a build with sanitizers makes no stubs")
    def test_stubs_tell_every_class_and_its_members(self):
        with open(os.path.join(os.path.dirname(vibe._core.__file__), "_core.pyi"), encoding="utf-8") as file:
            told = {item.name: {member.name for member in item.body if isinstance(member, ast.FunctionDef)}
                    for item in ast.parse(file.read()).body if isinstance(item, ast.ClassDef)}
        for name, thing in vars(vibe._core).items():
            if isinstance(thing, type):
                self.assertLessEqual({member for member in vars(thing) if not member.startswith("_")}, told[name], name)

    def test_everything_is_documented(self):
        for name in vibe.__all__:
            thing = getattr(vibe, name)
            members = vars(thing).items() if isinstance(thing, type) else ()
            for label, member in [("", thing)] + [(k, v) for k, v in members if not k.startswith("_")]:
                if not isinstance(member, tuple):
                    self.assertGreater(len(member.__doc__ or ""), 3, f"{name} {label}")


if __name__ == "__main__":
    unittest.main()
