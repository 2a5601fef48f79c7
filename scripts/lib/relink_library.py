#!/usr/bin/env python3
"""Links a library of a build once more, with some of its files compiled by another compiler.

The rest of the objects, all options but those for warnings, and the libraries are those of the build, which is not
changed. Prints how many files were compiled.

usage: relink_library.py BUILD TARGET COMPILER OUTPUT PATTERN
  BUILD has compile_commands.json, TARGET is the name of the library in CMake, PATTERN a regular expression for files
"""

import json
import pathlib
import re
import shlex
import subprocess
import sys


def commands(build, target):
    """Object of the target, as its linker names it -> (source, folder, words of the compiler)."""
    found = {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        words = shlex.split(entry['command'])
        made = words[words.index('-o') + 1]
        if f'/{target}.dir/' in f'/{made}':
            found[made] = (entry['file'], pathlib.Path(entry['directory']), words)
    return found


def compile_with(compiler, words, folder, made):
    """Compiles as the build does, without warnings: those of another compiler are not the subject."""
    while 'ccache' in words[0]:
        words = words[1:]
    words = [word for word in words[1:] if not word.startswith('-W')]
    words[words.index('-o') + 1] = str(made)
    subprocess.run([compiler, '-w', *words], cwd=folder, check=True)


def link(folder, target, replaced, output):
    """Links as the build does, with other objects."""
    words = shlex.split((folder / 'CMakeFiles' / f'{target}.dir' / 'link.txt').read_text())
    words[words.index('-o') + 1] = str(output)
    subprocess.run([str(replaced.get(word, word)) for word in words], cwd=folder, check=True)


def main():
    if len(sys.argv) != 6:
        print('\n'.join(__doc__.strip().splitlines()[-2:]), file=sys.stderr)
        return 2
    build, target, compiler, output, pattern = sys.argv[1:]
    output = pathlib.Path(output).resolve()
    known = commands(pathlib.Path(build).resolve(), target)
    chosen = {made: known[made] for made in known if re.search(pattern, known[made][0])}
    if not chosen:
        print(f"relink_library: no file of {target} matches '{pattern}'; is the build up to date?", file=sys.stderr)
        return 1
    output.parent.mkdir(parents=True, exist_ok=True)
    replaced = {made: output.parent / f'{number}.o' for number, made in enumerate(chosen)}
    for made, (_, folder, words) in chosen.items():
        compile_with(compiler, words, folder, replaced[made])
    link(folder, target, replaced, output)
    print(f'{len(chosen)} of {len(known)} files were compiled by {compiler}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
