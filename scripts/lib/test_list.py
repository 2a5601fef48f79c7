"""The tests of a workspace: those that ctest knows in a build folder, and the scripts of a folder like scripts/test.d; and
a folder in which ctest runs all of them.

A test of a package says what it is by properties of ctest: LABELS (its kind), COST, RESOURCE_LOCK, TIMEOUT. A script
says it in its first lines: `# kind: computing`, `# cost: 40`, `# units: 4`, `# alone-with: NAME`, `# timeout: 3600`,
`# packages: NAME...` (packages, or other folders and files of the workspace, whose changes it notices; none: of any).
"""

import concurrent.futures
import json
import os
import re
import subprocess
import sys

KINDS = ("computing", "waiting", "timed")
UNITS = {"computing": 2, "waiting": 1, "timed": 2}  # of the two that each core has
WIDE_FIRST = 1000  # added to the cost of a test that takes more than a core, which would wait for room until the end
TIMEOUT = 1200.0  # of a test that names none [s]
LISTING_TIMEOUT = 60.0  # for a program to list its cases [s]
HEADER_LINES = 15
OUTPUT_OPTION = "--gtest_output=xml:"
HEADER = re.compile(r"# (kind|cost|units|alone-with|timeout|packages): *(.+)")
NOT_BUILT = ["sh", "-c", "echo 'The program of this test is not built; run scripts/build --tests.'; exit 127"]
RUNNER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_test.py")


class DeclarationError(Exception):
    """One sentence: which test is declared wrongly, and what to write."""


class Test:
    """What is run, and what it needs."""

    def __init__(self, name, command, kind, properties, packages, is_script=False):
        self.name, self.command, self.kind, self.packages, self.is_script = name, command, kind, packages, is_script
        self.properties = dict({"TIMEOUT": TIMEOUT, "PROCESSORS": UNITS[kind]}, **properties)
        self.timeout = float(self.properties["TIMEOUT"])
        self.result_file = "lines" if is_script else next((path for path in map(path_in, command) if path), "")
        self.log = None

    def concerns(self, areas):
        """Whether the test is one of these packages or, a script, names one of these areas or is one."""
        own = {self.name, "scripts"} if self.is_script else set()
        return not areas or bool((self.packages | own) & set(areas))


def path_in(word):
    """The file into which a command with this word writes its cases: gtest's, or that of catkin's rostest."""
    if word.startswith(OUTPUT_OPTION):
        return word[len(OUTPUT_OPTION) :]
    return word if "/test_results/" in word and word.endswith(".xml") and " " not in word else None


def kind_of(name, labels):
    """A rostest starts nodes and waits for them; other tests compute, unless a label says what they do."""
    return next((kind for kind in KINDS if kind in labels), "waiting" if "rostest" in name else "computing")


def package_tests(build):
    """Every test that ctest knows in a build folder."""
    if not os.path.isdir(build):
        raise DeclarationError("there is no build folder {}; run scripts/build --tests".format(build))
    said = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True, stdout=subprocess.PIPE).stdout
    for test in json.loads(said)["tests"]:
        name = re.sub("^_ctest_", "", test["name"])
        properties = {item["name"]: item["value"] for item in test.get("properties", [])}
        labels = properties.pop("LABELS", [])
        kept = {key: value for key, value in properties.items()
                if key in ("COST", "ENVIRONMENT", "RESOURCE_LOCK", "TIMEOUT", "WORKING_DIRECTORY")}
        package = re.split("/|_rostest_", name)[0]
        yield Test(name, test.get("command", NOT_BUILT), kind_of(name, labels), kept, {package})


def check_declaration(path, single):
    """What a script declares, key by key, must be complete and of the right kind."""
    if single.get("kind") not in KINDS:
        found = "the kind '{}'".format(single["kind"]) if "kind" in single else "no kind"
        raise DeclarationError("{} declares {} in its first {} lines; add a line `# kind: WORD` with one of {}".format(
            path, found, HEADER_LINES, ", ".join(KINDS)))
    for key in ("cost", "units", "timeout"):
        if not re.fullmatch("[1-9][0-9]*", single.get(key, "1")):
            raise DeclarationError("{} declares the {} '{}'; write a whole number above zero".format(
                path, key, single[key]))


