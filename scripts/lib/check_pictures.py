#!/usr/bin/env python3
"""Checks the age of the pictures in docs/pictures against docs/pictures/made.csv: how each was made, when, and the digest of
the sources that decide what it shows. A picture whose sources have changed since is taken anew and looked at, and then

    scripts/lib/check_pictures.py ROOT --made PICTURE...

writes its date and digest. `compared` in the place of a digest: a test compares the picture with what is drawn now.
`older`: it shows an earlier version, which the next one who makes it mends.

Prints FILE: PROBLEM, and at the end how many files it has looked at. Exit status: 0 nothing found, 1 something found,
2 wrong call.
"""

import argparse
import csv
import datetime
import fnmatch
import hashlib
import pathlib
import sys


def digest(root, shows):
    """Of paths and bytes of files and folders, as 12 hexadecimal digits."""
    found = hashlib.sha256()
    for name in shows.split():
        here = root / name
        if not here.exists():
            return None
        for file in [here] if here.is_file() else sorted(here.rglob("*")):
            if file.is_file() and "__pycache__" not in file.parts:
                found.update(file.relative_to(root).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return found.hexdigest()[:12]


def problems(root, rows, pictures):
    for picture in pictures:
        of_it = [row for row in rows if fnmatch.fnmatch(picture, row["picture"])]
        if len(of_it) != 1:
            yield picture, "has {} rows in made.csv; give it one".format(len(of_it))
    for row in rows:
        now = digest(root, row["shows"])
        if not fnmatch.filter(pictures, row["picture"]):
            yield row["picture"], "is in made.csv and not in the folder; remove one of them"
        elif now is None:
            yield row["picture"], "shows '{}', of which not all is there; mend made.csv".format(row["shows"])
        elif row["digest"] not in ("compared", "older", now):
            yield row["picture"], (
                "is of {date}, and what it shows has changed since ({shows}); make it anew ({command}), look at it, and run "
                "scripts/lib/check_pictures.py . --made '{picture}'").format(**row)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path, help="the workspace")
    parser.add_argument("--made", nargs="+", default=[], metavar="PICTURE", help="as in the table: it has been made now")
    arguments = parser.parse_args()
    folder = arguments.root / "docs/pictures"
    with open(folder / "made.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if unknown := set(arguments.made) - {row["picture"] for row in rows}:
        parser.error("made.csv has no picture '{}'".format("', '".join(sorted(unknown))))
    for row in rows:
        if row["picture"] in arguments.made:
            row.update(date=datetime.date.today().isoformat(), digest=digest(arguments.root, row["shows"]))
    if arguments.made:
        with open(folder / "made.csv", "w", newline="", encoding="utf-8") as file:  # not whole: git keeps what was there
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    pictures = sorted(file.name for file in folder.iterdir() if file.suffix in (".png", ".svg"))
    found = list(problems(arguments.root, rows, pictures))
    for name, problem in found:
        print("docs/pictures/{}: {}".format(name, problem))
    print("{} files".format(len(pictures)))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
