"""Who drives a session: the nodes they need, their parameters, and what a person is told first."""

import os
import shutil
import tempfile
import time

from . import places
from .graph import GraphError

PATIENCE = 20.0  # for the emulator to offer its devices [s]
TUTORIAL = "docs/tutorials/drive_by_hand.md"


class Driver:
    """Somebody who drives in wall time. The simulator publishes no /clock and waits for nobody."""

    simulated_time = False
    rviz_config = places.RVIZ_CONFIG
    needs_rviz = needs_page = False
    nodes = ()  # names of those that drive, but for the trainee
    first_words = ""

    def __init__(self, arguments):
        self.arguments = arguments
        self.senders = []  # nodes that would go on sending after the simulator has ended

    def set_parameters(self, put):
        """Before any node starts: each reads its parameters once."""

    def start(self, graph):
        """Starts the nodes that drive."""

    def stop(self):
        """Ends the nodes that go on sending, so that the recorder comes to rest. Returns those that had to be forced."""
        stopped = [(process.name, process.stop()) for process in reversed(self.senders)]
        return [name for name, in_time in stopped if not in_time]

    def is_done(self):
        """Whether who drives has done everything there was to do. Raises GraphError when it failed."""
        return False

    def clean_up(self):
        """After all nodes have ended."""


class Trainee(Driver):
    """A protocol or a script, in simulated time and in lock-step, so that the session repeats to the bit."""

    simulated_time = True

    def __init__(self, arguments):
        super().__init__(arguments)
        self.node = None

    def set_parameters(self, put):
        put("/vibe_trainee/script", self.arguments.script)
        put("/vibe_trainee/lockstep", True)
        put("/vibe_trainee/exit_when_done", True)

    def start(self, graph):
        self.node = graph.start_node("vibe_sim", "vibe_trainee", visible=True)

    def is_done(self):
        return self.node.status() == 0


class Device(Driver):
    """The haptic device and the input device through /dev/hidraw. What the node says is for the person who drives."""

    nodes = ("hardware_node",)
    first_words = (
        "Driving with the devices. First hold the scope at its homing position and press the homing button; then press\n"
        "insufflate, wait for the pressure, and insert the scope. More: docs/hardware.md"
    )

    def set_parameters(self, put):
        if self.arguments.config:
            put("/hardware_node/config", self.arguments.config)

    def start(self, graph):
        # the simulator obeys one node only: the camera's, also while an instrument is lost
        remapped = ["suturing_device/input/joint_states:=suturing_device/buttons_js"] if self.arguments.camera else []
        self.senders = [graph.start_node("vibe_hardware", "hardware_node", *remapped, visible=True)]


class Emulator(Device):
    """The firmware of the devices with an emulated hand, behind local sockets."""

    first_words = "Driving with emulated devices; the emulated hand moves by itself. Ctrl-C ends the session."

    def __init__(self, arguments):
        super().__init__(arguments)
        # a path of a socket has 107 characters at most, so it cannot be in the folder of the session
        self.sockets = tempfile.mkdtemp(prefix="vibe-emulator-")

    def set_parameters(self, put):
        super().set_parameters(put)
        put("/hardware_node/bus", self.sockets)

    def start(self, graph):
        options = ["--folder", self.sockets, "--hand", *self.arguments.hand.split(":", 1)]
        options += ["--config", self.arguments.config] if self.arguments.config else []
        self.wait_for_devices(graph.start_node("vibe_hardware", "vibe_emulator", *options))
        super().start(graph)

    def wait_for_devices(self, emulator):
        """So that the node does not report devices as missing that are about to appear."""
        deadline = time.monotonic() + PATIENCE
        while len(os.listdir(self.sockets)) < 2:
            if emulator.status() is not None or time.monotonic() > deadline:
                raise GraphError("vibe_emulator offers no devices; what it said:\n" + emulator.last_words())
            time.sleep(0.05)

    def clean_up(self):
        shutil.rmtree(self.sockets, ignore_errors=True)


class Gamepad(Driver):
    """A gamepad. The node says by itself what it looks for and what to press first."""

    nodes = ("gamepad_node",)
    first_words = "Driving with a gamepad; its controls: " + TUTORIAL

    def set_parameters(self, put):
        put("/gamepad_node/mapping", self.arguments.mapping)
        put("/gamepad_node/pad", self.arguments.pad or "")
        put("/gamepad_node/replay", self.arguments.replay_pad or "")
        put("/gamepad_node/record", os.path.join(self.arguments.output, "pad.evemu"))

    def start(self, graph):
        self.senders = [graph.start_node("vibe_hardware", "gamepad_node", visible=True)]


class Keyboard(Driver):
    """The tool 'Drive scope' of rviz, which is active from the start."""

    rviz_config = "package://vibe_description/rviz/drive.rviz"
    needs_rviz = True
    first_words = (
        "Driving with keys and mouse: click into the view of rviz. The view shows the keys and the next step;\n"
        "H hides and shows them. More: " + TUTORIAL
    )


class Web(Driver):
    """Whoever takes control in a page, which the session serves."""

    needs_page = True
    first_words = "Driving from a browser: open the address, and press 'Take control'. More: docs/web.md"


DRIVERS = {"trainee": Trainee, "device": Device, "emulator": Emulator, "gamepad": Gamepad, "keyboard": Keyboard, "web": Web}
