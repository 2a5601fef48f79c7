"""Tables of errors and times of steps: against finite elements, in motion, in contact."""

from measured_store import number
from measured_tables import made_from
from measured_text import digits, percent, percents, sentence, table, whole

CASES = {
    "beam_mode": "beam of 14,080 linear tetrahedra: first frequency",
    "beam_release": "the same, released, 60 Hz, 4 iterations",
    "beam_settling": "the same under its weight, 200 frames",
    "beam_static": "the same, static, against a direct Newton method",
    "case1_uniaxial_mm": "block stretched, Mooney-Rivlin",
    "case1_uniaxial_nh": "block stretched, neo-Hookean",
    "case1_uniaxial_snh": "block stretched, stable neo-Hookean",
    "case2_cantilever": "cantilever bent far",
    "case3_twist": "beam twisted",
    "case4_sphere": "sphere inflated, against the closed form",
    "case5_inflation": "prolate wall inflated, 100 to 1,200 Pa",
    "case5_limit": "the same, beyond its limit",
    "case6_bite": "plate pulled at a gripped disc, 10 to 30 mm",
    "case6_bite_refined": "the same, mesh refined once",
    "case7_cinch": "two points of a plate pulled together, to 30, 20, 10 mm",
    "case7_cinch_fine": "the same, finer mesh",
    "case8a_modes": "clamped beam, first five frequencies",
    "case8a_release": "the same, released, undamped",
    "case8c_plate_release": "circular plate released, first 0.1 s",
}
HARD = {  # a stem that ends with _ stands before a speed or seed
    "ram_": "scope rams the wall by 60 mm, m/s: ",
    "random_": "joints driven at random for 30 s, seed ",
    "jump_": "wound in and holding, joints sent from limit to limit every 0.2 s for 20 s, seed ",
    "wind": "helix wound 20 turns in a fold, pulled 60 mm",
    "across": "cinch to 5 mm at 8 N across the lumen",
    "desufflate": "insufflator off while sutured",
    "sets_20": "twenty sets",
    "over_set": "a set over another",
    "pressure": "5 to 45 to 5 mmHg in steps of 1 s",
    "sleeve": "scope withdrawn through a cinched sleeve",
    "8x7": "8 sets of 7 bites",
    "14x4": "14 sets of 4 bites",
}
ERRORS = ("motion_error", "motion_error_end", "force_error", "force_error_end")
RATES = ("60", "120", "240")


@made_from("fem")
def fem(store):
    cases = {}
    for row in store.rows("fem"):
        cases.setdefault(row["case"], []).append(row)
    lines = []
    for name, rows in cases.items():
        errors = [row["setting"].replace("_", " ") + " " + percent(row["reference_error"]) for row in rows]
        elements = rows[0]["method"].replace("_tet", " tetrahedra")
        lines.append((CASES.get(name, name), f"`{name}`", elements, whole(rows[0]["particles"]), ", ".join(errors)))
    return table(("case", "file", "elements", "nodes", "largest error"), lines), [
        (f"`{row['case']}`", row) for row in store.rows("fem")
    ]


def motion_rows(store, *cases):
    return [row for row in store.rows("motion") if row["case"].startswith(cases)]


@made_from("motion")
def motion(store):
    rows, lines = motion_rows(store, "pull_20mm"), []
    for row in rows:
        method = "shape matching, " if row["method"] == "shape_matching" else ""
        errors = percents(row, ("motion_error", "static_error", "force_error"))
        lines.append((method + row["setting"], digits(row["ms_p50"]), *errors))
    return table(("setting", "ms per step", "motion", "static, 0.5 s after the stop", "force"), lines), [
        (row["setting"], row) for row in rows
    ]


@made_from("motion")
def long_pulls(store):
    rows = motion_rows(store, "pull_30mm", "pull_40mm", "pull_50mm")
    place, force = (percent(max(number(row[column]) for row in rows)) for column in ("static_error", "force_error"))
    text = "Pulls of 30, 40 and 50 mm, in 0.5 s and in one frame, with 2 and 3 iterations: 1.5 s after the stop the "
    text += f"error of the position is {place} at most, that of the force {force}."
    return sentence(text), [("", row) for row in rows]


@made_from("motion")
def growth(store):
    factors = {row["particles"]: row["ms_p50"] for row in motion_rows(store, "growth_factor")}
    rows = [row for row in motion_rows(store, "growth") if row["case"] == "growth"]
    lines = []
    for row in rows:
        count, time = row["particles"], row["ms_p50"]
        lines.append((whole(count), digits(time), digits(1e3 * number(time) / number(count)), digits(factors[count])))
    header = ("particles", "ms per step", "µs per particle and step", "stiffness and factor, in the background, ms")
    return table(header, lines), [("", row) for row in rows]


