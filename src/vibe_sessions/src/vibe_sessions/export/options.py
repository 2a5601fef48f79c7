"""Options of the export, and their checks. Standard library only: a call is checked before anything is built."""

import argparse
import difflib
import importlib.util

from ..report.options import Parser

FORMATS = ("csv", "parquet", "mcap", "lerobot", "mesh", "gltf")
DESCRIPTION = """\
Writes recorded sessions in formats that others read: tables of topics (csv, parquet), messages of ROS 2 (mcap), a data
set for learning (lerobot) and the moving wall (mesh: USD and PLY; gltf). docs/export.md has what is in the files."""
EPILOG = """\
Each format is a folder DIR/SESSION/FORMAT, that of lerobot DIR/lerobot. A format that is complete is kept: after an
interruption the same command goes on. The same call gives the same bytes. Ends with status 0, or 2 after one sentence."""


def number(unit, least):
    def read(text):
        try:
            value = float(text)
        except ValueError:
            value = -1
        if not least <= value < 1e10:
            raise argparse.ArgumentTypeError("needs {} from {:g} on, not '{}'".format(unit, least, text))
        return value

    return read


def words(text):
    return [each.strip() for each in text.split(",") if each.strip()]


def formats(text):
    for each in words(text):
        if each not in FORMATS:
            near = difflib.get_close_matches(each, FORMATS, 1, 0)[0]
            raise argparse.ArgumentTypeError("'{}' is no format; the nearest is '{}'".format(each, near))
    return [each for each in FORMATS if each in words(text)]


def add_options(made):
    add = made.add_argument
    add("bags", nargs="*", metavar="BAG", help="a recording, or a folder with recordings below it")
    add("--to", type=formats, metavar="LIST", help="formats with commas between them: " + ",".join(FORMATS))
    add("--output", metavar="DIR", help="folder to write to")
    add("--topics", type=words, metavar="LIST", help="of csv, parquet and mcap: only these, as scope/measured_cf or 'scope/*'")
    add("--from", dest="begin", type=number("seconds", 0), metavar="S", help="begin, as a stamp (simulated time begins at 1 s)")
    add("--to-time", dest="end", type=number("seconds", 0), metavar="S", help="end, as a stamp")
    add("--rate", type=number("Hz", 0.001), metavar="HZ", help="at most so many messages of a topic, frames or meshes per second "
        "(default: all; of lerobot 30, of mesh and gltf those of the recording)")  # fmt: skip
    add("--fill", action="store_true", help="repeat a compact recording first, so that it has every message of every topic; "
        "lerobot does so anyway, and mesh and gltf where --rate asks for it")  # fmt: skip
    add("--images", metavar="DIR", help="of lerobot: what scripts/dataset wrote of the only recording, as a video "
        "(default: the pictures in the recording, if it has some)")
    add("--lerobot-version", choices=("v3.0", "v2.1"), default="v3.0", help="of its format (default: %(default)s)")


def parser():
    made = Parser(prog="export", usage="rosrun vibe_sessions export BAG... --to LIST --output DIR [options]",
                  description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                  formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    add_options(made)
    return made


def check(arguments, fail):
    for value, question in ((arguments.bags, "which recording?"), (arguments.to, "to which format? --to LIST"),
                            (arguments.output, "where to? --output DIR"),
                            (arguments.topics != [], "which topics? --topics LIST")):  # fmt: skip
        if not value:
            fail(question)
    if arguments.end is not None and arguments.end <= (arguments.begin or 0):
        fail("--to-time must be later than --from; exchange their values")
    if "lerobot" in arguments.to and arguments.rate and not arguments.rate.is_integer():
        fail("--rate of lerobot must be a whole number, not {:g}".format(arguments.rate))
    for name in sorted({"parquet", "lerobot"} & set(arguments.to)):
        if importlib.util.find_spec("pyarrow") is None:
            fail("--to {} needs the Python package pyarrow, which is not there; in a sourced shell `pip install --target tools 'pyarrow<24' av` and "
                 "`PYTHONPATH=$PYTHONPATH:tools rosrun vibe_sessions export` give it, or leave {} out".format(name, name))  # fmt: skip
