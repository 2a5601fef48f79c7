"""A data set for computer vision from a recorded session: images of the endoscope with their truth."""

import glob
import os
import shutil
import subprocess
import sys
import tempfile

from . import cli, places

VALUES = ("rate", "every", "from", "to", "content", "lens", "field_of_view", "width", "height", "baseline", "seed",
          "vary")  # fmt: skip
FLAGS = ("stereo", "no_smoke")
DESCRIPTION = """\
Repeats a recorded session and writes what the endoscope sees: colour images, and the truth of each pixel: depth,
normals, labels and optical flow, with poses, intrinsics and a data sheet (docs/ground_truth.md lists the files). The
same recording and options give the same bytes on the same machine. Needs no screen and no graphics card."""
EPILOG = """\
About 7 MB per image of 640 x 480 with the default content, and 5 MB per second of the recording while it works."""


def parser():
    """The values are those of vibe_dataset, which checks them."""
    made = cli.Parser("dataset", "BAG --output DIR [options]", DESCRIPTION, EPILOG)
    cli.add_recording(made)
    add = made.options.add_argument
    add("--output", metavar="DIR", help="folder to write to; new or empty")
    add("--rate", metavar="HZ", help="images per second of simulated time (default: 10; 0: every state of the "
        "simulator)")  # fmt: skip
    add("--every", metavar="N", help="of these images, one in N (default: 1)")
    add("--from", metavar="S", help="begin (default: that of the recording)")
    add("--to", metavar="S", help="end (default: that of the recording)")
    add("--content", metavar="LIST", help="beside the images, of: depth,normals,labels,flow,particles,sutures (default: "
        "the first four)")  # fmt: skip
    add("--lens", metavar="LENS", help="equidistant (default) or rectilinear")
    add("--field-of-view", metavar="DEG", help="across the circle (default: 140)")
    add("--width", metavar="PX", help="of the images (default: 640)")
    add("--height", metavar="PX", help="of the images (default: 480)")
    add("--stereo", action="store_true", help="a pair of lenses")
    add("--baseline", metavar="M", help="between the lenses (default: 0.004)")
    add("--no-smoke", action="store_true", help="without the smoke of the argon beam")
    add("--seed", metavar="N", help="varies the lens in its mount, the sensor, the look of the mucosa and the light "
        "within stated ranges; 0: none of it (default)")  # fmt: skip
    add("--vary", metavar="LIST", help="what the seed varies, of: lens,sensor,mucosa,light (default: all); the truth "
        "depends on the lens alone")  # fmt: skip
    return made


def parse(words):
    made = parser()
    arguments = made.parse(words)
    arguments.bag = cli.recording(made, arguments)
    arguments.words = cli.words_of(arguments, *VALUES, *FLAGS)
    if not arguments.output:
        made.error("where to? --output DIR")
    output = os.path.realpath(arguments.output)
    if os.path.exists(output) and not os.path.isdir(output):
        made.error("--output: '{}' is not a folder".format(output))
    if os.path.isdir(output) and [name for name in os.listdir(output) if not name.startswith(".")]:
        made.error("--output: '{}' is not empty".format(output))
    arguments.output = made.check_output(output)
    return arguments


class Failure(Exception):
    """One sentence for the user, if it has not been said yet, and the exit status."""

    def __init__(self, sentence="", status=1):
        super().__init__(sentence)
        self.status = status


def last_line(file):
    with open(file, encoding="utf-8", errors="replace") as text:
        return (text.read().strip().splitlines() or [""])[-1]


def fill_recording(arguments, scratch):
    """The states between those that a recording keeps come from repeating it. Returns how that ended, in words."""
    said = os.path.join(scratch, "said.txt")
    print("repeating " + arguments.bag, flush=True)
    command = [places.program("vibe_sim", "vibe_replay"), "--fill", os.path.join(scratch, "whole.bag"), arguments.bag]
    with open(said, "w", encoding="utf-8") as file:  # not whole: scratch
        status = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode
    if status == 3:
        print("note: the recording has no hashes to compare all steps with; the data sheet says so", flush=True)
    elif status != 0:
        raise Failure("the recording does not repeat: " + last_line(said))
    return last_line(said)


def write_images(arguments, scratch):
    command = [places.program("vibe_endoscope", "vibe_dataset"), os.path.join(scratch, "whole.bag")]
    command += ["--name", os.path.basename(arguments.bag), "--output", arguments.output, *arguments.words]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace", check=False)
    # rospack says, as soon as graphics begin, that Debian has no package media_export; nothing needs it
    lines = [line for line in done.stderr.splitlines() if not line.startswith(("[rospack]", "[librospack]"))]
    print("\n".join(lines), end="\n" if lines else "", file=sys.stderr)
    if done.returncode not in (0, 1, 2):
        raise Failure("vibe_dataset broke off with status {} on '{}'".format(done.returncode, arguments.bag))
    if done.returncode != 0:
        raise Failure(status=done.returncode)


def make(arguments):
    for left in glob.glob(os.path.join(glob.escape(arguments.output), ".making-*")):  # by a call that was killed
        shutil.rmtree(left)
    with tempfile.TemporaryDirectory(prefix=".making-", dir=arguments.output) as scratch:
        replayed = fill_recording(arguments, scratch)
        write_images(arguments, scratch)
    from .dataset_sheet import describe

    describe(arguments.output, replayed)


def run(arguments):
    from .session import Interrupted, interruptible

    # a wrong option or file is said before there is a folder and before the recording is repeated
    check = [places.program("vibe_endoscope", "vibe_dataset"), "--check", arguments.bag, "--output", arguments.output]
    status = subprocess.run(check + arguments.words, check=False).returncode
    if status != 0:
        return status
    made = places.missing_folders(arguments.output)
    os.makedirs(arguments.output, exist_ok=True)
    try:
        with interruptible():
            make(arguments)
        return 0
    except Failure as failure:
        if str(failure):
            print("dataset: {}".format(failure), file=sys.stderr)
        status = failure.status
    except Interrupted as reason:
        print("dataset: stopped by {}".format(reason), file=sys.stderr)
        status = 130
    places.remove_empty(made)  # no folder where nothing was written
    return status
