"""How long a motion of the hand takes to become visible, stage by stage. The command line; see measure_latency.py."""

import argparse
import os

from . import cli, places

DESCRIPTION = """\
Runs emulated devices, the simulator and rviz on a virtual display while the hand jumps at random times, with the tip of
the scope pressed into the wall, and measures when each jump passes each stage, up to the pixel on the screen. Prints
mean, standard deviation, p50, p99 and max of each stage.
1,000 blinks take seven minutes; leave the computer alone meanwhile."""


def priority(text):
    if not text.isdecimal() or int(text) > 98:
        raise argparse.ArgumentTypeError("needs a number from 0 to 98, not '{}'".format(text))
    return int(text)


def lead(text):
    value = cli.matching(r"\d{1,3}\.?\d*", "0 to 200 ms", float)(text)
    if value > 200:
        raise argparse.ArgumentTypeError("needs 0 to 200 ms, not '{}'".format(text))
    return value


def parser():
    made = cli.Parser("latency", "[options]", DESCRIPTION)
    add = made.options.add_argument
    add("--steps", dest="mode", action="store_const", const="steps", default="blinks", help="no jumps: how steps keep "
        "their deadlines, without rviz, while the hand presses the tip into the wall")  # fmt: skip
    add("--sway", dest="mode", action="store_const", const="sway", help="no jumps: how old positions are while an "
        "instrument goes to and fro in front of the simulated camera")  # fmt: skip
    add("--minutes", metavar="M", type=cli.positive(), default=10, help="for --steps and --sway (default: "
        "%(default)s)")  # fmt: skip
    add("--lead", metavar="MS", type=lead, default=0, help="for --sway: the simulator takes the positions that the "
        "tracker predicts so far ahead (default: 0, off)")  # fmt: skip
    add("--blinks", metavar="N", type=cli.whole("a whole number above zero", 6), default=1000, help="how many jumps "
        "(default: %(default)s)")  # fmt: skip
    add("--rate", metavar="HZ", type=cli.positive(), default=100, help="of steps, at most 100, or 1000 with --steps "
        "(default: %(default)s)")  # fmt: skip
    add("--free", action="store_true", help="steps follow the wall clock only, not the reports of the device")
    add("--camera", action="store_true", help="the jumps are those of an instrument in front of a simulated GigE "
        "camera")  # fmt: skip
    add("--headless", action="store_true", help="without rviz: up to the published state")
    add("--view", metavar="NAME", default="", help="a saved view of rviz, such as Endoscope (default: as a session "
        "opens)")  # fmt: skip
    add("--scene", metavar="FILE", type=cli.file, default=places.SCENE, help="what is simulated (default: %(default)s)")
    add("--particles", metavar="N", type=cli.matching(r"\d{1,6}", "a whole number", int), default=0, help="of the tissue "
        "(default: as many as the scene has)")  # fmt: skip
    add("--load", action="store_true", help="keep one core busy with stress-ng")
    add("--realtime", metavar="N", type=priority, default=0, help="real-time priority of the steps (SCHED_FIFO), where "
        "that is permitted")  # fmt: skip
    add("--seed", metavar="N", type=cli.matching(r"\d{1,9}", "a whole number", int), default=1, help="of the times of "
        "the jumps (default: %(default)s)")  # fmt: skip
    add("--output", metavar="DIR", help="folder for tables, latency.json and latency.png (default: "
        "sessions/latency-<date-time>)")  # fmt: skip
    return made


def check_mode(arguments, fail):
    fastest = 1000 if arguments.mode == "steps" else 100
    if arguments.rate > fastest:
        words = "--rate: at most {} Hz, not '{:g}'; above 100 Hz a jump of the hand takes more than one step"
        fail(words.format(fastest, arguments.rate))
    if arguments.lead > 0 and arguments.mode != "sway":
        fail("--lead goes with --sway: a jump cannot be predicted")
    if arguments.mode != "blinks":
        arguments.headless = arguments.free = True
        arguments.camera = arguments.mode == "sway"


def parse(words):
    made = parser()
    arguments = made.parse(words)
    check_mode(arguments, made.error)
    output = arguments.output or places.output_folder("sessions/latency-" + cli.time_stamp())
    if os.path.exists(output):
        made.error("--output: '{}' is there already; give another path".format(output))
    arguments.output = made.check_output(output)
    return arguments


def parts(_):
    return ["session", "devices", "vision", "measurements"]


def run(arguments):
    from .measure_latency import measure

    return measure(arguments)
