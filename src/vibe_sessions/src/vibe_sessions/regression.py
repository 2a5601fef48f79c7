"""Regressions written as YAML: the command line, for people and for rostest."""
import os
import sys
import time
import xml.etree.ElementTree as ElementTree

from vibe_sessions.headless import SessionError
from vibe_sessions.regression_file import read_regression
from vibe_sessions.regression_run import known_measures, perform
from vibe_sessions.regression_units import show
from vibe_sessions.regression_verdict import judge, table
from vibe_sessions.whole_file import open_whole

USAGE = """Usage: rosrun vibe_sessions regression [--update] FILE...
Runs the scenes of regressions (docs/cohorts.md) and compares their measures with what each FILE expects.

  --update                 write the present values into the files; tolerances, limits and comments stay
  --gtest_output=xml:FILE  write the verdicts there too; rostest asks for it
  --help                   print this text and end

Exit status: 0; 1 if something has moved beyond its tolerance; 2 if a file or the call is wrong.
"""


class Result:
    """Of one file: verdicts, or the sentence that says why there are none."""

    def __init__(self, file):
        self.file, self.verdicts, self.error, self.seconds = file, [], "", 0.0

    def name(self):
        return os.path.basename(self.file).removesuffix(".yaml").removesuffix(".regression")


def updated(regression, values, state_hash):
    """The text of the file with the present values."""
    text = regression.text
    for e in sorted((e for e in regression.expect if e.place), key=lambda e: -e.place[0]):
        begin, end = e.place
        if e.digest:
            new = f'"{state_hash}"'
        elif values[e.name][0] is None:
            raise SessionError(f"{regression.file}: '{e.name}' has no value in this session; remove it.")
        else:
            new = show(values[e.name][0], e.unit, 5) if e.tolerance else f"{values[e.name][0]:.0f}"
        text = text[:begin] + new + text[end:]
    return text


def write_update(regression, values, state_hash):
    text = updated(regression, values, state_hash)
    try:
        with open_whole(regression.file) as stream:
            stream.write(text)
    except OSError as error:
        raise SessionError(f"{regression.file}: cannot be written: {error.strerror}.") from None


def run_one(file, known, update):
    result, start = Result(file), time.monotonic()
    try:
        regression = read_regression(file, known)
        values, state_hash = perform(regression)
        result.verdicts = judge(regression, values, state_hash)
        if update:
            write_update(regression, values, state_hash)
    except SessionError as error:
        result.error = str(error)
    result.seconds = time.monotonic() - start
    return result


def print_result(result, update):
    if result.error:
        print(f"regression: {result.error}", file=sys.stderr, flush=True)
        return
    failed = sum(not v.passed for v in result.verdicts)
    if update:
        verdict = f"{failed} of {len(result.verdicts)} beyond the old tolerances, all values written"
    else:
        verdict = f"{failed} of {len(result.verdicts)} FAILED" if failed else f"all {len(result.verdicts)} ok"
    print(f"{result.file}: {verdict}, {result.seconds:.1f} s\n{table(result.verdicts)}", flush=True)


def write_xml(file, results):
    """One test case per expectation, as rostest reads them."""
    cases = [(r, v) for r in results for v in r.verdicts]
    errors, failures = sum(bool(r.error) for r in results), sum(not v.passed for _, v in cases)
    suite = ElementTree.Element("testsuite", name="regression", tests=str(len(cases) + errors), errors=str(errors),
                                failures=str(failures), time=f"{sum(r.seconds for r in results):.3f}")
    for result, verdict in cases:
        share = result.seconds / len(result.verdicts)
        case = ElementTree.SubElement(suite, "testcase", classname=f"regression.{result.name()}", name=verdict.name,
                                      time=f"{share:.3f}")
        if not verdict.passed:
            ElementTree.SubElement(case, "failure", type="moved", message=verdict.sentence()).text = verdict.sentence()
    for result in (r for r in results if r.error):
        case = ElementTree.SubElement(suite, "testcase", classname=f"regression.{result.name()}", name="file",
                                      time=f"{result.seconds:.3f}")
        ElementTree.SubElement(case, "error", type="file", message=result.error).text = result.error
    os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
    ElementTree.ElementTree(suite).write(file, encoding="utf-8", xml_declaration=True)


def parse(arguments):
    """(files, update, file of the XML); ends the program for --help and wrong calls."""
    files, update, xml = [], False, ""
    for argument in (a for a in arguments if ":=" not in a):  # names that roslaunch gives to nodes
        if argument == "--help":
            print(USAGE, end="")
            sys.exit(0)
        elif argument == "--update":
            update = True
        elif argument.startswith("--gtest_output=xml:"):
            xml = argument.split(":", 1)[1]
        elif argument.startswith("-"):
            sys.exit(_wrong(f"unknown option '{argument}'"))
        else:
            files.append(argument)
    if not files:
        sys.exit(_wrong("which file?"))
    return files, update, xml


def _wrong(what):
    print(f"regression: {what} (--help lists what there is)", file=sys.stderr)
    return 2


def main(arguments):
    files, update, xml = parse(arguments)
    results = []
    try:
        known = known_measures()
    except SessionError as error:
        print(f"regression: {error}", file=sys.stderr)
        return 2
    for file in files:
        results.append(run_one(file, known, update))
        print_result(results[-1], update)
    if xml:
        write_xml(xml, results)
    if any(r.error for r in results):
        return 2
    return 0 if update or all(v.passed for r in results for v in r.verdicts) else 1
