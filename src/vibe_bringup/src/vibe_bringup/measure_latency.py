"""One measurement of latency: emulated devices or a simulated camera, simulator and rviz on a virtual display, while the
hand blinks; see docs/latency.md."""

import json
import os
import platform
import shutil
import subprocess
import tempfile
import time

import yaml
from vibe_sessions.whole_file import open_whole

from . import places
from .graph import Graph, GraphError
from .rviz_window import RvizWindow
from .session import carry_out

HAND = "package://vibe_hardware/config/hands/steady.yaml"
DEVICE_CLOCK_ERROR = 300  # so that the phase between device and host drifts through whole periods [ppm]
HID_JUMP = 0.03  # of the wheel, as far as the joint may move in a step of 10 ms [rad]
CAMERA_BASE = 1e-3  # of the helix in the scene blink [m]
CAMERA_JUMP = 1e-4  # of the helix: crosses its middle in one step [m]
SHORTEST, LONGEST, BEFORE = 0.25, 0.5, 17.0  # between blinks; time of the hand before the first one [s]
WARM_UP = 12.0  # of the graph, until the hand is at its place and the tissue has followed [s]
LAMP = {"Class": "vibe_rviz_plugins/LatencyLamp", "Enabled": True, "Name": "Lamp", "Value": True}


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        for row in text:
            if row.startswith("model name"):
                return row.split(":", 1)[1].strip()
    return platform.machine()


