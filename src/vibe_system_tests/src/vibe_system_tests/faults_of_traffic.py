"""Too much, too slow and at the wrong time: floods, deaf listeners, wrong clocks, and a simulator that stands still."""

import math
import signal
import time

from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from vibe_msgs.msg import ProcedureEvent, StepInput
from vibe_testing.wait import wait_until

from . import fault_peers
from .fault_bench import Flow, Row, expect, pace, script_of_motions

RATE = 10000.0  # of a flood [Hz]
LEAST_RATE = 0.5  # of that, on a busy machine
WINDOW = 3.0  # over which the pace is measured [s]
LEAST_PACE = 0.95  # of the pace before
MOST_MEMORY = 20.0  # by which a flood may raise what is resident [MB]
DEAF_MEMORY = 60.0  # that may wait for a listener [MB]
QUEUE = 10000  # small messages that wait for a listener
FULL = 1.5  # times as many steps as messages may wait
SMALL = 4096  # buffer of a listener in the kernel, so that what waits, waits in the simulator [bytes]
STANDSTILL = 3.0  # [s]
APART = 0.015  # how far the command is from where it was when the simulator goes on [m]
HOUR = 3600.0  # [s]
SPEEDS = (0.15, math.pi, math.pi, math.pi)  # largest, of the joints of the scope, from scope.urdf [m/s, rad/s]


