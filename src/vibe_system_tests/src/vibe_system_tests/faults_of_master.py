"""The ROS master dies and comes back on its port, empty."""

import os
import time

from sensor_msgs.msg import JointState
from vibe_msgs.msg import StepInput
from vibe_testing.wait import wait_until

from .fault_bench import Flow, Row, expect, script_of_motions

LIMIT = 2.0  # from the start of a program until its messages come [s]
OUTAGE = 3.0  # without a master [s]
UNDISTURBED = 1.0  # the longest silence of those who are connected [s]
STRANGER = 2.0  # for a node that is new after the return of the master to hear nothing [s]


class Master:
    """Simulator, trainee and recorder."""

    def __init__(self, bench):
        self.bench = bench
        self.bag = os.path.join(bench.folder, "first.bag")

    def prepare(self):
        bench = self.bench
        # not through roscore: it would end with its master
        bench.start("rosmaster", "rosmaster", "rosmaster", "--core", "-p", str(bench.graph.port))
        expect(wait_until(self.answers), "no master answers")
        bench.observe()
        self.steps = Flow("applied_input", StepInput, True)
        self.joints = Flow("scope/input/joint_states", JointState)
        bench.start_simulator()
        bench.start("vibe_trainee", "vibe_sim", "vibe_trainee",
                    script=bench.file("motions.yaml", script_of_motions("to and fro")))
        bench.start("vibe_record", "vibe_sim", "vibe_record", "--all", self.bag)
        begin = time.monotonic()
        expect(self.steps.wait(begin) and self.joints.wait(begin), "the graph does not start")
        time.sleep(1)

    def faults(self):
        return [
            ("the master dies: those who are connected go on", self.lose),
            ("the master is back, empty: the simulator says so", self.find),
            ("a restarted graph works with the new master", self.restart),
        ]

    def answers(self):
        try:
            return self.bench.graph.master.getPid("/observer")[0] == 1
        except OSError:
            return False

    def check_going_on(self, begin):
        now = time.monotonic()
        for flow in (self.steps, self.joints):
            gap = flow.gap(begin, now)
            expect(gap < UNDISTURBED, "{} was silent for {:.2f} s".format(flow.topic, gap))
        self.bench.check_alive()

    def lose(self):
        mark = self.bench.mark("sim_node")
        begin = self.bench.kill("rosmaster")
        sentence = self.bench.says("sim_node", "does not answer", mark)
        time.sleep(max(0.0, begin + OUTAGE - time.monotonic()))
        expect(not self.answers(), "the master still answers")
        self.check_going_on(begin)
        return [Row("master killed", "nothing among connected nodes; new ones cannot find them", 0.0,
                    sentence)]

    def find(self):
        mark = self.bench.mark("sim_node")
        begin = self.bench.start("rosmaster")
        expect(wait_until(self.answers), "the master does not come back")
        sentence = self.bench.says("sim_node", "answers again", mark)
        self.bench.says("vibe_record", "answers again; if it is a new one, start another recording")
        expect(not self.bench.graph.has_node("/sim_node"), "the new master knows the simulator")
        time.sleep(1)
        self.check_going_on(begin)
        self.start_listener("stranger")
        time.sleep(STRANGER)
        heard = self.heard("stranger")
        expect(heard == {}, "a new node hears {}".format(heard))
        return [Row("master back on its port", "all registrations and parameters: nodes do not register again (ROS 1)",
                    None, sentence)]

    def start_listener(self, name):
        """A node of the new graph, in a process of its own: this one is known to the old master only."""
        self.bench.start_module(name, "listener", name, "/applied_input", "/scope/input/joint_states")
        self.bench.says(name, "listens")

    def heard(self, name):
        """Topics that a listener has heard, and when first."""
        return {line.split()[0]: float(line.split()[1]) for line in self.bench.said(name) if line.startswith("/")}

    def restart(self):
        statuses = [self.bench.stop(name) for name in ("vibe_trainee", "sim_node", "vibe_record")]
        expect(statuses == [0, 0, 0], "ended with {}".format(statuses))
        expect(os.path.getsize(self.bag) > 100000, "the first recording is empty")
        self.bench.commands["vibe_record"][-2] = self.bag + ".second"
        self.bench.start("vibe_record")
        times = []
        for name, topic in (("sim_node", "/applied_input"), ("vibe_trainee", "/scope/input/joint_states")):
            begin = self.bench.start(name)
            expect(wait_until(lambda topic=topic: topic in self.heard("stranger")), topic + " is not heard")
            times.append(self.heard("stranger")[topic] - begin)
        expect(max(times) < LIMIT, "it took {:.2f} s".format(max(times)))
        recorded = self.bag + ".second.active"
        expect(wait_until(lambda: os.path.exists(recorded) and os.path.getsize(recorded) > 100000), "nothing is recorded")
        self.bench.check_alive()
        return [Row("simulator, trainee and recorder started again", "the session since its last snapshot", max(times),
                    "everything as after a first start")]
