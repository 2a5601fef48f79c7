"""Pictures of a session: the graph of scripts/run with rviz on a virtual display, taken while simulated time stands.

scripts/picture has checked the arguments, built the workspace and sourced its environment. The simulator begins paused
and is taken from picture to picture by its service `step`, so that a picture shows the same state on every machine.
"""

import argparse
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

from graph import GraphError
from run_session import Interrupted, Session, attempt, interrupt

SCREEN = "1280x720"
SCENE = "[1200x600+40+70]"  # the part of it where rviz draws: the frame rate below changes all the time
PATIENCE = 180.0  # for a program to be ready or for rviz to draw, software rendering on a busy machine [s]
EQUAL_SHOTS = 3  # so many in a row without a difference: rviz has drawn the last message
SHOT_INTERVAL = 1.0  # [s]
FEWEST_COLOURS = 5000  # the scene is black before the first frame, has few without the organ, some 30,000 with it


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    for name in ("--workspace", "--scene", "--script", "--output"):
        parser.add_argument(name, required=True)
    parser.add_argument("pictures", nargs="+")
    arguments = parser.parse_args()
    arguments.mesh, arguments.fast, arguments.duration, arguments.headless = "", True, 0.0, False
    pictures = [(text.split("=")[0], float(text.split("=")[1])) for text in arguments.pictures]
    arguments.pictures = sorted(pictures, key=lambda picture: picture[1])
    arguments.pictures_folder = arguments.output
    return arguments


def wait_for(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise GraphError("{} within {:.0f} s".format(what, PATIENCE))
        time.sleep(0.2)


class PictureSession(Session):
    """A session that stands still whenever nobody steps it, with rviz on a display of its own."""

    def __init__(self, arguments):
        super().__init__(arguments)
        self.steps_done = 0
        self.rviz = None

    def set_parameters(self):
        super().set_parameters()
        self.graph.set_parameter("/sim_node/start_paused", True)
        self.graph.set_parameter("/sim_node/await_recorder", False)

    def start(self):
        graph = self.graph
        self.start_display()
        graph.start_master()
        self.set_parameters()
        graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
        config = os.path.join(self.arguments.workspace, "src/vibe_description/rviz/vibe.rviz")
        # the splash screen would be in the way of the first picture
        self.rviz = graph.start("rviz", ["rosrun", "rviz", "rviz", "--splash-screen", "", "-d", config])
        graph.start("vibe_trainee", ["rosrun", "vibe_sim", "vibe_trainee"])
        self.sim = graph.start("sim_node", ["rosrun", "vibe_sim", "sim_node"], patience=30.0)
        wait_for(self.is_watched, "rviz did not listen to the tissue (see {})".format(self.rviz.log))

    def start_display(self):
        """The X server chooses a free display and writes its number into a pipe."""
        folder = os.path.join(self.output, "runtime")
        os.mkdir(folder, 0o700)
        self.graph.env.update(LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", XDG_RUNTIME_DIR=folder)
        number = os.path.join(self.output, "display")
        command = 'exec Xvfb -displayfd 7 -screen 0 "$1"x24 -nolisten tcp 7>"$2"'
        open(number, "wb").close()
        self.graph.start("xvfb", ["sh", "-c", command, "sh", SCREEN, number])
        wait_for(lambda: self.check_alive() and os.path.getsize(number) > 1, "Xvfb named no display")
        with open(number, encoding="ascii") as text:
            self.graph.env["DISPLAY"] = ":" + text.read().strip()

    def check_alive(self):
        dead = self.graph.dead()
        if dead is not None:
            raise GraphError("{} died; the last it said:\n{}".format(dead.name, dead.last_words()))
        return True

    def is_watched(self):
        self.check_alive()
        publishers, subscribers, services = self.graph.master.getSystemState("/vibe_scripts")[2]
        watchers = [node for topic, nodes in subscribers if topic == "/tissue/particles" for node in nodes]
        offered = [name for name, _ in services]
        return "/step" in offered and any(node.startswith("/rviz") for node in watchers)

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

    def colours_and_signature(self, file):
        self.check_alive()
        self.ask(["import", "-window", "root", file])
        colours, signature = self.ask(["identify", "-format", "%k %#", file + SCENE]).split()
        return int(colours), signature

    def shoot(self, name):
        """Saves the picture once rviz draws the organ and nothing moves any more."""
        file = os.path.join(self.output, "shot.png")
        seen = []
        deadline = time.monotonic() + PATIENCE
        while not (len(seen) >= EQUAL_SHOTS and len(set(seen[-EQUAL_SHOTS:])) == 1):
            if time.monotonic() > deadline:
                raise GraphError("rviz drew no steady scene within {:.0f} s; see {}".format(PATIENCE, self.rviz.log))
            time.sleep(SHOT_INTERVAL)
            colours, signature = self.colours_and_signature(file)
            seen = seen + [signature] if colours >= FEWEST_COLOURS else []
        target = os.path.join(self.arguments.pictures_folder, name + ".png")
        self.ask(["convert", file, "-strip", "-define", "png:compression-level=9", target])
        print("{} ({:.0f} kB)".format(target, os.path.getsize(target) / 1e3), flush=True)

    def take(self):
        period = self.step_period()
        for name, seconds in self.arguments.pictures:
            self.step_to(seconds, period)
            self.shoot(name)


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