@made_from("pulling")
def pulling(store):
    ways, lines = {}, []
    for row in store.rows("pulling"):
        ways.setdefault((row["method"].replace("_", " "), row["setting"]), []).append(row)
    for way, rows in ways.items():
        levels = [row for row in rows if row["case"].startswith("bites")]
        ends = [row["case"].split("_") for row in rows if row["case"].startswith("end")]
        errors = (", ".join(percent(row[column]) for row in levels) for column in ("motion_error", "force_error"))
        lines.append((*way, *errors, digits(rows[0]["ms_p50"]), *(f"{end[1]} mm, {end[3]} N" for end in ends or ())))
        lines[-1] += ("",) * (6 - len(lines[-1]))
    header = ("wall", "pulled by", "displacement field", "tension", "ms per frame", "final distance and tension")
    return table(header, lines), [("", row) for row in store.rows("pulling")]


@made_from("guard")
def guard(store):
    rows = [row for row in store.rows("guard") if row["state"]]
    lines = [(f"`{row['state']}`", digits(row["iterations_mean"]), *percents(row, ERRORS)) for row in rows]
    return table(("900 particles, 60 Hz", "iterations", "motion", "at end", "force", "at end"), lines), [
        ("", row) for row in rows
    ]


def state_rows(store):
    """{label: {rate: row}} of the states; the free pull that every run makes counts in its own only."""
    found = {}
    for row in store.rows("states"):
        rigid = row["part"] == "pressed_rigid" and row["state"] == "pressed"
        if rigid or row["part"] == row["state"]:
            label = f"`{row['state']}`" + (", rigid scope" if rigid else "")
            found.setdefault(label, {})[row["rate"]] = row
    return found


def times(row, *columns):
    return ", ".join(digits(row[column]) for column in columns)


@made_from("states")
def states(store):
    rows, lines = [(label, rates["60"]) for label, rates in state_rows(store).items()], []
    for label, row in rows:
        touching = [f", {row[name]} {word}" for name, word in (("contacts", "contacts"), ("pairs", "pairs of walls"))
                    if number(row[name]) > 0]  # fmt: skip
        lines.append((label + "".join(touching[:1]), times(row, "ms_p50", "ms_p99"), digits(row["ratio_to_free"]),
                      digits(row["iterations_mean"]), row["fallback_steps"], *percents(row, ERRORS)))  # fmt: skip
    header = ("state", "p50, p99 ms", "x", "iterations", "fallback steps", "motion", "at end", "force", "at end")
    return table(header, lines), rows


@made_from("states")
def states_by_rate(store):
    found = {label: rates for label, rates in state_rows(store).items() if set(RATES) <= set(rates)}
    lines = []
    for label, rates in found.items():
        errors = (percent(rates[rate][column]) for column in ("motion_error", "force_error") for rate in RATES)
        lines.append((label, *errors))
    header = ("state", *(f"{what}, {rate} Hz" for what in ("motion", "force") for rate in RATES))
    return table(header, lines), [(label, rates[rate]) for label, rates in found.items() for rate in RATES]


@made_from("states")
def steps_1_ms(store):
    particles = {"steps_1_ms": "3,618", "steps_1_ms_small": "1,000"}
    rows = [(f"`{row['state']}`, {particles[row['part']]} particles", row)
            for row in store.rows("states") if row["part"] in particles]
    lines = [(label, digits(row["ms_mean"]), times(row, "ms_p50", "ms_p99"), digits(row["iterations_mean"]))
             for label, row in rows]
    return table(("state, 1,020 Hz, 1 iteration", "mean", "p50, p99 ms", "iterations"), lines), rows


@made_from("ways")
def ways(store):
    """Steps of 1,000 that take each way, and in brackets their evaluations over those of all steps of the case."""
    rows = store.rows("ways")
    cases, words = (list(dict.fromkeys(row[name] for row in rows)) for name in ("case", "way"))
    found = {(row["case"], row["way"]): row for row in rows}

    def cell(case, word):
        row = found.get((case, word))
        if row is None:
            return ""
        cost = number(row["evaluations"]) / number(row["evaluations_of_all"])
        return "{} ({})".format(digits(1000 * number(row["taken"]) / number(row["steps"])), digits(cost))

    lines = [(word, *(cell(case, word) for case in cases)) for word in words]
    return table(("of 1,000 steps", *(f"`{case}`" for case in cases)), lines), [(f"`{row['case']}`", row) for row in rows]


