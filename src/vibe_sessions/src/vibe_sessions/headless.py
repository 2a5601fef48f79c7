"""Runs vibe_headless, which performs a session and writes its measures by name."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile

POLL = 0.2  # between looks whether the session is still wanted [s]


class SessionError(Exception):
    """One sentence for the user."""


class Killed(SessionError):
    """A signal ended the program: the session may succeed elsewhere."""


class Stopped(Exception):
    """The session was no longer wanted."""


def status_of(name, work, resume):
    """What a program ends with: its errors are one sentence. `resume` says what to do after an interruption."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return work()
    except SessionError as error:
        sentence, status = str(error), 2
    except OSError as error:
        sentence, status = f"'{error.filename or ''}' cannot be read or written: {error.strerror}.", 1
    except KeyboardInterrupt:
        sentence, status = f"interrupted; {resume}.", 130
    sys.stderr.write(("\n" if status == 130 else "") + f"{name}: {sentence}\n")
    return status


def find_in_package(package, name, kind="lib"):
    """The path of a program, or of what else is private to a package (`kind`: in lib or in share): in a workspace that is
    sourced, or where packages of the system are; None if it is not there."""
    for prefix in [*os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep), "/usr"]:
        path = os.path.join(prefix, kind, package, name)
        if prefix and os.access(path, os.R_OK):
            return path
    return None


def find_program(package="vibe_core", name="vibe_headless"):
    program = find_in_package(package, name)
    if program is None:
        raise SessionError(f"There is no {name}; build {package} and source its workspace.")
    return program


def _wait(child, stopped):
    while True:
        try:
            return child.communicate(timeout=POLL)
        except subprocess.TimeoutExpired:
            if stopped():
                raise Stopped from None


def call(arguments, stopped=lambda: False, program=None, accepted=(0,)):
    """What a program printed that ends with one of these statuses: vibe_headless, or that at another path.

    Raises SessionError with the sentence that it said, Killed if a signal ended it, Stopped on demand.
    """
    program = program or find_program()
    name = os.path.basename(program)
    # the child ends with the process that waits for it, even if that is killed
    guard = ["setpriv", "--pdeathsig", "KILL"] if shutil.which("setpriv") else []
    child = subprocess.Popen(guard + [program, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, errors="replace", process_group=0)
    try:
        output, said = _wait(child, stopped)
    finally:
        if child.poll() is None:
            child.kill()
            child.communicate()
    if child.returncode < 0:
        raise Killed(f"{name} was ended by the signal {signal.Signals(-child.returncode).name}.")
    if child.returncode not in accepted:
        lines = said.strip().splitlines() or [f"{name} ended with status {child.returncode}."]
        raise SessionError(lines[-1].removeprefix(name + ": "))
    return output


def perform(arguments, stopped=lambda: False):
    """Performs the session of these arguments: {"measures": {name: {"value", "unit"}}, "events", "state_hash", ...}."""
    with tempfile.TemporaryDirectory(prefix="vibe_session_") as folder:
        file = os.path.join(folder, "measures.json")
        call([*arguments, "--measures", file, "--quiet"], stopped)
        with open(file, encoding="utf-8") as stream:
            return json.load(stream)
