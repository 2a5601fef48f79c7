"""Pictures of a session: the graph of scripts/run with rviz on a virtual display, taken while simulated time stands.

scripts/picture has checked the arguments, built the workspace and sourced its environment. The simulator begins paused
and is taken from picture to picture by its service `step`, so that a picture shows the same state on every machine.
"""

import argparse
import collections
import os
import re
import signal
import subprocess
import sys
import tempfile

from graph import GraphError
from run_session import Interrupted, Session, attempt, interrupt, session_defaults
from rviz_window import FEWEST_COLOURS, RvizWindow, wait_for

Picture = collections.namedtuple("Picture", "name seconds view")


def picture_of(text):
    """From NAME=SECONDS[@VIEW]."""
    name, _, rest = text.partition("=")
    seconds, _, view = rest.partition("@")
    return Picture(name, float(seconds), view)


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    for name in ("--workspace", "--scene", "--script", "--config", "--output"):
        parser.add_argument(name, required=True)
    parser.add_argument("--view", default="")
    parser.add_argument("--program", default="rosrun rviz rviz")
    parser.add_argument("--colours", type=int, default=FEWEST_COLOURS)
    parser.add_argument("pictures", nargs="+", type=picture_of)
    arguments = parser.parse_args(namespace=session_defaults(fast=True))
    pictures = [picture._replace(view=picture.view or arguments.view) for picture in arguments.pictures]
    arguments.pictures = sorted(pictures, key=lambda picture: picture.seconds)
    arguments.pictures_folder = arguments.output
    return arguments


class PictureSession(Session):
    """A session that stands still whenever nobody steps it, with one rviz for each view that is asked for."""

    def __init__(self, arguments):
        super().__init__(arguments)
        self.steps_done = 0
        views = sorted({picture.view for picture in arguments.pictures})
        self.windows = {}
        for view in views:
            self.windows[view] = RvizWindow(self.graph, self.output, arguments.config, view, arguments.colours)

    def set_parameters(self):
        super().set_parameters()
        self.graph.set_parameter("/sim_node/start_paused", True)
        self.graph.set_parameter("/sim_node/await_recorder", False)

    def start(self):
        graph = self.graph
        graph.start_master()
        self.set_parameters()
        graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
        for window in self.windows.values():
            window.start(self.arguments.program.split())
        graph.start("vibe_trainee", ["rosrun", "vibe_sim", "vibe_trainee"])
        self.sim = graph.start("sim_node", ["rosrun", "vibe_sim", "sim_node"], patience=30.0)
        logs = " and ".join(window.process.log for window in self.windows.values())
        wait_for(self.is_watched, "rviz did not listen to the tissue (see {})".format(logs))

    def is_watched(self):
        next(iter(self.windows.values())).check_alive()
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

    def take(self):
        period = self.step_period()
        for picture in self.arguments.pictures:
            self.step_to(picture.seconds, period)
            self.windows[picture.view].shoot(os.path.join(self.arguments.pictures_folder, picture.name + ".png"))


def main():
    arguments = parse_arguments()
    failures = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    with tempfile.TemporaryDirectory(prefix="vibe-picture-") as arguments.output:
        session = PictureSession(arguments)
        try:
            attempt(session.start, failures)
            if not failures:
                attempt(session.take, failures)
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_IGN)
        except Interrupted as reason:
            failures.append("stopped by {}".format(reason))
        attempt(session.stop, failures)
    for failure in failures:
        print("picture: " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