def script_test(path):
    """The test of one script, as its first lines declare it."""
    with open(path, encoding="utf-8") as lines:
        head = [line.rstrip("\n") for _, line in zip(range(HEADER_LINES), lines)]
    said = dict(found.groups() for found in map(HEADER.fullmatch, head) if found)
    check_declaration(path, said)
    words = {"cost": "COST", "units": "PROCESSORS", "alone-with": "RESOURCE_LOCK", "timeout": "TIMEOUT"}
    properties = {word: said[key] for key, word in words.items() if key in said}
    if int(said.get("units", 0)) > UNITS["computing"]:
        properties["COST"] = WIDE_FIRST + int(said.get("cost", 0))
    name = os.path.basename(path)[: -len(".sh")]
    return Test(name, ["bash", path], said["kind"], properties, set(said.get("packages", "any").split()), is_script=True)


def all_tests(build, scripts, areas):
    """Tests of packages and scripts. Their names are those of their logs, too, so no two may be the same."""
    names = sorted(name for name in os.listdir(scripts) if name.endswith(".sh"))
    tests = [*package_tests(build), *(script_test(os.path.join(scripts, name)) for name in names)]
    seen = set()
    for test in tests:
        if test.name in seen:
            raise DeclarationError("two tests are called {}; rename one of them".format(test.name))
        seen.add(test.name)
    return [test for test in tests if test.concerns(areas)]


def with_option(command, option):
    """The command with one more option of its gtest program."""
    return [word for known in command for word in ([option, known] if known.startswith(OUTPUT_OPTION) else [known])]


def cases_of(test):
    """The names Suite.Case of a gtest program; none if it cannot be asked."""
    command = with_option(test.command, "--gtest_list_tests")
    if len(command) == len(test.command):
        return []
    try:
        said = subprocess.run(command, cwd=test.properties.get("WORKING_DIRECTORY"), stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=LISTING_TIMEOUT).stdout
    except (OSError, subprocess.TimeoutExpired):
        return []
    suite, cases = "", []
    for line in said.splitlines():
        name = line.split("#")[0].rstrip()
        if not line.startswith("  "):
            suite = name if re.fullmatch(r"\S+\.", name) else ""
        elif suite and name:
            cases.append(suite + name.strip())
    return cases


def select(tests, pattern):
    """The tests whose name matches or, if there is none, the gtest programs with those cases that match."""
    selected = [test for test in tests if re.search(pattern, test.name)]
    if not selected:
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
            for test, cases in zip(tests, threads.map(cases_of, tests)):
                matching = [case for case in cases if re.search(pattern, case)]
                if matching:
                    test.command = with_option(test.command, "--gtest_filter=" + ":".join(matching))
                    selected.append(test)
    return selected


def quoted(value):
    """A value for CMake, whatever it contains; a list has its parts joined by semicolons."""
    return "[===[{}]===]".format(";".join(value) if isinstance(value, list) else value)


def write(tests, folder, scratch):
    """Writes the list of tests that ctest reads in a folder, and an empty log for each."""
    with open(os.path.join(folder, "CTestTestfile.cmake"), "w", encoding="utf-8") as file:  # not whole: scratch
        for test in tests:
            test.log = os.path.join(folder, test.name.replace("/", "_") + ".log")
            with open(test.log, "w", encoding="utf-8"):  # not whole: a log
                pass
            words = [sys.executable, "-BS", RUNNER, scratch, test.log, test.result_file]
            properties = dict(test.properties, LABELS=test.kind)
            command = ["env", *properties.pop("ENVIRONMENT", []), *test.command]  # it is not for run_test.py
            print("add_test({} {})".format(quoted(test.name), " ".join(map(quoted, words + command))), file=file)
            print("set_tests_properties({} PROPERTIES {})".format(quoted(test.name), " ".join(
                "{} {}".format(key, quoted(value)) for key, value in properties.items())), file=file)
