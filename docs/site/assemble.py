#!/usr/bin/env python3
"""Puts the sources of the site together: the Markdown pages of the workspace in the folders where they are, the pages
that reference.py and api.py make, and a page for every file of code that a page links to. A link to what is not there,
and headers that lack a comment or a unit, end the program with status 1 when all is written."""

import argparse
import os
import pathlib
import posixpath
import re
import shutil
import sys

import api
import reference

PAGES = ("README.md", "CONTRIBUTING.md", "SECURITY.md", "docs/**/*.md", "src/**/README.md", "examples/**/README.md",
         "src/*/CHANGELOG.rst")
FENCE = re.compile(r"^(?P<indent> *)(?P<fence>```+|~~~+).*?^(?P=indent)(?P=fence) *$", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"(?P<head>!?\[(?:[^\[\]]|\[[^\]]*\]|!\[[^\]]*\]\([^)]*\))*\]\()(?P<target>[^)\s]+)(?P<tail>\))")
RAW_ANCHOR = re.compile(r'^<a id="([\w-]+)"></a>[ \n]*', re.MULTILINE)
LANGUAGES = {".hpp": "cpp", ".cpp": "cpp", ".h": "cpp", ".py": "python", ".yaml": "yaml", ".yml": "yaml", ".sh": "bash",
             ".xml": "xml", ".urdf": "xml", ".js": "js", ".cmake": "cmake", ".msg": "none", ".srv": "none"}
# Below their list, so that they are not in the sidebar of every page.
PACKAGE_PAGES = "\n```{toctree}\n:hidden:\n:glob:\n../src/**/README\n../src/*/CHANGELOG\n```\n"
SHOWN = 400_000  # bytes; a longer file is named, not shown


class Site:
    def __init__(self, root, output):
        self.root, self.output = root, output
        self.pages = sorted({file.relative_to(root).as_posix() for pattern in PAGES for file in root.glob(pattern)
                             if "docs/site" not in file.as_posix()})
        self.made = set()  # pages that stand in no file of the workspace
        self.code = set()  # paths that pages link to and that are no page
        self.problems = []

    def write(self, name, text):
        file = self.output / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def raw_anchors(self, page):
        if page.endswith(".md") and (self.root / page).is_file():
            return set(RAW_ANCHOR.findall((self.root / page).read_text(encoding="utf-8")))
        return set()

    def target_of(self, page, target):
        """The target of a link as the site has it."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, anchor = target.partition("#")
        there = posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page
        if anchor in self.raw_anchors(there):
            return anchor.lower()
        if not path or there in self.pages or there in self.made:
            return target
        if there.startswith("docs/site/") or not (self.root / there).exists():
            self.problems.append("{}: '{}' is not there".format(page, target))
            return target
        if re.search(r"\.(png|svg|jpg|css)$", there):
            return target
        self.code.add(there)
        return posixpath.relpath("code/" + there + ".md", posixpath.dirname(page) or ".")

    def rewrite(self, page, text):
        """The page with its links for the site; code is left alone."""
        kept = []

        def keep(found):
            kept.append(found.group(0))
            return "\0{}\0".format(len(kept) - 1)

        text = INLINE.sub(keep, FENCE.sub(keep, text))
        text = RAW_ANCHOR.sub(lambda found: "({})=\n".format(found.group(1).lower()), text)
        restore = lambda part: re.sub(r"\0(\d+)\0", lambda found: kept[int(found.group(1))], part)  # noqa: E731
        link = lambda found: found.group("head") + self.target_of(page, found.group("target")) + ")"  # noqa: E731
        while True:  # a picture that is a link has a link inside its words
            changed = LINK.sub(link, text)
            if changed == text or changed.count("](") == text.count("]("):
                return restore(changed)
            text = changed

    def copy_pages(self):
        for page in self.pages:
            text = (self.root / page).read_text(encoding="utf-8")
            if page == "docs/packages.md":
                text += PACKAGE_PAGES
            self.write(page, self.rewrite(page, text) if page.endswith(".md") else text)
        for picture in [*(self.root / "docs").rglob("*.png"), *(self.root / "docs").rglob("*.svg"),
                        *(self.root / "src").glob("*/*.png"), *(self.root / "examples").rglob("*.png")]:
            there = self.output / picture.relative_to(self.root)
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(picture, there)

    def code_page(self, path):
        file = self.root / path
        page = "code/" + path + ".md"
        head = "---\norphan: true\n---\n# `{}`\n\n".format(path)
        if file.is_dir():
            inside = sorted(item for item in file.rglob("*") if item.is_file() and "__pycache__" not in item.parts)
            lines = []
            for item in inside[:200]:
                name = item.relative_to(self.root).as_posix()
                if len(inside) <= 60 and name not in self.pages and b"\0" not in item.read_bytes()[:4096]:
                    self.code.add(name)
                    lines.append("* [`{}`]({})".format(name, posixpath.relpath("code/" + name + ".md", posixpath.dirname(page))))
                else:
                    lines.append("* `{}`".format(name))
            self.write(page, head + "\n".join(lines) + "\n")
            return
        data = file.read_bytes()
        if len(data) > SHOWN or b"\0" in data[:4096]:
            self.write(page, head + "A file of {:,} bytes.\n".format(len(data)))
            return
        self.write("code/" + path + ".txt", data.decode("utf-8"))
        language = LANGUAGES.get(file.suffix) or ("bash" if data.startswith(b"#!/usr/bin/env bash") else
                                                  "python" if data.startswith(b"#!/usr/bin/env python") else "none")
        self.write(page, head + "```{{literalinclude}} {}\n:language: {}\n:lineno-match:\n```\n".format(file.name + ".txt", language))

    def write_code_pages(self):
        done = set()
        while self.code - done:
            for path in sorted(self.code - done):
                self.code_page(path)
                done.add(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="the workspace")
    parser.add_argument("output", type=pathlib.Path, help="folder of the sources, which is made anew")
    parser.add_argument("--katex", type=pathlib.Path, required=True, help="folder of KaTeX")
    parser.add_argument("--lunr", type=pathlib.Path, required=True, help="lunr.min.js")
    parser.add_argument("--doxygen", type=pathlib.Path, required=True, help="folder of the XML of Doxygen")
    arguments = parser.parse_args()
    sys.dont_write_bytecode = True
    shutil.rmtree(arguments.output, ignore_errors=True)
    site = Site(arguments.root.resolve(), arguments.output)
    made = dict(reference.pages(site.root))
    interface = dict(api.pages(site.root, arguments.doxygen))
    made["index.md"] = (site.root / "docs/site/index.md").read_text(encoding="utf-8")
    site.made = {*made, *interface}
    site.copy_pages()
    for name, text in made.items():
        site.write(name, site.rewrite(name, text))
    for name, text in interface.items():
        site.write(name, text)
    site.write_code_pages()
    static = arguments.output / "_static"
    shutil.copytree(arguments.katex, static / "katex", ignore=shutil.ignore_patterns("*.mjs", "katex.js", "katex.css"))
    shutil.copyfile(arguments.lunr, static / "lunr.min.js")
    for name in ("formulas.js", "search.js", "site.css"):
        shutil.copyfile(site.root / "docs/site" / name, static / name)
    problems = [*site.problems, *api.problems(arguments.doxygen)]
    problems += ["{}: lists nothing; build first (scripts/build), or mend docs/site/reference.py".format(name)
                 for name, text in made.items() if reference.empty(text)]
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
