"""What a report writes besides the pages of sessions: sessions.csv, sessions.json and the page of all."""

import csv
import io
import json
import os
import sys
import tempfile

from ..whole_file import open_whole
from .session_work import write_text


class Output:
    """Collects results in any order. Keeps one row per session; the numbers wait in a file."""

    def __init__(self, folder, total):
        self._folder = folder
        self._rows = [None] * total
        self._problems = [None] * total
        self._places = [None] * total  # of the numbers in the file
        self._traces = [None] * total
        self._waiting = tempfile.TemporaryFile("w+", encoding="utf-8", dir=folder)
        self.done = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._waiting.close()

    @property
    def failures(self):
        return [problem for problem in self._problems if problem]

    @property
    def rows(self):
        return [row for row in self._rows if row is not None]

    def add(self, number, row, numbers, problem, trace):
        self.done += 1
        self._traces[number] = trace
        self._problems[number] = problem
        if row is not None:  # the names of the columns once, not once per row
            self._rows[number] = {sys.intern(key): value for key, value in row.items()}
        if numbers is not None:
            self._places[number] = self._waiting.tell()
            self._waiting.write(set_group(numbers, row) + "\n")

    def write(self, with_index):
        self._write_csv()
        self._write_json()
        if with_index:
            from .distributions import MOST_GROUPS, distributions
            from .page import index_page

            rows = self.rows
            groups = sorted({row["group"] for row in rows})
            traces = [trace for trace in self._traces if trace is not None]
            page = index_page(rows, self.failures, groups, distributions(rows), MOST_GROUPS, traces)
            write_text(os.path.join(self._folder, "index.html"), page)

    def _write_csv(self):
        columns = {}
        for row in self.rows:
            columns.update(dict.fromkeys(row))
        text = io.StringIO()
        writer = csv.DictWriter(text, columns, lineterminator="\n", restval="")
        writer.writeheader()
        writer.writerows({key: "" if value is None else value for key, value in row.items()} for row in self.rows)
        write_text(os.path.join(self._folder, "sessions.csv"), text.getvalue())

    def _write_json(self):
        path = os.path.join(self._folder, "sessions.json")
        with open_whole(path) as file:
            file.write('{"sessions": [\n')
            first = True
            for place in self._places:
                if place is not None:
                    self._waiting.seek(place)
                    file.write(("" if first else ",\n") + self._waiting.readline().rstrip("\n"))
                    first = False
            file.write('\n],\n"not_read": {}}}\n'.format(json.dumps(self.failures)))


def set_group(numbers, row):
    """The group may be known only when the recording has been read."""
    about = json.loads(numbers)
    return json.dumps({**about, "group": row["group"]}, allow_nan=False)
