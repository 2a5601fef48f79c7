#!/usr/bin/env python3
"""Measures what the module and the environments take, as the rows of the table in docs/python.md. CPU times of the
process unless wall time is named; a machine with other work on it makes them longer."""

import concurrent.futures
import ctypes
import multiprocessing
import os
import resource
import subprocess
import sys
import time

import numpy as np

import vibe
from vibe.env import Environment, VectorEnvironment, organs

ORGAN = [("sthenic", 1.0)]


def median(call, count):
    times = []
    for _ in range(count):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return 1e3 * float(np.median(times))


def first_step():
    program = ("import time; t = time.monotonic(); import vibe; a = time.monotonic(); s = vibe.Simulation(vibe.load()); "
               "s.step(); print(a - t, time.monotonic() - t, time.process_time())")
    said = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, check=True, text=True).stdout.split()
    return [float(word) for word in said]


def overhead():
    """Of step() from Python against run(), where the loop is in C++, on tissue at rest: the cheapest step."""
    simulation = vibe.Simulation(vibe.load(geometry={"kind": "sphere", "particles": 100}), metrics=False)
    simulation.run(600)
    best = {}
    for _ in range(9):
        for name, call in (("python", lambda: [simulation.step() for _ in range(2000)]),
                           ("c++", lambda: simulation.run(2000))):
            best[name] = min(best.get(name, np.inf), median(call, 1) / 2000)
    return 1e3 * (best["python"] - best["c++"])


def reach(scale, breathing=None, step_period=None, episodes=8, repeats=3):
    """Whole episodes of random actions of some of the greatest speed: actions per second of CPU time of all threads, the
    median of some repeats, and the share of actions after which the tool touches the wall."""
    environment = Environment("Reach", organs=ORGAN, breathing=breathing, step_period=step_period)
    speeds, touches = [], []
    for _ in range(repeats):
        spent = 0.0
        for seed in range(episodes):
            environment.reset(seed=seed)
            random, over = np.random.default_rng(seed), False
            while not over:
                action = scale * random.uniform(-1, 1, 4)
                begin = time.process_time()
                _, _, terminated, truncated, _ = environment.step(action)
                spent += time.process_time() - begin
                over = terminated or truncated
                touches.append(len(environment.simulation.contacts()["link"]) > 0)
        speeds.append(len(touches) / (len(speeds) + 1) / spent)
    return f"{np.median(speeds):.0f}; {100 * np.mean(touches):.0f} %"


def forces(scale, step_period, episodes=4, actions=40):
    """Force on the tool (n, 3) [N] and places of the wall (n, 48, 3) [m] after each action of some episodes."""
    environment = Environment("Reach", organs=ORGAN, step_period=step_period)
    force, wall = [], []
    for seed in range(episodes):
        environment.reset(seed=seed)
        random = np.random.default_rng(seed)
        for _ in range(actions):
            environment.task.advance(scale * random.uniform(-1, 1, (1, 4)))
            seen = environment.task.current()
            force.append(seen["wrench"][0, :3])
            wall.append(seen["wall"][0])
    return np.array(force), np.array(wall)


def step_periods():
    """What longer steps change, against steps of 1/240 s, and what they take."""
    for name, scale in (("slow motions", 0.2), ("all of the speed", 1.0)):
        force, wall = forces(scale, 1 / 240)
        print(f"| {name}: 1/240 s | greatest force {np.linalg.norm(force, axis=1).max():.2f} N | | |")
        for period in (60, 40, 20):
            other, moved = forces(scale, 1 / period)
            error = np.linalg.norm(other - force, axis=1)
            print(f"| {name}: 1/{period} s | {1e3 * np.sqrt(np.mean(error**2)):.1f} mN, {1e3 * error.max():.0f} mN | "
                  f"{1e3 * np.linalg.norm(moved - wall, axis=2).max():.2f} mm | {reach(scale, None, 1 / period)} |", flush=True)


def side_by_side(threads, cores, slots=16, actions=200):
    """Actions per second of wall time, and CPU time of all threads per action [ms], of whole episodes side by side at full
    speed, in a process that has these cores. The factors are made in threads of their own, beside those that step."""
    os.sched_setaffinity(0, cores)
    environments = VectorEnvironment("Reach", slots, threads=threads, organs=ORGAN)
    environments.reset(seed=1)
    random = np.random.default_rng(1)
    begin, spent = time.monotonic(), time.process_time()
    for _ in range(actions):
        environments.step(random.uniform(-1, 1, (slots, 4)))
    wall, spent = time.monotonic() - begin, time.process_time() - spent
    return slots * actions / wall, 1e3 * spent / (slots * actions)


