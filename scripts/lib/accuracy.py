"""Measures accuracy and speed, and writes the tables of the pages from what was measured; called by scripts/accuracy.

docs/measured holds a table per section; each of its rows says when, with which version and on what it was measured, and
the state of the guard then. The guard is a handful of states of contact on a coarse mesh, seconds long. While its
errors are the stored ones, what was measured with them holds; when they change, all that is not measured again is
marked as being of an older version in the pages.
"""

import argparse
import datetime
import os
import re
import signal
import subprocess
import sys

import measured_experiments  # noqa: F401: its tables enter themselves in TABLES
import measured_pages
import measured_policy  # noqa: F401: likewise
import measured_sessions  # noqa: F401: likewise
import measured_steps  # noqa: F401: likewise
from measured_sections import SESSION_TEXT, Runner, sections
from measured_store import GUARD, ITSELF, Store, differences, open_whole
from measured_tables import TABLES, block


class Work:
    def __init__(self, arguments):
        self.root, self.devel = arguments.root, arguments.devel or os.path.join(arguments.root, "devel")
        self.sections = sections(self.root, arguments.mesh)
        self.store = Store(arguments.results or os.path.join(self.root, "docs", "measured"))
        self.runner = Runner(self.root, self.devel, sys.stderr if arguments.verbose else subprocess.DEVNULL)

    def parts(self, quick=None):
        return [(section, part) for section in self.sections for part in section.parts if quick in (None, part.quick)]

    def rows_of(self, section, part):
        return [row for row in self.store.rows(section.name) if row["part"] == part.name]

    def is_due(self, section, part):
        rows = self.rows_of(section, part)
        return not rows or any(self.store.is_old(row) for row in rows)


