"""What the programs share on the command line: help, and one clear line on a wrong call. Standard library only:
scripts/* check a call (--check) before anything is installed or built.

A program NAME is a module with two functions: parse(words) returns its arguments, or ends it; run(arguments) returns its
exit status and imports what is more than the standard library. parts(arguments), if there is one, returns the parts of the
workspace that it needs.
"""

import argparse
import errno
import importlib
import os
import re
import sys
import textwrap
import time

from . import places


class Formatter(argparse.RawDescriptionHelpFormatter):
    """Line breaks of a text are kept; 'Usage' is written as everywhere."""

    def __init__(self, prog):
        super().__init__(prog, max_help_position=24, width=120)

    def add_usage(self, usage, actions, groups, prefix=None):
        super().add_usage(usage, actions, groups, "Usage: ")

    def _split_lines(self, text, width):
        return [line for part in text.splitlines() for line in textwrap.wrap(part, width)]


class Parser(argparse.ArgumentParser):
    """`usage` is what follows the name of the program. Options are added to `options`, and to groups."""

    def __init__(self, name, usage, description, epilog=None, package="vibe_bringup"):
        self.name = name
        prog = "rosrun {} {}".format(package, name)
        if "VIBE_WORKSPACE" in os.environ:
            prog = "scripts/" + name
            description += "\nInstalls and builds first what is missing; with --force also on other systems than Debian 12 and 13."
        super().__init__(
            prog=prog, usage="{} {}".format(prog, usage), description=description, epilog=epilog, add_help=False,
            allow_abbrev=False, formatter_class=Formatter,
        )  # fmt: skip
        self.options = self.add_argument_group()

    def error(self, message):
        """Ends the program with one line; what argparse says is put into the words of this project."""
        found = re.fullmatch(r"argument ([^:]+): (.*)", message, re.DOTALL)
        if found:
            option, message = found.group(1), found.group(2)
            if message.startswith("expected"):
                message = "needs a value"
            if option.startswith("-"):
                message = option + (" " if message.startswith("needs ") else ": ") + message
        print("{}: {} ({} --help lists what there is)".format(self.name, message, self.prog), file=sys.stderr)
        sys.exit(2)

    def parse(self, words):
        self.options.add_argument("--help", action="help", help="print this text and end")
        arguments, unknown = self.parse_known_intermixed_args(words)
        if unknown:
            self.error("unknown option '{}'".format(unknown[0]))
        return arguments

    def check_output(self, folder):
        """The absolute path of a folder that can be made and written to; leaves nothing that was not there."""
        folder = os.path.realpath(folder)
        made = places.missing_folders(folder)
        try:
            os.makedirs(folder, exist_ok=True)
            reason = "" if os.access(folder, os.W_OK) else os.strerror(errno.EACCES)
        except FileExistsError:
            reason = "it is a file"
        except OSError as error:
            reason = error.strerror
        places.remove_empty(made)
        if reason:
            words = "--output: cannot write to '{}' ({}); give a folder that you may write to"
            self.error(words.format(folder, reason))
        return folder


# --- types of values


def no_file(text, path):
    """Why a path is not that of a file, in the words of who called."""
    return ("'{}' is a folder, not a file" if os.path.isdir(path) else "there is no file '{}'").format(text)


def file(text):
    """The absolute path of a file that is there; it may be given as package://PACKAGE/PATH."""
    path = places.find(text)
    if not os.path.isfile(path):
        raise argparse.ArgumentTypeError(no_file(text, path))
    if not os.access(path, os.R_OK):
        raise argparse.ArgumentTypeError("'{}' cannot be read".format(text))
    return os.path.realpath(path)


def matching(pattern, what, kind=str):
    """A value whose text is matched by a pattern; `what` it needs."""

    def read(text):
        if not re.fullmatch(pattern, text):
            raise argparse.ArgumentTypeError("needs {}, not '{}'".format(what, text))
        return kind(text)

    return read


def positive(what="a number above zero"):
    return matching(r"(?=.*[1-9])(\d+\.?\d*|\.\d+)", what, float)


def whole(what="a number above zero", digits=9):
    return matching(r"[1-9]\d{{0,{}}}".format(digits - 1), what, int)


def time_stamp():
    return time.strftime("%Y-%m-%d-%H%M%S")


# --- a recording among the words


def add_recording(parser):
    parser.add_argument("bags", nargs="*", metavar="BAG", help=argparse.SUPPRESS)


def recording(parser, arguments):
    """The absolute path of the only recording."""
    for bag in arguments.bags[1:]:
        parser.error("one recording at a time, not '{}' as well".format(bag))
    return recordings(parser, arguments)[0]


def recordings(parser, arguments):
    """The absolute paths of the recordings."""
    if not arguments.bags:
        parser.error("which recording?")
    for bag in arguments.bags:
        if not os.path.isfile(bag):
            parser.error(no_file(bag, bag))
    return [os.path.realpath(bag) for bag in arguments.bags]


# --- programs


def words_of(arguments, *names):
    """The words of these options, as far as they are given, for a program that takes the same ones."""
    words = []
    for name in names:
        value, option = getattr(arguments, name), "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words += [option, str(value)]
    return words


def become(command):
    """Goes on as this command."""
    os.execvp(command[0], command)


def start(name):
    """The program NAME; with --check before its words it ends after these are found to be right, and prints which parts
    of the workspace it needs (scripts/lib/parts.sh)."""
    words = sys.argv[1:]
    only_check = words[:1] == ["--check"]
    module = importlib.import_module("vibe_bringup." + name)
    arguments = module.parse(words[only_check:])
    if only_check:
        print("needs:", *(module.parts(arguments) if hasattr(module, "parts") else ["session"]))
        return
    try:
        sys.exit(module.run(arguments))
    except OSError as error:  # a folder, a disk, a program that is missing
        where = " '{}'".format(error.filename) if error.filename else ""
        print("{}: {}{}".format(name, error.strerror or error, where), file=sys.stderr)
        sys.exit(1)
