"""What a finished test has shown: its cases, as its result file or its lines tell them.

A result file is that of gtest or of catkin's rostests. A test that failed without a failed case in it (a crash, a
timeout) counts as one failure, and so does a test that passed without any case. A test without a result file is one
case. A script prints `ok NAME`, `not ok NAME` and `skipped SENTENCE`.
"""

import re
import signal
import xml.etree.ElementTree as ElementTree


class Result:
    """Counts of cases, the names of those that failed, and the sentences of those that were skipped."""

    def __init__(self):
        self.passed = 0
        self.failures = []
        self.skipped = []

    def add(self, name, state, sentence=""):
        if state == "passed":
            self.passed += 1
        elif state == "failed":
            self.failures.append(name)
        else:
            self.skipped.append(sentence or name)

    def cases(self):
        return self.passed + len(self.failures) + len(self.skipped)


def file_cases(path):
    """Yields (name, state, sentence) for every case in a result file; nothing where there is no readable file."""
    try:
        tree = ElementTree.parse(path)
    except (OSError, ElementTree.ParseError):
        return
    for case in tree.iter("testcase"):
        name = "{}.{}".format(case.get("classname", ""), case.get("name", "")).strip(".")
        skipped = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            yield name, "failed", ""
        elif skipped is not None:
            said = (skipped.get("message") or skipped.text or "").strip().splitlines()
            yield name, "skipped", said[-1].strip() if said else ""
        elif case.get("status") == "notrun":
            yield name, "skipped", ""
        else:
            yield name, "passed", ""


def end_of(run):
    """How a run ended, in words."""
    if run.timed_out:
        return "did not end within {:.0f} s and was stopped".format(run.test.timeout)
    if run.status < 0:
        return "was ended by {}".format(signal.Signals(-run.status).name)
    return "ended with status {}".format(run.status)


def package_result(run):
    """The result of a test of a package."""
    result, succeeded = Result(), run.status == 0 and not run.timed_out
    if run.test.result_file:
        for case in file_cases(run.test.result_file):
            result.add(*case)
        if succeeded and not result.cases():
            result.failures.append("no case in it")
    elif succeeded:
        result.passed = 1
    if not succeeded and not result.failures:
        result.failures.append(end_of(run))
    return result


def script_result(run):
    """The result of a script."""
    result = Result()
    with open(run.log, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            found = re.match(r"(ok|not ok|skipped) (.*)", line)
            if found:
                state = {"ok": "passed", "not ok": "failed", "skipped": "skipped"}[found.group(1)]
                result.add(found.group(2), state)
    if run.status != 0 or run.timed_out or not result.cases():
        without = "" if result.passed or result.failures else " without a check"
        result.failures.append(end_of(run) + without)
    return result


def result_of(run):
    return script_result(run) if run.test.is_script else package_result(run)
