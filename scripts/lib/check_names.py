#!/usr/bin/env python3
"""Checks names. In unnamed namespaces: the sources of a folder are compiled as one file, in which they share one unnamed
namespace: a name that stands in two of them may be defined twice, and a name that also stands in a header hides that of
the header in all of them, without a word of the compiler. In comments of headers: `@param` names a parameter of what
follows.

Prints FILE:LINE: PROBLEM, and at the end how many files it has looked at. Exit status: 0 nothing found, 1 something found,
2 wrong call.
"""

import pathlib
import re
import sys

ALONE = re.compile(r"(_main|_nodelet|_sse2|_avx2|_avx512)\.cpp$")  # compiled by themselves
CONSTANT = re.compile(r"\b(k[A-Z]\w*)(?:\[\w*\])?\s*(?:=(?!=)|\{)")
ENUMERATOR = re.compile(r"\b(k[A-Z]\w*)\s*(?=[=,}]|$)")
DECLARATIONS = (
    re.compile(r"^(?:struct|class|enum(?: class)?)\s+(\w+)\s*(?:final\s*)?(?=[:{])"),
    re.compile(r"^using\s+(\w+)\s*="),
    re.compile(r"^(?!return|else|using|namespace|template|public|private)[\w:<>,&*\s\[\]]*?[\w>&*]\s+[&*]?(\w+)\("),
)


COMMENTED = re.compile(r"((?:^[ \t]*///.*\n)+)((?:(?![ \t]*///).*\n)+)", re.MULTILINE)


def without_comments(text):
    """Comments and what is in quotes become blanks; lines stay."""
    blank = lambda found: re.sub(r"[^\n]", " ", found.group())  # noqa: E731
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.DOTALL)


def declared(line, depth, in_enum):
    """Names that a line declares at the level of a namespace, or as values of an enum without `class`."""
    names = set()
    if in_enum:
        names.update(ENUMERATOR.findall(line))
    elif depth == 0:
        if re.match(r"(inline |static )?(constexpr|const) ", line):
            names.update(CONSTANT.findall(line))
        for pattern in DECLARATIONS:
            names.update(pattern.findall(line))
    return names


def names_of(text, unnamed):
    """{name: line} of what stands in the unnamed namespaces of a text, or directly in its named ones."""
    found, spaces, depth, enum = {}, [], 0, False
    for number, line in enumerate(text.splitlines(), 1):
        opened = re.match(r"\s*(?:inline\s+)?namespace\s*([\w:]*)\s*\{\s*$", line)
        if opened:
            spaces.append((opened.group(1), depth))
            depth += 1
            continue
        inside = bool(spaces) and (any(not name for name, _ in spaces) == unnamed)
        level = depth - (spaces[-1][1] + 1 if spaces else 0)
        enum = (enum and level > 0) or (level == 0 and re.match(r"enum(?! class)\b", line) is not None)
        if inside:
            for name in declared(line, level, enum):
                found.setdefault(name, number)
        depth += line.count("{") - line.count("}")
        while spaces and depth <= spaces[-1][1]:
            spaces.pop()
    return found


def folders(package):
    """The folders that are compiled as one file each."""
    return [folder for folder in [*package.glob("src/*/"), *package.glob("node/*/"), package / "node", package / "src"]
            if any(folder.glob("*.cpp"))]


def header_names(root, package):
    """{name: header} of what a package's own headers and the public ones of vibe_core declare."""
    core = root / "src" / "vibe_core"
    found = {}
    for place in (package / "include", package / "src", package / "node", core / "include"):
        for header in sorted(place.rglob("*.hpp")):
            for name in names_of(without_comments(header.read_text(encoding="utf-8")), False):
                found.setdefault(name, header)
    return found


def problems_of_folder(folder, headers, root):
    texts = {file: without_comments(file.read_text(encoding="utf-8"))
             for file in sorted(folder.glob("*.cpp")) if not ALONE.search(file.name)}
    seen = {}
    for file, text in texts.items():
        for name, line in names_of(text, True).items():
            place = "{}:{}".format(file.relative_to(root), line)
            if name in seen and "using {} =".format(name) not in text:
                yield "{}: '{}' stands in {}, too; share it, or name both after what they are".format(place, name, seen[name].name)
            seen.setdefault(name, file)
            word = re.compile(r"(?<![\w.>:]){}\b".format(name))
            hidden = [other.name for other, more in texts.items() if other != file and word.search(more)]
            if name in headers and hidden:
                yield "{}: '{}' hides that of {} in {}; rename it".format(
                    place, name, headers[name].relative_to(root), ", ".join(hidden))


def wrong_parameters(header, root):
    text = header.read_text(encoding="utf-8")
    for found in COMMENTED.finditer(text):
        for names in re.findall(r"@param\s+((?:\w+,\s+)*\w+)", found.group(1)):
            for name in re.split(r",\s+", names):
                if not re.search(r"\b{}\b".format(name), re.split(r";|\{\s*$", without_comments(found.group(2)), flags=re.MULTILINE)[0]):
                    yield "{}:{}: '@param {}' is no parameter of what follows".format(
                        header.relative_to(root), text.count("\n", 0, found.start(2)) + 1, name)


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "src" / "vibe_core").is_dir():
        print("usage: check_names.py ROOT  (the folder that has src/vibe_core)", file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    found, looked = [], 0
    for package in sorted((root / "src").glob("vibe_*")):
        headers = header_names(root, package)
        for folder in folders(package):
            looked += len(list(folder.glob("*.cpp")))
            found += problems_of_folder(folder, headers, root)
        for header in sorted(package.rglob("*.hpp")):
            found += wrong_parameters(header, root)
    print("\n".join([*found, "{} files".format(looked)]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
