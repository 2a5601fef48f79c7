#!/usr/bin/env python3
"""Names that topics had in the release before still work, each with one warning that says the present one."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from node_test_support import EPOCH, SCOPE_JOINTS, SUTURING_DEVICE_JOINTS, joints, scene
from sensor_msgs.msg import JointState
from vibe_msgs.msg import OperatingState, StateCommand, StepInput
from vibe_msgs.srv import Step
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

LAST_TIME = "for the last time"  # in every warning


class FormerNamesTest(unittest.TestCase):
    def start(self, *remapped, **parameters):
        settings = dict(scene=scene("balloon.yaml"), time_source="sim", fast="true", start_paused="true", **parameters)
        self.simulator = Program("vibe_sim", "sim_node", *remapped, name="sim_node", **settings)
        self.addCleanup(self.simulator.stop)
        self.applied = Recorder("applied_input", StepInput)
        self.addCleanup(self.applied.disconnect)
        rospy.wait_for_service("step", 20)
        self.assertTrue(self.applied.waits_for_connection(20))

    def publisher(self, topic, message_type):
        publisher = rospy.Publisher(topic, message_type, queue_size=10)
        self.addCleanup(publisher.unregister)
        self.assertTrue(wait_until(lambda: publisher.get_num_connections() > 0, 20), topic)
        return publisher

    def send(self, publisher, message):
        publisher.publish(message)
        rospy.rostime.wallsleep(0.2)

    def joints_after(self, steps):
        """What the last of these steps used."""
        self.applied.clear()
        self.assertTrue(rospy.ServiceProxy("step", Step)(steps).success)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) >= steps, 20))
        return self.applied.messages[-1].joints

    def test_drivers_of_the_release_before_drive(self):
        self.start()
        stamp = rospy.Time(nsecs=EPOCH)
        scope, device = self.publisher("scope/measured_js", JointState), self.publisher("overstitch/measured_js", JointState)
        for depth in (0.005, 0.01):
            self.send(scope, joints(SCOPE_JOINTS, (depth, 0.1, 0, 0), stamp))
            self.send(device, joints(SUTURING_DEVICE_JOINTS, (depth, 0, 0), stamp))
        used = self.joints_after(30)
        self.assertEqual((used[0], used[1], used[4]), (0.01, 0.1, 0.01))
        for former, present in (("scope/measured_js", "scope/input/joint_states"),
                                ("overstitch/measured_js", "suturing_device/input/joint_states")):
            warning = "publishes {}, the former name of an input".format(former)
            self.assertEqual(self.simulator.count(warning), 1, self.simulator.output())
            self.assertEqual(self.simulator.count("publish {}.".format(present)), 1)
        self.send(self.publisher("overstitch/servo_jp", JointState), joints([], (0.02, 0, 0), rospy.Time(0)))
        self.assertEqual(self.joints_after(30)[4], 0.02)
        self.send(self.publisher("overstitch/move_jp", JointState), joints([], (0.01, 0, 0), rospy.Time(0)))
        self.assertAlmostEqual(self.joints_after(60)[4], 0.01, places=9)
        state = Recorder("suturing_device/operating_state", OperatingState)
        self.addCleanup(state.disconnect)
        self.send(self.publisher("overstitch/state_command", StateCommand), StateCommand(string="resume"))
        self.assertIsNotNone(state.waits_for(lambda m: m.state == "ENABLED"))
        self.assertEqual(self.simulator.count(LAST_TIME), 5)

    def test_the_joints_of_a_tool_are_no_input(self):
        self.start()
        feedback = joints(SCOPE_JOINTS, (0.02, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        feedback.velocity, feedback.effort = [0.0] * 4, [0.0] * 4
        self.send(self.publisher("scope/measured_js", JointState), feedback)
        self.assertEqual(self.joints_after(30)[0], 0)
        self.assertEqual(self.simulator.count("is ignored: it has efforts"), 1, self.simulator.output())
        self.assertEqual(self.simulator.count(LAST_TIME), 0)

    def test_a_former_and_a_present_name_are_one_topic(self):
        self.start()
        here = self.publisher("scope/input/joint_states", JointState)
        ours = joints(SCOPE_JOINTS, (0.01, 0, 0, 0), rospy.Time(nsecs=EPOCH))
        text = "{{header: {{stamp: 1}}, name: {}, position: [0.02, 0, 0, 0]}}".format(SCOPE_JOINTS)
        self.send(here, ours)
        other = Program("rostopic", "rostopic", "pub", "scope/measured_js", "sensor_msgs/JointState", text)
        self.addCleanup(other.stop)
        sentence = "Two nodes publish scope/input/joint_states: {} is obeyed".format(rospy.get_name())

        def is_said():
            here.publish(ours)  # who is silent for two seconds gives the topic up
            return self.simulator.count(sentence) > 0

        self.assertTrue(wait_until(is_said, 20, 0.05), self.simulator.output() + other.output())
        self.assertEqual(self.joints_after(30)[0], 0.01)

    def test_listeners_of_the_release_before_hear(self):
        self.start()
        topics = {
            "scope/simulated/measured_js": ("scope/measured_js", JointState),
            "overstitch/simulated/measured_js": ("suturing_device/measured_js", JointState),
            "overstitch/helix/measured_cp": ("suturing_device/helix/measured_cp", PoseStamped),
            "overstitch/operating_state": ("suturing_device/operating_state", OperatingState),
        }
        self.assertEqual(self.simulator.count(LAST_TIME), 0)
        for former, (present, message_type) in topics.items():
            with self.subTest(former):
                twice = [Recorder(former, message_type) for _ in range(2)]
                now = Recorder(present, message_type)
                for recorder in (*twice, now):
                    self.addCleanup(recorder.disconnect)
                    self.assertTrue(recorder.waits_for_connection(20))
                self.joints_after(3)
                count = 1 if "state" in former else 3
                for recorder in (*twice, now):
                    self.assertTrue(wait_until(lambda: len(recorder.messages) >= count), former)
                self.assertEqual(twice[0].messages[-count:], now.messages[-count:])
                self.assertEqual(self.simulator.count("listens to {}, a former name".format(former)), 1)
                self.assertEqual(self.simulator.count("listen to {}.".format(present)), 1)
        self.assertEqual(self.simulator.count(LAST_TIME), len(topics))

    def test_remappings_and_parameters_of_the_release_before_are_understood(self):
        self.start("scope/measured_js:=pad/joints", "overstitch/measured_js:=camera/joints")
        self.send(self.publisher("pad/joints", JointState), joints(SCOPE_JOINTS, (0.01, 0, 0, 0), rospy.Time(nsecs=EPOCH)))
        self.send(self.publisher("camera/joints", JointState),
                  joints(SUTURING_DEVICE_JOINTS, (0.02, 0, 0), rospy.Time(nsecs=EPOCH)))
        used = self.joints_after(30)
        self.assertEqual((used[0], used[4]), (0.01, 0.02))
        self.assertEqual(self.simulator.count("is taken as scope/input/joint_states:=pad/joints; write that"), 1)
        self.assertEqual(self.simulator.count("taken as suturing_device/input/joint_states:=camera/joints"), 1)
        self.simulator.stop()
        wrong = Program("vibe_sim", "sim_node", name="sim_node", scene=scene("balloon.yaml"), follow="scope/measured_js",
                        time_source="sim", fast="true")  # fmt: skip
        self.assertEqual(wrong.ends(20), 2)
        self.assertIn("the former name of scope/input/joint_states; set it to that.", wrong.output())
        self.assertIn("Parameter ~follow excludes ~fast", wrong.output())  # so that it was understood


if __name__ == "__main__":
    rospy.init_node("former_names_test")
    rostest.rosrun("vibe_sim", "former_names_test", FormerNamesTest, sys.argv)
