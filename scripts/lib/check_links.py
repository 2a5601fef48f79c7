#!/usr/bin/env python3
"""Checks the links of the Markdown pages: files and folders that do not exist, and headings that a page does not have.
Addresses of the web are not asked. Prints FILE: PROBLEM, and at the end how many pages there are. Exit status: 0 nothing
found, 1 something found, 2 wrong call."""

import pathlib
import re
import sys

PAGES = ("*.md", "docs/**/*.md", "src/**/README.md", "examples/**/README.md")
FENCE = re.compile(r"^( *)(```+|~~~+).*?^\1\2 *$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ +(.*?) *$", re.MULTILINE)
RAW_ANCHOR = re.compile(r'<a id="([\w-]+)">')
MADE = re.compile(r"^(\.\./)*reference/")  # pages that scripts/docs makes


def slug(heading):
    """The anchor that Markdown viewers give a heading."""
    words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def anchors_of(text):
    found, anchors = {}, set(RAW_ANCHOR.findall(text))
    for heading in HEADING.findall(FENCE.sub("", text)):
        name = slug(heading)
        anchors.add(name if name not in found else "{}-{}".format(name, found[name]))
        found[name] = found.get(name, 0) + 1
    return anchors


def problems(root, pages):
    texts = {page: page.read_text(encoding="utf-8") for page in pages}
    anchors = {page: anchors_of(text) for page, text in texts.items()}
    for page, text in texts.items():
        # docs/site/index.md becomes a page beside README
        folder = root if page.parent.name == "site" else page.parent
        for target in LINK.findall(CODE.sub("", FENCE.sub("", text))):
            path, _, anchor = target.partition("#")
            if re.match(r"[a-z]+:", target) or MADE.match(target):
                continue
            there = (folder / path).resolve() if path else page
            if not there.exists():
                yield "{}: '{}' is not there".format(page.relative_to(root), target)
            elif anchor and there in anchors and anchor not in anchors[there]:
                yield "{}: '{}': that page has no such heading".format(page.relative_to(root), target)


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "docs").is_dir():
        print("usage: check_links.py ROOT  (the folder that has docs)", file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = sorted({page.resolve() for pattern in PAGES for page in root.glob(pattern)})
    found = list(problems(root, pages))
    print("\n".join([*found, "{} files".format(len(pages))]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
