"""A few sessions in the same axes: the force over time and the path of the tip."""

from dataclasses import dataclass

import numpy

from .curves import FORCE_LIMIT, rest_outline, three_views, title
from .drawing import HARM, POINTS, SET_COLOURS, WIDTH, envelope, figure, styled, svg, time_unit


@dataclass(frozen=True)
class Trace:
    name: str
    force: numpy.ndarray  # rows of time since the first step [s], magnitude [N]
    path: numpy.ndarray  # rows of time, x, y, z [m]
    outline: tuple  # of the undeformed organ, or None


def trace_of(recording, name):
    """As much as can be seen in a picture."""
    force, path = recording.force_curve(), recording.tip_path()
    force = numpy.stack(envelope(force[:, 0], force[:, 1]), axis=1)
    return Trace(name, force, path[:: max(1, len(path) // POINTS)], rest_outline(recording.topology))


@styled
def forces(traces):
    """None where fewer than two sessions have a force."""
    drawn = [(trace, colour) for trace, colour in zip(traces, SET_COLOURS) if len(trace.force) > 2]
    if len(drawn) < 2:
        return None
    name, unit = time_unit(max(trace.force[-1, 0] for trace, _ in drawn))
    picture = figure(WIDTH, 3.1)
    axes = picture.add_axes([0.075, 0.15, 0.9, 0.68])
    for trace, colour in drawn:
        axes.plot(trace.force[:, 0] / unit, trace.force[:, 1], color=colour, lw=0.9, alpha=0.8, label=trace.name)
    axes.axhline(FORCE_LIMIT, color=HARM, lw=1, ls=(0, (5, 3)))
    axes.set_xlabel("time [{}]".format(name))
    axes.set_ylabel("force [N]")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    title(axes, "Force of the tissue on the tool")
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=4, fontsize=8, borderaxespad=0.1, handlelength=1.2)
    return svg(picture)


@styled
def paths(traces):
    """None where fewer than two sessions have a path. The organ behind them is that of the first one that has one."""
    drawn = [(trace, colour) for trace, colour in zip(traces, SET_COLOURS) if len(trace.path) > 2]
    if len(drawn) < 2:
        return None

    def draw(axes, right, up):
        for trace, colour in drawn:
            points = 1e3 * trace.path[:, 1:]
            axes.plot(points[:, right], points[:, up], color=colour, lw=0.9, alpha=0.8, label=trace.name)

    outline = next((trace.outline for trace, _ in drawn if trace.outline), None)
    return three_views(numpy.concatenate([trace.path for trace, _ in drawn]), outline, draw)
