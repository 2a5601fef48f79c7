#!/usr/bin/env python3
"""Compares blocks of code in a Markdown page with the files they were taken from.

A line `<!-- file: PATH -->` before a block names the file that the block repeats; where the file has the lines
`// [recipe]` and `// [/recipe]`, what is between them. With `from: TEXT` and `to: TEXT` the block repeats the lines from
the first one that contains TEXT to the next one that is the other TEXT, indentation aside.
Prints one line for each block that differs; ends with status 1 if there is one, or no block at all.
"""

import pathlib
import re
import sys

BLOCK = re.compile(r"^<!-- file: (?P<path>\S+)(?: from: (?P<first>.+?))?(?: to: (?P<last>.+?))? -->\n+```\w*\n(?P<code>.*?)^```$",
                   re.MULTILINE | re.DOTALL)


def region(text, first, last):
    """The lines of a text between two marks, both included; without marks its recipe, or else all of it."""
    recipe = re.search(r"^// \[recipe\]\n(.*?)^// \[/recipe\]$", text, re.MULTILINE | re.DOTALL)
    if recipe and not first and not last:
        return recipe.group(1)
    lines = text.splitlines(keepends=True)
    begin = next((n for n, line in enumerate(lines) if first in line), None) if first else 0
    if begin is None:
        return None
    end = next((n for n, line in enumerate(lines) if n >= begin and last == line.strip()), None) if last else len(lines) - 1
    return None if end is None else "".join(lines[begin:end + 1])


def problem_of(block, root):
    """What is wrong with a block, or None."""
    file = root / block["path"]
    if not file.is_file():
        return "there is no such file"
    expected = region(file.read_text(encoding="utf-8"), block["first"], block["last"])
    if expected is None:
        return "the marks of the region are not in the file"
    return None if block["code"] == expected else "the block differs from the file"


def main():
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(__doc__.strip(), "\n\nUsage: check_code_blocks.py PAGE ROOT", sep="")
        return 0 if "--help" in sys.argv else 2
    page, root = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    blocks = list(BLOCK.finditer(page.read_text(encoding="utf-8")))
    problems = [(block["path"], problem_of(block, root)) for block in blocks]
    for path, problem in problems:
        if problem:
            print("{}: {}: {}".format(page.name, path, problem))
    if not blocks:
        print("{}: names no file".format(page.name))
    return 1 if not blocks or any(problem for _, problem in problems) else 0


if __name__ == "__main__":
    sys.exit(main())
