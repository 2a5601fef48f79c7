"""The phases of a session, and below them one row per kind of event."""

from . import events
from .drawing import ACCENT, HARM, INK, PHASE_COLOURS, SOFT, WARN, WIDTH, figure, spans_of, styled, svg, time_unit

MARKERS = {
    events.NOTE: ("o", SOFT, 16),
    events.DONE: ("o", ACCENT, 26),
    events.CAUTION: ("^", WARN, 34),
    events.HARM: ("X", HARM, 44),
}
ROW = 0.235  # [inch]
# in the order of the procedure
ORDER = (6, 10, 11, 12, 0, 1, 13, 2, 3, 30, 14, 15, 16, 17, 31, 18, 19, 20, 21, 23, 22, 24, 25, 26, 27, 28, 9, 7, 8)


@styled
def timeline(recording):
    name, unit = time_unit(recording.duration())
    rows = rows_of(recording)
    height = 0.78 + ROW * (len(rows) + 1.75)
    drawn = figure(WIDTH, height)
    axes = drawn.add_axes([0.165, 0.5 / height, 0.815, 1 - 0.78 / height])
    draw_phases(axes, recording, unit)
    for k, (kind, times) in enumerate(rows):
        marker, colour, size = MARKERS[events.severity_of(kind)]
        axes.scatter([t / unit for t in times], [k + 1] * len(times), s=size, marker=marker, color=colour, lw=0, zorder=3)
    axes.set_yticks([k + 1 for k in range(len(rows))])
    axes.set_yticklabels(["{}  ({})".format(events.words_of(kind), len(times)) for kind, times in rows], color=INK)
    axes.set_ylim(len(rows) + 0.6, -1.15)
    axes.set_xlim(0, recording.duration() / unit)
    axes.set_xlabel("time [{}]".format(name))
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    return svg(drawn)


def rows_of(recording):
    times = {}
    for stamp, kind, *_ in recording.events:
        if kind not in events.UNDRAWN:
            times.setdefault(kind, []).append(recording.seconds(stamp))
    known = [kind for kind in ORDER if kind in times]
    return [(kind, times[kind]) for kind in known + sorted(set(times) - set(known))]


def draw_phases(axes, recording, unit):
    """A bar; a name where it fits, and a legend for the rest."""
    total, named, unnamed = recording.duration(), set(), {}
    for phase, begin, end in spans_of(recording):
        colour = PHASE_COLOURS.get(phase, "#dddddd")
        bar = axes.barh(-0.35, (end - begin) / unit, left=begin / unit, height=0.95, color=colour, lw=0, zorder=2)
        if (end - begin) / total > 0.013 * len(phase):
            named.add(phase)
            axes.text(
                0.5 * (begin + end) / unit, -0.35, phase, ha="center", va="center", fontsize=8.5, color=INK, zorder=4
            )
        else:
            unnamed.setdefault(phase, bar)
    unnamed = {phase: bar for phase, bar in unnamed.items() if phase not in named}
    if unnamed:
        axes.legend(
            unnamed.values(), unnamed.keys(), loc="lower right", bbox_to_anchor=(1, 1), ncol=5, fontsize=8,
            handlelength=1, handleheight=0.9, borderaxespad=0.2,
        )  # fmt: skip
