"""What a finished test has shown: its cases, as its result file or its lines tell them.

A result file is that of gtest or of catkin's rostests. A test without a result file is one case. A script prints
`ok NAME`, `not ok NAME` and `skipped SENTENCE`.
"""

import re


END = "run_test: "  # begins the last line of a test that has failed


class Result:
    """The names of cases by how they ended; of those that were skipped, the sentences."""

    def __init__(self, cases):
        cases = list(cases)
        self.passed = sum(state == "passed" for _, state in cases)
        self.failures = [name for name, state in cases if state == "failed"]
        self.skipped = [name for name, state in cases if state == "skipped"]

    def is_good(self):
        return not self.failures and bool(self.passed or self.skipped)


def cases_of_file(path):
    """Yields (name, state) for every case in a result file; nothing where there is no readable file."""
    import xml.etree.ElementTree as ElementTree  # takes long, and most tests of a run need it once

    try:
        tree = ElementTree.parse(path)
    except (OSError, ElementTree.ParseError):
        return
    for case in tree.iter("testcase"):
        name = "{}.{}".format(case.get("classname", ""), case.get("name", "")).strip(".")
        skipped = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            yield name, "failed"
        elif skipped is not None or case.get("status") == "notrun":
            said = "" if skipped is None else (skipped.get("message") or skipped.text or "").strip()
            yield said.splitlines()[-1].strip() if said else name, "skipped"
        else:
            yield name, "passed"


def cases_of_lines(path):
    """The same for the lines of a script."""
    states = {"ok": "passed", "not ok": "failed", "skipped": "skipped"}
    with open(path, encoding="utf-8", errors="replace") as lines:
        for found in filter(None, (re.match(r"(ok|not ok|skipped) (.*)", line) for line in lines)):
            yield found.group(2), states[found.group(1)]


def end_of(log, timeout):
    """How a test ended that has failed as a whole: the last line of its log says it unless it was stopped."""
    with open(log, encoding="utf-8", errors="replace") as text:
        last = (text.read().splitlines() or [""])[-1]
    return last[len(END) :] if last.startswith(END) else "did not end within {:.0f} s and was stopped".format(timeout)


def read(log, result_file):
    """The result of a run; `result_file` is "lines" for a script, and empty for a test without cases."""
    if result_file:
        return Result(cases_of_lines(log) if result_file == "lines" else cases_of_file(result_file))
    return Result([("", "passed")])