class Measurement:
    def __init__(self, arguments):
        self.arguments, self.output = arguments, arguments.output
        self.logs = os.path.join(self.output, "log")
        os.makedirs(self.logs)
        self.graph = Graph(self.logs)
        self.sockets = tempfile.mkdtemp(prefix="vibe-latency-")
        self.joint = "helix_advance" if arguments.camera else "tip_left_right"
        self.base = CAMERA_BASE if arguments.camera else 0.0
        self.jump = CAMERA_JUMP if arguments.camera else HID_JUMP
        source = "suturing_device" if arguments.camera else "scope"
        self.follow = "" if arguments.free else source + "/input/joint_states"
        self.begin = 0  # of what counts [ns]
        self.probe = None

    def path(self, name):
        return os.path.join(self.output, name)

    def title(self):
        arguments = self.arguments
        details = ", steps at {:g} Hz{}{}".format(
            arguments.rate, ", ~follow" if self.follow else "", ", the other core is busy" if arguments.load else ""
        )
        if arguments.mode == "steps":
            return "Deadlines" + details
        source = "camera" if arguments.camera else "HID device"
        if arguments.mode == "sway":
            return "From {} to published state{}, predicted by {:g} ms".format(source, details, arguments.lead)
        return "From {} to {}{}".format(source, "published state" if arguments.headless else "pixel", details)

    def write_setup(self):
        """What the report needs to know."""
        arguments = self.arguments
        source = "camera" if arguments.camera else "device"
        periods = {"step": 1 / arguments.rate, source: 1 / 147 if arguments.camera else 0.01}
        setup = {
            "title": self.title(),
            "mode": arguments.mode,
            "from": self.begin,
            "lead": 1e-3 * arguments.lead,
            "joint": self.joint,
            "base": self.base,
            "jump": self.jump,
            "rate": arguments.rate,
            "follow": self.follow,
            "screen": not arguments.headless,
            "load": arguments.load,
            "realtime_priority": arguments.realtime,
            "periods": periods,
            "particles": arguments.particles,
            "processor": processor(),
            "cores": os.cpu_count(),
        }
        with open_whole(self.path("setup.json")) as file:
            json.dump(setup, file, indent=1)

    def scene(self):
        """The scene with another step period, and perhaps another number of particles."""
        name = os.path.splitext(os.path.basename(self.arguments.scene))[0]
        scene = {"base": self.arguments.scene, "name": name, "step_period": "{:.9f} s".format(1 / self.arguments.rate)}
        if self.arguments.particles:
            scene["geometry"] = {"particles": self.arguments.particles}
        path = self.path("scene.yaml")
        with open_whole(path) as file:
            yaml.safe_dump(scene, file)
        return path

    def set_parameters(self):
        put, source = self.graph.set_parameter, "suturing_device" if self.arguments.camera else "scope"
        put("/use_sim_time", False)
        put("/sim_node/scene", self.scene())
        put("/sim_node/summary_file", self.path("summary.txt"))
        put("/sim_node/follow", self.follow)
        put("/sim_node/realtime_priority", self.arguments.realtime)
        put("/hardware_node/bus", self.sockets)
        put("/hardware_node/realtime_priority", max(0, self.arguments.realtime - 1))
        put("/latency_probe/folder", self.output)
        put("/latency_probe/joint", self.joint)
        put("/latency_probe/device", source + "/input/joint_states")
        put("/latency_probe/state", source + ("/measured_js" if self.arguments.camera else "/setpoint_js"))
        put("/latency_probe/screen", not self.arguments.headless)

    def start(self):
        graph = self.graph
        self.write_setup()
        graph.start_master()
        print("tables, numbers and figure: " + self.output, flush=True)
        print(graph.how_to_attach(), flush=True)
        self.set_parameters()
        graph.start_robot()
        predicted = ["suturing_device/input/joint_states:=suturing_device/predicted_js"]
        remapped = predicted if self.arguments.lead > 0 else []
        graph.start_node("vibe_sim", "sim_node", *remapped, patience=30.0)
        if not self.arguments.headless:
            self.start_rviz()
        else:
            self.start_probe({})
        if self.arguments.camera:
            self.start_camera()
        self.start_devices()
        if self.arguments.load:
            graph.start("stress-ng", ["stress-ng", "--cpu", "1", "--quiet"])

    def start_rviz(self):
        window = RvizWindow(self.graph, self.logs, self.rviz_config(), self.arguments.view)
        window.start([places.program("rviz", "rviz")])
        self.start_probe({"DISPLAY": window.display})
        self.wait_for(self.probe, "latency_probe: ready", "rviz shows no lamp")

    def rviz_config(self):
        """The configuration of sessions with the lamp."""
        with open(places.find(places.RVIZ_CONFIG), encoding="utf-8") as file:
            config = yaml.safe_load(file)
        topic = "suturing_device/measured_js" if self.arguments.camera else "scope/setpoint_js"
        lamp = dict(LAMP, Joint=self.joint, Threshold=self.base + 0.5 * self.jump, Topic=topic)
        config["Visualization Manager"]["Displays"].append(lamp)
        path = self.path("latency.rviz")
        with open_whole(path) as file:
            yaml.safe_dump(config, file)
        return path

    def start_probe(self, environment):
        settings = ["{}={}".format(name, value) for name, value in environment.items()]
        self.probe = self.graph.start("latency_probe", ["env", *settings, places.program("vibe_latency", "latency_probe")])

    def start_camera(self):
        # like a device, a camera has hardware of its own
        command = self.with_priority() + [places.program("vibe_vision", "vibe_fake_camera"), "--config", self.path("rig.yaml")]
        if self.arguments.mode == "sway":
            command += ["--scene", "sway", "--truth", self.path("truth.csv")]
        else:
            command += ["--scene", "blink", "--blink-after", str(BEFORE)] + self.blink_options()
        camera = self.graph.start("vibe_fake_camera", command)
        self.wait_for(camera, " serves ", "the simulated camera does not start")
        self.graph.set_parameter("/vision_node/config", self.path("rig.yaml"))
        self.graph.set_parameter("/vision_node/source", "gige:127.0.0.1")
        self.graph.set_parameter("/vision_node/publish_images", False)
        self.graph.set_parameter("/vision_node/realtime_priority", max(0, self.arguments.realtime - 1))
        self.graph.set_parameter("/vision_node/lead", 1e-3 * self.arguments.lead)
        self.graph.start_node("vibe_vision", "vision_node")

    def start_devices(self):
        arguments = self.arguments
        # a device has a processor of its own: in a measurement with priorities, the emulated one has the highest
        command = self.with_priority()
        command += [places.program("vibe_hardware", "vibe_emulator"), "--folder", self.sockets]
        command += ["--clock-error", str(DEVICE_CLOCK_ERROR)]
        blinks = arguments.mode == "blinks" and not arguments.camera
        command += ["--hand", "blink", HAND] + self.blink_options() if blinks else ["--hand", "script", HAND]
        emulator = self.graph.start("vibe_emulator", command)
        self.wait_for(emulator, "input", "the emulator offers no devices")
        remapped = ["suturing_device/input/joint_states:=buttons_js"] if arguments.camera else []
        self.graph.start_node("vibe_hardware", "hardware_node", *remapped)

    def blink_options(self):
        options = ["--blinks", str(self.arguments.blinks), "--seed", str(self.arguments.seed)]
        return options + ["--blink-jump", str(self.jump), "--blink-log", self.path("blinks.csv")]

    def with_priority(self):
        """What, before a command, gives it a real-time priority above that of the simulator, where that is permitted."""
        command = ["chrt", "-f", str(self.arguments.realtime + 1)]
        if self.arguments.realtime == 0:
            return []
        if subprocess.run(command + ["true"], check=False, capture_output=True).returncode == 0:
            return command
        print("real-time priority is not permitted here; see docs/latency.md", flush=True)
        return []

    def wait_for(self, process, words, problem, seconds=180.0):
        deadline = time.monotonic() + seconds
        while True:
            with open(process.log, encoding="utf-8", errors="replace") as text:
                if words in text.read():
                    return
            self.graph.check_alive()
            if time.monotonic() > deadline:
                raise GraphError("{} within {:.0f} s; see {}".format(problem, seconds, process.log))
            time.sleep(0.1)

    def blinked(self):
        if not os.path.exists(self.path("blinks.csv")):
            return 0
        with open(self.path("blinks.csv"), encoding="ascii") as file:
            return max(0, sum(1 for _ in file) - 1)

    def watch(self):
        if self.arguments.mode == "blinks":
            self.watch_blinks()
        else:
            self.watch_time()

    def watch_time(self):
        """For some minutes, with a line now and then."""
        begin = told = time.monotonic()
        end = begin + WARM_UP + 60 * self.arguments.minutes
        while time.monotonic() < end:
            self.graph.check_alive()
            if self.begin == 0 and time.monotonic() > begin + WARM_UP:
                self.begin = time.time_ns()
                self.write_setup()
            if time.monotonic() - told > 30:
                told = time.monotonic()
                print("{:.1f} of {:g} minutes".format((told - begin - WARM_UP) / 60, self.arguments.minutes), flush=True)
            time.sleep(0.2)

    def watch_blinks(self):
        """Until the last blink, with a line now and then."""
        count, patience = self.arguments.blinks, BEFORE + 60 + LONGEST * self.arguments.blinks
        begin = told = time.monotonic()
        while self.blinked() < count:
            self.graph.check_alive()
            if time.monotonic() - begin > patience:
                raise GraphError("only {} of {} blinks within {:.0f} s".format(self.blinked(), count, patience))
            if time.monotonic() - told > 10:
                told = time.monotonic()
                print("{} of {} blinks".format(self.blinked(), count), flush=True)
            time.sleep(0.2)
        time.sleep(1.5)

    def stop(self):
        self.graph.stop_all()
        shutil.rmtree(self.sockets, ignore_errors=True)


def measure(arguments):
    """Returns the exit status."""
    measurement = Measurement(arguments)
    report = [places.program("vibe_latency", "latency_report"), arguments.output]
    status = carry_out("latency", [measurement.start, measurement.watch], measurement.stop)
    return status or subprocess.run(report, check=False).returncode
