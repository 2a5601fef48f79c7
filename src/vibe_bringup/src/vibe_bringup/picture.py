"""Pictures of rviz at given times of a session. The command line; see take_pictures.py."""

import argparse
import collections
import re
import shutil
import sys

from . import cli, places
from .run import trainee

Picture = collections.namedtuple("Picture", "name seconds view")

# of demo/five_states.yaml: insufflated; marked and burnt; a grab drawn in; a set of bites with its T-tag; drawn tight
STATES = ("rest=10", "marked=48", "grabbed=53.5", "sutured=89.5", "cinched=95.3")
FEWEST_COLOURS = 5000  # the scene is black before the first frame, has few without the organ, some 30,000 with it
NEEDED = ("Xvfb", "import", "identify", "convert", "compare")
DESCRIPTION = """\
Runs a session on a virtual display, stops it at each of the given simulated times, waits until rviz has drawn and
saves what it shows as NAME.png (1280 x 720). VIEW is a view that the rviz configuration has saved, by its name.
Default: the five states of the script ({}).
Needs no screen and no graphics card.""".format(" ".join(STATES))


def picture_of(text):
    """From NAME=SECONDS[@VIEW]."""
    found = re.fullmatch(r"([A-Za-z0-9_-]+)=(\d+\.?\d*|\.\d+)(?:@(.+))?", text)
    if found is None or float(found.group(2)) == 0:
        words = "a picture is NAME=SECONDS[@VIEW] with seconds above zero, not '{}'"
        raise argparse.ArgumentTypeError(words.format(text))
    return Picture(found.group(1), float(found.group(2)), found.group(3) or "")


def parse(words):
    made = cli.Parser("picture", "[options] [NAME=SECONDS[@VIEW]...]", DESCRIPTION)
    made.add_argument("pictures", nargs="*", type=picture_of, help=argparse.SUPPRESS)
    add = made.options.add_argument
    add("--scene", metavar="FILE", type=cli.file, default=places.SCENE, help="what is simulated (default: %(default)s)")
    add("--script", metavar="FILE", type=trainee, default="five_states", help="what the trainee does (default: "
        "%(default)s)")  # fmt: skip
    add("--config", metavar="FILE", type=cli.file, default=places.RVIZ_CONFIG, help="what rviz shows (default: "
        "%(default)s)")  # fmt: skip
    add("--view", metavar="VIEW", default="", help="the view of pictures that name none (default: the one that the "
        "configuration opens with)")  # fmt: skip
    add("--colours", metavar="N", type=cli.whole(), default=FEWEST_COLOURS, help="what has fewer is not yet a picture: "
        "rviz begins with an empty view (default: %(default)s)")  # fmt: skip
    add("--program", metavar="TEXT", default="rviz", help="this instead of rviz, with its options")
    add("--output", metavar="DIR", default=places.output_folder("docs/pictures"), help="folder for the pictures "
        "(default: docs/pictures)")  # fmt: skip
    arguments = made.parse(words)
    pictures = arguments.pictures or [picture_of(text) for text in STATES]
    pictures = [picture._replace(view=picture.view or arguments.view) for picture in pictures]
    arguments.pictures = sorted(pictures, key=lambda picture: picture.seconds)
    arguments.output = made.check_output(arguments.output)
    return arguments


def run(arguments):
    for program in NEEDED:
        if shutil.which(program) is None:
            words = "picture: there is no program '{}'; pictures need two more packages: apt-get install xvfb imagemagick"
            print(words.format(program), file=sys.stderr)
            return 1
    from .take_pictures import take_all

    return take_all(arguments)
