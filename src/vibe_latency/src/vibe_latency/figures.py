"""Figures of a measurement: histogram and time series of the latency, its stages, and the cross-correlation."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  after the choice of what draws
import numpy  # noqa: E402

from .stages import STAGES, duration  # noqa: E402
from .summary import cross_correlation, peak_lag, statistics, step_times  # noqa: E402

BLUE, GREY, RED = "#1b6ca8", "#5f6b6d", "#c23b22"
LIMIT = 0.1  # of the end-to-end latency in the paper [s]


def milliseconds(values):
    return 1e3 * values[~numpy.isnan(values)]


def last_known(traced):
    """What was measured furthest: ("event", "pixel") with a screen, else ("event", "published")."""
    return "pixel" if (traced["pixel"] >= 0).any() else "published"


def draw_histogram(axes, values):
    numbers = statistics(values)
    axes.hist(milliseconds(values), bins=40, color=BLUE, edgecolor="white", linewidth=0.4)
    axes.axvline(1e3 * numbers["p50"], color="black", linestyle=":", linewidth=1)
    axes.set_title(
        "{} blinks: {:.1f} ± {:.1f} ms, p50 {:.1f}, p99 {:.1f}, max {:.1f}".format(
            numbers["count"], *(1e3 * numbers[k] for k in ("mean", "sd", "p50", "p99", "max"))
        ),
        fontsize=10,
    )
    axes.set_xlabel("latency [ms]")
    axes.set_ylabel("blinks")


def draw_series(axes, traced, values):
    time = 1e-9 * (traced["event"] - traced["event"][0])
    axes.plot(time, 1e3 * values, ".", markersize=2.5, color=BLUE)
    if numpy.nanmax(values) > 0.5 * LIMIT:
        axes.axhline(1e3 * LIMIT, color=RED, linewidth=1)
        axes.annotate("limit of the paper", (0, 1e3 * LIMIT), xytext=(2, 3), textcoords="offset points", color=RED, fontsize=8)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("latency [ms]")


def draw_stages(axes, traced):
    rows = [(name, milliseconds(duration(traced, begin, end))) for name, begin, end in STAGES]
    rows = [(name, values) for name, values in rows if len(values)]
    for row, (name, values) in enumerate(rows):
        low, middle, high = numpy.percentile(values, [1, 50, 99])
        axes.barh(row, high - low, left=low, height=0.5, color=BLUE, alpha=0.35)
        axes.plot([middle], [row], "o", color=BLUE, markersize=4)
        axes.annotate("{:.2f}".format(middle), (high, row), xytext=(5, 0), textcoords="offset points", va="center", fontsize=8)
    axes.set_yticks(range(len(rows)), [name for name, _ in rows])
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.set_xlabel("time per stage [ms]: median, 1st to 99th percentile")


def draw_correlation(axes, measurement, end):
    lags, correlation = cross_correlation(measurement, end)
    lag = peak_lag(lags, correlation)
    axes.plot(1e3 * lags, correlation, color=BLUE)
    axes.axvline(1e3 * lag, color="black", linestyle=":", linewidth=1)
    axes.annotate("{:.0f} ms".format(1e3 * lag), (1e3 * lag, correlation.max()), xytext=(6, -4), textcoords="offset points", fontsize=9)
    last = min(0.5, max(0.1, 3 * lag))
    axes.set_xlim(0, 1e3 * last)
    axes.set_ylim(correlation[lags <= last].min() - 0.05, 1.05)
    axes.set_xlabel("lag [ms]")
    axes.set_ylabel("cross-correlation")


def draw(measurement, traced, path):
    """One page with all of them; at least one blink must have been seen in a published state."""
    end = last_known(traced)
    values = duration(traced, "event", end)
    figure, axes = plt.subplots(2, 2, figsize=(11, 7.5), constrained_layout=True)
    draw_histogram(axes[0, 0], values)
    draw_series(axes[0, 1], traced, values)
    draw_stages(axes[1, 0], traced)
    draw_correlation(axes[1, 1], measurement, end)
    for each in axes.flat:
        each.grid(alpha=0.3)
    figure.suptitle(measurement.setup["title"], fontsize=12)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def draw_step_series(axes, times, values, period, name):
    axes.plot(times, 1e3 * values, ".", markersize=1, color=BLUE, rasterized=True)
    axes.axhline(1e3 * period, color=RED, linewidth=1)
    axes.annotate("deadline", (0, 1e3 * period), xytext=(2, 3), textcoords="offset points", color=RED, fontsize=8)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(name + " [ms]")


def draw_exceeded(axes, rows, period):
    """Share of the steps that took longer than a time, on logarithmic axes: what is rare is seen too."""
    for name, values, colour in rows:
        ordered = numpy.sort(numpy.maximum(values, 1e-7))
        axes.step(1e3 * ordered, 1 - numpy.arange(len(ordered)) / len(ordered), color=colour, label=name, where="post")
    axes.axvline(1e3 * period, color=RED, linewidth=1)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(left=1e-3)
    axes.set_xlabel("time [ms]; red: period of the steps")
    axes.set_ylabel("share of steps beyond it")
    axes.legend(fontsize=8, loc="lower left")


def draw_steps(measurement, numbers, path):
    """One page about deadlines: when states came after their steps were due."""
    period = measurement.setup["periods"]["step"]
    times = step_times(measurement.step)
    steps, done = times["published"] - times["begin"], times["published"] - times["due"]
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    draw_step_series(axes[0], times["due"], done, period, "due to published")
    rows = (("step begins late", times["begin"] - times["due"], GREY), ("step takes", steps, BLUE), ("due to published", done, "black"))
    draw_exceeded(axes[1], rows, period)
    for each in axes.flat:
        each.grid(alpha=0.3)
    figure.suptitle(
        "{}: {} steps, {} missed, p50 {:.2f} ms, p99 {:.2f} ms".format(
            measurement.setup["title"], numbers["count"], numbers["missed"], *(1e3 * numbers["step"][k] for k in ("p50", "p99"))
        ),
        fontsize=11,
    )
    figure.savefig(path, dpi=100)
    plt.close(figure)


def draw_motion(measurement, motion, numbers, path):
    """Published positions beside the true ones, and how well they fit for each age."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    first = motion.times[len(motion.times) // 2]
    shown = (motion.times >= first) & (motion.times <= first + 1.4)
    fine = numpy.linspace(first, first + 1.4, 700)
    axes[0].plot(fine - first, 1e3 * numpy.interp(fine, motion.truth_times, motion.truth), color=GREY, label="the hand")
    axes[0].plot(motion.times[shown] - first, 1e3 * motion.positions[shown], ".", color=BLUE, label="in the published state")
    axes[0].set_xlabel("time [s]")
    axes[0].set_ylabel("position [mm]")
    axes[0].legend(fontsize=8)
    ages, errors = motion.errors()
    axes[1].plot(1e3 * ages, 1e3 * errors, color=BLUE)
    axes[1].axvline(1e3 * numbers["age"], color="black", linestyle=":", linewidth=1)
    axes[1].set_xlim(-20, 60)
    axes[1].set_xlabel("age of the position [ms]")
    axes[1].set_ylabel("error (rms) [mm]")
    for each in axes.flat:
        each.grid(alpha=0.3)
    figure.suptitle(
        "{}: age {:.1f} ms, error {:.3f} mm at once, {:.3f} mm with the age".format(
            measurement.setup["title"], 1e3 * numbers["age"], 1e3 * numbers["error at once"], 1e3 * numbers["error at age"]
        ),
        fontsize=11,
    )
    figure.savefig(path, dpi=100)
    plt.close(figure)
