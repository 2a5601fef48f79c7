"""One line of progress: done, rate, time left."""
import sys
import time

PERIOD = 10.0  # between lines where they are kept, as in a log [s]


def duration_text(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 90 * 60:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"


class Progress:
    """@param finished  sessions that an earlier call has performed"""

    def __init__(self, total, finished, stream=None, clock=time.monotonic):
        self._total, self._before, self._stream, self._clock = total, finished, stream or sys.stderr, clock
        self._done = self._failed = 0
        self._start = self._printed = clock()

    def add(self, failed=False):
        self._done += 1
        self._failed += failed
        last = self._before + self._done == self._total
        if self._stream.isatty():
            self._stream.write(f"\r{self.line():<78}" + ("\n" if last else ""))
            self._stream.flush()
        elif last or self._clock() - self._printed >= PERIOD:
            self._printed = self._clock()
            self._stream.write(self.line() + "\n")
            self._stream.flush()

    def line(self):
        """"12 of 120 sessions, 95 per hour, 68 min left"."""
        passed = max(self._clock() - self._start, 1e-3)
        text = f"{self._before + self._done} of {self._total} sessions"
        if self._done > 0:
            rate = self._done / passed
            left = (self._total - self._before - self._done) / rate
            text += f", {3600 * rate:.0f} per hour, {duration_text(left)} left"
        return text + (f", {self._failed} failed" if self._failed else "")
