#!/usr/bin/env python3
"""An emulated arm drives the scope through crtk_teleop and feels a balloon: simulator, teleoperation and arm."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState, Joy
from vibe_msgs.msg import OperatingState, StateCommand
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

BEFORE_THE_WALL = [0.066, 0.0, 0.2, 0.0]
SWAY = 0.012  # of the hand; the wall is 4 mm away [m]


class CrtkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.joints = Recorder("scope/setpoint_js", JointState)
        cls.pose = Recorder("arm/measured_cp", PoseStamped)
        cls.force = Recorder("arm/servo_cf", WrenchStamped)
        cls.operating = Recorder("arm/operating_state", OperatingState)
        cls.command = rospy.Publisher("scope/servo_jp", JointState, queue_size=10)
        cls.device = Recorder("suturing_device/measured_js", JointState)
        cls.clutch = rospy.Publisher("arm/button1", Joy, queue_size=10)
        cls.device_button = rospy.Publisher("arm/button2", Joy, queue_size=10)
        cls.state = rospy.Publisher("arm/state_command", StateCommand, queue_size=10)
        assert wait_until(lambda: cls.command.get_num_connections() > 0, 20)
        cls.command.publish(JointState(position=BEFORE_THE_WALL))
        assert wait_until(lambda: cls.joints.messages and abs(cls.insertion() - BEFORE_THE_WALL[0]) < 1e-6, 20)
        cls.arm = Program("vibe_hardware", "crtk_arm", sway=SWAY, start=0)
        cls.node = Program("vibe_hardware", "crtk_teleop",
                           mapping="package://vibe_hardware/config/arms/touch.yaml")

    @classmethod
    def tearDownClass(cls):
        for program in (cls.node, cls.arm):
            program.stop()

    @classmethod
    def insertion(cls):
        return cls.joints.messages[-1].position[0]

    def away(self):
        return -self.pose.messages[-1].pose.position.z

    def back(self):
        """Force to the person."""
        return self.force.messages[-1].wrench.force.z

    def press(self, down, button=None):
        (button or self.clutch).publish(Joy(header=rospy.Header(stamp=rospy.Time.now()), buttons=[int(down)]))

    def test_1_the_arm_moves_the_scope_and_feels_the_wall(self):
        self.assertTrue(wait_until(lambda: "drives the scope" in self.node.output(), 20), self.node.output())
        self.assertTrue(wait_until(lambda: self.clutch.get_num_connections() > 0, 20))
        self.press(2)  # a quick tap of a pedal of the dVRK, which comes up without a message
        self.assertTrue(wait_until(lambda: self.insertion() > BEFORE_THE_WALL[0] + 0.004, 20))
        self.assertTrue(wait_until(lambda: self.back() > 0.02, 20))
        self.assertTrue(wait_until(lambda: abs(self.back()) < 1e-3, 20), "it leaves the wall again")
        self.assertLess(max(abs(m.wrench.torque.x) for m in self.force.messages), 1e-9)

    def test_2_with_the_clutch_the_scope_stays_and_no_force_comes(self):
        self.assertTrue(wait_until(lambda: self.clutch.get_num_connections() > 0, 20))
        self.press(True)
        self.assertTrue(wait_until(lambda: "has let go" in self.node.output(), 20))
        rospy.sleep(0.5)  # until the simulator is where it was sent
        place = self.insertion()
        self.assertTrue(wait_until(lambda: self.away() < 1e-3, 20) and wait_until(lambda: self.away() > 0.005, 20))
        self.assertAlmostEqual(self.insertion(), place, 5)
        self.assertEqual(self.back(), 0)
        self.press(False)
        self.assertTrue(wait_until(lambda: abs(self.insertion() - place) > 1e-3, 20))

    def test_2b_with_the_button_for_the_device_the_helix_moves_and_the_scope_stays(self):
        self.assertTrue(wait_until(lambda: self.device_button.get_num_connections() > 0, 20))
        self.press(True, self.device_button)
        self.assertTrue(wait_until(lambda: "moves the suturing device" in self.node.output(), 20), self.node.output())
        rospy.sleep(0.5)  # until the simulator is where it was sent
        place, helix = self.insertion(), lambda: self.device.messages[-1].position[0]
        was = helix()
        self.assertTrue(wait_until(lambda: abs(helix() - was) > 1e-3, 20))
        self.assertAlmostEqual(self.insertion(), place, 5)
        self.assertEqual(self.back(), 0)
        self.press(False, self.device_button)
        self.assertTrue(wait_until(lambda: abs(self.insertion() - place) > 1e-3, 20))

    def test_2c_a_press_counts_that_comes_and_goes_at_once(self):
        """The node reads both messages together, mostly, since they come between two measurements of the arm."""
        buttons, pad = Recorder("scope/buttons", Joy), rospy.Publisher("/joy", Joy, queue_size=10)
        self.assertTrue(buttons.waits_for_connection() and wait_until(lambda: pad.get_num_connections() > 0, 20))
        down = lambda: [message.buttons[3] for message in buttons.messages]  # noqa: E731
        pad.publish(Joy(buttons=[0] * 6))
        self.assertTrue(wait_until(lambda: down()[-1:] == [0], 20))
        for taps in range(1, 21):
            for t_tag in (1, 0):
                pad.publish(Joy(buttons=[0, 0, 0, 0, t_tag, 0]))
            presses = lambda: sum(now > before for before, now in zip(down(), down()[1:]))  # noqa: E731
            self.assertTrue(wait_until(lambda taps=taps: presses() == taps and down()[-1] == 0, 20), presses())

    def test_3_an_arm_that_is_paused_drives_nothing(self):
        self.assertTrue(wait_until(lambda: self.state.get_num_connections() > 0, 20))
        self.state.publish(StateCommand(string="pause"))
        self.assertTrue(wait_until(lambda: "PAUSED" in self.node.output(), 20))
        self.assertTrue(wait_until(lambda: self.back() == 0, 20))
        self.state.publish(StateCommand(string="resume"))
        self.assertTrue(wait_until(lambda: self.node.output().count("drives the scope") >= 3, 20), self.node.output())

    def test_4_whoever_ends_it_leaves_the_arm_without_force(self):
        self.assertTrue(wait_until(lambda: abs(self.back()) > 0.02, 20), "pressing")
        self.assertEqual(self.node.stop(), 0)
        self.assertTrue(wait_until(lambda: self.back() == 0, 5))
        type(self).node = Program("vibe_hardware", "crtk_teleop")
        self.assertTrue(wait_until(lambda: "drives the scope" in self.node.output(), 20), self.node.output())

    def test_5_an_arm_that_is_gone_leaves_the_scope_where_it_is(self):
        self.arm.stop()
        self.assertTrue(wait_until(lambda: "fallen silent" in self.node.output(), 20), self.node.output())
        self.assertEqual(self.back(), 0)

    def test_6_an_arm_that_measures_only_its_joints(self):
        """A mapping of a pose is told what to do; one of the joints drives and gets efforts."""
        type(self).arm = Program("vibe_hardware", "crtk_arm", sway=SWAY, start=0, joints="true")
        self.assertTrue(wait_until(lambda: "this arm measures only its joints" in self.node.output(), 20),
                        self.node.output())
        self.node.stop()
        efforts = Recorder("arm/servo_jf", JointState)
        type(self).node = Program("vibe_hardware", "crtk_teleop",
                                  mapping="package://vibe_hardware/config/arms/joint_arm.yaml")
        self.assertTrue(wait_until(lambda: "drives the scope" in self.node.output(), 20), self.node.output())
        place = self.insertion()
        self.assertTrue(wait_until(lambda: abs(self.insertion() - place) > 2e-3, 20))
        self.assertTrue(efforts.waits_for(lambda m: m.name == ["reach", "roll", "side", "lift"]))


if __name__ == "__main__":
    rospy.init_node("crtk_test")
    rostest.rosrun("vibe_hardware", "crtk", CrtkTest, sys.argv)
