"""A recorded session goes through the simulator again, or into rviz. The command line; see view_replay.py."""

import argparse
import os

from . import cli, places

DESCRIPTION = """\
Feeds the inputs that a recorded session used, step by step, through the simulator, without a ROS master, compares every
step with the recording, and prints the summary of the session. Several BAGs are the parts of a split recording."""
EPILOG = """\
Ends with status 0 if all steps are the same, 1 if one differs, 2 if the recording cannot be repeated, 3 if it could not
be checked, or not all of it."""


def new_file(text):
    if os.path.exists(text):
        raise argparse.ArgumentTypeError("'{}' is there already; give another path".format(text))
    return os.path.realpath(text)


def parse(words):
    made = cli.Parser("replay", "[options] BAG...", DESCRIPTION, EPILOG)
    add = made.options.add_argument
    cli.add_recording(made)
    add("--from", metavar="S", help="begin at the last snapshot before S seconds")
    add("--to", metavar="S", help="end after S seconds")
    add("--fill", metavar="FILE", type=new_file, help="also write a bag with every message of every topic that the "
        "simulator sent")  # fmt: skip
    add("--list", action="store_true", help="list the sessions of the recording and end: a simulator that was started "
        "again, or several in namespaces")  # fmt: skip
    add("--session", metavar="S", help="which of them: its number in the list, or the beginning of its identity "
        "(default: the first)")  # fmt: skip
    add("--namespace", metavar="NS", help="the first session in this namespace")
    add("--view", action="store_true", help="show the session in rviz instead, with a bar to go to any time")
    arguments = made.parse(words)
    arguments.bags = cli.recordings(made, arguments)
    words = cli.words_of(arguments, "from", "to", "fill", "list")
    arguments.words = words + cli.words_of(arguments, "session", "namespace")
    if arguments.view and words:
        made.error("--view goes without {}".format(words[0]))
    if arguments.view and len(arguments.bags) > 1:
        made.error("--view shows one BAG; without it the parts of a split recording are replayed")
    if arguments.view and not os.environ.get("DISPLAY"):
        made.error("--view needs a display, but DISPLAY is not set")
    return arguments


def run(arguments):
    if arguments.view:
        from .view_replay import view

        return view(arguments)
    return cli.become([places.program("vibe_sim", "vibe_replay"), *arguments.words, *arguments.bags])
