"""Compares measures with what was expected: what moved, and by how much."""
import dataclasses
import math

from vibe_sessions.regression_units import show


@dataclasses.dataclass
class Verdict:
    """One line of the table."""

    name: str
    expected: str
    got: str
    moved: str
    passed: bool

    def sentence(self):
        moved = f", moved by {self.moved}" if self.moved else ""
        return f"{self.name}: expected {self.expected}, got {self.got}{moved}"


def expected_text(e):
    if e.digest:
        return e.digest
    if e.tolerance:
        return f"{show(e.value, e.unit)} +- {e.tolerance}"
    if e.value is not None:
        return show(e.value, e.unit)
    if math.isinf(e.high):
        return f"at least {show(e.low, e.unit)}"
    if math.isinf(e.low):
        return f"at most {show(e.high, e.unit)}"
    return f"{show(e.low, e.unit)} to {show(e.high, e.unit)}"


def moved_text(e, got):
    """Absolute, in %, and times the tolerance; for limits how far beyond them."""
    by = got - e.value if e.value is not None else min(got - e.low, 0) + max(got - e.high, 0)
    if abs(by) <= 1e-9 * abs(e.value or 0):
        return ""
    text = ("+" if by > 0 else "") + show(by, e.unit, 3)
    if e.value:
        text += f"  {100 * by / abs(e.value):+.3g} %"
    if e.tolerance and e.high > e.value:
        text += f"  {abs(by) / (e.high - e.value):.3g} x tolerance"
    return text


def slack(e):
    """Half a unit in the last place of limits that were rounded by their conversion from units."""
    return 1e-12 * max(abs(limit) for limit in (e.low, e.high, 0) if math.isfinite(limit))


def judge_one(e, values, state_hash):
    if e.digest:
        return Verdict(e.name, e.digest, state_hash, "" if e.digest == state_hash else "another state",
                       e.digest == state_hash)
    got = values[e.name][0]
    if got is None:
        return Verdict(e.name, expected_text(e), "no value", "", False)
    passed = e.low - slack(e) <= got <= e.high + slack(e)
    return Verdict(e.name, expected_text(e), show(got, e.unit), moved_text(e, got), passed)


def judge(regression, values, state_hash):
    return [judge_one(e, values, state_hash) for e in regression.expect]


def table(verdicts):
    rows = [("measure", "expected", "got", "moved by", "verdict")]
    rows += [(v.name, v.expected, v.got, v.moved, "ok" if v.passed else "FAILED") for v in verdicts]
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    return "".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() + "\n" for row in rows)
