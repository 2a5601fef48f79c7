"""rviz on a virtual display of its own, and pictures of what it shows."""

import os
import subprocess
import time

import yaml

from .graph import GraphError

SIZE = "1280x720"
PATIENCE = 180.0  # for a program to be ready or for rviz to draw, software rendering on a busy machine [s]
EQUAL_SHOTS = 3  # so many in a row without a difference: rviz has drawn the last message
SHOT_INTERVAL = 1.0  # [s]
LIVELY_PIXELS = 2000  # figures in panels change all the time, the frame rate in the corner too


def wait_for(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise GraphError("{} within {:.0f} s".format(what, PATIENCE))
        time.sleep(0.2)


def with_view(config, name):
    """The configuration with one of its saved views as the one that it opens with."""
    views = config["Visualization Manager"]["Views"]
    for view in views.get("Saved") or []:
        if view.get("Name") == name:
            views["Current"] = dict(view, Name="Current View")
            return config
    known = ", ".join("'{}'".format(view.get("Name")) for view in views.get("Saved") or [])
    raise GraphError("there is no saved view '{}' in the rviz configuration; it has {}".format(name, known or "none"))


class RvizWindow:
    """One rviz: `view` is one of the saved views, or empty for the configuration as it is. What has fewer colours is no
    picture yet."""

    def __init__(self, graph, folder, config, view="", fewest_colours=0):
        self.graph, self.view = graph, view
        self.name = "rviz" + ("_" + "".join(c if c.isalnum() else "_" for c in view) if view else "")
        self.folder = os.path.join(folder, self.name)
        self.config, self.fewest_colours = config, fewest_colours
        self.display = ""
        self.process = None

    def start(self, program):
        """`program` is rviz, or another one that takes its options."""
        self.start_display()
        config = self.config
        if self.view:
            config = os.path.join(self.folder, "view.rviz")
            with open(self.config, encoding="utf-8") as given, open(config, "w", encoding="utf-8") as derived:  # not whole: scratch
                yaml.safe_dump(with_view(yaml.safe_load(given), self.view), derived)
        # the splash screen would be in the way of the first picture
        command = [*program, "--splash-screen", "", "-d", config]
        self.process = self.graph.start(self.name, ["env", "DISPLAY=" + self.display, *command])

    def start_display(self):
        """The X server chooses a free display and writes its number into a pipe."""
        os.mkdir(self.folder, 0o700)
        self.graph.env.update(LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", XDG_RUNTIME_DIR=self.folder)
        number = os.path.join(self.folder, "display")
        command = 'exec Xvfb -displayfd 7 -screen 0 "$1"x24 -nolisten tcp 7>"$2"'
        open(number, "wb").close()  # not whole: scratch
        self.graph.start(self.name + "_xvfb", ["sh", "-c", command, "sh", SIZE, number])
        wait_for(lambda: self.graph.check_alive() and os.path.getsize(number) > 1, "Xvfb named no display")
        with open(number, encoding="ascii") as text:
            self.display = ":" + text.read().strip()

    def ask(self, command, accepted=(0,)):
        """What a program says, on its standard output or on its standard error."""
        env = dict(self.graph.env, DISPLAY=self.display)
        answer = subprocess.run(command, env=env, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        words = (answer.stdout + answer.stderr).decode(errors="replace").strip()
        if answer.returncode not in accepted:
            raise GraphError("{} failed: {}".format(command[0], words or "status {}".format(answer.returncode)))
        return words

    def grab(self, file):
        self.graph.check_alive()
        self.ask(["import", "-window", "root", file])
        return int(self.ask(["identify", "-format", "%k", file])) >= self.fewest_colours

    def is_steady(self, file, last):
        said = self.ask(["compare", "-metric", "AE", "-fuzz", "2%", file, last, "null:"], accepted=(0, 1))
        return float(said.split()[0]) <= LIVELY_PIXELS

    def shoot(self, target):
        """Saves the picture once rviz draws the organ and nothing but a few figures moves any more."""
        file, last = (os.path.join(self.folder, name) for name in ("shot.png", "last.png"))
        steady = 0
        deadline = time.monotonic() + PATIENCE
        while steady < EQUAL_SHOTS:
            if time.monotonic() > deadline:
                raise GraphError("rviz drew no steady scene within {:.0f} s; see {}".format(PATIENCE, self.process.log))
            time.sleep(SHOT_INTERVAL)
            if not self.grab(file):
                steady = 0
            elif steady > 0 and not self.is_steady(file, last):
                steady = 1
            else:
                steady += 1
            os.replace(file, last)
        self.ask(["convert", last, "-strip", "-define", "png:compression-level=9", target])
        print("{} ({:.0f} kB)".format(target, os.path.getsize(target) / 1e3), flush=True)
