#!/usr/bin/env python3
"""rviz with the shipped configuration and invalid, too many or too large messages: a status reports them, the next
valid message is drawn, and rviz keeps running."""

import time
import unittest

import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point, TransformStamped
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from vibe_msgs.msg import Bleeding, SutureArray, TissueTopology

import tissue_messages as good
from rviz_under_test import RvizUnderTest

FRAMES = 5  # drawn after each message
STORM_RATE, STORM = 600.0, 3000  # ten times the simulator's [1/s], and how many messages
MOST_GROWTH = 100e6  # of memory in a storm [B]
ROWS, AROUND = 300, 200  # 60,002 particles


def set_all(name, value):
    def change(points):
        points[name] = value

    return change


def set_one(name, value):
    def change(points):
        points[name][len(points) // 2] = value

    return change


class Robustness(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        config = rospkg.RosPack().get_path("vibe_description") + "/rviz/vibe.rviz"
        cls.topology = rospy.Publisher("/tissue/topology", TissueTopology, queue_size=1, latch=True)
        cls.particles = rospy.Publisher("/tissue/particles", PointCloud2, queue_size=10)
        cls.sutures = rospy.Publisher("/sutures", SutureArray, queue_size=10, latch=True)
        cls.transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        stomach = TransformStamped(child_frame_id="stomach")
        stomach.header.frame_id, stomach.transform.rotation.w = "world", 1.0
        cls.transforms.publish(TFMessage([stomach]))
        cls.rviz = RvizUnderTest(config)
        cls.rviz.wait_for(lambda: cls.particles.get_num_connections() > 0, "rviz does not listen to the particles")

    @classmethod
    def tearDownClass(cls):
        cls.rviz.stop()

    def setUp(self):
        self.show(good.topology(), good.particles(), good.sutures())

    def show(self, topology, particles, sutures):
        """Publishes valid messages until they are drawn."""
        self.topology.publish(topology)
        self.sutures.publish(sutures)
        count = len(topology.rest_positions) // 3
        self.rviz.wait_for_status("Stomach", "Topology", "Ok", "{} particles".format(count))
        deadline = time.monotonic() + 60
        while self.rviz.status("Stomach", "Particles")[0] != "Ok":  # not latched
            self.assertLess(time.monotonic(), deadline, self.rviz.status("Stomach", "Particles"))
            self.particles.publish(particles)
            time.sleep(0.2)
        self.rviz.wait_for_status("Sutures", "Message", "Ok", "")
        self.rviz.wait_for_frames(FRAMES)

    def refuses(self, publisher, message, status, part):
        """One invalid message is reported, and rviz keeps running."""
        publisher.publish(message)
        display = "Sutures" if publisher is self.sutures else "Stomach"
        self.rviz.wait_for_status(display, status, "Error", part)
        self.rviz.wait_for_frames(FRAMES)

    def test_particles_that_are_wrong(self):
        cases = [
            (good.particles(revision=7), "revision 7"),
            (good.particles(change=set_one("x", float("nan"))), "invalid"),
            (good.particles(change=set_all("z", float("inf"))), "invalid"),
            (good.particles(change=set_one("y", 3e38)), "invalid"),
            (good.particles(rows=41), "particles"),
            (good.particles(rows=0 + 2, around=3), "particles"),
        ]
        for message, part in cases:
            with self.subTest(part):
                self.refuses(self.particles, message, "Particles", part)
                self.setUp()

    def test_clouds_that_are_cut(self):
        for spoil in (
            lambda m: setattr(m, "data", m.data[:-1]),
            lambda m: setattr(m, "data", b""),
            lambda m: setattr(m, "point_step", 4),
            lambda m: setattr(m, "width", 2**31),
            lambda m: setattr(m.fields[0], "offset", 2**32 - 2),
            lambda m: m.fields.pop(0),
            lambda m: setattr(m.fields[1], "datatype", 8),
        ):
            message = good.particles()
            spoil(message)
            self.refuses(self.particles, message, "Particles", "")
            self.setUp()

    def test_topologies_that_are_garbage(self):
        for spoil in (
            lambda m: setattr(m, "triangles", [0, 1, 2**32 - 1]),
            lambda m: setattr(m, "triangles", [0, 1]),
            lambda m: setattr(m, "rest_positions", []),
            lambda m: setattr(m, "rest_positions", [float("nan")] * 9),
            lambda m: setattr(m, "region", b"\x00"),
            lambda m: setattr(m, "render_offsets", [0, 5, 2]),
            lambda m: setattr(m, "rest_positions", [1e30] * len(m.rest_positions)),
            lambda m: (setattr(m, "render_offsets", [0, 1]), setattr(m, "render_particles", [2**31])),
        ):
            message = good.topology()
            spoil(message)
            self.refuses(self.topology, message, "Topology", "")
            self.setUp()

    def test_sutures_that_are_garbage(self):
        for spoil in (
            lambda m: setattr(m.sutures[0], "stage", 250),
            lambda m: setattr(m.sutures[0], "thread_offsets", [0, 7, 2]),
            lambda m: setattr(m.sutures[0].bites[0].position, "x", float("nan")),
            lambda m: setattr(m.sutures[0], "tension", [float("inf"), 1.0]),
            lambda m: setattr(m.sutures[0], "transitions", [99, -1]),
        ):
            message = good.sutures()
            spoil(message)
            self.refuses(self.sutures, message, "Message", "")
            self.setUp()

    def test_bleeding_on_walls_that_come_change_and_are_wrong(self):
        """Blood follows the wall of the newest valid messages, whatever else comes."""
        message = good.sutures()
        for place in (Point(0.0, 0.07, 0.0), Point(0.02, 0.07, 0.03), Point(5.0, 0.0, 0.0)):  # the last is far from it
            message.bleedings.append(
                Bleeding(suture=0, bite=0, brisk=True, position=place, rate=2.5e-7, amount=3e-6, begin=0.0)
            )
        self.sutures.publish(message)
        self.rviz.wait_for_status("Sutures", "Message", "Ok", "3 bleedings")
        for topology, particles in (
            (good.topology(), good.particles()),
            (good.topology(20, 20, revision=2), good.particles(20, 20, revision=2)),
            (good.topology(20, 20, revision=2), good.particles(20, 20, revision=2, change=set_all("x", 0.0))),
        ):
            self.show(topology, particles, message)
        wrong = good.particles(20, 20, revision=2, change=set_one("y", float("nan")))
        self.refuses(self.particles, wrong, "Particles", "")
        message.bleedings = []
        self.sutures.publish(message)
        self.rviz.wait_for_status("Sutures", "Message", "Ok", "0 bleedings")
        self.rviz.wait_for_frames(FRAMES)

    def test_strain_that_is_not_finite(self):
        """Strain affects colours only, so there is no status, and rviz keeps running."""
        for value in (float("nan"), float("inf"), 3e38):
            self.particles.publish(good.particles(change=set_all("strain", value)))
            self.rviz.wait_for_frames(FRAMES)
        self.assertEqual(self.rviz.status("Stomach", "Particles")[0], "Ok")

    def test_organs_without_anything_to_draw(self):
        message = good.topology()
        message.triangles = []
        self.show(message, good.particles(), good.sutures())
        message.triangles, message.render_offsets = [0, 1, 2], [0]
        self.topology.publish(message)
        self.particles.publish(good.particles())
        self.rviz.wait_for_frames(FRAMES)

    def test_unknown_frame(self):
        message = good.particles()
        message.header.frame_id = "nowhere"
        self.refuses(self.particles, message, "Transform", "nowhere")
        message = good.sutures()
        message.header.frame_id = "nowhere"
        self.refuses(self.sutures, message, "Transform", "nowhere")
        self.sutures.publish(good.sutures())
        self.rviz.wait_for_status("Sutures", "Transform", "Ok", "")

    def test_storm(self):
        """At ten times the rate of the simulator rviz keeps drawing, and its memory does not grow."""
        particles, sutures = good.particles(), good.sutures()
        before = self.rviz.report()
        rate, begin = rospy.Rate(STORM_RATE), time.monotonic()
        for _ in range(STORM):
            particles.header.stamp = sutures.header.stamp = rospy.Time.now()
            self.particles.publish(particles)
            self.sutures.publish(sutures)
            rate.sleep()
        during = self.rviz.report()
        reached = STORM / (time.monotonic() - begin)
        print("storm: {:.0f} messages/s of each, {} frames".format(reached, during["frames"] - before["frames"]))
        self.assertGreater(during["frames"], before["frames"])
        self.refuses(self.particles, good.particles(revision=8), "Particles", "revision 8")
        self.assertLess(self.rviz.report()["memory"] - before["memory"], MOST_GROWTH)

    def test_60000_particles(self):
        topology = good.topology(ROWS, AROUND)
        self.show(topology, good.particles(ROWS, AROUND), good.sutures())
        for k in range(10):
            self.particles.publish(good.particles(ROWS, AROUND, change=set_all("strain", 0.01 * k)))
            self.rviz.wait_for_frames(1)
        self.assertEqual(self.rviz.status("Stomach", "Particles")[0], "Ok")


if __name__ == "__main__":
    rospy.init_node("rviz_robustness")
    rostest.rosrun("vibe_rviz_plugins", "rviz_robustness", Robustness)
