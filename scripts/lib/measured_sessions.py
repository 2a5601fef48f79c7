"""Tables of whole procedures: sets of sutures, outcomes, the sleeve on all organs, sessions."""

import os

from measured_sections import SESSION_TEXT
from measured_store import number
from measured_tables import made_from
from measured_text import code, digits, percent, signed, span, table, whole

ORGANS = {
    "stomach": "default",
    "stomach_small": "`stomach_small`, 0.85 times the size",
    "stomach_large": "`stomach_large`, 1.15 times the size",
}
POPULATION = "population_"
PLANNED_SETS = 6  # of trainees/expert.yaml
CHANGES = {
    "as_cinched": "nothing",
    "sewn_empty": "sewn and cinched in the empty stomach (1 mmHg), then 15 mmHg",
    "same_thread": "35 mm of thread drawn in every set",
    "no_friction": "thread without friction",
    "no_foundation": "no foundation",
}


def by_part(store, section):
    return {row["part"]: row for row in store.rows(section)}


@made_from("scenarios")
def scenarios(store):
    rows, lines = store.rows("scenarios"), []
    for name in dict.fromkeys(row["scenario"] for row in rows):
        of = {column: [number(row[column]) for row in rows if row["scenario"] == name] for column in rows[0]}
        sets, bites = name.split("x")
        lines.append((f"{sets} sets of {bites}", *(span(of["pulling_" + what]) for what in ("mean", "p50", "p99")),
                      digits(max(of["pulling_max"])), span(of["after_mean"]), span(of["tension"]) + " N",
                      ", ".join(whole(sum(of[what])) for what in ("torn_out", "broken", "recoveries"))))  # fmt: skip
    header = ("scenario", "while pulling, mean of a set, ms", "p50", "p99", "max", "mean of the second after",
              "tension", "torn out, threads broken, recoveries")  # fmt: skip
    return table(header, lines), [("", row) for row in rows]


def outcome_rows(store, trials):
    return [row for row in store.rows("outcomes") if row["trial"] in trials]


def changes(row, *columns):
    return [signed(number(row[column]) / number(row[column + "_before"]) - 1) for column in columns]


@made_from("outcomes")
def outcomes(store):
    rows = outcome_rows(store, ("as_cinched", "fine_mesh"))
    first = rows[0]
    before = (whole(1e6 * number(first["volume_before"])) + " mL", "", "", "", percent(first["strain_before"], 3),
              digits(1e-3 * number(first["stress_before"]), 3), "", "", "")  # fmt: skip
    lines = [("before", *before)]
    for row in rows:
        mesh = f", {whole(row['particles'])} particles" if row["trial"] == "fine_mesh" else ""
        stress, drawn = digits(1e-3 * number(row["stress"]), 3), digits(1e3 * number(row["drawn"]), 3)
        lines.append((row["pattern"].upper() + mesh, *changes(row, "volume", "area", "length", "curvature"),
                      percent(row["strain"], 3), stress, digits(row["mean_tension"]) + " N",
                      drawn + " mm", f"{row['recognised']}, {row['torn_out']}, {row['crossed']}"))  # fmt: skip
    header = ("15 mmHg, cinched with 3 N", "volume", "mean area of the body", "length of the axis", "greater curvature",
              "mean strain", "mean stress, kPa", "force", "thread drawn", "sets recognised, torn out, crossed")
    return table(header, lines), [("", row) for row in rows]


@made_from("outcomes")
def outcomes_changed(store):
    rows, lines = outcome_rows(store, CHANGES), []
    for trial, name in CHANGES.items():
        found = sorted((row for row in rows if row["trial"] == trial), key=lambda row: row["pattern"])
        lengths = ", ".join(changes(row, "length")[0] for row in found)
        lines += [(name, *(changes(row, "volume")[0] for row in found), lengths)] if len(found) == 3 else []
    return table(("changed", "C: volume at 15 mmHg", "U", "Z", "length of the axis: C, U, Z"), lines), [
        ("", row) for row in rows
    ]


