"""Runs tests side by side, as many as the cores can bear, and sees to it that nothing of a test outlives it.

Every test begins a session of its own and has a mark in its environment. A process of the session or with the mark
belongs to the test: it is ended with it, even if it has left the session and lost its parent.
"""

import os
import shutil
import signal
import subprocess
import time

POLL = 0.05  # [s]
PATIENCE = 3.0  # between SIGTERM and SIGKILL [s]
FORSAKEN = 20.0  # after SIGTERM; not even SIGKILL has ended it [s]
PROGRESS = 60.0  # a sign of life after so much silence [s]


class Interrupted(Exception):
    """A signal ended the run; its number is the argument."""


def processes():
    """Yields (process id, session, environment) of every process that is alive and may be looked at."""
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open("/proc/{}/stat".format(name), "rb") as stat:
                fields = stat.read().rpartition(b")")[2].split()
            with open("/proc/{}/environ".format(name), "rb") as environment:
                words = environment.read()
        except OSError:  # it has just ended, or is another user's
            continue
        if fields[0] != b"Z":
            yield int(name), int(fields[3]), words


class Run:
    """One run of a test."""

    def __init__(self, test, log, scratch):
        self.test, self.log, self.scratch = test, log, scratch
        self.begin, self.end = time.monotonic(), None
        self.asked = None  # when its processes were asked to end
        self.timed_out = False
        self.status = None
        self.mark = "VIBE_TEST_OF_{}={}".format(os.getpid(), os.path.basename(scratch))
        self.process = self.start()

    def environment(self):
        """Tests run side by side: each has folders of its own for ROS and for sockets."""
        folders = {"ROS_HOME": os.path.join(self.scratch, "ros"), "XDG_RUNTIME_DIR": os.path.join(self.scratch, "run")}
        for folder in folders.values():
            os.makedirs(folder, mode=0o700)
        key, _, value = self.mark.partition("=")
        return dict(os.environ, **folders, **{key: value}, **self.test.environment)

    def start(self):
        """None if there is no such program: the log says why, and the status is that of a shell."""
        if self.test.result_file and os.path.exists(self.test.result_file):
            os.remove(self.test.result_file)
        with open(self.log, "wb") as log:
            try:
                return subprocess.Popen(
                    self.test.command, cwd=self.test.folder, env=self.environment(), start_new_session=True,
                    stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
            except OSError as error:
                log.write("{} cannot be started: {}\n".format(self.test.command[0], error).encode())
            except IndexError:  # ctest names no command for a program that is not there
                log.write(b"The program of this test is not built; run scripts/build --tests.\n")
        self.status = 127
        return None

    def seconds(self):
        return (self.end or time.monotonic()) - self.begin

    def members(self):
        """The processes of this test that are alive."""
        mark = b"\0" + self.mark.encode() + b"\0"
        return [pid for pid, session, words in processes() if session == self.process.pid or mark in b"\0" + words]

    def send(self, number):
        for pid in self.members():
            try:
                os.kill(pid, number)
            except OSError:
                pass

    def stop(self):
        """Asks every process of the test to end."""
        self.asked = time.monotonic()
        self.send(signal.SIGTERM)

    def has_ended(self):
        """Whether the test and all that it started have ended; sees to it that they do."""
        if self.process is None:
            self.end = time.monotonic()
            return True
        now, self.status = time.monotonic(), self.process.poll()
        if self.status is not None and self.end is None:
            self.end = now
        if self.status is not None and not self.members():
            return True
        if self.asked is None and (self.status is not None or now - self.begin > self.test.timeout):
            self.timed_out = self.status is None
            self.stop()
        elif self.asked is not None and now - self.asked > PATIENCE:
            self.send(signal.SIGKILL)
        return self.status is not None and self.asked is not None and now - self.asked > FORSAKEN


class Pool:
    """Starts tests when there is room for them: a test takes some of the units, and all locks that it names."""

    def __init__(self, capacity, logs, scratch, say):
        self.capacity, self.logs, self.scratch, self.say = capacity, logs, scratch, say
        self.running = []
        self.count = 0
        self.interruption = None  # the number of the signal, once one has come
        self.spoken = time.monotonic()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.interrupt)

    def interrupt(self, number, _):
        self.interruption = self.interruption or number

    def run(self, tests, suffix="", alone=False):
        """Runs the tests, the longest first, and yields each run when it has ended. `alone`: one after the other."""
        waiting = sorted(tests, key=lambda test: (-test.cost, test.name))
        while waiting or self.running:
            if self.interruption:
                self.stop()
                raise Interrupted(self.interruption)
            for test in list(waiting):
                if self.has_room(test, alone):
                    waiting.remove(test)
                    self.start(test, suffix)
            yield from self.ended()
            self.tell_progress()
            time.sleep(POLL)

    def has_room(self, test, alone):
        if alone:
            return not self.running
        taken = sum(min(run.test.units, self.capacity) for run in self.running)
        locked = any(run.test.locks & test.locks for run in self.running)
        return not locked and taken + min(test.units, self.capacity) <= self.capacity

    def start(self, test, suffix):
        self.count += 1
        log = os.path.join(self.logs, test.name.replace("/", "_") + suffix + ".log")
        self.running.append(Run(test, log, os.path.join(self.scratch, str(self.count))))

    def ended(self):
        for run in [run for run in self.running if run.has_ended()]:
            self.running.remove(run)
            shutil.rmtree(run.scratch, ignore_errors=True)
            self.spoken = time.monotonic()
            yield run

    def tell_progress(self):
        if time.monotonic() - self.spoken > PROGRESS and self.running:
            self.spoken = time.monotonic()
            words = ["{} {:.0f} s".format(run.test.name, run.seconds()) for run in self.running]
            self.say("          running: " + ", ".join(words))

    def stop(self):
        """Ends everything that runs."""
        for run in self.running:
            if run.process is not None:
                run.stop()
        while self.running:
            list(self.ended())
            time.sleep(POLL)
