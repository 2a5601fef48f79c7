#!/usr/bin/python3
"""Draws predictions of published experiments over what was found: plot_measurements.py MEASUREMENTS.csv OUT.png"""

import csv
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "../../../scripts/lib"))
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import measured_experiments as data

LIMITS = (0.25, 4)


def points(rows, experiment, run):
    """(ratio, two deviations of it) of each value; relative to what the experiment names as scale."""
    for row in rows:
        if run in (None, row["run"]):
            spread = 0 if math.isnan(row["deviation"]) else data.MANY * row["deviation"] / abs(row["truth"])
            yield 1 + data.error(row, rows, experiment), spread


def main(table, picture):
    with open(table, newline="", encoding="utf-8") as stream:
        predictions = list(csv.DictReader(stream))
    lines = []
    for name, experiment in data.experiments():
        rows = list(data.compared(row for row in predictions if row["experiment"] == name))
        for run in experiment.get("compared_apart", [None])[:2]:
            if rows:
                lines.append((", ".join(filter(None, (experiment["title"], run))), list(points(rows, experiment, run))))
    figure, axes = plt.subplots(figsize=(10, 0.55 * len(lines) + 1.2))
    for place, (title, found) in enumerate(reversed(lines)):
        for number, (ratio, spread) in enumerate(found):
            height = place + 0.6 * ((number + 0.5) / len(found) - 0.5)
            inside = LIMITS[0] < ratio < LIMITS[1]
            axes.errorbar(min(max(ratio, LIMITS[0]), LIMITS[1]), height, xerr=spread or None, color=f"C{place % 10}",
                          marker="o" if inside else ">", markersize=3, elinewidth=0.6)
    axes.axvline(1, color="black", linewidth=0.8)
    axes.axvspan(0.9, 1.1, color="0.92", zorder=0)
    axes.set_xscale("log")
    ticks = (0.25, 0.5, 0.7, 0.9, 1, 1.1, 1.4, 2, 4)
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_yticks(range(len(lines)), [title for title, _ in reversed(lines)])
    axes.set_xlabel("predicted / found\nbars: twice the published scatter; grey: 10 %; arrow: beyond the picture")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
