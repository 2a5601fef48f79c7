"""Measured against predicted, and the faults of a measurement that have a likeness of their own."""
import numpy as np

from protocol import COMPARED, FORCES, QUANTITIES, SILENT_DROP, deviation
from sheet import OTHER_UNITS

CLEAR = 0.12  # deviation in common, as a share, that is said: three times that of thickness, batch and reading together
ALIKE = 0.4  # of the logarithms of two factors, from which the wall may cause both: forces grow less than the modulus
SURE = 4.0  # standard errors from which an offset is said


def table(readings, predicted):
    """Rows (measurement, at, mean, standard deviation, predicted, deviation in per cent, in standard deviations) of what
    was measured and predicted. The standard deviation is that of the repeats, at least that of protocol.deviation()."""
    rows = []
    for name in COMPARED:
        for at, expected in zip(QUANTITIES[name].at, predicted[name]):
            if name in readings and np.isfinite(expected):
                repeats = readings[name][at]
                mean = np.mean(repeats)
                spread = max(np.std(repeats, ddof=1) if len(repeats) > 1 else 0, deviation(name, mean))
                rows.append((name, at, mean, spread, expected, 100 * (mean / expected - 1), (mean - expected) / spread))
    return rows


def _line(rows, names):
    """Measured = slope x predicted + offset of some measurements: slope, offset, its standard error, and the slope of a
    line through zero. Weighted by the scatter of the readings."""
    chosen = [row for row in rows if row[0] in names]
    measured, spread, expected = (np.array([row[k] for row in chosen]) for k in (2, 3, 4))
    design = np.stack([expected, np.ones_like(expected)], axis=1) / spread[:, None]
    (slope, offset), *_ = np.linalg.lstsq(design, measured / spread, rcond=None)
    ratio = (measured * expected / spread ** 2).sum() / (expected ** 2 / spread ** 2).sum()
    return slope, offset, np.sqrt(np.linalg.inv(design.T @ design)[1, 1]), ratio


def fall(readings):
    """How much the pressure falls in a minute with the valve closed [mmHg], of all readings of drop; None without them."""
    if "drop" not in readings:
        return None
    pairs = [(at, value) for at, values in readings["drop"].items() for value in values]
    return float(-60 * np.polyfit(*np.transpose(pairs), 1)[0])


def _leak(readings):
    found = fall(readings)
    if found is None or found < SILENT_DROP:
        return []
    rate = ""
    if "fill" in readings:
        first = QUANTITIES["fill"].at[0]
        rise = np.mean(readings["fill"][first]) - 1  # above the 1 mmHg from which filling begins
        rate = f" (about {1e3 * first / rise * found:.1f} mL/min)" if rise > 0.1 else ""
    return [f"leak: the pressure falls by {found:.2f} mmHg in a minute{rate}, and less than {SILENT_DROP:g} is tight; look "
            "for bubbles at collars, pad and seams under water. All other readings may be too low."]


def causes(readings, rows):
    """Sentences that name possible causes of what deviates; none if nothing does. Nothing is corrected."""
    said, present = _leak(readings), {row[0] for row in rows}
    forces = [name for name in FORCES if name in present]
    slopes = {}
    if "fill" in present:
        slopes["fill"] = _line(rows, ["fill"])[3]
    if forces:
        slope, offset, error, ratio = _line(rows, forces)
        shifted = len(forces) > 1 and abs(offset) > max(SURE * error, 0.05)
        slopes["forces"] = slope if shifted else ratio
        if shifted:
            said.append(f"offset: all forces are {offset:+.2f} +- {error:.2f} N off, whatever their size; possible cause: "
                        "the gauge was not set to zero with pad and thread on it.")
    return said + _factors(slopes)


def _factors(slopes):
    off = {group: factor for group, factor in slopes.items() if abs(factor - 1) > CLEAR}
    logs = np.log([factor if factor > 0 else 1e-3 for factor in slopes.values()])
    if off and len(logs) == 2 and logs.prod() > 0 and min(abs(logs)) > ALIKE * max(abs(logs)):
        other = "stiffer or thicker" if logs[0] > 0 else "softer or thinner"
        return [f"stiff: pressures are {slopes['fill']:.2f} and forces {slopes['forces']:.2f} times the predicted ones; "
                f"possible cause: the wall is {other} than the cylinder and the measured places say (another batch, mixing ratio, age)."]
    said = []
    for group, factor in off.items():
        units = OTHER_UNITS["mmHg" if group == "fill" else "N"]
        fitting = [unit for unit, other in units.items() if abs(factor / other - 1) < 0.08]
        what = "pressures of fill" if group == "fill" else "forces"
        said.append(f"unit: the {what} are {factor:.3g} times the predicted ones, and the others are not; possible cause: "
                    f"they were read in {' or '.join(fitting)}." if fitting else
                    f"unexplained: the {what} are {factor:.3g} times the predicted ones, and the others are not.")
    return said


def as_text(rows):
    """The table for people."""
    lines = [f"{'':8}{'at':>10}{'measured':>16}{'predicted':>11}{'deviation':>11}{'in s.d.':>11}"]
    for name, at, mean, spread, expected, percent, ratio in rows:
        quantity = QUANTITIES[name]
        lines.append(f"{name:8}{at:>7g} {quantity.at_unit:2}{mean:>8.2f} +- {spread:.2f}{expected:>11.2f}{percent:>+9.1f} %"
                     f"{ratio:>+11.1f}  {quantity.unit}")
    return "\n".join(lines)
