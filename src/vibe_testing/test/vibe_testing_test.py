#!/usr/bin/env python3
"""Programs, waiting and diagnostics, without a ROS master."""

import os
import signal
import sys
import time
import unittest
from types import SimpleNamespace

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "src"))

from vibe_testing.diagnostics import Diagnostics
from vibe_testing.program import Program, find_program
from vibe_testing.wait import wait_until


def shell(code, **settings):
    return Program("dash", "sh", "-c", code, **settings)


def entry(name, level, **values):
    values = [SimpleNamespace(key=key, value=value) for key, value in values.items()]
    return SimpleNamespace(status=[SimpleNamespace(name=name, level=level, message="text", values=values)])


class TestingTest(unittest.TestCase):
    def test_waiting_ends_in_time(self):
        begin = time.monotonic()
        self.assertTrue(wait_until(lambda: time.monotonic() > begin + 0.1))
        self.assertFalse(wait_until(lambda: False, 0.2))
        self.assertLess(time.monotonic() - begin, 10)

    def test_output_and_status_of_a_program(self):
        program = shell("echo one; echo two one >&2; exit 3")
        self.assertTrue(program.says("two"))
        self.assertEqual(program.ends(), 3)
        self.assertEqual((program.output(), program.count("one")), ("one\ntwo one", 2))
        self.assertEqual(program.stop(), 3)
        self.assertFalse(program.says("three", 0.1))

    def test_a_program_is_stopped_or_killed(self):
        self.assertEqual(shell("exec sleep 100").stop(), -signal.SIGINT)
        stubborn = shell("trap '' INT; echo deaf; exec sleep 100")
        self.assertTrue(stubborn.says("deaf"))
        stubborn.send(signal.SIGINT)
        self.assertIsNone(stubborn.ends(0.2))
        self.assertTrue(stubborn.is_running())
        self.assertEqual(stubborn.kill(), -signal.SIGKILL)

    def test_variables_are_added_and_taken_away(self):
        program = shell('echo "<$ADDED$HOME>"', env={"ADDED": "x", "HOME": None})
        self.assertEqual(program.ends(), 0)
        self.assertEqual(program.lines, ["<x>"])

    def test_a_program_that_is_missing_has_a_sentence(self):
        with self.assertRaisesRegex(FileNotFoundError, "no_such_program of vibe_nowhere is not built"):
            find_program("vibe_nowhere", "no_such_program")

    def test_newest_diagnostics_of_a_name(self):
        recorder = SimpleNamespace(arrivals=[(1.0, entry("node: camera", 0, rate="5")), (2.0, entry("node: camera", 1)),
                                             (3.0, entry("node: helix", 2))])  # fmt: skip
        camera = Diagnostics(recorder, "camera")
        self.assertEqual(camera.newest(), (1, "text", {}))
        self.assertEqual(camera.newest(after=2.0), (None, "", {}))
        del recorder.arrivals[1]
        self.assertEqual(camera.waits_for_newer(), (0, "text", {"rate": "5"}))
        self.assertIsNone(camera.waits_for(lambda *_: True, 0.1))


if __name__ == "__main__":
    unittest.main()
