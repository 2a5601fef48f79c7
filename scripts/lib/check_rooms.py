#!/usr/bin/env python3
"""Checks that the rooms of a package include each other only downwards.

The order of the rooms is a numbered table, lowest first, below the heading "Rooms of PACKAGE" of docs/architecture.md;
every package that has one is checked. Prints FILE:LINE: PROBLEM for every
- file that lies in no room of the table,
- include of a room that stands later in the table than the file's own,
- include of a header that does not exist in its room,
- internal header included by its bare name,
- internal header included by a public one.
The last line says how many files it has looked at. Exit status: 0 nothing found, 1 something found, 2 wrong call.
"""

import pathlib
import re
import sys

HEADING = re.compile(r'^## (?:Rooms of `?(\w+)`?$)?')
ROW = re.compile(r'^\| *\d+ *\| *`(\w+)` *\|')
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SUFFIXES = {'.hpp', '.cpp', '.h', '.inl'}
looked = []  # files


def read_orders(page):
    """{package: {room: place}}"""
    orders, order = {}, {}
    for line in page.read_text(encoding='utf-8').splitlines():
        heading, row = HEADING.match(line), ROW.match(line)
        if heading:
            order = orders.setdefault(heading.group(1), {}) if heading.group(1) else {}
        elif row:
            order[row.group(1)] = len(order)
    if not orders or not all(orders.values()):
        sys.exit(f'check_rooms.py: {page} has no numbered table of rooms below each heading "Rooms of PACKAGE"')
    return orders


def target(package, quote, name):
    """Room and kind of what an include names, or None for a header from elsewhere; a sentence where it is wrong."""
    parts = name.split('/')
    if parts[0] == package.name:
        if len(parts) != 3 or not (package / 'include' / name).is_file():
            return None, f'"{name}" is no public header'
        return (parts[1], 'public'), None
    if (package / 'src' / parts[0]).is_dir() and len(parts) > 1:
        exists = (package / 'src' / name).is_file()
        return ((parts[0], 'internal'), None) if exists else (None, f'"{name}" is no header of the room {parts[0]}')
    if quote == '"' and not (package.parent / parts[0]).is_dir():
        return None, f'"{name}" does not name its room; write "ROOM/{parts[-1]}"'
    return None, None


def problems_of_file(package, file, room, public, order):
    for number, line in enumerate(file.read_text(encoding='utf-8').splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        found, wrong = target(package, *match.groups())
        if found and found[0] not in order:
            wrong = f'includes "{match.group(2)}", whose room is not in the table of docs/architecture.md'
        elif found and order[found[0]] > order[room]:
            wrong = f'{room} includes "{match.group(2)}", but {found[0]} comes after {room} in the order of the rooms'
        elif found and public and found[1] == 'internal':
            wrong = f'a public header includes the internal "{match.group(2)}"'
        if wrong:
            yield f'{number}: {wrong}'


def problems_of_package(root, package, order):
    public = package / 'include' / package.name
    for folder in (public, package / 'src'):
        for file in sorted(folder.rglob('*')):
            if file.suffix not in SUFFIXES:
                continue
            looked.append(file)
            room = file.relative_to(folder).parts[0]
            name = file.relative_to(root)
            if room not in order:
                yield f'{name}:1: lies in no room of the table of docs/architecture.md'
                continue
            for problem in problems_of_file(package, file, room, folder == public, order):
                yield f'{name}:{problem}'


def problems(root):
    for package, order in read_orders(root / 'docs' / 'architecture.md').items():
        yield from problems_of_package(root, root / 'src' / package, order)


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / 'src' / 'vibe_core').is_dir():
        print('usage: check_rooms.py ROOT  (the folder that has src/vibe_core and docs)', file=sys.stderr)
        return 2
    found = list(problems(pathlib.Path(sys.argv[1])))
    print('\n'.join([*found, f'{len(looked)} files']))
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
