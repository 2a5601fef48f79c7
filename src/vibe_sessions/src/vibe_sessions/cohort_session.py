"""One session of a cohort, performed by a child process; on this machine or on a worker."""
from vibe_sessions import headless
from vibe_sessions.cohort_plan import digest, resolve, versions
from vibe_sessions.headless import SessionError


def check_files(session):
    """A worker must have what the plan was made from."""
    here = versions()
    for name, expected in session.versions:
        if here.get(name) != expected:
            raise SessionError(f"The {name} of vibe_core is {here.get(name)} here and {expected} in the plan; give "
                               "each worker the same workspace.")
    for address, expected in session.digests:
        if expected != "unreadable" and digest(address) != expected:
            raise SessionError(f"'{address}' is missing here or differs from that of the plan; give each worker the "
                               "same files.")


def arguments_of(session):
    arguments = ["--script", resolve(session.script), "--scene", resolve(session.scene)]
    arguments += ["--seed", str(session.seed), "--novice", repr(float(session.novice))]
    arguments += ["--mesh", resolve(session.mesh)] if session.mesh else []
    return arguments + (["--duration", repr(float(session.duration))] if session.duration > 0 else [])


def text(value):
    return "" if value is None else f"{value:.6g}"


def perform(session, stopped=lambda: False):
    """Performs a session. Returns (columns, values) as text.

    Raises SessionError if the session cannot succeed, its kind Killed if it may succeed elsewhere, Stopped on demand.
    """
    check_files(session)
    return row_of(session, headless.perform(arguments_of(session), stopped))


def row_of(session, outcome):
    row = {"scene": session.scene, "mesh": session.mesh, "novice": text(session.novice), "seed": str(session.seed)}
    row.update((name, text(measure["value"])) for name, measure in outcome["measures"].items())
    row["state_hash"] = outcome["state_hash"]
    return list(row), list(row.values())