def git(root, *words):
    """What git says; nothing where there is no repository."""
    done = subprocess.run(["git", "-C", root, *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return done.stdout.strip()


def version(root):
    """Version and commit; a + where sources differ from the commit."""
    with open(os.path.join(root, "src/vibe_core/package.xml"), encoding="utf-8") as text:
        number = re.search(r"<version>(.*?)</version>", text.read()).group(1)
    commit = git(root, "rev-parse", "--short=8", "HEAD")
    changed = "+" if git(root, "status", "--porcelain", "--", "src", ":!*.py", ":!*.md", ":!*.rst") else ""
    return "{} ({}{})".format(number, commit, changed) if commit else number


def cores():
    return len(os.sched_getaffinity(0))


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        found = re.search(r"^model name\s*: (.*)$", text.read(), re.MULTILINE)
    return "{}, {} cores".format(found.group(1) if found else os.uname().machine, cores())


def stamped(work, part, rows, seconds):
    stamp = {
        "part": part.name,
        "date": datetime.date.today().isoformat(),
        "version": version(work.root),
        "machine": machine(),
        "load": "{:.1f}".format(os.getloadavg()[1]),
        "cpu_s": "{:.1f}".format(seconds),
        "command": " ".join(os.path.basename(word) if os.path.isabs(word) else word for word in part.words),
    }
    return [{**row, **stamp} for row in rows]


def measure(work, section, part):
    print("{} {}: about {:g} min".format(section.name, part.name, part.minutes), end="", flush=True)
    rows, seconds, said = work.runner.run(part)
    print(", took {:.0f} s of processor time".format(seconds), flush=True)
    if (section.name, part.name) == ("sessions", "first"):
        os.makedirs(work.store.folder, exist_ok=True)
        with open_whole(os.path.join(work.store.folder, SESSION_TEXT)) as text:
            text.write(said)
    return stamped(work, part, rows, seconds)


def keep(work, section, part, rows):
    epoch = ITSELF if section.name == GUARD else work.store.epoch
    imported = [row["part"] for row in work.store.rows(section.name) if row["part"].startswith("imported_")]
    order = list(dict.fromkeys([*(one.name for one in section.parts), *imported]))
    work.store.replace(section.name, order, part.name, [{**row, "epoch": epoch} for row in rows])


def measure_guard(work):
    """The quick parts; where errors have changed, they are stored anew. Sentences on what has."""
    found = []
    for section, part in work.parts(quick=True):
        fresh = measure(work, section, part)
        changed = list(differences(section, work.rows_of(section, part), fresh))
        found += changed
        if changed or work.is_due(section, part):
            keep(work, section, part, fresh)
    return found


def is_wanted(section, part, wanted):
    return not wanted or section.name in wanted or "{}/{}".format(section.name, part.name) in wanted


def measure_all(work, wanted, again):
    """Exit status: 1 if a part failed; the others are measured all the same."""
    for sentence in measure_guard(work):
        print("changed: " + sentence)
    status = 0
    for section, part in work.parts(quick=False):
        if is_wanted(section, part, wanted) and (again or work.is_due(section, part)):
            if part.cores > cores():
                print("{} {}: left out, needs {} cores".format(section.name, part.name, part.cores))
                continue
            try:
                keep(work, section, part, measure(work, section, part))
                render(work)
            except subprocess.CalledProcessError as failure:
                print(", FAILED with status {}; --verbose shows what it says".format(failure.returncode), flush=True)
                status = 1
    render(work)
    return status


def pages(work):
    for name in measured_pages.PAGES:
        with open(os.path.join(work.root, name), encoding="utf-8") as text:
            yield name, text.read()


def render(work):
    for name, text in pages(work):
        filled = measured_pages.fill(text, lambda name: block(work.store, name))
        if filled != text:
            with open_whole(os.path.join(work.root, name)) as out:
                out.write(filled)


def page_problems(work):
    """Sentences on tables that are not what the result files say, not in a page, or typed by hand."""
    shown = set()
    for name, text in pages(work):
        for one, stands in measured_pages.blocks(text):
            shown.add(one)
            if one not in TABLES:
                yield "{}: there is no table '{}'".format(name, one)
            elif block(work.store, one) != stands:
                text = "{}: the table '{}' is not what docs/measured holds; scripts/accuracy --render writes it"
                yield text.format(name, one)
        if name == measured_pages.STRICT:
            for line, heading in measured_pages.unmarked_tables(text):
                yield "{}:{}: a table below '{}' that no script makes".format(name, line, heading)
    for one in sorted(set(TABLES) - shown):
        yield "the table '{}' stands in no page".format(one)


def check(work, wanted, pages_only):
    """Prints what is not as stored. Exit status."""
    problems = list(page_problems(work))
    for section, part in [] if pages_only else work.parts(quick=True):
        if is_wanted(section, part, wanted):
            problems += differences(section, work.rows_of(section, part), work.runner.run(part)[0])
    print("\n".join(problems) or "nothing differs")
    return 1 if problems else 0


def show(work):
    for section in work.sections:
        print("{}: {}".format(section.name, section.about))
        for part in section.parts:
            rows = work.rows_of(section, part)
            state = "not measured" if not rows else "{} {}{}".format(
                rows[0]["date"], rows[0]["version"], ", OLDER than the code" if work.is_due(section, part) else "")
            print("  {:24} {:5.1f} min  {}{}".format(part.name, part.minutes, state, ", quick" if part.quick else ""))


def parse(words):
    line = argparse.ArgumentParser(prog="accuracy.py", allow_abbrev=False)
    line.add_argument("--root", required=True)
    line.add_argument("--devel")
    line.add_argument("--results")
    line.add_argument("--mesh", action="append", default=[])
    line.add_argument("--section", action="append", default=[])
    for flag in ("--again", "--verbose", "--list", "--render", "--check", "--check-pages"):
        line.add_argument(flag, action="store_true")
    return line.parse_args(words)


def main(words):
    arguments = parse(words)
    work = Work(arguments)
    known = {name for section, part in work.parts() for name in (section.name, section.name + "/" + part.name)}
    unknown = sorted(set(arguments.section) - known)
    if unknown:
        print("accuracy: there is no section '{}' (--list prints them)".format(unknown[0]), file=sys.stderr)
        return 2
    if arguments.list:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # of a reader that has seen enough
        show(work)
    elif arguments.check or arguments.check_pages:
        return check(work, arguments.section, arguments.check_pages)
    elif arguments.render:
        render(work)
    else:
        return measure_all(work, arguments.section, arguments.again)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
    except subprocess.CalledProcessError as failure:  # of the guard: nothing can be said without it
        sys.exit("accuracy: {} failed; --verbose shows what it says".format(os.path.basename(failure.cmd[0])))
