#!/usr/bin/env python3
"""Regressions: files that are wrong, verdicts, updates, and a changed scene that must fail."""
import contextlib
import glob
import io
import os
import re
import unittest
from unittest import mock
import xml.etree.ElementTree as ElementTree

from in_folder import InFolder

from vibe_sessions import regression, regression_units
from vibe_sessions.headless import SessionError, find_program
from vibe_sessions.regression_file import read_regression
from vibe_sessions.regression_verdict import judge, table

HERE = os.path.dirname(os.path.abspath(__file__))
SHIPPED = os.path.join(HERE, "..", "regressions")
SPHERE = "package://vibe_core/scenes/sphere.yaml"
KNOWN = {"max_force": "N", "volume": "m^3", "bites": "1", "area_reduction": "1", "lumen_area": "m^2", "time": "s",
         "pressure": "Pa", "energy_balance": "J", "events.grab": "1", "events.t-tag dropped": "1"}


def headless():
    try:
        return find_program()
    except SessionError:
        return None


class FileTest(InFolder):
    def file(self, text, name="x.regression.yaml"):
        return self.write(name, text)

    def expecting(self, lines, scene=SPHERE):
        return self.file(f"scene: {scene}\nexpect:\n" + "".join(f"  {line}\n" for line in lines.splitlines()))

    def read(self, lines):
        return read_regression(self.expecting(lines), KNOWN).expect[0]

    def refused(self, file, line, *words):
        with self.assertRaises(SessionError) as caught:
            read_regression(file, KNOWN)
        sentence = str(caught.exception)
        self.assertTrue(sentence.startswith(f"{file}:{line}: ") if line else sentence.startswith(file), sentence)
        for word in words:
            self.assertIn(word, sentence)
        self.assertNotIn("\n", sentence)


