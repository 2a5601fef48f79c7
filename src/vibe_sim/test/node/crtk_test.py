#!/usr/bin/env python3
"""Scope and suturing device as robots of the CRTK convention, however they are driven."""

import sys
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from node_test_support import SUTURING_DEVICE_JOINTS, PERIOD, SCOPE_JOINTS, joints
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header
from vibe_msgs.msg import OperatingState, StateCommand, StepInput
from vibe_msgs.srv import Reset, Step
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

INSERTION_SPEED = 0.15  # limit of the URDF [m/s]


def array(message):
    return numpy.array(message.data).reshape([dimension.size for dimension in message.layout.dim])


def place(pose):
    return numpy.array([pose.pose.position.x, pose.pose.position.y, pose.pose.position.z])


def forward(pose):
    """x axis of a pose."""
    q = pose.pose.orientation
    return numpy.array(
        [1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w)]
    )


class CrtkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scope = Recorder("scope/measured_js", JointState)
        cls.suturing_device = Recorder("suturing_device/measured_js", JointState)
        cls.state = Recorder("scope/operating_state", OperatingState)
        cls.suturing_device_state = Recorder("suturing_device/operating_state", OperatingState)
        cls.pose = Recorder("scope/measured_cp", PoseStamped)
        cls.jacobian = Recorder("scope/jacobian", Float64MultiArray)
        cls.twist = Recorder("scope/measured_cv", TwistStamped)
        cls.wall = Recorder("wall/measured_cp", PoseStamped)
        cls.applied = Recorder("applied_input", StepInput)
        cls.setpoint = Recorder("scope/setpoint_cp", PoseStamped)
        cls.recorders = [cls.setpoint, cls.scope, cls.suturing_device, cls.pose, cls.twist, cls.jacobian, cls.wall]
        cls.recorders.append(cls.applied)
        names = ["scope/input/joint_states", "scope/servo_jp", "scope/move_jp"]
        names += ["suturing_device/input/joint_states", "suturing_device/servo_jp", "suturing_device/move_jp"]
        cls.to = {name: rospy.Publisher(name, JointState, queue_size=10) for name in names}
        for name in ("scope/servo_cp", "scope/move_cp"):
            cls.to[name] = rospy.Publisher(name, PoseStamped, queue_size=10)
        for name in ("scope/state_command", "suturing_device/state_command"):
            cls.to[name] = rospy.Publisher(name, StateCommand, queue_size=10)
        rospy.wait_for_service("step", 20)
        cls.step_service = rospy.ServiceProxy("step", Step)
        cls.reset = rospy.ServiceProxy("reset", Reset)
        assert wait_until(lambda: all(p.get_num_connections() > 0 for p in cls.to.values()), 20)
        assert wait_until(lambda: all(r.is_connected() for r in cls.recorders), 20)

    def setUp(self):
        self.assertTrue(self.reset(seed=0, keep_time=False).success)
        self.send("scope/servo_jp", [0.0, 0.0, 0.0, 0.0])
        self.send("suturing_device/servo_jp", [0.0, 0.0, 0.0])
        self.step(1)

    def send(self, topic, positions):
        names = SCOPE_JOINTS if topic.startswith("scope") else SUTURING_DEVICE_JOINTS
        stamp = rospy.Time(0) if "input" not in topic else self.now()
        self.to[topic].publish(joints(names, positions, stamp))
        rospy.rostime.wallsleep(0.15)

    def now(self):
        return self.scope.messages[-1].header.stamp

    def step(self, count):
        """What the steps publish: a new list in every recorder."""
        for recorder in self.recorders:
            recorder.clear()
        self.assertTrue(self.step_service(count).success)
        for recorder in (self.applied, self.scope, self.suturing_device, self.pose, self.twist, self.jacobian):
            self.assertTrue(wait_until(lambda: len(recorder.messages) >= count))

    def check_kinematics(self, recorder):
        """Velocities are those of the positions."""
        messages = recorder.messages
        position = numpy.array([m.position for m in messages])
        velocity = numpy.array([m.velocity for m in messages])
        numpy.testing.assert_allclose(velocity[1:], numpy.diff(position, axis=0) / PERIOD, atol=1e-9)
        self.assertGreater(abs(velocity).max(), 1e-3)

    def test_the_scope_has_positions_velocities_and_efforts_however_it_is_driven(self):
        target = PoseStamped()
        target.header.frame_id = "world"
        target.pose.position.x = -0.04
        target.pose.orientation.w = 1
        ways = ("scope/input/joint_states", "scope/servo_jp", "scope/move_jp")
        ways = {name: lambda name=name: self.send(name, [0.06, 0.1, 0, 0]) for name in ways}
        ways["scope/servo_cp"] = lambda: (self.to["scope/servo_cp"].publish(target), rospy.rostime.wallsleep(0.15))
        self.assertEqual(len(ways), 4)
        for name, drive in ways.items():
            with self.subTest(name):
                self.setUp()
                drive()
                self.step(20)
                for message in self.scope.messages:
                    self.assertEqual(message.name, SCOPE_JOINTS)
                    self.assertEqual((len(message.velocity), len(message.effort)), (4, 4))
                self.check_kinematics(self.scope)
                stamps = [m.header.stamp for m in self.pose.messages]
                self.assertEqual([m.header.stamp for m in self.scope.messages], stamps)

    def test_the_effort_is_that_of_the_hand(self):
        self.send("scope/servo_jp", [0.05, 0, 0, 0])
        self.step(60)
        self.assertLess(abs(self.scope.messages[-1].effort[0]), 1e-3)
        self.send("scope/servo_jp", [0.08, 0, 0, 0])  # into the wall
        self.step(60)
        self.assertGreater(self.scope.messages[-1].effort[0], 0.05)

    def test_a_move_goes_smoothly_to_its_goal_and_is_busy_on_the_way(self):
        self.send("scope/move_jp", [0.04, 0.2, 0, 0])
        self.step(1)
        self.assertTrue(self.state.waits_for(lambda m: m.is_busy))
        self.step(59)
        self.assertTrue(wait_until(lambda: not self.state.messages[-1].is_busy))
        position = numpy.array([m.joints[0] for m in self.applied.messages])
        self.assertAlmostEqual(position[-1], 0.04, places=9)
        speed = numpy.diff(position) / PERIOD
        self.assertGreaterEqual(speed.min(), 0)
        self.assertLessEqual(speed.max(), INSERTION_SPEED * 1.001)
        change = abs(numpy.diff(speed)).max()
        self.assertLess(change, 0.3 * speed.max(), "a jump of the speed")
        self.assertAlmostEqual(self.scope.messages[-1].position[0], 0.04, places=4)

    def test_a_move_to_where_the_scope_is_becomes_busy_and_ends(self):
        self.send("scope/servo_jp", [0.03, 0.1, 0, 0])
        self.step(60)
        self.state.clear()
        self.send("scope/move_jp", [0.03, 0.1, 0, 0])
        self.step(1)
        self.assertTrue(self.state.waits_for(lambda m: m.is_busy))
        self.step(1)
        self.assertTrue(wait_until(lambda: not self.state.messages[-1].is_busy))
        stamps = [m.header.stamp for m in self.state.messages]
        self.assertEqual(stamps, sorted(set(stamps)))
        self.assertAlmostEqual(self.applied.messages[-1].joints[0], 0.03, places=9)

    def test_a_move_of_the_tip_ends_where_it_was_asked_to(self):
        self.send("scope/servo_jp", [0.03, 0, 0.2, 0])
        self.step(60)
        goal = self.setpoint.messages[-1]
        numpy.testing.assert_allclose(place(goal), place(self.pose.messages[-1]), atol=1e-4)
        self.send("scope/servo_jp", [0.01, 0, 0, 0])
        self.step(60)
        goal.header = Header()  # CRTK clients give no frame
        self.to["scope/move_cp"].publish(goal)
        rospy.rostime.wallsleep(0.15)
        self.step(1)
        self.assertTrue(self.state.waits_for(lambda m: m.is_busy))
        self.step(120)
        self.assertTrue(wait_until(lambda: not self.state.messages[-1].is_busy))
        numpy.testing.assert_allclose(place(self.setpoint.messages[-1]), place(goal), atol=1e-3)

    def test_a_velocity_moves_the_tip_while_it_is_sent(self):
        self.send("scope/servo_jp", [0.03, 0, 0.2, 0])
        self.step(60)
        velocity = rospy.Publisher("scope/servo_cv", TwistStamped, queue_size=10)
        self.assertTrue(wait_until(lambda: velocity.get_num_connections() > 0, 20))
        message = TwistStamped()  # CRTK clients give no frame
        message.twist.linear.x, message.twist.linear.z = 2e-3, -1e-3
        passed = []
        for _ in range(6):
            velocity.publish(message)
            rospy.rostime.wallsleep(0.15)
            self.step(10)
            passed += self.setpoint.messages
        moved = place(passed[-1]) - place(passed[0])
        numpy.testing.assert_allclose(moved, numpy.array([2e-3, 0, -1e-3]) * 59 * PERIOD, atol=3e-5)
        self.step(20)  # a third of a second after the last message
        further = numpy.linalg.norm(place(self.setpoint.messages[-1]) - place(passed[-1]))
        self.assertTrue(0 < further < 0.3 * numpy.linalg.norm([2e-3, 0, -1e-3]), further)
        self.step(10)
        numpy.testing.assert_allclose(place(self.setpoint.messages[-1]), place(self.setpoint.messages[0]), atol=1e-9)
        velocity.unregister()

    def test_the_state_is_commanded(self):
        command = self.to["suturing_device/state_command"]
        self.state.clear()
        for word in ("home", "no_such_command", "resume"):
            command.publish(StateCommand(string=word))
        self.assertTrue(self.state.waits_for(lambda m: m.state == "ENABLED"))
        command.publish(StateCommand(string="pause"))
        self.assertTrue(self.state.waits_for(lambda m: m.state == "PAUSED"))
        command.publish(StateCommand(string="enable"))
        self.assertTrue(wait_until(lambda: self.state.messages[-1].state == "ENABLED"))
        command.publish(StateCommand(string="pause"))
        self.assertTrue(wait_until(lambda: len(self.state.messages) == 4))
        self.assertEqual([m.state for m in self.state.messages], ["ENABLED", "PAUSED"] * 2)
        stamps = self.state.stamps()
        self.assertEqual(stamps, sorted(set(stamps)), "a client takes a state only if its stamp is later")

    def test_another_command_ends_a_move(self):
        self.send("scope/move_jp", [0.05, 0, 0, 0])
        self.step(5)
        self.assertTrue(self.state.waits_for(lambda m: m.is_busy))
        self.send("scope/servo_jp", [0.001, 0, 0, 0])
        self.step(2)
        self.assertTrue(wait_until(lambda: not self.state.messages[-1].is_busy))
        self.assertAlmostEqual(self.applied.messages[-1].joints[0], 0.001, places=9)

    def test_a_reset_ends_a_move(self):
        self.send("scope/move_jp", [0.05, 0, 0, 0])
        self.step(5)
        self.assertTrue(self.reset(seed=0, keep_time=True).success)
        rospy.rostime.wallsleep(0.1)  # until what the reset publishes is there
        self.step(30)
        self.assertLess(self.applied.messages[-1].joints[0], 0.001)
        self.assertFalse(self.state.messages[-1].is_busy)

    def test_the_suturing_device_takes_commands_and_moves(self):
        self.send("suturing_device/servo_jp", [0.01, 0.5, 0.001])
        self.step(60)
        numpy.testing.assert_allclose(self.suturing_device.messages[-1].position, [0.01, 0.5, 0.001], atol=1e-9)
        self.assertEqual(self.suturing_device.messages[-1].effort, ())
        self.send("suturing_device/move_jp", [0.02, 0.0, 0.0])
        self.step(1)
        self.assertTrue(self.suturing_device_state.waits_for(lambda m: m.is_busy))
        self.assertFalse(self.state.messages[-1].is_busy)
        self.step(120)
        self.check_kinematics(self.suturing_device)
        numpy.testing.assert_allclose(self.suturing_device.messages[-1].position, [0.02, 0, 0], atol=1e-9)
        self.assertFalse(self.suturing_device_state.messages[-1].is_busy)

    def test_the_jacobian_tells_how_the_tip_moves(self):
        self.send("scope/servo_jp", [0.03, 0.2, 0.4, -0.3])
        self.step(120)
        before, jacobian = self.pose.messages[-1], array(self.jacobian.messages[-1])
        self.assertEqual(jacobian.shape, (6, 4))
        step = numpy.array([0.001, 0.01, 0.01, -0.01])
        self.send("scope/servo_jp", [0.03, 0.2, 0.4, -0.3] + step)
        self.step(60)
        moved = place(self.pose.messages[-1]) - place(before)
        self.assertLess(numpy.linalg.norm(moved - jacobian[:3] @ step), 0.02 * numpy.linalg.norm(moved))
        turned = forward(self.pose.messages[-1]) - forward(before)
        expected = numpy.cross(jacobian[3:] @ step, forward(before))
        self.assertLess(numpy.linalg.norm(turned - expected), 0.03 * numpy.linalg.norm(turned))

    def test_the_velocity_of_the_tip_is_that_of_its_joints(self):
        self.send("scope/servo_jp", [0.03, 0.2, 0.4, -0.3])
        self.step(120)
        self.send("scope/move_jp", [0.06, 0.6, 0.1, 0.0])
        self.step(12)
        self.assertTrue(wait_until(lambda: self.twist.stamps()[-12:] == self.pose.stamps()))
        twists = self.twist.messages[-12:]
        for k in range(3, 11):
            linear, angular = (
                numpy.array([v.x, v.y, v.z]) for v in (twists[k].twist.linear, twists[k].twist.angular)
            )
            moved = place(self.pose.messages[k]) - place(self.pose.messages[k - 1])
            numpy.testing.assert_allclose(linear, moved / PERIOD, atol=1e-9)
            middle = (array(self.jacobian.messages[k]) + array(self.jacobian.messages[k - 1])) / 2
            expected = middle @ numpy.array(self.scope.messages[k].velocity)
            self.assertGreater(numpy.linalg.norm(angular), 0.1)
            self.assertLess(numpy.linalg.norm(linear - expected[:3]), 0.02 * numpy.linalg.norm(linear))
            self.assertLess(numpy.linalg.norm(angular - expected[3:]), 0.02 * numpy.linalg.norm(angular))
        self.twist.clear()
        self.assertTrue(self.reset(seed=0, keep_time=False).success)
        self.assertTrue(self.twist.waits_for(lambda m: m.twist == Twist()))

    def test_the_wall_ahead_has_a_place_and_a_normal(self):
        self.step(5)
        # A message about the step before may still arrive in front of these.
        self.assertTrue(wait_until(lambda: self.wall.stamps()[-5:] == self.pose.stamps()))
        wall, tip = self.wall.messages[-1], self.pose.messages[-1]
        self.assertEqual(wall.header.stamp, tip.header.stamp)
        sight = place(wall) - place(tip)
        self.assertLess(numpy.linalg.norm(numpy.cross(sight, forward(tip))), 1e-6)
        self.assertAlmostEqual(numpy.linalg.norm(place(wall)), 0.05, delta=0.005)
        self.assertGreater(-forward(wall) @ forward(tip), 0.9)

    def test_a_paused_simulator_is_paused(self):
        self.assertTrue(wait_until(lambda: self.state.messages and self.state.messages[-1].state == "PAUSED"))
        self.assertTrue(self.state.messages[-1].is_homed)


if __name__ == "__main__":
    rospy.init_node("crtk_test")
    rostest.rosrun("vibe_sim", "crtk_test", CrtkTest, sys.argv)
