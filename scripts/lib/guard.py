"""Runs a command so that nothing it starts outlives it, whatever happens to this process - SIGKILL included.

Two processes: this one, which the user sees and may kill, and a keeper in a session of its own. The keeper is the
command's parent and adopts every orphan below it (PR_SET_CHILD_SUBREAPER). It ends the whole family when the command
has ended, or when this process has died, which it notices because their pipe closes. A signal sent to this process
travels through the same pipe to the command.

Usage: guard.py COMMAND [ARGUMENT...]; ends with the command's exit status, or 128 + the signal that ended it.
"""

import ctypes
import os
import select
import signal
import sys
import time

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36
FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
PATIENCE_OF_COMMAND = 30.0  # for a command to end in its own way after this process has died [s]
PATIENCE_OF_ORPHANS = 3.0  # between SIGTERM and SIGKILL for what the command left behind [s]
POLL = 0.05  # [s]


def prctl(option, value):
    if ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl({}, {})".format(option, value))


def descendants():
    """Process ids of everything below this process."""
    children = {}
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open("/proc/{}/stat".format(name), "rb") as stat:
                fields = stat.read().rpartition(b")")[2].split()
        except OSError:  # it has just ended
            continue
        if fields[0] != b"Z":
            children.setdefault(int(fields[1]), []).append(int(name))
    found, wave = [], [os.getpid()]
    while wave:
        wave = [child for parent in wave for child in children.get(parent, [])]
        found += wave
    return found


def send(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass


class Keeper:
    """Parent of the command; sees to it that the whole family ends."""

    def __init__(self, life, command):
        self.life = life
        self.status = None
        prctl(PR_SET_CHILD_SUBREAPER, 1)
        for number in FORWARDED + (signal.SIGPIPE,):
            signal.signal(number, signal.SIG_IGN)
        self.ended, wake = os.pipe()  # one can be read when a child has ended
        os.set_blocking(wake, False)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda number, frame: None)
        self.command = os.fork()
        if self.command == 0:
            self.become(command)

    def become(self, command):
        """In the child: turns into the command."""
        try:
            for number in FORWARDED + (signal.SIGPIPE,):
                signal.signal(number, signal.SIG_DFL)
            prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
            os.environ["VIBE_GUARDED"] = str(os.getppid())
            os.execvp(command[0], command)
        except OSError as error:
            print("guard: {}: {}".format(command[0], error), file=sys.stderr)
        finally:
            os._exit(127)

    def reap(self):
        """Collects every ended child; remembers how the command ended."""
        try:
            while True:
                pid, status = os.waitpid(-1, os.WNOHANG)
                if pid == 0:
                    return
                if pid == self.command:
                    code = os.waitstatus_to_exitcode(status)
                    self.status = code if code >= 0 else 128 - code
        except ChildProcessError:
            pass

    def watch(self):
        """Until the command has ended; forwards signals; asks it to end when the other process is gone."""
        deadline = None
        while self.status is None:
            ready = select.select([self.life, self.ended], [], [], POLL)[0] if deadline is None else []
            if self.ended in ready:
                os.read(self.ended, 4096)  # else it would be ready for ever, and this a busy loop
            if self.life in ready:
                numbers = os.read(self.life, 64)
                for number in numbers:
                    send(self.command, number)
                if not numbers:
                    send(self.command, signal.SIGTERM)
                    deadline = time.monotonic() + PATIENCE_OF_COMMAND
            elif deadline is not None:
                time.sleep(POLL)
                if time.monotonic() > deadline:
                    return
            self.reap()

    def sweep(self):
        """Ends what is left of the family."""
        begin = time.monotonic()
        asked = set()
        while True:
            self.reap()
            left = descendants()
            if not left:
                return
            late = time.monotonic() - begin > PATIENCE_OF_ORPHANS
            for pid in left:
                if late:
                    send(pid, signal.SIGKILL)
                elif pid not in asked:
                    send(pid, signal.SIGTERM)
                    asked.add(pid)
            time.sleep(POLL)


def keep(life, answer, command):
    os.setsid()
    keeper = Keeper(life, command)
    keeper.watch()
    keeper.sweep()
    os.write(answer, bytes([255 if keeper.status is None else keeper.status]))


def run(command):
    """Runs a command and ends what it leaves behind; returns its exit status."""
    life_read, life_write = os.pipe()
    answer_read, answer_write = os.pipe()
    keeper = os.fork()
    if keeper == 0:
        os.close(life_write)
        os.close(answer_read)
        try:
            keep(life_read, answer_write, command)
        finally:
            os._exit(0)
    os.close(life_read)
    os.close(answer_write)
    for number in FORWARDED:
        signal.signal(number, lambda received, frame: os.write(life_write, bytes([received])))
    answer = os.read(answer_read, 1)
    os.waitpid(keeper, 0)  # it has nothing more to do, and is a process of the family as long as it is there
    return answer[0] if answer else 1


def main():
    if len(sys.argv) < 2:
        sys.exit("guard: no command given")
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
