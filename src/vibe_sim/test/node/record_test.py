#!/usr/bin/env python3
"""Recordings that begin late, go through a reset, or are cut off; replayed to the bit; played into a graph."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import rosbag
import rospy
import rostest
from node_test_support import buttons, joints
from sensor_msgs.msg import JointState, Joy, PointCloud2
from std_srvs.srv import SetBool
from vibe_msgs.msg import ProcedureState, ReplayCommand, ReplayStatus, StepInput
from vibe_msgs.srv import Reset
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

NAN = float("nan")
SCOPE = ["insertion", "rotation", "tip_up_down", "tip_left_right"]


def replay(bag, *options):
    """Status and last line of vibe_replay; its progress and, if it has no result, its error are on stderr."""
    done = subprocess.run(["rosrun", "vibe_sim", "vibe_replay", *options, bag], capture_output=True, text=True, check=False)
    return done.returncode, (done.stdout or done.stderr).strip().splitlines()[-1]


def steps_of(path):
    with rosbag.Bag(path) as bag:
        return [(m.run, m.step) for _, m, _ in bag.read_messages(topics=["/applied_input"])]


def count(path, topic):
    with rosbag.Bag(path) as bag:
        return bag.get_message_count(topic)


class RecordTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="vibe_record_test_")
        cls.bag = os.path.join(cls.folder, "late.bag")
        cls.motion = rospy.Publisher("scope/input/joint_states", JointState, queue_size=10)
        cls.presses = rospy.Publisher("scope/buttons", Joy, queue_size=10)
        cls.steps = Recorder("applied_input", StepInput)
        assert wait_until(lambda: len(cls.steps.messages) > 60, 60), "the simulator does not step"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def start(self, path, *options):
        recorder = subprocess.Popen(["rosrun", "vibe_sim", "vibe_record", *options, path])
        self.addCleanup(lambda: recorder.poll() is None and recorder.kill())
        before = self.steps.subscriber.get_num_connections()
        self.assertTrue(wait_until(lambda: os.path.exists(path + ".active"), 20))
        self.assertEqual(before, 1)
        rospy.rostime.wallsleep(2)  # it looks for topics, then for the inputs
        return recorder

    def move(self, seconds):
        """The scope goes in and out while the insufflator runs."""
        end = rospy.Time.now() + rospy.Duration(seconds)
        while rospy.Time.now() < end:
            t = rospy.Time.now().to_sec()
            self.motion.publish(joints(SCOPE, [0.05 + 0.02 * (t % 2), 0.2 * (t % 3), 0, 0], rospy.Time.now()))
            self.presses.publish(buttons((5,), rospy.Time.now()))
            rospy.rostime.wallsleep(0.02)

    def test_1_a_recording_that_begins_late_and_sees_a_reset_is_the_same(self):
        recorder = self.start(self.bag)
        self.move(4)
        self.assertTrue(rospy.ServiceProxy("reset", Reset)(seed=5, keep_time=True).success)
        self.move(2)
        recorder.send_signal(signal.SIGINT)
        self.assertEqual(recorder.wait(30), 0)
        steps = steps_of(self.bag)
        self.assertGreater(steps[0][1], 60, "it began with the session")
        self.assertEqual({run for run, _ in steps}, {1, 2})
        status, sentence = replay(self.bag)
        self.assertEqual(status, 0, sentence)
        same = int(re.match(r"the same: all (\d+) steps", sentence).group(1))
        self.assertLessEqual(len(steps) - same, 2)  # an input or two may come before the first snapshot

    def test_2_it_is_thinned_and_filled_up_again(self):
        steps = len(steps_of(self.bag))
        self.assertLess(count(self.bag, "/scope/measured_cp"), steps / 4)
        self.assertLess(count(self.bag, "/tissue/particles"), steps / 60)
        self.assertEqual(count(self.bag, "/step_result"), 0)
        filled = os.path.join(self.folder, "filled.bag")
        self.assertEqual(replay(self.bag, "--fill", filled)[0], 0)
        self.assertLessEqual(steps - count(filled, "/applied_input"), 2)
        for topic in ("/scope/measured_cp", "/step_result", "/joint_states"):
            self.assertGreaterEqual(count(filled, topic), count(filled, "/applied_input"), topic)
        self.assertLess(os.path.getsize(self.bag), os.path.getsize(filled) / 2)
        with rosbag.Bag(self.bag) as bag:
            messages = sum(len(message[1]) for _, message, _ in bag.read_messages(raw=True))
        self.assertLess(os.path.getsize(self.bag), 0.7 * messages)  # which a bag of short chunks exceeds

    def test_3_a_killed_recorder_loses_the_last_chunk_only(self):
        path = os.path.join(self.folder, "killed.bag")
        recorder = self.start(path)
        self.move(8)
        program = subprocess.run(["pgrep", "-f", "vibe_record .*" + path], capture_output=True, text=True, check=True)
        for pid in program.stdout.split():
            os.kill(int(pid), signal.SIGKILL)
        recorder.wait(10)
        end = self.steps.messages[-1].step
        status, sentence = replay(path + ".active")
        self.assertEqual(status, 2)
        self.assertIn("rosbag reindex", sentence)
        subprocess.run(["rosbag", "reindex", "--quiet", path + ".active"], check=True)
        steps = steps_of(path + ".active")
        self.assertLess(end - steps[-1][1], 60 * 4)  # a chunk is 2 s
        status, sentence = replay(path + ".active")
        self.assertEqual(status, 0, sentence)

    def test_4_an_edited_input_is_found(self):
        path = os.path.join(self.folder, "edited.bag")
        chosen = steps_of(self.bag)[100]
        with rosbag.Bag(self.bag) as source, rosbag.Bag(path, "w") as target:
            for topic, message, time in source.read_messages():
                if topic == "/applied_input" and (message.run, message.step) == chosen:
                    message.joints = list(message.joints[:-1]) + [NAN]
                target.write(topic, message, time)
        status, sentence = replay(path)
        self.assertEqual(status, 1, sentence)
        self.assertIn("at step {} ".format(chosen[1]), sentence)
        self.assertIn("input", sentence)

    def test_5_a_player_goes_to_any_time(self):
        self.assertTrue(rospy.ServiceProxy("pause", SetBool)(True).success)
        player = subprocess.Popen(["rosrun", "vibe_sim", "vibe_player", "__ns:=replayed", "/clock:=/replayed/clock",
                                   "_recording:=" + self.bag, "_play:=false"])
        self.addCleanup(player.kill)
        status = Recorder("/replayed/replay/status", ReplayStatus)
        clouds = Recorder("/replayed/tissue/particles", PointCloud2)
        commands = rospy.Publisher("/replayed/replay/command", ReplayCommand, queue_size=10)
        self.assertIsNotNone(status.waits_for(lambda m: m.duration > 5 and not m.playing, 30))
        self.assertTrue(wait_until(lambda: commands.get_num_connections() == 1, 20))
        commands.publish(ReplayCommand(play=False, rate=1, seek=3.0, exact=True))
        self.assertIsNotNone(status.waits_for(lambda m: abs(m.time - 3.0) < 0.02, 30))
        commands.publish(ReplayCommand(play=False, rate=1, seek=0.5, exact=True))
        there = status.waits_for(lambda m: abs(m.time - 0.5) < 0.02, 30)
        self.assertIsNotNone(there)
        states = Recorder("/replayed/procedure/state", ProcedureState)
        self.assertTrue(wait_until(lambda: len(states.messages) > 2, 10), "it is silent while it stands still")
        commands.publish(ReplayCommand(play=True, rate=4, seek=NAN, exact=True))
        self.assertIsNotNone(status.waits_for(lambda m: m.time > 4.5 and m.same, 60))
        stamps = clouds.stamps()
        self.assertGreater(len(stamps), 10)
        self.assertEqual(stamps, sorted(set(stamps)), "stamps go back")
        player.send_signal(signal.SIGINT)
        self.assertEqual(player.wait(20), 0)


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("vibe_sim", "record", RecordTest)
