"""One session: master, robot_state_publisher, simulator, who drives it, recorder and, with a display, rviz.

The simulator ends by itself after the duration, if there is one, and decides how the session ended. A person ends a
session by closing rviz, too. What shows the session, rviz or a page, goes on to show how it ended.
"""

import contextlib
import glob
import os
import signal
import sys
import time

import yaml
from vibe_sessions.whole_file import open_whole

from . import places
from .drivers import DRIVERS
from .graph import Graph, GraphError
from .run import PAGE_OPTIONS
from .vision import Vision

PORT = 8890  # of the page, by default
SETTLE = 1.0  # for the recorder to receive what the simulator sent last [s]
# For the trainee to answer [s]: on a machine that is much too busy it plans for longer than the simulator would wait by
# itself, and a simulator that has paused waits for good. Whether it is alive is watched here.
DRIVER_PATIENCE = 600.0
RECORDER_PATIENCE = 600.0  # for the recorder to write what it holds in memory [s]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)  # that end a program


def stepping_threads():
    """Of the simulator: two where as many cores are left for the next factor and for whatever else a session runs. The
    results are the same."""
    return 2 if len(os.sched_getaffinity(0)) >= 4 else 1


class Interrupted(Exception):
    """Somebody wants the session to end."""


def interrupt(number, _frame):
    # a second Ctrl-C must not break off the orderly end that the first one began
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted(signal.Signals(number).name)


class Session:
    def __init__(self, arguments):
        self.arguments = arguments
        self.output = arguments.output = places.claim_session(arguments.output, arguments.free_name)
        self.summary = os.path.join(self.output, "summary.txt")
        self.bag = os.path.join(self.output, "session.bag")
        self.logs = os.path.join(self.output, "log")
        self.graph = Graph(self.logs, own_master=not arguments.master)
        self.driver = DRIVERS[arguments.drive](arguments)
        self.vision = Vision(arguments) if arguments.camera else None
        self.sim = self.recorder = self.rviz = self.page = None
        self.finished, self.forced = False, []  # programs that had to be killed
        self.deaths = {}  # of what only shows the session: name -> sentence

    def describe(self):
        """What people say of the session, for its report, where they can change it afterwards."""
        about = {key: getattr(self.arguments, key) for key in ("person", "notes") if getattr(self.arguments, key)}
        if about:
            with open_whole(os.path.join(self.output, "session.about.yaml")) as file:
                yaml.safe_dump(about, file, allow_unicode=True)

    def start(self):
        self.describe()
        graph = self.graph
        graph.start_master()
        print(graph.how_to_attach(), flush=True)
        self.set_parameters()
        graph.start_robot()
        self.sim = graph.start_node("vibe_sim", "sim_node", visible=True, patience=30.0)
        if self.driver.first_words:
            print(self.driver.first_words, flush=True)
        self.driver.start(graph)
        if self.vision:
            self.vision.start(graph, self.driver)
        # the simulator begins when somebody listens to applied_input: by then every other topic must be connected
        whole = ["--all"] if self.arguments.record_all else []
        record = [*whole, "--last", "applied_input", self.bag]
        self.recorder = graph.start_node("vibe_sim", "vibe_record", *record, patience=RECORDER_PATIENCE)
        if not self.arguments.headless:
            config = places.find(self.driver.rviz_config)
            self.rviz = graph.start_rviz(config)
        if self.arguments.web:
            self.page = graph.start_page(self.arguments.port or PORT, essential=self.driver.needs_page)

    def set_parameters(self):
        arguments, put = self.arguments, self.graph.set_parameter
        simulated = self.driver.simulated_time
        put("/use_sim_time", simulated)  # before any node starts: each reads it once
        put("/sim_node/scene", arguments.scene)
        if arguments.mesh:
            put("/sim_node/mesh", arguments.mesh)
        put("/sim_node/time_source", "sim" if simulated else "wall")
        put("/sim_node/fast", arguments.fast)
        put("/sim_node/lockstep", simulated)
        if simulated:
            put("/sim_node/lockstep_timeout", DRIVER_PATIENCE)
        put("/sim_node/threads", stepping_threads())
        put("/sim_node/await_recorder", True)
        put("/sim_node/duration", arguments.duration)
        put("/sim_node/summary_file", self.summary)
        for name in PAGE_OPTIONS:
            if getattr(arguments, name) is not None:
                put("/web_node/" + name, getattr(arguments, name))
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
        """Whether the person who drives has closed rviz."""
        self.note_death(self.rviz, self.driver.needs_rviz)
        # a page that ends by itself could not begin: its port is taken, or its certificate cannot be used
        self.note_death(self.page, self.page is not None and (self.page.status() or 0) > 0)
        closed = self.rviz is not None and self.rviz.status() == 0
        return closed and not self.driver.simulated_time and self.page is None

    def note_death(self, viewer, needed):
        """Of what shows the session, which goes on without it. Raises GraphError when it is needed."""
        if viewer is None or not viewer.status() or viewer.name in self.deaths:
            return
        death = "{} died with status {}".format(viewer.name, viewer.status())
        words = "{}; the last it said (all of it: {}):\n{}".format(death, viewer.log, viewer.last_words())
        if needed:
            raise GraphError(words)
        self.deaths[viewer.name] = words
        with open(viewer.log, "a", encoding="utf-8") as log:  # not whole: a log
            print(death, file=log)  # for scripts/doctor
        print("{} died; the session goes on without it.".format(viewer.name), flush=True)

    def finish(self):
        """Ends what computes and records, the simulator before the recorder so that its last words are kept, and says
        where the session lies; the simulator has printed the summary itself."""
        if self.sim is None or self.finished:
            return
        self.finished = True
        self.sim.stop()
        self.forced += self.driver.stop()
        time.sleep(SETTLE)
        if self.recorder is None:
            return
        if not self.recorder.stop():
            self.forced.append(self.recorder.name)
        if os.path.exists(self.bag):
            print("recorded: {} ({:.1f} MB)".format(self.bag, os.path.getsize(self.bag) / 1e6), flush=True)

    def show(self):
        """How the session ended, until a person has seen it."""

        def running():
            shown = {"rviz": self.rviz, "the page": self.page}
            return [name for name, process in shown.items() if process is not None and process.status() is None]

        if running():
            end = "Ctrl-C" if self.page else "it is closed, or Ctrl-C"
            print("The session has ended. It is still shown by {}, until {}.".format(" and ".join(running()), end), flush=True)
        while running():
            time.sleep(0.1)

    def stop(self):
        """Ends everything in reverse order."""
        self.finish()
        self.forced += self.graph.stop_all()
        self.driver.clean_up()
        troubles = list(self.deaths.values())
        if self.forced:
            troubles.append("{} did not stop when asked and was killed; see {}".format(", ".join(self.forced), self.logs))
        if self.recorder is not None and (not os.path.exists(self.bag) or glob.glob(self.bag + "*.active")):
            troubles.append("the recording {} is not complete; see {}".format(self.bag, self.recorder.log))
        if troubles:
            raise GraphError("\n".join(troubles))


