"""The folder of a cohort: plan, one small file per finished session, table."""
import csv
import fcntl
import json
import os

from vibe_sessions.cohort_plan import Plan
from vibe_sessions.headless import SessionError
from vibe_sessions.whole_file import open_whole


def write_whole(path, write):
    """A file, by a function of an open one."""
    try:
        with open_whole(path, newline="") as stream:
            write(stream)
    except OSError as error:
        raise SessionError(f"Cannot write '{path}': {error.strerror}.") from None


class Store:
    """DIR/cohort.yaml, DIR/rows/KEY.json, DIR/cohort.csv and, if a session failed, DIR/failed.csv."""

    def __init__(self, folder):
        self.folder = folder
        try:
            os.makedirs(os.path.join(folder, "rows"), exist_ok=True)
            self._lock = open(os.path.join(folder, ".lock"), "w", encoding="utf-8")  # not whole: it is empty
        except OSError as error:
            raise SessionError(f"Cannot write into '{folder}': {error.strerror}.") from None
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise SessionError(f"Another cohort is at work in '{folder}'; wait for it or name another "
                               "folder.") from None

    def close(self):
        self._lock.close()

    def path(self, name):
        return os.path.join(self.folder, name)

    def has_plan(self):
        return os.path.exists(self.path("cohort.yaml"))

    def adopt(self, plan):
        """The folder gets this plan, or has it already.

        Raises SessionError if it has another one.
        """
        if not self.has_plan():
            write_whole(self.path("cohort.yaml"), lambda stream: stream.write(plan.text()))
            return
        difference = plan.difference(Plan.load(self.path("cohort.yaml")))
        if difference:
            raise SessionError(f"'{self.folder}' has a cohort with another plan: {difference}; name another folder.")

    def has(self, session):
        return os.path.exists(self.path(f"rows/{session.key}.json"))

    def keep(self, session, row):
        columns, values = row
        text = json.dumps({"columns": columns, "values": values}) + "\n"
        write_whole(self.path(f"rows/{session.key}.json"), lambda stream: stream.write(text))

    def _read(self, session):
        path = self.path(f"rows/{session.key}.json")
        try:
            with open(path, encoding="utf-8") as stream:
                row = json.load(stream)
            return row["columns"], row["values"]
        except (OSError, ValueError, KeyError, TypeError):
            raise SessionError(f"'{path}' cannot be read; remove it and call again.") from None

    def write_table(self, plan):
        """The rows of all finished sessions, in the order of the plan, one at a time in memory."""
        def write(stream):
            writer, names = csv.writer(stream, lineterminator="\n"), None
            for session in (s for s in plan.sessions() if self.has(s)):
                columns, values = self._read(session)
                if names is None:
                    writer.writerow(columns)
                    names = columns
                if columns != names:
                    raise SessionError(f"The row of {session.key} has other columns; remove it and call again.")
                writer.writerow(values)
        write_whole(self.path("cohort.csv"), write)

    def write_failures(self, failures):
        """[(key, reason)]; without any the file goes."""
        path = self.path("failed.csv")
        if not failures:
            if os.path.exists(path):
                os.remove(path)
            return
        rows = [("session", "reason")] + failures
        write_whole(path, lambda stream: csv.writer(stream, lineterminator="\n").writerows(rows))
