#!/usr/bin/env python3
"""What can go wrong around the simulator: one clear sentence, the right exit status, nothing left behind."""

import os
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import rosgraph
import rospy
import rostest
from node_test_support import scene, state_hash
from std_msgs.msg import String
from vibe_msgs.msg import StepInput
from vibe_testing.program import Program, find_program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class FailuresTest(unittest.TestCase):
    def assert_refuses(self, program, words, **parameters):
        """Ends with status 2 and one sentence that has the words."""
        refused = Program("vibe_sim", program, name=program + "_refused", **parameters)
        try:
            self.assertEqual(refused.ends(20), 2, refused.output())
            self.assertEqual(len(refused.lines), 1, refused.output())
            for word in words:
                self.assertIn(word, refused.lines[0])
        finally:
            refused.stop()

    def test_a_recorder_does_not_wait_for_a_publisher_that_came_and_went(self):
        ghost = rosgraph.Master("/ghost")
        address = "http://localhost:{}".format(free_port())
        ghost.registerPublisher("/seen_once", "std_msgs/Empty", address)
        last = rospy.Publisher("applied_input", StepInput, queue_size=1)
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "ghost.bag")
            recorder = subprocess.Popen(["rosrun", "vibe_sim", "vibe_record", "--last", "applied_input", bag])
            try:
                self.assertTrue(wait_until(lambda: self.is_heard("/seen_once"), 20))
                rospy.rostime.wallsleep(1)
                self.assertEqual(last.get_num_connections(), 0, "it should wait for what is published and not connected")
                ghost.unregisterPublisher("/seen_once", address)
                self.assertTrue(wait_until(lambda: last.get_num_connections() == 1, 20))
            finally:
                recorder.send_signal(signal.SIGINT)
                self.assertEqual(recorder.wait(30), 0)
                last.unregister()

    def is_heard(self, topic):
        """Has the topic a subscriber?"""
        return any(name == topic and nodes for name, nodes in rosgraph.Master("/looker").getSystemState()[1])

    def test_wrong_parameters(self):
        good = scene("balloon.yaml")
        cases = (
            ({}, ["scene"]),
            ({"scene": "/nowhere.yaml"}, ["/nowhere.yaml"]),
            ({"scene": "package://no_such_package/x.yaml"}, ["no_such_package"]),
            ({"scene": good, "trheads": 2}, ["trheads", "threads"]),
            ({"scene": good, "threads": 0}, ["threads", "1 to 256"]),
            ({"scene": good, "threads": "many"}, ["threads"]),
            ({"scene": good, "duration": -1}, ["duration"]),
            ({"scene": good, "time_source": "moon"}, ["moon", "wall or sim"]),
            ({"scene": good, "time_source": "sim"}, ["/use_sim_time", "rosparam set"]),
            ({"scene": good, "fast": "true"}, ["fast", "time_source"]),
            ({"scene": good, "lockstep": "true"}, ["lockstep", "time_source"]),
        )
        for parameters, words in cases:
            with self.subTest(parameters=parameters):
                self.assert_refuses("sim_node", words, **parameters)
        self.assert_refuses("vibe_trainee", ["skill", "clumsy", "expert or novice"], skill="clumsy")
        self.assert_refuses("vibe_trainee", ["/nowhere.yaml"], script="/nowhere.yaml")

    def test_simulated_time_must_be_wanted_by_both_sides(self):
        rospy.set_param("/use_sim_time", True)
        try:
            self.assert_refuses("sim_node", ["/use_sim_time", "wall"], scene=scene("balloon.yaml"))
        finally:
            rospy.delete_param("/use_sim_time")

    def test_the_older_of_two_nodes_of_one_name_ends(self):
        older = Program("vibe_sim", "sim_node", name="twin", scene=scene("balloon.yaml"))
        newer = None
        try:
            self.assertTrue(older.says("x real time"), older.output())
            newer = Program("vibe_sim", "sim_node", name="twin", scene=scene("balloon.yaml"))
            self.assertEqual(older.ends(20), 0, older.output())
            self.assertEqual(older.count("Stopped because the ROS master said so"), 1)
            self.assertTrue(newer.says("x real time"), newer.output())
        finally:
            older.stop()
            self.assertEqual(newer and newer.stop(), 0)

    def test_a_signal_loses_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "summary.txt")
            parameters = {"scene": scene("balloon.yaml"), "duration": 1000, "summary_file": file}
            simulator = Program("vibe_sim", "sim_node", name="signalled", **parameters)
            self.assertTrue(simulator.says("x real time"), simulator.output())
            simulator.send(signal.SIGTERM)
            self.assertEqual(simulator.ends(20), 1)  # less than the duration asked for
            with open(file) as text:
                self.assertEqual(state_hash(text.read()), state_hash(simulator.output()))

    def test_a_summary_that_cannot_be_written_is_an_error(self):
        parameters = {"scene": scene("balloon.yaml"), "duration": 0.1, "summary_file": "/nowhere/summary.txt"}
        simulator = Program("vibe_sim", "sim_node", name="unwritable", **parameters)
        self.assertEqual(simulator.ends(20), 2)
        self.assertIn("/nowhere/summary.txt", simulator.output())

    def test_without_master_it_goes_on_until_nobody_listens(self):
        port = free_port()
        env = {"ROS_MASTER_URI": "http://localhost:{}".format(port)}
        master = subprocess.Popen(
            ["rosmaster", "--core", "-p", str(port)],
            env=dict(os.environ, **env),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        simulator = Program("vibe_sim", "sim_node", env=env, scene=scene("balloon.yaml"), master_timeout=2.5)
        try:
            self.assertTrue(simulator.says("x real time"), simulator.output())
            master.kill()
            master.wait()
            self.assertTrue(simulator.says("does not answer"), simulator.output())
            before = simulator.count("x real time")
            self.assertTrue(wait_until(lambda: simulator.count("x real time") > before, 5))
            self.assertEqual(simulator.ends(20), 1, simulator.output())
            self.assertEqual(simulator.count("does not answer"), 1)
            self.assertEqual(simulator.count("giving up"), 1)
        finally:
            master.kill()
            simulator.stop()

    def test_without_a_master_every_program_says_so_and_ends(self):
        env = {"ROS_MASTER_URI": "http://localhost:{}".format(free_port())}
        for program in ("sim_node", "vibe_trainee", "vibe_record"):
            with self.subTest(program):
                path = find_program("vibe_sim", program)
                shown = subprocess.run([path, "--help"], env=dict(os.environ, **env), capture_output=True, timeout=5)
                self.assertEqual(shown.returncode, 0)
                self.assertIn(b"Usage", shown.stdout)
                alone = subprocess.run(
                    [path, "file.bag"], env=dict(os.environ, **env), capture_output=True, timeout=30
                )
                self.assertNotEqual(alone.returncode, 0)
                self.assertIn(b"No ROS master answers at " + env["ROS_MASTER_URI"].encode(), alone.stderr)

    def test_a_recorder_whose_master_died_still_hears_ctrl_c(self):
        port = free_port()
        env = dict(os.environ, ROS_MASTER_URI="http://localhost:{}".format(port))
        master = subprocess.Popen(
            ["rosmaster", "--core", "-p", str(port)], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "orphan.bag")
            recorder = subprocess.Popen([find_program("vibe_sim", "vibe_record"), bag], env=env)
            try:
                self.assertTrue(wait_until(lambda: os.path.exists(bag + ".active"), 20))
                rospy.rostime.wallsleep(1)
                master.kill()
                master.wait()
                rospy.rostime.wallsleep(2)
                recorder.send_signal(signal.SIGINT)
                self.assertEqual(recorder.wait(10), 0)
                self.assertTrue(os.path.exists(bag))
            finally:
                master.kill()
                recorder.kill()

    def ends_on_a_full_disk(self, bag, status, limit=None):
        """vibe_record ends with the status and one sentence; `limit` is the size of a file that has room [bytes]."""

        def little_room():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # so that writing fails as on a full disk
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        publisher = rospy.Publisher("much", String, queue_size=1000)
        recorder = subprocess.Popen(
            [find_program("vibe_sim", "vibe_record"), bag],
            stderr=subprocess.PIPE,
            preexec_fn=little_room if limit else None,
        )
        try:
            deadline = time.monotonic() + 30
            while recorder.poll() is None and time.monotonic() < deadline:
                publisher.publish(os.urandom(50000).hex())  # noise, of which compression takes the half
                time.sleep(0.01)
            said = recorder.communicate(timeout=10)[1]
            self.assertEqual(recorder.returncode, status, said)
            self.assertEqual(len(said.splitlines()), 1, said)
            return said
        finally:
            recorder.kill()
            publisher.unregister()

    def test_a_recording_on_a_full_disk_ends_with_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "none.bag")
            os.symlink("/dev/full", bag + ".active")
            self.assertIn(b"cannot be written", self.ends_on_a_full_disk(bag, 2))
            bag = os.path.join(folder, "some.bag")
            self.assertIn(b"make room on the disk", self.ends_on_a_full_disk(bag, 1, limit=3000000))
            self.assertGreater(os.path.getsize(bag + ".active"), 1000000)

    def test_await_recorder_waits_for_a_listener(self):
        simulator = Program(
            "vibe_sim", "sim_node", name="patient", scene=scene("balloon.yaml"), duration=0.5, await_recorder="true"
        )
        try:
            self.assertTrue(simulator.says("x real time"), simulator.output())
            self.assertIn("t =    0.00 s", simulator.output())
            applied = Recorder("applied_input", StepInput)
            self.assertEqual(simulator.ends(20), 0, simulator.output())
            self.assertEqual([m.step for m in applied.messages], list(range(30)))
        finally:
            simulator.stop()


if __name__ == "__main__":
    rospy.init_node("failures_test")
    rostest.rosrun("vibe_sim", "failures_test", FailuresTest, sys.argv)
