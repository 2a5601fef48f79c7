"""What all figures share: look, axes of time, and pictures as addresses that are part of the page."""

import base64
import io

import matplotlib

matplotlib.use("Agg")

import numpy  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from PIL import Image  # noqa: E402

INK, SOFT, GRID, ACCENT, WARN, HARM = "#1f2933", "#66727f", "#e4e8ec", "#2563a8", "#b45309", "#b42318"
PHASE_COLOURS = {"inspect": "#9db8d6", "mark": "#e9b872", "suture": "#8fbf9f", "pull": "#c49bc9", "done": "#c3c9d0"}
SET_COLOURS = ("#2563a8", "#b45309", "#1d7a5f", "#8e4a9e", "#b42318", "#4b5563", "#0e7490", "#a16207")
POINTS = 1400  # of a curve; more cannot be seen
WIDTH = 9.6  # of the page [inch]
STYLE = {
    "font.size": 9,
    "axes.edgecolor": "#aab4be",
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "text.color": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "legend.frameon": False,
    "text.parse_math": False,  # names are of the user
    "svg.hashsalt": "vibe",  # the same page from the same recording
}


def figure(width, height):
    return Figure(figsize=(width, height))


def styled(draw):
    """Decorator: draws in the look of the page, whatever the user's own matplotlibrc says."""

    def inner(*arguments, **options):
        with matplotlib.rc_context({**matplotlib.rcParamsDefault, **STYLE, "backend": "Agg"}):
            return draw(*arguments, **options)

    return inner


def svg(drawn):
    """A figure as the address of an image."""
    stream = io.BytesIO()
    drawn.savefig(stream, format="svg", dpi=110, metadata={"Date": None, "Creator": None})
    return address("image/svg+xml", stream.getvalue())


def jpeg(pixels):
    """Rows of RGB bytes as the address of an image."""
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, format="jpeg", quality=88, subsampling=0, optimize=True)
    return address("image/jpeg", stream.getvalue())


def address(kind, data):
    return "data:{};base64,{}".format(kind, base64.b64encode(data).decode("ascii"))


def time_unit(duration):
    """(name, seconds) of the unit of the axes of time."""
    return ("min", 60.0) if duration > 300 else ("s", 1.0)


def envelope(times, values):
    """The curve with so few points that a page can hold it: the smallest and the largest value of each piece."""
    if len(times) <= POINTS:
        return times, values
    pieces = numpy.array_split(numpy.arange(len(times)), POINTS // 2)
    known = numpy.nan_to_num(values)
    keep = [sorted((p[numpy.argmin(known[p])], p[numpy.argmax(known[p])])) for p in pieces]
    keep = numpy.unique(numpy.concatenate([[0], numpy.ravel(keep), [len(times) - 1]]))
    return times[keep], values[keep]


def spans_of(recording):
    """(phase, begin, end) in seconds."""
    duration, spans = recording.duration(), []
    for stamp, phase, *_ in recording.states:
        begin = min(max(recording.seconds(stamp), 0.0), duration)
        if not spans or spans[-1][0] != phase:
            if spans:
                spans[-1][2] = begin
            spans.append([phase, begin if spans else 0.0, duration])
    return [tuple(span) for span in spans if span[2] > span[1]]


def shade_phases(axes, recording, unit):
    for phase, begin, end in spans_of(recording):
        axes.axvspan(begin / unit, end / unit, color=PHASE_COLOURS.get(phase, GRID), alpha=0.22, lw=0)