class ReadingTest(FileTest):
    def test_values_and_tolerances_are_si(self):
        e = self.read("volume: {value: 0.8 L, tolerance: 5 %}")
        self.assertAlmostEqual(e.value, 0.8e-3)
        self.assertAlmostEqual(e.low, 0.76e-3)
        self.assertAlmostEqual(e.high, 0.84e-3)
        e = self.read("pressure: {value: 10 mmHg, tolerance: 0.5 mmHg}")
        self.assertAlmostEqual(e.high, 10.5 * 133.322387415)
        e = self.read("area_reduction: {value: 6 %, tolerance: 10 %}")  # a tolerance in % is relative
        self.assertAlmostEqual(e.high, 0.066)
        e = self.read("max_force: {min: 500 mN, max: 2 N}")
        self.assertEqual((e.low, e.high), (0.5, 2))
        e = self.read("max_force: {value: 1, tolerance: 0.25}")  # plain numbers are SI
        self.assertEqual((e.low, e.high), (0.75, 1.25))

    def test_counts_are_exact(self):
        e = self.read("bites: 3")
        self.assertEqual((e.low, e.high), (3, 3))
        self.assertEqual(self.read("events.t-tag dropped: 2").value, 2)

    def test_bad_files_are_one_sentence_with_their_line(self):
        for lines, line, words in (
                ("max_forse: {value: 1 N, tolerance: 5 %}", 3, ("max_forse", "did you mean 'max_force'")),
                ("bites: 1\nmax_force: {value: 1 mm, tolerance: 5 %}", 4, ("1 mm", "is in m", "in N")),
                ("max_force: {value: 1 X, tolerance: 5 %}", 3, ("unknown unit 'X'",)),
                ("max_force: 1.2 N", 3, ("no tolerance", "{value: 1.2 N, tolerance: 5 %}")),
                ("max_force: {value: 1 N}", 3, ("no tolerance",)),
                ("max_force: {value: 1 N, tolerance: 5 s}", 3, ("5 s", "is in s")),
                ("max_force: {value: 1 N, tolerance: -5 %}", 3, ("negative",)),
                ("max_force: {value: 0 N, tolerance: 5 %}", 3, ("allows nothing",)),
                ("max_force: {valeu: 1 N, tolerance: 5 %}", 3, ("unknown key 'valeu'", "'value'")),
                ("max_force: {value: 1 N, tolerance: 5 %, max: 2 N}", 3, ("both",)),
                ("max_force: {min: 3 N, max: 2 N}", 3, ("above",)),
                ("max_force: {}", 3, ("neither",)),
                ("max_force: {value: much, tolerance: 5 %}", 3, ("'much'", "not a number")),
                ("max_force: [1, 2]", 3, ("map",)),
                ("bites: 1\nbites: 2", 4, ("twice",)),
                ("bites: 1.5", 3, ("no tolerance",)),
                ("state_hash: 12", 3, ("16 hexadecimal digits",)),
                ("{}", 3, ("empty",))):
            self.refused(self.expecting(lines), line, *words)

    def test_bad_heads_are_one_sentence_with_their_line(self):
        for text, line, words in (
                ("scene: a\nscript: none.yaml\nexpect: {bites: 1}\n", 1, ("there is no scene 'a'",)),
                (f"scene: {SPHERE}\nscript: none.yaml\nexpect: {{bites: 1}}\n", 2, ("there is no script 'none.yaml'",)),
                (f"scene: {SPHERE}\nscirpt: a\nexpect: {{bites: 1}}\n", 2, ("'scirpt'", "did you mean 'script'")),
                (f"scene: {SPHERE}\nseed: -1\nexpect: {{bites: 1}}\n", 2, ("seed '-1'",)),
                (f"scene: {SPHERE}\nduration: 3 mm\nexpect: {{bites: 1}}\n", 2, ("3 mm",)),
                (f"scene: {SPHERE}\n", 1, ("'expect' is missing",)),
                ("expect: {bites: 1}\n", 1, ("'scene' is missing",)),
                (f"scene: {SPHERE}\nexpect: {{bites: 1\n", 3, ("not YAML",)),
                (f"scene: {SPHERE}\nduration: 0 s\nexpect: {{bites: 1}}\n", 2, ("more than 0 s",)),
                (f"scene: {SPHERE}\nduration: -1 s\nexpect: {{bites: 1}}\n", 2, ("more than 0 s",)),
                (f"scene: {SPHERE}\n\x01expect: {{bites: 1}}\n", 2, ("not YAML",)),
                ("- " * 100000, None, ("nested too deeply",)),
                ("- 1\n", 1, ("map",)),
                ("", None, ("map",))):
            self.refused(self.file(text), line, *words)
        self.refused(os.path.join(self.folder, "none"), None, "cannot be read")

    def test_paths_are_relative_to_the_file(self):
        self.file("name: s\n", "scene.yaml")
        result = read_regression(self.expecting("bites: 1", scene="scene.yaml"), KNOWN)
        self.assertEqual(result.scene, os.path.join(self.folder, "scene.yaml"))


