"""Tests of run_tests.py with made-up tests; called by scripts/test.d/test_runner.sh."""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RUNNER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_tests.py")
SUITE_FILE = "<testsuites>{}</testsuites>"
GOOD, BAD = '<testcase classname="S" name="good"/>', '<testcase classname="S" name="bad"><failure/></testcase>'
SKIPPED = '<testcase classname="S" name="left"><skipped message="x.cpp:1&#x0A;no board"/></testcase>'

# A program with the options of gtest and the cases A.one, A.two and B.one, of which B.one fails.
PROGRAM = r"""#!/bin/bash
for word; do case $word in
  --gtest_list_tests) printf 'A.\n  one\n  two  # GetParam() = 2\nB.\n  one\n'; exit 0 ;;
  --gtest_filter=*) filter=${word#*=} ;;
  --gtest_output=xml:*) file=${word#*xml:} ;;
esac; done
{ echo '<testsuites>'
  for name in ${filter//:/ }; do echo "<testcase classname='${name%.*}' name='${name#*.}'/>"; done
  echo '</testsuites>'; } >"$file"
"""

# Fails if another test is in the same place at the same time.
NARROW = "mkdir narrow && sleep 0.4 && rmdir narrow"


class RunnerTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="vibe_runner.")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        os.mkdir(self.path("scripts"))
        os.makedirs(self.path("build", "test_results"))
        self.declared = []
        self.test("fine", "true")

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text, mode=0o644):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path(name), mode)
        return self.path(name)

    def command(self, name, words, **properties):
        """A test of a package, as CMake declares it."""
        self.declared.append("add_test({} {})".format(name, " ".join("[==[{}]==]".format(word) for word in words)))
        properties.update(WORKING_DIRECTORY=self.folder, _BACKTRACE_TRIPLES="/w/src/pack/CMakeLists.txt;1;add_test;"
                          "/w/src/pack/CMakeLists.txt;0;")
        pairs = " ".join('{} "{}"'.format(*pair) for pair in properties.items())
        self.declared.append("set_tests_properties({} PROPERTIES {})".format(name, pairs))

    def test(self, name, line, **properties):
        self.command(name, ["sh", "-c", line], **properties)

    def with_file(self, name, cases, line="true", **properties):
        """A test that writes a result file."""
        file = self.path("build", "test_results", name + ".xml")
        self.write(name + ".cases", SUITE_FILE.format(cases))
        self.command(name, ["sh", "-c", "cp {}.cases $0; {}".format(name, line), file], **properties)
        return file

    def script(self, name, text):
        self.write("scripts/{}.sh".format(name), text)

    def arguments(self, *options):
        self.write("build/CTestTestfile.cmake", "\n".join(self.declared))
        return [sys.executable, "-B", RUNNER, "--build", self.path("build"), "--scripts", self.path("scripts"),
                "--cores", "1", *options]

    def run_it(self, *options, status=0, **environment):
        """Runs the tests; returns what was said."""
        inherited = {name: value for name, value in os.environ.items() if name not in ("VIBE_TEST_RETRY", "VIBE_TEST_VERBOSE")}
        environment = dict(inherited, **environment)
        ended = subprocess.run(self.arguments(*options), env=environment, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, timeout=60)
        self.assertEqual(ended.returncode, status, ended.stdout)
        return ended.stdout

    def closes(self, said, line):
        self.assertEqual(said.splitlines()[-1], line, said)

    def order(self):
        with open(self.path("order"), encoding="utf-8") as file:
            return file.read().split()

    # --- what counts

    def test_counts_the_cases_of_files_and_scripts(self):
        self.with_file("_ctest_cases", GOOD + GOOD + SKIPPED)
        self.script("words", "# Words.\n# kind: waiting\necho 'ok one'; echo 'skipped two (later)'; echo 'figure 7'\n")
        said = self.run_it()
        self.assertIn("Skipped:\n  no board\n  two (later)\n", said)
        self.assertNotIn("figure", said)
        self.assertRegex(said, r"Slowest, and processor time:\n +[0-9.]+ s +[0-9.]+ s  ")
        self.closes(said, "4 passed, 0 failed, 2 skipped")
        self.assertIn("\nfigure 7\n", self.run_it("--verbose"))

    def test_names_what_failed_and_shows_the_end_of_its_output(self):
        self.with_file("wrong", GOOD + BAD, "seq 1 1000; exit 1")
        said = self.run_it(status=1, VIBE_TEST_RETRY="0")
        self.assertIn("Failed:\n  wrong: S.bad\n2 passed, 1 failed\n", said)
        self.assertIn("\n602\n", said)
        self.assertNotIn("\n601\n", said)
        with open(re.search("the last of 1001 lines in (.*)", said).group(1), encoding="utf-8") as log:
            self.assertEqual(log.read(), "".join("{}\n".format(k + 1) for k in range(1000)) + "run_test: ended with status 1\n")

    def test_a_crash_is_one_failure(self):
        self.with_file("crash", GOOD, "kill -SEGV $$")
        self.test("_ctest_missing", "true")
        self.declared[-2] = "add_test(_ctest_missing /nowhere/program)"
        said = self.run_it(status=1, VIBE_TEST_RETRY="0")
        self.assertIn("  crash: was ended by SIGSEGV\n", said)
        self.assertIn("  missing: ended with status 127\n", said)
        self.closes(said, "2 passed, 2 failed")

    def test_a_passed_file_without_a_case_is_a_failure_even_if_an_old_one_is_there(self):
        os.rename(self.write("old", SUITE_FILE.format(GOOD)), self.with_file("empty", ""))
        self.declared[-2] = self.declared[-2].replace("cp empty.cases $0; ", "")
        self.assertIn("Failed:\n  empty: no good case in it\n1 passed, 1 failed\n", self.run_it(status=1))

    def test_scripts_that_fail(self):
        self.script("silent", "# kind: computing\ntrue\n")
        self.script("ends", "# kind: computing\necho 'ok one'; exit 3\n")
        self.script("says", "# kind: computing\necho 'not ok one thing'\n")
        said = self.run_it(status=1, VIBE_TEST_RETRY="0")
        for line in "silent: no good case in it", "ends: ended with status 3", "says: one thing":
            self.assertIn("  {}\n".format(line), said)
        self.closes(said, "2 passed, 3 failed")

    def test_nothing_ran(self):
        self.closes(self.run_it("--filter", "no_such", status=1), "0 passed, 0 failed")
        self.assertIn("test: no test ran; does anything match 'no_such'?", self.run_it("--filter", "no_such", status=1))
        self.declared.clear()
        self.script("good", "# kind: waiting\necho 'ok one'\n")
        said = self.run_it(status=1)
        self.assertIn("Failed:\n  no test of any package ran\n1 passed, 1 failed\n", said)
        self.closes(self.run_it("--filter", "go+d"), "1 passed, 0 failed")

    def test_wrong_declarations(self):
        wrong = {"": "no kind", "# kind: idle\n": "the kind 'idle'", "# kind: timed\n# units: two\n": "the units 'two'"}
        for head, problem in wrong.items():
            self.script("lost", head + "echo 'ok one'\n")
            said = self.run_it(status=1)
            self.assertRegex(said, r"^test: .*/lost.sh declares .*{}.*\n$".format(problem))

    # --- when tests run

    def test_what_tests_declare_is_what_ctest_knows(self):
        self.test("_ctest_locked", "true", RESOURCE_LOCK="a;b", COST=7, TIMEOUT=9)
        self.test("pack_rostest_x", "true")
        self.script("wide", "# kind: timed\n# units: 4\n# alone-with: a\n# cost: 40\n# timeout: 50\necho 'ok one'\n")
        self.closes(self.run_it(), "4 passed, 0 failed")
        listing = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.path("build", "test_logs"), check=True,
                                 stdout=subprocess.PIPE).stdout
        found = {test["name"]: {each["name"]: each["value"] for each in test["properties"]}
                 for test in json.loads(listing)["tests"]}
        wanted = {"locked": dict(LABELS=["computing"], PROCESSORS=2, RESOURCE_LOCK=["a", "b"], COST=7, TIMEOUT=9),
                  "pack_rostest_x": dict(LABELS=["waiting"], TIMEOUT=1200),
                  "wide": dict(LABELS=["timed"], PROCESSORS=4, RESOURCE_LOCK=["a"], COST=1040, TIMEOUT=50)}
        for name, properties in wanted.items():
            self.assertEqual({key: found[name].get(key) for key in properties}, properties, name)

    def test_computing_tests_take_a_core_each(self):
        for k in range(3):
            self.test("narrow{}".format(k), NARROW)
        self.closes(self.run_it(VIBE_TEST_RETRY="0"), "4 passed, 0 failed")
        self.assertIn("FAILED", self.run_it("--cores", "2", status=1, VIBE_TEST_RETRY="0"))  # control

    def test_timed_tests_run_alone_at_the_end_after_what_is_repeated(self):
        note = "echo {} >>order; "
        for name in "timed1", "timed2":
            self.test(name, note.format(name) + NARROW, LABELS="timed")
        self.test("slow", "sleep 0.6;" + note.format("slow"), LABELS="waiting")
        self.test("bad", note.format("bad") + "exit 1", LABELS="waiting")
        self.run_it("--cores", "4", status=1)
        self.assertEqual(self.order(), ["bad", "slow", "bad", "timed1", "timed2"])

    def test_each_has_folders_of_its_own(self):
        for name in "one", "two":
            self.test(name, "[ -d $ROS_HOME ] && [ -d $XDG_RUNTIME_DIR ] && echo $ROS_HOME >>order")
        self.run_it()
        self.assertEqual(len(set(self.order())), 2)
        self.assertFalse([folder for folder in self.order() if os.path.exists(folder)])

    def test_environments(self):
        self.test("one", '[ "$A$B" = "c d" ]', ENVIRONMENT="A=c;B= d")
        self.script("two", "# kind: waiting\n[ $VIBE_VARIANT = -x ] && echo 'ok two'")
        self.closes(self.run_it("--variant=-x"), "3 passed, 0 failed")

    # --- a second run

    def fails_first(self, name):
        line = "[ -e {0}.was ] || {{ touch {0}.was; echo first words; exit 1; }}; echo second words"
        self.test(name, line.format(name))

    def test_what_passes_alone_is_unstable(self):
        self.fails_first("shaky")
        said = self.run_it()
        self.assertIn("first words", said)
        self.assertIn("Unstable:\n  shaky: failed, and passed when it ran again alone (shaky.first.log)\n", said)
        self.closes(said, "2 passed, 0 failed")
        for name, words in ("shaky.first", "first"), ("shaky", "second"):
            with open(self.path("build", "test_logs", name + ".log"), encoding="utf-8") as log:
                self.assertEqual(log.readline(), words + " words\n")

    def test_no_second_run_on_demand(self):
        self.fails_first("shaky")
        self.closes(self.run_it(status=1, VIBE_TEST_RETRY="0"), "1 passed, 1 failed")

    def test_four_unstable_tests_are_a_failure(self):
        for k in range(4):
            self.fails_first("shaky{}".format(k))
        said = self.run_it(status=1)
        self.assertIn("Failed:\n  4 tests are unstable, more than 3: ", said)
        self.closes(said, "5 passed, 1 failed")

    def test_many_failures_are_not_repeated(self):
        for k in range(11):
            self.test("bad{}".format(k), "exit 1")
        said = self.run_it("--cores", "4", status=1)
        self.assertIn("\n11 tests failed, too many to run them again\n", said)
        self.assertNotIn("Once more", said)
        self.closes(said, "1 passed, 11 failed")

    # --- filters

    def test_the_name_is_filtered(self):
        self.test("_ctest_other", "exit 1")
        self.closes(self.run_it("--filter", "^f.ne$"), "1 passed, 0 failed")
        self.closes(self.run_it("--filter", "^other", status=1), "0 passed, 1 failed")

    def test_cases_are_filtered_where_no_name_matches(self):
        program = self.write("program", PROGRAM, 0o755)
        for name in "plain", "other":
            result = self.path("build", "test_results", name + ".xml")
            self.command(name, ["env", program, "--only_file=a_test.cpp", "--gtest_output=xml:" + result])
        self.closes(self.run_it("--filter", "^A"), "4 passed, 0 failed")
        self.closes(self.run_it("--filter", r"^B\.one|A.two$"), "4 passed, 0 failed")
        self.closes(self.run_it("--filter", "^C", status=1), "0 passed, 0 failed")

    def test_areas_select_packages_and_scripts_that_name_them(self):
        for name in "vibe_a/test/x", "vibe_a_rostest_x", "vibe_b/test/x":
            self.test(name, "true")
        for name, line in ("named", "# packages: docs vibe_a"), ("other", "# packages: vibe_b"), ("always", "#"):
            self.script(name, "# kind: waiting\n{}\necho 'ok one'\n".format(line))
        for areas, count in ("vibe_a", 3), ("any docs", 2), ("vibe_b", 2), ("any scripts", 3), ("other", 1):
            self.closes(self.run_it("--areas", areas), "{} passed, 0 failed".format(count))

    def test_a_change_reaches_what_depends_on_it(self):
        for name, needs in ("vibe_a", ""), ("vibe_b", "<test_depend>vibe_a</test_depend>"), ("vibe_c", "<depend>vibe_b</depend>"):
            os.makedirs(self.path("src", name))
            self.write("src/{}/package.xml".format(name), "<package>{}</package>".format(needs))
        reach = os.path.join(os.path.dirname(RUNNER), "reach.py")
        for path, reached in (("src/vibe_b/x.cpp", "vibe_b vibe_c"), ("src/vibe_a/x", "vibe_a vibe_b vibe_c"),
                              ("docs/x.md", "docs"), ("scripts/test.d/x.sh", "x"), ("scripts/lib/x.py", "scripts")):  # fmt: skip
            said = subprocess.run([sys.executable, "-B", reach, self.folder], input=path, text=True, check=True,
                                  stdout=subprocess.PIPE).stdout
            self.assertEqual(said.split(), reached.split())

    # --- nothing is left

    def alive(self, mark):
        found = []
        for name in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open("/proc/{}/environ".format(name), "rb") as words:
                    found += [name] if mark.encode() in words.read() else []
            except OSError:
                pass
        return found

    # Processes of other sessions, some of which have lost their parent or do not hear SIGTERM.
    FAMILY = "export LEFT={0}; (trap '' TERM; setsid sleep 301 &) ; setsid sleep 302 & touch {0}; "

    def test_a_test_that_does_not_end_is_stopped_with_all_that_it_started(self):
        self.test("endless", self.FAMILY.format(self.path("begun")) + "sleep 303", TIMEOUT=4)
        said = self.run_it(status=1, VIBE_TEST_RETRY="0")
        self.assertIn("  endless: did not end within 4 s and was stopped\n", said)
        self.assertTrue(os.path.exists(self.path("begun")))
        self.assertEqual(self.alive("LEFT=" + self.path("begun")), [])

    def test_a_test_that_ends_leaves_nothing(self):
        self.test("careless", self.FAMILY.format(self.path("begun")))
        self.closes(self.run_it(), "2 passed, 0 failed")
        self.assertEqual(self.alive("LEFT=" + self.path("begun")), [])

    def test_an_interrupted_run_leaves_nothing(self):
        self.test("endless", self.FAMILY.format(self.path("begun")) + "sleep 303")
        with subprocess.Popen(self.arguments(), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as runner:
            deadline = time.monotonic() + 20
            while not os.path.exists(self.path("begun")) and time.monotonic() < deadline:
                time.sleep(0.05)
            self.assertNotEqual(self.alive("LEFT=" + self.path("begun")), [])
            runner.send_signal(signal.SIGINT)
            said = runner.communicate(timeout=30)[0]
        self.assertEqual(runner.returncode, 128 + signal.SIGINT, said)
        self.assertRegex(said, "test: interrupted\n$")
        deadline = time.monotonic() + 20
        while self.alive("LEFT=" + self.path("begun")) and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(self.alive("LEFT=" + self.path("begun")), [])


if __name__ == "__main__":
    unittest.main()
