#!/usr/bin/env python3
"""Draws the figures of docs/computation.md from its equations: figures.py FOLDER writes computation_*.png there."""

import argparse
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402

E, NU, B = 110e3, 0.45, 2.0  # of the default scene [Pa], ratio, ratio
MU, LAMBDA = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))


# --- laws: energy per volume W(I, J), equation 3

def general(i, j, law):
    k = i - 3 - 2 * math.log(j)
    if law == "neo_hookean":
        return MU / 2 * k + LAMBDA / 2 * math.log(j) ** 2
    if law == "yeoh":
        return MU / 2 * (k + B / 2 * k**2 + B**2 / 6 * k**3) + LAMBDA / 2 * math.log(j) ** 2
    if law == "fung":
        return MU / 2 * math.expm1(B * k) / B + LAMBDA / 2 * math.log(j) ** 2
    if law == "gent":
        return -MU / 2 / B * math.log(1 - B * k) + LAMBDA / 2 * math.log(j) ** 2 if B * k < 0.95 else math.nan
    if law == "macklin_mueller":
        bulk = LAMBDA + MU
        return MU / 2 * (i - 3) + bulk / 2 * (j - 1 - MU / bulk) ** 2 - MU**2 / (2 * bulk)
    shear, bulk = 4 / 3 * MU, LAMBDA + 5 / 6 * MU
    rest = 0.75 * shear / bulk
    return shear / 2 * (i - 3) + bulk / 2 * (j - 1 - rest) ** 2 - shear / 2 * math.log((i + 1) / 4) - shear**2 * 0.5625 / (2 * bulk)


def least(function, low, high):
    """Minimum of a convex function of one number by the golden section."""
    ratio = (math.sqrt(5) - 1) / 2
    for _ in range(70):
        a, b = high - ratio * (high - low), low + ratio * (high - low)
        low, high = (low, b) if function(a) < function(b) else (a, high)
    return function((low + high) / 2)


def equibiaxial(stretch, law):
    """Energy of a wall that is stretched by as much in both directions, with no stress across it."""
    return least(lambda across: general(2 * stretch**2 + across**2, stretch**2 * across, law), 0.25, 1.6)


def draw_laws(axes):
    stretches = numpy.linspace(1, 1.4, 60)
    for law in ("neo_hookean", "stable_neo_hookean", "macklin_mueller", "yeoh", "fung", "gent"):
        energy = numpy.array([equibiaxial(s, law) for s in stretches])
        stress = numpy.gradient(energy, stretches, edge_order=2) / 2 / 1e3
        axes.plot(stretches, stress, label=law, linewidth=2.5 if law == "yeoh" else 1.2)
    axes.set(xlabel="stretch in both directions", ylabel="nominal stress [kPa]", ylim=(0, 150))
    axes.legend(fontsize=8)


# --- self-contact, equation 21

def squeeze(s, onset=0.25, straight=0.2):
    if s >= 1 + onset:
        return 0.0, 0.0
    kept = max(s, straight)
    strain = 1 - kept
    full = strain > onset
    h = strain if full else (strain + onset) ** 2 / (4 * onset)
    slope = (1 if full else (strain + onset) / (2 * onset)) * math.log1p(-h) / (1 - h)
    return 0.5 * math.log1p(-h) ** 2 + slope * (s - kept), slope


def draw_contact(axes):
    s = numpy.linspace(0.05, 1.4, 300)
    axes.plot(s, [squeeze(x)[0] for x in s], label="energy $e(s)$")
    axes.plot(s, [-squeeze(x)[1] for x in s], label="force $-e'(s)$")
    axes.axvspan(0.75, 1.25, alpha=0.15, label="contact sets in")
    axes.set(xlabel="distance over thickness $s = d/t$", ylim=(0, 9))
    axes.legend(fontsize=8)


# --- capstan, equation 17

def draw_capstan(axes):
    angle = numpy.linspace(0, 180, 100)
    for friction in (0.05, 0.15, 0.3):
        axes.plot(angle, numpy.exp(friction * numpy.radians(angle)), label="friction {}".format(friction))
    axes.set(xlabel="turn of the thread at a bite [deg]", ylabel="largest ratio of tensions")
    axes.legend(fontsize=8)


# --- numerical damping of the time scheme, equations 7 and 8, of a vibration without other damping

def damping_ratio(frequency, radius, h=1 / 60):
    am, af = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    gamma, beta = 0.5 - am + af, 0.25 * (1 - am + af) ** 2
    omega2 = (2 * math.pi * frequency) ** 2
    left = (1 - am) + (1 - af) * omega2 * beta * h * h
    new = numpy.array([-omega2, -omega2 * (1 - af) * h, -am - omega2 * (1 - af) * h * h * (0.5 - beta)]) / left
    matrix = numpy.array([[1, h, h * h * (0.5 - beta)], [0, 1, h * (1 - gamma)], [0, 0, 0]]) + numpy.outer(
        [beta * h * h, gamma * h, 1], new)
    values = [value for value in numpy.linalg.eigvals(matrix) if abs(value.imag) > 1e-9]
    value = max(values, key=abs) if values else math.nan
    return -math.log(abs(value)) / abs(numpy.angle(value))


def draw_damping(axes):
    frequencies = numpy.linspace(0.5, 25, 100)
    for radius in (0, 0.2, 0.5):
        axes.plot(frequencies, [damping_ratio(f, radius) for f in frequencies], label="time scheme, radius {}".format(radius))
    omega = 2 * numpy.pi * frequencies
    axes.plot(frequencies, 30 / (2 * omega) + 15e-6 * omega / 2, "k--", label="tissue (30 1/s, 15 µs)")
    axes.set(xlabel="frequency [Hz]", ylabel="damping ratio", ylim=(0, 0.6))
    axes.legend(fontsize=8)


