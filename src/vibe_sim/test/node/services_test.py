#!/usr/bin/env python3
"""Every service: what it does, that it has done it when it answers, and what it says when it cannot."""

import os
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from node_test_support import EPOCH, SCOPE_JOINTS, joints, scene, stamp_of
from sensor_msgs.msg import JointState, PointCloud2
from std_srvs.srv import SetBool
from vibe_msgs.msg import ProcedureState, SolverStatistics, StepInput, TissueTopology
from vibe_msgs.srv import LoadScene, Reset, Snapshot, Step
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until


class ServicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.particles = Recorder("tissue/particles", PointCloud2)
        cls.procedure = Recorder("procedure/state", ProcedureState)
        cls.topology = Recorder("tissue/topology", TissueTopology)
        cls.performance = Recorder("solver_statistics", SolverStatistics)
        cls.scope = rospy.Publisher("scope/input/joint_states", JointState, queue_size=100)
        kinds = {
            "pause": SetBool,
            "step": Step,
            "reset": Reset,
            "save_snapshot": Snapshot,
            "load_snapshot": Snapshot,
            "load_scene": LoadScene,
        }
        for name in kinds:
            rospy.wait_for_service(name, 20)
        cls.call = {name: rospy.ServiceProxy(name, kind) for name, kind in kinds.items()}
        recorders = (cls.applied, cls.particles, cls.procedure, cls.performance)
        assert wait_until(lambda: all(r.is_connected() for r in recorders), 20)
        assert wait_until(lambda: cls.scope.get_num_connections() > 0, 20)

    def setUp(self):
        self.call["pause"](True)
        reply = self.call["reset"](seed=0, keep_time=False)
        self.assertTrue(reply.success, reply.message)
        rospy.rostime.wallsleep(0.2)
        for recorder in (self.applied, self.particles, self.procedure):
            recorder.clear()

    def forget_particles(self):
        rospy.rostime.wallsleep(0.2)  # for those that are on the way
        self.particles.clear()

    def hash(self):
        rospy.rostime.wallsleep(0.1)  # for a report from before
        self.performance.clear()
        return self.performance.waits_for(lambda m: True, 4).state_hash

    def assert_fails(self, service, words, *arguments, **named):
        reply = self.call[service](*arguments, **named)
        self.assertFalse(reply.success)
        self.assertEqual(reply.message.count("\n"), 0)
        for word in words:
            self.assertIn(word, reply.message)

    def test_pause_stops_and_resumes(self):
        self.assertTrue(self.call["pause"](False).success)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) > 10))
        self.assertTrue(self.call["pause"](True).success)
        rospy.rostime.wallsleep(0.2)
        count = len(self.applied.messages)
        rospy.rostime.wallsleep(0.5)
        self.assertEqual(len(self.applied.messages), count)
        self.assertTrue(self.procedure.messages[-1].paused)
        self.assertTrue(any(not m.paused for m in self.procedure.messages))
        self.assertTrue(self.call["pause"](True).success)  # twice is no error

    def test_step_has_taken_the_steps_when_it_answers(self):
        reply = self.call["step"](25)
        self.assertTrue(reply.success, reply.message)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) == 25))
        rospy.rostime.wallsleep(0.3)
        self.assertEqual([m.step for m in self.applied.messages], list(range(25)))

    def test_step_refuses_zero_steps_and_a_running_simulation(self):
        self.assert_fails("step", ["0 steps"], 0)
        self.call["pause"](False)
        self.assert_fails("step", ["paused"], 5)

    def test_reset_restores_the_initial_state_and_time_goes_on(self):
        initial = self.hash()
        self.call["step"](30)
        self.assertNotEqual(self.hash(), initial)
        self.forget_particles()
        reply = self.call["reset"](seed=0, keep_time=True)
        self.assertTrue(reply.success, reply.message)
        self.assertEqual(self.hash(), initial)
        self.call["step"](5)
        self.assertTrue(wait_until(lambda: len(self.particles.messages) == 6))
        # the reset takes the place of one step, so that no stamp is there twice
        self.assertEqual(self.particles.stamps(), [stamp_of(k) for k in range(31, 37)])

    def test_reset_can_set_the_time_back(self):
        self.call["step"](30)
        self.forget_particles()
        self.assertTrue(self.call["reset"](seed=0, keep_time=False).success)
        self.call["step"](2)
        self.assertTrue(wait_until(lambda: len(self.particles.messages) == 3))
        self.assertEqual(self.particles.stamps(), [EPOCH, stamp_of(1), stamp_of(2)])

    def test_reset_takes_a_seed(self):
        initial = self.hash()
        self.assertTrue(self.call["reset"](seed=99, keep_time=True).success)
        self.assertIsNotNone(self.procedure.waits_for(lambda m: m.seed == 99))
        self.assertNotEqual(self.hash(), initial)

    def test_a_loaded_snapshot_has_the_same_future(self):
        self.scope.publish(joints(SCOPE_JOINTS, (0.075, 0, 0, 0), rospy.Time(nsecs=EPOCH)))
        rospy.rostime.wallsleep(0.3)
        self.call["step"](40)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "session.snapshot")
            reply = self.call["save_snapshot"](file=file)
            self.assertTrue(reply.success, reply.message)
            self.assertTrue(os.path.exists(file))
            saved = self.hash()
            self.call["step"](20)
            moved_on = self.hash()
            self.assertNotEqual(moved_on, saved)
            self.forget_particles()
            reply = self.call["load_snapshot"](file=file)
            self.assertTrue(reply.success, reply.message)
            self.assertEqual(self.hash(), saved)
            # the scope had not arrived yet: tell it again where to go
            self.scope.publish(joints(SCOPE_JOINTS, (0.075, 0, 0, 0), rospy.Time(nsecs=EPOCH)))
            rospy.rostime.wallsleep(0.3)
            self.call["step"](20)
            self.assertEqual(self.hash(), moved_on)
            stamps = self.particles.stamps()
            self.assertEqual(stamps, sorted(set(stamps)))
            self.assertGreater(stamps[0], stamp_of(60))

    def test_bad_snapshots_are_refused_and_nothing_changes(self):
        before = self.hash()
        self.assert_fails("load_snapshot", ["/nowhere/x.snapshot"], file="/nowhere/x.snapshot")
        self.assert_fails("save_snapshot", ["/nowhere/x.snapshot"], file="/nowhere/x.snapshot")
        self.assert_fails("load_snapshot", ["balloon.yaml"], file=scene("balloon.yaml"))
        self.assert_fails("load_snapshot", ["balloon.yaml"], file=scene("balloon.yaml"), other_scene=True)
        self.assertEqual(self.hash(), before)

    def test_load_scene_replaces_the_scene_and_back(self):
        wait_until(lambda: self.topology.messages)
        revision = self.topology.messages[-1].revision
        self.call["step"](10)
        self.forget_particles()
        self.addCleanup(self.call["load_scene"], scene("balloon.yaml"))
        reply = self.call["load_scene"](scene("rest.yaml"))
        self.assertTrue(reply.success, reply.message)
        topology = self.topology.waits_for(lambda m: m.revision == revision + 1)
        self.assertEqual((topology.name, len(topology.region)), ("rest", 200))
        self.call["step"](3)
        self.assertTrue(wait_until(lambda: len(self.particles.messages) == 4))
        self.assertEqual({m.width for m in self.particles.messages}, {200})
        # another step period, the same time
        begin = stamp_of(11)
        self.assertEqual(self.particles.stamps(), [begin + k * 20_000_000 for k in range(4)])

    def test_a_bad_scene_is_refused_and_the_old_one_goes_on(self):
        before = self.hash()
        self.assert_fails("load_scene", ["/nowhere.yaml"], "/nowhere.yaml")
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("name: bad\ngeometry: {kind: sphere}\ntisue: {}\n")
            file.flush()
            self.assert_fails("load_scene", [":3:", "tisue", "tissue"], file.name)
        self.assertEqual(self.hash(), before)
        self.assertTrue(self.call["step"](1).success)

    def test_calls_from_several_sides_at_once_are_all_answered(self):
        replies = {"step": [], "pause": []}

        def work(service, argument):
            replies[service].append(self.call[service](argument))

        threads = [threading.Thread(target=work, args=("step", 50)) for _ in range(3)]
        threads.append(threading.Thread(target=work, args=("pause", True)))
        begin = time.monotonic()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(20)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual([reply.success for reply in replies["pause"]], [True])
        # a request for steps is either done as a whole or rejected while another is being done
        self.assertEqual(len(replies["step"]), 3)
        done = [reply for reply in replies["step"] if reply.success]
        self.assertGreaterEqual(len(done), 1)
        for reply in replies["step"]:
            self.assertIn("Took 50 steps" if reply.success else "another caller", reply.message)
        self.assertTrue(wait_until(lambda: len(self.applied.messages) >= 50 * len(done)))
        rospy.rostime.wallsleep(0.2)
        self.assertEqual([m.step for m in self.applied.messages], list(range(50 * len(done))))


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("vibe_sim", "services_test", ServicesTest, sys.argv)
