#!/usr/bin/env python3
"""Another node commands a trainee: goals by service and topic, refusals with a reason, progress, cancelling; in
lock-step and without."""

import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from node_test_support import scene
from sensor_msgs.msg import JointState
from std_msgs.msg import UInt32
from vibe_msgs.msg import GoalProgress, StepInput, TraineeGoal, TraineeProgress
from vibe_msgs.srv import Reset, SendGoal
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

TUTORIAL = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../../../../docs/tutorials/command_a_trainee.md")
QUEUED, ACTIVE = GoalProgress.QUEUED, GoalProgress.ACTIVE
REACHED, FAILED = GoalProgress.REACHED, GoalProgress.FAILED


class ServoTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.progress = Recorder("trainee/progress", TraineeProgress)
        cls.applied = Recorder("applied_input", StepInput)
        cls.motion = Recorder("scope/input/joint_states", JointState)
        cls.goals = rospy.Publisher("trainee/goal", TraineeGoal, queue_size=10)
        cls.cancel = rospy.Publisher("trainee/cancel", UInt32, queue_size=10)

    def setUp(self):
        self.programs = []
        self.progress.clear()
        self.applied.clear()

    def tearDown(self):
        for program in self.programs:
            program.stop()

    def start(self, program, **parameters):
        self.programs.append(Program("vibe_sim", program, name=program, **parameters))
        return self.programs[-1]

    def begin(self, lockstep="true", **parameters):
        """A simulator and a trainee without a protocol, ready for goals."""
        self.start("sim_node", scene=scene("small_stomach.yaml"), time_source="sim", lockstep=lockstep, fast=lockstep)
        self.trainee = self.start("vibe_trainee", lockstep=lockstep, **parameters)
        self.assertIsNotNone(self.progress.waits_for(lambda m: not m.goals, 20), self.trainee.output())
        rospy.wait_for_service("trainee/goal", 20)
        self.send = rospy.ServiceProxy("trainee/goal", SendGoal)
        self.assertIsNotNone(self.applied.waits_for(lambda m: True, 20), self.trainee.output())
        no_goal = TraineeGoal(kind="wait", time=-1)
        self.assertTrue(wait_until(lambda: "the scene yet" not in self.send(no_goal).message, 20))
        self.assertTrue(wait_until(lambda: self.goals.get_num_connections() and self.cancel.get_num_connections()))

    def entry(self, number):
        """The newest news of a goal, or None."""
        messages = self.progress.messages
        goals = messages[-1].goals if messages else []
        return goals[number - 1] if len(goals) >= number else None

    def reaches(self, number, state, seconds=60):
        return wait_until(lambda: self.entry(number) and self.entry(number).state == state, seconds)

    def check_a_bite(self):
        reply = self.send(TraineeGoal(kind="insufflate", time=1.0, label="gas"))
        self.assertTrue(reply.success, reply.message)
        self.assertEqual(reply.id, 1)
        self.assertIn("insufflate", reply.message)
        reply = self.send(TraineeGoal(kind="bite", along=0.5, around=0.35, label="here"))
        self.assertEqual((reply.success, reply.id), (True, 2))
        self.assertTrue(self.reaches(2, ACTIVE), self.trainee.output())
        self.assertEqual(self.entry(2).label, "here")
        self.assertEqual(self.entry(2).goal, "bite at 50 % of the axis, 20 deg")
        self.assertTrue(self.entry(2).activity)
        self.assertIn(self.entry(1).state, (REACHED, FAILED))
        self.assertTrue(wait_until(lambda: self.entry(2).state in (REACHED, FAILED), 120), self.trainee.output())
        self.assertTrue(self.entry(2).state == REACHED or self.entry(2).reason)

    def test_a_bite_here_in_lockstep(self):
        self.begin()
        self.check_a_bite()

    def test_a_bite_here_without_lockstep(self):
        self.begin(lockstep="false")
        self.check_a_bite()

    def test_without_a_goal_others_may_drive(self):
        self.begin(lockstep="false")
        self.motion.clear()
        self.assertTrue(self.send(TraineeGoal(kind="wait", time=1.0)).success)
        self.assertTrue(self.reaches(1, REACHED))
        self.assertGreater(len(self.motion.messages), 20)
        rospy.sleep(0.2)  # what is on its way
        self.motion.clear()
        rospy.sleep(1)
        self.assertEqual(len(self.motion.messages), 0)

    def test_bad_goals_are_refused_with_one_sentence_and_the_session_goes_on(self):
        self.begin()
        bad = {
            "out of range": TraineeGoal(kind="bite", along=1.5),
            "not finite": TraineeGoal(kind="bite", along=math.nan),
            "did you mean 'bite'": TraineeGoal(kind="bites"),
            "did you mean 'body'": TraineeGoal(kind="bite", along=0.5, region="bodi"),
            "known are u, z": TraineeGoal(kind="suture_set", along=0.5, pattern="w"),
            "does not exist": TraineeGoal(kind="suture_set", along=0.5, pattern="square", bites=4),
            "has no section 'marking'": TraineeGoal(kind="mark", along=0.5),
        }
        for words, goal in bad.items():
            with self.subTest(words):
                reply = self.send(goal)
                self.assertEqual((reply.success, reply.id), (False, 0))
                self.assertIn(words, reply.message)
                self.assertNotIn("\n", reply.message)
        self.assertFalse(self.progress.messages[-1].goals)
        # by topic the sentence is in the progress
        self.goals.publish(TraineeGoal(kind="bite", around=9.0, label="far"))
        self.assertTrue(self.reaches(1, FAILED))
        self.assertEqual(self.entry(1).label, "far")
        self.assertIn("out of range", self.entry(1).reason)
        self.goals.publish(TraineeGoal(kind="wait", time=0.2))
        self.assertTrue(self.reaches(2, REACHED), self.trainee.output())

    def test_goals_can_be_cancelled(self):
        self.begin()
        for _ in range(3):
            self.send(TraineeGoal(kind="wait", time=3000.0))
        self.assertTrue(self.reaches(1, ACTIVE))
        self.cancel.publish(2)
        self.assertTrue(self.reaches(2, FAILED))
        self.assertEqual(self.entry(1).state, ACTIVE)
        self.cancel.publish(1)
        self.assertTrue(self.reaches(3, ACTIVE))
        self.assertEqual([self.entry(k).reason for k in (1, 2)], ["cancelled", "cancelled"])
        self.cancel.publish(0)
        self.assertTrue(self.reaches(3, FAILED))
        self.cancel.publish(77)  # there is none
        self.assertTrue(self.send(TraineeGoal(kind="wait", time=0.1)).success)
        self.assertTrue(self.reaches(4, REACHED))

    def test_a_reset_ends_the_goals_and_new_ones_are_welcome(self):
        self.begin()
        self.send(TraineeGoal(kind="wait", time=3000.0))
        self.assertTrue(self.reaches(1, ACTIVE))
        self.assertTrue(rospy.ServiceProxy("reset", Reset)(0, True).success)
        self.assertTrue(self.reaches(1, FAILED), self.trainee.output())
        self.assertEqual(self.entry(1).reason, "the session has ended")
        self.assertTrue(self.send(TraineeGoal(kind="wait", time=0.1)).success)
        self.assertTrue(self.reaches(2, REACHED))

    def test_a_scene_without_anatomy_is_a_reason(self):
        self.start("sim_node", scene=scene("balloon.yaml"), time_source="sim", lockstep="true", fast="true")
        trainee = self.start("vibe_trainee", lockstep="true", skill="novice")
        rospy.wait_for_service("trainee/goal", 20)
        self.assertIsNotNone(self.applied.waits_for(lambda m: True, 20), trainee.output())
        reply = rospy.ServiceProxy("trainee/goal", SendGoal)(TraineeGoal(kind="bite", along=0.5))
        self.assertFalse(reply.success)
        self.assertGreater(len(reply.message), 20)
        self.assertEqual(self.progress.messages[-1].skill, "novice")

    def test_the_program_of_the_tutorial(self):
        self.begin()
        with open(TUTORIAL, encoding="utf-8") as text:
            program = re.search(r"```python\n(.*?)```", text.read(), re.DOTALL).group(1)
        with tempfile.NamedTemporaryFile("w", suffix=".py") as file:
            file.write(program)
            file.flush()
            command = [sys.executable, file.name]
            done = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True, timeout=240)
        self.assertEqual(done.returncode, 0)
        lines = done.stdout.splitlines()
        self.assertEqual(len(lines), 4, done.stdout)
        self.assertTrue(lines[0].startswith("insufflate: (True"), done.stdout)
        self.assertTrue(lines[3].startswith("withdraw: (True"), done.stdout)

    def test_wrong_parameters_end_the_program(self):
        trainee = self.start("vibe_trainee", skill="master")
        self.assertEqual(trainee.ends(20), 2)
        self.assertIn("expert or novice", trainee.output())


if __name__ == "__main__":
    rospy.init_node("servo_test")
    rostest.rosrun("vibe_sim", "servo_test", ServoTest, sys.argv)
