"""The tables of the pages: numbers as people read them, with their units."""

import dataclasses
import statistics

from .references import REFERENCES, verdict

DASH = "–"
# stages of a step as people read them (vibe_msgs/StepTiming)
STAGES = {
    "loads": "touching tool, grip, threads, gas",
    "factor": "new factor and columns",
    "energy": "energy and gradient",
    "inverse": "directions",
    "rows": "forces of contacts and threads",
    "paths": "whether anything has gone through",
    "walls": "walls that have come near",
    "other": "all else",
}
# heading, key of the row, from SI to the unit shown, digits (None: text)
INDEX_COLUMNS = (
    ("session", "name", 1, None),
    ("group", "group", 1, None),
    ("scene", "scene", 1, None),
    ("recorded", "recorded", 1, None),
    ("person", "person", 1, None),
    ("driver", "driver", 1, None),
    ("time [s]", "time", 1, 0),
    ("sets", "sutures", 1, 0),
    ("bites", "bites", 1, 0),
    ("full thickness [%]", "full_thickness_share", 100, 0),
    ("area reduced [%]", "area_reduction", 100, 1),
    ("path [m]", "path_length", 1, 2),
    ("SPARC", "spectral_arc_length", 1, 2),
    ("max force [N]", "max_force", 1, 2),
    ("> 5 N [s]", "time_above", 1, 1),
    ("blood [mL]", "blood_lost", 1e6, 1),
    ("warnings", "warning_count", 1, 0),
)
# the same without headings, which are in the template
PHASE_COLUMNS = (
    ("phase", 1, None), ("time", 1, 1), ("path_length", 1, 3), ("log_dimensionless_jerk", 1, 2),
    ("spectral_arc_length", 1, 2), ("submovements", 1, 0), ("economy", 1, 2), ("max_force", 1, 2), ("mean_force", 1, 2),
    ("time_above", 1, 2),
)  # fmt: skip
SET_COLUMNS = (
    ("set", 1, None), ("technique", 1, None), ("technique_margin", 1, 2), ("bites", 1, None), ("full_thickness", 1, None),
    ("tear_outs", 1, None), ("along", 1, 2), ("spacing_mean", 1e3, 1), ("depth_mean", 1e3, 1), ("thread_length", 1e3, 1),
    ("thread_drawn", 1e3, 1), ("cinch_tension", 1, 2), ("tension", 1, 2), ("time", 1, 1), ("stage", 1, None),
)  # fmt: skip
# and with the words of the row first and the unit last; the stages of a step follow the first three
SOLVER_ROWS = (
    ("CPU time of a step, p50", "step_p50", 1e3, 2, "ms"),
    ("CPU time of a step, p99", "step_p99", 1e3, 2, "ms"),
    ("CPU time of a step, max", "step_max", 1e3, 2, "ms"),
    ("wall time of a step with messages, p50", "total_p50", 1e3, 2, "ms"),
    ("wall time of a step with messages, p99", "total_p99", 1e3, 2, "ms"),
    ("wall time of a step with messages, max", "total_max", 1e3, 2, "ms"),
    ("real-time factor", "real_time_factor", 1, 2, ""),
    ("missed deadlines", "missed_deadlines", 1, None, ""),
    ("steps that ended at the limit of their work", "unfinished_steps", 1, None, ""),
    ("residual, max", "residual", 1e6, 2, "µm"),
    ("particles", "particles", 1, None, ""),
)
# what is drawn and summed up by group
MAIN_MEASURES = (
    ("time [s]", "time", 1, 0),
    ("bites in 5 min of suturing", "bites_per_5_min", 1, 1),
    ("area reduced by [%]", "area_reduction", 100, 1),
    ("bites of full thickness [%]", "full_thickness_share", 100, 0),
    ("path of the tip [m]", "path_length", 1, 2),
    ("smoothness, SPARC", "spectral_arc_length", 1, 2),
    ("smoothness, LDLJ", "log_dimensionless_jerk", 1, 1),
    ("max force on the tool [N]", "max_force", 1, 2),
    ("blood lost [mL]", "blood_lost", 1e6, 1),
)


