"""Reports of some recordings: finding them, and the work on each."""

import contextlib
import fnmatch
import glob
import os
import sys
import tempfile
import time

from .options import KEYS, check, parser
from .output import Output
from .session_work import Task, names_of, page_names, report_on
from .workers import run_all

COMPARED = 8  # sessions at most, for which there are colours


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
    single, few = len(paths) == 1, 1 < len(paths) <= COMPARED
    pages = ["index.html"] if single else page_names(names)
    return [
        Task(path, name, group, arguments.namespace,
             "" if arguments.no_pages else os.path.join(folder, page), "" if single else "index.html",
             arguments.session, few)
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
                result = None, None, "{}: could not be reported on ({})".format(tasks[number].path, result), None
            row, numbers, problem, trace = result
            if row is not None and key:
                row["group"] = str(row[key]) if row[key] is not None else ""
            output.add(number, row, numbers, problem, trace)
            if problem:
                print("report: " + problem, file=sys.stderr)
            progress.show(output.done, len(output.failures))
        output.write(with_index=len(tasks) > 1)
        return not output.failures


def report(arguments, fail):
    """Returns the exit status, and what to look at, or None."""
    paths = find_bags(arguments, fail)
    folder = arguments.output or default_output(paths)
    try:
        os.makedirs(folder, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError
    except OSError:
        fail("--output: cannot write to '{}'".format(folder))
    try:
        good = run(arguments, paths, folder)
    except KeyboardInterrupt:
        print("\nreport: interrupted; the pages that are finished are in {}".format(folder), file=sys.stderr)
        return 130, None
    shown = os.path.join(folder, "index.html")
    if not os.path.exists(shown):
        shown = os.path.join(folder, "sessions.csv")
    return (0 if good else 1), (shown if good or len(paths) > 1 else None)


def main(words=None):
    made = parser()
    arguments = made.parse_args(words)
    check(arguments, made.error)
    status, shown = report(arguments, made.error)
    if shown:
        print(shown)
    return status
