#!/usr/bin/env python3
"""Draws time per step against errors from the table that vibe_bench writes.

usage: plot_speed_error.py TABLE.csv PICTURE.png [PICTURE.svg ...]
"""
import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402

PULL = "pull_20mm"
WORST = 10.0  # errors beyond are drawn at the edge, as arrows
COLOURS = ["tab:blue", "tab:orange", "tab:green", "tab:purple", "tab:brown"]


def number(text):
    return float(text) if text else math.nan


def step_rate(setting):
    return float(setting.split(" Hz")[0]) if " Hz" in setting else 60.0


def family(row):
    if row["method"] != "implicit":
        return row["method"].replace("_", " ") + " (per frame)"
    if "Euler" in row["setting"]:
        return "implicit, backward Euler"
    return "implicit, generalised alpha"


def label(setting):
    return setting.replace(" iterations", " it.").replace(" iteration", " it.").replace(" Euler", "")


def per_frame(row):
    """Time of a 60 Hz frame: steps of the implicit method are timed one by one, the peer's frames whole."""
    rate = step_rate(row["setting"])
    return number(row["ms_p50"]) * (rate / 60 if row["method"] == "implicit" else 1)


def draw_errors(axis, rows, column, title):
    families = sorted({family(row) for row in rows}, reverse=True)
    for colour, name in zip(COLOURS, families):
        points = []
        for row in rows:
            error = number(row[column])
            if family(row) == name and not math.isnan(error) and not math.isnan(per_frame(row)):
                points.append((per_frame(row), min(max(error, 1e-7), WORST) * 100, row["setting"], error > WORST))
        if not points:
            continue
        for beyond, marker in ((False, "o"), (True, "^")):
            chosen = [point for point in points if point[3] == beyond]
            axis.plot([p[0] for p in chosen], [p[1] for p in chosen], marker, color=colour, markersize=6,
                      label=name if not beyond or len(chosen) == len(points) else None)
        place_labels(axis, points, colour)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel("median CPU time of a 60 Hz frame [ms]")
    axis.set_ylabel(title + " [%]")
    axis.axvline(1000 / 60, color="0.6", linewidth=0.8, linestyle="--")
    axis.grid(True, which="major", color="0.9")
    axis.margins(x=0.25, y=0.15)
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axis.xaxis.set_minor_formatter(NullFormatter())


def place_labels(axis, points, colour):
    for rank, (time, error, setting, _) in enumerate(sorted(points)):
        up = rank % 2 == 0
        axis.annotate(label(setting), (time, error), textcoords="offset points", xytext=(5, 4 if up else -9),
                      fontsize=6.5, color=colour)


def draw_growth(axis, rows):
    rows = sorted(rows, key=lambda row: int(row["particles"]))
    sizes = [int(row["particles"]) for row in rows]
    costs = [1e3 * number(row["ms_p50"]) / size for row, size in zip(rows, sizes)]
    axis.plot(sizes, costs, "o-", color=COLOURS[0])
    if costs:
        axis.axhline(3 * costs[0], color="0.6", linewidth=0.8, linestyle="--")
        axis.text(sizes[0], 3 * costs[0], " three times the smallest", fontsize=7, va="bottom", color="0.4")
    axis.set_xscale("log")
    axis.set_ylim(bottom=0)
    axis.set_xticks(sizes)
    axis.xaxis.set_major_formatter(FormatStrFormatter("%d"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_xlabel("particles")
    axis.set_ylabel("median CPU time per particle and step [us]")
    axis.grid(True, which="major", color="0.9")


def main(table, pictures):
    with open(table, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    pulls = [row for row in rows if row["case"] == PULL]
    if not pulls:
        sys.exit(f"{table}: has no row of the case '{PULL}'; write it with vibe_bench --csv, without --case")
    growth = [row for row in rows if row["case"] == "growth"]
    figure, axes = plt.subplots(2, 2, figsize=(12, 9.5))
    draw_errors(axes[0][0], pulls, "motion_error", "error of the motion, worst frame")
    draw_errors(axes[0][1], pulls, "force_error", "error of the force, worst frame")
    draw_errors(axes[1][0], pulls, "static_error", "error 0.5 s after the stop")
    draw_growth(axes[1][1], growth)
    axes[0][0].legend(fontsize=8, loc="best")
    particles = pulls[0]["particles"]
    figure.suptitle(f"20 mm pull in 0.5 s, {particles} particles, one thread: speed against error\n"
                    "triangles: beyond 1000 %; dashed: one frame", fontsize=11)
    figure.tight_layout()
    for picture in pictures:
        figure.savefig(picture, dpi=130, metadata={"Date": None} if picture.endswith(".svg") else None)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    main(sys.argv[1], sys.argv[2:])
