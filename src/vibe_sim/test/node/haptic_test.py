#!/usr/bin/env python3
"""haptic/parameters during a session, and sessions of a thousand steps per second."""

import math
import subprocess
import sys
import unittest

import numpy
import rospy
import rostest
from node_test_support import PERIOD, SCOPE_JOINTS, scene, stamp_of, state_hash
from vibe_msgs.msg import HapticParameters, ProcedureEvent, StepInput
from vibe_testing.program import Program, find_program
from vibe_testing.recorder import Recorder

DURATION = 3.0  # of poke.trainee.yaml [s]


def vector(message):
    return numpy.array([message.x, message.y, message.z])


def matrix(values):
    return numpy.array(values).reshape(3, 3)


class HapticTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.parameters = Recorder("haptic/parameters", HapticParameters)
        cls.applied = Recorder("applied_input", StepInput)
        cls.events = Recorder("procedure/events", ProcedureEvent)

    def run_session(self, name):
        """The state hash after a session in lock-step with the trainee; its messages are in the recorders."""
        for recorder in (self.parameters, self.applied, self.events):
            recorder.clear()
        settings = dict(scene=scene(name), time_source="sim", lockstep="true", fast="true", duration=DURATION)
        simulator = Program("vibe_sim", "sim_node", name="sim_node", await_recorder="true", **settings)
        trainee = Program("vibe_sim", "vibe_trainee", name="trainee", script=scene("poke.trainee.yaml"), lockstep="true")
        try:
            self.assertEqual(simulator.ends(90), 0, simulator.output())
        finally:
            simulator.stop()
            trainee.stop()
        return state_hash(simulator.output())

    def run_headless(self, name):
        command = [find_program("vibe_core", "vibe_headless"), "--scene", scene(name)]
        command += ["--script", scene("poke.trainee.yaml")]
        command += ["--duration", str(DURATION), "--quiet"]
        return state_hash(subprocess.run(command, check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout)

    def stamps_of(self, kind):
        return [m.header.stamp.to_nsec() for m in self.events.messages if m.kind == kind]

    def event(self, kind):
        found = self.stamps_of(kind)
        self.assertEqual(len(found), 1, kind)
        return found[0]

    def test_parameters_come_with_every_frame_that_touches(self):
        hash_in_node = self.run_session("haptic.yaml")
        self.assertEqual(hash_in_node, self.run_headless("haptic.yaml"))
        messages = self.parameters.messages
        stamps = self.parameters.stamps()
        self.assertEqual(stamps, sorted(set(stamps)))
        self.assertTrue(set(stamps) <= {stamp_of(k) for k in range(1, round(DURATION / PERIOD) + 1)})
        self.assertEqual({m.header.frame_id for m in messages}, {"world"})
        self.assertGreater(sum(m.touching for m in messages), 40)
        # not before something is touched, and once more when nothing is
        # (the wall touches the tip again when the helix lets go)
        self.assertGreaterEqual(stamps[0], self.stamps_of(ProcedureEvent.CONTACT_BEGIN)[0])
        self.assertFalse(messages[-1].touching)
        self.assertLess(stamps[-1], stamp_of(round(DURATION / PERIOD)))
        for before, after in zip(messages, messages[1:]):
            self.assertTrue(before.touching or after.touching)
        grab, release = self.event(ProcedureEvent.GRAB), self.event(ProcedureEvent.RELEASE)
        for message in messages:
            with self.subTest(stamp=message.header.stamp.to_nsec()):
                self.check_content(message, grab, release)

    def check_content(self, message, grab, release):
        self.assertEqual(message.joint_name, SCOPE_JOINTS)
        stiffness, damping = matrix(message.stiffness), matrix(message.damping)
        if not message.touching:
            self.assertEqual((stiffness.any(), damping.any(), vector(message.force).any()), (False, False, False))
            return
        values = numpy.linalg.eigvalsh(stiffness)
        self.assertTrue((stiffness == stiffness.T).all() or abs(stiffness - stiffness.T).max() < 1e-9 * values[2])
        self.assertGreater(values[2], 1)
        self.assertGreaterEqual(values[0], -1e-9 * values[2])
        self.assertGreaterEqual(numpy.linalg.eigvalsh(damping)[0], -1e-9)
        # insertion goes along x; where contacts jump, both are means of two frames, by stiffnesses of their own
        size = numpy.linalg.norm(vector(message.force))
        self.assertAlmostEqual(message.joint_effort[0], message.force.x, delta=0.05 * size + 1e-4)
        held = grab <= message.header.stamp.to_nsec() < release
        self.assertEqual(message.force_limit, 6.0 if held else math.inf)
        if values[0] > 0.01 * values[2]:  # the spring says the same as the force
            offset = vector(message.equilibrium) - vector(message.position)
            spring = stiffness @ offset - damping @ vector(message.velocity)
            self.assertLess(numpy.linalg.norm(spring - vector(message.force)), 1e-6 + 1e-6 * abs(spring).max())

    def test_a_thousand_steps_per_second(self):
        hash_in_node = self.run_session("kilohertz.yaml")
        self.assertEqual(hash_in_node, self.run_headless("kilohertz.yaml"))
        self.assertEqual([m.step for m in self.applied.messages], list(range(round(DURATION / 1e-3))))
        self.event(ProcedureEvent.GRAB)
        self.assertFalse([m.text for m in self.events.messages if m.kind == ProcedureEvent.RECOVERY])
        touching = [m.header.stamp.to_nsec() for m in self.parameters.messages if m.touching]
        self.assertGreater(len(touching), 60)
        steps = numpy.diff(touching)
        self.assertEqual(numpy.median(steps), 10_000_000)  # 100 Hz


if __name__ == "__main__":
    rospy.init_node("haptic_test")
    rostest.rosrun("vibe_sim", "haptic_test", HapticTest, sys.argv)
