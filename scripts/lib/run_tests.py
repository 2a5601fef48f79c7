"""Runs the tests of a workspace that is built: ctest does, and this makes its list, judges, and sums up.

The list is that of the build folder and the scripts of a folder like scripts/test.d, each run by run_test.py. What fails
is run once more, alone, when the others have ended. Tests that judge times run after them, one after the other. See
'Tests' in CONTRIBUTING.md.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import test_list
import test_results

UNITS_OF_A_CORE = 2
OVERBOOKED = 1.25  # units in use for each that there is: what computes waits now and then; with 1.5, tests in real time fail
MOST_UNSTABLE = 3
MOST_REPEATED = 10  # where more fail, the reason is no accident, and to run them one by one would take long
MOST_LINES = 400  # of the output of a failed test
SLOWEST = 10


def say(text):
    print(text, flush=True)


class Suite:
    """Phases of ctest and what they have shown."""

    def __init__(self, options, tests):
        self.options, self.tests = options, {test.name: test for test in tests}
        self.folder = os.path.join(options.build, "test_logs")
        self.seconds = {}  # name -> duration of the run that counts
        self.failed = []
        self.unstable = []
        self.phases = 0

    def ctest(self, *words):
        """Runs ctest; returns the names of those that failed."""
        self.phases += 1
        report = os.path.join(self.folder, "ctest.{}.xml".format(self.phases))
        subprocess.run(["ctest", "--output-junit", report, *words], cwd=self.folder, check=False)
        failed = []
        for case in ElementTree.parse(report).iter("testcase"):
            name = case.get("name")
            self.seconds[name] = float(case.get("time"))
            if case.get("status") != "run":
                failed.append(name)
        return failed

    def show(self, name):
        """The end of what a test has said."""
        with open(self.tests[name].log, encoding="utf-8", errors="replace") as text:
            lines = text.read().splitlines()
        say("--- {}: the last of {} lines in {}".format(name, len(lines), self.tests[name].log))
        say("\n".join(lines[-MOST_LINES:]))
        say("--- end of {}".format(name))

    def phase(self, kind, jobs):
        """Runs the tests that are timed, or those that are not (-L, -LE); those that fail twice."""
        if not any((test.kind == "timed") == (kind == "-L") for test in self.tests.values()):
            return
        failed = self.ctest(kind, "timed", "-j", str(jobs))
        for name in failed if not self.options.verbose else self.seconds:
            self.show(name)
        if len(failed) > MOST_REPEATED:
            say("{} tests failed, too many to run them again".format(len(failed)))
        elif failed and os.environ.get("VIBE_TEST_RETRY") != "0":
            say("Once more, alone: " + ", ".join(failed))
            for name in failed:
                os.rename(self.tests[name].log, self.tests[name].log[: -len(".log")] + ".first.log")
            again = self.ctest("--rerun-failed", "-j", "1")
            for name in again:
                self.show(name)
            self.unstable += [name for name in failed if name not in again]
            failed = again
        self.failed += failed

    def processor_time(self, name):
        """Of a test, as run_test.py has written it [s]; none of one that was stopped."""
        path = self.tests[name].log + ".seconds"
        if not os.path.exists(path):
            return "-"
        with open(path, encoding="ascii") as text:
            return text.read()

    def result_of(self, name):
        """The cases of a test; where it failed as a whole, that is one."""
        test = self.tests[name]
        result = test_results.read(test.log, test.result_file)
        if name in self.failed and not result.failures:
            result.passed = result.passed if test.result_file else 0
            result.failures.append(test_results.end_of(test.log, test.timeout))
        return result

    def close(self):
        """Prints the summary; returns the exit status."""
        results = {name: self.result_of(name) for name in self.seconds}
        failures = ["{}: {}".format(name, case) for name, result in results.items() for case in result.failures]
        of_packages = [result for name, result in results.items() if not self.tests[name].is_script]
        if not (self.options.filter or self.options.areas) and not any(result.passed for result in of_packages):
            failures.append("no test of any package ran")
        if len(results) != len(self.tests):
            failures.append("only {} of {} tests ran".format(len(results), len(self.tests)))
        if len(self.unstable) > MOST_UNSTABLE:
            failures.append("{} tests are unstable, more than {}: make them independent of the load of the machine".format(
                len(self.unstable), MOST_UNSTABLE))
        slowest = sorted(self.seconds, key=lambda name: -self.seconds[name])[:SLOWEST]
        skipped = [sentence for result in results.values() for sentence in result.skipped]
        show_list("Skipped:", sorted(set(skipped)))
        show_list("Slowest, and processor time:", ["{:>8.1f} s {:>8} s  {}".format(
            self.seconds[name], self.processor_time(name), name) for name in slowest])
        show_list("Unstable:", ["{0}: failed, and passed when it ran again alone ({0}.first.log)".format(
            name.replace("/", "_")) for name in self.unstable])
        show_list("Failed:", failures)
        passed = sum(result.passed for result in results.values())
        if not passed and not failures:
            say("test: no test ran{}".format("; does anything match '{}'?".format(self.options.filter)))
        say("{} passed, {} failed".format(passed, len(failures)) + (", {} skipped".format(len(skipped)) if skipped else ""))
        return 0 if passed and not failures else 1


def show_list(title, lines):
    if lines:
        say("\n  ".join([title, *lines]))


def fresh_folder(folder):
    """Empties the folder of the logs, but for how long tests took, by which ctest starts the longest first."""
    os.makedirs(folder, exist_ok=True)
    for name in os.listdir(folder):
        if os.path.isfile(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))


def run_all(options, scratch):
    tests = test_list.all_tests(options.build, options.scripts, options.areas)
    if options.filter:
        tests = test_list.select(tests, options.filter)
    suite = Suite(options, tests)
    fresh_folder(suite.folder)
    test_list.write(tests, suite.folder, scratch)
    os.environ["VIBE_VARIANT"] = options.variant
    say("{} tests on {} cores; the output of each is kept in {}".format(len(tests), options.cores, suite.folder))
    suite.phase("-LE", int(OVERBOOKED * UNITS_OF_A_CORE * options.cores))
    suite.phase("-L", 1)
    return suite.close()


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, type=os.path.abspath, help="build folder of the workspace, with its tests")
    parser.add_argument("--scripts", required=True, type=os.path.abspath, help="folder with scripts that are tests")
    parser.add_argument("--variant", default="", help="what scripts get as VIBE_VARIANT")
    parser.add_argument("--filter", default="", help="regular expression: names of tests or, if none matches, of cases")
    parser.add_argument("--areas", type=str.split, default=[], help="packages whose tests run, with the scripts that name "
                        "one of these, `any` for those that name none")
    parser.add_argument("--verbose", action="store_true", help="show the output of tests that pass, too")
    parser.add_argument("--cores", type=int, default=len(os.sched_getaffinity(0)), help="how many there are")
    options = parser.parse_args()
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
    except KeyboardInterrupt:
        say("test: interrupted")
        return 130
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
