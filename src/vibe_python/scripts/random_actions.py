#!/usr/bin/env python3
"""Random actions in every task, still and breathing, for as long as wanted: no crash, no number that is not finite, no
growth of memory. Prints a line per round of all tasks; ends with status 1 at the first thing that is wrong."""

import argparse
import os
import sys
import time

import numpy as np

from vibe.env import BREATHING, TASKS, VectorEnvironment

ORGANS = [("sthenic", 0.92), ("j", 1.0), ("steer_horn", 1.08)]
BREATHS = (None, *BREATHING)


def resident():
    """Memory of the process [MB]."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def faults(name, parts):
    return [f"{name}.{key}" for key, value in parts.items() if not np.isfinite(value).all()]


def episode(environment, random, actions):
    """Some random actions, held for some steps as a hand holds them. Returns what was not finite."""
    space, found = environment.action_space, []
    environment.reset(seed=int(random.integers(2**31)))
    held = random.uniform(space.low, space.high)
    for k in range(actions):
        if k % int(random.integers(1, 12)) == 0:
            held = random.uniform(space.low, space.high) * random.choice([0.2, 1])
        seen, reward, *_ = environment.step(held.astype(np.float32))
        found += faults("observation", seen) + faults("step", {"reward": reward})
    return found


def one_round(number, particles, actions, count=2):
    """Every task for some actions in each of some slots. Returns actions taken and faults."""
    random, found, taken = np.random.default_rng([31, number]), [], 0
    for k, name in enumerate(TASKS):
        breathing = BREATHS[(number + k) % len(BREATHS)]
        mode = "tip" if name in ("Reach", "Inspect") and number % 2 else "joints"
        camera = (16, 12, 1.7) if number % 3 == 0 else None
        environment = VectorEnvironment(name, count, particles=particles, organs=ORGANS, threads=1, action=mode,
                                        camera=camera, breathing=breathing)
        found += [f"{name} {breathing}: {fault}" for fault in episode(environment, random, actions)]
        environment.close()
        taken += count * actions
    return taken, found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=20, help="of wall time (default: %(default)s)")
    parser.add_argument("--particles", type=int, default=1000)
    parser.add_argument("--actions", type=int, default=200, help="per task and round (default: %(default)s)")
    parser.add_argument("--growth", type=float, default=60, help="of memory that is allowed once every stomach has been "
                        "met, in MB (default: %(default)s)")
    options = parser.parse_args()
    end, total, number, base = time.monotonic() + 60 * options.minutes, 0, 0, None
    while time.monotonic() < end:
        taken, found = one_round(number, options.particles, options.actions)
        total, number, memory = total + taken, number + 1, resident()
        print(f"round {number}: {total} actions, {memory:.0f} MB", flush=True)
        if found:
            sys.exit(f"not finite: {found[0]} and {len(found) - 1} more")
        if number == 3 * len(BREATHS):  # every stomach with every grade, most likely
            base = memory
        if base is not None and memory > base + options.growth:
            sys.exit(f"memory has grown from {base:.0f} to {memory:.0f} MB")


if __name__ == "__main__":
    main()
