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


def step_times(step):
    """{"due", "begin", "solved", "published"} of all steps, from when the first was due [s]."""
    return {k: 1e-9 * (step[k] - step["due"][0]) for k in ("due", "begin", "solved", "published")}


def step_statistics(step, period):
    """How well steps kept their deadlines: a step misses its deadline when its state is published later than one period
    after the step was due."""
    if len(step["due"]) == 0:
        nothing = statistics(numpy.array([]))
        return {"count": 0, "missed": 0, "late begin": nothing, "solve": nothing, "step": nothing}
    due, begin, solved, published = step_times(step).values()
    return {
        "count": len(due),
        "missed": int((published - due > period).sum()),
        "late begin": statistics(begin - due),
        "solve": statistics(solved - begin),
        "step": statistics(published - begin),
    }


def square_wave(times, values, samples):
    """A signal at sample times: the last of the values that came until then; before the first one, its opposite."""
    values = numpy.concatenate(([-values[0]], values))
    return values[numpy.searchsorted(times, samples, side="right")]


def signs(values):
    return numpy.where(values, 1.0, -1.0)


def wave_of_end(measurement, end):
    """(times [ns], values) of the joint as it was seen at the end of the way: on the screen or in the published state."""
    if end == "pixel":
        return measurement.pixel["wall"], signs(measurement.pixel["lit"] == 1)
    setup = measurement.setup
    return measurement.state["wall"], signs(measurement.state["position"] > setup["base"] + 0.5 * setup["jump"])


def cross_correlation(measurement, end):
    """(lags [s], correlation): how well what was seen, shifted back by each lag, agrees with what the hand did.

    The second method of the paper: it pairs no blinks and knows nothing of stages. Its peak is the median delay.
    @param end  "pixel" or "published"
    """
    lags = numpy.arange(int(LONGEST * RATE)) / RATE
    events = measurement.blinks["event"]
    times, values = wave_of_end(measurement, end)
    if len(events) < 2 or len(times) < 2:
        return lags, numpy.zeros(len(lags))
    count = int((events[-1] - events[0] + 2e9) / 1e9 * RATE)
    samples = events[0] - 1e9 + numpy.arange(count + len(lags)) * (1e9 / RATE)
    up = (measurement.blinks["blink"] % 2 == 0) == (measurement.setup["jump"] > 0)
    first, second = square_wave(events, signs(up), samples), square_wave(times, values, samples)
    return lags, numpy.array([float(first[:count] @ second[k : k + count]) / count for k in range(len(lags))])


def peak_lag(lags, correlation):
    """Lag of the highest correlation [s]."""
    return float(lags[int(numpy.argmax(correlation))])


def phase_coverage(waits, period):
    """How far the waits for a clock are from uniform ones: the largest distance between their distribution and the
    uniform one (Kolmogorov), from 0 to 1. About 1.36 / sqrt(n) is exceeded by chance once in twenty times; steps that
    follow a device are far from it, since they wait for no clock."""
    phases = numpy.sort(waits[~numpy.isnan(waits)] / period % 1)
    n = len(phases)
    if n == 0:
        return 1.0
    steps = numpy.arange(n)
    return float(max((phases - steps / n).max(), ((steps + 1) / n - phases).max()))
