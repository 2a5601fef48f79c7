"""A recorded session played through rviz again and again: does its memory grow?

scripts/test.d/soak.sh has recorded the session and sourced the environment. The first part of the time is left to warm
up (fonts, shaders, the largest set of sutures); growth is the slope of a straight line through what is resident after
that, times half an hour.
"""

import argparse
import json
import os
import time

from vibe_bringup.graph import GraphError
from vibe_bringup.rviz_window import RvizWindow, wait_for

from .soak import Soak, run, slope

INTERVAL = 2.0  # between two samples [s]
WARM_UP = 0.3  # of the time
HALF_HOUR = 1800.0  # [s]


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False, description=__doc__.split("\n\n", maxsplit=1)[0])
    for name in ("--program", "--bag", "--config"):
        parser.add_argument(name, required=True)
    parser.add_argument("--minutes", type=float, default=30.0, help="of the session")
    parser.add_argument("--rate", type=float, default=10.0, help="how much faster than real time it is played")
    parser.add_argument("--most-growth", type=float, default=20.0, help="in half an hour of the session [MB]")
    return parser.parse_args()


class RvizSoak(Soak):
    def __init__(self, arguments, folder):
        super().__init__(arguments, folder)
        self.report_file = os.path.join(folder, "report.json")
        self.window = RvizWindow(self.graph, folder, arguments.config)

    def start(self):
        self.graph.start_master()
        self.graph.set_parameter("/use_sim_time", True)
        self.graph.start_robot()
        self.window.start([self.arguments.program, self.report_file])
        wait_for(lambda: self.graph.check_alive() and self.report()["frames"] > 0, "rviz drew nothing")
        rate = "{:g}".format(self.arguments.rate)
        self.graph.start("rosbag", ["rosrun", "rosbag", "play", "--loop", "--quiet", "--rate", rate, self.arguments.bag])

    def report(self):
        try:
            with open(self.report_file, encoding="utf-8") as text:
                return json.load(text)
        except FileNotFoundError:
            return {"frames": 0, "memory": 0, "statuses": []}

    def watch(self):
        begin = time.monotonic()
        end = 60 * self.arguments.minutes / self.arguments.rate
        samples = []
        while time.monotonic() - begin < end:
            time.sleep(INTERVAL)
            self.graph.check_alive()
            samples.append((self.arguments.rate * (time.monotonic() - begin), self.report()["memory"] / 1e6))
        self.judge(samples, end)

    def judge(self, samples, end):
        warm = [sample for sample in samples if sample[0] > WARM_UP * end * self.arguments.rate]
        growth = HALF_HOUR * slope(warm)
        told = self.report()
        frames = "{:.0f} frames, {:.1f} minutes of the session in {:.1f}".format(
            told["frames"], self.arguments.minutes, end / 60
        )
        print("{}; resident {:.1f} MB when warm, {:.1f} MB at the end, growth {:.2f} MB in half an hour".format(
            frames, warm[0][1], warm[-1][1], growth))
        errors = [status for status in told["statuses"] if status["level"] == "Error"]
        if errors:
            raise GraphError("a display has an error: {}".format(errors[0]))
        if ("Stomach", "Particles", "Ok") not in [(s["of"], s["what"], s["level"]) for s in told["statuses"]]:
            raise GraphError("rviz drew no organ: what it told last is {}".format(told["statuses"]))
        if growth > self.arguments.most_growth:
            raise GraphError("memory grew by {:.1f} MB, {:.1f} are allowed".format(growth, self.arguments.most_growth))


if __name__ == "__main__":
    run(RvizSoak, parse_arguments())
