"""Quantities with units, as scene files write them: "1.2 N", "20 mm", "10 mmHg", "5 %"."""
import math
import re

# The symbols of vibe_core/src/scene/unit.cpp that measures need: (factor, SI unit). A test compares the two.
SYMBOLS = {
    "1": (1, "1"), "%": (1e-2, "1"),
    "m": (1, "m"), "dm": (1e-1, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "µm": (1e-6, "m"),
    "μm": (1e-6, "m"),
    "in": (25.4e-3, "m"),
    "L": (1e-3, "m^3"), "l": (1e-3, "m^3"), "dL": (1e-4, "m^3"), "mL": (1e-6, "m^3"), "ml": (1e-6, "m^3"),
    "s": (1, "s"), "ms": (1e-3, "s"), "us": (1e-6, "s"), "min": (60, "s"), "h": (3600, "s"),
    "N": (1, "N"), "mN": (1e-3, "N"), "kN": (1e3, "N"),
    "Pa": (1, "Pa"), "hPa": (1e2, "Pa"), "kPa": (1e3, "Pa"), "MPa": (1e6, "Pa"), "bar": (1e5, "Pa"),
    "mbar": (1e2, "Pa"), "mmHg": (133.322387415, "Pa"), "cmH2O": (98.0665, "Pa"),
    "J": (1, "J"), "kJ": (1e3, "J"),
}
ANGLES = {"rad": (1, "rad"), "mrad": (1e-3, "rad"), "deg": (math.pi / 180, "rad"), "turn": (2 * math.pi, "rad"),
          "turns": (2 * math.pi, "rad")}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
EXAMPLES = {"1": "0.45 or 45 %", "m": "20 mm", "m^2": "60 cm^2", "m^3": "0.9 L", "s": "20 s", "N": "1.2 N",
            "Pa": "10 mmHg", "J": "0.1 J", "rad": "90 deg"}


class UnitError(ValueError):
    """The part of a sentence after what was written."""


def unit_of(text):
    """(factor, SI unit) of "mm", "cm^2", ...; a product of units is none that a measure has."""
    symbol, _, power = text.replace(" ", "").partition("^")
    if symbol not in {**SYMBOLS, **ANGLES} or power not in ("", "2", "3"):
        raise UnitError(f"has the unknown unit '{text}'")
    factor, unit = {**SYMBOLS, **ANGLES}[symbol]
    if not power:
        return factor, unit
    if unit != "m":
        raise UnitError(f"has the unknown unit '{text}'")
    return factor ** int(power), f"m^{power}"


def split(text):
    """(number, unit as written) of "1.2 N"."""
    match = NUMBER.match(text.strip())
    if not match or not math.isfinite(float(match.group())):
        raise UnitError("is not a number")
    return float(match.group()), text.strip()[match.end():].strip()


def parse(text, si_unit):
    """(value in SI, unit as written) of a quantity of that unit; plain numbers are SI."""
    try:
        number, written = split(text)
        factor, unit = unit_of(written) if written else (1, si_unit)
    except UnitError as error:
        raise UnitError(f"{error}; write for example {EXAMPLES[si_unit]}") from None
    if unit != si_unit:
        raise UnitError(f"is in {unit}, but should be in {si_unit}; write for example {EXAMPLES[si_unit]}")
    return number * factor, written


def show(value, written, digits=6):
    """An SI value in a unit as written."""
    factor = unit_of(written)[0] if written else 1
    return f"{value / factor:.{digits}g}" + (f" {written}" if written else "")
