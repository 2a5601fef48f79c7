#!/usr/bin/env python3
"""In lock-step the same script gives the same state hash: again, with any number of threads, paced or not, without ROS,
and whatever nonsense is sent beside it."""

import os
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from node_test_support import SUTURING_DEVICE_JOINTS, SCOPE_JOINTS, joints, scene, stamp_of, state_hash
from sensor_msgs.msg import JointState
from vibe_msgs.msg import ProcedureEvent, ProcedureState, StepInput
from vibe_msgs.srv import Step
from vibe_testing.program import Program, find_program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

DURATION = 3.0


class LockstepTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.procedure = Recorder("procedure/state", ProcedureState)
        cls.reference = cls.run_headless()

    @staticmethod
    def run_headless():
        command = [find_program("vibe_core", "vibe_headless"), "--scene", scene("balloon.yaml")]
        command += ["--script", scene("poke.trainee.yaml"), "--duration", str(DURATION), "--quiet"]
        return state_hash(subprocess.run(command, check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout)

    def setUp(self):
        self.programs = []
        for recorder in (self.applied, self.events, self.procedure):
            recorder.clear()

    def tearDown(self):
        for program in self.programs:
            program.stop()

    def start_trainee(self, name="trainee"):
        trainee = Program("vibe_sim", "vibe_trainee", name=name, script=scene("poke.trainee.yaml"), lockstep="true")
        self.programs.append(trainee)
        return trainee

    def start_simulator(self, **parameters):
        settings = dict(scene=scene("balloon.yaml"), time_source="sim", lockstep="true", fast="true")
        settings.update(parameters)
        simulator = Program("vibe_sim", "sim_node", name="sim_node", **settings)
        self.programs.append(simulator)
        return simulator

    def run_session(self, **parameters):
        """The finished simulator after a session with the trainee."""
        settings = dict(duration=DURATION, await_recorder="true")
        settings.update(parameters)
        simulator = self.start_simulator(**settings)
        self.start_trainee()
        self.assertEqual(simulator.ends(60), 0, simulator.output())
        return simulator

    def test_same_script_same_hash_as_without_ros(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "summary.txt")
            simulator = self.run_session(summary_file=file)
            with open(file) as summary:
                text = summary.read()
        self.assertIsNotNone(self.reference)
        self.assertEqual(state_hash(text), self.reference)
        self.assertEqual(state_hash(simulator.output()), self.reference)
        self.assertTrue(text.splitlines()[-1].startswith("state hash: "))
        # every step is there, with the stamp of its start
        steps = self.applied.messages
        self.assertEqual([m.step for m in steps], list(range(180)))
        self.assertEqual(self.applied.stamps(), [stamp_of(k) for k in range(180)])
        kinds = [m.kind for m in self.events.messages]
        self.assertIn(ProcedureEvent.GRAB, kinds)
        self.assertIn(ProcedureEvent.RELEASE, kinds)
        last = self.procedure.messages[-1]
        self.assertEqual((last.step, last.header.stamp.to_nsec()), (180, stamp_of(180)))

    def test_threads_and_pace_do_not_matter(self):
        simulator = self.run_session(threads=2, fast="false")
        self.assertEqual(state_hash(simulator.output()), self.reference)
        # paced by the wall clock: progress was reported each second
        self.assertGreaterEqual(simulator.count("x real time"), 2)

    def test_nonsense_beside_it_does_not_matter(self):
        publisher = rospy.Publisher("scope/servo_jp", JointState, queue_size=10)
        simulator = self.start_simulator(duration=DURATION, await_recorder="true")
        self.assertTrue(wait_until(lambda: publisher.get_num_connections() > 0, 20))
        self.start_trainee()
        for _ in range(50):
            publisher.publish(joints(SCOPE_JOINTS, (float("nan"), 0, 0, 0), rospy.Time(1)))
            publisher.publish(joints(SUTURING_DEVICE_JOINTS, (0, 0, 0), rospy.Time(1)))
            rospy.rostime.wallsleep(0.01)
        self.assertEqual(simulator.ends(60), 0, simulator.output())
        self.assertEqual(state_hash(simulator.output()), self.reference)
        warnings = [m for m in self.events.messages if m.kind == ProcedureEvent.WARNING]
        self.assertGreaterEqual(len(warnings), 1)

    def test_another_script_gives_another_hash(self):
        simulator = self.start_simulator(duration=1.5)
        self.start_trainee()
        self.assertEqual(simulator.ends(60), 0, simulator.output())
        self.assertNotEqual(state_hash(simulator.output()), self.reference)

    def test_missing_inputs_end_a_session_of_given_length(self):
        simulator = self.start_simulator(duration=DURATION, lockstep_timeout=1.5)
        self.assertEqual(simulator.ends(30), 1)
        self.assertEqual(simulator.count("ERROR"), 1, simulator.output())
        self.assertIn("scope/input/joint_states, suturing_device/input/joint_states, scope/buttons", simulator.output())
        # what there is of the session is summed up all the same
        self.assertIsNotNone(state_hash(simulator.output()))

    def test_missing_inputs_pause_an_open_session(self):
        simulator = self.start_simulator(lockstep_timeout=1.5)
        self.assertTrue(simulator.says("the simulation is paused"), simulator.output())
        self.assertIsNotNone(self.procedure.waits_for(lambda m: m.paused, 5))
        rospy.wait_for_service("step", 5)
        reply = rospy.ServiceProxy("step", Step)(1)
        self.assertFalse(reply.success)
        self.assertIn("scope/buttons", reply.message)
        self.assertEqual(simulator.stop(), 0)


if __name__ == "__main__":
    rospy.init_node("lockstep_test")
    rostest.rosrun("vibe_sim", "lockstep_test", LockstepTest, sys.argv)
