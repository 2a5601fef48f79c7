"""Counts the test cases that one run of ctest made, and names those that failed.

ctest knows one test per executable; the result files that catkin's tests write know the cases inside. A test that
ctest calls failed without a failed case in its file (a crash, a timeout) counts as one failure, and so does a test
that passed without any case in it. Prints `passed failed skipped` on the first line, then one name per failure.

Usage: count_tests.py BUILD_DIR CTEST_JUNIT_XML
"""

import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree


def result_files(build_dir):
    """The result file of each ctest test; None for a test that writes none."""
    listing = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build_dir, check=True, stdout=subprocess.PIPE)
    files = {}
    for test in json.loads(listing.stdout)["tests"]:
        inside = [word for word in test.get("command", []) if "/test_results/" in word and word.endswith(".xml")]
        files[test["name"]] = inside[0] if inside else None
    return files


def cases(path):
    """Yields (name, state) for every case in a result file; nothing where there is no readable file."""
    try:
        tree = ElementTree.parse(path)
    except (OSError, ElementTree.ParseError):
        return
    for case in tree.iter("testcase"):
        name = "{}.{}".format(case.get("classname", ""), case.get("name", "")).strip(".")
        if case.find("failure") is not None or case.find("error") is not None:
            yield name, "failed"
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            yield name, "skipped"
        else:
            yield name, "passed"


def count(build_dir, junit):
    """Returns ({state: number}, [names of the failures])."""
    totals = {"passed": 0, "failed": 0, "skipped": 0}
    failures = []
    files = result_files(build_dir)
    for test in ElementTree.parse(junit).iter("testcase"):
        name, succeeded = test.get("name"), test.get("status") == "run"
        path = files.get(name)
        found = list(cases(path)) if path else [(name, "passed" if succeeded else "failed")]
        for case, state in found:
            totals[state] += 1
            if state == "failed":
                failures.append("{}: {}".format(name, case))
        explained = any(state == "failed" for _, state in found)
        if (succeeded and not found) or (not succeeded and not explained):
            totals["failed"] += 1
            failures.append("{}: {}".format(name, "no case in it" if succeeded else "ended badly"))
    return totals, failures


def main():
    build_dir, junit = sys.argv[1:]
    if not os.path.isfile(junit):
        print("0 0 0")
        return
    totals, failures = count(build_dir, junit)
    print(totals["passed"], totals["failed"], totals["skipped"])
    for failure in failures:
        print(failure)


if __name__ == "__main__":
    main()