def scaling(rounds=3):
    """side_by_side() for one thread on one core, one on two, two on two: of each the median of some rounds in turn."""
    two = sorted(os.sched_getaffinity(0))[:2]
    asked = {"one thread, one core": (1, two[:1]), "one thread, two cores": (1, two), "two threads, two cores": (2, two)}
    found = {name: [] for name in asked}
    for _ in range(rounds):
        for name, (threads, cores) in asked.items():
            with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
                found[name].append(process.submit(side_by_side, threads, cores).result())
    return {name: np.median(rows, axis=0) for name, rows in found.items()}


def memory(particles, impedance):
    """Resident memory per further simulation that has run [MB]."""
    ctypes.CDLL(None).malloc_trim(0)  # what earlier ones have left would be used first
    model = vibe.load(geometry={"particles": particles}, render_surface=False)
    kept = []

    def one():
        simulation = vibe.Simulation(model, metrics=False, impedance=impedance)
        simulation.run(40, insertion=0.1, insufflate=True)
        kept.append(simulation)

    one()
    page = resource.getpagesize()
    resident = lambda: int(open("/proc/self/statm").read().split()[1]) * page
    before = resident()
    for _ in range(8):
        one()
    return (resident() - before) / 8 / 1e6


def resets():
    """Times [ms] of restore(), of the first step after it, and of reset() with a goal that is known."""
    organ = organs.organ(("sthenic", 1.0), 1000)
    simulation, spent = organ.take(), []
    restored = median(lambda: simulation.restore(organ.starts[1][0]), 50)
    for _ in range(20):
        simulation.run(5, insertion=0.12)
        simulation.restore(organ.starts[1][0])
        spent.append(median(simulation.step, 1))
    environment = Environment("Reach", organs=ORGAN)
    for seed in range(20):
        environment.reset(seed=seed)
    seeds = iter(range(20))
    return restored, float(np.median(spent)), median(lambda: environment.reset(seed=next(seeds)), 20)


def session():
    """The hash of the first session of the README."""
    model = vibe.load()
    simulation = vibe.Simulation(model)
    simulation.follow(vibe.Trainee(model, "package://vibe_core/trainees/first.yaml"))
    return f"{simulation.hash():016x}"


def first():
    imported, stepped, cpu = first_step()
    print(f"| `import vibe`; and the first step of the default stomach | {imported:.2f} s; {stepped:.2f} s of wall time, "
          f"{cpu:.2f} s of CPU |")
    print(f"| `step()` from Python more than a step in C++ | {overhead():.1f} us |")
    restored, after, reset = resets()
    print(f"| `restore()` of a snapshot, 1,000 particles | {restored:.2f} ms |")
    print(f"| the first step after it, of a prepared snapshot | {after:.1f} ms |")
    print(f"| `reset()` of `Reach`, a goal known | {reset:.2f} ms |")


def pictures():
    full = vibe.Simulation(vibe.load())
    full.run(30, insertion=0.08, insufflate=True)
    print(f"| depth and labels, 128 x 128, 3,618 particles | {median(lambda: full.camera(128, 128), 30):.2f} ms |")
    for colour, tool in ((True, False), (False, True), (True, True)):
        name = " and ".join(["colours"] * colour + ["device"] * tool)
        print(f"| the same with {name} | {median(lambda: full.camera(128, 128, colour=colour, tool=tool), 30):.2f} ms |")


def threads():
    for name, (rate, spent) in scaling().items():
        print(f"| 16 episodes of `Reach` side by side: {name} | {rate:.0f} actions per second of wall time, {spent:.2f} ms of "
              f"CPU each |", flush=True)


def memories():
    for name, impedance in (("without impedance, as in environments", False), ("all of it", True)):
        print(f"| memory per further simulation, 1,000; 3,618 particles: {name} | {memory(1000, impedance):.0f} MB; "
              f"{memory(3618, impedance):.0f} MB |")


def speeds():
    print("| time per step | force differs: root mean square, greatest | wall, greatest | actions per CPU second; in contact |")
    step_periods()
    print(f"With moderate breathing, slow motions: {reach(0.2, 'moderate')}")


PARTS = {"first": first, "pictures": pictures, "threads": threads, "memories": memories, "speeds": speeds,
         "session": lambda: print(f"state hash of the first session: {session()}")}


def main():
    asked = sys.argv[1:] or list(PARTS)
    if not set(asked) <= set(PARTS):
        sys.exit(f"usage: measure.py [part ...]; the parts are {', '.join(PARTS)}; all of them by default")
    for name in asked:
        PARTS[name]()
        print(f"{name}: load {os.getloadavg()[0]:.1f}, {len(os.sched_getaffinity(0))} cores", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
