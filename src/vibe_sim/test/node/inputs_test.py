#!/usr/bin/env python3
"""What is wrong with an input is said once and clearly, and changes nothing."""

import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from node_test_support import EPOCH, SUTURING_DEVICE_JOINTS, SCOPE_JOINTS, joints, scene
from sensor_msgs.msg import JointState, Joy
from vibe_msgs.msg import ProcedureEvent, SolverStatistics, StateCommand, StepInput, TissuePull
from vibe_msgs.srv import Reset, Step
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

NAN = float("nan")


def pose(frame="world", x=-0.07, w=1.0):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x = x
    message.pose.orientation.w = w
    return message


def pull(particle=3, frame="world", x=0.0):
    message = TissuePull(particle=particle)
    message.header.frame_id = frame
    message.target.x = x
    return message


class InputsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.performance = Recorder("solver_statistics", SolverStatistics)
        cls.poses = Recorder("scope/measured_cp", PoseStamped)
        topics = {
            "scope/input/joint_states": JointState,
            "scope/servo_jp": JointState,
            "scope/servo_cp": PoseStamped,
            "suturing_device/input/joint_states": JointState,
            "scope/buttons": Joy,
            "tissue/pull": TissuePull,
        }
        cls.publishers = {topic: rospy.Publisher(topic, kind, queue_size=100) for topic, kind in topics.items()}
        rospy.wait_for_service("step", 20)
        cls.step = rospy.ServiceProxy("step", Step)
        cls.reset = rospy.ServiceProxy("reset", Reset)
        assert wait_until(lambda: all(p.get_num_connections() > 0 for p in cls.publishers.values()), 20)
        assert wait_until(lambda: all(r.is_connected() for r in (cls.applied, cls.events, cls.performance)), 20)

    complained = {}  # when there was a complaint about a topic

    def setUp(self):
        self.assertTrue(self.reset(seed=0, keep_time=False).success)
        rospy.rostime.wallsleep(0.1)
        self.events.clear()
        self.applied.clear()

    def wait_for_silence(self, *topics):
        """Complaints are limited to one a second per topic; waits until the next would be heard."""
        now = time.monotonic()
        for topic in topics:
            time.sleep(max(0, self.complained.get(topic, -10) + 1.1 - now))
            self.complained[topic] = time.monotonic()
        self.events.clear()

    def last_input_after(self, steps):
        self.applied.clear()
        self.assertTrue(self.step(steps).success)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) == steps))
        return self.applied.messages[-1]

    def assert_refused(self, topic, message, words):
        """A message leads to one warning with these words and leaves the input as it is."""
        self.wait_for_silence(topic)
        before = self.last_input_after(1)
        self.publishers[topic].publish(message)
        warning = self.events.waits_for(lambda m: m.kind == ProcedureEvent.WARNING, 5)
        self.assertIsNotNone(warning, "no warning")
        for word in (topic, rospy.get_name()) + words:
            self.assertIn(word, warning.text)
        after = self.last_input_after(5)
        self.assertEqual((after.joints, after.buttons), (before.joints, before.buttons))
        self.assertEqual((after.pull_particle, after.pull_target), (before.pull_particle, before.pull_target))

    def test_bad_messages_are_refused_with_a_reason(self):
        now = rospy.Time(nsecs=EPOCH)
        good = (0.04, 0, 0, 0)
        scope, device = "scope/input/joint_states", "suturing_device/input/joint_states"
        cases = (
            (scope, joints(SCOPE_JOINTS, (NAN, 0, 0, 0), now), ("insertion", "finite")),
            (device, joints(SUTURING_DEVICE_JOINTS, (0, NAN, 0), now), ("helix_rotation",)),
            ("scope/servo_jp", joints(SCOPE_JOINTS[:2], good[:2], now), ("2 positions",)),
            (scope, joints(SCOPE_JOINTS, (0.04, 0, float("inf"), 0), now), ("tip_up_down", "finite")),
            ("scope/servo_cp", pose(frame="map"), ("'map'", "world")),
            ("scope/buttons", Joy(buttons=[1, 0]), ("2 buttons",)),
            (scope, joints(SCOPE_JOINTS, (0.04, 0, 0), now), ("3 positions",)),
            ("scope/servo_cp", pose(x=NAN), ("finite",)),
            ("scope/buttons", Joy(buttons=[0, 7, 0, 0, 0, 0]), ("helix_grab",)),
            (scope, joints(SUTURING_DEVICE_JOINTS + ["x"], good, now), ("helix_advance",)),
            ("scope/servo_cp", pose(w=0.0), ("quaternion",)),
            (scope, joints(SCOPE_JOINTS, good, rospy.Time(0)), ("stamp is 0",)),
            ("tissue/pull", pull(frame="scope_tip"), ("'scope_tip'", "world")),
            ("tissue/pull", pull(x=NAN), ("finite",)),
            ("tissue/pull", pull(particle=-5), ("-5",)),
        )
        for topic, message, words in cases:
            with self.subTest(topic=topic, words=words):
                self.assert_refused(topic, message, words)

    def test_a_pull_at_no_particle_is_refused_when_its_step_begins(self):
        self.events.clear()
        self.publishers["tissue/pull"].publish(pull(particle=1000000))
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(self.last_input_after(1).pull_particle, -1)
        warning = self.events.waits_for(lambda m: m.kind == ProcedureEvent.WARNING, 5)
        self.assertIsNotNone(warning)
        self.assertIn("tissue/pull", warning.text)
        self.assertIn("1000000", warning.text)

    def test_a_flood_of_bad_messages_gives_one_warning_a_second(self):
        self.wait_for_silence("scope/input/joint_states")
        bad = joints(SCOPE_JOINTS, (NAN, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        for _ in range(200):
            self.publishers["scope/input/joint_states"].publish(bad)
        self.assertIsNotNone(self.events.waits_for(lambda m: True, 5))
        rospy.rostime.wallsleep(0.5)
        self.assertEqual(len(self.events.messages), 1)

    def test_a_flood_of_unknown_commands_gives_one_warning_a_second(self):
        command = rospy.Publisher("scope/state_command", StateCommand, queue_size=1000)
        self.assertTrue(wait_until(lambda: command.get_num_connections() > 0, 20))
        self.events.clear()
        begin = time.monotonic()
        for k in range(1000):
            command.publish(StateCommand(string="fly {}".format(k)))
            time.sleep(0.001)
        command.publish(StateCommand(string="last one"))
        self.assertIsNotNone(self.events.waits_for(lambda m: "there is no command 'fly" in m.text, 5))
        rospy.rostime.wallsleep(0.3)
        self.assertLessEqual(len(self.events.messages), 1 + (time.monotonic() - begin))
        command.unregister()

    def test_a_place_in_millimetres_is_refused_when_its_step_begins(self):
        self.wait_for_silence("scope/servo_cp")
        before = self.last_input_after(1)
        self.publishers["scope/servo_cp"].publish(pose(x=86.0))
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(self.last_input_after(5).joints, before.joints)
        warning = self.events.waits_for(lambda m: "scope/servo_cp asks for a place 86" in m.text, 5)
        self.assertIsNotNone(warning)
        self.assertIn("millimetres", warning.text)

    def hash_after_steps(self, n):
        self.assertTrue(self.step(n).success)
        rospy.rostime.wallsleep(0.1)  # for a report from before
        self.performance.clear()
        return self.performance.waits_for(lambda m: True, 4).state_hash

    def test_bad_messages_leave_the_state_hash_alone(self):
        start = joints(SCOPE_JOINTS, (0.075, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        hashes = []
        for disturb in (False, True, None):
            self.setUp()
            if disturb is not None:  # the last run lacks the command: a hash that cannot change would prove nothing
                self.publishers["scope/input/joint_states"].publish(start)
            rospy.rostime.wallsleep(0.3)
            if disturb:
                self.wait_for_silence("scope/input/joint_states", "scope/servo_cp", "scope/buttons")
                wrong = joints(SCOPE_JOINTS, (NAN, 0, 0, 0), start.header.stamp)
                self.publishers["scope/input/joint_states"].publish(wrong)
                self.publishers["scope/servo_cp"].publish(pose(frame="map"))
                self.publishers["scope/buttons"].publish(Joy(buttons=[1]))
                self.assertIsNotNone(self.events.waits_for(lambda m: "buttons" in m.text, 5))
            hashes.append(self.hash_after_steps(60))
        self.assertEqual(hashes[0], hashes[1])
        self.assertNotEqual(hashes[0], hashes[2])

    def test_commands_beyond_the_limits_are_clamped(self):
        message = joints(SCOPE_JOINTS, (9.0, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        self.publishers["scope/input/joint_states"].publish(message)
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(self.last_input_after(200).joints[0], 9.0)
        tip = self.poses.messages[-1].pose.position.x
        self.assertAlmostEqual(tip, -0.12 + 0.3, delta=1e-6)

    def test_servo_jp_takes_positions_without_names_or_stamp(self):
        message = JointState(position=[0.03, 0.1, 0, 0])
        self.publishers["scope/servo_jp"].publish(message)
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(self.last_input_after(1).joints[:4], (0.03, 0.1, 0, 0))

    def test_servo_cp_brings_the_tip_there(self):
        for message in (pose(x=-0.08), pose(frame="scope_base", x=0.06)):
            target = message.pose.position.x - (0.12 if message.header.frame_id == "scope_base" else 0)
            self.publishers["scope/servo_cp"].publish(message)
            rospy.rostime.wallsleep(0.3)
            self.last_input_after(90)
            wait_until(lambda: abs(self.poses.messages[-1].pose.position.x - target) < 1e-3, 3)
            self.assertAlmostEqual(self.poses.messages[-1].pose.position.x, target, delta=1e-3)

    def test_a_pose_out_of_reach_is_reported_with_what_is_missing(self):
        self.wait_for_silence("scope/servo_cp")
        far = pose(x=0.5)
        for _ in range(30):
            self.publishers["scope/servo_cp"].publish(far)
            rospy.rostime.wallsleep(0.01)
            self.step(1)
        warning = self.events.waits_for(lambda m: "scope/servo_cp" in m.text, 5)
        self.assertIsNotNone(warning)
        self.assertRegex(warning.text, "misses by [0-9]+ mm")
        self.assertLessEqual(len([m for m in self.events.messages if "scope/servo_cp" in m.text]), 3)
        self.events.clear()
        rospy.rostime.wallsleep(1.1)
        self.publishers["scope/servo_cp"].publish(pose(x=-0.08))
        rospy.rostime.wallsleep(0.3)
        self.last_input_after(90)
        self.assertIsNone(self.events.waits_for(lambda m: "scope/servo_cp" in m.text, 0.5))

    def test_only_one_of_two_publishers_is_obeyed(self):
        self.wait_for_silence("scope/input/joint_states")
        ours = joints(SCOPE_JOINTS, (0.04, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        self.publishers["scope/input/joint_states"].publish(ours)
        rospy.rostime.wallsleep(0.2)
        other = Program("vibe_sim", "vibe_trainee", name="other", script=scene("poke.trainee.yaml"))
        try:
            deadline = time.monotonic() + 15
            warning = None
            while warning is None and time.monotonic() < deadline:
                self.publishers["scope/input/joint_states"].publish(ours)
                self.step(1)  # time must go on for the trainee to move
                warning = self.events.waits_for(lambda m: "Two nodes publish scope/input/joint_states" in m.text, 0.02)
            self.assertIsNotNone(warning)
            self.assertIn(rospy.get_name() + " is obeyed", warning.text)
            self.assertIn("/other", warning.text)
            self.assertEqual(self.last_input_after(1).joints[0], 0.04)
        finally:
            other.stop()


if __name__ == "__main__":
    rospy.init_node("inputs_test")
    rostest.rosrun("vibe_sim", "inputs_test", InputsTest, sys.argv)
