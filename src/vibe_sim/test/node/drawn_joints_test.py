#!/usr/bin/env python3
"""Joints that only a picture needs, through a bite and robot_state_publisher: the frames are where the procedure has the
parts. The simulation is paused and stepped."""

import math
import sys
import unittest

import rospy
import rostest
import tf2_ros
from node_test_support import EPOCH, SUTURING_DEVICE_JOINTS, SCOPE_JOINTS, buttons, joints, stamp_of
from sensor_msgs.msg import JointState, Joy
from vibe_msgs.msg import ProcedureEvent, StepInput
from vibe_msgs.srv import Reset, Step
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

OPEN, CLOSING, CLOSED = (0, 0, 0), (0, 0, 0.012), (0, 0, 0.018)
NEEDLE_BUTTON = 2


class DrawnJointsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states = Recorder("joint_states", JointState)
        cls.applied = Recorder("applied_input", StepInput)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.scope = rospy.Publisher("scope/input/joint_states", JointState, queue_size=100)
        cls.suturing_device = rospy.Publisher("suturing_device/input/joint_states", JointState, queue_size=100)
        cls.buttons = rospy.Publisher("scope/buttons", Joy, queue_size=100)
        cls.tf = tf2_ros.Buffer()
        cls.tf_listener = tf2_ros.TransformListener(cls.tf)
        rospy.wait_for_service("step", 20)
        cls.step_service = rospy.ServiceProxy("step", Step)
        publishers = (cls.scope, cls.suturing_device, cls.buttons)
        assert wait_until(lambda: all(p.get_num_connections() > 0 for p in publishers), 20)
        assert wait_until(lambda: all(r.is_connected() for r in (cls.states, cls.applied, cls.events)), 20)
        assert rospy.ServiceProxy("reset", Reset)(seed=0, keep_time=False).success

    def step(self, n):
        before = len(self.applied.messages)
        self.assertTrue(self.step_service(n).success)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) == before + n))
        last = stamp_of(self.applied.messages[-1].step + 1)
        self.assertTrue(wait_until(lambda: self.states.stamps()[-1:] == [last]))
        return last

    def command(self, device, pressed=()):
        """Steps until a step has used these inputs, and for a second in which the device comes where it is sent."""
        stamp = rospy.Time(nsecs=EPOCH)
        for attempt in range(100):
            self.scope.publish(joints(SCOPE_JOINTS, (0.02, 0, 0, 0), stamp))
            self.suturing_device.publish(joints(SUTURING_DEVICE_JOINTS, device, stamp))
            self.buttons.publish(buttons(pressed, stamp))
            self.step(1)
            used = self.applied.messages[-1]
            if used.joints[4:] == device and [k for k in range(6) if used.buttons[k]] == list(pressed):
                break
        else:
            self.fail("the command was never used")
        self.step(60)
        return dict(zip(self.states.messages[-1].name, self.states.messages[-1].position))

    def distance(self, frame, other):
        """Between two frames that move only when the device does, when both have arrived."""
        wanted = self.step(1)
        self.tf.clear()  # of the time before the reset
        for attempt in range(50):  # robot_state_publisher limits its rate in simulated time
            self.step(6)
            rospy.rostime.wallsleep(0.05)
            if not self.tf.can_transform(frame, other, rospy.Time(0)):
                continue
            transform = self.tf.lookup_transform(frame, other, rospy.Time(0))
            if transform.header.stamp.to_nsec() >= wanted:
                place = transform.transform.translation
                return math.sqrt(place.x**2 + place.y**2 + place.z**2)
        self.fail(f"there is no transform between {frame} and {other}")

    def test_the_needle_goes_into_the_exchange_and_stays_there(self):
        on_arm = self.command(CLOSING)
        self.assertEqual(on_arm["needle_slide"], on_arm["needle_driver"])
        self.assertEqual((on_arm["needle_draw"], on_arm["needle_turn"]), (0, on_arm["needle_hook_turn"]))
        self.assertLess(self.distance("needle", "suture_needle"), 1e-6)
        # positions of their own, not what the joints mimic, with which the bars would be millimetres apart here
        self.assertLess(self.distance("needle_arm_pin", "needle_hook_pin"), 1e-6)
        self.command(CLOSED)
        self.command(CLOSED, pressed=(NEEDLE_BUTTON,))
        self.assertIsNotNone(self.events.waits_for(lambda m: m.kind == ProcedureEvent.BITE), "outside the balloon is deep")
        held = self.command(OPEN)
        self.assertEqual((held["needle_driver"], held["needle_slide"], held["needle_draw"]), (0, 0.018, 0.0012))
        self.assertAlmostEqual(self.distance("needle", "suture_needle"), math.hypot(0.0108 + 0.0012, 0.0144), delta=1e-6)
        self.assertLess(self.distance("needle_arm_pin", "needle_hook_pin"), 1e-6)

    def test_the_probe_stays_in_without_one_in_the_scene(self):
        self.assertEqual(self.command(OPEN, pressed=(0,))["argon_probe"], -0.005)


if __name__ == "__main__":
    rospy.init_node("drawn_joints_test")
    rostest.rosrun("vibe_sim", "drawn_joints_test", DrawnJointsTest, sys.argv)