def shown(value, scale=1.0, digits=None):
    """A value as text: a dash if it is not defined, thousands apart, a real minus sign."""
    if value is None or value == "":
        return DASH
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str) or (digits is None and isinstance(value, int)):
        return str(value)
    text = "{:,.{}f}".format(value * scale, digits if digits is not None else 3).replace(",", "\u202f")
    return text.replace("-", "\u2212") if any(c in "123456789" for c in text) else text.replace("-", "")


def facts(numbers):
    """What, when, who, on what: pairs of words and text; nothing about what an older recording does not say."""
    session = numbers["session"]
    who = session["driver"] or ""
    if session["skill"]:
        who = "{} (skill: {})".format(who, session["skill"]).strip()
    machine = ", ".join(
        str(part) for part in (session["processor"], session["cores"] and "{} cores".format(session["cores"])) if part
    )
    build = ", ".join(str(session[key]) for key in ("compiler", "c_library", "os") if session[key])
    arithmetic = ", ".join(str(session[key]) for key in ("instruction_set", "arithmetic") if session[key])
    when = session["recorded"] + (" (time of the file)" if session["time_source"] == "simulated" else "")
    found = [
        ("Scene", session["scene"]),
        ("Recorded", when),
        ("Person", session["person"]),
        ("Notes", session["notes"]),
        ("Driven by", who),
        ("Length", "{} s, {} steps".format(shown(session["duration"], 1, 2), session["steps"])),
        ("Time", session["time_source"] + (", seed {}".format(session["seed"]) if session["seed"] is not None else "")),
        ("Recording", "{}, {} MB".format(session["recording"], shown(session["bytes"], 1e-6, 1))),
        ("Software", session["version"]),
        ("Machine", machine),
        ("Built with", build),
        ("Arithmetic", arithmetic),
        ("State hash", numbers["solver"].get("state_hash")),
        ("File", numbers["file"]),
    ]
    return [(word, text) for word, text in found if text]


def tiles(numbers):
    """The headline: (value, unit, words, whether it deserves attention)."""
    measures, goals = numbers["measures"], numbers["goals"]
    get = measures.get
    mistakes = sum(get(key) or 0 for key in ("slips", "tear_outs", "broken_threads", "missed_bites"))
    found = [
        (shown(get("time") or numbers["session"]["duration"], 1, 0), "s", "simulated time", False),
        (shown(get("sutures")), "", "suture sets", False),
        (shown(get("bites")), "", "bites", False),
        (shown(get("full_thickness_share"), 100, 0), "%", "of full thickness", False),
        (shown(get("area_reduction"), 100, 1), "%", "area of the body reduced", False),
        (shown(get("max_force"), 1, 2), "N", "max force on the tool", (get("max_force") or 0) > 8),
        (shown(get("blood_lost"), 1e6, 1), "mL", "blood lost", bool(get("overdue_bleedings"))),
        (shown(mistakes), "", "slips, misses, tears", mistakes > 0),
    ]
    if get("coverage") is not None:
        found.insert(1, (shown(get("coverage"), 100, 1), "%", "of the wall seen", False))
    if goals["given"]:
        failed = goals["failed"] > 0
        found.insert(1, ("{} / {}".format(goals["reached"], goals["given"]), "", "goals reached", failed))
    return found


def reference_rows(numbers):
    rows = []
    for reference in REFERENCES:
        value = numbers["measures"].get(reference.measure)
        scaled = value * reference.scale if value is not None else None
        words = {"value": shown(scaled, 1, reference.digits), "verdict": verdict(reference, scaled)}
        rows.append({**dataclasses.asdict(reference), **words})
    return rows


def coverage_rows(numbers):
    """(part of the wall, share that was seen), the least seen first."""
    prefix = "coverage."
    shares = {name[len(prefix) :]: share for name, share in numbers["measures"].items() if name.startswith(prefix) and share is not None}
    return [(name.replace("_", " "), shown(shares[name], 100, 1)) for name in sorted(shares, key=shares.get)]


def cells(row, columns):
    return [shown(row.get(key), scale, digits) for key, scale, digits in columns]


