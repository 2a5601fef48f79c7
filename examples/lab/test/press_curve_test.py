#!/usr/bin/env python3
"""The program of the lab reads its file, finds its scene and presses."""

import subprocess
import unittest

import rospkg
import rostest

FOLDER = rospkg.RosPack().get_path("vibe_example_lab")


def run(study):
    return subprocess.run(["rosrun", "vibe_example_lab", "press_curve", study], capture_output=True, text=True, check=False)


class PressCurveTest(unittest.TestCase):
    def test_the_force_grows(self):
        done = run(FOLDER + "/test/study.yaml")
        self.assertEqual(done.returncode, 0, done.stderr)
        forces = [float(line.split()[2]) for line in done.stdout.splitlines() if " m " in line]
        self.assertGreater(len(forces), 5)
        self.assertEqual(forces, sorted(forces))
        self.assertGreater(forces[-1], 0.1)

    def test_a_file_that_is_not_there_is_named(self):
        done = run("/nowhere.yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("/nowhere.yaml", done.stderr)


if __name__ == "__main__":
    rostest.rosrun("vibe_example_lab", "press_curve", PressCurveTest)
