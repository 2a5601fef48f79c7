#!/usr/bin/env python3
"""steer_to_particle.py brings the tip to 15 mm from a particle that it did not look at before."""

import os
import subprocess
import sys
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import JointState, Joy, PointCloud2
from vibe_msgs.msg import OperatingState, StepResult

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../scripts/steer_to_particle.py")


def newest(topic, kind):
    return rospy.wait_for_message(topic, kind, 60)


class SteerToParticle(unittest.TestCase):
    def insufflate(self):
        """Room for the scope."""
        buttons = rospy.Publisher("scope/buttons", Joy, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: buttons.publish(Joy(buttons=[0, 0, 0, 0, 0, 1])))
        while not newest("step_result", StepResult).pressure_reached:
            pass
        timer.shutdown()

    def insert(self):
        move = rospy.Publisher("scope/move_jp", JointState, queue_size=1, latch=True)
        move.publish(JointState(position=[0.08, 0, 0.3, 0]))
        rospy.sleep(1)
        while newest("scope/operating_state", OperatingState).is_busy:
            rospy.sleep(0.1)

    def distances(self):
        cloud = newest("tissue/particles", PointCloud2)
        wall = numpy.array(list(point_cloud2.read_points(cloud, ("x", "y", "z"))))
        tip = newest("scope/measured_cp", PoseStamped).pose
        axis = [1 - 2 * (tip.orientation.y**2 + tip.orientation.z**2),
                2 * (tip.orientation.x * tip.orientation.y + tip.orientation.z * tip.orientation.w),
                2 * (tip.orientation.x * tip.orientation.z - tip.orientation.y * tip.orientation.w)]
        way = wall - [tip.position.x, tip.position.y, tip.position.z]
        distance = numpy.linalg.norm(way, axis=1)
        return distance, way @ axis / distance

    def test_steers_to_a_particle(self):
        self.insufflate()
        self.insert()
        distance, cosine = self.distances()
        # one that is 30 to 40 degrees off the line of sight
        aside = numpy.where((cosine > 0.77) & (cosine < 0.87))[0]
        self.assertGreater(len(aside), 0)
        particle = int(aside[numpy.argmin(distance[aside])])
        self.assertGreater(distance[particle], 0.02, "control: it is not there already")
        subprocess.run([sys.executable, SCRIPT, "_particle:={}".format(particle)], check=True, timeout=150)
        self.assertAlmostEqual(self.distances()[0][particle], 0.015, delta=0.003)


if __name__ == "__main__":
    rospy.init_node("steer_to_particle_test")
    rostest.rosrun("vibe_example_controller", "steer_to_particle", SteerToParticle)