class Traffic:
    """Simulator and trainee in wall time."""

    def __init__(self, bench):
        self.bench = bench

    def prepare(self):
        bench = self.bench
        bench.graph.start_master()
        bench.observe()
        self.steps = Flow("applied_input", StepInput, True)
        self.events = Flow("procedure/events", ProcedureEvent, True)
        self.poses = Flow("scope/measured_cp", PoseStamped, True)
        self.commands = Flow("scope/input/joint_states", JointState, True)
        self.setpoints = Flow("scope/setpoint_js", JointState, True)
        bench.start_simulator()
        self.aside = Flow("trainee/suturing_device")  # it waits for a listener of all that it sends
        bench.start("vibe_trainee", "vibe_sim", "vibe_trainee",
                    "suturing_device/input/joint_states:=trainee/suturing_device",
                    script=bench.file("motions.yaml", script_of_motions("to and fro")))
        expect(self.steps.wait(time.monotonic(), lambda m: m.joints[0] > 0.03), "the trainee does not drive")
        time.sleep(1)

    def faults(self):
        return [
            ("a flood of valid messages", lambda: self.flood("valid", "suturing_device/input/joint_states")),
            ("a flood of invalid messages", lambda: self.flood("invalid", "scope/servo_jp")),
            ("a flood of messages that cannot be read", lambda: self.flood("garbage", "scope/servo_jp")),
            ("a node whose clock is an hour ahead", lambda: self.wrong_clock(HOUR)),
            ("a node whose clock is an hour behind", lambda: self.wrong_clock(-HOUR)),
            ("listeners that stand still", self.deaf),
            ("the simulator stands still for three seconds", self.stand_still),
        ]

    def start_peer(self, name, *arguments):
        self.bench.start_module(name, "fault_peers", "--name", "/" + name, *arguments)

    def achieved(self, name):
        """Messages that a flood has sent in a second, in the mean [Hz]."""
        seconds, count = self.bench.said(name)[-1].split()
        return float(count) / float(seconds)

    def flood(self, kind, topic):
        bench = self.bench
        before, memory, begin = pace(self.steps, WINDOW), bench.memory("sim_node"), time.monotonic()
        log = bench.mark("sim_node")
        self.start_peer("flood", "--topic", "/" + topic, "--kind", kind, "--rate", str(RATE))
        expect(wait_until(lambda: len(bench.said("flood")) > 1 and self.achieved("flood") > 0), "no flood")
        during = pace(self.steps, WINDOW)
        rate, grown = self.achieved("flood"), bench.memory("sim_node") - memory
        written = (bench.mark("sim_node") - log) / (time.monotonic() - begin)
        bench.kill("flood")
        expect(rate > LEAST_RATE * RATE, "only {:.0f} messages a second were taken".format(rate))
        expect(during > LEAST_PACE * before, "pace {:.3f}, before {:.3f}".format(during, before))
        expect(grown < MOST_MEMORY, "memory grew by {:.1f} MB".format(grown))
        bench.check_alive()
        told = [m.text for _, m in self.events.since(begin) if m.kind == ProcedureEvent.WARNING]
        share = self.share_of_flood(4 if kind == "valid" else 0, begin + 1)
        print("{}: share of steps that used it {:.2f}, {} warnings".format(kind, share, len(told)))
        if kind == "valid":
            expect(share > 0.9 and not told, "the flood was not obeyed in {:.2f} of the steps".format(1 - share))
        if kind == "invalid":
            expect(told and len(told) <= time.monotonic() - begin + 1, "{} warnings".format(len(told)))
        expect(kind == "valid" or share == 0, "messages that are wrong were obeyed")
        seen = told[-1] if told else (bench.said("sim_node", log) or ["nothing"])[0]
        return [Row("{:.0f} messages a second, {}, on {}".format(rate, kind, topic),
                    "nothing; pace {:.2f} (before {:.2f}), memory +{:.1f} MB, log {:.0f} kB/s".format(
                        during, before, grown, written / 1e3), 0.0, seen)]

    def share_of_flood(self, joint, begin):
        """Share of the steps since then that used the position of the flood for this joint."""
        used = [m.joints[joint] == fault_peers.POSITION for _, m in self.steps.since(begin)]
        return sum(used) / len(used)

    def wrong_clock(self, ahead):
        begin = time.monotonic()
        self.start_peer("late", "--topic", "/scope/servo_jp", "--rate", "100", "--ahead", str(ahead))
        words = "ahead of" if ahead > 0 else "behind"
        told = self.events.wait(begin, lambda m: "/late" in m.text and words in m.text)
        expect(told is not None, "the node is not named; said: {}".format(
            [m.text for _, m in self.events.since(begin)][-3:]))
        time.sleep(1)
        refused = time.monotonic()
        moved = [m.joints[0] for _, m in self.steps.since(refused - 1)]
        self.bench.kill("late")
        expect(max(moved) - min(moved) > 0.005, "the trainee does not drive any more")
        expect(self.steps.gap(begin, refused) < 1, "the simulator stood still")
        self.bench.check_alive()
        time.sleep(1.1)  # complaints are limited to one a second per topic
        return [Row("clock of a node {:+.0f} h".format(ahead / HOUR), "its messages", 0.0, told[1].text)]

    def deaf(self):
        bench = self.bench
        before, memory = pace(self.steps, WINDOW), bench.memory("sim_node")
        bench.start_module("deaf", "listener", "deaf", *sorted("/" + topic for topic in TOPICS))
        expect(wait_until(lambda: len(bench.said("deaf")) > 5), "the listener hears nothing")
        bench.send("deaf", signal.SIGSTOP)
        try:
            during = pace(self.steps, WINDOW)
            grown = bench.memory("sim_node") - memory
        finally:
            bench.kill("deaf")
        expect(during > LEAST_PACE * before, "pace {:.3f}, before {:.3f}".format(during, before))
        expect(grown < DEAF_MEMORY, "memory grew by {:.1f} MB".format(grown))
        return [Row("a listener of all topics stands still (SIGSTOP)", "its messages; pace {:.2f} (before {:.2f}), "
                    "memory +{:.1f} MB in {:.0f} s".format(during, before, grown, WINDOW), 0.0, "nothing")]

    def stand_still(self):
        bench = self.bench
        begin = time.monotonic()
        bench.send("sim_node", signal.SIGSTOP)
        try:
            time.sleep(STANDSTILL)
            expect(pace(self.steps, 0.5) < 0.1, "it takes steps although it stands still")  # the pace can drop
            before = self.steps.newest().joints[0]  # it goes on when the trainee is elsewhere, or nothing could jump
            expect(wait_until(lambda: abs(self.commands.newest().position[0] - before) > APART), "no motion")
        finally:
            resumed = time.monotonic()
            bench.send("sim_node", signal.SIGCONT)
        first = self.steps.wait(resumed)
        expect(first is not None, "it does not go on")
        told = self.events.wait(resumed, lambda m: "behind the wall clock and gives that time up" in m.text, 5)
        expect(told is not None, "it does not say that it gives time up")
        after = pace(self.steps, WINDOW)
        expect(after > 0.9, "pace {:.2f} afterwards".format(after))
        jump, allowed, angle = self.largest_jump(begin)
        bench.check_alive()
        return [Row("simulator stands still for {:.1f} s".format(resumed - begin),
                    "that time; largest step of the tip {:.1f} mm (allowed {:.1f}), of a joint {:.0f} % of the "
                    "speed limit".format(1e3 * jump, 1e3 * allowed, 100 * angle), first[0] - resumed, told[1].text)]

    def largest_jump(self, begin):
        """Between two steps: of scope/measured_cp [m], what the limits of speed allow [m], and of a joint as part of
        its limit. The trainee must have moved much further, or nothing could jump."""
        steps = [m for _, m in self.steps.since(begin - 1)]
        apart = max(abs(b.joints[0] - a.joints[0]) for a, b in zip(steps, steps[1:]))
        period = 1 / 60
        enough = apart > 1.5 * SPEEDS[0] * period
        expect(enough, "the command went only {:.1f} mm: nothing could jump".format(1e3 * apart))
        poses = [m.pose.position for _, m in self.poses.since(begin - 1)]
        jump = max(math.dist((a.x, a.y, a.z), (b.x, b.y, b.z)) for a, b in zip(poses, poses[1:]))
        allowed = 1.01 * SPEEDS[0] * period  # the straight tip lies on the axis of the rotation
        expect(jump <= allowed, "the tip jumped by {:.1f} mm, {:.1f} mm are allowed".format(1e3 * jump, 1e3 * allowed))
        joints = [m.position for _, m in self.setpoints.since(begin - 1)]
        shares = [abs(b[i] - a[i]) / (SPEEDS[i] * period) for a, b in zip(joints, joints[1:]) for i in range(4)]
        expect(max(shares) <= 1 + 1e-6, "a joint moved {:.2f} times as fast as it may".format(max(shares)))
        return jump, allowed, max(shares)


