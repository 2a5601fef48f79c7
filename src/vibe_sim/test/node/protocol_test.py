#!/usr/bin/env python3
"""A trainee that performs a protocol in lock-step gives the state hash of vibe_headless: whatever the pace, and whenever
messages arrive. What it did is in applied_input, so that a recording repeats without it."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from node_test_support import scene, stamp_of, state_hash
from sensor_msgs.msg import PointCloud2
from vibe_msgs.msg import ProcedureEvent, StepInput, StepResult
from vibe_msgs.srv import Reset
from vibe_testing.program import Program, find_program
from vibe_testing.recorder import Recorder

DURATION = 18.0  # the first bite is over
STEPS = 1080
PROTOCOL = "look.protocol.yaml"


class ProtocolTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.results = Recorder("step_result", StepResult)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.folder = tempfile.TemporaryDirectory()
        cls.reference = cls.run_headless(scene(PROTOCOL))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @staticmethod
    def run_headless(protocol):
        command = [find_program("vibe_core", "vibe_headless"), "--scene", scene("small_stomach.yaml")]
        command += ["--script", protocol]
        command += ["--duration", str(DURATION), "--quiet"]
        return state_hash(subprocess.run(command, check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout)

    def setUp(self):
        self.programs = []
        for recorder in (self.applied, self.results, self.events):
            recorder.clear()

    def tearDown(self):
        for program in self.programs:
            program.stop()

    def start(self, program, **parameters):
        self.programs.append(Program("vibe_sim", program, name=program, **parameters))
        return self.programs[-1]

    def start_simulator(self, **parameters):
        settings = dict(scene=scene("small_stomach.yaml"), time_source="sim", lockstep="true", fast="true")
        settings.update(parameters)
        return self.start("sim_node", **settings)

    def start_trainee(self, protocol=scene(PROTOCOL), **parameters):
        return self.start("vibe_trainee", script=protocol, lockstep="true", **parameters)

    def hash_of_session(self, protocol=scene(PROTOCOL), **parameters):
        simulator = self.start_simulator(duration=DURATION, **parameters)
        self.start_trainee(protocol)
        self.assertEqual(simulator.ends(120), 0, simulator.output())
        return state_hash(simulator.output())

    def other_seed(self):
        file = os.path.join(self.folder.name, "other.protocol.yaml")
        with open(scene(PROTOCOL)) as text, open(file, "w") as other:
            other.write(text.read().replace("seed: 5", "seed: 6"))
        return file

    def test_same_protocol_same_hash_as_without_ros(self):
        self.assertIsNotNone(self.reference)
        self.assertEqual(self.hash_of_session(await_recorder="true"), self.reference)
        self.assertEqual([m.step for m in self.applied.messages], list(range(STEPS)))
        # it went as far as to look at what it holds
        self.assertIn(ProcedureEvent.BITE, [m.kind for m in self.events.messages])
        trainee = self.programs[-1]
        self.assertTrue(trainee.says("goal 2 of 4, mark at 40 % of the axis, 0 deg: given up, the scene has no"))

    def test_step_result_says_what_the_topics_say(self):
        self.hash_of_session(await_recorder="true")
        results = self.results.messages
        # roscpp sends a latched message twice to who connects while it is published
        if [m.step for m in results[:2]] == [0, 0]:
            del results[0]
        self.assertEqual([m.step for m in results], list(range(STEPS + 1)))
        self.assertEqual([m.header.stamp.to_nsec() for m in results], [stamp_of(k) for k in range(STEPS + 1)])
        told = [(e.kind, e.particle, e.value, e.text) for m in results for e in m.events]
        events = [(e.kind, e.particle, e.value, e.text) for e in self.events.messages]
        self.assertEqual(told, events)
        self.assertGreater(len(told), 3)

    def test_pace_and_a_trainee_that_is_interrupted_do_not_matter(self):
        simulator = self.start_simulator(duration=DURATION, threads=2)
        trainee = self.start_trainee()
        for _ in range(5):
            time.sleep(0.3)
            trainee.send(signal.SIGSTOP)
            time.sleep(0.3)
            trainee.send(signal.SIGCONT)
        self.assertEqual(simulator.ends(120), 0, simulator.output())
        self.assertEqual(state_hash(simulator.output()), self.reference)

    def test_another_seed_gives_another_hash(self):
        other = self.run_headless(self.other_seed())
        self.assertNotEqual(other, self.reference)
        self.assertEqual(self.hash_of_session(self.other_seed()), other)

    def test_a_recording_repeats_without_the_trainee(self):
        file = os.path.join(self.folder.name, "session.bag")
        recorder = subprocess.Popen([find_program("vibe_sim", "vibe_record"), "--last", "applied_input", file],
                                    stdout=subprocess.PIPE, universal_newlines=True)
        # the recorder joins applied_input last, when it has all the other topics
        for own in (self.applied, self.results, self.events):
            own.subscriber.unregister()
        try:
            self.assertEqual(self.hash_of_session(await_recorder="true"), self.reference)
        finally:
            recorder.send_signal(signal.SIGINT)
            recorder.communicate(timeout=60)
            type(self).setUpRecorders()
        command = [find_program("vibe_sim", "vibe_replay"), file]
        replay = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(replay.returncode, 0, replay.stdout)
        self.assertEqual(state_hash(replay.stdout), self.reference)

    @classmethod
    def setUpRecorders(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.results = Recorder("step_result", StepResult)
        cls.events = Recorder("procedure/events", ProcedureEvent)

    def test_after_a_reset_it_begins_again(self):
        simulator = self.start_simulator(fast="false")
        self.start_trainee()
        rospy.wait_for_service("reset", 20)
        first = self.inputs_of_a_second(simulator)
        self.applied.clear()
        self.assertTrue(rospy.ServiceProxy("reset", Reset)(0, True).success)
        again = self.inputs_of_a_second(simulator)
        # the first step after a reset may have had its input before, and a recorder may have missed those before it joined
        common = sorted(set(first) & set(again) - {0})
        self.assertGreater(len(common), 30)
        self.assertEqual([again[k] for k in common], [first[k] for k in common])

    def inputs_of_a_second(self, simulator):
        self.assertIsNotNone(self.applied.waits_for(lambda m: m.step == 59, 60), simulator.output())
        return {m.step: m.joints for m in self.applied.messages if m.step < 60}

    def test_it_can_end_the_node_when_its_goals_have_ended(self):
        self.start_simulator()
        file = os.path.join(self.folder.name, "short.protocol.yaml")
        with open(file, "w") as text:
            text.write("name: short\ngoals: [wait]\n")
        trainee = self.start_trainee(file, exit_when_done="true")
        self.assertEqual(trainee.ends(60), 0, trainee.output())
        self.assertEqual(trainee.count("goal 1 of 1, wait: reached"), 1, trainee.output())

    def test_who_comes_late_gets_the_particles_of_the_present(self):
        simulator = self.start_simulator(lockstep="false", start_paused="true")
        rospy.wait_for_service("pause", 20)
        time.sleep(0.5)
        particles = Recorder("tissue/particles", PointCloud2)
        self.assertIsNotNone(particles.waits_for(lambda m: m.header.stamp.to_nsec() == stamp_of(0)), simulator.output())
        particles.subscriber.unregister()


if __name__ == "__main__":
    rospy.init_node("protocol_test")
    rostest.rosrun("vibe_sim", "protocol_test", ProtocolTest, sys.argv)
