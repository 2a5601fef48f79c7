"""The table of docs/policy.md: numbers that steer a step, from the sources, and what shifts of them change."""

import os
import re

from measured_store import number
from measured_tables import made_from
from measured_text import digits, sentence, signed, table

TABLES = ("contact_numbers.inl", "solver_numbers.inl")
FOLDER = os.path.join(os.path.dirname(__file__), "..", "..", "src/vibe_core/include/vibe_core/solver")
ENTRY = re.compile(r'VIBE_(POLICY_SECTION|REAL|COUNT)\(((?:"(?:[^"\\]|\\.)*"|[^")])*)\)')
WORD = re.compile(r'((?:"(?:[^"\\]|\\.)*"\s*)+)|([^,"\s][^,"]*)')
NO_EFFECT = "no effect in these states"


def words(arguments):
    """The arguments of a row; adjacent texts are one."""
    for found in WORD.finditer(arguments):
        texts = re.findall(r'"((?:[^"\\]|\\.)*)"', found.group(1) or "")
        yield "".join(texts).replace('\\"', '"') if found.group(1) else found.group(2).strip()


def numbers():
    """(section, name, default, unit, meaning, reason) of every row of the tables."""
    section = ""
    for file in TABLES:
        with open(os.path.join(FOLDER, file), encoding="utf-8") as stream:
            text = re.sub(r"^//.*$", "", stream.read(), flags=re.MULTILINE)
        for found in ENTRY.finditer(text):
            row = list(words(found.group(2)))
            if found.group(1) == "POLICY_SECTION":
                section = row[0]
            elif found.group(1) == "COUNT":
                yield (section, row[0], row[1], "", *row[2:])
            else:
                yield (section, *row)


def numbers_of_walls():
    """Names of the numbers that act where walls meet, which those of a coarse mesh do not."""
    return [name for section, name, *_ in numbers() if "walls" in section.lower()]


def effect(row, totals):
    """What one shift changes, in a few words."""
    if row is None:
        return "not measured yet"
    total = totals[row["part"]]
    if not row["states"]:
        return NO_EFFECT
    parts = [("force", number(row["force_change"])), ("stiffness", number(row["stiffness_change"]))]
    said = [f"{name} {digits(100 * value)} %" for name, value in parts if value >= 5e-5]
    if number(row["motion_max_mm"]) >= 0.001:
        said.append(f"motion {digits(row['motion_rms_mm'])} mm rms, {digits(row['motion_max_mm'])} mm at most")
    for name, column in (("iterations", "iterations"), ("evaluations", "evaluations")):
        change = number(row[column]) / number(total[column])
        if abs(change) >= 0.001:
            said.append(f"{name} {signed(change)}")
    for name, column in (("solved again", "solved_again"), ("fallback", "fallback_steps")):
        if number(row[column]):
            said.append(f"{name} {int(row[column]):+d} steps".replace("-", "−"))
    return ", ".join(said) or "last bits"


@made_from("policy")
def policy(store):
    of_walls = set(numbers_of_walls())
    rows = {(row["number"], row["factor"]): row for row in store.rows("policy")
            if (row["number"] in of_walls) == (row["part"] == "walls")}  # fmt: skip
    totals = {row["part"]: row for row in store.rows("policy") if row["number"] == "defaults"}
    sections = {}
    for section, name, default, unit, meaning, reason in numbers():
        less, more = (effect(rows.get((name, factor)), totals) for factor in ("0.8", "1.2"))
        change = less if less == more else f"−20 %: {less}; +20 %: {more}"
        value = " ".join(filter(None, (default, unit)))
        sections.setdefault(section, []).append((f"`{name}`", value, meaning, reason, change))
    said = [sentence(f"With the defaults, the states of {particles} particles have {total['steps']} steps with "
                     f"{total['iterations']} iterations and {total['evaluations']} evaluations of the elastic energy; "
                     f"{total['solved_again']} steps are solved again, {total['fallback_steps']} by backward Euler.")
            for particles, part in (("900", "numbers"), ("3,618", "walls")) if (total := totals.get(part))]  # fmt: skip
    for section, lines in sections.items():
        said += [f"## {section}", table(("number", "default", "meaning", "source", "effect of a shift"), lines)]
    return "\n\n".join(said), [("walls" if row["part"] == "walls" else "other numbers", row) for row in rows.values()]