@made_from("outcomes")
def outcomes_area(store):
    names = {"tight": "3 N", "loose": "0.9 N, the tightness of a novice"}
    rows = outcome_rows(store, names)
    lines = [(names[row["trial"]], *changes(row, "area", "least_area", "volume"), digits(row["mean_tension"]) + " N",
              digits(1e3 * number(row["drawn"]), 3) + " mm") for row in rows]  # fmt: skip
    header = ("cinched with", "mean area of the body", "min area", "volume", "force", "thread drawn")
    return table(header, lines), [("", row) for row in rows]


def organ_name(row):
    name = row["part"]
    if name.startswith(POPULATION):
        seed, number = ["1", *name.split("_")[1:]][-2:]
        return f"population of seed {seed}, number {number}, {whole(row['particles'])} particles"
    return ORGANS.get(name, f"`{name}`")


def set_times(row):
    return f"{whole(row['set_s_least'])} to {whole(row['set_s_most'])} s"


def bites(row):
    return f"{row['bites']}, {row['bites_full_thickness']}, {row['tear_outs']}"


@made_from("organs")
def organs(store):
    rows = store.rows("organs")
    lines = [(organ_name(row), f"{row['sets_as_planned']} of {PLANNED_SETS}", bites(row), row["slips"],
              digits(row["max_force"]) + " N", set_times(row), signed(-number(row["area_reduction"])),
              ", ".join(digits(row[column]) + " J" for column in ("correction_work", "thread_work") if row[column]))
             for row in rows]  # fmt: skip
    header = ("organ", "sets as planned", "bites, of full thickness, torn out", "slips", "max force", "time of a set",
              "area of the body", "work of corrections, of threads")  # fmt: skip
    return table(header, lines), [(organ_name(row), row) for row in rows]


@made_from("organs")
def sleeve(store):
    row = by_part(store, "organs")["stomach"]
    reductions = ", ".join(percent(row[what + "_reduction"], 3) for what in ("area", "volume", "length"))
    pace = f"{digits(row['bites_per_5_min'])} bites in 5 minutes of suturing (experienced: 13.1 ± 5.2)"
    lines = (
        ("sets as planned", f"{row['sets_as_planned']} of {PLANNED_SETS}"),
        ("bites taken, of full thickness, torn out", bites(row)),
        ("max force on the tool", digits(row["max_force"]) + " N"),
        ("time of a set", f"{set_times(row)}, {pace}"),
        ("area of the body, volume, length", f"reduced by {reductions} (area of an expert's: 34.6 %)"),
        ("time", f"{whole(row['time'])} s of simulated time"),
    )
    return table(("six sets of seven bites", ""), lines), [("", row)]


@made_from("sessions")
def first_session(store):
    with open(os.path.join(store.folder, SESSION_TEXT), encoding="utf-8") as text:
        return code(text.read()), [("", by_part(store, "sessions")["first"])]


@made_from("sessions")
def replayed(store):
    row = by_part(store, "sessions")["first"]
    same = f"the same: all {row['steps']} steps have the recorded input and the recorded state"
    begin = f"repeated {row['steps']} steps, {number(row['time']):.2f} s"
    return code(f"{begin}\n...\nstate hash: {row['state_hash']}\n{same}"), []


@made_from("sessions")
def speed(store):
    sessions = by_part(store, "sessions")
    found = (
        ("sleeve", "a sleeve of six sets", by_part(store, "organs").get("stomach")),
        ("first session", "the first session, one set", sessions.get("first")),
        ("grabs", "`demo/grabs.yaml`, one minute, with self-contact", sessions.get("grabs")),
        ("shape matching", "the same with `shape_matching`", sessions.get("grabs_shape_matching")),
    )
    lines = [(what, whole(row["particles"]), *(digits(row[column]) + " ms" for column in ("ms_p50", "ms_p99")))
             for _, what, row in found if row]  # fmt: skip
    lines.append(("Erden et al., Intel i7-12700KF: tissue is pulled", "3,618", "16 to 18 ms", "not stated"))
    return table(("what", "particles", "p50", "p99"), lines), [(label, row) for label, _, row in found if row]


@made_from("fine")
def fine(store):
    rows = store.rows("fine")
    lines = [(row["part"].split("_")[1], *(digits(row[column]) + " ms" for column in ("ms_p50", "ms_p99")),
              row["real_time_factor"], digits(row["cpu_s"]) + " s") for row in rows]  # fmt: skip
    return table(("threads", "p50", "p99", "real-time factor", "processor time in all"), lines), [("", row) for row in rows]