@made_from("rest")
def rest(store):
    """Of each mesh and organ: how many poses rest, creep, tremble, and those that move most."""
    parts, lines = {}, []
    for row in store.rows("rest"):
        parts.setdefault(row["part"], []).append(row)
    for part, rows in parts.items():
        organ = "shipped" if part.isdigit() else "0.8 mm thick" if part == "thin" else f"`{part}`"
        moving = sorted((row for row in rows if row["wall"] == "trembles"), key=lambda row: -number(row["motion_mm"]))
        worst = ["{} mm at {} N{}".format(digits(row["motion_mm"]), digits(row["force_N"]), "" if row["period_steps"] in "01"
                 else ", every {} steps".format(row["period_steps"])) for row in moving[:3]]  # fmt: skip
        counts = (sum(row["wall"] == word for row in rows) for word in ("rests", "creeps", "trembles"))
        lines.append((organ, whole(rows[0]["particles"]), str(len(rows)), *map(str, counts), "; ".join(worst)))
    header = ("organ", "particles", "poses", "rest", "creep", "tremble", "those that tremble most")
    return table(header, lines), [
        (f"{whole(part)} particles" if part.isdigit() else "thin" if part == "thin" else f"`{part}`", rows[0]) for part, rows in parts.items()
    ]


@made_from("threads")
def threads(store):
    """Of a state the row with one thread of the first part; ratios are those within a part, which is one run."""
    rows = store.rows("threads")
    alone = {(row["part"], row["state"]): row for row in reversed(rows) if row["threads"] == "1"}
    lines, shown = [], []
    for state in dict.fromkeys(row["state"] for row in rows):
        found = [row for row in rows if row["state"] == state]
        for row in (found[0], *(row for row in found if row["threads"] != "1")):
            ratio = number(row["ms_wall_mean"]) / number(alone[row["part"], state]["ms_wall_mean"])
            lines.append((f"`{state}`", row["threads"], digits(row["ms_wall_mean"]), digits(ratio),
                          times(row, "ms_wall_p50", "ms_wall_p99"), *(digits(row[c]) for c in ("ms_mean", "ms_all_threads"))))
            shown.append((row["part"], row))
    header = ("state", "threads", "wall time, mean, ms", "of one thread", "p50, p99 ms", "CPU of the stepping thread, ms",
              "CPU of all, ms")  # fmt: skip
    return table(header, lines), shown


@made_from("instructions")
def instructions(store):
    rows = store.rows("instructions")
    parts = ("step", "energy", "inverse", "rows", "paths", "walls", "loads", "factor")
    lines = [(f"`{row['state']}`", row["steps"], *(f"{number(row[part]):.2f}" for part in parts)) for row in rows]
    header = ("state", "steps", "all", "energy", "inverse", "of it rows", "paths", "walls", "loads", "factor")
    return table(header, lines), [(f"`{row['state']}`", row) for row in rows]


@made_from("refinement")
def refinement(store):
    rows, forces = store.rows("refinement"), {}
    for row in rows:
        forces.setdefault(row["grip"], {}).setdefault(whole(row["particles"]), []).append(number(row["force_N"]))
    lines = [(grip, *(digits(sum(at) / len(at), 3) + " N" for at in found.values())) for grip, found in forces.items()]
    return table(("", *next(iter(forces.values()))), lines), [(whole(row["particles"]), row) for row in rows]


def hard_name(case):
    stem = next((stem for stem in HARD if stem.endswith("_") and case.startswith(stem)), case)
    return HARD.get(stem, case) + case[len(stem):]


@made_from("hard")
def hard(store):
    lines = []
    for row in store.rows("hard"):
        events = [f"{row[name]} {word}" for name, word in (("slips", "slips"), ("tear_outs", "torn out"),
                  ("breaks", "threads broken"), ("recoveries", "recoveries")) if number(row[name]) > 0]  # fmt: skip
        forces = [f"{what} {digits(row[what + '_N'])} N" for what in ("tool", "grip", "thread")
                  if number(row[what + "_N"]) > 0]  # fmt: skip
        end = f"{digits(row['away_mm'])} mm away, {digits(row['speed_mm_s'])} mm/s"
        lines.append((hard_name(row["case"]), times(row, "ms_p50", "ms_p99", "ms_max"), ", ".join(forces),
                      f"{row['crossed_steps']}, {row['pierced']}", ", ".join(events),
                      percent(number(row["balance_J"]) / number(row["work_J"])),
                      end if row["returns"] == "1" else "sutured"))  # fmt: skip
    header = ("case", "p50, p99, max ms", "largest force", "steps that end crossed, triangles pierced", "events",
              "energy balance, of the work", "at the end")  # fmt: skip
    return table(header, lines), [(hard_name(row["case"]), row) for row in store.rows("hard")]
