"""The tables of a measurement, as arrays. All times are of the wall clock [ns]."""

import csv
import json
import os

import numpy

NAMES = ("blinks", "device", "input", "step", "state", "display", "pixel")
MODES = {  # what was measured: the tables that it needs
    "blinks": NAMES,
    "steps": ("step",),
    "sway": ("input", "step"),
}


class TableError(Exception):
    """One sentence for the user."""


def read_table(path):
    """{column: array} of a CSV file; whole numbers stay exact."""
    try:
        with open(path, encoding="ascii") as file:
            columns = file.readline().strip().split(",")
            rows = [line.strip().split(",") for line in file]
    except (OSError, UnicodeDecodeError) as error:
        raise TableError("'{}' cannot be read: {}".format(path, error)) from error
    table = {}
    for c, name in enumerate(columns):
        kind = numpy.float64 if name == "position" else numpy.int64
        try:
            table[name] = numpy.array([row[c] for row in rows]).astype(kind)
        except (IndexError, ValueError) as error:
            raise TableError("'{}' has a row that is no row of {}".format(path, ",".join(columns))) from error
    return table


def read_truth(path):
    """{"wall" [ns], "position" [m]} of the helix, from the table of the simulated camera: one row per frame and
    instrument, in any order of columns."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["instrument"] == "helix"]
        seconds = numpy.array([float(row["stamp"]) for row in rows])
        positions = numpy.array([float(row["slide"]) for row in rows])
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise TableError("'{}' is no table of true positions: {}".format(path, error)) from error
    if len(rows) < 2:
        raise TableError("'{}' has no two positions of the helix; did the session run to its end?".format(path))
    return {"wall": numpy.round(1e9 * seconds).astype(numpy.int64), "position": positions}


class Measurement:
    """What one run has written, by table, and how it was set up."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "setup.json"), encoding="utf-8") as file:
            self.setup = json.load(file)
        self.mode = self.setup.get("mode", "blinks")
        if self.mode not in MODES:
            raise TableError("'{}/setup.json' has the mode '{}'; there are {}".format(folder, self.mode, ", ".join(MODES)))
        for name in MODES[self.mode]:
            setattr(self, name, read_table(os.path.join(folder, name + ".csv")))
        if self.mode == "sway":
            self.truth = read_truth(os.path.join(folder, "truth.csv"))
