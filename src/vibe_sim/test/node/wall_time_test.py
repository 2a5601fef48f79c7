#!/usr/bin/env python3
"""With the wall clock as the source of time: pace, stamps, pause, no /clock; and a trainee that runs freely."""

import os
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from node_test_support import SCOPE_JOINTS, buttons, joints, scene
from sensor_msgs.msg import JointState, Joy, PointCloud2
from std_srvs.srv import SetBool
from vibe_msgs.msg import ProcedureEvent, SolverStatistics, StepInput
from vibe_msgs.srv import Reset
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until


class WallTimeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.particles = Recorder("tissue/particles", PointCloud2)
        cls.applied = Recorder("applied_input", StepInput)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.performance = Recorder("solver_statistics", SolverStatistics)
        cls.joints = Recorder("scope/input/joint_states", JointState)
        cls.simulator = Program("vibe_sim", "sim_node", name="sim_node", scene=scene("light.yaml"))
        rospy.wait_for_service("pause", 20)
        cls.pause = rospy.ServiceProxy("pause", SetBool)
        cls.reset = rospy.ServiceProxy("reset", Reset)
        assert wait_until(lambda: len(cls.particles.messages) > 0, 20), cls.simulator.output()

    @classmethod
    def tearDownClass(cls):
        assert cls.simulator.stop() == 0, cls.simulator.output()
        assert cls.simulator.count("Stopped by a signal.") == 1

    def setUp(self):
        self.pause(False)
        self.particles.clear()
        self.applied.clear()

    def test_sixty_hertz_with_stamps_of_the_wall_clock(self):
        begin = time.time()
        self.assertTrue(wait_until(lambda: len(self.particles.messages) >= 120, 10))
        stamps = [1e-9 * s for s in self.particles.stamps()]
        self.assertEqual(stamps, sorted(set(stamps)))
        rate = (len(stamps) - 1) / (stamps[-1] - stamps[0])
        self.assertTrue(50 < rate < 61, rate)
        self.assertLess(abs(stamps[0] - begin), 0.4)
        self.assertLess(stamps[-1], time.time() + 0.001)  # no sample is from the future

    def test_there_is_no_clock(self):
        self.assertNotIn("/clock", [topic for topic, _ in rospy.get_published_topics()])

    def test_stamps_follow_the_wall_clock_after_a_pause(self):
        self.pause(True)
        time.sleep(1.0)
        self.particles.clear()
        self.pause(False)
        self.assertTrue(wait_until(lambda: self.particles.messages))
        self.assertLess(abs(1e-9 * self.particles.stamps()[0] - time.time()), 0.4)

    def test_reset_keeps_stamps_monotonic_and_cannot_set_them_back(self):
        self.assertTrue(wait_until(lambda: len(self.particles.messages) > 5))
        self.assertTrue(self.reset(seed=0, keep_time=True).success)
        self.assertTrue(wait_until(lambda: any(m.step == 5 for m in self.applied.messages)))
        stamps = self.particles.stamps()
        self.assertEqual(stamps, sorted(set(stamps)))
        reply = self.reset(seed=0, keep_time=False)
        self.assertFalse(reply.success)
        self.assertIn("keep_time", reply.message)

    def test_performance_keeps_real_time(self):
        self.performance.clear()
        self.assertTrue(wait_until(lambda: len(self.performance.messages) >= 3, 6))
        self.assertAlmostEqual(self.performance.messages[-1].real_time_factor, 1, delta=0.15)

    def test_a_node_whose_clock_is_wrong_is_told_so_and_locks_nobody_out(self):
        command = rospy.Publisher("scope/servo_jp", JointState, queue_size=100)
        self.assertTrue(wait_until(lambda: command.get_num_connections() > 0))
        for hours in (1, -1):
            time.sleep(1.1)  # complaints are limited to one a second
            self.events.clear()
            stamp = rospy.Time.from_sec(time.time() + 3600 * hours)
            for k in range(5000):  # more than may wait
                command.publish(joints([], (0.09, 0, 0, 0), stamp + rospy.Duration(0.001 * k)))
            told = self.events.waits_for(lambda m: "scope/servo_jp" in m.text and rospy.get_name() in m.text, 10)
            self.assertIsNotNone(told)
            self.assertRegex(told.text, "3(59[0-9]|60[0-9])[.][0-9] s (ahead of|behind) the simulator's time")
        self.assertFalse(any(m.joints[0] == 0.09 for m in self.applied.messages))
        command.unregister()
        other = rospy.Publisher("scope/input/joint_states", JointState, queue_size=10)

        def obeyed():
            other.publish(joints(SCOPE_JOINTS, (0.03, 0, 0, 0), rospy.Time.from_sec(time.time())))
            return any(m.joints[0] == 0.03 for m in self.applied.messages)

        self.assertTrue(wait_until(obeyed, 5))
        other.unregister()

    def test_buttons_of_a_node_that_is_gone_are_released(self):
        press = rospy.Publisher("scope/buttons", Joy, queue_size=10)
        self.assertTrue(wait_until(lambda: press.get_num_connections() > 0))
        for _ in range(20):  # 2 s: longer than the timeout
            press.publish(buttons([0, 4]))
            time.sleep(0.1)
        self.assertEqual(self.applied.messages[-1].buttons[0], 1)
        self.events.clear()
        warning = self.events.waits_for(lambda m: "scope/buttons" in m.text, 5)
        self.assertIsNotNone(warning)
        self.assertIn("are released: apc_pedal, cinch;", warning.text)
        self.assertTrue(wait_until(lambda: not any(self.applied.messages[-1].buttons), 2))
        press.unregister()

    def test_a_velocity_of_a_node_that_hangs_ends(self):
        twist = ["scope/servo_cv", "geometry_msgs/TwistStamped", "{twist: {linear: {z: -0.01}}}"]
        publisher = subprocess.Popen(["rostopic", "pub", "-r", "20"] + twist, stdout=subprocess.DEVNULL)
        try:
            begin = self.applied.waits_for(lambda m: True, 5).joints[0]
            self.assertTrue(wait_until(lambda: abs(self.applied.messages[-1].joints[0] - begin) > 2e-3, 20))
            self.events.clear()
            os.kill(publisher.pid, signal.SIGSTOP)
            self.assertIsNotNone(self.events.waits_for(lambda m: "scope/servo_cv has been silent for 0.3" in m.text, 5))
            self.applied.clear()
            self.assertTrue(wait_until(lambda: len(self.applied.messages) > 30))
            self.assertEqual(len({m.joints for m in self.applied.messages[2:]}), 1)
            self.assertEqual(len(self.events.messages), 1, self.events.messages)
        finally:
            publisher.kill()
            publisher.wait()

    def test_a_free_trainee_moves_the_scope(self):
        trainee = Program("vibe_sim", "vibe_trainee", name="trainee", script=scene("poke.trainee.yaml"))
        try:
            self.assertTrue(wait_until(lambda: any(m.joints[0] > 0.07 for m in self.applied.messages), 15))
            self.assertIsNotNone(self.events.waits_for(lambda m: m.kind == ProcedureEvent.GRAB, 10))
            stamps = [1e-9 * s for s in self.joints.stamps()]
            rate = (len(stamps) - 1) / (stamps[-1] - stamps[0])
            self.assertAlmostEqual(rate, 100, delta=1)
            self.assertEqual(stamps, sorted(set(stamps)))
        finally:
            self.assertEqual(trainee.stop(), 0)


if __name__ == "__main__":
    rospy.init_node("wall_time_test")
    rostest.rosrun("vibe_sim", "wall_time_test", WallTimeTest, sys.argv)
