"""What the checks of faults share: a graph whose programs are killed and started again, and an observer that knows when
which message came."""

import os
import re
import signal
import sys
import time

import rospy
from vibe_bringup import places
from vibe_bringup.graph import Graph
from vibe_testing.program import find_program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import PATIENCE, wait_until

STEPS_PER_SECOND = 60  # of light.yaml
DECORATION = re.compile(r"\x1b\[[0-9;]*m(\[ *[A-Z]+\] \[[0-9., ]+\]: )?|^\[ *[A-Z]+\] \[[0-9., ]+\]: ")  # of roscpp


class Failure(Exception):
    """One sentence: what a check expected and what came."""


def expect(condition, sentence):
    """Raises Failure unless the condition holds."""
    if not condition:
        raise Failure(sentence)


class Row:
    """A fault in the table: what was lost, how long it took to recover [s], what the user sees."""

    def __init__(self, fault, lost, seconds, seen):
        self.fault, self.lost, self.seconds, self.seen = fault, lost, seconds, seen

    def text(self):
        recovery = "-" if self.seconds is None else "{:.2f} s".format(self.seconds)
        return "| {} | {} | {} | {} |".format(self.fault, self.lost, recovery, self.seen)


class Flow(Recorder):
    """When the messages of a topic arrived, in monotonic time, and, if it is to `keep` them, the messages. Only those
    count for which `counts` holds."""

    clock = staticmethod(time.monotonic)

    def __init__(self, topic, kind=rospy.AnyMsg, keep=False, counts=None):
        self.topic, self.keep, self.counts = topic, keep, counts
        super().__init__(topic, kind)

    def take(self, message):
        if self.counts is None or self.counts(message):
            super().take(message if self.keep else None)

    def since(self, begin, end=None):
        """(time of arrival, message) from begin to end."""
        return [(t, m) for t, m in self.arrivals if t >= begin and (end is None or t <= end)]

    def gap(self, begin, end):
        """The longest time without a message between two times [s]."""
        times = [begin] + [t for t, _ in self.since(begin, end)] + [end]
        return max(b - a for a, b in zip(times, times[1:]))

    def wait(self, begin, condition=None, seconds=PATIENCE):
        """The first (time of arrival, message) after begin for which the condition holds, or None."""
        found = []

        def look():
            found[:] = [(t, m) for t, m in self.since(begin) if condition is None or condition(m)][:1]
            return found

        return found[0] if wait_until(look, seconds) else None


