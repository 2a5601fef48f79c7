"""The numbers of a report against known ones: the tip goes round on a circle, the force is a half sine."""

import json
import math
import os
import struct
import unittest
from unittest import mock

import rosbag
from in_folder import InFolder
from report_bags import RADIUS, SyntheticSession

from vibe_sessions.report.bag_file import Connection
from vibe_sessions.report.curves import speeds_of
from vibe_sessions.report.drawing import POINTS, envelope, spans_of
from vibe_sessions.report.message_types import StepReader
from vibe_sessions.report.numbers import numbers_of, row_of
from vibe_sessions.report.recording import read_recording
from vibe_sessions.report.references import REFERENCES, verdict
from vibe_sessions.report.tables import coverage_rows

import numpy


class NumbersTest(InFolder):
    def read(self, **options):
        path = SyntheticSession(os.path.join(self.folder, "session.bag"), **options).write()
        recording = read_recording(path)
        return recording, numbers_of(recording)

    def test_path_and_force_at_either_rate(self):
        for rate, count in ((60, 600), (10, 100)):
            recording, numbers = self.read(duration=10, rate=rate)
            self.assertEqual(len(recording.tip_path()), count)
            # two turns less one sample, as a polygon
            arc = 2 * math.pi * RADIUS * (2 - 1 / (5 * rate))
            self.assertAlmostEqual(numbers["measures"]["recorded_path_length"], arc, delta=2e-4 * arc * 60 / rate)
            self.assertAlmostEqual(numbers["measures"]["recorded_max_force"], 6.0, delta=0.01)
            speeds = speeds_of(recording.tip_path())[1]
            self.assertAlmostEqual(float(numpy.median(speeds)), 2 * math.pi * RADIUS / 5, places=4)

    def test_session(self):
        _, numbers = self.read(duration=2)
        session = numbers["session"]
        self.assertEqual((session["scene"], session["seed"], session["steps"]), ("test", 3, 120))
        self.assertEqual((session["time_source"], session["skill"]), ("simulated", "expert"))
        self.assertAlmostEqual(session["duration"], 2.0, places=6)
        self.assertEqual(numbers["goals"], {"given": 2, "reached": 1, "failed": 1})
        self.assertEqual(numbers["events"], {"WARNING": 1})
        self.assertEqual(session["recording"], "compact")
        self.assertIsNone(session["version"])  # no session_info

    def test_measures(self):
        _, numbers = self.read(duration=2, metrics={"time_above": 0.5})
        measures = numbers["measures"]
        self.assertEqual(measures["max_force"], 6.0)
        self.assertIsNone(measures["log_dimensionless_jerk"])  # NaN in the message
        self.assertAlmostEqual(measures["share_above"], 0.25)
        self.assertEqual(measures["bites_per_set"], 2)
        self.assertEqual(measures["bites_per_5_min"], 5)  # one further bite in a minute

    def test_coverage(self):
        _, numbers = self.read(duration=2)
        self.assertEqual((numbers["measures"]["coverage"], coverage_rows(numbers)), (None, []))
        region, wall = [0.1, 0.4, 0.9, 0.8, math.nan], [0.5, 0.6, 0.7, 0.55]
        _, numbers = self.read(duration=2, metrics={"coverage": 0.62, "coverage_region": region, "coverage_wall": wall})
        self.assertEqual(numbers["measures"]["coverage"], 0.62)
        rows = coverage_rows(numbers)
        self.assertEqual((rows[0], rows[-1], len(rows)), (("cardia", "10.0"), ("body", "90.0"), 8))
        self.assertIn(("greater curvature", "60.0"), rows)

    def test_set(self):
        _, numbers = self.read(duration=2)
        (each,) = numbers["sets"]
        self.assertEqual((each["technique"], each["bites"], each["full_thickness"]), ("u", 2, 1))
        self.assertEqual((each["stage"], each["cinch_tension"], each["time"]), ("cinched", 3.0, 79.0))
        self.assertAlmostEqual(each["spacing_mean"], 0.025)

    def test_a_whole_recording_has_no_gaps(self):
        _, numbers = self.read(duration=2)
        dropped = numbers["dropped"]
        self.assertEqual([dropped[k] for k in ("missing_steps", "gaps", "restarts", "lost_inputs")], [0, 0, 0, 0])
        self.assertEqual(dropped["steps_without_hash"], 0)

    def test_missing_steps(self):
        _, numbers = self.read(duration=2, skip_steps=(10, 11, 12, 50))
        self.assertEqual((numbers["dropped"]["missing_steps"], numbers["dropped"]["gaps"]), (4, 2))
        self.assertTrue(any("4 steps are missing in 2 gaps" in text for text in numbers["warnings"]))

    def test_a_reset_and_a_loaded_state_are_no_gaps(self):
        path = os.path.join(self.folder, "session.bag")
        session = SyntheticSession(path, duration=1)
        with rosbag.Bag(path, "w") as session.bag:
            session._begin()
            for session.run, steps in ((1, range(60)), (2, range(10)), (3, range(500, 520))):
                for step in steps:
                    session._step(step)
            session._end(20.0)
        recording = read_recording(path)
        dropped = numbers_of(recording)["dropped"]
        self.assertEqual((dropped["missing_steps"], dropped["restarts"]), (0, 2))

    def test_where_a_reset_moves_the_tip_it_has_not_gone(self):
        path = os.path.join(self.folder, "session.bag")
        session = SyntheticSession(path, duration=4)
        with rosbag.Bag(path, "w") as session.bag:
            session._begin()
            for session.run, steps in ((1, range(60)), (2, range(150, 210))):  # a third of a turn later
                for step in steps:
                    session._step(step)
            session._end(20.0)
        recording = read_recording(path)
        arc = 2 * math.pi * RADIUS * 2 * (1 - 1 / 60) / 5
        self.assertAlmostEqual(numbers_of(recording)["measures"]["recorded_path_length"], arc, delta=1e-3 * arc)
        self.assertAlmostEqual(float(numpy.nanmax(speeds_of(recording.tip_path(), recording.resets())[1])), 2 * math.pi * RADIUS / 5, places=4)

    def test_steps_without_hash(self):
        _, numbers = self.read(duration=1, unhashed=(3, 4, 5))
        self.assertEqual(numbers["dropped"]["steps_without_hash"], 3)
        old = Connection("/applied_input", "vibe_msgs/StepInput", "", "Header header\nuint64 step\nuint32 version\n", "")
        reader = StepReader(old)
        self.assertFalse(reader.has_hash)
        self.assertEqual(reader.read(struct.pack("<IIII3sQI", 1, 2, 3, 3, b"abc", 77, 2)), (2_000_000_003, 77, 0, 0))

    def test_thinned(self):
        _, numbers = self.read(duration=4, rate=10)
        self.assertAlmostEqual(numbers["dropped"]["thinned"]["scope/measured_cp"], 10, delta=0.01)
        _, numbers = self.read(duration=4, rate=60)
        self.assertNotIn("scope/measured_cp", numbers["dropped"]["thinned"])

    def test_delays_and_lost_inputs_in_wall_time(self):
        recording, numbers = self.read(duration=3, origin=1.7e9, delay=0.035, lose_every=10)
        self.assertFalse(recording.is_simulated_time)
        delay = numbers["latency"]["/scope/input/joint_states"]
        self.assertAlmostEqual(delay["p50"], 0.035, places=6)
        self.assertEqual(delay["messages"], 162)
        self.assertEqual(numbers["dropped"]["lost_inputs"], 17)  # of 18: nothing follows the last
        self.assertEqual(numbers["session"]["driver"], "gamepad_node")

    def test_who_drives_in_rviz_is_the_keyboard(self):
        for caller, shown in (("/rviz_1795891871594679402", "keyboard"), ("/rviz", "keyboard"), ("/left/rviz_1", "left/keyboard"),
                              ("/rviz_2_node", "rviz_2_node"), ("/web_node", "web_node")):  # fmt: skip
            self.assertEqual(self.read(duration=0.1, origin=1.7e9, caller=caller)[1]["session"]["driver"], shown)

    def test_no_delays_in_simulated_time(self):
        self.assertEqual(self.read(duration=1)[1]["latency"], {})

    def test_solver_without_a_message_about_the_whole(self):
        _, numbers = self.read(duration=4)
        solver = numbers["solver"]
        self.assertIs(solver["whole"], False)
        self.assertAlmostEqual(solver["step_p50"], 0.003)
        self.assertAlmostEqual(solver["real_time_factor"], 1.5)
        self.assertEqual(list(solver["stages"]), ["energy", "paths"])
        self.assertAlmostEqual(solver["stages"]["energy"]["time_p99"], 0.003)
        self.assertEqual(solver["missed_deadlines"], 8)

    def test_the_message_about_the_whole_is_not_counted_twice(self):
        # the simulator counts 2 missed deadlines in each message of these sessions
        for windows, whole, missed in (((1, 1, 1, 3), True, 2), ((1, 1, 1, 1), False, 8), ((1, 1.5), True, 2),
                                       ((1, 1.1), False, 4), ((1,), False, 2)):  # fmt: skip
            solver = self.read(duration=1, windows=windows)[1]["solver"]
            self.assertEqual((solver["whole"], solver["missed_deadlines"]), (whole, missed), windows)

    def test_values_that_are_not_finite_are_empty(self):
        _, numbers = self.read(duration=5, broken_sensor=True)
        self.assertIsNone(numbers["solver"]["step_max"])
        self.assertAlmostEqual(numbers["measures"]["recorded_max_force"], 6.0, delta=0.01)  # of the samples before
        json.dumps(numbers, allow_nan=False)

    def test_the_largest_tension_is_that_of_all_messages(self):
        with mock.patch("vibe_sessions.report.recording.SAMPLES", 2):
            recording, numbers = self.read(duration=10, peak={6: 99.0})
        self.assertNotIn(99.0, [tension for _, row in recording.tensions for tension in row])  # the picture has not all
        self.assertEqual(numbers["measures"]["recorded_max_tension"], 99.0)

    def test_phases(self):
        recording, numbers = self.read(duration=10)
        spans = spans_of(recording)
        self.assertEqual([span[0] for span in spans], ["inspect", "suture"])
        self.assertAlmostEqual(spans[-1][2], 10.0, places=3)
        self.assertEqual([phase["phase"] for phase in numbers["phases"]], ["inspect", "mark", "suture", "pull", "done"])

    def test_without_metrics_pose_and_tissue(self):
        missing = ("procedure/skill_metrics", "scope/measured_cp", "scope/measured_cf", "tissue/particles", "sutures")
        _, numbers = self.read(duration=1, without=missing)
        self.assertIsNone(numbers["measures"]["recorded_path_length"])
        self.assertEqual(numbers["sets"], [])
        self.assertTrue(any("skill_metrics" in text for text in numbers["warnings"]))

    def test_the_row_is_flat(self):
        _, numbers = self.read(duration=1)
        row = row_of(numbers, "a", "b")
        self.assertTrue(all(not isinstance(value, (dict, list)) for value in row.values()))
        self.assertEqual((row["name"], row["group"], row["max_force"], row["dropped_missing_steps"]), ("a", "b", 6.0, 0))


class SmallPartsTest(unittest.TestCase):
    def test_envelope_keeps_the_extremes(self):
        times = numpy.arange(100000.0)
        values = numpy.sin(times)
        values[54321] = 7.0
        kept = envelope(times, values)
        self.assertLessEqual(len(kept[0]), POINTS + 2)
        self.assertEqual(kept[1].max(), 7.0)
        self.assertEqual((kept[0][0], kept[0][-1]), (0.0, 99999.0))

    def test_verdicts(self):
        force = next(each for each in REFERENCES if each.measure == "max_force")
        self.assertEqual([verdict(force, value) for value in (None, 7.9, 8.1)], ["", "within", "outside"])
        jerk = next(each for each in REFERENCES if each.measure == "log_dimensionless_jerk")
        self.assertEqual(verdict(jerk, -10), "")
        self.assertTrue(all(each.source for each in REFERENCES))


if __name__ == "__main__":
    unittest.main()
