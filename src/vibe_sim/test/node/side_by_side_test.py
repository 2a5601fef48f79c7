#!/usr/bin/env python3
"""Two simulators in one graph, each in a namespace with a transform tree of its own."""

import sys
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from node_test_support import scene
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

SIDES = ("left", "right")


class SideBySideTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.poses = {side: Recorder("/{}/scope/measured_cp".format(side), PoseStamped) for side in SIDES}
        cls.transforms = {side: Recorder("/{}/tf_static".format(side), TFMessage) for side in SIDES}
        cls.programs = [
            Program(
                "vibe_sim",
                "sim_node",
                "/tf_static:=tf_static",
                env={"ROS_NAMESPACE": side},
                scene=scene("balloon.yaml"),
            )
            for side in SIDES
        ]
        for side in SIDES:
            assert cls.poses[side].waits_for(lambda m: True, 30), "\n".join(p.output() for p in cls.programs)

    @classmethod
    def tearDownClass(cls):
        for program in cls.programs:
            program.stop()

    def test_a_command_moves_one_of_them_only(self):
        command = rospy.Publisher("/left/scope/servo_jp", JointState, queue_size=1, latch=True)
        start = {side: self.poses[side].messages[-1].pose.position.x for side in SIDES}
        command.publish(JointState(position=[0.03, 0, 0, 0]))
        moved = lambda side: self.poses[side].messages[-1].pose.position.x - start[side]
        self.assertTrue(wait_until(lambda: moved("left") > 0.029))
        self.assertAlmostEqual(moved("right"), 0, places=6)

    def test_a_service_concerns_one_of_them_only(self):
        self.assertTrue(rospy.ServiceProxy("/left/pause", SetBool)(True).success)
        rospy.sleep(0.3)
        count = {side: len(self.poses[side].messages) for side in SIDES}
        self.assertTrue(wait_until(lambda: len(self.poses["right"].messages) > count["right"] + 30))
        self.assertEqual(len(self.poses["left"].messages), count["left"])
        self.assertTrue(rospy.ServiceProxy("/left/pause", SetBool)(False).success)

    def test_each_has_its_own_transforms(self):
        for side in SIDES:
            self.assertTrue(self.transforms[side].waits_for(lambda m: m.transforms[0].child_frame_id == "stomach"))
        published, _, _ = rosgraph.Master("/side_by_side").getSystemState()
        self.assertEqual([nodes for topic, nodes in published if topic == "/tf_static"], [])

    def test_all_names_are_in_the_namespace(self):
        published, _, _ = rosgraph.Master("/side_by_side").getSystemState()
        outside = [t for t, nodes in published if any("sim_node" in n for n in nodes) and not t.startswith(("/left", "/right"))]
        self.assertEqual(outside, ["/rosout"])


if __name__ == "__main__":
    rospy.init_node("side_by_side_test")
    rostest.rosrun("vibe_sim", "side_by_side", SideBySideTest, sys.argv)
