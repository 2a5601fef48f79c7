#!/usr/bin/env python3
"""Several sessions in one recording: a simulator that was started again, two in namespaces, and what tells them apart."""

import os
import shutil
import tempfile
import unittest

import rosbag
from report_bags import SyntheticSession
from vibe_msgs.msg import SessionInfo

from vibe_sessions.report.bag_file import BagError, BagFile
from vibe_sessions.report.health import warnings_of
from vibe_sessions.report.numbers import numbers_of
from vibe_sessions.report.recording import read_recording
from vibe_sessions.report.sessions import list_sessions

FIRST, SECOND = 0x1111222233334444, 0xAAAABBBBCCCCDDDD


class SessionsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.path = os.path.join(self.folder, "session.bag")

    def write(self, *sessions):
        """One after the other, as they were received; each is of 1 s, 2 s and so on."""
        with rosbag.Bag(self.path, "w", chunk_threshold=4096) as bag:
            for count, options in enumerate(sessions, 1):
                session = SyntheticSession("", duration=count, metrics={"path_length": count}, **options)
                session.bag = bag
                if session.identity:
                    info = SessionInfo(session=session.identity, run=1, scene="name: s{}\n".format(count))
                    session.put("session_info", info, session.origin)
                session._begin()
                for step in range(60 * count):
                    session._step(step)
                session._end(session.origin + count)

    def check(self, recording, count):
        self.assertEqual(len(recording.steps), 60 * count)
        self.assertEqual(list(recording.steps), list(range(60 * count)))
        self.assertEqual(recording.skill.path_length, count)
        self.assertEqual(recording.count("scope/measured_cp"), 60 * count)
        self.assertAlmostEqual(recording.duration(), count, places=6)
        numbers = numbers_of(recording)
        self.assertEqual((numbers["dropped"]["restarts"], numbers["dropped"]["missing_steps"]), (0, 0))
        return numbers

    def problem_of(self, **choice):
        with self.assertRaises(BagError) as caught:
            read_recording(self.path, **choice)
        return str(caught.exception)

    def test_a_simulator_that_was_started_again(self):
        for origins in ((1, 1), (1e9, 1e9 + 20)):  # simulated time begins anew, wall time does not
            self.write({"identity": FIRST, "origin": origins[0]}, {"identity": SECOND, "origin": origins[1]})
            first = read_recording(self.path)
            self.assertEqual(self.check(first, 1)["session"]["identity"], "1111222233334444")
            self.assertEqual(first.scene, "name: s1\n")
            self.assertIn("holds 2 sessions; this is number 1 (1111222233334444 in /)", warnings_of(first)[0])
            for choice in ("2", "aaaa", "aaaabbbbccccdddd"):
                second = read_recording(self.path, session=choice)
                self.check(second, 2)
                self.assertEqual((second.identity, second.scene), (SECOND, "name: s2\n"))
                self.assertIsNotNone(second.topology)
            self.check(read_recording(self.path, session="1111"), 1)
            self.assertIn("no session '3', but 1 (1111222233334444 in /), 2 (aaaa", self.problem_of(session="3"))

    def test_namespaces(self):
        self.write({"identity": FIRST, "namespace": "/left"}, {"identity": SECOND, "namespace": "/right"})
        self.check(read_recording(self.path), 1)
        for namespace in ("right", "/right", "/right/"):
            self.check(read_recording(self.path, namespace), 2)
        self.check(read_recording(self.path, session="2"), 2)
        self.assertIn("has no session in '/middle', but in '/left', '/right'", self.problem_of(namespace="/middle"))
        self.assertIn("no session '2' in '/left'", self.problem_of(namespace="left", session="2"))

    def test_of_a_release_without_identities(self):
        self.write({}, {})
        first = read_recording(self.path)
        self.check(first, 1)
        self.assertIn("number 1 (without identity in /)", warnings_of(first)[0])
        self.check(read_recording(self.path, session="2"), 2)
        with BagFile(self.path) as bag:
            self.assertEqual([session.steps for session in list_sessions(bag)], [60, 120])

    def test_one_session_says_nothing_of_others(self):
        self.write({"identity": FIRST})
        self.assertEqual(read_recording(self.path).remark, "")
        self.check(read_recording(self.path, session="1"), 1)

    def sort(self):
        """By the times of the messages, as tools that merge or filter recordings do."""
        copy = os.path.join(self.folder, "copy.bag")
        with rosbag.Bag(self.path) as source, rosbag.Bag(copy, "w") as target:
            for topic, message, stamp in sorted(source.read_messages(), key=lambda each: each[2]):
                target.write(topic, message, stamp)
        self.path = copy

    def test_namespaces_that_were_sorted_by_simulated_time(self):
        self.write({"identity": FIRST, "namespace": "/left"}, {"identity": SECOND, "namespace": "/right"})
        self.sort()
        self.check(read_recording(self.path), 1)
        second = read_recording(self.path, session="2")
        self.check(second, 2)
        self.assertNotIn("in turns", second.remark)

    def test_sessions_in_turns_with_the_same_stamps(self):
        self.write({"identity": FIRST}, {"identity": SECOND})
        self.sort()
        for choice, count, identity in ((None, 1, FIRST), ("2", 2, SECOND), ("aaaa", 2, SECOND)):
            recording = read_recording(self.path, session=choice)
            self.assertEqual(list(recording.steps), list(range(60 * count)))
            self.assertEqual((recording.identity, recording.scene), (identity, "name: s{}\n".format(count)))
            self.assertIn("come in turns", warnings_of(recording)[0])
            self.assertEqual(numbers_of(recording)["session"]["steps"], 60 * count)
        # the second one is longer, and what came then is its own
        self.assertEqual(recording.skill.path_length, 2)
        self.assertGreater(min(recording.tip[::4]), 2e9)
        self.assertIsNone(read_recording(self.path).skill)

    def test_sessions_in_turns_with_stamps_of_their_own(self):
        self.write({"identity": FIRST, "origin": 1e9}, {"identity": SECOND, "origin": 1e9 + 0.005})
        self.sort()
        self.check(read_recording(self.path), 1)
        self.check(read_recording(self.path, session="2"), 2)

    def test_in_turns_without_identity(self):
        self.write({}, {"origin": 1.005})
        self.sort()
        self.assertIn("they have no identity", self.problem_of())
        self.assertIn("they have no identity", self.problem_of(session="2"))

    def test_a_recording_that_was_merged_with_a_part_of_itself(self):
        self.write({"identity": FIRST})
        copy = os.path.join(self.folder, "copy.bag")
        with rosbag.Bag(copy, "w") as target:
            for begin, end in ((1.405, 9), (0, 1.595)):
                with rosbag.Bag(self.path) as source:
                    for topic, message, stamp in source.read_messages():
                        if begin <= stamp.to_sec() < end:
                            target.write(topic, message, stamp)
        recording = read_recording(copy)
        self.assertEqual(list(recording.steps), list(range(60)))
        self.assertAlmostEqual(recording.duration(), 1.0, places=6)
        said = " ".join(warnings_of(recording))
        self.assertIn("11 steps are in the recording twice", said)
        self.assertNotIn("reset", said)

    def test_parts_in_time(self):
        self.write({"identity": FIRST, "origin": 1e9}, {"identity": SECOND, "origin": 1e9 + 20})
        copy = os.path.join(self.folder, "copy.bag")
        with rosbag.Bag(self.path) as source, rosbag.Bag(copy, "w") as target:
            for topic, message, stamp in source.read_messages():
                if stamp.to_sec() > 1e9 + 0.5 or topic in ("/scene", "/session_info"):
                    target.write(topic, message, stamp)
        recording = read_recording(copy)
        self.assertEqual(recording.identity, FIRST)
        self.assertTrue(any("begins at step 30: " in text for text in warnings_of(recording)))


if __name__ == "__main__":
    unittest.main()
