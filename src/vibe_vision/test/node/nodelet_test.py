#!/usr/bin/env python3
"""The vision node as a nodelet: a camera and a tracker of its images in one process."""

import unittest

import rospy
import rostest
from vibe_msgs.msg import InstrumentTrackArray
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until
from vision_test_support import Scene, errors_of, rms

FRAMES = 147


class NodeletTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = Scene("moving", FRAMES)

    @classmethod
    def tearDownClass(cls):
        cls.scene.remove()

    def test_two_nodelets_share_images(self):
        first = Recorder("suturing_device/tracking", InstrumentTrackArray)
        second = Recorder("second/suturing_device/tracking", InstrumentTrackArray)
        manager = Program("nodelet", "nodelet", "manager", name="manager")
        follower = Program(
            "nodelet", "nodelet", "load", "vibe_vision/VisionNodelet", "/manager", "image:=/image_raw", "__ns:=second",
            name="vision", config=self.scene.config, source="topic",
        )  # fmt: skip
        camera = Program(
            "nodelet", "nodelet", "load", "vibe_vision/VisionNodelet", "/manager",
            name="camera", config=self.scene.config, source=self.scene.source, loop="true",
        )  # fmt: skip
        try:
            enough = wait_until(lambda: sum(m.exposure > 0 for m in second.messages) > 100, 30)
            self.assertTrue(enough, manager.output() + follower.output() + camera.output())
            tracks = [m for m in first.messages if 0 < m.exposure and m.frame_sequence < FRAMES]
            slides, _ = errors_of(self.scene, tracks, "needle_driver")
            self.assertLess(rms(slides), 2e-6)
            stamps = {m.header.stamp.to_nsec(): m.instruments[1] for m in first.messages}
            same = [(t, stamps[m.header.stamp.to_nsec()]) for m in second.messages for t in m.instruments[1:]
                    if m.exposure > 0 and m.header.stamp.to_nsec() in stamps]  # fmt: skip
            self.assertGreater(len(same), 50)
            self.assertLess(max(abs(a.slide - b.slide) for a, b in same[10:]), 2e-6)
        finally:
            for program in (follower, camera, manager):
                program.stop()

    def test_wrong_parameters_are_said_by_the_manager(self):
        manager = Program("nodelet", "nodelet", "manager", name="manager2")
        nodelet = Program("nodelet", "nodelet", "load", "vibe_vision/VisionNodelet", "manager2", name="wrong")
        try:
            self.assertTrue(manager.says("Parameter /wrong/config is not set"), manager.output())
            self.assertNotEqual(nodelet.ends(10), 0)
            self.assertIsNone(manager.process.poll())  # other nodelets live on
        finally:
            nodelet.stop()
            manager.stop()


if __name__ == "__main__":
    rospy.init_node("nodelet_test")
    rostest.rosrun("vibe_vision", "nodelet", NodeletTest)