def attempt(action, failures):
    """Runs a part of the session; keeps what went wrong, for what comes after must happen all the same."""
    try:
        action()
    except GraphError as error:
        failures.append(str(error))
    except (OSError, ValueError) as error:
        failures.append("{}: {}".format(type(error).__name__, error))


@contextlib.contextmanager
def interruptible():
    """In here, signals that end a program raise Interrupted; afterwards they are ignored, so that the end is orderly."""
    for number in SIGNALS:
        signal.signal(number, interrupt)
    try:
        yield
    finally:
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)


def carry_out(name, parts, stop, may_be_interrupted=False):
    """Parts of a program one after the other until one fails, then `stop` in any case. Returns the exit status."""
    failures = []
    try:
        with interruptible():
            for part in parts:
                if not failures:
                    attempt(part, failures)
    except Interrupted as reason:
        if may_be_interrupted:
            print("\nStopping after {}...".format(reason), flush=True)
        else:
            failures.append("stopped by {}".format(reason))
    attempt(stop, failures)
    for failure in failures:
        print("{}: {}".format(name, failure), file=sys.stderr)
    return 1 if failures else 0


def node_names(arguments):
    """Of the nodes that a session starts, and of a trainee, which would drive in it; rviz has a new name each time."""
    always = ("robot_state_publisher", "sim_node", "vibe_record", "vibe_trainee")
    camera = ("vision_node",) if arguments.camera else ()
    page = ("web_node",) if arguments.web else ()
    return (*always, *DRIVERS[arguments.drive].nodes, *camera, *page)


def perform(arguments):
    """A whole session; returns the exit status."""
    try:
        if arguments.master:
            Graph("", own_master=False).use_master(node_names(arguments))  # before there is a folder
        session = Session(arguments)
    except (OSError, GraphError) as error:
        print("run: {}".format(error), file=sys.stderr)
        return 1

    return carry_out("run", [session.start, session.watch, session.finish, session.show], session.stop, may_be_interrupted=True)
