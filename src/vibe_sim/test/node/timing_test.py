#!/usr/bin/env python3
"""When steps run: step_timing, steps that follow an input, stalls, real-time priority."""

import os
import signal
import statistics
import sys
import threading
import time
import unittest

import rospy
import rostest
from node_test_support import PERIOD, SCOPE_JOINTS, joints, scene
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from vibe_msgs.msg import StepInput, StepTiming
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

SCHED_FIFO = 1


def ns(stamp):
    return stamp.to_nsec()


class Device:
    """Sends joints at times begin + k * PERIOD of the wall clock, with stamps that are `ahead` of their sending [s]."""

    def __init__(self, begin, position_at=lambda time: 0.02, ahead=0.0):
        self.publisher = rospy.Publisher("scope/input/joint_states", JointState, queue_size=10, tcp_nodelay=True)
        self.begin, self.position_at, self.ahead = begin, position_at, ahead
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        k = 0
        while not self.ended.is_set():
            due = self.begin + k * PERIOD
            time.sleep(max(0, due - time.time()))
            stamp = due + self.ahead
            position = (self.position_at(stamp), 0, 0, 0)
            self.publisher.publish(joints(SCOPE_JOINTS, position, rospy.Time.from_sec(stamp)))
            k += 1

    def stop(self):
        self.ended.set()
        self.thread.join()
        self.publisher.unregister()


class TimingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.timing = Recorder("step_timing", StepTiming)
        cls.pose = Recorder("scope/measured_cp", PoseStamped)
        cls.applied = Recorder("applied_input", StepInput)

    def start(self, scene_file="light.yaml", **parameters):
        self.simulator = Program("vibe_sim", "sim_node", name="sim_node", scene=scene(scene_file), **parameters)
        self.addCleanup(self.stop)
        self.timing.clear()
        self.pose.clear()
        self.applied.clear()
        self.assertTrue(wait_until(lambda: len(self.timing.messages) > 60, 20), self.simulator.output())

    def stop(self):
        self.assertEqual(self.simulator.stop(), 0, self.simulator.output())

    def wait_before_step(self, device):
        """By how many periods samples are older than the begin of the next step, in the median of the last second."""
        begins = [1e-9 * ns(m.begin) for m in self.timing.messages[-60:]]
        return statistics.median(((b - device.begin) / PERIOD) % 1 for b in begins)

    def device_after_steps(self):
        """A device whose samples come 30 % of a period after the begin of steps as it is now: too late for them."""
        begins = [1e-9 * ns(m.begin) for m in self.timing.messages[-60:]]
        offset = statistics.median((b - begins[0] + 0.5 * PERIOD) % PERIOD - 0.5 * PERIOD for b in begins)
        first = begins[0] + offset + 0.3 * PERIOD
        return Device(first + PERIOD * int((time.time() - first) / PERIOD + 10))

    def test_times_are_in_order_and_stamps_those_of_the_state(self):
        self.start()
        for message in self.timing.messages[10:]:
            times = [ns(t) for t in (message.due, message.begin, message.solved, message.published)]
            self.assertEqual(times, sorted(times))
            self.assertLess(abs(ns(message.due) - ns(message.header.stamp)), 2)  # a step is due at the stamp of its result
        steps = [m.step for m in self.timing.messages]
        self.assertEqual(steps, list(range(steps[0], steps[0] + len(steps))))
        self.assertTrue(wait_until(lambda: len(set(self.pose.stamps()) & set(self.timing.stamps())) > 50))

    def stages_of(self, message):
        return [getattr(message, name) for name in message.__slots__ if name.startswith("stage_")]

    def test_stages_add_up_to_the_time_of_the_step(self):
        self.start("light_shell.yaml")
        for message in self.timing.messages[10:]:
            stages = self.stages_of(message)
            self.assertEqual(len(stages), 8)
            self.assertEqual(message.stage_energy > 0, message.evaluations > 0, message)
            self.assertTrue(all(s >= 0 for s in stages), stages)
            # of the thread's CPU, and so no more than the wall time around it
            self.assertLess(sum(stages), 1e-9 * (ns(message.solved) - ns(message.begin)) + 1e-4)
            self.assertGreaterEqual(message.evaluations, message.iterations)
        self.assertGreater(max(m.evaluations for m in self.timing.messages), 0)

    def test_shape_matching_has_one_stage_only(self):
        self.start()
        for message in self.timing.messages[10:]:
            self.assertEqual([s for s in self.stages_of(message) if s > 0], [message.stage_other])

    def test_steps_that_follow_begin_when_a_sample_arrives(self):
        self.start(follow="scope/input/joint_states")
        device = self.device_after_steps()
        self.addCleanup(device.stop)
        self.assertTrue(wait_until(lambda: self.wait_before_step(device) < 0.3, 15), self.wait_before_step(device))
        stamps = self.timing.stamps()
        self.assertEqual(stamps, sorted(set(stamps)))

    def test_steps_that_do_not_follow_leave_a_sample_waiting(self):
        self.start()
        device = self.device_after_steps()
        self.addCleanup(device.stop)
        time.sleep(4)
        self.assertGreater(self.wait_before_step(device), 0.5)

    def test_after_a_stall_steps_come_faster_but_in_no_burst_and_the_motion_keeps_its_form(self):
        self.start()
        start = time.time()
        ramp = lambda when: 0.02 + 0.03 * max(0.0, when - start)  # noqa: E731  30 mm/s
        device = Device(start + 0.1, ramp, ahead=0.2)  # a stall of this test must not count
        self.addCleanup(device.stop)
        time.sleep(1)
        stalled = time.time()
        self.simulator.send(signal.SIGSTOP)
        time.sleep(0.15)
        self.simulator.send(signal.SIGCONT)
        time.sleep(1)
        # from the last steps before the stall on: a burst would be between them and the first one after it
        messages = [m for m in self.timing.messages if stalled - 0.05 < 1e-9 * ns(m.begin) < stalled + 0.8]
        begins = [1e-9 * ns(m.begin) for m in messages]
        late = [1e-9 * (ns(m.begin) - ns(m.due)) for m in messages]
        self.assertGreater(max(late), 0.08)
        self.assertLess(statistics.median(late[-15:]), PERIOD)  # it has been made up for
        self.assertGreater(min(b - a for a, b in zip(begins, begins[1:])), 0.45 * PERIOD)
        used = [m.joints[0] for m in self.applied.messages if m.step in {m.step for m in messages}]
        self.assertLess(max(b - a for a, b in zip(used, used[1:])), 3.5 * 0.03 * PERIOD)

    def scheduling(self):
        """(policy, priority) of the threads of the simulator."""
        folder = "/proc/{}/task".format(self.simulator.process.pid)
        found = []
        for task in os.listdir(folder):
            with open(os.path.join(folder, task, "stat"), encoding="ascii", errors="replace") as text:
                fields = text.read().rsplit(")", 1)[1].split()
            found.append((int(fields[38]), int(fields[37])))
        return found

    def test_real_time_priority_is_taken_or_refused_with_a_sentence(self):
        self.start(realtime_priority=20)
        taken = (SCHED_FIFO, 20) in self.scheduling()
        refused = self.simulator.count("runs without real-time priority") == 1
        self.assertNotEqual(taken, refused, self.simulator.output())

    def test_without_permission_the_simulator_says_so_and_runs(self):
        wrapper = ["prlimit", "--rtprio=0", "--memlock=65536"]
        if os.geteuid() == 0:
            wrapper = wrapper + ["setpriv", "--bounding-set=-sys_nice,-ipc_lock,-sys_resource"]
        self.start_wrapped(wrapper, realtime_priority=20)
        self.assertFalse(any(policy == SCHED_FIFO for policy, _ in self.scheduling()))
        self.assertTrue(self.simulator.says("runs without real-time priority: SCHED_FIFO"))
        self.assertTrue(self.simulator.says("Memory is not locked"))
        self.assertTrue(self.simulator.says("limits.d"))

    def start_wrapped(self, wrapper, **parameters):
        parameters["scene"] = scene("light.yaml")
        self.simulator = Program("vibe_sim", "sim_node", name="sim_node", wrapper=wrapper, **parameters)
        self.addCleanup(self.stop)
        self.timing.clear()
        self.assertTrue(wait_until(lambda: len(self.timing.messages) > 60, 20), self.simulator.output())

    def test_wrong_parameters_are_refused(self):
        for words, parameters in (
            ("scope/input/joint_states or suturing_device/input/joint_states", {"follow": "scope/buttons"}),
            ("realtime_priority must be a whole number from 0 to 99", {"realtime_priority": 100}),
        ):
            program = Program("vibe_sim", "sim_node", name="sim_node", scene=scene("light.yaml"), **parameters)
            self.assertEqual(program.ends(20), 2, program.output())
            self.assertEqual(program.count(words), 1, program.output())


if __name__ == "__main__":
    rospy.init_node("timing_test")
    rostest.rosrun("vibe_sim", "timing_test", TimingTest, sys.argv)