TOPICS = (
    "scope/measured_cp", "suturing_device/helix/measured_cp", "scope/measured_cf", "joint_states", "scope/setpoint_js",
    "tissue/topology", "tissue/particles", "procedure/state", "procedure/skill_metrics", "sutures", "applied_input",
    "solver_statistics", "step_result",
)  # fmt: skip


class FastTraffic:
    """A simulator that takes steps as fast as it can, with simulated time: queues fill within seconds."""

    def __init__(self, bench):
        self.bench = bench

    def prepare(self):
        bench = self.bench
        bench.graph.start_master()
        bench.graph.set_parameter("/use_sim_time", True)
        bench.start_simulator(time_source="sim", fast="true")
        bench.waits_for_step("sim_node", 300)

    def faults(self):
        return [("what waits for a listener that stands still is bounded", self.bound)]

    def bound(self):
        """As SIGSTOP would do it, but with a small buffer in the kernel, so that what waits, waits in the simulator. A
        second listener reads, so that it is known how much was published."""
        bench = self.bench
        victim = fault_peers.Victim(bench.graph.env["ROS_MASTER_URI"], "/sim_node")
        readers = [fault_peers.Listener(victim, "/" + topic) for topic in TOPICS]
        before, begin, deaf = bench.memory("sim_node"), bench.step("sim_node"), []
        try:
            deaf = [fault_peers.subscribe(victim, "/" + topic, SMALL) for topic in TOPICS]
            start = sum(reader.bytes for reader in readers)
            bench.waits_for_step("sim_node", begin + FULL * QUEUE)
            waiting = bench.memory("sim_node") - before
            published = (sum(reader.bytes for reader in readers) - start) / 1e6
        finally:
            for connection in deaf + [reader.connection for reader in readers]:
                connection.close()
        steps = bench.step("sim_node") - begin
        expect(published > 2 * DEAF_MEMORY, "only {:.0f} MB were published".format(published))
        expect(waiting < DEAF_MEMORY, "{:.1f} MB wait of {:.0f} MB".format(waiting, published))
        expect(waiting > 1, "nothing waits: the listener is not deaf")
        return [Row("the same for {:.0f} steps, taken as fast as possible".format(steps),
                    "its messages; {:.1f} MB wait of {:.0f} MB that were published".format(waiting, published), None,
                    "nothing")]
