"""Marks in the pages: what stands between `<!-- measured: NAME -->` and `<!-- end of measured -->` is written by
scripts/accuracy. A table outside of them is a measurement that somebody typed, or below a heading of OTHER_TABLES.
"""

import re

PAGES = ("README.md", "docs/accuracy.md", "docs/computation.md", "docs/measurements.md", "docs/policy.md", "docs/protocols.md",
         "docs/tutorials/first_run.md",
         "docs/tutorials/record_and_replay.md")
STRICT = "docs/accuracy.md"  # where every table is made or in the list
MARKED = re.compile(r"^<!-- measured: (\w+) -->\n(.*?)^<!-- end of measured -->$", re.MULTILINE | re.DOTALL)

# headings of STRICT whose tables are no measurements: definitions, analysis, or bounds that tests hold at every run
OTHER_TABLES = {
    "Force rendered by a haptic device": "bounds, haptic_test",
    "Self-contact": "bounds, self_contact tests",
    "Robustness": "bounds, tests of vibe_core/test/system",
    "Wall": "bounds, shape_matching_test",
    "Motion": "bounds, shape_matching_test and tests of vibe_core/test/system",
    "Gas": "bounds, gas_test",
    "Tool": "bounds, tool_test",
    "Energy balance": "definitions, and bounds of energy_test",
    "Default stomach compared with published values": "published values",
    "Numerical damping": "analysis, numerical_damping_test",
    "Relaxation": "bounds, relaxation_test",
}


def fill(page, make):
    """The page with every block made anew by make(NAME)."""
    return MARKED.sub(lambda found: "<!-- measured: {} -->\n{}\n<!-- end of measured -->".format(
        found.group(1), make(found.group(1))), page)


def blocks(page):
    """(name, what stands there) of every block."""
    return [(found.group(1), found.group(2).removesuffix("\n")) for found in MARKED.finditer(page)]


def unmarked_tables(page):
    """(line, heading) of the tables that are neither made nor below a heading of OTHER_TABLES."""
    rest = MARKED.sub(lambda found: "\n" * found.group(0).count("\n"), page)
    heading, inside = "", False
    for number, line in enumerate(rest.splitlines(), 1):
        if re.match(r"#+ ", line):
            heading = line.lstrip("# ").strip()
        starts, inside = line.startswith("|") and not inside, line.startswith("|")
        if starts and heading not in OTHER_TABLES:
            yield number, heading
