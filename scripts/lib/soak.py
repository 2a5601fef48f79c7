"""What the programs that look for growing memory share."""

import signal
import sys
import tempfile

from run_session import Interrupted, attempt, interrupt


def slope(samples):
    """Of a straight line through (time, value), by least squares."""
    mean_time = sum(time for time, _ in samples) / len(samples)
    mean_value = sum(value for _, value in samples) / len(samples)
    above = sum((time - mean_time) * (value - mean_value) for time, value in samples)
    return above / sum((time - mean_time) ** 2 for time, _ in samples)


def run(make, arguments):
    """Starts and watches what `make(arguments, folder)` returns, and stops it in any case. Ends this program with status 1
    if something failed."""
    failures = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    with tempfile.TemporaryDirectory(prefix="vibe-soak-") as folder:
        soak = make(arguments, folder)
        try:
            attempt(soak.start, failures)
            if not failures:
                attempt(soak.watch, failures)
        except Interrupted as reason:
            failures.append("stopped by {}".format(reason))
        attempt(soak.stop, failures)
    for failure in failures:
        print("soak: " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)
