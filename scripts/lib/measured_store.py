"""What has been measured: docs/measured/SECTION.csv, one row per result, with when, where and how it was measured."""

import csv
import hashlib
import math
import os
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../src/vibe_sessions/src"))
from vibe_sessions.whole_file import open_whole  # noqa: E402

# columns that the store adds; `epoch` is that of the guard when the row was measured
PROVENANCE = ("part", "date", "version", "epoch", "machine", "load", "cpu_s", "command")
GUARD = "guard"  # section whose errors tell whether the physics is still the one that was measured
ITSELF = "guard"  # epoch of the guard's own rows
ROUNDING = 1e-5  # of errors as fractions; 0.001 % is of no interest
# Largest differences that are none. Fused and plain arithmetic differ in the last bits, which contact magnifies to 0.002
# of an error; forces differ in the last digit that is written, the fourth.
OF_ERROR, OF_FORCE = 0.005, 0.001


class Store:
    """The result files of a folder."""

    def __init__(self, folder):
        self.folder = folder
        self.epoch = self.find_epoch()

    def file(self, section):
        return os.path.join(self.folder, section + ".csv")

    def rows(self, section):
        if not os.path.exists(self.file(section)):
            return []
        with open(self.file(section), newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def replace(self, section, order, part, rows):
        """Puts rows in the place of those of a part; the parts of a section are kept in this order."""
        kept = [row for row in self.rows(section) if row["part"] != part and row["part"] in order]
        rows = sorted(kept + rows, key=lambda row: order.index(row["part"]))
        columns = list(dict.fromkeys(name for row in rows for name in row if name not in PROVENANCE))
        os.makedirs(self.folder, exist_ok=True)
        with open_whole(self.file(section), newline="") as stream:
            writer = csv.DictWriter(stream, columns + list(PROVENANCE), restval="", lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        self.epoch = self.find_epoch()

    def find_epoch(self):
        """A digest of the guard's results: it changes when their errors do."""
        kept = [[value for name, value in row.items() if name not in PROVENANCE and not is_time(name)]
                for row in self.rows(GUARD)]  # fmt: skip
        text = "\n".join(map(",".join, kept))
        return hashlib.sha1(text.encode()).hexdigest()[:8] if text else ""

    def is_old(self, row):
        return row["epoch"] not in (self.epoch, ITSELF)


def is_time(column):
    return column.startswith("ms_") or column in ("ratio_to_free", "state_hash")


def number(text):
    """A number of a table; not a number where there is none."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def differences(section, stored, fresh):
    """Sentences on the results of one part that are not the stored ones: rows that come or go, errors that differ."""
    by_key = lambda rows: {tuple(row.get(name, "") for name in section.keys): row for row in rows}  # noqa: E731
    known, found = by_key(stored), by_key(fresh)
    for key in dict.fromkeys([*known, *found]):
        name = " ".join([section.name, *filter(None, key)])
        if key not in known or key not in found:
            yield "{}: is {}".format(name, "measured no longer" if key in known else "not in the stored table")
            continue
        for column in section.compared:
            old, new = known[key].get(column, ""), found[key].get(column, "")
            part = OF_FORCE if column.endswith("_N") else OF_ERROR
            if old != new and not abs(number(old) - number(new)) <= ROUNDING + part * abs(number(old)):
                yield "{}: {} is {}, stored {}".format(name, column, new or "empty", old or "empty")
