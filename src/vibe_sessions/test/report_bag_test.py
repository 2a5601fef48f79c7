"""The reader of bags: every compression, one sentence for every bad file, and what is left of one that was cut."""

import os
import shutil
import struct
import tempfile
import unittest

import rosbag
from report_bags import SyntheticSession
from std_msgs.msg import Float64

from vibe_sessions.report.bag_file import BagError, BagFile
from vibe_sessions.report.message_types import offset_of, parse
from vibe_sessions.report.recording import read_recording


class BagTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.path = os.path.join(self.folder, "session.bag")

    def make(self, **options):
        return SyntheticSession(self.path, **options).write()

    def problem_of(self, path=None, namespace=None):
        with self.assertRaises(BagError) as caught:
            read_recording(path or self.path, namespace)
        text = str(caught.exception)
        self.assertTrue(text.startswith((path or self.path) + ": "), text)
        self.assertNotIn("\n", text)
        self.assertGreater(text.count(";") + text.count(", "), 0, "no remedy in: " + text)
        return text

    def write(self, data):
        with open(self.path, "wb") as file:
            file.write(data)


class ReadTest(BagTest):
    def test_messages_are_those_of_rosbag_with_every_compression(self):
        for compression in (rosbag.Compression.NONE, rosbag.Compression.BZ2, rosbag.Compression.LZ4):
            self.make(compression=compression)
            with rosbag.Bag(self.path) as bag:
                expected = sorted((t, stamp.to_nsec(), raw[1]) for t, raw, stamp in bag.read_messages(raw=True))
            with BagFile(self.path) as bag:
                found = sorted(
                    (bag.connections[c].topic, received, data) for c, received, data in bag.messages(bag.connections)
                )
                self.assertEqual(bag.cut_reason, "")
                counted = sum(bag.count(c) for c in bag.connections)
            self.assertGreater(len(found), 500)
            self.assertEqual(counted, len(found))
            self.assertEqual(found, expected, compression)

    def test_only_what_is_wanted(self):
        self.make()
        with BagFile(self.path) as bag:
            (state,) = [c for c, each in bag.connections.items() if each.topic == "/procedure/state"]
            all_states = list(bag.messages([state]))
            self.assertEqual({c for c, _, _ in all_states}, {state})
            self.assertEqual(len(all_states), bag.count(state))
            self.assertEqual(parse(bag.connections[state], all_states[0][2]).scene, "test")

    def test_offsets_of_fields(self):
        definition = "# x\nHeader header\nuint64 step\nuint8[6] buttons  # six\ngeometry_msgs/Point p\nuint64 hash\n"
        definition += "string name\nuint8 late\n====\nuint64 other\n"
        self.assertEqual(offset_of(definition, "step"), 0)
        self.assertEqual(offset_of(definition, "hash"), 38)
        self.assertIsNone(offset_of(definition, "late"))  # behind a string
        self.assertIsNone(offset_of(definition, "other"))  # of another message


class CutTest(BagTest):
    def cut(self, share, **options):
        self.make(**options)
        with open(self.path, "rb") as file:
            whole = file.read()
        self.write(whole[: int(share * len(whole))])

    def test_cut_in_the_middle(self):
        for compression in (rosbag.Compression.NONE, rosbag.Compression.BZ2, rosbag.Compression.LZ4):
            self.cut(0.6, duration=10, compression=compression)
            recording = read_recording(self.path)
            self.assertIn("was not closed", recording.cut_reason)
            self.assertGreater(len(recording.steps), 200)
            self.assertLess(len(recording.steps), 600)
            self.assertEqual(list(recording.steps), list(range(len(recording.steps))))

    def test_cut_behind_the_last_chunk_loses_nothing(self):
        self.make(duration=3)
        with open(self.path, "rb") as file:
            whole = file.read()
        header = whole[13:4096]
        (index,) = struct.unpack_from("<Q", header, header.index(b"index_pos=") + len(b"index_pos="))
        self.write(whole[:index])
        self.assertEqual(len(read_recording(self.path).steps), 180)

    def test_a_recorder_that_was_killed(self):
        """No index position in the header, and a last chunk of size 0, as rosbag leaves them."""
        session = SyntheticSession(self.path, duration=2)
        session.bag = rosbag.Bag(self.path, "w", chunk_threshold=1 << 30)
        session._begin()
        for step in range(120):
            session._step(step)
        session.bag._file.flush()
        shutil.copy(self.path, self.path + ".active")
        session.bag.close()
        recording = read_recording(self.path + ".active")
        self.assertIn("was not closed", recording.cut_reason)
        self.assertGreater(len(recording.steps), 110)

    def test_cut_before_the_first_message(self):
        self.make()
        with open(self.path, "rb") as file:
            begin = file.read(3000)
        self.write(begin)
        self.problem_of()

    def test_any_cut_and_any_damage_is_a_recording_or_a_sentence(self):
        self.make(duration=0.2)
        with open(self.path, "rb") as file:
            whole = file.read()
        for k in range(120):
            data = bytearray(whole)
            if k % 2:
                data = data[: k * len(whole) // 120]
            else:
                at = 13 + k * (len(whole) - 13) // 120
                data[at : at + 8] = b"\xff" * 8
            self.write(bytes(data))
            try:
                read_recording(self.path)
            except BagError as error:
                self.assertIn(self.path, str(error))
            except (struct.error, ValueError, KeyError) as error:
                # a damaged message in a whole file: the worker turns it into a sentence
                self.assertEqual(k % 2, 0, error)


class BadFileTest(BagTest):
    def test_missing(self):
        self.assertIn("no such file", self.problem_of())

    def test_folder(self):
        os.mkdir(self.path)
        self.assertIn("cannot be read", self.problem_of())

    def test_empty(self):
        self.write(b"")
        self.assertIn("is empty", self.problem_of())

    def test_not_a_bag(self):
        self.write(b"<html>404</html>")
        self.assertIn("is not a bag", self.problem_of())

    def test_old_bag(self):
        self.write(b"#ROSBAG V1.2\n")
        self.assertIn("another format", self.problem_of())

    def test_another_robot(self):
        with rosbag.Bag(self.path, "w") as bag:
            bag.write("/battery", Float64(1.0))
            bag.write("/applied_input", Float64(1.0))
        text = self.problem_of()
        self.assertIn("no topic applied_input", text)
        self.assertIn("/battery", text)

    def test_no_message(self):
        rosbag.Bag(self.path, "w").close()
        self.assertIn("no message", self.problem_of())

    def test_without_scene(self):
        self.make(without=("scene",), duration=0.5)
        self.assertIn("no scene", self.problem_of())

    def test_without_steps(self):
        self.make(skip_steps=range(1000), duration=0.5)
        self.assertIn("applied_input", self.problem_of())

    def test_two_sessions_and_a_namespace(self):
        with rosbag.Bag(self.path, "w") as bag:
            for name in ("/left", "/right"):
                session = SyntheticSession("", duration=0.5, namespace=name)
                session.bag = bag
                session._begin()
                session._step(0)
        self.assertEqual(read_recording(self.path).namespace, "/left")
        self.assertIn("'/left', '/right'", self.problem_of(namespace="/middle"))
        self.assertEqual(read_recording(self.path, "/right/").namespace, "/right")


if __name__ == "__main__":
    unittest.main()
