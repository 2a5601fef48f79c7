#!/usr/bin/env python3
"""Writes mesh files of all four formats, valid and wrong by the rules of their standards, and what is right for each.

usage: make_mesh_files.py FOLDER [--count N] [--seed N]

FOLDER/expected.tsv has a line for each file:
    NAME  loads  VOLUME  AREA  X  Y  Z  VERTICES  TRIANGLES    the closed surface with its centroid, in units of the file
    NAME  refused  WORDS                                       words that the reason contains
"""

import argparse
import pathlib
import random as randomness

import gltf_files
import obj_files
import ply_files
import stl_files
from shapes import IN_ITS_PLACE, Case

FORMATS = {".obj": obj_files, ".stl": stl_files, ".ply": ply_files, ".glb": gltf_files}


def cases(count, seed):
    random = randomness.Random(seed)
    others = [Case(f"other_{k}{ending}", content, refused=words)
              for ending in (*FORMATS, ".gltf") for k, (content, words) in enumerate(IN_ITS_PLACE)]
    yield from others
    left = count - len(others)
    for k, module in enumerate(FORMATS.values()):
        yield from module.cases(random, left * (k + 1) // 4 - left * k // 4)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    lines = []
    for case in cases(arguments.count, arguments.seed):
        (arguments.folder / case.name).write_bytes(case.content)
        for name, content in case.beside.items():
            (arguments.folder / name).write_bytes(content)
        lines.append("\t".join(case.expectation()) + "\n")
    (arguments.folder / "expected.tsv").write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