class VerdictTest(FileTest):
    def verdicts(self, lines, state_hash="0" * 16, **values):
        file = read_regression(self.expecting(lines), KNOWN)
        return judge(file, {name.replace("__", "."): (value, KNOWN[name.replace("__", ".")])
                            for name, value in values.items()}, state_hash)

    def test_says_what_moved_and_by_how_much(self):
        verdict = self.verdicts("max_force: {value: 1.2 N, tolerance: 5 %}", max_force=1.38)[0]
        self.assertFalse(verdict.passed)
        self.assertEqual(verdict.sentence(), "max_force: expected 1.2 N +- 5 %, got 1.38 N, moved by +0.18 N  +15 %  "
                                             "3 x tolerance")
        self.assertTrue(self.verdicts("max_force: {value: 1.2 N, tolerance: 5 %}", max_force=1.26)[0].passed)
        self.assertFalse(self.verdicts("max_force: {value: 1.2 N, tolerance: 5 %}", max_force=1.1399)[0].passed)

    def test_shows_the_unit_of_the_file(self):
        verdict = self.verdicts("volume: {value: 800 mL, tolerance: 8 mL}", volume=0.92e-3)[0]
        self.assertEqual((verdict.got, verdict.moved), ("920 mL", "+120 mL  +15 %  15 x tolerance"))

    def test_limits(self):
        lines = "max_force: {min: 1 N, max: 2 N}"
        self.assertEqual([self.verdicts(lines, max_force=f)[0].passed for f in (0.9, 1, 2, 2.1)],
                         [False, True, True, False])
        self.assertEqual(self.verdicts(lines, max_force=2.5)[0].moved, "+0.5 N")
        self.assertEqual(self.verdicts("max_force: {max: 2 N}", max_force=1)[0].expected, "at most 2 N")

    def test_a_measure_without_a_value_fails(self):
        verdict = self.verdicts("max_force: {min: 1 N}", max_force=None)[0]
        self.assertEqual((verdict.passed, verdict.got), (False, "no value"))

    def test_hash(self):
        lines = 'state_hash: "1f6dad6d7aa7616b"'
        self.assertTrue(self.verdicts(lines, "1f6dad6d7aa7616b")[0].passed)
        self.assertFalse(self.verdicts(lines)[0].passed)

    def test_the_table_has_a_line_per_measure(self):
        text = table(self.verdicts("bites: 3\nevents.grab: 2", bites=3, events__grab=1))
        self.assertRegex(text, r"bites +3 +3 +ok\n")
        self.assertRegex(text, r"events.grab +2 +1 +-1  -50 % +FAILED\n")

    def test_an_update_keeps_tolerances_limits_and_comments(self):
        lines = ("max_force: {value: 1.2 N, tolerance: 5 %}  # why\nbites: 3   # count\nvolume: {min: 1 L}\n"
                 'state_hash: "0000000000000000"')
        file = read_regression(self.expecting(lines), KNOWN)
        values = {"max_force": (1.38, "N"), "bites": (4, "1"), "volume": (2e-3, "m^3")}
        text = regression.updated(file, values, "f" * 16)
        self.assertEqual(text, f"scene: {SPHERE}\nexpect:\n  max_force: {{value: 1.38 N, tolerance: 5 %}}  # why\n"
                         '  bites: 4   # count\n  volume: {min: 1 L}\n  state_hash: "' + "f" * 16 + '"\n')
        self.assertEqual(len(read_regression(self.file(text), KNOWN).expect), 4)


class UnitTest(unittest.TestCase):
    def test_symbols_are_those_of_the_library(self):
        source = os.path.join(HERE, "..", "..", "vibe_core", "src", "scene", "unit.cpp")
        if not os.path.exists(source):
            self.skipTest("the sources of vibe_core are not beside these")
        with open(source, encoding="utf-8") as stream:
            rows = re.findall(r'\{"([^"]+)", ([^,]+), k(\w+)\}', stream.read())
        there = {name: (factor, dimension) for name, factor, dimension in rows}
        units = {"1": "None", "m": "Length", "m^3": "Volume", "s": "Time", "N": "Force", "Pa": "Pressure",
                 "J": "Energy"}
        for name, (factor, unit) in regression_units.SYMBOLS.items():
            self.assertEqual((factor, units[unit]), (float(there[name][0]), there[name][1]), name)
        missing = {name for name, (_, dimension) in there.items() if dimension in units.values()}
        self.assertEqual(missing, set(regression_units.SYMBOLS))

    def test_powers(self):
        self.assertAlmostEqual(regression_units.parse("60 cm^2", "m^2")[0], 60e-4)
        self.assertAlmostEqual(regression_units.parse("1 dm^3", "m^3")[0], 1e-3)
        self.assertEqual(regression_units.show(60e-4, "cm^2"), "60 cm^2")


class ShippedTest(unittest.TestCase):
    def test_each_runs_in_the_test_file(self):
        with open(os.path.join(SHIPPED, "regressions.test"), encoding="utf-8") as stream:
            listed = re.findall(r"/(\w+\.regression\.yaml)", stream.read())
        files = glob.glob(os.path.join(SHIPPED, "*.regression.yaml"))
        self.assertEqual(sorted(listed), sorted(map(os.path.basename, files)))
        self.assertGreaterEqual(len(listed), 10)


