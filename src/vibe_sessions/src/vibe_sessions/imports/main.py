"""Imports a recorded motion as a session."""
import argparse
import os
import sys

import yaml

from vibe_sessions.cohort_options import _Parser
from vibe_sessions.headless import SessionError, status_of
from vibe_sessions.imports.map_file import read_map
from vibe_sessions.imports.motion_file import open_motion
from vibe_sessions.imports.resampling import inputs_of
from vibe_sessions.imports.session import record, write_commands
from vibe_sessions.whole_file import open_whole

DESCRIPTION = """\
Moves the scope as a person or another robot moved: a CSV or a bag, of which a map (YAML) says what moves which joint, in
which unit. DIR gets commands.bag, session.bag, a report, and import.txt: what was not used, left out or clamped. Pages:
docs/import.md."""
EPILOG = "Exit status: 0; 1 if the session or its report failed; 2 if motion, map or call are wrong; 130 if interrupted."


def parse(words):
    parser = _Parser(prog="import", allow_abbrev=False, description=DESCRIPTION, epilog=EPILOG)
    parser.add_argument("motion", metavar="FILE", help="a CSV with a line of names, or a bag")
    parser.add_argument("--map", metavar="FILE", required=True, help="what its columns or topics mean")
    parser.add_argument("--output", metavar="DIR", required=True, help="folder to write to; new or empty")
    return parser.parse_args(words)


def perform(options):
    made = read_map(options.map)
    motion = open_motion(options.motion, made.time)
    notes = list(motion.notes)
    period, joints, buttons = inputs_of(motion, made, notes)
    notes += motion.unused()
    os.makedirs(options.output, exist_ok=True)
    if os.listdir(options.output):
        raise SessionError(f"'{options.output}' is not empty; name another folder.")
    place = lambda name: os.path.join(options.output, name)  # noqa: E731
    print("".join(f"import: {note}\n" for note in notes), end="", file=sys.stderr, flush=True)
    with open_whole(place("import.txt")) as file:
        file.writelines(f"{note}\n" for note in notes)
    about = {"notes": f"imported from {os.path.basename(options.motion)} by {os.path.basename(options.map)}"}
    with open_whole(place("session.about.yaml")) as file:
        yaml.safe_dump(about, file, allow_unicode=True)
    write_commands(place("commands.bag"), made.scene, period, joints, buttons)
    print(f"{len(joints)} steps, {len(joints) * period:.2f} s")
    print(f"state hash: {record(options.output)}", flush=True)
    from vibe_sessions.report.main import main as report  # takes a second to import
    return report([place("session.bag")])


def main(words):
    options = parse(words)
    return status_of("import", lambda: perform(options), f"remove '{options.output}' and call again")
