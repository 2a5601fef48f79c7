#!/usr/bin/env python3
"""Draws speed against error of states with contact, from the table that `vibe_contact states` writes.

usage: plot_contact.py [--machine=TEXT] [--sutures=TABLE.csv] [--steps=STEPS.csv] TABLE.csv PICTURE.png [PICTURE.svg ...]

With the table of `vibe_sutures scenarios` it adds the growth of a step over the sets, with the steps of
`vibe_contact hard --steps` the cost of a step over its contacts.
"""
import csv
import math
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402

STATES = {
    "free": ("free pull", "tab:blue", "o"),
    "free_closed": ("free pull, insufflator off", "tab:cyan", "o"),
    "pressed": ("pressed by the scope", "tab:red", "s"),
    "wound": ("gripped and wound fold", "tab:purple", "^"),
    "cinch1": ("first set cinched", "tab:green", "D"),
    "cinch6": ("sixth set cinched", "tab:olive", "D"),
}
FRAME = 1000 / 60  # [ms]
LEAST = 1e-3  # error drawn at least [%]


def read(name, needed):
    with open(name, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    if not rows or needed not in rows[0]:
        sys.exit(f"{name}: has no column '{needed}'; see --help for the program that writes it")
    return rows


def settings(row):
    return f"{row['rate']} Hz, {row['iterations']} it."


def draw_errors(axis, rows, column, title):
    for name, (label, colour, marker) in STATES.items():
        points = [(float(row["ms_p50"]) * float(row["rate"]) / 60, max(100 * float(row[column]), LEAST), settings(row))
                  for row in rows if row["state"] == name and row[column]]
        points.sort()
        if not points:
            continue
        axis.plot([p[0] for p in points], [p[1] for p in points], marker + "-", color=colour, linewidth=0.8,
                  markersize=5, label=label)
        for time, error, text in points:
            axis.annotate(text, (time, error), textcoords="offset points", xytext=(4, 3), fontsize=5.5, color=colour)
    axis.axvline(FRAME, color="tab:red", linestyle="--", linewidth=0.9, label="a 60 Hz frame")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel("median CPU time of a 60 Hz frame [ms]")
    axis.set_ylabel(title + " [%]")
    for one, locator in ((axis.xaxis, LogLocator(subs=(1, 2, 5))), (axis.yaxis, LogLocator())):
        one.set_major_locator(locator)
        one.set_major_formatter(FormatStrFormatter("%g"))
        one.set_minor_formatter(NullFormatter())
    axis.grid(True, which="major", color="0.92")
    axis.legend(fontsize=7)


def draw_growth(axis, rows):
    for name, colour in (("8x7", "tab:blue"), ("14x4", "tab:green")):
        chosen = [row for row in rows if row["scenario"] == name]
        sets = [int(row["set"]) for row in chosen]
        axis.plot(sets, [float(row["pulling_mean"]) for row in chosen], "o-", color=colour, markersize=4,
                  label=f"{name}, mean while pulling")
        axis.plot(sets, [float(row["pulling_p99"]) for row in chosen], "s--", color=colour, markersize=3, linewidth=0.8,
                  label=f"{name}, 99th percentile")
    axis.set_xlabel("suture set")
    axis.set_ylabel("CPU time of a step [ms]")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.set_ylim(bottom=0)
    axis.grid(True, color="0.92")
    axis.legend(fontsize=7)


def slope(points):
    """Least-squares line: time without contact, time per contact."""
    x, y = [p[0] for p in points], [p[1] for p in points]
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    square = sum((v - mean_x) ** 2 for v in x)
    rate = sum((v - mean_x) * (w - mean_y) for v, w in points) / square if square else math.nan
    return mean_y - rate * mean_x, rate


def draw_contacts(axis, rows):
    by_count = {}
    for row in rows:
        by_count.setdefault(int(row["contacts"]), []).append(float(row["ms"]))
    points = sorted((count, statistics.median(times)) for count, times in by_count.items())
    axis.plot([p[0] for p in points], [p[1] for p in points], "o", color="tab:red", markersize=4,
              label="median of the steps with so many contacts")
    start, rate = slope([(int(row["contacts"]), float(row["ms"])) for row in rows])
    axis.plot([0, points[-1][0]], [start, start + rate * points[-1][0]], "-", color="0.5", linewidth=0.9,
              label=f"{1000 * rate:.0f} µs per contact")
    axis.set_xlabel("contacts of tool and wall")
    axis.set_ylabel("CPU time of a step [ms]")
    axis.set_ylim(bottom=0)
    axis.grid(True, color="0.92")
    axis.legend(fontsize=7)


def main(options, table, pictures):
    rows = read(table, "motion_error")
    extra = [name for name in ("sutures", "steps") if name in options]
    count = 2 + len(extra)
    figure, axes = plt.subplots(1 if count == 2 else 2, 2, figsize=(13, 5.5 if count == 2 else 10.5), squeeze=False)
    axes = [axis for line in axes for axis in line]
    machine = options.get("machine", "")
    figure.suptitle("Steps in contact: speed against error" + (f"\n{machine}" if machine else ""), fontsize=11)
    draw_errors(axes[0], rows, "motion_error", "error of the motion, worst frame")
    draw_errors(axes[1], rows, "force_error", "error of force or tension, worst frame")
    if "sutures" in options:
        draw_growth(axes[2], read(options["sutures"], "pulling_mean"))
    if "steps" in options:
        draw_contacts(axes[count - 1], read(options["steps"], "contacts"))
    for axis in axes[count:]:
        axis.set_axis_off()
    figure.tight_layout()
    for picture in pictures:
        figure.savefig(picture, dpi=130, metadata={"Date": None} if picture.endswith(".svg") else None)


if __name__ == "__main__":
    arguments = sys.argv[1:]
    chosen = {}
    while arguments and arguments[0].startswith("--"):
        key, _, value = arguments.pop(0)[2:].partition("=")
        if key not in ("machine", "sutures", "steps") or not value:
            sys.exit(__doc__.strip())
        chosen[key] = value
    if len(arguments) < 2:
        sys.exit(__doc__.strip())
    main(chosen, arguments[0], arguments[1:])
