"""How old the positions in the published states are, and how far from where the hand is then.

A hand that goes to and fro, instead of one that blinks: only a motion that goes on can be predicted.
"""

import numpy

RESOLUTION = 2e-4  # of the age [s]
YOUNGEST, OLDEST = -0.02, 0.15  # that are looked at [s]
GAP = 0.02  # between two frames: the camera has paused, and nobody knows where the hand was [s]
AFTER_GAP = 0.05  # until steps have frames again [s]


def published_positions(measurement):
    """(wall time of publishing [s], position [m]) of the joint in each step, with the truth's time as zero."""
    published = dict(zip(measurement.step["step"].tolist(), measurement.step["published"].tolist()))
    known = [i for i, step in enumerate(measurement.input["step"].tolist()) if step in published]
    walls = numpy.array([published[int(measurement.input["step"][i])] for i in known], dtype=numpy.int64)
    return 1e-9 * (walls - measurement.truth["wall"][0]), measurement.input["position"][known]


class Motion:
    """The published positions beside the true ones."""

    def __init__(self, measurement):
        truth = measurement.truth
        self.truth_times = 1e-9 * (truth["wall"] - truth["wall"][0])
        self.truth = truth["position"]
        times, positions = published_positions(measurement)
        # setup's "from": before it the graph starts
        first = max(self.truth_times[0] + OLDEST, 1e-9 * (measurement.setup.get("from", 0) - truth["wall"][0]))
        inside = (times > first) & (times < self.truth_times[-1] + YOUNGEST)
        beside = inside & self.has_frames(times)
        self.times, self.positions = times[beside], positions[beside]
        self.left_out = int(inside.sum() - beside.sum())

    def has_frames(self, times):
        """Whether the camera has sent frames without a pause until each time."""
        result = numpy.ones(len(times), dtype=bool)
        for k in numpy.flatnonzero(numpy.diff(self.truth_times) > GAP):
            result &= (times < self.truth_times[k]) | (times > self.truth_times[k + 1] + AFTER_GAP)
        return result

    def error(self, age):
        """Of the published positions, if each were that of the hand so long ago, as root mean square [m]."""
        true = numpy.interp(self.times - age, self.truth_times, self.truth)
        return float(numpy.sqrt(numpy.mean((self.positions - true) ** 2)))

    def errors(self):
        """(ages [s], errors [m])"""
        ages = numpy.arange(YOUNGEST, OLDEST, RESOLUTION)
        return ages, numpy.array([self.error(age) for age in ages])

    def numbers(self):
        """age: of the positions, the one for which they fit the hand best; error at once: from where the hand is at the
        time of publishing; error at age: what remains with the age taken into account; left out: positions published while
        the camera paused."""
        if len(self.times) < 2:
            return {"count": len(self.times)}
        ages, errors = self.errors()
        best = int(numpy.argmin(errors))
        return {
            "count": len(self.times),
            "left out": self.left_out,
            "age": float(ages[best]),
            "error at age": float(errors[best]),
            "error at once": self.error(0.0),
            "max at once": float(
                numpy.abs(self.positions - numpy.interp(self.times, self.truth_times, self.truth)).max()
            ),
        }
