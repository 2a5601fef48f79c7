"""A ROS graph: a master of its own on a free port, or the user's, and nodes that end with this process. No ROS here."""

import ctypes
import http.client
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import xml.parsers.expat
import xmlrpc.client

from vibe_sessions.headless import find_in_package

from . import places

PR_SET_PDEATHSIG = 1
TAIL_LINES = 15
PROGRESS = re.compile(rb"^(t = .*)\n", re.MULTILINE)  # a line a second, of sim_node


class GraphError(Exception):
    """One sentence for the user."""


def end_with_parent():
    """Runs in a new process before it becomes its program: it must not outlive us, and Ctrl-C must reach it again."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def free_port():
    with socket.socket() as probe:
        try:
            probe.bind(("localhost", 0))
        except socket.gaierror as error:
            sys.exit("the name localhost has no address here ({}); add '127.0.0.1 localhost' to /etc/hosts".format(error))
        return probe.getsockname()[1]


def answers(uri):
    """Whether there is a ROS master."""
    try:
        return xmlrpc.client.ServerProxy(uri).getPid("/vibe_scripts")[0] == 1
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, xml.parsers.expat.ExpatError, TypeError, LookupError):
        return False


def write_all(descriptor, data):
    """A full disk or a closed pipe must not stop the program whose output this is."""
    try:
        while data:
            data = data[os.write(descriptor, data) :]
    except OSError:
        pass


def on_one_line(data):
    """For a terminal: the progress takes one line, so that what was said before, such as an address, stays in view."""
    return b"\033[K" + PROGRESS.sub(rb"\1\033[K\r", data)


def loopback_library():
    """What, preloaded, keeps the TCP servers of a program on the loopback interface; None if it is not built."""
    return find_in_package("vibe_ros_utils", "libvibe_loopback.so")


class Process:
    """One program of the graph. Its output goes to a log file and, if it is visible, also where ours goes. `patience` is
    how long it may take to stop after SIGINT [s]."""

    def __init__(self, name, command, log, env, patience=10.0, essential=True, visible=False):
        self.name, self.log, self.patience, self.essential = name, log, patience, essential
        self.copies = []
        with open(log, "ab") as output:  # not whole: a log
            self.process = subprocess.Popen(
                command,
                env=env,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE if visible else output,
                stderr=subprocess.PIPE if visible else subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=end_with_parent,
            )
        if visible:
            for source, ours in ((self.process.stdout, 1), (self.process.stderr, 2)):
                self.copies.append(threading.Thread(target=self.copy, args=(source, ours), daemon=True))
                self.copies[-1].start()

    def copy(self, source, ours):
        with open(self.log, "ab", buffering=0) as log:  # not whole: a log
            while True:
                data = os.read(source.fileno(), 65536)
                if not data:
                    return
                write_all(ours, on_one_line(data) if os.isatty(ours) else data)
                write_all(log.fileno(), data)

    def flush(self, seconds=2.0):
        """Waits until everything that an ended program has said is where it belongs."""
        for thread in self.copies:
            thread.join(seconds)

    def status(self):
        """None while it runs, else its exit status."""
        return self.process.poll()

    def wait(self, seconds):
        """True when it has ended within this time."""
        try:
            self.process.wait(seconds)
            self.flush()
            return True
        except subprocess.TimeoutExpired:
            return False

    def stop(self):
        """SIGINT, then harder. Returns whether SIGINT was enough."""
        for number, patience in ((signal.SIGINT, self.patience), (signal.SIGTERM, 5.0), (signal.SIGKILL, 5.0)):
            if self.status() is not None:
                self.flush()
                return True
            self.process.send_signal(number)
            if self.wait(patience):
                return number == signal.SIGINT
        return False

    def last_words(self):
        """The end of what it wrote, indented."""
        if not os.path.exists(self.log):
            return ""
        with open(self.log, errors="replace") as text:
            lines = text.read().splitlines()[-TAIL_LINES:]
        return "\n".join("    " + line for line in lines)


class Graph:
    """A master and the programs around it, in the order they were started."""

    def __init__(self, log_folder, own_master=True):
        self.log_folder = log_folder
        self.own_master = own_master
        self.processes = []
        self.parameters = {}  # what the user's master had before: name -> value, or None
        self.env = dict(os.environ)
        if own_master:
            self.port = free_port()
            self.env.update(ROS_MASTER_URI="http://localhost:{}".format(self.port), ROS_HOSTNAME="localhost")
            self.env.pop("ROS_IP", None)
            preload = [loopback_library(), os.environ.get("LD_PRELOAD")]
            self.env["LD_PRELOAD"] = ":".join(library for library in preload if library)
        self.env.setdefault("ROS_MASTER_URI", "http://localhost:11311")
        self.env.pop("ROS_NAMESPACE", None)
        self.env.setdefault("ROS_HOME", os.path.join(log_folder, "ros"))
        self.env.setdefault("ROS_LOG_DIR", os.path.join(log_folder, "ros"))
        self.env.setdefault("ROSCONSOLE_STDOUT_LINE_BUFFERED", "1")  # messages in time also where this is piped
        self.master = xmlrpc.client.ServerProxy(self.env["ROS_MASTER_URI"])

    def how_to_attach(self):
        words = "To attach from another terminal: export ROS_MASTER_URI=" + self.env["ROS_MASTER_URI"]
        return words + (" ROS_HOSTNAME=localhost" if self.own_master else "")

    def use_master(self, names=()):
        """The user's, which must answer, and have no nodes of these names: a master ends a node when another one of its
        name comes."""
        if not self.has_node("/rosout"):
            uri = self.env["ROS_MASTER_URI"]
            raise GraphError("no ROS master answers at {}; start roscore, or leave --master out".format(uri))
        known = " and ".join("/" + name for name in names if self.has_node("/" + name))
        if known:
            words = "{} runs already at {}, and the session would end it; stop it first (rosnode kill; rosnode cleanup if it was killed)"
            raise GraphError(words.format(known, self.env["ROS_MASTER_URI"]))

    def start_master(self, seconds=30.0):
        if not self.own_master:
            return self.use_master()
        # what roscore starts, too, after seconds
        master = self.start("rosmaster", ["rosmaster", "--core", "-p", str(self.port)], patience=seconds)
        deadline = time.monotonic() + seconds
        while not answers(self.env["ROS_MASTER_URI"]):
            if master.status() is not None:
                raise GraphError("rosmaster did not start:\n" + master.last_words())
            if time.monotonic() > deadline:
                raise GraphError("rosmaster gave no answer within {:.0f} s; see {}".format(seconds, master.log))
            time.sleep(0.05)
        self.start_node("rosout", "rosout")

    def start(self, name, command, visible=False, patience=10.0, essential=True):
        """Starts a program; its output goes to a log file and, when it is visible, also where ours goes."""
        log = os.path.join(self.log_folder, name + ".log")
        process = Process(name, command, log, self.env, patience, essential, visible)
        self.processes.append(process)
        return process

    def start_node(self, package, name, *options, **settings):
        return self.start(name, [places.program(package, name), *options], **settings)

    def start_rviz(self, config):
        """As an X client on a Wayland desktop, too: into the window of a Wayland client OGRE cannot draw, and rviz aborts."""
        command = ["rosrun", "rviz", "rviz", "-d", config]  # a session goes on without it, even where it is not installed
        if self.env.get("QT_QPA_PLATFORM", "wayland" if self.env.get("WAYLAND_DISPLAY") else "").startswith("wayland"):
            print("On this Wayland desktop rviz runs through Xwayland (QT_QPA_PLATFORM=xcb).", flush=True)
            command = ["env", "QT_QPA_PLATFORM=xcb", *command]
        return self.start("rviz", command, essential=False)

    def start_page(self, port, essential):
        """The page of the session. Its port alone is open to the network if web_node wants it to be."""
        command = ["env", "VIBE_OPEN_PORT={}".format(port), places.program("vibe_web", "web_node")]
        return self.start("web_node", command, visible=True, essential=essential)

    def start_robot(self):
        """The endoscope, and the transforms of its links."""
        with open(places.find(places.ROBOT), encoding="utf-8") as urdf:
            self.set_parameter("/robot_description", urdf.read())
        # else every second step of the simulator has no tf
        self.set_parameter("/robot_state_publisher/publish_frequency", 200.0)
        self.start_node("robot_state_publisher", "robot_state_publisher")

    def check_alive(self):
        dead = self.dead()
        if dead is not None:
            raise GraphError("{} died; the last it said:\n{}".format(dead.name, dead.last_words()))
        return True

    def has_node(self, name):
        try:
            return self.master.lookupNode("/vibe_scripts", name)[0] == 1
        except (OSError, xmlrpc.client.Error):
            return False

    def set_parameter(self, name, value):
        if not self.own_master and name not in self.parameters:
            known, _, before = self.master.getParam("/vibe_scripts", name)
            self.parameters[name] = before if known == 1 else None
        code, message, _ = self.master.setParam("/vibe_scripts", name, value)
        if code != 1:
            raise GraphError("the master refused the parameter {}: {}".format(name, message))

    def restore_parameters(self):
        """Puts back what the user's master had."""
        try:
            for name, before in self.parameters.items():
                if before is None:
                    self.master.deleteParam("/vibe_scripts", name)
                else:
                    self.master.setParam("/vibe_scripts", name, before)
        except (OSError, xmlrpc.client.Error):
            pass  # it is gone, and its parameters with it
        self.parameters = {}

    def dead(self):
        """The first essential program that is not running any more, or None."""
        for process in self.processes:
            if process.essential and process.status() is not None:
                return process
        return None

    def stop_all(self):
        """Stops everything, the last one first. Returns the names of the essential ones that had to be forced."""
        stopped = [(process, process.stop()) for process in reversed(self.processes)]
        self.restore_parameters()
        return [process.name for process, in_time in stopped if process.essential and not in_time]
