"""When each blink passed each stage, from the tables of a measurement.

A blink is a jump of one joint, up or down in turn. It is followed from the sensor to the screen: the first sample with
it, the driver's message about it, the step that used it, the state after that step, the first frame of rviz with
this state, and the first reading of the screen with the lamp in its new colour. Later stages are joined by the stamp of
the state, not by the order of arrival.
"""

import numpy

# What happens between two of the times below, in this order; each begins where the one before ended.
STAGES = (
    ("wait for a sample", "event", "report"),
    ("sample to driver", "report", "driver"),
    ("driver to step", "driver", "begin"),
    ("solve", "begin", "solved"),
    ("publish", "solved", "published"),
    ("wait for a frame", "published", "received"),
    ("render", "received", "rendered"),
    ("to the screen", "rendered", "pixel"),
)
TOTALS = (
    ("sample to published state", "report", "published"),
    ("event to published state", "event", "published"),
    ("published state to pixel", "published", "pixel"),
    ("event to pixel", "event", "pixel"),
)
TIMES = ("event", "report", "driver", "begin", "solved", "published", "received", "rendered", "pixel")
LOST = -1


def first_from(times, start, chosen):
    """Index of the first chosen row at or after a time; None without one. `times` ascend."""
    for i in range(int(numpy.searchsorted(times, start)), len(times)):
        if chosen(i):
            return i
    return None


class Tracer:
    """Follows blinks through the tables of one measurement."""

    def __init__(self, measurement):
        self.m = measurement
        setup = measurement.setup
        self.threshold = setup["base"] + 0.5 * setup["jump"]
        self.rises = setup["jump"] > 0
        self.by_step = {int(step): i for i, step in enumerate(measurement.step["step"])}

    def is_new(self, position, blink):
        """Whether a position is that after the blink."""
        return (position > self.threshold) == ((blink % 2 == 0) == self.rises)

    def trace(self, index):
        """{time: ns} of one blink, with LOST for stages where it was not seen."""
        m = self.m
        blink, event = int(m.blinks["blink"][index]), int(m.blinks["event"][index])
        times = dict.fromkeys(TIMES, LOST)
        times.update(event=event, report=int(m.blinks["report"][index]))
        device = first_from(m.device["wall"], event, lambda i: self.is_new(m.device["position"][i], blink))
        if device is not None:
            times["driver"] = int(m.device["stamp"][device])
        used = first_from(m.input["wall"], event, lambda i: self.is_new(m.input["position"][i], blink))
        step = self.by_step.get(int(m.input["step"][used])) if used is not None else None
        if step is None:
            return times
        for name in ("begin", "solved", "published"):
            times[name] = int(m.step[name][step])
        self.trace_display(times, blink, int(m.step["stamp"][step]))
        return times

    def trace_display(self, times, blink, stamp):
        m = self.m
        lit = (blink % 2 == 0) == self.rises
        shown = first_from(m.display["stamp"], stamp, lambda i: bool(m.display["lit"][i]) == lit)
        if shown is None:
            return
        times.update(received=int(m.display["received"][shown]), rendered=int(m.display["rendered"][shown]))
        pixel = first_from(m.pixel["wall"], times["received"], lambda i: bool(m.pixel["lit"][i]) == lit)
        if pixel is not None:
            times["pixel"] = int(m.pixel["wall"][pixel])


def trace_blinks(measurement):
    """{time: array [ns]} with one value per blink. A blink that was seen only after the next one counts as lost there."""
    tracer = Tracer(measurement)
    count = len(measurement.blinks["blink"])
    traced = {name: numpy.full(count, LOST, dtype=numpy.int64) for name in TIMES}
    events = measurement.blinks["event"]
    for i in range(count):
        end = events[i + 1] if i + 1 < count else events[i] + 1_000_000_000
        for name, time in tracer.trace(i).items():
            traced[name][i] = time if time < end else LOST
    return traced


def duration(traced, begin, end):
    """Durations of a stage [s]; nan where the blink was lost."""
    known = (traced[begin] != LOST) & (traced[end] != LOST)
    return numpy.where(known, 1e-9 * (traced[end] - traced[begin]), numpy.nan)
