"""Numbers of a measurement."""

import numpy

from .stages import STAGES, TOTALS, duration

RATE = 1000.0  # at which the two square waves are compared [Hz]
LONGEST = 0.5  # lag that is looked at [s]


def statistics(values):
    """Mean, sd, p50, p99, min, max [s] and counts of durations; nan counts as lost."""
    known = values[~numpy.isnan(values)]
    lost = int(len(values) - len(known))
    if len(known) == 0:
        return {"count": 0, "lost": lost}
    p50, p99 = numpy.percentile(known, [50, 99])
    return {
        "count": len(known),
        "lost": lost,
        "mean": float(known.mean()),
        "sd": float(known.std(ddof=1)) if len(known) > 1 else 0.0,
        "p50": float(p50),
        "p99": float(p99),
        "min": float(known.min()),
        "max": float(known.max()),
    }


def stage_statistics(traced):
    """{name: statistics} of all stages and totals, in their order."""
    return {name: statistics(duration(traced, begin, end)) for name, begin, end in STAGES + TOTALS}


def step_statistics(step, period):
    """How well steps kept their deadlines: a step misses its deadline when its state is published later than one period
    after the step was due."""
    due, begin, solved, published = (1e-9 * (step[k] - step["due"][0]) for k in ("due", "begin", "solved", "published"))
    return {
        "count": len(due),
        "missed": int((published - due > period).sum()),
        "late begin": statistics(begin - due),
        "solve": statistics(solved - begin),
        "step": statistics(published - begin),
    }


def square_wave(changes, start, count):
    """Samples of a signal that is 1 after every even change and -1 after every odd one and before."""
    samples = start + numpy.arange(count) * (1e9 / RATE)
    return numpy.where(numpy.searchsorted(changes, samples, side="right") % 2 == 1, 1.0, -1.0)


def cross_correlation(traced, begin="event", end="pixel"):
    """(lags [s], correlation): how well the later signal, shifted back by each lag, agrees with the first.

    The second method of the paper: it needs no pairing of blinks, and its peak is the most frequent delay.
    """
    known = (traced[begin] >= 0) & (traced[end] >= 0)
    # a lost blink would turn the rest of the wave upside down: keep whole pairs
    if len(known) % 2 == 1:
        known = known[:-1]
    pairs = known.reshape(-1, 2).all(axis=1).repeat(2)
    first, second = traced[begin][: len(pairs)][pairs], traced[end][: len(pairs)][pairs]
    lags = numpy.arange(int(LONGEST * RATE)) / RATE
    if len(first) < 2:
        return lags, numpy.zeros(len(lags))
    start = float(first[0]) - 1e9
    count = int((float(second[-1]) - start) / 1e9 * RATE) + len(lags)
    a, b = square_wave(first, start, count), square_wave(second, start, count)
    n = count - len(lags)
    return lags, numpy.array([float(a[:n] @ b[k : k + n]) / n for k in range(len(lags))])


def peak_lag(lags, correlation):
    """Lag of the highest correlation [s]."""
    return float(lags[int(numpy.argmax(correlation))])


def phase_coverage(traced, period):
    """Largest distance between the distribution of the blinks' phases in a period and the uniform one (Kolmogorov), from
    0 to 1; about 1.36 / sqrt(n) is exceeded by chance once in twenty times."""
    phases = numpy.sort(traced["event"] % int(1e9 * period)) / (1e9 * period)
    n = len(phases)
    if n == 0:
        return 1.0
    steps = numpy.arange(n)
    return float(max((phases - steps / n).max(), ((steps + 1) / n - phases).max()))
