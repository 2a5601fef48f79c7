"""The tables of a measurement, as arrays. All times are of the wall clock [ns]."""

import json
import os

import numpy

NAMES = ("blinks", "device", "input", "step", "state", "display", "pixel")


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


class Measurement:
    """What one run has written, by table, and how it was set up."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "setup.json"), encoding="utf-8") as file:
            self.setup = json.load(file)
        for name in NAMES:
            setattr(self, name, read_table(os.path.join(folder, name + ".csv")))
