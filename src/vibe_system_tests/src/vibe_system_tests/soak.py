"""What the programs that look for growing memory share."""

import os
import sys
import tempfile

from vibe_bringup.graph import Graph
from vibe_bringup.session import carry_out


class Soak:
    """A graph whose memory is watched; who derives from it starts and watches what is in it."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        logs = os.path.join(folder, "log")
        os.mkdir(logs)
        self.graph = Graph(logs)

    def stop(self):
        self.graph.stop_all()


def slope(samples):
    """Of a straight line through (time, value), by least squares."""
    mean_time = sum(time for time, _ in samples) / len(samples)
    mean_value = sum(value for _, value in samples) / len(samples)
    above = sum((time - mean_time) * (value - mean_value) for time, value in samples)
    return above / sum((time - mean_time) ** 2 for time, _ in samples)


def run(make, arguments):
    """Starts and watches what `make(arguments, folder)` returns, and stops it in any case. Ends this program with status 1
    if something failed."""
    with tempfile.TemporaryDirectory(prefix="vibe-soak-") as folder:
        soak = make(arguments, folder)
        status = carry_out("soak", [soak.start, soak.watch], soak.stop)
    sys.exit(status)
