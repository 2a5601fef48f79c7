#!/usr/bin/env python3
"""Draws the motion of the haptic device after the hand lets go, measured and computed.

The table comes from build-firmware/host/vibe_cosim release --table TABLE, in this process or, with --fifos, in QEMU.
"""
import argparse
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

TITLES = ("K = 0.1 N m/rad, B = 4 mN m s/rad", "K = 0.3 N m/rad, B = 6 mN m s/rad")


def read(path):
    """@return dictionary: heading of a column -> its numbers"""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def draw(table, axis, motion, error):
    time, measured = table["time"], table[f"axis {axis}"]
    theories = (("second order", "tab:orange"), ("sampled", "tab:green"))
    motion.plot(time, measured, label="firmware", color="tab:blue")
    for name, colour in theories:
        values = table[f"{name} {axis}"]
        motion.plot(time, values, "--", label=name, color=colour, linewidth=1)
        error.plot(time, [100 * (m - t) for m, t in zip(measured, values)], label=name, color=colour, linewidth=1)
    motion.set_title(TITLES[axis])
    motion.grid(True)
    error.grid(True)
    error.set_xlabel("time after the release [s]")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", help="written by vibe_cosim release --table")
    parser.add_argument("picture", help="PNG or SVG to write")
    arguments = parser.parse_args()
    table = read(arguments.table)
    figure, axes = plt.subplots(2, 2, sharex=True, figsize=(9, 5), height_ratios=(2, 1))
    for axis in range(2):
        draw(table, axis, axes[0][axis], axes[1][axis])
    axes[0][0].set_ylabel("position / displacement")
    axes[1][0].set_ylabel("difference [%]")
    axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(arguments.picture, dpi=100)


if __name__ == "__main__":
    main()
