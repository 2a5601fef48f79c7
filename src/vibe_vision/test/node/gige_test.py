#!/usr/bin/env python3
"""vision_node with a GigE Vision camera in software: packets, positions, latency, and a camera that goes and comes."""

import csv
import os
import tempfile
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from vibe_msgs.msg import InstrumentTrack, InstrumentTrackArray
from vibe_testing.diagnostics import Diagnostics
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

ADDRESS = "127.0.0.1"
OK, WARN, ERROR = 0, 1, 2


class GigeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="vibe_vision_")
        cls.config = os.path.join(cls.folder, "config.yaml")
        cls.truth = os.path.join(cls.folder, "truth.csv")
        cls.tracking = Recorder("suturing_device/tracking", InstrumentTrackArray)
        cls.diagnostics = Diagnostics(Recorder("/diagnostics", DiagnosticArray), "camera")

    def setUp(self):
        for file in (self.config, self.truth):
            if os.path.exists(file):
                os.remove(file)
        self.tracking.clear()
        self.camera = self.start_camera()
        self.assertTrue(wait_until(lambda: os.path.exists(self.config), 60), self.camera.output())
        self.node = Program("vibe_vision", "vision_node", name="vision_node", config=self.config, source="gige:" + ADDRESS)

    def tearDown(self):
        self.node.stop()
        self.camera.stop()

    def start_camera(self):
        arguments = ["--address", ADDRESS, "--frames", "60", "--truth", self.truth, "--config", self.config]
        return Program("vibe_vision", "vibe_fake_camera", *arguments)

    def follows(self, begin=0.0):
        """Whether frames come in which both are tracked, stamped after a time."""

        def tracked():
            messages = [m for m in self.tracking.messages if m.exposure > 0 and m.header.stamp.to_sec() > begin]
            return sum(all(track.tracked for track in m.instruments) for m in messages) > 50

        return wait_until(tracked, 60)

    def test_positions_and_stages(self):
        self.assertTrue(self.follows(), self.node.output() + self.camera.output())
        arrivals = [(time, m) for time, m in self.tracking.arrivals if m.exposure > 0]
        for arrival, message in arrivals:
            self.assertLess(message.header.stamp.to_sec(), arrival)
            self.assertGreater(message.transport, 0)  # half the exposure is in it
            self.assertLess(message.track, 1)
        self.node.stop()
        self.camera.stop()
        with open(self.truth) as file:
            rows = [row for row in csv.DictReader(file) if row["instrument"] == "needle_driver"]
        truth = sorted((float(row["stamp"]), float(row["slide"])) for row in rows)
        errors, stamps = [], []
        for _, message in arrivals:
            track = message.instruments[1]
            stamp, slide = min(truth, key=lambda row: abs(row[0] - message.header.stamp.to_sec()))
            stamps.append(message.header.stamp.to_sec() - stamp)
            if track.tracked:
                errors.append(abs(track.slide - slide))
        self.assertLess(sorted(errors)[len(errors) // 2], 2e-6)
        self.assertLess(abs(sorted(stamps)[len(stamps) // 2]), 1e-3)

    def test_a_camera_that_goes_and_comes_back(self):
        self.assertTrue(self.follows(), self.node.output() + self.camera.output())
        self.camera.kill()
        gone = time.time()
        silent = self.tracking.waits_for(lambda m: m.header.stamp.to_sec() > gone and m.exposure == 0)
        self.assertIsNotNone(silent)
        self.assertEqual([track.reason for track in silent.instruments], [InstrumentTrack.NO_FRAME] * 2)
        entry = self.diagnostics.waits_for(lambda level, text, _: level == ERROR and "no images" in text)
        self.assertIsNotNone(entry, self.diagnostics.newest())
        self.camera = self.start_camera()
        self.assertTrue(self.follows(time.time()), self.node.output())
        entry = self.diagnostics.waits_for(lambda level, _, values: int(values["reconnects"]) > 0)
        self.assertIsNotNone(entry, self.diagnostics.newest())
        stamps = [m.header.stamp.to_nsec() for m in self.tracking.messages]
        self.assertEqual(stamps, sorted(set(stamps)))


if __name__ == "__main__":
    rospy.init_node("gige_test")
    rostest.rosrun("vibe_vision", "gige", GigeTest)
