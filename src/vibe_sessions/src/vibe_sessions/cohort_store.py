"""The folder of a cohort: plan, one small file per finished session, table."""
import csv
import fcntl
import io
import json
import os

from vibe_sessions.cohort_plan import Plan
from vibe_sessions.headless import SessionError


def write_whole(path, text):
    """A file appears complete or not at all."""
    part = path + ".part"
    try:
        with open(part, "w", encoding="utf-8", newline="") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    except OSError as error:
        raise SessionError(f"Cannot write '{path}': {error.strerror}.") from None


class Store:
    """DIR/cohort.yaml, DIR/rows/KEY.json, DIR/cohort.csv and, if a session failed, DIR/failed.csv."""

    def __init__(self, folder):
        self.folder = folder
        try:
            os.makedirs(os.path.join(folder, "rows"), exist_ok=True)
            self._lock = open(os.path.join(folder, ".lock"), "w", encoding="utf-8")
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
            write_whole(self.path("cohort.yaml"), plan.text())
            return
        difference = plan.difference(Plan.load(self.path("cohort.yaml")))
        if difference:
            raise SessionError(f"'{self.folder}' has a cohort with another plan: {difference}; name another folder.")

    def has(self, session):
        return os.path.exists(self.path(f"rows/{session.key}.json"))

    def keep(self, session, row):
        columns, values = row
        write_whole(self.path(f"rows/{session.key}.json"), json.dumps({"columns": columns, "values": values}) + "\n")

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
        part = self.path("cohort.csv.part")
        with open(part, "w", encoding="utf-8", newline="") as stream:
            writer, names = csv.writer(stream, lineterminator="\n"), None
            for session in (s for s in plan.sessions() if self.has(s)):
                columns, values = self._read(session)
                if names is None:
                    writer.writerow(columns)
                    names = columns
                if columns != names:
                    raise SessionError(f"The row of {session.key} has other columns; remove it and call again.")
                writer.writerow(values)
        os.replace(part, self.path("cohort.csv"))

    def write_failures(self, failures):
        """[(key, reason)]; without any the file goes."""
        path = self.path("failed.csv")
        if not failures:
            if os.path.exists(path):
                os.remove(path)
            return
        text = io.StringIO(newline="")
        csv.writer(text, lineterminator="\n").writerows([("session", "reason")] + failures)
        write_whole(path, text.getvalue())
