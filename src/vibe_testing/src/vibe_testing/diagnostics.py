"""Entries on /diagnostics."""

import time

from .wait import PATIENCE, wait_until


class Diagnostics:
    """An entry, as (level, message, values); (None, "", {}) where there is none. recorder: of /diagnostics."""

    def __init__(self, recorder, name):
        self.recorder, self.name = recorder, name

    def newest(self, after=0.0):
        """The last that has arrived after a time."""
        for arrival, message in reversed(self.recorder.arrivals):
            for status in message.status:
                if status.name.endswith(": " + self.name) and arrival > after:
                    return status.level, status.message, {v.key: v.value for v in status.values}
        return None, "", {}

    def waits_for_newer(self, after=0.0, seconds=PATIENCE):
        """The newest, once one has arrived after a time."""
        wait_until(lambda: self.newest(after)[0] is not None, seconds)
        return self.newest(after)

    def waits_for(self, condition, seconds=PATIENCE):
        """The newest for which condition(level, message, values) holds, of those from now on; or None."""
        begin, found = time.time(), []

        def look():
            found[:] = [self.newest(begin)]
            return found[0][0] is not None and condition(*found[0])

        return found[0] if wait_until(look, seconds) else None
