"""The main measures of many sessions: every session a point, with median and quartiles by group."""

import numpy

from .drawing import INK, SET_COLOURS, WIDTH, figure, styled, svg
from .tables import MAIN_MEASURES, values_of

COLUMNS = 3
MOST_GROUPS = 8  # side by side


@styled
def distributions(rows):
    """None if there is nothing to compare."""
    if len(rows) < 2:
        return None
    groups = sorted({row["group"] for row in rows})[:MOST_GROUPS]
    measures = [m for m in MAIN_MEASURES if any(row.get(m[1]) is not None for row in rows)]
    if not measures:
        return None
    lines = -(-len(measures) // COLUMNS)
    drawn = figure(1.25 * WIDTH, 2.0 * lines + 0.1)
    for k, (label, key, scale, _) in enumerate(measures):
        axes = drawn.add_subplot(lines, COLUMNS, k + 1)
        axes.use_sticky_edges = False  # a point at the edge is whole
        for place, group in enumerate(groups):
            draw_group(axes, place, numpy.array(values_of(rows, group, key, scale)))
        axes.set_yticks(range(len(groups)), [shortened(group) for group in groups], color=INK)
        axes.set_ylim(len(groups) - 0.4, -0.6)
        axes.grid(axis="y", visible=False)
        axes.margins(x=0.08)
        axes.locator_params(axis="x", nbins=5)
        axes.set_title(label, loc="left", fontsize=9.5, fontweight="bold")
    drawn.tight_layout(h_pad=1.2, w_pad=1.6)
    return svg(drawn)


def shortened(name):
    return name if len(name) <= 18 else name[:17] + "…"


def draw_group(axes, place, values):
    if not len(values):
        return
    colour = SET_COLOURS[place % len(SET_COLOURS)]
    low, middle, high = numpy.percentile(values, [25, 50, 75])
    axes.barh(place, high - low, left=low, height=0.5, color=colour, alpha=0.18, lw=0)
    axes.plot([middle, middle], [place - 0.28, place + 0.28], color=colour, lw=2.2, solid_capstyle="butt")
    scatter = numpy.random.default_rng(1).uniform(-0.22, 0.22, len(values))
    axes.plot(values, place + scatter, "o", ms=3.2, color=colour, alpha=0.65, mew=0)
