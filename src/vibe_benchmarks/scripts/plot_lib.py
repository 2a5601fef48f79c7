"""What the plot scripts share: command lines, tables, axes of speed against error, pictures."""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402,F401
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402

FRAME = 1000 / 60  # [ms]


def parse_arguments(usage, options):
    """[--OPTION=TEXT ...] TABLE.csv PICTURE [PICTURE ...]: the options given, the table, the pictures."""
    arguments, given = sys.argv[1:], {}
    while arguments and arguments[0].startswith("--"):
        key, equals, value = arguments.pop(0)[2:].partition("=")
        if key not in options or not equals:
            sys.exit(usage.strip())
        given[key] = value
    if len(arguments) < 2:
        sys.exit(usage.strip())
    return given, arguments[0], arguments[1:]


def read_table(name, column, program):
    """Rows of a CSV file that has the column."""
    with open(name, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    if not rows or column not in rows[0]:
        sys.exit(f"{name}: has no column '{column}'; write it with {program}")
    return rows


def label_log_axes(axis, time, error):
    """Plain numbers on both axes."""
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel(time)
    axis.set_ylabel(error)
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    for one in (axis.xaxis, axis.yaxis):
        one.set_major_formatter(FormatStrFormatter("%g"))
        one.set_minor_formatter(NullFormatter())
    axis.grid(True, which="major", color="0.92")


def set_title(figure, title, given):
    machine = given.get("machine", "")
    figure.suptitle(title + (f"\n{machine}" if machine else ""), fontsize=11)


def save(figure, pictures, dpi=130):
    for picture in pictures:
        figure.savefig(picture, dpi=dpi, metadata={"Date": None} if picture.endswith(".svg") else None)
