#!/usr/bin/env python3
"""Usage: soak.py MINUTES
What pages cost the simulator, and whether the server bears them for long: again and again 15 s without pages, with one,
with ten, and with one while others come, go, sleep and send rubbish. The scope makes the same motion in each 15 s, so
the times of the steps can be compared. Needs a workspace that is built, with the page, and a roscore. Prints a table;
the status is 1 if the server ended, lost a steady page, or keeps descriptors: more than three, which ROS opens and
closes itself, above those after the first round."""

import json
import math
import os
import subprocess
import sys
import time

import numpy
import rospy
from sensor_msgs.msg import JointState
from vibe_msgs.msg import SolverStatistics
from vibe_testing.program import Program
from vibe_testing.wait import wait_until

from compare_views import page_work

SECONDS = 15  # of a part
SETTLE = 2  # of it that do not count: pages open and close, and a window of the statistics is a second
PARTS = ("0", "1", "10", "1 rough")
STAGES = ("solver", "solver_wall", "publish")
PORT = 8898
TICKS = os.sysconf("SC_CLK_TCK")


class Watch:
    """Resources of a process."""

    def __init__(self, program):
        self.program, self.folder = program, "/proc/{}/".format(program.process.pid)

    def descriptors(self):
        return len(os.listdir(self.folder + "fd"))

    def cpu(self):
        with open(self.folder + "stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS


class Soak:
    def __init__(self):
        self.simulator = Program(
            "vibe_sim", "sim_node", name="sim_node", scene="package://vibe_core/scenes/stomach.yaml", time_source="wall"
        )
        self.server = Program("vibe_web", "web_node", name="web_node", port=PORT)
        if not wait_until(lambda: "http" in self.server.output()):
            sys.exit("soak.py: web_node has not started: " + self.server.last_words())
        self.watch = Watch(self.server)
        self.crowd = subprocess.Popen(["node", "test/crowd.mjs", str(PORT)], cwd=page_work(), text=True,
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE)  # fmt: skip
        self.command = rospy.Publisher("scope/servo_jp", JointState, queue_size=1)
        self.windows = {part: [] for part in PARTS}
        self.told = {part: [] for part in PARTS}
        self.part, self.kept = None, []
        rospy.Subscriber("solver_statistics", SolverStatistics, self.take)

    def take(self, message):
        if self.part is not None:
            stages = {stage.name: stage for stage in message.stages}
            self.windows[self.part].append([[stages[name].p50, stages[name].p99] for name in STAGES])

    def move(self, seconds):
        turn = 2 * math.pi * seconds / SECONDS
        self.command.publish(
            JointState(position=[0.12 - 0.08 * math.cos(turn), 0, 0.9 * math.sin(turn), 0.5 * math.sin(2 * turn)])
        )

    def perform(self, part):
        self.ask(part)
        begin, cpu = time.monotonic(), self.watch.cpu()
        while time.monotonic() < begin + SECONDS:
            self.move(time.monotonic() - begin)
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
            self.ask("0")
            time.sleep(5)  # what slept is closed
            self.kept.append((self.server.memory() / 1e6, self.watch.descriptors()))
            print("round {}: {:.1f} MB, {} descriptors".format(len(self.kept), *self.kept[-1]), flush=True)

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
        grown = self.kept[-1][1] - self.kept[0][1]
        print("steady pages lost: {}; descriptors: {:+d}; memory: {:+.1f} MB".format(lost, grown, self.kept[-1][0] - self.kept[0][0]))
        return 1 if lost or grown > 3 or not self.server.is_running() else 0

    def close(self):
        self.crowd.stdin.close()
        self.server.stop()
        self.simulator.stop()


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
