"""Every node of a session is killed and started again; devices are unplugged, the camera stands still."""

import os
import shutil
import signal
import subprocess
import time

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Joy
from vibe_bringup import places
from vibe_msgs.msg import InstrumentTrackArray, OperatingState, ProcedureEvent, StepInput
from vibe_msgs.srv import Snapshot
from vibe_testing.wait import PATIENCE, wait_until

from .fault_bench import Failure, Flow, Row, expect, script_of_motions

LIMIT = 2.0  # from the start of a program until its messages come again [s]
TRIES = 3  # to do so, since other programs run on this machine, too
OUTAGE = 1.0  # how long a killed node is missing [s]
SETTLED = 0.3  # after which nothing of a killed node is under way any more [s]
UNDISTURBED = 1.0  # the longest silence of a node that has nothing to do with the one that was killed [s]
CAMERA_LIMIT = 8.0  # until the camera lets go of a host that is gone (3 s) and is found again (once a second) [s]
CHUNK = 768 * 1024  # of a bag [bytes]

# The hand holds a pedal down and moves slowly.
HAND = """
name: busy
actions:
  - {move: {insertion: 4 cm}, in: 0.5 s}
  - {press: apc_pedal}
"""


class Nodes:
    """Simulator, robot_state_publisher, recorder, devices, camera, gamepad and trainee, in wall time. Devices and
    camera drive; what gamepad and trainee send goes to topics of their own: the simulator obeys one node only."""

    def __init__(self, bench):
        self.bench = bench
        self.sockets = os.path.join(bench.folder, "bus")
        self.bag = os.path.join(bench.folder, "first.bag")
        self.flows = {}

    def prepare(self):
        bench = self.bench
        os.mkdir(self.sockets)
        bench.graph.start_master()
        with open(places.find(places.ROBOT), encoding="utf-8") as urdf:
            bench.graph.set_parameter("/robot_description", urdf.read())
        rig = os.path.join(bench.folder, "rig.yaml")
        bench.start("vibe_fake_camera", "vibe_vision", "vibe_fake_camera", "--frames", "30", "--config", rig)
        turn = "  - {{move: {{rotation: {} deg}}, in: 1 s}}\n"
        hand = HAND + "".join(turn.format(20 * (-1) ** k) for k in range(400))
        bench.start("vibe_emulator", "vibe_hardware", "vibe_emulator", "--folder", self.sockets, "--hand", "script",
                    bench.file("hand.yaml", hand))
        bench.observe()
        self.listen()
        bench.start_simulator()
        bench.start("robot_state_publisher", "robot_state_publisher", "robot_state_publisher")
        bench.start("vibe_trainee", "vibe_sim", "vibe_trainee", "scope/input/joint_states:=trainee/scope",
                    "suturing_device/input/joint_states:=trainee/suturing_device", "scope/buttons:=trainee/buttons",
                    script=bench.file("motions.yaml", script_of_motions("to and fro")))
        bench.start("gamepad_node", "vibe_hardware", "gamepad_node", "scope/servo_jp:=pad/scope",
                    "suturing_device/input/joint_states:=pad/suturing_device", "scope/buttons:=pad/buttons",
                    replay=places.find("package://vibe_hardware/test/node/pad_session.evemu"))
        bench.start("hardware_node", "vibe_hardware", "hardware_node",
                    "suturing_device/input/joint_states:=suturing_device/buttons_js", bus=self.sockets)
        bench.says("vibe_fake_camera", " serves ", seconds=90)
        bench.start("vision_node", "vibe_vision", "vision_node", config=rig, source="gige:127.0.0.1",
                    publish_images="false")
        bench.start("vibe_record", "vibe_sim", "vibe_record", "--all", self.bag)
        begin = time.monotonic()
        for name, flow in self.flows.items():
            expect(flow.wait(begin) is not None, "{} does not publish {}: {}".format(
                name, flow.topic, bench.said(name)[-5:]))
        expect(self.frames.wait(begin) is not None, "the camera is not tracked: {}".format(bench.said("vision_node")))
        time.sleep(1)

    def listen(self):
        self.flows = {
            "sim_node": Flow("scope/measured_cp", PoseStamped),
            "robot_state_publisher": Flow("/tf"),
            "vibe_trainee": Flow("trainee/scope"),
            "gamepad_node": Flow("pad/scope"),
            "hardware_node": Flow("scope/input/joint_states"),
            "vision_node": Flow("suturing_device/tracking", InstrumentTrackArray),
        }
        self.others = [Flow(topic) for topic in ("trainee/suturing_device", "trainee/buttons", "pad/suturing_device")]
        self.frames = Flow("suturing_device/tracking", InstrumentTrackArray, True, lambda m: m.exposure > 0)
        self.steps = Flow("applied_input", StepInput, True)
        self.events = Flow("procedure/events", ProcedureEvent, True)
        self.buttons = Flow("scope/buttons", Joy, True)
        self.state = Flow("haptic/operating_state", OperatingState, True)

    def faults(self):
        """Name and check of each."""
        return [
            ("sim_node is killed: a snapshot brings the session back", self.kill_simulator),
            ("robot_state_publisher is killed", lambda: [self.kill("robot_state_publisher", "poses of the links")]),
            ("vibe_trainee is killed", lambda: [self.kill("vibe_trainee", "where it was in its script")]),
            ("gamepad_node is killed", lambda: [self.kill("gamepad_node", "where it was in its recording")]),
            ("hardware_node is killed: the pedal is released", self.kill_hardware),
            ("vision_node is killed", self.kill_vision),
            ("vibe_record is killed: what it wrote is read again", self.kill_recorder),
            ("devices are unplugged and plugged in", self.replug),
            ("vibe_emulator is killed", self.kill_emulator),
            ("the camera stands still and goes on", self.stall),
        ]

    # a node does not need those that are not in its list
    NEEDS = {
        "robot_state_publisher": ("sim_node",),
        "gamepad_node": ("sim_node",),
        "hardware_node": ("vibe_emulator",),
        "vision_node": ("vibe_fake_camera",),
    }

    def check_others(self, killed, begin):
        """Nothing else has died or fallen silent since then."""
        self.bench.check_alive()
        now = time.monotonic()
        for name, flow in self.flows.items():
            if name != killed and killed not in self.NEEDS.get(name, ()):
                gap = flow.gap(begin, now)
                expect(gap < UNDISTURBED, "{} was silent for {:.2f} s while {} was killed".format(name, gap, killed))

    def take_away(self, name, during=None):
        """Kills a node, and sees that its messages stop, so that what comes later is from the new one."""
        begin = self.bench.kill(name)
        if during:
            during(begin)
        time.sleep(max(0.0, begin + OUTAGE - time.monotonic()))
        if name in self.flows:
            left = self.flows[name].since(begin + SETTLED)
            expect(not left, "{} messages of {} came after its end".format(len(left), name))
        self.check_others(name, begin)
        return begin

    def bring_back(self, name, waited=None):
        """Starts it again; how long all that depends on it took to publish again [s]. It may try a few times."""
        flows = [flow for node, flow in self.flows.items() if node == name or name in self.NEEDS.get(node, ())]
        for _ in range(TRIES):
            begin = self.bench.start(name)
            times = []
            for flow in [waited] if waited else flows:
                first = flow.wait(begin)
                expect(first is not None, "no message on {} after {} was started: {}".format(
                    flow.topic, name, self.bench.said(name)[-5:]))
                times.append(first[0] - begin)
            self.check_others(name, begin)
            if max(times) < LIMIT:
                return max(times)
            print("{} took {:.2f} s".format(name, max(times)))
            self.take_away(name)
        raise Failure("{} took {:.2f} s to come back, and no less in {} attempts".format(name, max(times), TRIES))

    def kill(self, name, lost, seen="nothing from other nodes; `scripts/run` ends with \"{} died\""):
        self.take_away(name)
        return Row(name + " killed and started", lost, self.bring_back(name), seen.format(name))

    def kill_simulator(self):
        snapshot = os.path.join(self.bench.folder, "state.snapshot")
        saved = rospy.ServiceProxy("save_snapshot", Snapshot)(file=snapshot)
        expect(saved.success, saved.message)
        marks = {name: self.bench.mark(name) for name in self.bench.programs}
        step, session = self.steps.newest().step, self.steps.newest().session
        self.take_away("sim_node")
        begin = time.monotonic()
        seconds = self.bring_back("sim_node")
        fresh = self.steps.wait(begin)[1]  # how far it has come since, the time to connect decides
        expect(fresh.session != session, "step {} follows step {}: it was not started anew".format(fresh.step, step))
        loaded = rospy.ServiceProxy("load_snapshot", Snapshot)(file=snapshot)
        expect(loaded.success, loaded.message)
        expect(wait_until(lambda: self.steps.newest().step >= step), "it does not continue from step {}".format(step))
        driven = self.steps.newest().joints[0]
        expect(abs(driven - 0.04) < 0.01, "the device does not drive it: insertion {:.4f} m".format(driven))
        for name in set(marks) - {"sim_node"}:
            for line in self.bench.said(name, marks[name]):
                print("{} said: {}".format(name, line))
        lost = "the session since its last snapshot"
        return [Row("sim_node killed and started", lost, seconds, "`scripts/run` ends with \"sim_node ended\"")]

    def kill_hardware(self):
        expect(self.steps.newest().buttons[0] == 1, "the hand holds no pedal")
        words = "apc_pedal"
        begin = self.bench.kill("hardware_node")
        told = self.events.wait(begin, lambda m: m.kind == ProcedureEvent.WARNING and words in m.text)
        expect(told is not None, "the simulator does not say that it released the pedal")
        expect(wait_until(lambda: self.steps.newest().buttons[0] == 0, 2), "the pedal is stuck")
        deepest = self.steps.newest().joints[0]
        expect(abs(deepest - 0.04) < 0.01, "the scope has left its place")
        self.check_others("hardware_node", begin)
        seconds = self.bring_back("hardware_node")
        expect(wait_until(lambda: self.steps.newest().buttons[0] == 1, 2), "the pedal does not act any more")
        return [Row("hardware_node killed and started", "pedal released after {:.2f} s, scope stayed".format(
            told[0] - begin), seconds, told[1].text)]

    def kill_vision(self):
        self.take_away("vision_node")
        begin = time.monotonic()
        seconds = self.bring_back("vision_node")
        first = self.frames.wait(begin, seconds=CAMERA_LIMIT)
        expect(first is not None, "no frame is tracked: {}".format(self.bench.said("vision_node")[-5:]))
        row = Row("vision_node killed and started", "instruments stay where they were", seconds,
                  "NO_FRAME on `suturing_device/tracking` until the camera is open again: frames after {:.1f} s".format(
                      first[0] - begin))
        return [row]

    def kill_recorder(self):
        begin = self.take_away("vibe_record")
        known = self.steps.since(0, begin)[-1][1]
        active = self.bag + ".active"
        size = os.path.getsize(active)
        copy = shutil.copy(active, os.path.join(self.bench.folder, "copy.bag"))
        again = subprocess.run(self.bench.commands["vibe_record"], env=self.bench.graph.env, capture_output=True,
                               text=True, timeout=PATIENCE, check=False)
        expect(again.returncode == 2 and "rosbag reindex" in again.stderr, "a second recorder says: " + again.stderr)
        expect(os.path.getsize(active) == size, "a second recorder has written over the first")
        self.bench.commands["vibe_record"][-2] = os.path.join(self.bench.folder, "second.bag")
        started = self.bench.start("vibe_record")
        second = os.path.join(self.bench.folder, "second.bag.active")
        expect(wait_until(lambda: os.path.exists(second) and os.path.getsize(second) > 50000), "it does not record")
        seconds = time.monotonic() - started
        expect(seconds < LIMIT, "the recorder took {:.2f} s to come back".format(seconds))
        subprocess.run(["rosbag", "reindex", "--quiet", copy], check=True, stdout=subprocess.DEVNULL)
        with rosbag.Bag(copy) as bag:
            kept = [m for _, m, _ in bag.read_messages(topics=["/applied_input"])]
        rate = size / (known.header.stamp - kept[0].header.stamp).to_sec()
        # of each start of the simulator by itself, to which the recorder takes a moment to connect
        gaps = [b.header.seq for a, b in zip(kept, kept[1:]) if b.session == a.session and b.header.seq != a.header.seq + 1]
        expect(not gaps, "steps are missing before {}".format(gaps))
        lost = (known.header.stamp - kept[-1].header.stamp).to_sec()
        most = CHUNK / rate
        expect(-0.5 < lost < most + 0.5, "{:.2f} s are lost, a chunk has {:.2f} s".format(lost, most))
        text = "{:.2f} s at the end of the first bag: at most a chunk of 768 kB, {:.2f} s at {:.2f} MB/s"
        return [Row("vibe_record killed and started", text.format(max(0, lost), most, rate / 1e6), seconds,
                    "FILE.active, which `rosbag reindex` reads: {} steps without a gap".format(len(kept)))]

    def is_driven(self):
        """Whether the device moves the scope: the rotation changes."""
        taken = self.steps.since(time.monotonic() - 0.3)
        return len(taken) > 5 and max(m.joints[1] for _, m in taken) - min(m.joints[1] for _, m in taken) > 1e-3

    def replug(self):
        expect(wait_until(self.is_driven), "the hand does not move the scope")
        mark, begin = self.bench.mark("hardware_node"), time.monotonic()
        before = self.steps.newest().joints[0]
        self.bench.send("vibe_emulator", signal.SIGUSR1)
        sentence = self.bench.says("hardware_node", "is gone", mark)
        expect(wait_until(lambda: self.steps.newest().buttons[0] == 0, 2), "the pedal is stuck")
        released = time.monotonic() - begin
        time.sleep(max(0.0, begin + OUTAGE - time.monotonic()))
        silent = not self.flows["hardware_node"].since(begin + SETTLED + 0.2)
        expect(silent and not self.is_driven(), "positions come without a device")
        expect(abs(self.steps.newest().joints[0] - before) < 1e-3, "the scope has left its place")
        self.check_others("vibe_emulator", begin)
        plugged = time.monotonic()
        self.bench.send("vibe_emulator", signal.SIGUSR1)
        first = self.flows["hardware_node"].wait(plugged)
        expect(first is not None and first[0] - plugged < LIMIT, "no positions after it was plugged in")
        expect(wait_until(self.is_driven), "the hand does not move the scope any more")
        self.check_others("vibe_emulator", begin)
        return [Row("devices unplugged and plugged in", "pedal released after {:.2f} s, scope stayed".format(released),
                    first[0] - plugged, sentence)]

    def kill_emulator(self):
        self.take_away("vibe_emulator")
        seconds = self.bring_back("vibe_emulator", waited=self.flows["hardware_node"])
        return [Row("vibe_emulator killed and started", "homing of the devices", seconds, "as unplugged")]

    def stall(self):
        begin, mark = time.monotonic(), self.bench.mark("vision_node")
        self.bench.send("vibe_fake_camera", signal.SIGSTOP)
        try:
            time.sleep(2.5)
            silent = not self.frames.since(begin + SETTLED)
            expect(silent, "frames come from a camera that stands still")
            self.check_others("vibe_fake_camera", begin)
        finally:
            back = time.monotonic()
            self.bench.send("vibe_fake_camera", signal.SIGCONT)
        first = self.frames.wait(back, seconds=CAMERA_LIMIT)
        expect(first is not None, "no frame after the camera went on: {}".format(self.bench.said("vision_node")[-5:]))
        said = [line for line in self.bench.said("vision_node", mark)]
        self.check_others("vibe_fake_camera", begin)
        return [Row("camera stands still for 2.5 s", "its frames; instruments stay where they were", first[0] - back,
                    "NO_FRAME on `suturing_device/tracking`; the node said: {}".format(" / ".join(said) or "nothing"))]
