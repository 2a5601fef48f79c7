"""The simulator for hours of simulated time, driven without a pause: does its memory grow?

scripts/test.d/soak_sim.sh has sourced the environment. The simulator takes steps as fast as it can, in lock-step with a
trainee that plays a script again and again; a listener takes what is published. The first part of the time is left to
warm up; growth is the slope of a straight line through what is resident after that.
"""

import argparse
import os
import socket
import time
import xmlrpc.client

from vibe_bringup import places
from vibe_bringup.graph import GraphError
from vibe_testing.program import find_program

from .fault_bench import memory, simulated_time
from .fault_peers import Listener, Victim
from .soak import Soak, run, slope

INTERVAL = 1.0  # between two samples [s of wall time]
WARM_UP = 0.2  # of the time
FEWEST = 20  # samples after that
PATIENCE = 60.0  # for the simulator to begin, and for it to take the next step [s]
HOUR = 3600.0  # [s]
SCRIPT_SECONDS = 60.0  # of one turn of the script
HEARD = ("tissue/particles", "step_result", "joint_states", "sutures", "procedure/state", "procedure/skill_metrics",
         "procedure/events", "applied_input", "haptic/parameters", "scope/measured_cf")  # fmt: skip


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False, description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--scene", default="package://vibe_sim/test/node/scenes/small_stomach.yaml")
    parser.add_argument("--script", default="package://vibe_core/trainees/demo/grabs.yaml", help="of one turn")
    parser.add_argument("--minutes", type=float, default=120.0, help="of simulated time")
    parser.add_argument("--most-growth", type=float, default=1.0, help="in an hour of simulated time [MB]")
    return parser.parse_args()


def repeated(script, times):
    """The text of a trainee script that plays its actions again and again."""
    head, actions = script.split("\nactions:\n")
    return head + "\nactions:\n" + times * (actions.rstrip("\n") + "\n")


class SimulatorSoak(Soak):
    def __init__(self, arguments, folder):
        super().__init__(arguments, folder)
        self.listeners = []

    def start(self):
        graph, put = self.graph, self.graph.set_parameter
        graph.start_master()
        put("/use_sim_time", True)
        put("/sim_node/scene", places.find(self.arguments.scene))
        put("/sim_node/time_source", "sim")
        for node in ("sim_node", "vibe_trainee"):
            put("/{}/lockstep".format(node), True)
        put("/sim_node/fast", True)
        put("/vibe_trainee/script", self.write_script())
        # not through rosrun: it would be rosrun whose memory is looked at
        self.sim = graph.start("sim_node", [find_program("vibe_sim", "sim_node")])
        graph.start("vibe_trainee", [find_program("vibe_sim", "vibe_trainee")])
        self.listeners = self.wait_for_simulator()

    def write_script(self):
        turn = places.find(self.arguments.script)
        path = os.path.join(self.folder, "script.yaml")
        with open(turn, encoding="utf-8") as text, open(path, "w", encoding="utf-8") as script:
            script.write(repeated(text.read(), round(60 * self.arguments.minutes / SCRIPT_SECONDS) + 1))
        return path

    def wait_for_simulator(self):
        """Listeners to all its topics."""
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                victim = Victim(self.graph.env["ROS_MASTER_URI"], "/sim_node")
                return [Listener(victim, "/" + topic) for topic in HEARD]
            except (OSError, AssertionError, TypeError, ValueError, xmlrpc.client.Error):
                self.graph.check_alive()
                if time.monotonic() > deadline:
                    raise GraphError("sim_node does not begin; it said:\n" + self.sim.last_words())
                time.sleep(0.2)

    def watch(self):
        end, begin = 60 * self.arguments.minutes, time.monotonic()
        samples, progress = [], begin
        while not samples or samples[-1][0] < end:
            time.sleep(INTERVAL)
            self.graph.check_alive()
            now = simulated_time(self.sim.log)
            if not samples or now > samples[-1][0]:
                samples.append((now, memory(self.sim.process.pid)))
                progress = time.monotonic()
            if time.monotonic() - progress > PATIENCE:
                raise GraphError("no step in {:.0f} s; it said:\n{}".format(PATIENCE, self.sim.last_words()))
        self.judge(samples, end, time.monotonic() - begin)

    def judge(self, samples, end, seconds):
        warm = [sample for sample in samples if sample[0] > WARM_UP * end]
        if len(warm) < FEWEST:
            raise GraphError("only {} samples; let it run for more minutes".format(len(warm)))
        growth = HOUR * slope(warm)
        heard = sum(listener.bytes for listener in self.listeners) / 1e6
        print("{:.1f} minutes simulated in {:.1f}, {:.0f} MB heard; resident {:.1f} MB when warm, {:.1f} MB at the end, "
              "at most {:.1f} MB; growth {:.3f} MB in an hour of simulated time (allowed {:.1f})".format(
                  samples[-1][0] / 60, seconds / 60, heard, warm[0][1], warm[-1][1], max(m for _, m in samples), growth,
                  self.arguments.most_growth))
        for listener in self.listeners:
            if listener.topic in ("/tissue/particles", "/step_result") and listener.bytes == 0:
                raise GraphError("nothing was heard on {}".format(listener.topic))
        if growth > self.arguments.most_growth:
            raise GraphError("memory grows by {:.2f} MB in an hour".format(growth))

    def stop(self):
        for listener in self.listeners:
            listener.connection.shutdown(socket.SHUT_RDWR)
        super().stop()


if __name__ == "__main__":
    run(SimulatorSoak, parse_arguments())
