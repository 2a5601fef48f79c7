"""Options of the reports, and their checks. Standard library only: a call is checked before anything is built."""

import argparse
import re
import sys

KEYS = ("folder", "person", "scene", "skill", "driver", "version")
DESCRIPTION = """\
Writes a report of recorded sessions: a page (HTML, in one file), all numbers (sessions.json) and one row per session
(sessions.csv). One recording gives one page; several give a page with a table and distributions, and one page each."""
EPILOG = """\
A recording that was cut off (session.bag.active of a killed recorder) is read as far as it goes. Ends with status 0 if
all recordings could be read, 1 if some could not, 2 on a wrong call."""


class Parser(argparse.ArgumentParser):
    """Errors in the words of the other scripts."""

    def error(self, message):
        print("{}: {} (--help lists what there is)".format(self.prog, message), file=sys.stderr)
        sys.exit(2)


def count(text):
    if not re.fullmatch("[1-9][0-9]{0,5}", text):
        raise argparse.ArgumentTypeError("needs a number above zero, not '{}'".format(text))
    return int(text)


def add_options(made):
    made.add_argument("bags", nargs="*", metavar="BAG", help="a recording, or a folder with recordings below it")
    made.add_argument("--output", metavar="DIR", help="folder to write to (default: NAME_report beside the only "
                      "recording, else report in the present folder)")  # fmt: skip
    made.add_argument("--group", action="append", default=[], metavar="GROUP", help="how to group sessions: folder "
                      "(the first below the folder that all share), person, scene, skill, driver or version; or NAME=PATTERN for "
                      "the recordings whose path fits the pattern, may be repeated")  # fmt: skip
    made.add_argument("--no-pages", action="store_true", help="no page per session, which is faster")
    made.add_argument("--jobs", type=count, default=0, metavar="N", help="worker processes (default: one per core)")
    made.add_argument("--session", metavar="S", help="which session of a recording of several: its number in the list "
                      "of scripts/replay --list, or the beginning of its identity (default: the first)")  # fmt: skip
    made.add_argument("--namespace", metavar="NS", help="the first session in this namespace, for recordings of several "
                      "simulators")  # fmt: skip


def parser():
    made = Parser(
        prog="report", usage="rosrun vibe_sessions report [options] BAG...", description=DESCRIPTION, epilog=EPILOG,
        allow_abbrev=False, add_help=False, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    add_options(made)
    made.add_argument("--help", action="help", help="print this text and end")
    return made


def check(arguments, fail):
    if not arguments.bags:
        fail("which recording?")
    keys = [group for group in arguments.group if "=" not in group]
    for key in keys:
        if key not in KEYS:
            fail("--group: '{}' is neither {} nor NAME=PATTERN".format(key, ", ".join(KEYS)))
    if keys and len(arguments.group) > 1:
        fail("--group: give one of {}, or any number of NAME=PATTERN, not both".format(", ".join(KEYS)))
