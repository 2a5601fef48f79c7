#!/usr/bin/env python3
"""Draws the time of each suture set from the table that `vibe_sutures scenarios` writes.

usage: plot_sutures.py [--machine=TEXT] TABLE.csv PICTURE.png [PICTURE.svg ...]
"""
import sys

from plot_lib import FRAME, parse_arguments, plt, read_table, save, set_title

PROTOTYPE_FPS = (55, 59)  # Erden et al., both scenarios
TITLES = {"8x7": "8 sets of 7 bites", "14x4": "14 sets of 4 bites"}


def column(rows, name):
    return [float(row[name]) for row in rows]


def draw_rate(axis, rows):
    sets = [int(row["set"]) for row in rows]
    axis.bar(sets, [1000 / wall for wall in column(rows, "pulling_wall")], color="tab:blue",
             label="steps per second of wall time, mean while pulling")
    axis.axhspan(*PROTOTYPE_FPS, color="tab:orange", alpha=0.6, label="ViBE prototype, 55 to 59 frames per second")
    axis.axhline(60, color="tab:red", linestyle="--", linewidth=0.9, label="60 per second: real time")
    axis.set_ylabel("steps per second")


def draw_times(axis, rows):
    sets = [int(row["set"]) for row in rows]
    axis.plot(sets, column(rows, "pulling_max"), "^", color="0.6", markersize=5, label="dearest step while pulling")
    axis.plot(sets, column(rows, "pulling_p99"), "s-", color="tab:cyan", markersize=4, label="99th percentile")
    axis.plot(sets, column(rows, "pulling_mean"), "o-", color="tab:blue", label="mean while pulling")
    axis.plot(sets, column(rows, "after_mean"), "o--", color="tab:green", markersize=4, label="mean in the second after")
    prototype = float(rows[0]["prototype"])
    axis.axhline(prototype, color="tab:orange", label=f"ViBE prototype, {prototype:g} ms (Intel i7-12700KF)")
    axis.axhline(FRAME, color="tab:red", linestyle="--", linewidth=0.9, label="a 60 Hz frame")
    axis.set_ylabel("solver, CPU time of a step [ms]")


def finish(axis, title):
    axis.set_title(title, fontsize=10)
    axis.set_xlabel("suture set")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.set_ylim(0, 1.5 * axis.get_ylim()[1])
    axis.grid(True, axis="y", color="0.92")
    axis.set_axisbelow(True)
    axis.legend(fontsize=7, loc="upper left")


def main(options, table, pictures):
    rows = read_table(table, "scenario", "vibe_sutures scenarios --csv")
    missing = [name for name in TITLES if not any(row["scenario"] == name for row in rows)]
    if missing:
        sys.exit(f"{table}: has no rows of the scenario '{missing[0]}'; write it with vibe_sutures scenarios --csv")
    figure, axes = plt.subplots(2, 2, figsize=(12, 8.5))
    set_title(figure, "Suture sets, 3,618 particles", options)
    for place, (name, title) in enumerate(TITLES.items()):
        chosen = [row for row in rows if row["scenario"] == name]
        draw_rate(axes[0][place], chosen)
        finish(axes[0][place], title)
        draw_times(axes[1][place], chosen)
        finish(axes[1][place], title)
    figure.tight_layout()
    save(figure, pictures, dpi=120)


if __name__ == "__main__":
    main(*parse_arguments(__doc__, ("machine",)))
