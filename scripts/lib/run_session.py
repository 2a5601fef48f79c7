"""One session: master, robot_state_publisher, simulator, who drives it, recorder and, with a display, rviz.

scripts/run has checked the arguments, built the workspace and sourced its environment. The simulator ends by itself
after the duration, if there is one, and decides how the session ended. A person ends a session by closing rviz, too.
"""

import argparse
import glob
import os
import signal
import sys
import time

from drivers import DRIVERS
from graph import Graph, GraphError
from vision import Vision

SETTLE = 1.0  # for the recorder to receive what the simulator sent last [s]
RECORDER_PATIENCE = 600.0  # for the recorder to write what it holds in memory [s]


class Interrupted(Exception):
    """Somebody wants the session to end."""


def interrupt(number, _frame):
    # a second Ctrl-C must not break off the orderly end that the first one began
    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted(signal.Signals(number).name)


def session_parser():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("--workspace", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--drive", choices=DRIVERS, default="trainee")
    parser.add_argument("--script", default="")
    parser.add_argument("--config", default="")
    parser.add_argument("--hand", default="")
    parser.add_argument("--pad", default="")
    parser.add_argument("--mapping", default="")
    parser.add_argument("--replay-pad", default="")
    parser.add_argument("--camera", default="", help="that watches the instruments; empty: none")
    parser.add_argument("--vision-config", default="")
    parser.add_argument("--mesh", default="")
    parser.add_argument("--output", required=True)
    parser.add_argument("--duration", type=float, required=True, help="0: no end")
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--record-all", action="store_true", help="every message of every topic")
    parser.add_argument("--headless", action="store_true")
    parser.add_argument("--master", action="store_true", help="use the master of ROS_MASTER_URI")
    return parser


def session_defaults(**values):
    """All arguments of a session with their defaults, for programs that begin one with arguments of their own."""
    required = ["--workspace", "", "--scene", "", "--output", "", "--duration", "0"]
    return argparse.Namespace(**{**vars(session_parser().parse_args(required)), **values})


class Session:
    def __init__(self, arguments):
        self.arguments = arguments
        self.output = arguments.output
        self.summary = os.path.join(self.output, "summary.txt")
        self.bag = os.path.join(self.output, "session.bag")
        self.logs = os.path.join(self.output, "log")
        os.makedirs(self.logs, exist_ok=True)
        self.graph = Graph(self.logs, own_master=not arguments.master)
        self.driver = DRIVERS[arguments.drive](arguments)
        self.vision = Vision(arguments) if arguments.camera else None
        self.sim = self.recorder = self.rviz = None

    def start(self):
        graph = self.graph
        graph.start_master()
        print(graph.how_to_attach(), flush=True)
        self.set_parameters()
        graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
        self.sim = graph.start("sim_node", ["rosrun", "vibe_sim", "sim_node"], visible=True, patience=30.0)
        if self.driver.first_words:
            print(self.driver.first_words, flush=True)
        self.driver.start(graph)
        if self.vision:
            self.vision.start(graph, self.driver)
        # the simulator begins when somebody listens to applied_input: by then every other topic must be connected
        whole = ["--all"] if self.arguments.record_all else []
        record = ["rosrun", "vibe_sim", "vibe_record", *whole, "--last", "applied_input", self.bag]
        self.recorder = graph.start("vibe_record", record, patience=RECORDER_PATIENCE)
        if not self.arguments.headless:
            config = os.path.join(self.arguments.workspace, self.driver.rviz_config)
            self.rviz = graph.start("rviz", ["rosrun", "rviz", "rviz", "-d", config], essential=False)

    def set_parameters(self):
        arguments, put = self.arguments, self.graph.set_parameter
        simulated = self.driver.simulated_time
        put("/use_sim_time", simulated)  # before any node starts: each reads it once
        with open(os.path.join(arguments.workspace, "src/vibe_description/urdf/scope.urdf"), encoding="utf-8") as urdf:
            put("/robot_description", urdf.read())
        put("/robot_state_publisher/publish_frequency", 200.0)  # else every second step of the simulator has no tf
        put("/sim_node/scene", arguments.scene)
        if arguments.mesh:
            put("/sim_node/mesh", arguments.mesh)
        put("/sim_node/time_source", "sim" if simulated else "wall")
        put("/sim_node/fast", arguments.fast)
        put("/sim_node/lockstep", simulated)
        put("/sim_node/await_recorder", True)
        put("/sim_node/duration", arguments.duration)
        put("/sim_node/summary_file", self.summary)
        self.driver.set_parameters(put)

    def watch(self):
        """Until the simulator or who drives it has ended, or a person has closed rviz. Raises GraphError when anything
        else dies."""
        while self.sim.status() is None:
            if self.driver.is_done():
                return
            dead = self.graph.dead()
            if dead is not None and dead is not self.sim:
                raise GraphError(
                    "{} died with status {}; the last it said (all of it: {}):\n{}".format(
                        dead.name, dead.status(), dead.log, dead.last_words()
                    )
                )
            if self.is_closed():
                print("rviz was closed: the session ends.", flush=True)
                return
            time.sleep(0.1)
        if self.sim.status() != 0:
            raise GraphError("sim_node ended with status {}; what it said is above".format(self.sim.status()))
        if not os.path.exists(self.summary):
            raise GraphError("sim_node ended without writing {}".format(self.summary))

    def is_closed(self):
        """Whether the person who drives has closed rviz. Raises GraphError when it died and somebody drives with it."""
        if self.rviz is None or self.driver.simulated_time or self.rviz.status() is None:
            return False
        if self.rviz.status() != 0 and self.driver.needs_rviz:
            raise GraphError(
                "rviz died with status {}; the last it said (all of it: {}):\n{}".format(
                    self.rviz.status(), self.rviz.log, self.rviz.last_words()
                )
            )
        return self.rviz.status() == 0

    def stop(self):
        """Ends everything in reverse order, the simulator before the recorder so that its last words are kept."""
        forced = []
        if self.sim is not None:
            self.sim.stop()
            forced = self.driver.stop()
            time.sleep(SETTLE)
        forced += self.graph.stop_all()
        self.driver.clean_up()
        if forced:
            raise GraphError("{} did not stop when asked and was killed; see {}".format(", ".join(forced), self.logs))
        if self.recorder is not None and (not os.path.exists(self.bag) or glob.glob(self.bag + "*.active")):
            raise GraphError("the recording {} is not complete; see {}".format(self.bag, self.recorder.log))

    def report(self):
        """Where the session lies; the simulator has printed the summary itself."""
        if os.path.exists(self.bag):
            print("recorded: {} ({:.1f} MB)".format(self.bag, os.path.getsize(self.bag) / 1e6), flush=True)


def attempt(action, failures):
    """Runs a part of the session; keeps what went wrong, for what comes after must happen all the same."""
    try:
        action()
    except GraphError as error:
        failures.append(str(error))
    except (OSError, ValueError) as error:
        failures.append("{}: {}".format(type(error).__name__, error))


def main():
    session = Session(session_parser().parse_args())
    failures = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    try:
        attempt(session.start, failures)
        if not failures:
            attempt(session.watch, failures)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)
    except Interrupted as reason:
        print("\nStopping after {}...".format(reason), flush=True)
    attempt(session.stop, failures)
    session.report()
    for failure in failures:
        print("run: " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
