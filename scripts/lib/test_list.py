"""The tests of a workspace: those that ctest knows in a build folder, and the scripts of a folder like scripts/test.d.

A test of a package says what it is by properties of ctest: LABELS (its kind), COST, RESOURCE_LOCK, TIMEOUT. A script
says it in its first lines: `# kind: computing`, `# cost: 40`, `# units: 4`, `# alone-with: NAME`, `# timeout: 3600`.
"""

import concurrent.futures
import json
import os
import re
import subprocess

KINDS = ("computing", "waiting", "timed")
UNITS = {"computing": 2, "waiting": 1, "timed": 2}  # of the two that each core has
TIMEOUT = 1200.0  # of a test that names none [s]
LISTING_TIMEOUT = 60.0  # for a program to list its cases [s]
HEADER_LINES = 15
OUTPUT_OPTION = "--gtest_output=xml:"
HEADER = re.compile(r"# (kind|cost|units|alone-with|timeout): *(.+)")


class DeclarationError(Exception):
    """One sentence: which test is declared wrongly, and what to write."""


class Test:
    """What is run, and what it needs."""

    def __init__(self, name, command, group, **given):
        self.name, self.command, self.group = name, command, group
        self.folder = given.get("folder")
        self.kind = given.get("kind", "computing")
        self.timeout = float(given.get("timeout", TIMEOUT))
        self.cost = float(given.get("cost", 0))
        self.units = int(given.get("units", UNITS[self.kind]))
        self.locks = frozenset(given.get("locks", ()))
        self.environment = given.get("environment", {})
        self.result_file = given.get("result_file")
        self.is_script = given.get("is_script", False)

    def is_gtest(self):
        return any(OUTPUT_OPTION in word for word in self.command)

    def with_option(self, option):
        """The command with one more option of its gtest program, which catkin's wrapper takes as one shell line."""
        words = []
        for word in self.command:
            if word.startswith(OUTPUT_OPTION):
                words += [option, word]
            else:
                words.append(word.replace(OUTPUT_OPTION, "'{}' {}".format(option, OUTPUT_OPTION), 1))
        return words


def result_file(command):
    """The file into which a command writes its cases; None if it writes none."""
    for word in command:
        path = word[len(OUTPUT_OPTION) :] if word.startswith(OUTPUT_OPTION) else word
        if path.endswith(".xml") and (path is not word or "/test_results/" in path) and " " not in path:
            return path
    return None


def kind_of(name, command, labels):
    """A rostest starts nodes and waits for them; other tests compute, unless a label says what they do."""
    for kind in KINDS:
        if kind in labels:
            return kind
    return "waiting" if any("rostest" in word for word in [name] + command) else "computing"


def package_of(test, graph, build):
    """The folder of the CMakeLists.txt in which the test is declared, however deep the call of add_test() is."""
    node = test.get("backtrace")
    while node is not None and "parent" in graph["nodes"][node]:
        node = graph["nodes"][node]["parent"]
    file = build if node is None else graph["files"][graph["nodes"][node]["file"]]
    inside = re.search(r"/src/([^/]+)/", file)
    return inside.group(1) if inside else os.path.basename(os.path.dirname(file)) or "packages"


def package_tests(build):
    """Every test that ctest knows in a build folder."""
    if not os.path.isdir(build):
        raise DeclarationError("there is no build folder {}; run scripts/build --tests".format(build))
    said = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True, stdout=subprocess.PIPE).stdout
    listing = json.loads(said)
    tests = []
    for test in listing["tests"]:
        properties = {item["name"]: item["value"] for item in test.get("properties", [])}
        command = test.get("command", [])  # ctest names none for a program that is not built
        tests.append(Test(
            re.sub("^_ctest_", "", test["name"]), command, package_of(test, listing["backtraceGraph"], build),
            folder=properties.get("WORKING_DIRECTORY", build),
            kind=kind_of(test["name"], command, properties.get("LABELS", [])),
            timeout=properties.get("TIMEOUT") or TIMEOUT, cost=properties.get("COST", 0),
            locks=properties.get("RESOURCE_LOCK", []), result_file=result_file(command),
            environment=dict(item.split("=", 1) for item in properties.get("ENVIRONMENT", []))))
    return tests


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


def script_test(path, environment):
    """The test of one script, as its first lines declare it."""
    with open(path, encoding="utf-8") as lines:
        head = [line.rstrip("\n") for _, line in zip(range(HEADER_LINES), lines)]
    said = [found.groups() for found in map(HEADER.fullmatch, head) if found]
    single = dict(said)
    check_declaration(path, single)
    numbers = {key: single[key] for key in ("cost", "units", "timeout") if key in single}
    return Test(os.path.basename(path)[: -len(".sh")], ["bash", path], "scripts", kind=single["kind"], is_script=True,
                locks=[value for key, value in said if key == "alone-with"], environment=environment, **numbers)


def script_tests(folder, environment):
    """Every script of a folder."""
    names = sorted(name for name in os.listdir(folder) if name.endswith(".sh"))
    return [script_test(os.path.join(folder, name), environment) for name in names]


def all_tests(build, scripts, environment):
    """Tests of packages and scripts. Their names are those of their logs, too, so no two may be the same."""
    tests = package_tests(build) + script_tests(scripts, environment)
    names = [test.name for test in tests]
    for name in names:
        if names.count(name) > 1:
            raise DeclarationError("two tests are called {}; rename one of them".format(name))
    return tests


def listed_cases(text):
    """The names Suite.Case in what a program says to --gtest_list_tests."""
    suite, cases = "", []
    for line in text.splitlines():
        name = line.split("#")[0].rstrip()
        if not line.startswith("  "):
            suite = name if re.fullmatch(r"\S+\.", name) else ""
        elif suite and name:
            cases.append(suite + name.strip())
    return cases


def cases_of(test):
    """The cases of a gtest program; none if it cannot be asked."""
    try:
        listing = subprocess.run(
            test.with_option("--gtest_list_tests"), cwd=test.folder, env=dict(os.environ, **test.environment),
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=LISTING_TIMEOUT)
    except (OSError, subprocess.TimeoutExpired):
        return []
    return listed_cases(listing.stdout.decode(errors="replace"))


def select_cases(tests, pattern):
    """The gtest programs that have cases which match, each with these cases alone."""
    programs = [test for test in tests if test.is_gtest()]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
        found = list(threads.map(cases_of, programs))
    selected = []
    for test, cases in zip(programs, found):
        matching = [case for case in cases if re.search(pattern, case)]
        if matching:
            test.command = test.with_option("--gtest_filter=" + ":".join(matching))
            selected.append(test)
    return selected


def select(tests, pattern):
    """The tests whose name matches or, if there is none, the cases whose name does."""
    return [test for test in tests if re.search(pattern, test.name)] or select_cases(tests, pattern)
