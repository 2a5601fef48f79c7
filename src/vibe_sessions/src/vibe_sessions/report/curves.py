"""Curves over time: force, gas, threads, speed of the tip, times of the solver; and the path of the tip."""

import numpy

from .drawing import (
    ACCENT, HARM, INK, PHASE_COLOURS, SET_COLOURS, SOFT, WARN, WIDTH, envelope, figure, shade_phases, spans_of, styled,
    svg, time_unit,
)  # fmt: skip

MMHG = 133.322387415
FORCE_LIMIT = 5  # [N]
SPEED_PERIOD = 0.095  # over which a speed is taken: recordings have the tip at 10 Hz or more [s]
LONGEST_GAP = 0.5  # between poses; the speed between two that are farther apart is not known [s]


@styled
def curves(recording):
    """None if there is nothing to draw."""
    parts = [
        (draw_force, len(recording.force) > 2),
        (draw_gas, len(recording.states) > 1),
        (draw_tensions, any(row for _, row in recording.tensions)),
        (draw_speed, len(recording.tip) > 8),
    ]
    drawers = [draw for draw, has_data in parts if has_data]
    if not drawers:
        return None
    name, unit = time_unit(recording.duration())
    height = 1.72 * len(drawers) + 0.35
    drawn = figure(WIDTH, height)
    grid = drawn.subplots(len(drawers), 1, sharex=True, squeeze=False)[:, 0]
    drawn.subplots_adjust(left=0.075, right=0.925, top=1 - 0.3 / height, bottom=0.5 / height, hspace=0.36)
    for axes, draw in zip(grid, drawers):
        shade_phases(axes, recording, unit)
        draw(axes, recording, unit)
        axes.set_xlim(0, recording.duration() / unit)
    grid[-1].set_xlabel("time [{}]".format(name))
    drawn.align_ylabels(grid)
    return svg(drawn)


def title(axes, text):
    axes.set_title(text, loc="left", fontsize=9.5, color=INK, fontweight="bold", pad=5)


def draw_force(axes, recording, unit):
    curve = recording.force_curve()
    times, values = envelope(curve[:, 0], curve[:, 1])
    axes.plot(times / unit, values, color=ACCENT, lw=0.9)
    top = max(1.25 * FORCE_LIMIT, 1.08 * float(values.max()))
    axes.axhline(FORCE_LIMIT, color=HARM, lw=1, ls=(0, (5, 3)))
    axes.text(
        0.995, FORCE_LIMIT, "5 N", color=HARM, ha="right", va="bottom", fontsize=8, transform=axes.get_yaxis_transform()
    )
    axes.set_ylim(0, top)
    axes.set_ylabel("force [N]")
    title(axes, "Force of the tissue on the tool")


def draw_gas(axes, recording, unit):
    times = numpy.array([recording.seconds(state[0]) for state in recording.states])
    pressure = numpy.array([state[2] for state in recording.states]) / MMHG
    volume = 1e6 * numpy.array([state[3] for state in recording.states])
    axes.plot(*scaled(envelope(times, pressure), unit), color=ACCENT, lw=1.3)
    axes.set_ylabel("pressure [mmHg]", color=ACCENT)
    axes.set_ylim(bottom=min(0, 1.1 * float(pressure.min())), top=max(1, 1.15 * float(pressure.max())))
    other = axes.twinx()
    other.plot(*scaled(envelope(times, volume), unit), color=WARN, lw=1.3)
    other.set_ylabel("volume [mL]", color=WARN)
    other.set_ylim(bottom=0, top=1.5 * max(1, float(volume.max())))  # so that the two lines lie apart
    other.grid(False)
    title(axes, "Gas in the lumen")


def scaled(curve, unit):
    return curve[0] / unit, curve[1]


def draw_tensions(axes, recording, unit):
    times = numpy.array([recording.seconds(stamp) for stamp, _ in recording.tensions]) / unit
    count = max(len(row) for _, row in recording.tensions)
    for k in range(count):
        values = [row[k] if k < len(row) else numpy.nan for _, row in recording.tensions]
        axes.plot(times, values, color=SET_COLOURS[k % len(SET_COLOURS)], lw=1.2, label="set {}".format(k + 1))
    axes.set_ylabel("tension [N]")
    axes.set_ylim(0, max(1, 1.12 * max(max(row, default=0) for _, row in recording.tensions)))
    if count > 1:
        axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=min(count, 8), fontsize=8, borderaxespad=0.1,
                    handlelength=1.2, columnspacing=1.2)  # fmt: skip
    title(axes, "Largest tension of each thread")


def speeds_of(path, resets=()):
    """Times and speeds, over periods that any recording resolves; NaN where poses are missing, and where the scope jumps."""
    times = path[:, 0]
    stride = max(1, round(SPEED_PERIOD / max(float(numpy.median(numpy.diff(times))), 1e-6)))
    coarse = path[::stride]
    steps = numpy.diff(coarse[:, 0])
    lengths = numpy.linalg.norm(numpy.diff(coarse[:, 1:], axis=0), axis=1)
    for reset in resets:
        lengths[(coarse[:-1, 0] <= reset + 1e-6) & (coarse[1:, 0] >= reset - 1e-6)] = numpy.nan
    good = steps > 0
    speeds = lengths[good] / steps[good]
    return coarse[1:, 0][good], numpy.where(steps[good] > LONGEST_GAP, numpy.nan, speeds)


def draw_speed(axes, recording, unit):
    times, speeds = speeds_of(recording.tip_path(), recording.resets())
    times, speeds = envelope(times, speeds)
    if numpy.isnan(speeds).all():
        return
    axes.plot(times / unit, 1e3 * speeds, color=ACCENT, lw=0.9)
    axes.set_ylabel("speed [mm/s]")
    axes.set_ylim(0, 1.1e3 * max(1e-3, float(numpy.nanmax(speeds))))
    title(axes, "Speed of the tip")


