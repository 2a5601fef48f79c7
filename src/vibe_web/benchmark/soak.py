#!/usr/bin/env python3
"""Usage: soak.py MINUTES
What pages cost the simulator, and whether the server bears them for long: again and again 15 s without pages, with one,
with ten, and with one while others come, go, sleep and send rubbish, and a page of Chromium visits where it is
installed. The scope makes the same motion in each 15 s, so the times of the steps can be compared. Needs a workspace
that is built, with the page, and a roscore with robot_description. Prints a table; the status is 1 if the server ended,
lost a steady page, showed nothing to a visitor, or has grown since the first round: by threads, by 2 MB, or by more
than three descriptors, which ROS opens and closes itself."""

import json
import math
import os
import shutil
import subprocess
import sys
import time

import numpy
import rospy
from vibe_msgs.msg import SolverStatistics

from compare_views import page_work
from moving_scope import SECONDS, MovingScope

SETTLE = 2  # seconds of a part that do not count: pages open and close, and a window of the statistics is a second
PARTS = ("0", "1", "10", "1 rough")
STAGES = ("solver", "solver_wall", "publish")
PORT = 8898
TICKS = os.sysconf("SC_CLK_TCK")


class Watch:
    """Resources of a process."""

    def __init__(self, program):
        self.program, self.folder = program, "/proc/{}/".format(program.process.pid)

    def kept(self):
        """Memory [MB], descriptors, threads."""
        counts = [len(os.listdir(self.folder + name)) for name in ("fd", "task")]
        return (self.program.memory() / 1e6, *counts)

    def cpu(self):
        with open(self.folder + "stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS


class Soak:
    def __init__(self):
        self.graph = MovingScope(PORT)
        self.server = self.graph.server
        self.watch = Watch(self.server)
        self.crowd = subprocess.Popen(["node", "test/crowd.mjs", str(PORT), *filter(None, [shutil.which("chromium")])],
                                      cwd=page_work(), text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)  # fmt: skip
        self.windows = {part: [] for part in PARTS}
        self.told = {part: [] for part in PARTS}
        self.part, self.kept, self.visits = None, [], {}
        rospy.Subscriber("solver_statistics", SolverStatistics, self.take)

    def take(self, message):
        if self.part is not None:
            stages = {stage.name: stage for stage in message.stages}
            self.windows[self.part].append([[stages[name].p50, stages[name].p99] for name in STAGES])

    def perform(self, part):
        self.ask(part)
        begin, cpu = time.monotonic(), self.watch.cpu()
        while time.monotonic() < begin + SECONDS:
            self.graph.move(time.monotonic() - begin)
            if self.part is None and time.monotonic() > begin + SETTLE:
                self.part = part
            time.sleep(1 / 60)
        self.part = None
        used = (self.watch.cpu() - cpu) / (time.monotonic() - begin)
        return {**self.ask(part.split()[0]), "cpu": used}

    def ask(self, line):
        print(line, file=self.crowd.stdin, flush=True)
        return json.loads(self.crowd.stdout.readline())

    def run(self, minutes):
        end = time.monotonic() + 60 * minutes
        while time.monotonic() < end and self.server.is_running():
            for part in PARTS:
                self.told[part].append(self.perform(part))
            self.visits = self.ask("0")
            time.sleep(5)  # what slept is closed
            self.kept.append(self.watch.kept())
            print("round {}: {:.1f} MB, {} descriptors, {} threads".format(len(self.kept), *self.kept[-1]), flush=True)

    def report(self):
        print("\npages     steps' p50 and p99 [ms]: CPU; wall; publish      server CPU  frames/s  MB/s  longest gap  others")
        for part in PARTS:
            times = numpy.median(self.windows[part], axis=0)
            told = {key: [each[key] for each in self.told[part]] for key in self.told[part][0]}
            print(
                "{:8}  {:5.2f} {:6.2f};  {:5.2f} {:6.2f};  {:5.2f} {:6.2f}   {:20.1f} %  {:8.1f}  {:4.2f}  {:8.0f} ms  {:6}".format(
                    part, *times.ravel(), 100 * numpy.mean(told["cpu"]), numpy.mean(told["frames_per_second"]),
                    numpy.mean(told["bytes_per_second"]) / 1e6, max(told["longest_gap_ms"]), sum(told["came"]),
                )
            )  # fmt: skip
        noise = [numpy.std([w[0][1] for w in self.windows[part]]) / math.sqrt(len(self.windows[part])) for part in PARTS]
        print("standard error of the mean of the p99 of a second, CPU [ms]:", " ".join("{:.2f}".format(n) for n in noise))
        lost = sum(each["lost"] for part in PARTS for each in self.told[part])
        visits, seen = self.visits["visits"], self.visits["seen"]
        print("steady pages lost: {}; visits of Chromium: {}, of which {} saw the organ".format(lost, visits, seen))
        memory, descriptors, threads = (last - first for first, last in zip(self.kept[0], self.kept[-1]))
        print("memory: {:+.1f} MB; descriptors: {:+d}; threads: {:+d}".format(memory, descriptors, threads))
        grown = memory > 2 or descriptors > 3 or threads > 0
        return 1 if lost or seen < visits or grown or not self.server.is_running() else 0

    def close(self):
        self.crowd.stdin.close()
        self.graph.stop()


def main(minutes):
    rospy.init_node("web_soak", anonymous=True)
    soak = Soak()
    try:
        soak.run(minutes)
        return soak.report()
    finally:
        soak.close()


if __name__ == "__main__":
    if len(sys.argv) != 2 or not sys.argv[1].replace(".", "", 1).isdigit():
        sys.exit(__doc__)
    sys.exit(main(float(sys.argv[1])))
