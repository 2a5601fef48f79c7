#!/usr/bin/env python3
"""Usage: wire.py [SNAPSHOT]
What a page gets per second, by kind of message, while the scope moves for 30 s: from the beginning of a session, or from
a snapshot, which `vibe_headless --snapshot` writes. Needs a workspace that is built, with the page, and a roscore with
robot_description. The status is 1 if it is more than 1.5 MB/s at 60 frames per second."""

import json
import subprocess
import sys

import numpy
import rospy
from vibe_msgs.msg import SutureArray
from vibe_testing.recorder import Recorder

from compare_views import page_work
from moving_scope import MovingScope

PORT = 8896
SECONDS = 30
MOST = 1.5e6  # [bytes/s]
FRAME = "3"
KINDS = ("", "scene", "topology", "frame", "folds", "heat", "sutures", "state", "events", "replay", "operator", "pong",
         "refusal", "grant", "blood", "threads")  # fmt: skip


def ways(messages):
    """How far the bites of each set went [mm]."""
    places = [numpy.array([[b.position.x, b.position.y, b.position.z] for b in s.bites]) for s in messages[-1].sutures]
    for number, last in enumerate(places):
        path = [[[b.position.x, b.position.y, b.position.z] for b in m.sutures[number].bites] for m in messages]
        path = numpy.array([each for each in path if len(each) == len(last)])
        yield 1000 * numpy.linalg.norm(path.max(axis=0) - path.min(axis=0), axis=1).mean()


def main(snapshot):
    rospy.init_node("web_wire", anonymous=True)
    graph = MovingScope(PORT, snapshot)
    try:
        sutures = Recorder("sutures", SutureArray)
        page = subprocess.Popen(["node", "test/wire.mjs", str(PORT), str(SECONDS)], cwd=page_work(), stdout=subprocess.PIPE)
        graph.move_for(SECONDS + 5)
        told = json.loads(page.communicate()[0])
    finally:
        graph.stop()
    if sutures.messages and sutures.messages[-1].sutures:
        print("sets went", ", ".join("{:.1f}".format(way) for way in ways(sutures.messages)), "mm")
    rate = told["counts"][FRAME]["messages"] / told["seconds"]
    whole = 0
    for kind, count in told["counts"].items():
        each, per_second = count["bytes"] / count["messages"], count["bytes"] / told["seconds"]
        whole += per_second * (60 / rate if kind == FRAME else 1)
        print("{:9} {:6.0f} bytes {:5.1f} times a second: {:9.0f} bytes/s".format(
            KINDS[int(kind)], each, count["messages"] / told["seconds"], per_second))  # fmt: skip
    print("with 60 frames per second: {:.2f} MB/s".format(whole / 1e6))
    return 1 if whole > MOST else 0


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[-1].startswith("-"):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:] or [None]))
