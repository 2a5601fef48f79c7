"""The numbers of a session: one nested dictionary in SI units, and the flat row of a table. None: not defined."""

import math
import os
import re
import time

import numpy

from . import events
from .about import about_of
from .health import dropped_of, latency_of, solver_of, warnings_of

SKILL_SKIPPED = ("header", "organ_reference")
INFO_FIELDS = (
    "version", "state_version", "compiler", "c_library", "os", "processor", "cores", "instruction_set", "arithmetic",
    "scene_hash", "urdf_hash", "model_hash",
)  # fmt: skip
SET_STAGES = ("open", "tagged", "cinching", "cinched", "broken")
REGIONS = ("cardia", "fundus", "body", "antrum", "pylorus")
WALLS = ("anterior", "greater_curvature", "posterior", "lesser_curvature")
STATE_FIELDS = (
    "pressure", "volume", "marks", "burns", "deep_burns", "beam_energy", "thread_used", "bites", "partial_bites",
    "tear_outs", "sutures", "sutures_open", "sutures_cinched", "sutures_loose", "sutures_broken", "bleeding",
    "blood_lost",
)  # fmt: skip


def finite(value):
    """A number of a message as JSON can hold it; NaN says that the session does not define it."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def finite_all(value):
    if isinstance(value, dict):
        return {key: finite_all(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite_all(each) for each in value]
    return finite(value)


def numbers_of(recording):
    session = session_of(recording)
    numbers = {
        "file": recording.path,
        "session": session,
        "measures": measures_of(recording),
        "phases": phases_of(recording.skill),
        "sets": sets_of(recording.sutures),
        "events": counts_of(recording.events),
        "goals": goals_of(recording.progress),
        "solver": solver_of(recording),
        "latency": latency_of(recording),
        "dropped": dropped_of(recording),
        "warnings": warnings_of(recording),
    }
    return finite_all(numbers)


def session_of(recording):
    state, info = recording.state, recording.info
    values = {
        "scene": state.scene if state is not None else scene_name(recording.scene),
        "recorded": when(recording),
        "duration": recording.duration(),
        "time_source": "simulated" if recording.is_simulated_time else "wall",
        "driver": driver_of(recording),
        "skill": recording.progress.skill if recording.progress is not None else None,
        "seed": state.seed if state is not None else None,
        "steps": len(recording.steps),
        "step_period": state.step_period if state is not None else None,
        "recording": "all" if recording.has_all("tissue/particles") else "compact",
        "bytes": recording.size,
        "cut": bool(recording.cut_reason),
        **about_of(recording.path),
        "namespace": recording.namespace or "/",
        "identity": "{:016x}".format(recording.identity) if recording.identity else None,
    }
    for name in INFO_FIELDS:
        value = getattr(info, name, None) or None
        values[name] = "{:016x}".format(value) if value and name.endswith("_hash") else value
    return values


def scene_name(scene):
    match = re.search(r"^name:\s*(.+?)\s*$", scene, re.MULTILINE)
    return match.group(1) if match else ""


def when(recording):
    """Local time of the first step; of simulated time it is not known, so that of the file."""
    seconds = os.path.getmtime(recording.path) if recording.is_simulated_time else recording.begin / 1e9
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(seconds))


def driver_of(recording):
    """The nodes that sent inputs, by their names in the headers of the connections; rviz, which has another name each time,
    is who drives with its window: by the keyboard."""
    callers = {name.lstrip("/") for names in recording.callers.values() for name in names}
    names = sorted({re.sub(r"^(.*/)?rviz(_\d+)?$", r"\1keyboard", name) for name in callers})
    return ", ".join(names) or None


def measures_of(recording):
    values = {}
    if recording.skill is not None:
        for name, kind in zip(recording.skill.__slots__, recording.skill._slot_types):
            if name not in SKILL_SKIPPED and "[" not in kind:
                values[name] = finite(getattr(recording.skill, name))
        values["share_above"] = ratio(values["time_above"], values["time"])
        values["bites_off_body"] = values["bites_in_antrum"] + values["bites_in_fundus"]
    if recording.state is not None:
        values.update({name: finite(getattr(recording.state, name)) for name in STATE_FIELDS})
    path = recording.tip_path()
    values["recorded_path_length"] = way_of(path, recording.resets()) if len(path) > 1 else None
    curve = recording.force_curve()
    values["recorded_max_force"] = largest(curve[:, 1])
    values["bites_per_5_min"] = bites_per_five_minutes(recording.sutures)
    tagged = [s for s in recording.sutures.sutures if s.stage > 0] if recording.sutures is not None else []
    values["bites_per_set"] = ratio(sum(len(s.bites) for s in tagged), len(tagged))
    values["recorded_max_tension"] = recording.max_tension
    values.update(coverage_of(recording.skill))
    return values


def coverage_of(skill):
    """Shares of the wall that the lens has seen, by the names of the measures of vibe_core; none in a scene without
    inspection, and in recordings of releases that did not look."""
    if skill is None or finite(getattr(skill, "coverage", math.nan)) is None:
        return {}
    parts = zip(REGIONS + WALLS, [*skill.coverage_region, *skill.coverage_wall])
    return {"coverage." + name: finite(share) for name, share in parts}


def largest(values):
    known = values[numpy.isfinite(values)]
    return float(known.max()) if len(known) else None


def ratio(part, whole):
    return part / whole if part is not None and whole else None


def way_of(path, resets):
    """Length of a path with times, without its jumps at resets, each the longest step of those that end, or begin, there [m]."""
    times, steps = path[:, 0], numpy.linalg.norm(numpy.diff(path[:, 1:], axis=0), axis=1)
    for reset in resets:
        near = numpy.flatnonzero((times[:-1] <= reset + 1e-6) & (times[1:] >= reset - 1e-6))
        if len(near):
            steps[near[numpy.argmax(steps[near])]] = 0
    return float(steps.sum())


def path_length(points):
    """Length of the polygon through the points [m]."""
    return float(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1).sum())


def bites_per_five_minutes(sutures):
    """As the measure of vibe_core: from the first to the last bite of each set, with one bite less."""
    seconds = bites = 0
    for suture in sutures.sutures if sutures is not None else ():
        if len(suture.bites) > 1:
            seconds += suture.bites[-1].time - suture.bites[0].time
            bites += len(suture.bites) - 1
    return 300 * bites / seconds if seconds > 0 else None


def phases_of(skill):
    if skill is None:
        return []
    names = [name for name in skill.__slots__ if name.startswith("phase_")]
    return [
        {"phase": phase, **{name[len("phase_") :]: finite(getattr(skill, name)[k]) for name in names}}
        for k, phase in enumerate(events.PHASES)
    ]


def sets_of(sutures):
    return [set_of(k + 1, suture) for k, suture in enumerate(sutures.sutures)] if sutures is not None else []


def set_of(number, suture):
    bites = suture.bites
    spacing = path_length(numpy.array([[p.x, p.y, p.z] for p in suture.taken])) if len(suture.taken) > 1 else None
    stage = SET_STAGES[suture.stage] if suture.stage < len(SET_STAGES) else str(suture.stage)
    return {
        "set": number,
        "technique": suture.technique_name or None,
        "technique_margin": finite(suture.technique_margin) if suture.technique_name else None,
        "stage": "loose" if suture.loose else stage,
        "bites": len(bites),
        "full_thickness": sum(bite.full_thickness for bite in bites),
        "tear_outs": suture.tear_outs,
        "along": sum(bite.along for bite in bites) / len(bites) if bites else None,
        "spacing_mean": ratio(spacing, len(suture.taken) - 1),
        "depth_mean": sum(bite.depth for bite in bites) / len(bites) if bites else None,
        "thread_length": sum(suture.length),
        "thread_drawn": suture.pulled,
        "cinch_tension": suture.cinch_tension or None,
        "tension": max(suture.tension, default=0.0),
        "time": suture.end - suture.begin if suture.end > 0 else None,
    }


def counts_of(all_events):
    counts = {}
    for _, kind, _, _, _ in all_events:
        counts[events.name_of(kind)] = counts.get(events.name_of(kind), 0) + 1
    return dict(sorted(counts.items()))


def goals_of(progress):
    if progress is None:
        return {"given": None, "reached": None, "failed": None}
    states = [goal.state for goal in progress.goals]
    return {"given": len(states), "reached": states.count(2), "failed": states.count(3)}


def row_of(numbers, name="", group=""):
    """The flat row of sessions.csv."""
    row = {"name": name, "group": group, "file": numbers["file"]}
    row.update(numbers["session"])
    row.update(numbers["measures"])
    for phase in numbers["phases"]:
        for key in ("time", "path_length", "max_force"):
            row["{}_{}".format(phase["phase"], key)] = phase[key]
    for part in ("goals", "solver", "dropped"):
        flat = {key: value for key, value in numbers[part].items() if not isinstance(value, (dict, list))}
        row.update({"{}_{}".format(part, key): value for key, value in flat.items()})
    row["input_delay_p50"] = max((each["p50"] for each in numbers["latency"].values()), default=None)
    row["input_delay_p99"] = max((each["p99"] for each in numbers["latency"].values()), default=None)
    row["warning_count"] = len(numbers["warnings"])
    return row
