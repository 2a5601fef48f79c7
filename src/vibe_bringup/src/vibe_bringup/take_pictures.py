"""Pictures of a session: its graph with rviz on a virtual display, taken while simulated time stands.

The simulator begins paused and is taken from picture to picture by its service `step`, so that a picture shows the same
state on every machine.
"""

import os
import re
import subprocess
import tempfile

from .graph import GraphError
from .run import defaults
from .rviz_window import RvizWindow, wait_for
from .session import Session, carry_out


class PictureSession(Session):
    """A session that stands still whenever nobody steps it, with one rviz for each view that is asked for."""

    def __init__(self, arguments, pictures=(), config="", program="", colours=0):
        super().__init__(arguments)
        self.steps_done = 0
        self.wanted, self.program = pictures, program.split()
        views = sorted({picture.view for picture in pictures})
        self.windows = {view: RvizWindow(self.graph, self.output, config, view, colours) for view in views}

    def set_parameters(self):
        super().set_parameters()
        self.graph.set_parameter("/sim_node/start_paused", True)
        self.graph.set_parameter("/sim_node/await_recorder", False)

    def start(self):
        graph = self.graph
        graph.start_master()
        self.set_parameters()
        graph.start_robot()
        for window in self.windows.values():
            window.start(self.program)
        graph.start_node("vibe_sim", "vibe_trainee")
        self.sim = graph.start_node("vibe_sim", "sim_node", patience=30.0)
        logs = " and ".join(window.process.log for window in self.windows.values())
        wait_for(self.is_watched, "rviz did not listen to the tissue (see {})".format(logs))

    def is_watched(self):
        self.graph.check_alive()
        _, subscribers, services = self.graph.master.getSystemState("/vibe_scripts")[2]
        watchers = {node for topic, nodes in subscribers if topic == "/tissue/particles" for node in nodes}
        offered = [name for name, _ in services]
        return "/step" in offered and sum(node.startswith("/rviz") for node in watchers) >= len(self.windows)

    def ask(self, command):
        """What a program of the graph's environment says."""
        answer = subprocess.run(command, env=self.graph.env, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        if answer.returncode != 0:
            words = answer.stderr.decode(errors="replace").strip() or "status {}".format(answer.returncode)
            raise GraphError("{} failed: {}".format(command[0], words))
        return answer.stdout.decode(errors="replace")

    def step_period(self):
        text = self.ask(["rostopic", "echo", "-n", "1", "/procedure/state/step_period"])  # latched
        return float(text.split()[0])

    def step_to(self, seconds, period):
        steps = round(seconds / period) - self.steps_done
        if steps > 0:
            said = self.ask(["rosservice", "call", "/step", "n: {}".format(steps)])
            if not re.search(r"success: True", said):
                raise GraphError("the simulator took no steps: " + " ".join(said.split()))
            self.steps_done += steps

    def take(self, folder):
        period = self.step_period()
        for picture in self.wanted:
            self.step_to(picture.seconds, period)
            self.windows[picture.view].shoot(os.path.join(folder, picture.name + ".png"))


def take_all(arguments):
    """Returns the exit status."""
    os.makedirs(arguments.output, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="vibe-picture-") as folder:
        session = PictureSession(
            defaults(scene=arguments.scene, script=arguments.script, fast=True, output=folder),
            arguments.pictures, arguments.config, arguments.program, arguments.colours,
        )  # fmt: skip
        return carry_out("picture", [session.start, lambda: session.take(arguments.output)], session.stop)
