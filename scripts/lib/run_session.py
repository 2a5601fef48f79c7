"""One session: master, robot_state_publisher, simulator, scripted trainee, recorder and, with a display, rviz.

scripts/run has checked the arguments, built the workspace and sourced its environment. The simulator ends by itself
after the duration and decides how the session ended.
"""

import argparse
import glob
import os
import signal
import sys
import time

from graph import Graph, GraphError

SETTLE = 1.0  # for the recorder to receive what the simulator sent last [s]
RECORDER_PATIENCE = 600.0  # for the recorder to write what it holds in memory [s]


class Interrupted(Exception):
    """Somebody wants the session to end."""


def interrupt(number, _frame):
    # a second Ctrl-C must not break off the orderly end that the first one began
    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted(signal.Signals(number).name)


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("--workspace", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--script", required=True)
    parser.add_argument("--mesh", default="")
    parser.add_argument("--output", required=True)
    parser.add_argument("--duration", type=float, required=True)
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--headless", action="store_true")
    return parser.parse_args()


class Session:
    def __init__(self, arguments):
        self.arguments = arguments
        self.output = arguments.output
        self.summary = os.path.join(self.output, "summary.txt")
        self.bag = os.path.join(self.output, "session.bag")
        self.logs = os.path.join(self.output, "log")
        os.makedirs(self.logs, exist_ok=True)
        self.graph = Graph(self.logs)
        self.sim = self.recorder = None

    def start(self):
        graph = self.graph
        graph.start_master()
        self.set_parameters()
        graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
        self.sim = graph.start("sim_node", ["rosrun", "vibe_sim", "sim_node"], visible=True, patience=30.0)
        graph.start("vibe_trainee", ["rosrun", "vibe_sim", "vibe_trainee"])
        # the simulator begins when somebody listens to applied_input: by then every other topic must be connected
        record = ["rosrun", "vibe_sim", "vibe_record", "--last", "applied_input", self.bag]
        self.recorder = graph.start("vibe_record", record, patience=RECORDER_PATIENCE)
        if not self.arguments.headless:
            config = os.path.join(self.arguments.workspace, "src/vibe_description/rviz/vibe.rviz")
            graph.start("rviz", ["rosrun", "rviz", "rviz", "-d", config], essential=False)

    def set_parameters(self):
        arguments, put = self.arguments, self.graph.set_parameter
        put("/use_sim_time", True)  # before any node starts: each reads it once
        with open(os.path.join(arguments.workspace, "src/vibe_description/urdf/scope.urdf"), encoding="utf-8") as urdf:
            put("/robot_description", urdf.read())
        put("/robot_state_publisher/publish_frequency", 200.0)  # else every second step of the simulator has no tf
        put("/vibe_trainee/script", arguments.script)
        put("/vibe_trainee/lockstep", True)
        put("/sim_node/scene", arguments.scene)
        if arguments.mesh:
            put("/sim_node/mesh", arguments.mesh)
        put("/sim_node/time_source", "sim")
        put("/sim_node/fast", arguments.fast)
        put("/sim_node/lockstep", True)
        put("/sim_node/await_recorder", True)
        put("/sim_node/duration", arguments.duration)
        put("/sim_node/summary_file", self.summary)

    def watch(self):
        """Until the simulator has ended. Raises GraphError when anything else dies before it does."""
        while self.sim.status() is None:
            dead = self.graph.dead()
            if dead is not None and dead is not self.sim:
                raise GraphError(
                    "{} died with status {}; the last it said (all of it: {}):\n{}".format(
                        dead.name, dead.status(), dead.log, dead.last_words()
                    )
                )
            time.sleep(0.1)
        if self.sim.status() != 0:
            raise GraphError("sim_node ended with status {}; what it said is above".format(self.sim.status()))
        if not os.path.exists(self.summary):
            raise GraphError("sim_node ended without writing {}".format(self.summary))

    def stop(self):
        """Ends everything in reverse order, the simulator before the recorder so that its last words are kept."""
        if self.sim is not None:
            self.sim.stop()
            time.sleep(SETTLE)
        forced = self.graph.stop_all()
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
    session = Session(parse_arguments())
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
