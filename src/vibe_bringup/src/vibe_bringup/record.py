"""Records a running ROS graph."""

import os
import sys

from . import cli, places

DESCRIPTION = """\
Records the ROS graph that ROS_MASTER_URI names (default: this machine) until Ctrl-C: inputs, events and all that a
replay cannot compute again, and of the rest enough to look at it. Loses no message. It may begin at any time."""


def parse(words):
    made = cli.Parser("record", "[options]", DESCRIPTION)
    add = made.options.add_argument
    add("--output", metavar="FILE", help="the recording (default: sessions/<date-time>.bag)")
    add("--duration", metavar="S", type=cli.whole("whole seconds above zero"), default=0, help="end after S seconds")
    add("--all", action="store_true", help="record every message of every topic (7 MB per second)")
    arguments = made.parse(words)
    arguments.free_name = not arguments.output  # another recorder may begin in the same second
    arguments.output = arguments.output or places.output_folder("sessions/{}.bag".format(cli.time_stamp()))
    if not arguments.free_name and os.path.exists(arguments.output):
        made.error("--output: '{}' is there already; give another path".format(arguments.output))
    made.check_output(os.path.dirname(arguments.output) or ".")
    return arguments


def run(arguments):
    from .graph import answers

    uri = os.environ.get("ROS_MASTER_URI", "http://localhost:11311")
    if not answers(uri):
        print("record: no ROS master answers at {}; start one, or set ROS_MASTER_URI to that of yours (http://HOST:PORT)".format(uri), file=sys.stderr)
        return 1
    os.makedirs(os.path.dirname(arguments.output) or ".", exist_ok=True)
    command = [places.program("vibe_sim", "vibe_record"), *cli.words_of(arguments, "all", "free_name"), arguments.output]
    # timeout with 0 is no limit
    return cli.become(["timeout", "--signal=INT", "--preserve-status", str(arguments.duration), *command])
