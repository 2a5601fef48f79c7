#!/usr/bin/env python3
"""The age of positions whose delay is known, and deadlines of steps whose times are."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
from vibe_latency.motion import Motion
from vibe_latency.tables import Measurement, TableError

MS = 1_000_000  # [ns]
START = 1_700_000_000_000_000_000
REPORT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../programs/latency_report")


def position(seconds):
    return 0.010 - 0.008 * numpy.cos(2 * numpy.pi * 1.5 * seconds)


def write(folder, name, columns, rows):
    with open(os.path.join(folder, name + ".csv"), "w", encoding="ascii") as file:
        file.write(columns + "\n")
        file.writelines(",".join(str(value) for value in row) + "\n" for row in rows)


def write_session(folder, age, noise=0.0, seconds=12.0):
    """Steps at 100 Hz whose published positions are those of the hand `age` [s] before."""
    random = numpy.random.default_rng(1)
    truth = [(k, "{:.9f}".format(1e-9 * START + t), "helix", position(t)) for k, t in enumerate(numpy.arange(0, seconds, 1 / 147))]
    truth += [(0, 1e-9 * START, "needle_driver", 7.0)]
    used, step = [], []
    for k in range(int(100 * seconds)):
        published = START + k * 10 * MS
        seen = position(1e-9 * (published - START) - age) + noise * random.standard_normal()
        used.append((published, published, k, seen))
        step.append((published, published, k, published - 6 * MS, published - 5 * MS, published - MS, published))
    write(folder, "truth", "sequence,stamp,instrument,slide", truth)
    write(folder, "input", "wall,stamp,step,position", used)
    write(folder, "step", "wall,stamp,step,due,begin,solved,published", step)
    write_setup(folder, "sway")


def write_setup(folder, mode, **more):
    setup = dict({"title": "test", "mode": mode, "periods": {"step": 0.01}}, **more)
    with open(os.path.join(folder, "setup.json"), "w", encoding="utf-8") as file:
        json.dump(setup, file)


def numbers_of(age, noise=0.0):
    with tempfile.TemporaryDirectory() as folder:
        write_session(folder, age, noise)
        return Motion(Measurement(folder)).numbers()


class Age(unittest.TestCase):
    def test_is_found_to_the_resolution(self):
        for age in (0.0, 0.011, 0.043, -0.006):
            numbers = numbers_of(age)
            self.assertAlmostEqual(numbers["age"], age, delta=2e-4)
            self.assertLess(numbers["error at age"], 3e-5)

    def test_error_at_once_is_speed_times_age(self):
        speed = 0.008 * 2 * numpy.pi * 1.5  # of the peak [m/s]
        numbers = numbers_of(0.010)
        self.assertAlmostEqual(numbers["error at once"], 0.010 * speed / numpy.sqrt(2), delta=2e-5)
        self.assertAlmostEqual(numbers["max at once"], 0.010 * speed, delta=3e-5)
        self.assertLess(numbers_of(0.0)["error at once"], 3e-5)

    def test_noise_is_an_error_and_no_age(self):
        numbers = numbers_of(0.020, noise=1e-4)
        self.assertAlmostEqual(numbers["age"], 0.020, delta=1e-3)
        self.assertAlmostEqual(numbers["error at age"], 1e-4, delta=2e-5)

    def test_pauses_of_the_camera_do_not_count(self):
        with tempfile.TemporaryDirectory() as folder:
            write_session(folder, 0.012)
            with open(os.path.join(folder, "truth.csv"), encoding="ascii") as file:
                rows = file.readlines()
            with open(os.path.join(folder, "truth.csv"), "w", encoding="ascii") as file:
                file.writelines(rows[:600] + rows[615:])  # 0.1 s
            numbers = Motion(Measurement(folder)).numbers()
            self.assertAlmostEqual(numbers["age"], 0.012, delta=2e-4)
            self.assertLess(numbers["error at age"], 3e-5)
            self.assertAlmostEqual(numbers["left out"], 16, delta=2)
            self.assertEqual(numbers_of(0.012)["left out"], 0)

    def test_a_wrong_truth_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            write_session(folder, 0.01)
            write(folder, "truth", "sequence,stamp,instrument,slide", [(0, 1.0, "needle_driver", 0.0)])
            with self.assertRaisesRegex(TableError, "no two positions of the helix"):
                Measurement(folder)
            write(folder, "truth", "sequence,stamp", [(0, 1.0)])
            with self.assertRaisesRegex(TableError, "no table of true positions"):
                Measurement(folder)

    def test_an_unknown_mode_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            write_setup(folder, "dance")
            with self.assertRaisesRegex(TableError, "mode 'dance'"):
                Measurement(folder)


class Report(unittest.TestCase):
    def run_report(self, folder):
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
        return subprocess.run(
            [sys.executable, REPORT, folder], capture_output=True, text=True, check=False, env=environment
        )

    def numbers(self, folder):
        result = self.run_report(folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(os.path.getsize(os.path.join(folder, "latency.png")), 10000)
        with open(os.path.join(folder, "latency.json"), encoding="utf-8") as file:
            return json.load(file)

    def test_of_a_motion(self):
        with tempfile.TemporaryDirectory() as folder:
            write_session(folder, 0.012)
            self.assertAlmostEqual(self.numbers(folder)["motion"]["age"], 0.012, delta=2e-4)

    def test_of_steps_leaves_out_the_warm_up(self):
        with tempfile.TemporaryDirectory() as folder:
            rows = []
            for k in range(1000):
                due = START + k * 10 * MS
                late = 15 * MS if k < 100 or k % 100 == 0 else 0  # in the warm-up all, then one in a hundred
                rows.append((due, due, k, due, due + late, due + late + 3 * MS, due + late + 4 * MS))
            write(folder, "step", "wall,stamp,step,due,begin,solved,published", rows)
            write_setup(folder, "steps", **{"from": START + 1000 * MS})
            steps = self.numbers(folder)["steps"]
            self.assertEqual(steps["count"], 900)
            self.assertEqual(steps["missed"], 9)
            self.assertAlmostEqual(steps["step"]["p50"], 0.004, delta=1e-9)
            self.assertAlmostEqual(steps["late begin"]["max"], 0.015, delta=1e-6)

    def test_of_no_steps_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, "step", "wall,stamp,step,due,begin,solved,published", [])
            write_setup(folder, "steps")
            result = self.run_report(folder)
            self.assertEqual(result.returncode, 1)
            self.assertIn("has no steps", result.stderr)


if __name__ == "__main__":
    unittest.main()
