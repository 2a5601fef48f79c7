"""Waiting for what must come sooner or later. No ROS here."""

import time

PATIENCE = 40.0  # of everything that waits: a busy machine is normal; a limit that a test judges is another number [s]


def wait_until(condition, seconds=PATIENCE, interval=0.01):
    """Whether the condition became true within some seconds of wall time."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(interval)
    return bool(condition())
