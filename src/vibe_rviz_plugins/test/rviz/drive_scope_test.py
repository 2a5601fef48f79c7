#!/usr/bin/env python3
"""The tool 'Drive scope' in rviz: keys and mouse in, topics and picture out."""

import subprocess
import threading
import time
import unittest

import rospkg
import rospy
import rostest
import yaml
from sensor_msgs.msg import JointState, Joy
from vibe_testing.recorder import Recorder

from rviz_under_test import RvizUnderTest
from small_simulator import SUTURING_DEVICE, SCOPE, START, SmallSimulator

RVIZ = rospkg.RosPack().get_path("vibe_description") + "/rviz/"
INSERTION_SPEED = 0.03  # with the properties of the shipped configuration [m/s]
INSERTION_ACCELERATION = 0.15 / 0.3  # from rest to the limit of the URDF in 0.3 s [m/s^2]
WHEEL = 2e-3  # insertion per notch [m]
PANELS = "840x560+20+110"  # of the picture: where keys and state are shown, without the line above them


class DriveScope(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulator = SmallSimulator()
        cls.simulator.publishes = False
        cls.scope = Recorder("/scope/servo_jp", JointState)
        cls.suturing_device = Recorder("/suturing_device/input/joint_states", JointState)
        cls.buttons = Recorder("/scope/buttons", Joy)
        cls.simulator.start()
        cls.rviz = RvizUnderTest(RVIZ + "drive.rviz")
        cls.rviz.wait_for(lambda: cls.rviz.report()["tool"] == "Drive Scope", "the tool is not active at the start")
        cls.rviz.tell("focus_in")
        time.sleep(2)
        cls.silent_at_first = not cls.scope.messages and not cls.buttons.messages
        cls.simulator.publishes = True

    @classmethod
    def tearDownClass(cls):
        cls.rviz.stop()
        cls.simulator.stop()

    def setUp(self):
        """The tool drives, and everything is at its start."""
        self.rviz.tell("focus_out", "tool Move Camera")
        self.wait(lambda: not self.scope.is_connected() and not self.buttons.is_connected(), "silence")
        self.simulator.clock_runs = self.simulator.runs = self.simulator.publishes = True
        self.simulator.reset()
        time.sleep(0.2)
        self.scope.clear(), self.suturing_device.clear(), self.buttons.clear()
        self.rviz.tell("tool Drive Scope")
        for recorder in (self.scope, self.suturing_device, self.buttons):
            self.wait(lambda: recorder.messages, "messages of the tool on " + recorder.subscriber.name)

    def wait(self, condition, what):
        self.rviz.wait_for(condition, "no " + what, 20)

    def tell_and_wait(self, *lines):
        """Until rviz has acted; it may draw only one picture a second."""
        self.rviz.tell(*lines)
        self.rviz.wait_for_frames(4)

    def joint(self, name):
        recorder = self.scope if name in SCOPE else self.suturing_device
        message = recorder.messages[-1]
        return message.position[message.name.index(name)]

    def pressed(self):
        return list(self.buttons.messages[-1].buttons)

    def wait_for_buttons(self, expected):
        self.wait(lambda: self.pressed() == expected, "buttons {}".format(expected))

    def rest(self):
        """Until the joints stand still; returns the insertion."""
        last, since = None, time.monotonic()
        while time.monotonic() - since < 0.5:
            if self.joint("insertion") != last:
                last, since = self.joint("insertion"), time.monotonic()
            time.sleep(0.02)
        return last

    def test_silent_without_a_simulator(self):
        self.assertTrue(self.silent_at_first)

    def test_begins_where_the_simulator_is(self):
        time.sleep(1)
        for message in self.scope.messages + self.suturing_device.messages:
            for name, position in zip(message.name, message.position):
                self.assertEqual(position, START[name], name)
        self.assertEqual(self.scope.messages[0].name, SCOPE)
        self.assertEqual(self.suturing_device.messages[0].name, SUTURING_DEVICE)

    def test_key_moves_a_joint_smoothly(self):
        self.rviz.tell("down Key_W")
        self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.03, "motion")
        self.rviz.tell("repeat Key_W", "repeat Key_W", "up Key_W")
        self.assertGreater(self.rest(), START["insertion"] + 0.03)
        messages = self.scope.messages
        times = [message.header.stamp.to_sec() for message in messages]
        places = [message.position[0] for message in messages]
        last_speed, last_passed = 0.0, 0.0
        for k in range(1, len(messages)):
            passed = times[k] - times[k - 1]
            self.assertGreater(passed, 0, "stamps repeat")
            speed = (places[k] - places[k - 1]) / passed
            self.assertLessEqual(abs(speed), INSERTION_SPEED * 1.001)
            # mean speeds of two intervals, half of each apart
            most = INSERTION_ACCELERATION * (passed + last_passed) / 2
            self.assertLess(abs(speed - last_speed), most + 1e-6)
            last_speed, last_passed = speed, passed
        self.assertEqual([message.position[1:] for message in messages], [messages[0].position[1:]] * len(messages))

    def test_rate_is_that_of_the_clock(self):
        """Whatever the frame rate of rviz."""
        time.sleep(0.5)
        self.scope.clear()
        begin = self.simulator.now
        time.sleep(3)
        messages = len(self.scope.messages) / (self.simulator.now - begin)
        self.assertGreater(messages, 40)
        self.assertLess(messages, 61)

    def test_focus_loss_releases_keys_and_buttons(self):
        self.rviz.tell("down Key_W", "down Key_Space", "click Key_I")
        self.wait_for_buttons([1, 0, 0, 0, 0, 1])
        self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.01, "motion")
        self.rviz.tell("focus_out")
        self.wait_for_buttons([0, 0, 0, 0, 0, 1])  # gas is switched, not held
        end = self.rest()
        self.tell_and_wait("repeat Key_W", "up Key_W")
        self.assertEqual(self.joint("insertion"), end)

    def test_a_key_ends_whatever_its_release_is_called(self):
        """Shift, or another layout, may have come between; what counts is the place of the key."""
        self.rviz.tell("down Key_W 25")
        self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.005, "motion")
        self.rviz.tell("up Key_Eacute 26")  # control: another key
        at = self.joint("insertion")
        self.wait(lambda: self.joint("insertion") > at + 0.005, "motion")
        self.rviz.tell("up Key_Eacute 25")
        self.rest()

    def test_without_focus_loss_the_joint_keeps_moving(self):
        """Negative control of the test above."""
        self.rviz.tell("down Key_W")
        self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.01, "motion")
        time.sleep(1)
        self.assertGreater(self.joint("insertion"), START["insertion"] + 0.02)

    def test_buttons(self):
        self.rviz.tell("click Key_G")
        self.wait_for_buttons([0, 1, 0, 0, 0, 0])
        self.rviz.tell("down Key_C")
        self.wait_for_buttons([0, 1, 0, 0, 1, 0])
        self.rviz.tell("up Key_C", "click Key_G")
        self.wait_for_buttons([0, 0, 0, 0, 0, 0])
        self.rviz.tell("click Key_N")
        self.wait(lambda: any(message.buttons[2] for message in self.buttons.messages), "press of the needle")
        self.wait_for_buttons([0, 0, 0, 0, 0, 0])

    def test_wheel_and_drag(self):
        self.rviz.tell("wheel 3")
        self.wait(lambda: abs(self.joint("insertion") - START["insertion"] - 3 * WHEEL) < 1e-6, "insertion by wheel")
        self.rviz.tell("drag 40 -60")
        self.wait(lambda: self.joint("tip_up_down") > START["tip_up_down"] + 0.25, "bending up")
        self.wait(lambda: self.joint("tip_left_right") < START["tip_left_right"] - 0.15, "bending to the right")

    def test_nothing_is_published_while_time_stands_still(self):
        for stop in ("clock_runs", "runs", "publishes"):
            self.simulator.tell_state()
            setattr(self.simulator, stop, False)
            self.simulator.tell_state()
            time.sleep(1)
            self.scope.clear(), self.suturing_device.clear(), self.buttons.clear()
            self.tell_and_wait("down Key_W")
            self.tell_and_wait("up Key_W")
            self.assertEqual((self.scope.messages, self.suturing_device.messages), ([], []), stop)
            if stop == "runs":
                self.assertEqual(self.buttons.messages, [])
            setattr(self.simulator, stop, True)
            self.simulator.tell_state()
            self.wait(lambda: self.scope.messages, "messages after the pause")
            self.assertEqual(self.joint("insertion"), START["insertion"])

    def test_reset_is_followed(self):
        self.rviz.tell("down Key_S")
        self.wait(lambda: self.joint("insertion") < 0.05, "motion")
        self.rviz.tell("up Key_S")
        self.rest()
        self.simulator.reset()  # a command that is under way may still move it a little
        self.wait(lambda: abs(self.joint("insertion") - START["insertion"]) < 0.02, "return to the new state")
        time.sleep(1)
        self.assertLess(abs(self.simulator.joints["insertion"] - START["insertion"]), 0.02)

    def test_another_device_is_respected(self):
        device = rospy.Publisher("/scope/input/joint_states", JointState, queue_size=10)
        message = JointState(name=SCOPE, position=[0.2, 0, 0, 0])
        since = time.monotonic()
        while time.monotonic() - since < 2:
            message.header.stamp = rospy.Time.now()
            device.publish(message)
            time.sleep(0.02)
            if time.monotonic() - since < 1:
                self.scope.clear()
        self.assertEqual(self.scope.messages, [])
        device.unregister()
        self.wait(lambda: self.scope.messages, "messages after the device is gone")
        self.assertAlmostEqual(self.scope.messages[0].position[0], 0.2, 6)

    def test_buttons_of_another_node_are_respected(self):
        """The joints can be driven all the same."""
        self.rviz.tell("tool Move Camera")
        self.wait(lambda: not self.buttons.is_connected(), "silence")
        other = rospy.Publisher("/scope/buttons", Joy, queue_size=10)
        ends = threading.Event()

        def press():
            while not ends.wait(0.05):
                other.publish(Joy(buttons=[0, 1, 0, 0, 0, 0]))

        thread = threading.Thread(target=press)
        thread.start()
        try:
            time.sleep(1)
            self.scope.clear()
            self.rviz.tell("tool Drive Scope")
            self.wait(lambda: self.scope.messages, "joints")
            self.rviz.tell("down Key_Space", "down Key_W")
            self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.01, "motion")
            time.sleep(1.5)
            self.assertEqual({tuple(message.buttons) for message in self.buttons.messages[-20:]}, {(0, 1, 0, 0, 0, 0)})
        finally:
            ends.set()
            thread.join()
            other.unregister()
        self.buttons.clear()
        self.rviz.tell("focus_out")
        self.wait(lambda: self.buttons.messages, "control of the buttons")
        self.assertEqual(self.pressed(), [0, 1, 0, 0, 0, 0], "the helix stays as it was")

    def test_leaving_the_tool_falls_silent(self):
        self.rviz.tell("down Key_W", "down Key_Space", "click Key_G")
        self.wait_for_buttons([1, 1, 0, 0, 0, 0])
        self.wait(lambda: self.joint("insertion") > START["insertion"] + 0.005, "motion")
        self.rviz.tell("tool Move Camera")
        self.wait(lambda: not self.scope.is_connected() and not self.buttons.is_connected(), "silence")
        self.assertEqual(self.pressed(), [0, 1, 0, 0, 0, 0], "the helix must not let go")
        speeds = [b.position[0] - a.position[0] for a, b in zip(self.scope.messages[-6:], self.scope.messages[-5:])]
        self.assertLess(speeds[-1], 0.5 * INSERTION_SPEED / 60, "it brakes")

    def test_escape_leaves_and_d_comes_back(self):
        self.rviz.tell("click Key_Escape")
        self.wait(lambda: self.rviz.report()["tool"] == "Move Camera", "other tool")
        self.rviz.tell("click Key_D")
        self.wait(lambda: self.rviz.report()["tool"] == "Drive Scope", "tool")
        self.tell_and_wait("click Key_M", "click Key_P")  # keys of other tools
        self.assertEqual(self.rviz.report()["tool"], "Drive Scope")

    def difference(self, before, after):
        """Pixels of the overlay that differ."""
        crop = ["-crop", PANELS, "+repage"]
        for file in (before, after):
            subprocess.run(["convert", file, *crop, file], check=True)
        answer = subprocess.run(["compare", "-metric", "AE", "-fuzz", "5%", before, after, "null:"], stderr=-1, check=False)
        return float(answer.stderr.split()[0])

    def steady_picture(self, name):
        self.rviz.wait_for_frames(8)
        return self.rviz.picture(name)

    def test_overlay(self):
        shown = self.steady_picture("shown.png")
        self.assertLess(self.difference(shown, self.steady_picture("again.png")), 200)
        shown = self.steady_picture("shown.png")
        self.rviz.tell("click Key_H")
        hidden = self.steady_picture("hidden.png")
        self.rviz.tell("click Key_F1", "down Key_Space")
        self.assertGreater(self.difference(shown, hidden), 50000)
        shown, lit = self.steady_picture("lit.png"), None
        self.rviz.tell("up Key_Space")
        self.wait_for_buttons([0, 0, 0, 0, 0, 0])
        lit = self.steady_picture("dark.png")
        changed = self.difference(shown, lit)
        self.assertGreater(changed, 500)
        self.assertLess(changed, 5000)

    def test_every_property_has_a_help_sentence(self):
        self.assertEqual(self.rviz.report()["help"]["without_help"], [])

    def test_configuration_is_the_usual_one_with_other_tools(self):
        configurations = []
        for name in ("vibe.rviz", "drive.rviz"):
            with open(RVIZ + name, encoding="utf-8") as text:
                configurations.append(yaml.safe_load(text))
            configurations[-1]["Visualization Manager"].pop("Tools")
        self.assertEqual(*configurations)


if __name__ == "__main__":
    rospy.init_node("drive_scope_test")
    rostest.rosrun("vibe_rviz_plugins", "drive_scope", DriveScope)
