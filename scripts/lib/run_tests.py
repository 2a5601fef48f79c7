"""Runs the tests of a workspace that is built; called by scripts/test.

Tests that compute and tests that wait run side by side. What fails there is run once more, alone. Tests that judge
times run after them, one after the other. See 'Tests' in CONTRIBUTING.md.
"""

import argparse
import json
import os
import re
import shutil
import sys
import tempfile

import test_list
import test_report
from test_pool import Interrupted, Pool
from test_report import say
from test_results import result_of

UNITS_OF_A_CORE = 2
MOST_UNSTABLE = 3
MOST_REPEATED = 10  # where more fail, the reason is no accident, and to run them one by one would take long
TIMES = "seconds.json"  # in the folder of the logs: how long each test took when it last passed


class Suite:
    """Runs of tests and what they have shown."""

    def __init__(self, pool, total, retry, verbose):
        self.pool, self.total, self.retry, self.verbose = pool, total, retry, verbose
        self.runs = []
        self.outcomes = {}  # name -> (run, result) of the run that counts
        self.unstable = []  # (first run, second run)

    def first_time(self, tests, alone):
        """Runs tests, and returns those runs that failed."""
        failed = []
        for run in self.pool.run(tests, alone=alone):
            place = "[{:>{}}/{}]".format(len(self.outcomes) + 1, len(str(self.total)), self.total)
            if self.take(run, place, "ok", "FAILED").failures:
                failed.append(run)
        return failed

    def second_time(self, failed):
        """Runs failed tests once more, one after the other; those that pass now are unstable."""
        first = {run.test.name: run for run in failed}
        for run in self.pool.run([run.test for run in failed], suffix=".again", alone=True):
            if not self.take(run, "[again]", "unstable", "FAILED").failures:
                self.unstable.append((first[run.test.name], run))

    def take(self, run, place, good, bad):
        """Tells of a finished run and keeps its result."""
        result = result_of(run)
        self.runs.append(run)
        self.outcomes[run.test.name] = run, result
        verdict = bad if result.failures else "skipped" if not result.passed else good
        test_report.show_run(run, result, place, verdict, self.verbose)
        return result

    def phase(self, tests, alone):
        failed = self.first_time(tests, alone)
        if len(failed) > MOST_REPEATED and self.retry:
            say("{} tests failed, too many to run them again".format(len(failed)))
        elif failed and self.retry:
            say("Once more, alone: " + ", ".join(run.test.name for run in failed))
            self.second_time(failed)

    def run(self, tests):
        self.phase([test for test in tests if test.kind != "timed"], alone=False)
        self.phase([test for test in tests if test.kind == "timed"], alone=True)

    def counted(self, of_packages=False):
        """How many cases were judged."""
        return sum(result.cases() - len(result.skipped) for run, result in self.outcomes.values()
                   if not (of_packages and run.test.is_script))

    def failures(self, everything):
        """A line for each failure. A run of everything without a test of a package is one, too."""
        lines = ["{}: {}".format(name, case) for name, (_, result) in self.outcomes.items() for case in result.failures]
        if everything and self.counted(of_packages=True) == 0:
            lines.append("no test of any package ran")
        if len(self.unstable) > MOST_UNSTABLE:
            lines.append("{} tests are unstable, more than {}: make them independent of the load of the machine".format(
                len(self.unstable), MOST_UNSTABLE))
        return lines

    def close(self, pattern):
        """Prints the summary; returns the exit status."""
        results = [result for _, result in self.outcomes.values()]
        failures = self.failures(everything=not pattern)
        passed = sum(result.passed for result in results)
        test_report.show_summary(results, failures, self.unstable, self.runs)
        if not passed and not failures:
            say("test: no test ran{}".format("; does anything match '{}'?".format(pattern) if pattern else ""))
        say(test_report.closing_line(passed, len(failures), sum(len(result.skipped) for result in results)))
        return 0 if passed and not failures else 1


def read_times(logs):
    try:
        with open(os.path.join(logs, TIMES), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def write_times(logs, known, suite):
    """Keeps how long tests took, so that the next run can start the longest first."""
    passed = {name: round(run.seconds(), 2) for name, (run, result) in suite.outcomes.items() if not result.failures}
    with open(os.path.join(logs, TIMES), "w", encoding="utf-8") as file:
        json.dump(dict(known, **passed), file, indent=1, sort_keys=True)


def fresh_logs(logs):
    """Empties the folder of the logs; returns how long tests took in earlier runs."""
    times = read_times(logs)
    shutil.rmtree(logs, ignore_errors=True)
    os.makedirs(logs)
    return times


def selected_tests(options):
    """The tests to run: all of them, or those that the filter selects."""
    tests = test_list.all_tests(options.build, options.scripts, {"VIBE_VARIANT": options.variant})
    return test_list.select(tests, options.filter) if options.filter else tests


def run_all(options, scratch):
    logs = os.path.join(options.build, "test_logs")
    tests = selected_tests(options)
    times = fresh_logs(logs)
    for test in tests:
        test.cost = times.get(test.name, test.cost)
    say("{} tests on {} cores; the output of each is kept in {}".format(len(tests), options.cores, logs))
    pool = Pool(UNITS_OF_A_CORE * options.cores, logs, scratch, say)
    suite = Suite(pool, len(tests), os.environ.get("VIBE_TEST_RETRY") != "0", options.verbose)
    try:
        suite.run(tests)
    except Interrupted as interrupted:
        say("test: interrupted by signal {} after {} of {} tests".format(interrupted, len(suite.outcomes), len(tests)))
        return 128 + interrupted.args[0]
    finally:
        write_times(logs, times, suite)
    return suite.close(options.filter)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, help="build folder of the workspace, with its tests")
    parser.add_argument("--scripts", required=True, help="folder with scripts that are tests")
    parser.add_argument("--variant", default="", help="what scripts get as VIBE_VARIANT")
    parser.add_argument("--filter", default="", help="regular expression: names of tests or, if none matches, of cases")
    parser.add_argument("--verbose", action="store_true", help="show the output of tests that pass, too")
    parser.add_argument("--cores", type=int, default=len(os.sched_getaffinity(0)), help="how many there are")
    options = parser.parse_args()
    options.build = os.path.abspath(options.build)
    options.verbose = options.verbose or os.environ.get("VIBE_TEST_VERBOSE") == "1"
    try:
        re.compile(options.filter)
    except re.error as error:
        parser.error("--filter needs a regular expression, not '{}': {}".format(options.filter, error))
    return options


def main():
    options = parse()
    scratch = tempfile.mkdtemp(prefix="vibe_test.")
    try:
        return run_all(options, scratch)
    except test_list.DeclarationError as error:
        print("test: {}".format(error), file=sys.stderr)
        return 1
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
