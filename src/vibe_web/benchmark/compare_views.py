#!/usr/bin/env python3
"""Usage: compare_views.py FOLDER [VIEW...]
How much the page's picture of the endoscope is that of endoscope_camera, in the views of scripts/views: structural
similarity (Wang 2004, Gaussian window of 1.5 px) of the grey pictures, of all of it and of the circle alone. Needs a
workspace that is built, with the page, and Chromium. Pictures go into the folder, those of the page as eye_VIEW_web.png."""

import os
import re
import shutil
import subprocess
import sys

import numpy
from PIL import Image
from vibe_bringup import take_views, views
from vibe_system_tests.compare_pictures import similarity_map
from vibe_testing.program import find_program

SIZE = 480  # [px]
PORT = 8899


def page_work():
    with open(os.path.join(os.path.dirname(find_program("vibe_web", "web_node")), "../../share/vibe_web/page.work")) as file:
        return file.read().strip()


class WebSession(take_views.ViewSession):
    """A session of scripts/views with a page beside the camera."""

    def start(self):
        super().start()
        self.graph.start_node("vibe_web", "web_node", "_port:={}".format(PORT))
        work, chromium = page_work(), shutil.which("chromium")
        self.page = subprocess.Popen(["node", "test/dump.mjs", str(PORT), chromium, str(SIZE)], cwd=work, text=True,
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE)  # fmt: skip
        if self.page.stdout.readline().strip() != "ready":
            raise take_views.GraphError("the page cannot be opened")

    def save(self, stamp, file):
        super().save(stamp, file)
        raw = re.sub(r"\.png$", ".raw", file)
        print(raw, file=self.page.stdin, flush=True)
        self.page.stdout.readline()
        pixels = numpy.fromfile(raw, numpy.uint8).reshape(SIZE, SIZE, 4)[::-1, :, :3]
        os.remove(raw)
        Image.fromarray(numpy.ascontiguousarray(pixels)).save(re.sub(r"\.png$", "_web.png", file))


def main(folder, names):
    arguments = views.parse(["--size", "{0}x{0}".format(SIZE), "--output", folder, *names])
    # both follow from the beginning: smoke and the age of marks depend on it
    arguments.views = [view._replace(followed=0.5) for view in arguments.views]
    take_views.ViewSession = WebSession
    status = take_views.take_all(arguments)
    y, x = numpy.mgrid[0:SIZE, 0:SIZE] - (SIZE - 1) / 2
    circle = numpy.hypot(x, y) < SIZE / 2
    for view in arguments.views:
        files = [os.path.join(folder, "eye_{}{}.png".format(view.name, end)) for end in ("", "_web")]
        # lightness of 100 for white, as similarity_map() takes it
        similarity = similarity_map(*(numpy.asarray(Image.open(file).convert("L")) / 2.55 for file in files))
        print("{:12} {:.3f}  circle {:.3f}".format(view.name, similarity.mean(), similarity[circle].mean()))
    return status


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2:]))
