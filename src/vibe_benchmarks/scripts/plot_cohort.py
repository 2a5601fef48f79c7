#!/usr/bin/env python3
"""Draws the measures of virtual trainees by skill, from `cohort.csv` of scripts/cohort, with published values.
Prints the same as a Markdown table: mean and standard deviation per skill, and how often an expert is the better one
of an expert and a novice (1: always, 0.5: no difference).

usage: plot_cohort.py [--machine=TEXT] TABLE.csv PICTURE.png [PICTURE.svg ...]
"""
import collections
import math
import statistics
import sys

from plot_lib import parse_arguments, plt, read_table, save, set_title

# better: +1 more, -1 less; published: (expert, novice), each (mean, standard deviation or None); source
Measure = collections.namedtuple("Measure", "column title scale better published source")
MEASURES = [
    Measure("bites_per_5_min", "bites in 5 minutes of suturing", 1, 1, ((13.1, 5.2), (3.0, 0.8)),
            "endoscopic suturing simulator"),
    Measure("time", "time [s]", 1, -1, None, "colonoscope task: 31.5 and 101.5 s"),
    Measure("movements", "movements", 1, -1, None, "colonoscope task: 21.5 and 62"),
    Measure("path_length", "path of the tip [m]", 1, -1, None, "hand motion, D'Angelo 2015"),
    Measure("spectral_arc_length", "smoothness, SPARC", 1, 1, None, "endovascular tool tip"),
    Measure("log_dimensionless_jerk", "smoothness, LDLJ", 1, 1, None, "hand motion, direction only"),
    Measure("area_reduction", "area of the body reduced by [%]", 100, 1, None, "sleeve: 34.6 and 9.4 %"),
    Measure("max_force", "max force on the tool [N]", 1, -1, None, ""),
    Measure("cinch_tension_mean", "tension of the cinch [N]", 1, 1, None, ""),
]
NAMES = {0.0: "expert", 1.0: "novice"}


def values(rows, measure, skill):
    chosen = [row[measure.column] for row in rows if float(row["novice"]) == skill]
    return [measure.scale * float(value) for value in chosen if value != ""]


def share_better(experts, novices, better):
    """Probability that an expert is better than a novice; ties count half (area under the ROC curve)."""
    wins = sum((better * (e - n) > 0) + 0.5 * (e == n) for e in experts for n in novices)
    return wins / (len(experts) * len(novices)) if experts and novices else math.nan


def summary(numbers):
    if not numbers:
        return "-"
    spread = statistics.stdev(numbers) if len(numbers) > 1 else 0
    return f"{statistics.mean(numbers):.3g} ± {spread:.2g}"


def print_table(rows, skills):
    names = [NAMES.get(skill, f"{skill:g}") for skill in skills]
    print("| measure | " + " | ".join(names) + " | expert better | published |")
    print("|---" * (len(skills) + 3) + "|")
    for measure in MEASURES:
        cells = [summary(values(rows, measure, skill)) for skill in skills]
        auc = share_better(values(rows, measure, 0.0), values(rows, measure, 1.0), measure.better)
        known = measure.source
        if measure.published:
            known = " and ".join(f"{mean:g} ± {spread:g}" for mean, spread in measure.published) + ", " + known
        print(f"| {measure.title} | " + " | ".join(cells) + f" | {auc:.2f} | {known} |")


def spread_out(count):
    """Places side by side, so that equal values do not hide each other."""
    return [0.24 * ((k * 0.618) % 1 - 0.5) for k in range(count)]


def draw(axis, rows, measure, skills):
    for place, skill in enumerate(skills):
        found = values(rows, measure, skill)
        colour = plt.cm.coolwarm(skill)
        axis.plot([place + shift for shift in spread_out(len(found))], found, "o", markersize=4, color=colour, alpha=0.7)
        if found:
            axis.hlines(statistics.median(found), place - 0.22, place + 0.22, color="black", linewidth=1.5, zorder=3)
    for (mean, spread), skill in zip(measure.published or (), (0.0, 1.0)):
        if skill in skills:
            axis.errorbar(skills.index(skill) + 0.33, mean, yerr=spread, fmt="D", color="tab:green", markersize=5,
                          capsize=4)
    auc = share_better(values(rows, measure, 0.0), values(rows, measure, 1.0), measure.better)
    note = "" if math.isnan(auc) else f"\nexpert better: {100 * auc:.0f} %"
    axis.set_title(measure.title + note, fontsize=10)
    axis.set_xticks(range(len(skills)))
    axis.set_xticklabels([NAMES.get(skill, f"{skill:g}") for skill in skills])
    axis.set_xlim(-0.6, len(skills) - 0.4)
    axis.grid(True, axis="y", color="0.92")
    axis.set_axisbelow(True)


def legend(figure):
    marks = [plt.Line2D([], [], marker="o", linestyle="", color="0.4", label="one trainee"),
             plt.Line2D([], [], color="black", label="median"),
             plt.Line2D([], [], marker="D", linestyle="", color="tab:green", label="published, mean ± sd")]
    figure.legend(handles=marks, loc="lower center", ncol=3, fontsize=9, frameon=False)


def main(options, table, pictures):
    rows = read_table(table, "novice", "scripts/cohort")
    missing = [measure.column for measure in MEASURES if measure.column not in rows[0]]
    if missing:
        sys.exit(f"{table}: has no column '{missing[0]}'; write it with scripts/cohort")
    skills = sorted({float(row["novice"]) for row in rows})
    print_table(rows, skills)
    figure, axes = plt.subplots(3, 3, figsize=(11, 10))
    set_title(figure, "Virtual trainees by skill", options)
    for axis, measure in zip(axes.flat, MEASURES):
        draw(axis, rows, measure, skills)
    figure.tight_layout(rect=(0, 0.03, 1, 1))
    legend(figure)
    save(figure, pictures, dpi=110)


if __name__ == "__main__":
    main(*parse_arguments(__doc__, ("machine",)))
