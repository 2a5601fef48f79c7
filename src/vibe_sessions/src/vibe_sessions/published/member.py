"""The files of one session of a published set; made on this machine or on a worker, to the same bytes."""
import dataclasses
import json
import os
import shutil

import numpy

from vibe_sessions import headless
from vibe_sessions.cohort_session import arguments_of, check_files, row_of
from vibe_sessions.headless import SessionError
from vibe_sessions.imports.resampling import scene_facts
from vibe_sessions.imports.session import record, write_commands
from vibe_sessions.whole_file import open_whole

SIZE = ("--width", "320", "--height", "240")  # of pictures [px]
CONTENT = "depth,labels,particles"  # beside pictures


def make_member(session, stopped, folder, rate):
    """Makes FOLDER/sessions/KEY as a whole, and returns the row of the session."""
    check_files(session)
    making, made = os.path.join(folder, ".making-" + session.key), os.path.join(folder, "sessions", session.key)
    for left in (making, made):  # by a call that was killed before it had its row
        shutil.rmtree(left, ignore_errors=True)
    os.makedirs(making)
    try:
        outcome = perform(session, stopped, making)
        headless.call([os.path.join(making, "session.bag"), "--output", os.path.join(making, "images"), "--rate", str(rate),
                       "--content", CONTENT, *SIZE], stopped, headless.find_program("vibe_bringup", "dataset"))
        os.makedirs(os.path.dirname(made), exist_ok=True)
        os.replace(making, made)
    finally:
        shutil.rmtree(making, ignore_errors=True)
    return row_of(dataclasses.replace(session, scene=os.path.basename(session.scene)), outcome)


def perform(session, stopped, folder):
    """The session itself with its tables, and again as a recording, which must end in the same state."""
    place = lambda name: os.path.join(folder, name)  # noqa: E731
    tables = ["--csv", place("steps.csv"), "--inputs", place("inputs.csv"), "--contacts", place("contacts.csv")]
    outcome = headless.perform([*arguments_of(session), *tables], stopped)
    with open_whole(place("measures.json")) as file:
        json.dump(outcome, file, indent=1)
    inputs = numpy.loadtxt(place("inputs.csv"), delimiter=",", skiprows=1, ndmin=2)
    write_commands(place("commands.bag"), session.scene, scene_facts(session.scene)[0], inputs[:, 1:8],
                   inputs[:, 8:].astype(numpy.uint8), session.seed)
    found = record(folder, stopped)
    if found != outcome["state_hash"]:
        raise SessionError(f"The recording ends in the state {found}, and the session in {outcome['state_hash']}; vibe_core and "
                           "vibe_sim may be of different builds.")
    for name in ("commands.bag", "summary.txt"):  # the recording has the one, and the other has times of this machine
        os.remove(place(name))
    return outcome