# --- heat, equation 29

def draw_dose(axes):
    time = numpy.linspace(0, 60, 600)
    rate = 1 / 40 + 1 / 120
    for power, until in ((40, 2), (40, 15), (20, 40)):
        heat = [power / rate * (1 - math.exp(-rate * min(t, until))) * math.exp(-max(0, t - until) / 40) for t in time]
        axes.plot(time, heat, label="{} W for {} s".format(power, until))
    for name, energy in (("mark", 25), ("burn scar", 425), ("deep", 800)):
        level = 40 / rate * -math.expm1(-rate * energy / 40)
        axes.axhline(level, color="grey", linewidth=0.8)
        axes.text(60, level, name, ha="right", va="bottom", fontsize=8)
    axes.set(xlabel="time [s]", ylabel="heat of a spot $h$ [J]")
    axes.legend(fontsize=8, loc="upper left")


# --- technique, equations 25 and 26: what the printed rule asks of the legs of a U

def draw_technique(axes):
    def leg(angle):
        return numpy.array([math.cos(angle), math.sin(angle)])

    bar = numpy.array([1.0, 0.0])
    angles = numpy.radians(numpy.linspace(120, 240, 121))  # of a leg with bar . leg <= -0.5
    ends = numpy.array([[leg(a) @ leg(b) for a in angles] for b in angles])
    assert min(bar @ leg(a) for a in angles) > -1.01 and ends.min() > -0.51
    picture = axes.contourf(numpy.degrees(angles), numpy.degrees(angles), ends, levels=numpy.arange(-1, 1.01, 0.25), cmap="viridis")
    plt.colorbar(picture, ax=axes, label="first vector · last vector")
    axes.set(xlabel="first leg against the bar [deg]", ylabel="last leg against the bar [deg]",
             title="least value {:.2f}; a U needs < -0.7".format(ends.min()))
    axes.title.set_fontsize(9)

# --- the order of a step: boxes in a grid of columns and rows, and arrows between them

STEP_BOXES = {  # name: (column, row, width, text, number of the way or None)
    "gather": (0, 0, 1, "blocks add loads;\ncontacts where the\ntool is expected", None),
    "asleep": (0, 1, 1, "1 asleep\n2 recovery", "way"),
    "guess": (1, 0, 1, "start: along the\nvelocities, or here", None),
    "drop": (1, 1, 1, "3 guess tangled\n4 guess misled", "way"),
    "aim": (2, 0, 1, "first direction,\nrows eliminated", None),
    "exchange": (2, 1, 1, "5 contacts exchanged", "way"),
    "early": (2, 2, 1, "6 tool reaimed early", "way"),
    "iterate": (3, 0, 1, "iterations\n(L-BFGS, line search)", None),
    "search": (3, 1, 1, "7 pairs dropped\n8 search restarted\n9 constraints met\n10 last move unseen", "way"),
    "arrived": (3, 2, 1, "11 not arrived\n12 backward Euler", "way"),
    "separate": (4, 0, 1, "walls and tool\non their sides", None),
    "again": (4, 1, 1, "13 tool reaimed\n14 tool limited", "way"),
    "stop": (4, 2, 1, "15 wall stopped", "way"),
    "store": (5, 0, 1, "forces, works,\nimpedance", None),
    "finite": (5, 1, 1, "16 not finite", "way"),
}
STEP_ARROWS = (("gather", "guess"), ("guess", "aim"), ("aim", "iterate"), ("iterate", "separate"), ("separate", "store"),
               ("gather", "asleep"), ("guess", "drop"), ("aim", "exchange"), ("exchange", "early"), ("iterate", "search"),
               ("search", "arrived"), ("separate", "again"), ("again", "stop"), ("store", "finite"))


def draw_ways(axes):
    axes.set(xlim=(-0.55, 5.55), ylim=(-3.05, 0.55))
    axes.axis("off")
    for first, second in STEP_ARROWS:
        (x, y), (u, v) = (STEP_BOXES[name][:2] for name in (first, second))
        start, end = ((x + 0.43, -y), (u - 0.43, -v)) if y == v else ((x, -y - 0.3), (u, -v + 0.3))
        axes.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": "0.4"})
    for column, row, _, text, kind in STEP_BOXES.values():
        axes.text(column, -row, text, ha="center", va="center", fontsize=7.5,
                  bbox={"boxstyle": "round,pad=0.35", "fc": "#fdd9b0" if kind else "0.92", "ec": "0.4"})
    for column, low in ((2, -2.3), (4.3, -1.3)):
        axes.plot([column, column], [low, -2.75], color="tab:red", linewidth=1)
    axes.plot([4.3, -0.5, -0.5], [-2.75, -2.75, 0], color="tab:red", linewidth=1)
    axes.annotate("", (-0.4, 0), (-0.51, 0), arrowprops={"arrowstyle": "->", "color": "tab:red"})
    axes.text(0.7, -2.75, "another attempt, from the state before the step", fontsize=8, va="center", ha="center",
              color="tab:red", bbox={"fc": "white", "ec": "none"})


FIGURES = {"laws": draw_laws, "damping": draw_damping, "contact": draw_contact, "capstan": draw_capstan, "dose": draw_dose,
           "technique": draw_technique, "ways": draw_ways}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    for name, draw in FIGURES.items():
        size = (10.5, 4.2) if name == "ways" else (4.8, 3.2)
        figure, axes = plt.subplots(figsize=size, layout="constrained")
        draw(axes)
        figure.savefig(folder / "computation_{}.png".format(name), dpi=110, metadata={"Software": None})
        plt.close(figure)


if __name__ == "__main__":
    main()
