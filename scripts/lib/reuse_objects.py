#!/usr/bin/env python3
"""Copies object files from one build of a package into another, freshly configured build of a copy of its sources.

An object is copied only if both builds compile the file with the same command, apart from the folders and the macro
that catkin defines for its own headers, if the two source files are equal, and if the object is newer than every file
that it was compiled from. make then compiles only the rest. Prints how many objects were copied, and of how many.

usage: reuse_objects.py FROM_BUILD FROM_SOURCE TO_BUILD TO_SOURCE
"""

import filecmp
import json
import pathlib
import shlex
import shutil
import sys

IGNORED = {'-DROS_BUILD_SHARED_LIBS=1'}


def read_commands(build, source):
    """Key: source file below the package and object's target. Value: command without folders, and the object file."""
    commands = {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        if not entry['file'].startswith(f'{source}/'):
            continue
        words = [word for word in shlex.split(entry['command']) if word not in IGNORED]
        while 'ccache' in words[0]:
            words.pop(0)
        place = words.index('-o')
        output = words[place + 1]
        del words[place:place + 2]
        target = next(part for part in output.split('/') if part.endswith('.dir'))
        key = (entry['file'][len(str(source)) + 1:], target)
        plain = [word.replace(str(source), 'SOURCE') for word in words]
        commands[key] = (plain, pathlib.Path(entry['directory']) / output)
    return commands


def newest_input(made, source):
    """Time of the newest file that an object was compiled from; without the compiler's list, of the newest header."""
    listed = pathlib.Path(f'{made}.d')
    if listed.is_file():
        files = [pathlib.Path(word) for word in shlex.split(listed.read_text().replace('\\\n', ' '))[1:]]
    else:
        files = [file for folder in ('include', 'src') for file in (source / folder).rglob('*.hpp')]
    return max(file.stat().st_mtime if file.is_file() else float('inf') for file in files)


def main():
    if len(sys.argv) != 5:
        print(__doc__.strip().splitlines()[-1], file=sys.stderr)
        return 2
    from_build, from_source, to_build, to_source = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    known = read_commands(from_build, from_source)
    wanted = read_commands(to_build, to_source)
    copied = 0
    for key, (command, target) in wanted.items():
        same, made = known.get(key, (None, None))
        if same != command or not made.is_file():
            continue
        if made.stat().st_mtime < max((from_source / key[0]).stat().st_mtime, newest_input(made, from_source)):
            continue
        if not filecmp.cmp(from_source / key[0], to_source / key[0], shallow=False):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(made, target)
        copied += 1
    print(f'{copied} of {len(wanted)} objects')
    return 0


if __name__ == '__main__':
    sys.exit(main())
