#!/usr/bin/env python3
"""endoscope_camera with the endoscope of vibe_description: what the device covers of the picture, and where."""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGES = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path[:0] = [HERE, os.path.join(PACKAGES, "vibe_description", "test")]

import numpy
import rospkg
import rospy
import rostest
import tf2_msgs.msg
from ball import FRAME, Ball
from endoscope_camera_test import CAMERA, QUATERNION, Camera, distance_from_middle, pixels_of
from geometry_msgs.msg import TransformStamped
from scipy.spatial.transform import Rotation
from scope_pose import Scope, pose
from sensor_msgs.msg import Image, PointCloud2
from vibe_msgs.msg import TissueTopology
from vibe_testing.wait import wait_until

TIP = numpy.array([-0.02, 0, 0])  # of the endoscope in the ball, which looks along x [m]
LENS = TIP + (0, 0, 0.0025)  # scope_camera_mount
PARTS = ("scope_tip", "device_cap", "needle_arm", "needle_hook", "suture_needle", "argon_probe")
NEEDLE_WAY = 0.018  # of needle_driver [m]
HELD = {"needle_slide": NEEDLE_WAY, "needle_draw": 0.0012, "needle_turn": 0.4189}  # the needle in the exchange
PROBE_OUT = {"argon_probe": 0.010}
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

    def transform(self, frame, place, turn):
        message = TransformStamped(child_frame_id=frame)
        message.header.stamp, message.header.frame_id = self.clock, FRAME
        message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = place
        rotation = message.transform.rotation
        rotation.x, rotation.y, rotation.z, rotation.w = turn
        return message

    def picture(self, camera, way, joints):
        publishers = (self.topology, self.particles, self.tf)
        self.assertTrue(wait_until(lambda: min(p.get_num_connections() for p in publishers) > 0))
        shown = set()

        def drawn():
            return [(image, labels) for image in camera.images[""] for labels in camera.labels
                    if image.header.stamp == labels.header.stamp and image.header.stamp in shown]

        def shows():
            self.show(way, joints)
            shown.add(self.clock)
            return wait_until(drawn, 1)

        # one state after the other, as a simulator sends them: one that overtakes the topology or the poses is not drawn
        self.assertTrue(wait_until(shows), "no image in time; the program said: " + camera.last_words())
        image, seen = drawn()[0]
        labels = numpy.frombuffer(seen.data, numpy.uint8).reshape(image.height, image.width)
        return pixels_of(image), distance_from_middle(image), labels

    def show(self, way, joints):
        """Sends the device and the ball, with a stamp of their own."""
        type(self).clock += rospy.Duration(1)
        # the camera last: the image waits for its pose, and parts without a pose by then are not drawn
        scope = Scope(description())
        poses = scope.poses({**scope.arm(way), **joints}, pose(TIP))
        turn = lambda frame: Rotation.from_matrix(poses[frame][:3, :3]).as_quat()
        frames = [self.transform(frame, poses[frame][:3, 3], turn(frame)) for frame in PARTS]
        frames.append(self.transform(CAMERA, LENS, QUATERNION))
        self.tf.publish(tf2_msgs.msg.TFMessage(frames))
        self.particles.publish(self.ball.particles(self.clock))

    def shot(self, urdf, way=0.0, joints={}):
        """The picture, how far its pixels are from the middle, and their labels."""
        rospy.set_param("/robot_description", urdf)
        program = Camera(rate=0, width=320, height=320)
        program.labels = []
        program.subscribers.append(rospy.Subscriber("endoscope/labels", Image, program.labels.append))
        with program as camera:
            found = self.picture(camera, way, joints)
        publishers = (self.topology, self.particles, self.tf)
        wait_until(lambda: max(p.get_num_connections() for p in publishers) == 0)
        return found

    def test_device_is_at_the_edge_and_shines(self):
        empty, aside, labels = self.shot("<robot name='none'><link name='none'/></robot>")
        self.assertFalse((labels >= FIRST_PART).any())
        inside = aside < 158
        shares = {}
        for name, way in (("open", 0.0), ("closed", NEEDLE_WAY)):
            picture, _, labels = self.shot(description(), way)
            covered = (labels >= FIRST_PART) & inside  # not what differs: the device casts shadows
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

    def pixels_of_part(self, part, **shot):
        """Number of pixels with its label, and mean colour and how far right and down they are from the middle."""
        root = Scope(description()).root
        seen = sorted(link.get("name") for link in root.findall("link") if link.find("visual") is not None)
        picture, _, labels = self.shot(description(), **shot)
        found = labels == FIRST_PART + seen.index(part)
        down, right = numpy.argwhere(found).mean(axis=0) - 159.5 if found.any() else (0, 0)
        return found.sum(), picture[found].mean(axis=0) if found.any() else None, right, down

    def test_the_needle_is_where_the_exchange_holds_it(self):
        on_arm, _, right, down = self.pixels_of_part("suture_needle", way=NEEDLE_WAY)
        held, colour, held_right, held_down = self.pixels_of_part("suture_needle", joints=HELD)
        print(f"needle: {on_arm} pixels on the closed arm, {held} in the exchange")
        self.assertGreater(on_arm, 40)
        self.assertGreater(held, 40)
        self.assertGreater(min(held_right, held_down), 20, "at the lower right, where the exchange is")
        self.assertGreater(colour[0], 1.15 * colour[2], "golden, with its blue thread")
        opened, _, _, open_down = self.pixels_of_part("suture_needle")
        self.assertLess(open_down, -40, "control: on the open arm it is above")
        gone, _, _, _ = self.pixels_of_part("suture_needle", joints={**HELD, "needle_draw": NEEDLE_WAY})
        self.assertEqual(gone, 0, "nothing is left of the one that has been dropped")

    def test_the_probe_is_seen_only_while_it_is_out(self):
        out, colour, right, down = self.pixels_of_part("argon_probe", joints=PROBE_OUT)
        print(f"probe: {out} pixels")
        self.assertGreater(out, 3000)
        self.assertGreater(colour[2], 1.2 * colour[0], "blue beside the red of the wall")
        self.assertTrue(right < -20 and down > 20, "from the lower left")
        self.assertEqual(self.pixels_of_part("argon_probe")[0], 0)

    def test_a_mesh_that_is_missing_is_left_out(self):
        rest = description()
        broken, aside, _ = self.shot(rest.replace("meshes/cap.obj", "meshes/nowhere.obj"))
        whole, _, _ = self.shot(rest)
        gone = (abs(whole - broken).max(axis=2) > 12) & (aside < 158)
        self.assertGreater(gone.mean(), 0.03, "the cap is not drawn, the rest is")


if __name__ == "__main__":
    rospy.init_node("device_view_test")
    rostest.rosrun("vibe_endoscope", "device_view_test", DeviceViewTest, sys.argv)
