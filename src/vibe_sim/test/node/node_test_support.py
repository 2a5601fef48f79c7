"""What the tests of the node share. The tests know the simulator only through its topics, services and exit status."""

import os
import signal
import subprocess
import threading
import time

import rospkg
import rospy
from sensor_msgs.msg import JointState, Joy

EPOCH = 1_000_000_000  # stamp of step 0 [ns]
PERIOD = 1.0 / 60  # of balloon.yaml [s]
SCOPE_JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
OVERSTITCH_JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]


def scene(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", name)


def stamp_of(step, origin=EPOCH, period=PERIOD):
    return origin + round(step * period * 1e9)


def wait_until(condition, seconds=10.0):
    """Whether the condition became true within some seconds of wall time."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.01)
    return bool(condition())


class Recorder:
    """Everything that arrives on a topic, in order."""

    def __init__(self, topic, message_type):
        self._messages = []
        self._lock = threading.Lock()
        self.subscriber = rospy.Subscriber(topic, message_type, self._append, queue_size=None, tcp_nodelay=True)

    def _append(self, message):
        with self._lock:
            self._messages.append(message)

    @property
    def messages(self):
        with self._lock:
            return list(self._messages)

    def clear(self):
        with self._lock:
            self._messages = []

    def is_connected(self):
        return self.subscriber.get_num_connections() > 0

    def stamps(self):
        return [message.header.stamp.to_nsec() for message in self.messages]

    def find(self, condition, seconds=10.0):
        """The first message for which it holds, or None."""
        found = []
        wait_until(lambda: found.extend(m for m in self.messages if condition(m)) or found, seconds)
        return found[0] if found else None


def joints(names, positions, stamp):
    message = JointState(name=list(names), position=list(positions))
    message.header.stamp = stamp
    return message


def buttons(pressed=(), stamp=None):
    message = Joy(buttons=[1 if i in pressed else 0 for i in range(6)])
    message.header.stamp = stamp or rospy.Time(0)
    return message


class Program:
    """A program of the package under test, with its output."""

    def __init__(self, program, name=None, env=None, remap=(), wrapper=(), **parameters):
        path = find_program(program)
        if name and rospy.has_param("/" + name):
            rospy.delete_param("/" + name)  # of an earlier program of this name
        arguments = ["_{}:={}".format(key, value) for key, value in parameters.items()]
        if name:
            arguments.append("__name:=" + name)
        arguments += remap
        self.lines = []
        self.process = subprocess.Popen(
            list(wrapper) + [path] + arguments,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=dict(os.environ, **(env or {})),
            universal_newlines=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def output(self):
        return "\n".join(self.lines)

    def count(self, text):
        return sum(text in line for line in list(self.lines))

    def says(self, text, seconds=20.0):
        return wait_until(lambda: self.count(text) > 0, seconds)

    def ends(self, seconds=30.0):
        """The exit status, or None if it still runs after that time."""
        try:
            self.process.wait(seconds)
            self._reader.join(5)
        except subprocess.TimeoutExpired:
            return None
        return self.process.returncode

    def stop(self):
        """SIGINT, as Ctrl-C; SIGKILL if that is not enough. The exit status."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        if self.ends(15) is None:
            self.process.kill()
        return self.ends()


def find_program(program):
    for folder in os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep):
        for package in ("vibe_sim", "vibe_core"):
            path = os.path.join(folder, "lib", package, program)
            if os.path.exists(path):
                return path
    raise rospkg.ResourceNotFound(program)


def state_hash(text):
    hashes = [line.split()[-1] for line in text.splitlines() if line.startswith("state hash: ")]
    return hashes[-1] if hashes else None
