"""One session of a cohort, performed by a child process; on this machine or on a worker."""
import csv
import shutil
import signal
import subprocess

from vibe_sessions.cohort_plan import CohortError, digest, find_program, resolve, versions

POLL = 0.2  # between looks whether the session is still wanted [s]


class Killed(Exception):
    """A signal ended the child: the session may succeed elsewhere."""


class Stopped(Exception):
    """The session was no longer wanted."""


def check_files(session):
    """A worker must have what the plan was made from."""
    here = versions()
    for name, expected in session.versions:
        if here.get(name) != expected:
            raise CohortError(f"The {name} of vibe_core is {here.get(name)} here and {expected} in the plan; give each "
                              "worker the same workspace.")
    for address, expected in session.digests:
        if expected != "unreadable" and digest(address) != expected:
            raise CohortError(f"'{address}' is missing here or differs from that of the plan; give each worker the "
                              "same files.")


def command_of(session):
    command = [find_program(), "--script", resolve(session.script), "--scene", resolve(session.scene), "--csv", "-"]
    command += ["--count", "1", "--first-seed", str(session.seed), "--novice", repr(float(session.novice))]
    command += ["--mesh", resolve(session.mesh)] if session.mesh else []
    command += ["--duration", repr(float(session.duration))] if session.duration > 0 else []
    # the child ends with the process that waits for it, even if that is killed
    return (["setpriv", "--pdeathsig", "KILL"] if shutil.which("setpriv") else []) + command


def wait(child, stopped):
    while True:
        try:
            return child.communicate(timeout=POLL)
        except subprocess.TimeoutExpired:
            if stopped():
                raise Stopped from None


def row_of(output, said, status):
    """(columns, values) of the table that the child has printed."""
    if status < 0:
        raise Killed(f"The session was ended by the signal {signal.Signals(-status).name}.")
    if status != 0:
        lines = said.strip().splitlines()
        raise CohortError(lines[-1].removeprefix("vibe_cohort: ") if lines else f"It ended with status {status}.")
    rows = list(csv.reader(output.splitlines()))
    if len(rows) != 2 or len(rows[0]) != len(rows[1]):
        raise CohortError("It printed no row of measures.")
    return rows


def perform(session, stopped=lambda: False):
    """Performs a session. Returns (columns, values) as text.

    Raises CohortError if the session cannot succeed, Killed if it may succeed elsewhere, Stopped on demand.
    """
    check_files(session)
    child = subprocess.Popen(command_of(session), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, errors="replace", process_group=0)
    try:
        output, said = wait(child, stopped)
    finally:
        if child.poll() is None:
            child.kill()
            child.communicate()
    columns, values = row_of(output, said, child.returncode)
    return ["scene", "mesh"] + columns, [session.scene, session.mesh] + values
