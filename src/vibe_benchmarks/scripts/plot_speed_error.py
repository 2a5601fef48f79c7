#!/usr/bin/env python3
"""Draws time per step against errors from the table that vibe_bench writes.

usage: plot_speed_error.py [--machine=TEXT] TABLE.csv PICTURE.png [PICTURE.svg ...]
"""
import math
import sys

from matplotlib.transforms import Bbox

from plot_lib import label_log_axes, parse_arguments, plt, read_table, save, set_title

PULL = "pull_20mm"
WORST = 1.0  # errors beyond are drawn at the edge, as triangles with their figure
# method: name, colour, marker
FAMILIES = {
    "implicit": ("shell, generalised alpha", "tab:blue", "o"),
    "euler": ("shell, backward Euler", "tab:cyan", "o"),
    "shape_matching": ("shape matching", "tab:purple", "D"),
}
PROTOTYPE = (16, 18)  # ms per frame that Erden et al. report for 3,618 particles, without an error
# column: (largest CPU time of a frame [ms], largest error); the third one of the motion is 17 steps of 0.6 ms
GOALS = {
    "motion_error": [(1.0, 0.035), (3.0, 0.012), (10.2, 0.001)],
    "force_error": [(1.0, 0.03), (3.0, 0.025)],
    "static_error": [(100, 1e-4)],
}
LABEL_SPOTS = [(6, -3), (-6, -3), (0, 6), (0, -12), (6, 6), (-6, 6), (6, -12), (-6, -12), (14, 12), (14, -18), (-14, 12),
               (-14, -18), (0, 16), (0, -22), (20, 22), (20, -28)]


def number(text):
    return float(text) if text else math.nan


def step_rate(setting):
    return float(setting.split(" Hz")[0]) if " Hz" in setting else 60.0


def family(row):
    return "euler" if "Euler" in row["setting"] else row["method"]


def label(setting):
    short = setting.replace(" iterations", " it.").replace(" iteration", " it.").replace(" Euler", "")
    return short.replace("60 Hz, ", "", 1) if short.startswith("60 Hz, ") else short


def per_frame(row):
    """Time of a 60 Hz frame: the solver is timed per step, other methods per frame."""
    return number(row["ms_p50"]) * (step_rate(row["setting"]) / 60 if row["method"] == "implicit" else 1)


def points_of(rows, column):
    points = []
    for row in rows:
        time, error = per_frame(row), number(row[column])
        if not math.isnan(time) and not math.isnan(error):
            points.append((family(row), time, error, label(row["setting"])))
    return points


def draw_errors(axis, rows, column, title):
    points = points_of(rows, column)
    for key, (name, colour, marker) in FAMILIES.items():
        for beyond in (False, True):
            chosen = [point for point in points if point[0] == key and (point[2] > WORST) == beyond]
            axis.plot([p[1] for p in chosen], [100 * min(p[2], WORST) for p in chosen], "^" if beyond else marker,
                      color=colour, markersize=6, label=None if beyond else name, zorder=3)
    axis.axvspan(*PROTOTYPE, color="0.85", label="ViBE prototype, 16 to 18 ms, error unknown")
    for number_of, (time, error) in enumerate(GOALS[column]):
        axis.plot([axis_left(points), time, time], [100 * error, 100 * error, 100 * lowest(points)], "--",
                  color="tab:red", linewidth=0.9, label="aims: left of and below the line" if number_of == 0 else None)
    axis.text(math.sqrt(PROTOTYPE[0] * PROTOTYPE[1]), 100 * lowest(points) * 1.2, "ViBE prototype", rotation=90,
              ha="center", va="bottom", fontsize=7, color="0.4")
    label_log_axes(axis, "median CPU time of a 60 Hz frame [ms]", title + " [%]")
    axis.set_xlim(axis_left(points), max(45, 2 * max(point[1] for point in points)))
    axis.set_ylim(100 * lowest(points), 190)
    place_labels(axis, points)


def axis_left(points):
    return 0.5 * min(point[1] for point in points)


def lowest(points):
    return 0.3 * min(point[2] for point in points)


def place_labels(axis, points):
    """Places each label at the first position around its point that covers neither a point nor another label."""
    renderer = axis.figure.canvas.get_renderer()
    taken = []
    for _, time, error, _ in points:
        x, y = axis.transData.transform((time, 100 * min(error, WORST)))
        taken.append(Bbox.from_extents(x - 4, y - 4, x + 4, y + 4))
    for key, time, error, text in sorted(points, key=lambda point: point[1]):
        if error > WORST:
            text += f": {100 * error:,.0f} %"
        best = None
        for x, y in LABEL_SPOTS:
            note = axis.annotate(text, (time, 100 * min(error, WORST)), textcoords="offset points", xytext=(x, y),
                                 ha="left" if x > 0 else "right" if x < 0 else "center", fontsize=6.5,
                                 color=FAMILIES[key][1], zorder=4)
            box = note.get_window_extent(renderer)
            overlap = sum(1 for other in taken if box.overlaps(other))
            if best is None or overlap < best[0]:
                if best is not None:
                    best[1].remove()
                best = (overlap, note, box)
            else:
                note.remove()
            if best[0] == 0:
                break
        taken.append(best[2])


def draw_growth(axis, rows):
    steps = sorted((int(row["particles"]), number(row["ms_p50"])) for row in rows if row["case"] == "growth")
    factors = sorted((int(row["particles"]), number(row["ms_p50"])) for row in rows if row["case"] == "growth_factor")
    for values, name, colour in ((steps, "step", "tab:blue"), (factors, "stiffness and factor, in the background", "0.5")):
        axis.plot([v[0] for v in values], [1e3 * v[1] / v[0] for v in values], "o-", color=colour, label=name)
        for size, time in values:
            axis.annotate(f"{time:,.3g} ms" if time < 1000 else f"{time / 1000:.1f} s", (size, 1e3 * time / size),
                          textcoords="offset points", xytext=(0, 6), ha="center", fontsize=7, color=colour)
    if steps:
        axis.axhline(3 * min(1e3 * v[1] / v[0] for v in steps), color="tab:red", linewidth=0.9, linestyle="--",
                     label="aim for the step: below three times the smallest")
    label_log_axes(axis, "particles", "median CPU time per particle [us]")
    axis.set_ylim(0.1, 200)
    axis.set_xticks([v[0] for v in steps], [str(v[0]) for v in steps])
    axis.margins(x=0.15)
    axis.legend(fontsize=7, loc="center left")


def main(options, table, pictures):
    rows = read_table(table, "case", "vibe_bench --csv")
    pulls = [row for row in rows if row["case"] == PULL]
    if not pulls:
        sys.exit(f"{table}: has no row of the case '{PULL}'; write it with vibe_bench --csv, without --case")
    figure, axes = plt.subplots(2, 2, figsize=(13, 10.5))
    particles = pulls[0]["particles"]
    set_title(figure, f"20 mm pull in 0.5 s, {particles} particles, one thread: speed against error", options)
    figure.subplots_adjust(left=0.07, right=0.98, top=0.92, bottom=0.06, wspace=0.18, hspace=0.2)
    draw_errors(axes[0][0], pulls, "motion_error", "error of the motion, worst frame")
    draw_errors(axes[0][1], pulls, "force_error", "error of the force, worst frame")
    draw_errors(axes[1][0], pulls, "static_error", "error 0.5 s after the stop")
    draw_growth(axes[1][1], rows)
    axes[1][0].legend(fontsize=7, loc="center left")
    save(figure, pictures)


if __name__ == "__main__":
    main(*parse_arguments(__doc__, ("machine",)))
