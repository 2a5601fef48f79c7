"""The sheet of readings: an empty one, and reading one with everything that is wrong with it said at the door."""
import csv
import difflib
import math

from protocol import QUANTITIES, REPEATS
from vibe_sessions.whole_file import open_whole

COLUMNS = ["measurement", "at", "at_unit", "reading", "unit", "repeat"]
HEADER = """# Readings of a silicone stomach; the protocol is docs/phantom.md. Lines that begin with # are comments.
# One row per reading: write it into the column reading, with a point, in the unit of the row. Change nothing else; a row
# that was not measured is deleted with all of its measurement.
"""


class SheetError(Exception):
    """What is wrong with a sheet, one sentence per line."""


def write(file, readings=None):
    """An empty sheet, or one with readings: those of {(measurement, at, repeat): reading}."""
    with open_whole(file, newline="") as stream:
        for name, quantity in QUANTITIES.items():
            stream.write((HEADER if name == "coupon" else "") + f"# {name}: {quantity.what}\n")
            if name == "coupon":
                csv.writer(stream).writerow(COLUMNS)
            for at in quantity.at:
                for repeat in range(1, (1 if name == "wall" else REPEATS) + 1):
                    reading = readings[name, at, repeat] if readings else ""
                    csv.writer(stream).writerow([name, at, quantity.at_unit, reading, quantity.unit, repeat])


def read(file):
    """Readings as {measurement: {at: [reading, ...]}}. Raises SheetError with all that is wrong."""
    with open(file, newline="", encoding="utf-8-sig") as stream:
        lines = [(number, line) for number, line in enumerate(stream, 1) if line.strip() and not line.startswith("#")]
    rows = list(csv.reader(line for _, line in lines))
    if not rows or [cell.strip() for cell in rows[0]] != COLUMNS:
        raise SheetError(f"{file}: the first row is not '{','.join(COLUMNS)}'; begin with scripts/phantom sheet.")
    readings, wrong = {}, []
    for (number, _), row in zip(lines[1:], rows[1:]):
        try:
            name, at, value = _reading([cell.strip() for cell in row])
            readings.setdefault(name, {}).setdefault(at, []).append(value)
        except SheetError as error:
            wrong.append(f"{file}:{number}: {error}")
    wrong += [f"{file}: {sentence}" for sentence in ([] if wrong else _missing(readings))]
    if wrong:
        raise SheetError("\n".join(wrong))
    return readings


def _number(text, column):
    try:
        value = float(text)
    except ValueError:
        raise SheetError(f"the {column} is '{text}', which is no number; write one with a point.") from None
    if not math.isfinite(value):
        raise SheetError(f"the {column} is {text}; write what the instrument showed, or delete the measurement.")
    return value


def _reading(row):
    if len(row) != len(COLUMNS):
        raise SheetError(f"the row has {len(row)} columns and not {len(COLUMNS)}; write numbers with a point.")
    name, at, at_unit, reading, unit, _ = row
    if name not in QUANTITIES:
        near = difflib.get_close_matches(name, QUANTITIES, 1)
        raise SheetError(f"there is no measurement '{name}'; " +
                         (f"did you mean '{near[0]}'?" if near else f"there are {', '.join(QUANTITIES)}."))
    quantity = QUANTITIES[name]
    for found, wanted in ((at_unit, quantity.at_unit), (unit, quantity.unit)):
        if found != wanted:
            raise SheetError(f"{name} is in '{found}' and not in {wanted}; convert the number and write {wanted}.")
    at, value = _number(at, "setting"), _number(reading, "reading")
    if at not in quantity.at:
        swapped = any(math.isclose(value, setting) for setting in quantity.at)
        raise SheetError(f"{name} is not measured at {at:g} {quantity.at_unit}, but at {', '.join(map(str, quantity.at))}; " +
                         (f"possible cause: the columns at and reading are swapped (the reading is {value:g})."
                          if swapped else "measure there."))
    if not quantity.low <= value <= quantity.high:
        raise SheetError(f"{name} at {at:g} {quantity.at_unit} is {value:g} {unit}, and plausible is {quantity.low:g} to "
                         f"{quantity.high:g}; {_unit_hint(quantity, value)}")
    return name, at, value


# of a reading in another unit, over the reading in the right one
OTHER_UNITS = {"mmHg": {"kPa": 0.133322, "hPa or mbar": 1.33322, "cmH2O": 1.35951, "Pa": 133.322},
               "N": {"kgf": 0.101972, "gf": 101.972, "mN": 1000.0, "lbf": 0.224809}, "mm": {"cm": 0.1, "m": 0.001}}


def _unit_hint(quantity, value):
    fitting = [unit for unit, factor in OTHER_UNITS[quantity.unit].items()
               if quantity.low <= value / factor <= quantity.high]
    return ("possible cause: it was read in " + " or ".join(fitting) + "." if fitting else
            "possible cause: a slip of the pen, or of the point.")


def _missing(readings):
    for name in ("coupon", "wall"):
        if name not in readings:
            yield f"there is no reading of {name}, which the twin is made with; measure it."
    for name, found in readings.items():
        lacking = [at for at in QUANTITIES[name].at if at not in found]
        if lacking:
            yield (f"{name} lacks readings at {', '.join(map(str, lacking))} {QUANTITIES[name].at_unit}; measure there, "
                   f"or delete all of {name}.")