@unittest.skipUnless(headless(), "vibe_headless is not built")
class SceneTest(FileTest):
    """With the real program."""

    def call(self, *arguments):
        """(status, output, errors)"""
        said, wrong = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(wrong):
            try:
                status = regression.main(list(arguments))
            except SystemExit as end:
                status = end.code
        return status, said.getvalue(), wrong.getvalue()

    def sphere(self, modulus):
        """The shipped regression of the sphere with another stiffness."""
        self.file(f"base: {SPHERE}\ntissue:\n  young_modulus: {modulus} kPa\n", "scene.yaml")
        with open(os.path.join(SHIPPED, "sphere.regression.yaml"), encoding="utf-8") as stream:
            return self.file(stream.read().replace(SPHERE, "scene.yaml"))

    def test_a_changed_scene_fails_and_names_the_measure(self):
        status, said, _ = self.call(self.sphere(60))
        self.assertEqual(status, 0, said)
        file, xml = self.sphere(61.2), os.path.join(self.folder, "x.xml")
        status, said, _ = self.call(file, f"--gtest_output=xml:{xml}", "__name:=x")
        self.assertEqual(status, 1, said)
        self.assertRegex(said, r"max_strain .*-.* % .* x tolerance +FAILED")
        self.assertRegex(said, r"pressure .* ok")  # that of the insufflator has not moved
        suite = ElementTree.parse(xml).getroot()
        failed = [case.get("name") for case in suite if case.find("failure") is not None]
        self.assertIn("max_strain", failed)
        self.assertEqual((int(suite.get("failures")), int(suite.get("tests"))), (len(failed), len(suite)))
        self.assertEqual(self.call("--update", file)[0], 0)
        self.assertEqual(self.call(file)[0], 0)

    def test_bad_files_do_not_stop_the_others(self):
        bad = self.file(f"scene: {SPHERE}\nexpect: {{no_such: 1}}\n", "bad.yaml")
        xml = os.path.join(self.folder, "x.xml")
        good = self.file(f"scene: {SPHERE}\nduration: 0.1 s\nexpect: {{bites: 0, events.pressure reached: 0}}\n")
        status, said, wrong = self.call(bad, good, f"--gtest_output=xml:{xml}")
        self.assertEqual((status, wrong.count("\n")), (2, 1))
        self.assertIn("bad.yaml:2: unknown measure 'no_such'", wrong)
        self.assertIn("all 2 ok", said)
        self.assertEqual(ElementTree.parse(xml).getroot().get("errors"), "1")

    def test_what_the_simulator_refuses_is_one_sentence(self):
        self.file("colour: red\n", "scene.yaml")
        status, _, wrong = self.call(self.expecting("bites: 0", scene="scene.yaml"))
        self.assertEqual((status, wrong.count("\n")), (2, 1), wrong)
        self.assertIn("colour", wrong)

    def test_a_simulator_that_is_killed_is_one_sentence(self):
        program = os.path.join(self.folder, "prefix", "lib", "vibe_core", "vibe_headless")
        os.makedirs(os.path.dirname(program))
        with open(program, "w", encoding="utf-8") as stream:
            stream.write("#!/bin/sh\nkill -SEGV $$\n")
        os.chmod(program, 0o755)
        with mock.patch.dict(os.environ, CMAKE_PREFIX_PATH=os.path.join(self.folder, "prefix")):
            status, _, wrong = self.call(self.expecting("bites: 0"))
        self.assertEqual((status, wrong.count("\n")), (2, 1), wrong)
        self.assertIn("SIGSEGV", wrong)

    def test_wrong_calls(self):
        for arguments in ([], ["--no-such"]):
            status, _, wrong = self.call(*arguments)
            self.assertEqual((status, wrong.count("\n")), (2, 1))


if __name__ == "__main__":
    unittest.main()
