"""Pictures of what the endoscope sees. The command line, and the views; see take_views.py."""

import argparse
import collections

from . import cli, places

View = collections.namedtuple("View", "name session seconds followed", defaults=(None,))
# followed: from when on the camera listens, for what depends on the past: smoke, and the colour of marks
SESSIONS = {  # script, and what differs from the default scene
    "eye": ("eye", {}),
    "states": ("five_states", {}),
    "bleeding": ("five_states", {"mild_probability": 1.0, "brisk_probability": 0.0}),
}
VIEWS = [
    View("rest", "eye", 1.9),
    View("5mmhg", "eye", 5.6),
    View("10mmhg", "eye", 16.0),
    View("antrum", "eye", 21.5),
    View("retroflexed", "eye", 35.5),
    View("marked", "states", 48.0),
    View("sutured", "states", 89.5),
    View("bleeding", "bleeding", 89.5),
    View("smoke", "eye", 48.4, followed=45.0),
    View("scar", "eye", 332.0, followed=45.0),
]
DESCRIPTION = """\
Runs sessions without a screen, stops them at fixed simulated times and saves the image of endoscope_camera there as
eye_VIEW.png, and all of them as eye_views.png. Views: rest (collapsed), 5mmhg, 10mmhg, antrum, retroflexed, marked,
sutured, bleeding, smoke (after a mark), scar (five minutes later, beside a new one); default: all of them."""


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
