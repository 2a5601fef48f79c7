"""Tables of published experiments: predictions of docs/measured/measurements.csv beside what was measured or computed
by others."""

import csv
import glob
import math
import os
import statistics

import yaml

from measured_store import number
from measured_tables import made_from
from measured_text import digits, percent, sentence, signed, table

FOLDER = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../../src/vibe_benchmarks/measurements")
MANY = 2  # published deviations within which a prediction agrees


def experiments():
    for file in sorted(glob.glob(os.path.join(FOLDER, "*.yaml"))):
        with open(file, encoding="utf-8") as text:
            yield os.path.splitext(os.path.basename(file))[0], yaml.safe_load(text)


def measured():
    """(experiment, run, quantity, at): the row of measured.csv."""
    with open(os.path.join(FOLDER, "measured.csv"), newline="", encoding="utf-8") as stream:
        return {(row["experiment"], row["run"], row["quantity"], row["at"]): row for row in csv.DictReader(stream)}


def compared(rows):
    """Each prediction with `truth` and its `deviation`, NaN where there is none; those without truth are left out. An
    experiment whose measurement names no run is compared with each of its runs."""
    known = measured()
    rows = list(rows)
    lost = {key[2:] for key in known if key[0] in {row["experiment"] for row in rows}} - {
        (row["quantity"], row["at"]) for row in rows}
    if lost:
        raise ValueError(f"measured.csv has values that no experiment predicts: {sorted(lost)[0]}")
    for row in rows:
        name, run, quantity, at = (row[key] for key in ("experiment", "run", "quantity", "at"))
        found = known.get((name, run, quantity, at)) or known.get((name, "", quantity, at)) or {}
        truth = number(row["reference"] or found.get("measured"))
        if not math.isnan(truth):
            yield {**row, "truth": truth, "deviation": number(found.get("deviation")), "is": found.get("deviation_is")}


def error(row, rows, experiment):
    """Relative to the truth, or to that of the quantity that the experiment names for it, of the same run."""
    scale = experiment.get("relative_to", {}).get(row["quantity"], row["quantity"])
    size = next(one["truth"] for one in rows if (one["run"], one["quantity"], one["at"]) == (row["run"], scale, row["at"]))
    return (number(row["predicted"]) - row["truth"]) / abs(size)


def count(rows):
    """How many predictions agree within MANY deviations, of those with a deviation; in words."""
    known = [row for row in rows if row["is"] == "SD"]
    good = [row for row in known if abs(number(row["predicted"]) - row["truth"]) <= MANY * row["deviation"]]
    return f"{len(good)} of {len(known)}" if known else ""


def share(value):
    return percent(value, 3 if value >= 1 else 2)


@made_from("measurements")
def measurements(store):
    rows, lines = store.rows("measurements"), []
    for name, experiment in experiments():
        mine = list(compared(row for row in rows if row["experiment"] == name))
        for run in experiment.get("compared_apart", [None]):
            part = [row for row in mine if run in (None, row["run"])]
            off = [abs(error(row, mine, experiment)) for row in part]
            title = ", ".join(filter(None, (experiment["title"], run)))
            said = (share(statistics.median(off)), share(max(off))) if off else ("", "")
            lines.append((title, experiment["judge"], str(len(part)) if part else "no figures available", *said, count(part)))
    header = ("experiment", "judge", "values", "median off", "most off", f"within {MANY} standard deviations")
    return table(header, lines), [(row["experiment"], row) for row in rows]


def values(rows, experiment):
    """Predictions and truths, a line per run and quantity, a column per point of the curve."""
    points = list(dict.fromkeys(row["at"] for row in rows))
    lines = {}
    for row in rows:
        deviation = "" if math.isnan(row["deviation"]) else f" ± {digits(row['deviation'])}"
        cell = f"{digits(row['predicted'], 3)} / {digits(row['truth'], 3)}{deviation}, {signed(error(row, rows, experiment))}"
        lines.setdefault((row["run"], f"{row['quantity']} [{row['unit']}]"), {})[row["at"]] = cell
    runs = len({run for run, _ in lines}) > 1
    head = ", by ".join(filter(None, ("predicted / found", experiment.get("points"))))
    body = [((run,) if runs else ()) + (what, *(cells.get(at, "") for at in points)) for (run, what), cells in lines.items()]
    return table((("run",) if runs else ()) + (head, *points), body)


@made_from("measurements")
def measurements_values(store):
    said = []
    for name, experiment in experiments():
        mine = list(compared(row for row in store.rows("measurements") if row["experiment"] == name))
        shown = [row for row in mine if row["run"] in experiment.get("compared_apart", [row["run"]])[:1] or
                 "compared_apart" not in experiment]
        said += [f"### {experiment['title']}", sentence(f"`{name}`. {experiment['source']}. {experiment.get('found', '')}".strip())]
        said += [values(shown, experiment)] if shown else []
    return "\n\n".join(said), [(row["experiment"], row) for row in store.rows("measurements")]
