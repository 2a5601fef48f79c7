#!/usr/bin/env python3
"""Usage: take_page.py [--snapshot FILE] [FOLDER]
Takes the pictures of docs/web.md: the page on a screen and on a phone, web.png and web_narrow.png, of the session
demo/five_states.yaml at 89.5 s, or of a snapshot. Needs a workspace that is built, with the page, Chromium, and a
roscore with robot_description. FOLDER: docs/pictures unless told."""

import argparse
import os
import shutil
import subprocess
import tempfile

import rospy
from vibe_bringup import places
from vibe_testing.program import find_program

from compare_views import page_work
from moving_scope import MovingScope

PORT = 8894
SECONDS = 89.5  # a set is sewn, and the scope looks at it


def make_snapshot(file):
    script = "package://vibe_core/trainees/demo/five_states.yaml"
    command = [find_program("vibe_core", "vibe_headless"), "--script", script, "--duration", str(SECONDS), "--snapshot", file]
    subprocess.run(command, check=True)


def main(folder, snapshot):
    rospy.init_node("web_pictures", anonymous=True)
    with tempfile.TemporaryDirectory() as made:
        if snapshot is None:
            snapshot = os.path.join(made, "snapshot")
            make_snapshot(snapshot)
        graph = MovingScope(PORT, snapshot, start_paused=True)
        try:
            command = ["node", "test/pictures.mjs", str(PORT), shutil.which("chromium"), os.path.abspath(folder)]
            subprocess.run(command, cwd=page_work(), check=True)
        finally:
            graph.stop()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage=__doc__[7:], add_help=False)
    parser.add_argument("folder", nargs="?", default=places.output_folder("docs/pictures"))
    parser.add_argument("--snapshot")
    main(**vars(parser.parse_args()))
