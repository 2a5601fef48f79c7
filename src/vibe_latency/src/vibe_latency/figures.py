"""Figures of a measurement: histogram and time series of the latency, its stages, and the cross-correlation."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  after the choice of what draws
import numpy  # noqa: E402

from .stages import STAGES, duration  # noqa: E402
from .summary import cross_correlation, peak_lag, statistics  # noqa: E402

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
