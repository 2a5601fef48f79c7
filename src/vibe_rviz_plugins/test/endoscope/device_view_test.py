#!/usr/bin/env python3
"""endoscope_camera with the endoscope of vibe_description: what the device covers of the picture, and where."""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, HERE)

import numpy
import rospkg
import rospy
import rostest
import tf2_msgs.msg
from ball import FRAME, Ball
from endoscope_camera_test import CAMERA, QUATERNION, Program, distance_from_middle, pixels_of, wait_until
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import Image, PointCloud2
from vibe_msgs.msg import TissueTopology

TIP = numpy.array([-0.02, 0, 0])  # of the endoscope in the ball, which looks along x [m]
LENS = TIP + (0, 0, 0.0025)  # scope_camera_mount
NEEDLE_OPEN = TIP + (0.0148, -0.0025, 0.0134)
CLOSING = numpy.array([-0.0108, 0, -0.0144])  # the way of needle_driver
STRAIGHT = (0, 0, 0, 1)
FIRST_PART = 128  # label of the instrument


def description():
    with open(os.path.join(rospkg.RosPack().get_path("vibe_description"), "urdf", "scope.urdf"), encoding="utf-8") as file:
        return file.read()


class DeviceViewTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ball = Ball(4)
        cls.topology = rospy.Publisher("tissue/topology", TissueTopology, queue_size=1, latch=True)
        cls.particles = rospy.Publisher("tissue/particles", PointCloud2, queue_size=5)
        cls.tf = rospy.Publisher("/tf", tf2_msgs.msg.TFMessage, queue_size=100)
        cls.topology.publish(cls.ball.topology(rospy.Time.now()))
        cls.clock = rospy.Time.now() - rospy.Duration(1000)

    def transform(self, frame, place, turn=STRAIGHT):
        message = TransformStamped(child_frame_id=frame)
        message.header.stamp, message.header.frame_id = self.clock, FRAME
        message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = place
        rotation = message.transform.rotation
        rotation.x, rotation.y, rotation.z, rotation.w = turn
        return message

    def picture(self, camera, needle=NEEDLE_OPEN):
        type(self).clock += rospy.Duration(1)
        publishers = (self.topology, self.particles, self.tf)
        self.assertTrue(wait_until(lambda: min(p.get_num_connections() for p in publishers) > 0))
        # the camera last: the image waits for its pose, and parts without a pose by then are not drawn
        frames = [self.transform(frame, TIP) for frame in ("scope_tip", "device_cap")]
        frames += [self.transform("needle", needle), self.transform(CAMERA, LENS, QUATERNION)]
        self.tf.publish(tf2_msgs.msg.TFMessage(frames))
        self.particles.publish(self.ball.particles(self.clock))
        image, _ = camera.last(self.clock)
        of_stamp = lambda: [m for m in camera.labels if m.header.stamp == self.clock]
        self.assertTrue(wait_until(of_stamp), "no labels in time")
        labels = numpy.frombuffer(of_stamp()[0].data, numpy.uint8).reshape(image.height, image.width)
        return pixels_of(image), distance_from_middle(image), labels >= FIRST_PART

    def shot(self, urdf, needle=NEEDLE_OPEN):
        rospy.set_param("/robot_description", urdf)
        program = Program(rate=0, width=320, height=320)
        program.labels = []
        program.subscribers.append(rospy.Subscriber("endoscope/labels", Image, program.labels.append))
        with program as camera:
            found = self.picture(camera, needle)
        publishers = (self.topology, self.particles, self.tf)
        wait_until(lambda: max(p.get_num_connections() for p in publishers) == 0)
        return found

    def test_device_is_at_the_edge_and_shines(self):
        empty, aside, device = self.shot("<robot name='none'><link name='none'/></robot>")
        self.assertFalse(device.any())
        inside = aside < 158
        shares = {}
        for name, needle in (("open", NEEDLE_OPEN), ("closed", NEEDLE_OPEN + CLOSING)):
            picture, _, device = self.shot(description(), needle)
            covered = device & inside  # not what differs: the device casts shadows
            differs = abs(picture - empty).max(axis=2) > 12
            self.assertGreater(differs[covered].mean(), 0.9, name + ": it is drawn where the labels say")
            shares[name] = covered.sum() / inside.sum()
            print(f"{name}: {100 * shares[name]:.1f} % of the picture")
            self.assertGreater(shares[name], 0.06, name)
            self.assertLess(shares[name], 0.13, name)
            self.assertEqual(covered[aside < 40].sum(), 0, name + ": 17 degrees about the axis are free")
            colours = picture[covered]
            # grey of steel beside the red of the wall, from dark gaps to highlights
            grey = numpy.ptp(colours, axis=1) < 60
            self.assertGreater(grey.mean(), 0.5, name)
            dark, middle, bright = numpy.percentile(colours.mean(axis=1), (2, 50, 98))
            print(f"{name}: levels {dark:.0f}, {middle:.0f}, {bright:.0f}")
            self.assertGreater(bright, 1.2 * middle, name + ": highlights")
            self.assertLess(dark, 0.75 * middle, name + ": dark parts")
        self.assertNotEqual(shares["open"], shares["closed"])
        # control: half of the wall's own pixels are redder than that
        self.assertLess((numpy.ptp(empty[inside], axis=1) < 60).mean(), 0.2)

    def test_a_mesh_that_is_missing_is_left_out(self):
        rest = description()
        broken, aside, _ = self.shot(rest.replace("meshes/cap.obj", "meshes/nowhere.obj"))
        whole, _, _ = self.shot(rest)
        gone = (abs(whole - broken).max(axis=2) > 12) & (aside < 158)
        self.assertGreater(gone.mean(), 0.03, "the cap is not drawn, the rest is")


if __name__ == "__main__":
    rospy.init_node("device_view_test")
    rostest.rosrun("vibe_rviz_plugins", "device_view_test", DeviceViewTest, sys.argv)
