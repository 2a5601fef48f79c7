"""Command line of the reports."""

import argparse
import contextlib
import fnmatch
import glob
import os
import sys
import tempfile
import time

from .output import Output
from .session_work import Task, names_of, page_names, report_on
from .workers import run_all

KEYS = ("folder", "scene", "skill", "driver", "version")
DESCRIPTION = """\
Writes a report of recorded sessions: a page (HTML, in one file), all numbers (sessions.json) and one row per session
(sessions.csv). One recording gives one page; several give a page with a table and distributions, and one page each."""
EPILOG = """\
A recording that was cut off (session.bag.active of a killed recorder) is read as far as it goes. Ends with status 0 if
all recordings could be read, 1 if some could not, 2 on a wrong call."""


class Parser(argparse.ArgumentParser):
    """Errors in the words of the other scripts."""

    def error(self, message):
        print("report: {} (scripts/report --help lists what there is)".format(message), file=sys.stderr)
        sys.exit(2)


def parser():
    made = Parser(
        prog="scripts/report", usage="scripts/report [options] BAG...", description=DESCRIPTION, epilog=EPILOG,
        allow_abbrev=False, add_help=False, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    made.add_argument("bags", nargs="*", metavar="BAG", help="a recording, or a folder with recordings below it")
    made.add_argument("--output", metavar="DIR", help="folder to write to (default: NAME_report beside the only "
                      "recording, else report in the present folder)")  # fmt: skip
    made.add_argument("--group", action="append", default=[], metavar="GROUP", help="how to group sessions: folder "
                      "(the first below the folder that all share), scene, skill, driver or version; or NAME=PATTERN for "
                      "the recordings whose path fits the pattern, may be repeated")  # fmt: skip
    made.add_argument("--no-pages", action="store_true", help="no page per session, which is faster")
    made.add_argument("--jobs", type=int, default=0, metavar="N", help="worker processes (default: one per core)")
    made.add_argument("--namespace", metavar="NS", help="of the session, for recordings of several simulators")
    made.add_argument("--help", action="help", help="print this text and end")
    return made


def check(arguments, fail):
    if not arguments.bags:
        fail("which recording?")
    if arguments.jobs < 0:
        fail("--jobs needs a number above zero, not '{}'".format(arguments.jobs))
    keys = [group for group in arguments.group if "=" not in group]
    for key in keys:
        if key not in KEYS:
            fail("--group: '{}' is neither {} nor NAME=PATTERN".format(key, ", ".join(KEYS)))
    if keys and len(arguments.group) > 1:
        fail("--group: give one of {}, or any number of NAME=PATTERN, not both".format(", ".join(KEYS)))


def find_bags(arguments, fail):
    """The recordings, those in folders included, each once. A path that does not exist is kept and gets its sentence."""
    found = []
    for path in arguments.bags:
        if os.path.isdir(path):
            inside = sorted(glob.glob(os.path.join(glob.escape(path), "**", "*.bag*"), recursive=True))
            inside = [each for each in inside if each.endswith((".bag", ".bag.active"))]
            if not inside:
                fail("there is no recording (*.bag) in the folder '{}'".format(path))
            found += inside
        else:
            found.append(path)
    seen = set()
    return [path for path in found if not (os.path.realpath(path) in seen or seen.add(os.path.realpath(path)))]


def groups_of(arguments, paths):
    """Names of groups by the path; those by what is in the recording are put in later."""
    if arguments.group == ["folder"]:
        full = [os.path.dirname(os.path.abspath(path)) for path in paths]
        common = os.path.commonpath(full)
        first = [os.path.relpath(folder, common).split(os.sep)[0] for folder in full]
        return ["" if name == "." else name for name in first]
    pairs = [group.split("=", 1) for group in arguments.group if "=" in group]
    return [next((name for name, pattern in pairs if fnmatch.fnmatch(path, pattern)), "") for path in paths]


def default_output(paths):
    if len(paths) > 1:
        return "report"
    for ending in (".active", ".bag"):
        if paths[0].endswith(ending):
            paths = [paths[0][: -len(ending)]]
    return paths[0] + "_report"


def tasks_of(arguments, paths, folder):
    names, groups = names_of(paths), groups_of(arguments, paths)
    single = len(paths) == 1
    pages = ["index.html"] if single else page_names(names)
    return [
        Task(path, name, group, arguments.namespace,
             "" if arguments.no_pages else os.path.join(folder, page), "" if single else "index.html")
        for path, name, group, page in zip(paths, names, groups, pages)
    ]  # fmt: skip


class Progress:
    """One line on stderr that is written over, or one per minute where it would not be."""

    def __init__(self, total):
        self._total, self._begin, self._said = total, time.monotonic(), 0.0

    def show(self, done, failed):
        now = time.monotonic()
        live = sys.stderr.isatty()
        if self._total == 1 or now - self._said < (0.2 if live else 60) and done < self._total:
            return
        self._said = now
        left = (now - self._begin) / done * (self._total - done)
        text = "report: {} of {} sessions, {} not read, {:.0f} s left".format(done, self._total, failed, left)
        print("\r\033[K" + text if live else text, end="\n" if not live or done == self._total else "", file=sys.stderr,
              flush=True)  # fmt: skip


def remove_old(folder):
    """What an earlier call wrote is not the report of this one."""
    for name in ("index.html", "sessions.csv", "sessions.json"):
        with contextlib.suppress(FileNotFoundError):
            os.remove(os.path.join(folder, name))


def run(arguments, paths, folder):
    """Whether all could be read."""
    with tempfile.TemporaryDirectory(prefix="vibe_report_") as scratch:
        tempfile.tempdir = scratch  # where workers, which end without cleaning up, write the classes of messages
        try:
            return run_in(arguments, paths, folder)
        finally:
            tempfile.tempdir = None


def run_in(arguments, paths, folder):
    key = arguments.group[0] if arguments.group and arguments.group[0] in KEYS[1:] else None
    tasks = tasks_of(arguments, paths, folder)
    remove_old(folder)
    progress = Progress(len(tasks))
    with Output(folder, len(tasks)) as output:
        jobs = min(arguments.jobs or len(os.sched_getaffinity(0)), len(tasks))
        for number, succeeded, result in run_all(tasks, report_on, jobs):
            if not succeeded:
                result = None, None, "{}: could not be reported on ({})".format(tasks[number].path, result)
            row, numbers, problem = result
            if row is not None and key:
                row["group"] = str(row[key]) if row[key] is not None else ""
            output.add(number, row, numbers, problem)
            if problem:
                print("report: " + problem, file=sys.stderr)
            progress.show(output.done, len(output.failures))
        output.write(with_index=len(tasks) > 1)
        return not output.failures


def main(words=None):
    made = parser()
    arguments = made.parse_args(words)
    check(arguments, made.error)
    paths = find_bags(arguments, made.error)
    folder = arguments.output or default_output(paths)
    try:
        os.makedirs(folder, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError
    except OSError:
        made.error("--output: cannot write to '{}'".format(folder))
    try:
        good = run(arguments, paths, folder)
    except KeyboardInterrupt:
        print("\nreport: interrupted; the pages that are finished are in {}".format(folder), file=sys.stderr)
        return 130
    shown = os.path.join(folder, "index.html")
    if good or len(paths) > 1:
        print(shown if os.path.exists(shown) else os.path.join(folder, "sessions.csv"))
    return 0 if good else 1
