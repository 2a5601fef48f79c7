"""Programs under test, with what they write."""

import os
import shutil
import signal
import subprocess
import threading

import rospy

from .wait import PATIENCE, wait_until


def find_program(package, program):
    """Its path: in a catkin workspace, of the system's packages, or on PATH."""
    prefixes = os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) + ["/usr"]
    folders = os.pathsep.join(os.path.join(prefix, "lib", package) for prefix in prefixes)
    path = shutil.which(program, path=folders) or shutil.which(program)
    if path is None:
        raise FileNotFoundError("{} of {} is not built, or this workspace is not sourced".format(program, package))
    return path


class Program:
    """A program of a package, with its output, as rosrun would start it.

    name:        of the node; its parameters of an earlier program are removed
    env:         variables besides ours; None takes one away
    wrapper:     a command line in front of the program's
    stdin:       as for subprocess.Popen
    parameters:  private ROS parameters
    """

    def __init__(self, package, program, *arguments, name=None, env=None, wrapper=(), stdin=None, **parameters):
        if name and rospy.has_param("/" + name):
            rospy.delete_param("/" + name)
        command = [*wrapper, find_program(package, program), *arguments]
        command += ["_{}:={}".format(key, value) for key, value in parameters.items()]
        if name:
            command.append("__name:=" + name)
        environment = {**os.environ, "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1", **(env or {})}
        self.lines = []
        self.process = subprocess.Popen(
            command,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={key: value for key, value in environment.items() if value is not None},
            text=True,
            errors="replace",
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        with self.process.stdout as output:
            for line in output:
                self.lines.append(line.rstrip())

    def output(self):
        return "\n".join(self.lines)

    def last_words(self, count=15):
        return "\n".join(self.lines[-count:])

    def count(self, text):
        """Of the lines that have the text."""
        return sum(text in line for line in list(self.lines))

    def says(self, text, seconds=PATIENCE):
        return wait_until(lambda: self.count(text) > 0, seconds)

    def is_running(self):
        return self.process.poll() is None

    def send(self, number):
        """A signal."""
        self.process.send_signal(number)

    def ends(self, seconds=PATIENCE):
        """The exit status, or None if it still runs after that time."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None
        self._reader.join(5)
        return self.process.returncode

    def kill(self):
        """SIGKILL. The exit status."""
        self.process.kill()
        return self.ends()

    def stop(self, number=signal.SIGINT):
        """SIGINT, as Ctrl-C, or another signal; SIGKILL if that is not enough. The exit status."""
        if self.is_running():
            self.send(number)
        return self.kill() if self.ends() is None else self.process.returncode

    def memory(self):
        """Resident memory [bytes]."""
        with open("/proc/{}/statm".format(self.process.pid), encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
