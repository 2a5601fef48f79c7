"""What the tests of hardware_node share: programs, recorders of topics, diagnostics."""

import os
import signal
import subprocess
import tempfile
import threading
import time

import rospkg
import rospy

SCOPE_JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
OVERSTITCH_JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]


def wait_until(condition, seconds=10.0):
    """Whether the condition became true within some seconds."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.005)
    return bool(condition())


def find_program(program):
    for folder in os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep):
        path = os.path.join(folder, "lib", "vibe_hardware", program)
        if os.path.exists(path):
            return path
    raise rospkg.ResourceNotFound(program)


class Recorder:
    """Everything that arrives on a topic, in order, with the time of arrival."""

    def __init__(self, topic, message_type):
        self._arrivals = []
        self._lock = threading.Lock()
        self.subscriber = rospy.Subscriber(topic, message_type, self._append, queue_size=None, tcp_nodelay=True)

    def _append(self, message):
        with self._lock:
            self._arrivals.append((time.time(), message))

    @property
    def arrivals(self):
        with self._lock:
            return list(self._arrivals)

    @property
    def messages(self):
        return [message for _, message in self.arrivals]

    def clear(self):
        with self._lock:
            self._arrivals = []

    def stamps(self):
        return [message.header.stamp.to_nsec() for message in self.messages]

    def waits_for(self, condition, seconds=10.0):
        """The first message for which it holds, or None."""
        found = []
        wait_until(lambda: found.extend(m for m in self.messages if condition(m)) or found, seconds)
        return found[0] if found else None


class Program:
    """A program with its output. ROS parameters as keywords."""

    def __init__(self, program, arguments=(), name=None, **parameters):
        if name and rospy.has_param("/" + name):
            rospy.delete_param("/" + name)  # of an earlier program of this name
        command = [find_program(program)] + list(arguments)
        command += ["_{}:={}".format(key, value) for key, value in parameters.items()]
        if name:
            command.append("__name:=" + name)
        self.lines = []
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True
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

    def says(self, text, seconds=10.0):
        return wait_until(lambda: self.count(text) > 0, seconds)

    def send(self, number):
        self.process.send_signal(number)

    def kill(self):
        self.process.kill()
        self.process.wait()

    def ends(self, seconds=15.0):
        """The exit status, or None if it still runs after that time."""
        try:
            self.process.wait(seconds)
            self._reader.join(5)
        except subprocess.TimeoutExpired:
            return None
        return self.process.returncode

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        if self.ends() is None:
            self.process.kill()
        return self.ends()


class Emulator:
    """vibe_emulator with a folder and a hand of its own."""

    def __init__(self, script):
        self.folder = tempfile.mkdtemp(prefix="vibe_hw_")
        self.script = os.path.join(self.folder, "hand.yaml")
        with open(self.script, "w") as file:
            file.write(script)
        self.program = None

    def sockets(self):
        """With their times: an emulator that was killed leaves its sockets behind."""
        files = [os.path.join(self.folder, f) for f in os.listdir(self.folder) if f.endswith(".hid")]
        return {(f, os.stat(f).st_ctime_ns) for f in files if os.path.exists(f)}

    def start(self):
        """Returns the time at which its devices are there."""
        stale = self.sockets()
        self.program = Program("vibe_emulator", ["--folder", self.folder, "--hand", "script", self.script])
        wait_until(lambda: len(self.sockets() - stale) == 2, 20)
        return time.time()

    def kill(self):
        self.program.kill()

    def stop(self):
        if self.program:
            self.program.stop()


class Diagnostics:
    """Newest values of the entry of a device on /diagnostics."""

    def __init__(self, recorder, name):
        self.recorder = recorder
        self.name = name

    def newest(self, after=0.0):
        """Status that was measured after a time, as (level, message, values); waits for it."""
        found = []

        def look():
            for arrival, message in reversed(self.recorder.arrivals):
                for status in message.status:
                    if status.name.endswith(self.name) and arrival > after:
                        found.append((status.level, status.message, {v.key: v.value for v in status.values}))
                        return True
            return False

        wait_until(look, 5)
        return found[0] if found else (None, "", {})

    def value(self, key, after=0.0):
        return float(self.newest(after)[2][key])
