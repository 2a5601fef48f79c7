#!/usr/bin/env python3
"""Draws what `vibe_haptic_loop --csv NAME` has written: forces and errors with the spring-damper and with the last force.

usage: plot_haptic_loop.py NAME PICTURE.png [PICTURE.svg ...]
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def read(file):
    with open(file) as lines:
        rows = list(csv.DictReader(lines))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def draw_forces(axis, run, title):
    axis.step(run["time"], run["frame"], color="0.7", linewidth=0.8, label="simulator, last frame")
    axis.plot(run["time"], run["rendered"], color="tab:blue", linewidth=1, label="motor")
    axis.plot(run["time"], run["reference"], color="tab:red", linewidth=1, linestyle="--", label="1,000 steps per second")
    axis.set_title(title, fontsize=10)
    axis.grid(alpha=0.3)


def draw_error(axis, runs):
    for run, name, colour in zip(runs, ("spring-damper", "last force held"), ("tab:blue", "tab:orange")):
        error = [1e3 * (a - b) for a, b in zip(run["rendered"], run["reference"])]
        axis.plot(run["time"], error, color=colour, linewidth=0.9, label=name)
    axis.set_ylabel("error [mN]")
    axis.set_xlabel("time [s]")
    axis.legend(fontsize=8, loc="upper right")
    axis.grid(alpha=0.3)


def main():
    if len(sys.argv) < 3 or "--help" in sys.argv:
        print(__doc__.strip())
        return 0 if "--help" in sys.argv else 2
    runs = [read(sys.argv[1] + end) for end in (".spring.csv", ".held.csv")]
    figure, axes = plt.subplots(3, 1, figsize=(7, 7), sharex=True, constrained_layout=True)
    draw_forces(axes[0], runs[0], "force, stiffness and damping from haptic/parameters")
    draw_forces(axes[1], runs[1], "last force held")
    for axis in axes[:2]:
        axis.set_ylabel("force [N]")
    axes[0].legend(fontsize=8, loc="lower right")
    draw_error(axes[2], runs)
    for picture in sys.argv[2:]:
        figure.savefig(picture, dpi=120)
    return 0


if __name__ == "__main__":
    sys.exit(main())
