#!/usr/bin/env python3
"""Checks that the rooms of vibe_core include each other only downwards.

The order of the rooms is the numbered table in docs/architecture.md, lowest first. Prints FILE:LINE: PROBLEM for every
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

ROW = re.compile(r'^\| *\d+ *\| *`(\w+)` *\|')
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SUFFIXES = {'.hpp', '.cpp', '.h', '.inl'}
looked = []  # files


def read_order(table):
    rooms = [match.group(1) for match in map(ROW.match, table.read_text(encoding='utf-8').splitlines()) if match]
    if not rooms:
        sys.exit(f'check_rooms.py: {table} has no numbered table of rooms')
    return {room: place for place, room in enumerate(rooms)}


def target(core, quote, name):
    """Room and kind of what an include names, or None for a header from elsewhere; a sentence where it is wrong."""
    parts = name.split('/')
    if parts[0] == 'vibe_core':
        if len(parts) != 3 or not (core / 'include' / name).is_file():
            return None, f'"{name}" is no public header'
        return (parts[1], 'public'), None
    if (core / 'src' / parts[0]).is_dir() and len(parts) > 1:
        exists = (core / 'src' / name).is_file()
        return ((parts[0], 'internal'), None) if exists else (None, f'"{name}" is no header of the room {parts[0]}')
    if quote == '"':
        return None, f'"{name}" does not name its room; write "ROOM/{parts[-1]}"'
    return None, None


def problems_of_file(core, file, room, public, order):
    for number, line in enumerate(file.read_text(encoding='utf-8').splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        found, wrong = target(core, *match.groups())
        if found and found[0] not in order:
            wrong = f'includes "{match.group(2)}", whose room is not in the table of docs/architecture.md'
        elif found and order[found[0]] > order[room]:
            wrong = f'{room} includes "{match.group(2)}", but {found[0]} comes after {room} in the order of the rooms'
        elif found and public and found[1] == 'internal':
            wrong = f'a public header includes the internal "{match.group(2)}"'
        if wrong:
            yield f'{number}: {wrong}'


def problems(root):
    core = root / 'src' / 'vibe_core'
    order = read_order(root / 'docs' / 'architecture.md')
    for folder in (core / 'include' / 'vibe_core', core / 'src'):
        for file in sorted(folder.rglob('*')):
            if file.suffix not in SUFFIXES:
                continue
            looked.append(file)
            room = file.relative_to(folder).parts[0]
            name = file.relative_to(root)
            if room not in order:
                yield f'{name}:1: lies in no room of the table of docs/architecture.md'
                continue
            for problem in problems_of_file(core, file, room, folder.name == 'vibe_core', order):
                yield f'{name}:{problem}'


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / 'src' / 'vibe_core').is_dir():
        print('usage: check_rooms.py ROOT  (the folder that has src/vibe_core and docs)', file=sys.stderr)
        return 2
    found = list(problems(pathlib.Path(sys.argv[1])))
    print('\n'.join([*found, f'{len(looked)} files']))
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