def phase_rows(numbers):
    whole = {"phase": "whole", **numbers["measures"]}
    return [cells(phase, PHASE_COLUMNS) for phase in numbers["phases"] + ([whole] if numbers["phases"] else [])]


def set_rows(numbers):
    return [cells(each, SET_COLUMNS) for each in numbers["sets"]]


def solver_rows(numbers):
    solver = numbers["solver"]
    rows = [(words, shown(solver.get(key), scale, digits), unit) for words, key, scale, digits, unit in SOLVER_ROWS]
    return rows[:3] + stage_rows(solver["stages"]) + rows[3:]


def stage_rows(stages):
    """The dearest stage first."""
    dearest = sorted(stages, key=lambda name: -stages[name]["time_p50"])
    return [
        (
            "of it " + STAGES.get(name, name) + ", p50, p99",
            " ".join(shown(stages[name][key], 1e3, 2) for key in ("time_p50", "time_p99")),
            "ms",
        )
        for name in dearest
    ]


def latency_rows(numbers):
    return [
        (topic, shown(each["messages"]), *(shown(each[key], 1e3, 1) for key in ("p50", "p99", "max")))
        for topic, each in numbers["latency"].items()
    ]


def dropped_rows(numbers):
    """(words, value, whether it is trouble)."""
    dropped = numbers["dropped"]
    no_hash = dropped["steps_without_hash"]
    rows = [
        ("steps missing in applied_input", shown(dropped["missing_steps"]), dropped["missing_steps"] > 0),
        ("resets, loaded states", shown(dropped["restarts"]), False),
        ("first step", shown(dropped["first_step"]), dropped["first_step"] > 0),
        (
            "steps without a hash of the state",
            shown(no_hash) if no_hash is not None else "all (the recording has none per step)",
            bool(no_hash),
        ),
        ("input messages lost on the way to the recorder", shown(dropped["lost_inputs"]), dropped["lost_inputs"] > 0),
    ]
    rows += [("lost on " + topic, shown(count), True) for topic, count in dropped["lost_inputs_by_topic"].items()]
    if dropped["frames"]:
        rows.append(("camera frames received", shown(dropped["frames"]), False))
        rows.append(("camera frames lost", shown(dropped["lost_frames"]), dropped["lost_frames"] > 0))
    rows += [(name, shown(count), True) for name, count in dropped["diagnostics"].items()]
    rows += [(topic + ", thinned", shown(rate, 1, 1) + " per second", False) for topic, rate in dropped["thinned"].items()]
    return rows


def all_numbers(numbers):
    """(name, value) of all measures and event counts, in SI units."""
    found = [(name, shown(value, 1, 6)) for name, value in sorted(numbers["measures"].items())]
    return found + [("events: " + name, shown(count)) for name, count in numbers["events"].items()]


def index_columns(rows):
    """Those in which any session has something."""
    return [column for column in INDEX_COLUMNS if any(row.get(column[1]) not in (None, "") for row in rows)]


def index_rows(rows):
    columns = index_columns(rows)
    return [
        {
            "link": row.get("page", ""),
            "cells": [(shown(row.get(key), scale, digits), sort_key(row.get(key))) for _, key, scale, digits in columns],
        }
        for row in rows
    ]


def sort_key(value):
    return "" if value is None else value


def group_summary(rows):
    """Rows of the table of groups: group, sessions, then mean and standard deviation of each main measure."""
    names = sorted({row["group"] for row in rows})
    return [
        (name or "all", str(sum(row["group"] == name for row in rows)))
        + tuple(mean_text(rows, name, *measure[1:]) for measure in MAIN_MEASURES)
        for name in names
    ]


def mean_text(rows, group, key, scale, digits):
    values = values_of(rows, group, key, scale)
    if not values:
        return DASH
    text = shown(statistics.fmean(values), 1, digits)
    return text + " ± " + shown(statistics.stdev(values), 1, digits) if len(values) > 1 else text


def values_of(rows, group, key, scale):
    return [row[key] * scale for row in rows if row["group"] == group and row.get(key) is not None]


