#!/usr/bin/env python3
"""Draws speed against error of states with contact, from the table that `vibe_contact states` writes.

usage: plot_contact.py [--machine=TEXT] [--sutures=TABLE.csv] TABLE.csv PICTURE.png [PICTURE.svg ...]

With the table of `vibe_sutures scenarios` it adds the growth of a step over the sets.
"""
from matplotlib.ticker import LogLocator

from plot_lib import FRAME, label_log_axes, parse_arguments, plt, read_table, save, set_title

STATES = {
    "free": ("free pull", "tab:blue", "o"),
    "free_closed": ("free pull, insufflator off", "tab:cyan", "o"),
    "pressed": ("pressed by the scope", "tab:red", "s"),
    "wound": ("gripped and wound fold", "tab:purple", "^"),
    "cinch1": ("first set cinched", "tab:green", "D"),
    "cinch6": ("sixth set cinched", "tab:olive", "D"),
}
LEAST = 1e-3  # error drawn at least [%]


def labels(rows):
    """Of the points: steps per second, and the iterations where the table has several."""
    several = len({row["iterations"] for row in rows}) > 1
    return lambda row: row["rate"] + (f" x {row['iterations']}" if several else "")


def draw_errors(axis, rows, column, title):
    label_of = labels(rows)
    for name, (label, colour, marker) in STATES.items():
        points = [(float(row["ms_p50"]) * float(row["rate"]) / 60, max(100 * float(row[column]), LEAST), label_of(row))
                  for row in rows if row["state"] == name and row[column]]
        points.sort()
        if not points:
            continue
        axis.plot([p[0] for p in points], [p[1] for p in points], marker + "-", color=colour, linewidth=0.8,
                  markersize=5, label=label)
        for time, error, text in points:
            axis.annotate(text, (time, error), textcoords="offset points", xytext=(5, 3), fontsize=7, color=colour)
    axis.axvline(FRAME, color="tab:red", linestyle="--", linewidth=0.9, label="a 60 Hz frame")
    label_log_axes(axis, "median CPU time of a 60 Hz frame [ms]; labels: steps per second", title + " [%]")
    axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.legend(fontsize=7, loc="lower right")


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


def main(options, table, pictures):
    rows = read_table(table, "motion_error", "vibe_contact states --csv")
    rows = [row for row in rows if row.get("part", row["state"]) == row["state"]]  # the free pull of other runs
    count = 3 if "sutures" in options else 2
    figure, axes = plt.subplots(1, count, figsize=(6 * count, 5.2))
    set_title(figure, "Steps in contact: speed against error", options)
    draw_errors(axes[0], rows, "motion_error", "error of the motion, worst frame")
    draw_errors(axes[1], rows, "force_error", "error of force or tension, worst frame")
    if "sutures" in options:
        draw_growth(axes[2], read_table(options["sutures"], "pulling_mean", "vibe_sutures scenarios --csv"))
    figure.tight_layout()
    save(figure, pictures)


if __name__ == "__main__":
    main(*parse_arguments(__doc__, ("machine", "sutures")))
