#!/usr/bin/env python3
"""Usage: opening.py [TIMES]
How soon a page shows the organ after it is opened, on this machine's Chromium without a graphics card and with nothing
in its store; and, over 20 s, how old the state is that a finished picture shows. Needs a workspace that is built, with
the page, and a roscore with robot_description. TIMES: openings, 10 unless told."""

import json
import shutil
import subprocess
import sys

import numpy
import rospy

from compare_views import page_work
from moving_scope import MovingScope

PORT = 8897
SECONDS = 20
FRAME = 1000 / 60  # [ms]
PARTS = ("script", "scene", "topology", "frame", "pattern", "folds", "picture")


def spread(values):
    return "median {:6.0f}, worst {:6.0f}".format(numpy.median(values), max(values))


def report(openings, shown):
    print("after opening [ms], of {} openings:".format(len(openings)))
    for part in PARTS:
        print("  {:9} {}".format(part, spread([each[part] for each in openings if part in each])))
    draw, age = numpy.array(shown["draw"]), numpy.array(shown["age"])
    print("{:.1f} pictures of {} px in a second".format(len(age) / shown["seconds"], shown["edge"]))
    print("  to draw one [ms]                   {}".format(spread(draw)))
    print("  age of its state when it came [ms] {}".format(spread(shown["came"])))
    print("  age of its state when drawn [ms]   {}".format(spread(age)))
    print("  beyond drawing [ms]                {}".format(spread(age - draw)))
    print("  the same in frames of 60 Hz        {:.1f}".format(numpy.median(age - draw) / FRAME))


def main(times):
    rospy.init_node("web_opening", anonymous=True)
    graph = MovingScope(PORT)
    try:
        if not graph.simulator.says("t = "):
            sys.exit("opening.py: sim_node has not started: " + graph.simulator.last_words())
        command = ["node", "test/opening.mjs", PORT, shutil.which("chromium"), times, SECONDS]
        run = subprocess.run([str(word) for word in command], cwd=page_work(), text=True, check=True, stdout=subprocess.PIPE)
        lines = [json.loads(line) for line in run.stdout.splitlines()]
        report(lines[:-1], lines[-1])
    finally:
        graph.stop()


if __name__ == "__main__":
    if len(sys.argv) > 2 or any(not word.isdigit() for word in sys.argv[1:]):
        sys.exit(__doc__)
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
