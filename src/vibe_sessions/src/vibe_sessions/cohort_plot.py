"""The learning curve of a cohort: measures against skill, with spread, beside published values."""
import collections
import csv
import os
import statistics

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["text.parse_math"] = False  # names are of the user
import matplotlib.pyplot as plt  # noqa: E402

from vibe_sessions.headless import SessionError  # noqa: E402
from vibe_sessions.whole_file import whole  # noqa: E402

# bands: (mean, standard deviation, who); note: what was measured, where a band would not be the same task. Sources:
# docs/protocols.md, "Skill" and "Expert and novice".
Panel = collections.namedtuple("Panel", "title unit value bands note")
ORGAN_COLOURS = ("#1f5a99", "#c4561a", "#2d7f5e", "#7b4fa3", "#8a6d1d", "#a33b5b")
BAND_COLOURS = {"experienced": "#3a9d6e", "intermediate": "#d8a53a", "novices": "#c8553d"}


def column(name, scale=1.0):
    return lambda row: scale * float(row[name]) if row.get(name) else None


def share(part, total):
    return lambda row: 100 * float(row[part]) / float(row[total]) if row.get(part) and float(row[total] or 0) else None


PANELS = [
    Panel("Pace of suturing", "bites in 5 minutes", column("bites_per_5_min"),
          [(13.1, 5.2, "experienced"), (5.7, 2.8, "intermediate"), (3.0, 0.8, "novices")], ""),
    Panel("Time", "s", column("time"), [], "colonoscope task: 101.5 → 31.5 s"),
    Panel("Path of the tip", "m", column("path_length"), [], "shorter: D'Angelo 2015"),
    Panel("Smoothness", "SPARC", column("spectral_arc_length"), [], "smoother: endovascular tool tip"),
    Panel("Bites through the whole wall", "%", share("bites_full_thickness", "bites"), [], ""),
    Panel("Area of the body", "reduced by, %", column("area_reduction", 100), [], "whole sleeve: 9.4 → 34.6 %"),
]


def read(file):
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
    except OSError as error:
        raise SessionError(f"Cannot read '{file}': {error.strerror}; finish the cohort first.") from None
    if not rows or "novice" not in rows[0]:
        raise SessionError(f"'{file}' has no rows with a skill; finish the cohort first.")
    return rows


def organ_key(row):
    return row.get("scene"), row.get("mesh")


def organ_of(row):
    names = [os.path.splitext(os.path.basename(row.get(key) or ""))[0] for key in ("scene", "mesh")]
    return ", ".join(name for name in names if name)


def organ_names(rows):
    """{key: name}, with names that differ also where files of different folders have the same name."""
    names = {}
    for row in rows:
        name, count = organ_of(row), 1
        while organ_key(row) not in names and name in names.values():
            count += 1
            name = f"{organ_of(row)} ({count})"
        names.setdefault(organ_key(row), name)
    return names


def by_skill(rows, panel):
    """{novice part: sorted values}"""
    found = collections.defaultdict(list)
    for row in rows:
        value = panel.value(row)
        if value is not None:
            found[float(row["novice"])].append(value)
    return {skill: sorted(found[skill]) for skill in sorted(found)}


def quartiles(values):
    if len(values) < 2:
        return values[0], values[0], values[0]
    return tuple(statistics.quantiles(values, n=4, method="inclusive"))


def draw_bands(axis, panel):
    for mean, spread, who in panel.bands:
        axis.axhspan(mean - spread, mean + spread, color=BAND_COLOURS[who], alpha=0.13, linewidth=0)
        axis.axhline(mean, color=BAND_COLOURS[who], linewidth=0.9, linestyle=(0, (5, 3)))
        left = who == "experienced"  # the curve rises from the lower left to the upper right
        axis.text(0.015 if left else 0.985, mean, f"{who} {mean:g} ± {spread:g}", fontsize=7.5, va="bottom",
                  ha="left" if left else "right", color=BAND_COLOURS[who], transform=axis.get_yaxis_transform())


def draw_curve(axis, values, colour, width):
    """Each trainee a dot, the median a line, the middle half an area."""
    skills = list(values)
    low, middle, high = zip(*(quartiles(values[skill]) for skill in skills))
    axis.fill_between(skills, low, high, color=colour, alpha=0.2, linewidth=0)
    for skill in skills:
        count = len(values[skill])
        places = [skill + width * ((k * 0.618) % 1 - 0.5) for k in range(count)]
        axis.plot(places, values[skill], "o", markersize=3, color=colour, alpha=0.45, markeredgewidth=0)
    axis.plot(skills, middle, "-", color=colour, linewidth=2, solid_capstyle="round")
    axis.plot(skills, middle, "o", color="white", markeredgecolor=colour, markeredgewidth=1.6, markersize=5)


def label(axis, panel):
    axis.set_title(panel.title, fontsize=10.5, loc="left", fontweight="bold")
    axis.set_ylabel(panel.unit, fontsize=9)
    if panel.note:
        axis.text(0.98, 1.02, panel.note, transform=axis.transAxes, fontsize=7, color="0.45", ha="right", va="bottom")
    axis.set_xlim(1.06, -0.06)
    axis.set_xticks([1, 0.8, 0.6, 0.4, 0.2, 0])
    axis.set_xticklabels(["novice\n1", "0.8", "0.6", "0.4", "0.2", "expert\n0"], fontsize=8)
    axis.tick_params(axis="y", labelsize=8)
    axis.grid(True, axis="y", color="0.92", linewidth=0.8)
    axis.set_axisbelow(True)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)


def legend(figure, organs):
    one = "0.35" if len(organs) > 1 else ORGAN_COLOURS[0]
    marks = [plt.Line2D([], [], marker="o", color=one, markerfacecolor="white", label="median"),
             plt.Rectangle((0, 0), 1, 1, color=one, alpha=0.2, label="middle half"),
             plt.Line2D([], [], marker="o", markersize=4, alpha=0.45, linestyle="", color=one, label="one trainee"),
             plt.Rectangle((0, 0), 1, 1, color=BAND_COLOURS["experienced"], alpha=0.25, label="published, mean ± sd")]
    if len(organs) > 1:
        marks += [plt.Line2D([], [], color=colour, label=organ) for organ, colour in zip(organs, ORGAN_COLOURS * 9)]
    figure.legend(handles=marks, loc="lower center", ncol=min(len(marks), 6), fontsize=8.5, frameon=False)


def draw(table, picture):
    rows = read(table)
    names = organ_names(rows)
    organs = list(names.values())
    figure, axes = plt.subplots(2, 3, figsize=(11.5, 6.6))
    for axis, panel in zip(axes.flat, PANELS):
        label(axis, panel)
        for organ, colour in zip(organs, ORGAN_COLOURS * 9):
            values = by_skill([row for row in rows if names[organ_key(row)] == organ], panel)
            if values:
                draw_curve(axis, values, colour, 0.04)
        draw_bands(axis, panel)
    skills = {row["novice"] for row in rows}
    figure.suptitle(f"Learning curve of {len(rows)} virtual trainees, {len(skills)} skills" +
                    ("" if len(organs) == 1 else f", {len(organs)} organs"), fontsize=12.5, x=0.012, ha="left")
    figure.tight_layout(rect=(0, 0.045, 1, 1), h_pad=1.6, w_pad=1.4)
    legend(figure, organs)
    try:
        with whole(picture) as part:
            figure.savefig(part, dpi=110)
    except (OSError, ValueError) as error:
        raise SessionError(f"Cannot write '{picture}': {error}.") from None
