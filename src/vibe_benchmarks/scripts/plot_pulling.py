#!/usr/bin/env python3
"""Draws the side view of two bites pulled together, from the mid-lines that vibe_bench --pulling --profile writes.

usage: plot_pulling.py PROFILE.csv REFERENCE.csv PICTURE.png
REFERENCE.csv: reference/case7_field.csv
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {
    "condition": "tab:gray",
    "thread": "tab:blue",
    "groups, first 5": "tab:orange",
    "groups, all": "tab:red",
    "groups, all, limit 2": "tab:brown",
}
TITLES = {"shell": "shell", "shape_matching": "shape matching"}


def profiles(path):
    lines = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            line = lines.setdefault((row["method"], row["setting"]), ([], [], float(row["tension"])))
            line[0].append(1e3 * float(row["x"]))
            line[1].append(1e3 * float(row["z"]))
    return lines


def reference(path):
    """Mid-line of the finite elements at the last level; the other half follows by symmetry."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    last = max(float(row["level"]) for row in rows)
    points = [
        (1e3 * (float(row["x"]) + float(row["ux"])), 1e3 * (float(row["z"]) + float(row["uz"])))
        for row in rows
        if float(row["level"]) == last and abs(float(row["y"])) < 1e-9 and row["ux"] and row["uz"]
    ]
    return sorted({(sign * x, z) for x, z in points for sign in (-1, 1)})


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    lines, points = profiles(sys.argv[1]), reference(sys.argv[2])
    figure, axes = plt.subplots(len(TITLES), 1, figsize=(9, 5.8), sharex=True, sharey=True)
    for axis, (method, title) in zip(axes, TITLES.items()):
        for (line_method, setting), (x, z, tension) in lines.items():
            if line_method == method:
                axis.plot(x, z, color=COLOURS[setting], label=f"{setting}: {tension:.2f} N", linewidth=1.6)
        axis.plot(*zip(*points), "k.", markersize=6, label="finite elements, bites 10 mm apart")
        axis.set_title(title, loc="left")
        axis.set_ylabel("z, mm")
        axis.set_aspect("equal")
        axis.legend(fontsize=7, loc="upper left")
        axis.set_ylim(-4, 26)
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("x, mm")
    figure.suptitle("Side view of a wall whose two bites, 40 mm apart, are pulled together")
    figure.tight_layout()
    figure.savefig(sys.argv[3], dpi=110)


if __name__ == "__main__":
    main()
