#!/usr/bin/env python3
"""Two arms at one scope, and what drivers of arms may send: whoever takes over pulls nothing, and each oddity is said once."""

import sys
import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState, Joy
from vibe_testing.diagnostics import Diagnostics
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

RATE = 200  # [Hz]


class ScriptedArm:
    """Publishes the pose that a test sets."""

    def __init__(self, name):
        self.position, self.frame, self.late, self.jitter = [0.0, 0.0, 0.0], "arm_base", 0.0, 1e-6
        self.publisher = rospy.Publisher(name + "/measured_cp", PoseStamped, queue_size=10)
        self.clutch = rospy.Publisher(name + "/button1", Joy, queue_size=10, latch=True)
        self.runs = True
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def end(self):
        self.runs = False
        self.thread.join()

    def run(self):
        count = 0
        while self.runs:
            message = PoseStamped()
            message.header.stamp = rospy.Time.now() - rospy.Duration(self.late)
            message.header.frame_id = self.frame
            p = message.pose.position
            p.x, p.y, p.z = self.position
            p.x += self.jitter * (count % 2)
            message.pose.orientation.w = 1
            self.publisher.publish(message)
            count += 1
            time.sleep(1 / RATE)

    def press(self, down):
        self.clutch.publish(Joy(header=rospy.Header(stamp=rospy.Time.now()), buttons=[int(down)]))

    def reach(self, depth):
        """Away from the person, at 0.1 m/s."""
        while abs(self.position[2] + depth) > 1e-9:
            self.position[2] -= max(-5e-4, min(5e-4, depth + self.position[2]))
            time.sleep(1 / RATE)


class CrtkArmsTest(unittest.TestCase):
    def setUp(self):
        self.joints = Recorder("scope/setpoint_js", JointState)
        assert self.joints.waits_for()

    def insertion(self):
        return self.joints.newest().position[0]

    def follows(self, arm, depth, within=1e-6):
        """Whether the scope makes the motion of an arm to a depth. On a machine that stands still for the time after which an
        arm counts as silent, 0.1 s, a part of it is lost: then the arm makes it again."""
        begin = -arm.position[2]
        for _ in range(4):
            place = self.insertion()
            arm.reach(depth)
            if wait_until(lambda: abs(self.insertion() - place - (depth - begin)) < within, 5):
                return True
            arm.reach(begin)
            rospy.sleep(1)
        return False

    def test_1_an_arm_at_rest_pulls_nothing_when_the_other_lets_go(self):
        arms = [ScriptedArm(name) for name in ("left", "right")]
        for arm in arms:
            self.addCleanup(arm.end)
        nodes = []
        for name in ("left", "right"):
            nodes.append(Program("vibe_hardware", "crtk_teleop", name="teleop_" + name, arm=name))
            self.assertTrue(nodes[-1].says("drives the scope"), nodes[-1].output())
            if name == "left":
                self.assertTrue(self.follows(arms[0], 0.005))
        self.assertTrue(self.follows(arms[0], 0.033), self.insertion())
        place = self.insertion()
        arms[0].press(True)
        self.assertTrue(nodes[0].says("has let go"))
        rospy.sleep(3)  # the simulator obeys the other arm when the first has been silent for 2 s
        self.assertLess(abs(self.insertion() - place), 1e-3)
        self.assertTrue(self.follows(arms[1], 0.01, within=1e-3), self.insertion())
        for node in nodes:
            self.assertEqual(node.stop(), 0)

    def test_2_what_a_driver_does_wrong_is_said_once(self):
        begin = time.time()
        arm = ScriptedArm("arm")
        self.addCleanup(arm.end)
        diagnostics = Diagnostics(Recorder("/diagnostics", DiagnosticArray), "crtk_teleop")
        node = Program("vibe_hardware", "crtk_teleop", name="teleop")
        self.assertTrue(node.says("drives the scope"), node.output())
        arm.late = -0.0005  # a clock that is nearly the same
        arm.reach(0.01)
        self.assertEqual(node.count("off the clock"), 0)
        arm.late = 0.03
        self.assertTrue(node.says("write a longer 'delay'"))
        self.assertTrue(diagnostics.waits_for(lambda level, message, _: level == 1 and "arm.delay is 10 ms" in message))
        arm.late = 0.3
        self.assertTrue(node.says("raise 'timeout'"))
        arm.late = 0
        arm.position[0] = float("nan")
        self.assertTrue(node.says("not finite"))
        arm.position[0] = 0.0
        arm.frame = "other"
        self.assertTrue(node.says("from 'arm_base' to 'other'"))
        rospy.sleep(0.5)
        arm.position[0] = 0.2  # a jump, and then a motion in millimetres
        self.assertTrue(node.says("may publish millimetres"))
        for i in range(400):
            arm.position[0] = 0.2 + 0.03 * i
            time.sleep(1 / RATE)
        for text in ("write a longer 'delay'", "raise 'timeout'", "not finite", "to 'other'", "has jumped"):
            self.assertLessEqual(node.count(text), 1 + (time.time() - begin) / 10, node.output())
        arm.position[0], arm.jitter = 0.3, 0
        self.assertTrue(diagnostics.waits_for(
            lambda level, message, values: level < 2 and float(values["the same measurement for [s]"]) > 5))
        self.assertEqual(node.stop(), 0)


if __name__ == "__main__":
    rospy.init_node("crtk_arms_test")
    rostest.rosrun("vibe_hardware", "crtk_arms", CrtkArmsTest, sys.argv)
