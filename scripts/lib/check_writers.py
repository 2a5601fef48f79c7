#!/usr/bin/env python3
"""Checks that what is left for people is written as whole files: by vibe_sessions.whole_file in Python, by WholeFile,
writeWhole() or writeFile() of vibe_core/files in C++, which give the path to write to the name `part`; bags are
written as FILE.active by the recorder's rules. A call that opens a
file to write to without `part` on its lines is found, unless a comment there says why: `not whole: REASON`, as scratch, of
a folder that is thrown away, or a log, whose lines are whole one by one.

Prints FILE:LINE: PROBLEM, and at the end how many files it has looked at. Exit status: 0 nothing found, 1 something found,
2 wrong call.
"""

import fnmatch
import pathlib
import re
import sys

WRITERS = {
    ".py": re.compile(r"""\bopen\([^#]*?,\s*(?:mode=)?["'][wax]b?\+?["']|\.write_(?:text|bytes)\(|\bsavefig\((?!stream)|\b(?:np|numpy)\.save\w*\("""
                      r"""|(?<!self)(?<!super\(\))\.save\((?!stream\b)|\bto_csv\(|\bBag\([^#]*?,\s*["'][wa]["']|h5py\.File\("""),
    ".cpp": re.compile(r"""\bofstream\s+\w|\bofstream\(\w|\bfopen\((?![^;]*"r)|\bimwrite\(|\bimage\.save\(|bagmode::Write"""),
}
APART = (
    "*/test/*", "*test.d/*", "*_test.py", "src/vibe_testing/*", "src/vibe_system_tests/*", "*/fuzz/*",  # in scratch folders
    "docs/*", "examples/*",  # short, for readers; the site of the pages
    "*/plot_*.py", "*/make_*.py", "*/figures.py", "*/phantom/pictures.py", "scripts/lib/debian_control.py",  # drawn or made again by the same call in a second
    "src/vibe_sessions/src/vibe_sessions/export/*",  # in a folder that gets its name when it is whole
    "src/vibe_web/benchmark/*", "src/vibe_python/*", "src/vibe_firmware/*", "*/render_with_blender.py",  # use no other package
)


def kind_of(file):
    """.py, .cpp or None."""
    if file.suffix in (".py", ".cpp", ".hpp"):
        return ".cpp" if file.suffix == ".hpp" else file.suffix
    return ".py" if not file.suffix and file.read_bytes()[:40].startswith(b"#!/usr/bin/env python") else None


def findings(text, kind):
    """Numbers of the lines that write and do not say how."""
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        around = " ".join(lines[max(0, number - 2):number])
        if WRITERS[kind].search(line) and not re.search(r"\bpart\b|\.active|not whole: \w", around):
            yield number


def main(root):
    looked = found = 0
    for file in sorted(file for folder in ("src", "scripts", "docs", "examples") for file in (root / folder).rglob("*")):
        name = file.relative_to(root)
        if not file.is_file() or any(fnmatch.fnmatch(str(name), each) for each in APART):
            continue
        kind = kind_of(file)
        if kind is None:
            continue
        looked += 1
        for number in findings(file.read_text(encoding="utf-8"), kind):
            found += 1
            print(f"{name}:{number}: writes a file that may be left half; use whole_file (Python) or WholeFile (C++), or say "
                  "`not whole: REASON` there")
    print(f"{looked} files")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_writers.py ROOT")
    sys.exit(main(pathlib.Path(sys.argv[1])))