# views of the path: title, axes of the world to the right and up, and their signs
VIEWS = (("from the front", 1, 2, 1), ("from the left", 0, 2, -1), ("from below", 1, 0, 1))


@styled
def trajectory(recording):
    """Three views of the path of the tip in the outline of the stomach, to one scale."""
    path = recording.tip_path()
    if len(path) < 3:
        return None
    return three_views(path, rest_outline(recording.topology), lambda *view: draw_phases(recording, path, *view))


def three_views(path, outline, draw):
    """Pictures of what draw(axes, right, up) draws of a path, given the axes of the world to the right and up."""
    ranges = [axis_range(path, outline, axis) for axis in range(3)]
    widths = [ranges[right][1] - ranges[right][0] for _, right, _, _ in VIEWS]
    tallest = max(ranges[up][1] - ranges[up][0] for _, _, up, _ in VIEWS)
    scale = min((WIDTH - 2.3) / sum(widths), 3.9 / tallest)  # inches per millimetre
    height = scale * tallest + 1.0
    drawn = figure(WIDTH, height)
    gap = (WIDTH - scale * sum(widths) - 0.85) / 2
    left = 0.65
    for (name, right, up, sign), width in zip(VIEWS, widths):
        tall = scale * (ranges[up][1] - ranges[up][0])
        axes = drawn.add_axes([left / WIDTH, (height - 0.35 - tall) / height, scale * width / WIDTH, tall / height])
        draw_outline(axes, outline, right, up)
        draw(axes, right, up)
        axes.set_xlim(*(ranges[right] if sign > 0 else ranges[right][::-1]))
        axes.set_ylim(*ranges[up])
        axes.set_xlabel("{} [mm]".format("xyz"[right]))
        axes.set_ylabel("{} [mm]".format("xyz"[up]), labelpad=1)
        axes.locator_params(nbins=5)
        title(axes, name.capitalize())
        left += scale * width + gap
    legend = drawn.legend(*axes.get_legend_handles_labels(), loc="lower right", ncol=3, fontsize=8.5, handlelength=1.4)
    for line in legend.get_lines():
        line.set_linewidth(2.5)
    return svg(drawn)


def rest_outline(topology):
    """Positions of the undeformed wall and its triangles, or None."""
    if topology is None or len(topology.rest_positions) == 0:
        return None
    return 1e3 * numpy.array(topology.rest_positions).reshape(-1, 3), numpy.array(topology.triangles).reshape(-1, 3)


def axis_range(path, outline, axis):
    values = [1e3 * path[:, 1 + axis]] + ([outline[0][:, axis]] if outline else [])
    low, high = min(map(numpy.min, values)), max(map(numpy.max, values))
    margin = 0.04 * max(high - low, 20)
    return low - margin, high + margin


def draw_outline(axes, outline, right, up):
    from matplotlib.collections import PolyCollection

    axes.grid(False)
    if outline:
        points = outline[0][:, [right, up]]
        axes.add_collection(
            PolyCollection(points[outline[1]], facecolor="#f3e3df", edgecolor="#f3e3df", lw=0.3, rasterized=True)
        )


def draw_phases(recording, path, axes, right, up):
    named = set()
    for phase, begin, end in spans_of(recording) or [("", 0, recording.duration())]:
        inside = path[(path[:, 0] >= begin) & (path[:, 0] <= end + 0.11)]
        stride = max(1, len(inside) // 3000)
        colour = darker(PHASE_COLOURS.get(phase, SOFT))
        label = "" if phase in named else phase
        named.add(phase)
        axes.plot(1e3 * inside[::stride, 1 + right], 1e3 * inside[::stride, 1 + up], color=colour, lw=0.9, label=label)
    for index, marker, label in ((0, "o", "begin"), (-1, "s", "end")):
        axes.plot(1e3 * path[index, 1 + right], 1e3 * path[index, 1 + up], marker, color=INK, ms=3.5, label=label)


def darker(colour):
    return "#" + "".join("{:02x}".format(int(0.72 * int(colour[k : k + 2], 16))) for k in (1, 3, 5))


@styled
def solver_curves(recording):
    """Times of the steps and the real-time factor, once per second of wall time."""
    windows = [each for each in recording.windows if any(s.name == "solver" and s.max > 0 for s in each.stages)]
    if len(windows) < 3:
        return None
    name, unit = time_unit(recording.duration())
    times = numpy.array([recording.seconds(each.header.stamp.to_nsec()) for each in windows]) / unit
    stages = [next(s for s in each.stages if s.name == "solver") for each in windows]
    drawn = figure(WIDTH, 2.1)
    axes = drawn.add_axes([0.075, 0.22, 0.85, 0.64])
    for field, colour, label in (("max", "#c9d4df", "max"), ("p99", WARN, "p99"), ("p50", ACCENT, "p50")):
        axes.plot(times, [getattr(stage, field) for stage in stages], color=colour, lw=1.2, label=label)
    axes.axhline(1e3 / 60, color=HARM, lw=1, ls=(0, (5, 3)))
    axes.set_yscale("log")
    axes.set_ylabel("CPU time of a step [ms]")
    axes.set_xlabel("time [{}]".format(name))
    axes.set_xlim(0, recording.duration() / unit)
    axes.yaxis.set_major_formatter(lambda value, _: "{:g}".format(value))
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=3, fontsize=8, borderaxespad=0.1)
    title(axes, "Time of the solver")
    return svg(drawn)
