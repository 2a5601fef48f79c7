"""Pictures of what the endoscope sees. The command line; see take_views.py."""

import argparse

from . import cli, places
from .view_list import VIEWS

DESCRIPTION = """\
Runs sessions without a screen, stops them at fixed simulated times and saves the image of endoscope_camera there as
eye_VIEW.png, and all of them as eye_views.png. Views: rest (collapsed), 5mmhg, 10mmhg, antrum, retroflexed, near
(2 mm before the wall), touched (the wall lies on the lens), marked, sutured, bleeding, smoke (after a mark), scar (five
minutes later, beside a new one); default: all of them."""


def view(text):
    for each in VIEWS:
        if each.name == text:
            return each
    raise argparse.ArgumentTypeError("there is no view '{}'; see --help".format(text))


def parse(words):
    made = cli.Parser("views", "[options] [VIEW...]", DESCRIPTION)
    made.add_argument("views", nargs="*", type=view, help=argparse.SUPPRESS)
    add = made.options.add_argument
    add("--size", metavar="WxH", type=cli.matching(r"[1-9]\d{1,3}x[1-9]\d{1,3}", "WIDTHxHEIGHT in pixels"),
        default="640x480", help="pixels of a picture (default: %(default)s)")  # fmt: skip
    add("--output", metavar="DIR", default=places.output_folder("docs/pictures"), help="folder for the pictures "
        "(default: docs/pictures)")  # fmt: skip
    add("--truth", action="store_true", help="also save labels and depth of every pixel, as eye_VIEW.npz")
    arguments = made.parse(words)
    arguments.views = arguments.views or VIEWS
    arguments.output = made.check_output(arguments.output)
    return arguments


def run(arguments):
    from .take_views import take_all

    return take_all(arguments)
