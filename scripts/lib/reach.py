"""Reads changed paths, one per line, and prints what they reach: packages that have changed or depend on one that has
(package.xml), other folders of the workspace, and names of scripts in scripts/test.d. Usage: reach.py ROOT"""

import pathlib
import re
import sys

OWN_DEPENDENCY = re.compile(r"depend[^>]*>\s*(vibe_\w+)")


def area(path):
    """What a changed path belongs to."""
    if path.match("scripts/test.d/*.sh"):
        return path.stem
    return path.parts[1] if path.parts[0] == "src" and len(path.parts) > 1 else path.parts[0]


def main():
    files = pathlib.Path(sys.argv[1]).glob("src/*/package.xml")
    needs = {file.parent.name: set(OWN_DEPENDENCY.findall(file.read_text(encoding="utf-8"))) for file in files}
    reached = {area(pathlib.PurePath(line)) for line in sys.stdin.read().splitlines()}
    size = 0
    while size < len(reached):
        size = len(reached)
        reached |= {package for package, needed in needs.items() if needed & reached}
    print("\n".join(sorted(reached)))


if __name__ == "__main__":
    main()
