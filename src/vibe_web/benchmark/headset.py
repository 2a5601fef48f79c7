#!/usr/bin/env python3
"""Usage: headset.py FOLDER [SNAPSHOT]
Draws and triangles of the page, and of an emulated headset for each eye, of the beginning of a session or of a snapshot,
which `vibe_headless --snapshot` writes; whether the triangles that are left out of the endoscope's picture are not in
it; and 30 s in which a controller drives the handle, with the joints at the end. Stereo pictures go into FOLDER. Needs
a workspace that is built, with the page, Chromium, and a roscore with robot_description. The status is 1 if there are
more than 25 draws or 120,000 triangles, if a byte of the picture differs, or if the joints of the simulator are others
than those of the page."""

import json
import os
import shutil
import subprocess
import sys

import rospy
from sensor_msgs.msg import JointState
from vibe_testing.recorder import Recorder

from compare_views import page_work
from moving_scope import MovingScope

PORT = 8895
SECONDS = 30
MOST = {"calls": 25, "triangles": 120000}
SAME = 1e-6  # [m] or [rad]


def counts(name, told, eyes):
    each = {kind: told[kind] / eyes for kind in MOST}
    print("{:22} {:5.1f} draws, {:7.0f} triangles".format(name, each["calls"], each["triangles"]))
    return all(each[kind] <= most for kind, most in MOST.items())


def main(folder, snapshot=None):
    rospy.init_node("web_headset", anonymous=True)
    graph = MovingScope(PORT, snapshot)
    try:
        setpoint = Recorder("scope/setpoint_js", JointState)
        setpoint.waits_for()
        command = ["node", "test/headset.mjs", str(PORT), shutil.which("chromium"), os.path.abspath(folder), str(SECONDS)]
        run = subprocess.run(command, cwd=page_work(), text=True, check=True, stdout=subprocess.PIPE)
        told, last = json.loads(run.stdout), setpoint.messages[-1].position
    finally:
        graph.stop()
    good = [counts("page", told["page"], 1), counts("headset, for each eye", told["eyes"], 2)]
    print("bytes of the picture that differ: {differ}; with too much left out: {control}".format(**told["picture"]))
    for k, name in enumerate(("insertion", "rotation")):
        print("{:9} began {:.4f}, ended {:.4f}, went {:.4f}; the hand {:.4f}".format(
            name, told["begin"][k], told["end"][k], told["end"][k] - told["begin"][k], told["hand"][name]))  # fmt: skip
    print("frames of the headset take {:.0f} ms".format(1000 * told["frames"]))
    apart = max(abs(a - b) for a, b in zip(last, told["end"]))
    print("joints of simulator and page are apart by {:.1e}".format(apart))
    good += [told["picture"]["differ"] == 0, told["picture"]["control"] > 0, apart < SAME]
    return 0 if all(good) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    os.makedirs(sys.argv[1], exist_ok=True)
    sys.exit(main(*sys.argv[1:]))
