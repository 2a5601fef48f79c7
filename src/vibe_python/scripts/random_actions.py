#!/usr/bin/env python3
"""Random actions in every task, still and breathing, alone and side by side, for as long as wanted; between them what
programs do to simulations: snapshots, pickles, threads, forks, views that outlive what they show. No crash, no number that
is not finite, no growth of memory. Prints a line per round of all tasks; ends with status 1 at the first thing that is
wrong."""

import argparse
import ctypes
import itertools
import os
import sys
import time

import numpy as np

import vibe
from vibe.env import BREATHING, TASKS, Environment, Expert, VectorEnvironment, organs

import rough_use

ORGANS = [("sthenic", 0.92), ("j", 1.0), ("steer_horn", 1.08)]
BREATHS = (None, *BREATHING)


def resident():
    """Memory of the process [MB]. What is free goes back to the system first: how much malloc() keeps says nothing of growth."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def allocated():
    """What malloc() has given out and not got back [MB], with glibc 2.33 or newer; what it keeps besides is free."""
    class Info(ctypes.Structure):
        _fields_ = [(name, ctypes.c_size_t) for name in ("arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks "
                                                         "fordblks keepcost").split()]

    ask = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if ask is None:
        return float("nan")
    ask.restype = Info
    info = ask()
    return (info.uordblks + info.hblkhd) / 1e6


def faults(name, parts):
    return [f"{name}.{key}" for key, value in parts.items() if not np.isfinite(value).all()]


def held_actions(space, random):
    """Random actions, each held for some steps as a hand holds them."""
    while True:
        held = (random.uniform(space.low, space.high) * random.choice([0.2, 1])).astype(np.float32)
        for _ in range(int(random.integers(1, 12))):
            yield held


def side_by_side(task, random, actions, autoreset, **settings):
    environment = VectorEnvironment(task, 2, autoreset=autoreset, **settings)
    environment.reset(seed=int(random.integers(2**31)))
    found = []
    for action in itertools.islice(held_actions(environment.action_space, random), actions):
        seen, reward, terminated, truncated, _ = environment.step(action)
        found += faults("observation", seen) + faults("step", {"reward": reward})
        if autoreset == "disabled" and (terminated | truncated).any():
            environment.reset(options={"reset_mask": terminated | truncated})
    environment.close()
    return 2 * actions, found


def alone(task, random, actions, **settings):
    """Half of the actions are the expert's where there is one: they go where chance does not."""
    environment = Environment(task, **settings)
    expert = Expert(environment) if environment.task.expert(1) else None
    over, found, seen = True, [], None
    for action in itertools.islice(held_actions(environment.action_space, random), actions):
        if over:
            seen, _ = environment.reset(seed=int(random.integers(2**31)))
            if expert:
                expert.reset()
        if expert and random.random() < 0.5:
            action = expert.action(seen)
        seen, reward, terminated, truncated, _ = environment.step(action)
        over = terminated or truncated
        found += faults("observation", seen) + faults("step", {"reward": reward})
    found += rough_use.of(environment, random)
    environment.close()
    return actions, found


def one_round(number, particles, actions):
    """Every task for some actions. Returns actions taken and faults."""
    random, found, taken = np.random.default_rng([31, number]), [], 0
    asked = [("Reach", breathing) for breathing in BREATHS]
    asked += [(task, BREATHS[(number + k) % len(BREATHS)]) for k, task in enumerate(TASKS) if task != "Reach"]
    for k, (task, breathing) in enumerate(asked):
        settings = {"particles": particles, "organs": ORGANS, "breathing": breathing,
                    "action": "tip" if TASKS[task].moves_tip_only() and number % 2 else "joints",
                    "camera": (16, 12, 1.7) if (number + k) % 3 == 0 else None}
        if settings["camera"]:
            settings["pictures"] = ["depth", "normal", "colour"]
        if (number + k) % 2:
            count, wrong = alone(task, random, actions, **settings)
        else:
            mode = ("next_step", "same_step", "disabled")[number % 3]
            count, wrong = side_by_side(task, random, actions, mode, threads=1 + number % 2, **settings)
        taken += count
        found += [f"{task}, {breathing}: {fault}" for fault in wrong]
    return taken, found


def meet_all(particles):
    """Every stomach is prepared, and has as many simulations as a round uses at once: what is kept for the process."""
    for (shape, scale), breathing, step in itertools.product(ORGANS, BREATHS, (1 / 20, 1 / 60)):
        organ = organs.organ((shape, scale), particles, breathing, step)
        for simulation in [organ.take() for _ in range(3)]:
            simulation.run(30, insertion=0.2, tip_up_down=0.6, insufflate=True)
            organ.give(simulation)


def growth(minutes, memory):
    """Of the straight line that fits best, over all of the time [MB]."""
    return float(np.polyfit(minutes, memory, 1)[0] * np.ptp(minutes)) if len(minutes) > 2 else 0.0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=20, help="of wall time (default: %(default)s)")
    parser.add_argument("--particles", type=int, default=1000)
    parser.add_argument("--actions", type=int, default=200, help="per task and round (default: %(default)s)")
    parser.add_argument("--growth", type=float, default=30, help="of resident memory that is allowed in the second half "
                        "of the time, by the straight line that fits it best [MB]; -1: any (default: %(default)s)")
    options = parser.parse_args()
    meet_all(options.particles)
    begin = time.monotonic()
    total, number, track = 0, 0, []
    while time.monotonic() < begin + 60 * options.minutes:
        taken, found = one_round(number, options.particles, options.actions)
        total, number = total + taken, number + 1
        track.append(((time.monotonic() - begin) / 60, resident()))
        print(f"round {number}: {total} actions, {track[-1][1]:.0f} MB, of it {allocated():.0f} MB in use", flush=True)
        if found:
            sys.exit(f"{found[0]} and {len(found) - 1} more")
    later = np.array([point for point in track if point[0] > options.minutes / 2])
    grown = growth(*later.T) if len(later) else 0.0
    print(f"{total} actions in {track[-1][0]:.1f} minutes; in the second half memory grew by {grown:.1f} MB")
    if 0 <= options.growth < grown:
        sys.exit(f"memory grows by {grown:.1f} MB, more than {options.growth:g} MB")


if __name__ == "__main__":
    main()
