"""Options of the export, and their checks. Standard library only: a call is checked before anything is built."""

import argparse
import difflib
import importlib.util
import sys

FORMATS = ("csv", "parquet", "mcap", "lerobot", "mesh")
PACKAGES = {"parquet": "pyarrow", "lerobot": "pyarrow"}  # which a format needs from outside Debian
DESCRIPTION = """\
Writes recorded sessions in formats that others read: tables of topics (csv, parquet), messages of ROS 2 (mcap), a data
set for learning (lerobot) and the moving wall (mesh: USD and PLY). docs/export.md has what is in the files."""
EPILOG = """\
Each format is a folder DIR/SESSION/FORMAT, that of lerobot DIR/lerobot. A format that is complete is kept: after an
interruption the same command goes on. The same call gives the same bytes. Ends with status 0, or 2 after one sentence."""


def seconds(text):
    try:
        value = float(text)
    except ValueError:
        value = -1
    if not 0 <= value < 1e10:
        raise argparse.ArgumentTypeError("needs seconds, not '{}'".format(text))
    return value


def hertz(text):
    try:
        value = float(text)
    except ValueError:
        value = 0
    if not 0 < value <= 1e5:
        raise argparse.ArgumentTypeError("needs a rate above zero in Hz, not '{}'".format(text))
    return value


def words(text):
    found = [each.strip() for each in text.split(",") if each.strip()]
    if not found:
        raise argparse.ArgumentTypeError("needs names with commas between them, not '{}'".format(text))
    return found


def formats(text):
    for each in words(text):
        if each not in FORMATS:
            near = difflib.get_close_matches(each, FORMATS, 1, 0.3)
            hint = "the nearest is '{}'; ".format(near[0]) if near else ""
            raise argparse.ArgumentTypeError("'{}' is no format; {}there are {}".format(each, hint, ", ".join(FORMATS)))
    return [each for each in FORMATS if each in words(text)]


def add_options(made):
    made.add_argument("bags", nargs="*", metavar="BAG", help="a recording, or a folder with recordings below it")
    made.add_argument("--to", type=formats, metavar="LIST", help="formats with commas between them: " + ",".join(FORMATS))
    made.add_argument("--output", metavar="DIR", help="folder to write to")
    made.add_argument("--topics", type=words, metavar="LIST", help="of csv, parquet and mcap: only these topics, as "
                      "scope/measured_cf or 'scope/*'")  # fmt: skip
    made.add_argument("--from", dest="begin", type=seconds, metavar="S", help="begin, as a stamp (simulated time begins "
                      "at 1 s)")  # fmt: skip
    made.add_argument("--to-time", dest="end", type=seconds, metavar="S", help="end, as a stamp")
    made.add_argument("--rate", type=hertz, metavar="HZ", help="at most so many messages of a topic, frames or meshes per "
                      "second (default: all; of lerobot 30, of mesh those of the recording)")  # fmt: skip
    made.add_argument("--fill", action="store_true", help="repeat a compact recording first, so that it has every message "
                      "of every topic; lerobot does so anyway, and mesh where --rate asks for it")  # fmt: skip
    made.add_argument("--images", metavar="DIR", help="of lerobot: the images that scripts/dataset wrote of the only "
                      "recording, as a video")  # fmt: skip
    made.add_argument("--lerobot-version", choices=("v3.0", "v2.1"), default="v3.0", help="of its format (default: "
                      "%(default)s; v2.1: Open-H-Embodiment)")  # fmt: skip


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print("export: {} (--help lists what there is)".format(message), file=sys.stderr)
        sys.exit(2)


def parser():
    made = Parser(prog="export", usage="rosrun vibe_sessions export BAG... --to LIST --output DIR [options]",
                  description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                  formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    add_options(made)
    return made


def check(arguments, fail):
    if not arguments.bags:
        fail("which recording?")
    if not arguments.to:
        fail("to which format? --to {}".format(",".join(FORMATS)))
    if not arguments.output:
        fail("where to? --output DIR")
    if arguments.end is not None and arguments.end <= (arguments.begin or 0):
        fail("--to-time must be later than --from; exchange their values")
    if "lerobot" in arguments.to and arguments.rate and (arguments.rate != int(arguments.rate)):
        fail("--rate of lerobot must be a whole number, not {:g}".format(arguments.rate))
    for name in arguments.to:
        if name in PACKAGES and importlib.util.find_spec(PACKAGES[name]) is None:
            fail("--to {} needs the Python package {}, which is not there; `pip install {}`, or leave {} out".format(
                name, PACKAGES[name], PACKAGES[name], name))  # fmt: skip