class Bench:
    """A graph of its own. Programs are named as their nodes are and can be killed and started again."""

    def __init__(self, folder):
        self.folder = folder
        logs = os.path.join(folder, "log")
        os.makedirs(logs, exist_ok=True)
        self.graph = Graph(logs)
        for name in ("ROS_MASTER_URI", "ROS_HOSTNAME", "ROS_HOME", "ROS_LOG_DIR"):
            os.environ[name] = self.graph.env[name]
        self.commands, self.programs = {}, {}

    def observe(self):
        """Makes this process a node."""
        rospy.init_node("observer", disable_signals=True, log_level=rospy.FATAL)

    def file(self, name, text):
        """A file of this bench."""
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return path

    def start(self, name, package=None, program=None, *arguments, **parameters):
        """Starts a node or, with nothing but a name, what had this name before. Returns when it was started."""
        if package is not None:
            words = ["_{}:={}".format(key, value) for key, value in parameters.items()]
            node = [] if program in ("vibe_emulator", "vibe_fake_camera", "rosmaster") else ["__name:=" + name]
            # not through rosrun, so that a signal meets the program and no time goes into looking for it
            self.commands[name] = [find_program(package, program)] + list(arguments) + words + node
        begin = time.monotonic()
        self.programs[name] = self.graph.start(name, self.commands[name])
        return begin

    def start_simulator(self, **parameters):
        """The lightest scene, in real time unless the parameters say something else."""
        scene = places.find("package://vibe_sim/test/node/scenes/light.yaml")
        self.start("sim_node", "vibe_sim", "sim_node", **{"scene": scene, **parameters})

    def start_module(self, name, module, *words):
        """A module of this package, in a process of its own."""
        self.programs[name] = self.graph.start(name, [sys.executable, "-P", "-m", __package__ + "." + module, *words])

    def pid(self, name):
        return self.programs[name].process.pid

    def send(self, name, number):
        os.kill(self.pid(name), number)

    def kill(self, name):
        """SIGKILL. Returns when."""
        begin = time.monotonic()
        program = self.programs.pop(name)
        program.process.kill()
        program.process.wait()
        self.graph.processes.remove(program)
        return begin

    def stop(self, name):
        """SIGINT, as Ctrl-C. Returns the exit status."""
        program = self.programs.pop(name)
        program.stop()
        self.graph.processes.remove(program)
        return program.status()

    def check_alive(self):
        for name, program in self.programs.items():
            expect(program.status() is None, "{} died with status {}:\n{}".format(
                name, program.status(), program.last_words()))

    def said(self, name, begin=0):
        """What a program has written, from a number of bytes on: no times, and not the line of every second."""
        with open(os.path.join(self.graph.log_folder, name + ".log"), errors="replace", encoding="utf-8") as text:
            text.seek(begin)
            lines = [DECORATION.sub("", line.rstrip()) for line in text]
        return [line for line in lines if line and "x real time" not in line]

    def mark(self, name):
        """Where the log of a program ends now."""
        return os.path.getsize(os.path.join(self.graph.log_folder, name + ".log"))

    def says(self, name, words, begin=0, seconds=PATIENCE):
        """The line with these words that a program has written."""
        found = []
        wait_until(lambda: found.extend(line for line in self.said(name, begin) if words in line) or found, seconds)
        expect(found, "{} does not say '{}'; it said: {}".format(name, words, self.said(name, begin)[-5:]))
        return found[0]

    def step(self, name):
        """Steps of a simulator, from the line that it prints every second."""
        return round(STEPS_PER_SECOND * simulated_time(self.programs[name].log))

    def waits_for_step(self, name, step, seconds=90):
        expect(wait_until(lambda: self.step(name) >= step, seconds), "{} takes too few steps".format(name))

    def memory(self, name, key="VmRSS"):
        return memory(self.pid(name), key)

    def descriptors(self, name):
        return len(os.listdir("/proc/{}/fd".format(self.pid(name))))

    def end(self):
        for program in self.programs.values():
            if program.status() is None:
                program.process.send_signal(signal.SIGCONT)  # what stands still does not hear that it should end
        self.graph.stop_all()


def memory(pid, key="VmRSS"):
    """Of a process [MB]."""
    with open("/proc/{}/status".format(pid), encoding="ascii") as text:
        return next(int(line.split()[1]) / 1024 for line in text if line.startswith(key + ":"))


def simulated_time(log):
    """Time of the simulator, from the end of what it has printed [s]."""
    with open(log, "rb") as text:
        text.seek(max(0, os.path.getsize(log) - 2000))
        lines = [line for line in text.read().decode(errors="replace").splitlines() if line.startswith("t = ")]
    return float(lines[-1].split()[2]) if lines else 0.0


def pace(steps, seconds):
    """Simulated time by wall time over some seconds from now, from the step numbers of applied_input."""
    begin = time.monotonic()
    time.sleep(seconds)
    end = time.monotonic()
    taken = steps.since(begin, end)
    if len(taken) < 2:
        return 0.0
    return (taken[-1][1].step - taken[0][1].step + 1) / STEPS_PER_SECOND / (end - begin)


def script_of_motions(name, count=400):
    """A trainee script that moves the scope to and fro before the tissue, at 5 cm/s in the mean, for 0.6 s a stroke."""
    lines = ["name: " + name, "actions:"]
    for k in range(count):
        insertion, rotation = ("5 cm", "20 deg") if k % 2 == 0 else ("2 cm", "-20 deg")
        lines.append("  - {{move: {{insertion: {}, rotation: {}}}, in: 0.6 s}}".format(insertion, rotation))
    return "\n".join(lines) + "\n"
