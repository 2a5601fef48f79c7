"""How well the session ran and was recorded: solver times, delays of inputs, what is missing, warnings."""

import numpy

from . import events

THINNED = ("scope/measured_cp", "scope/measured_cf", "joint_states", "step_result", "tissue/particles")
TROUBLE = ("lost", "dropped", "duplicated", "reordered", "malformed", "implausible", "incomplete", "unreadable",
           "disorder", "late", "reconnects", "restarts", "refused", "failed", "differently", "without valid")  # fmt: skip
MOST_WARNINGS = 50


def solver_of(recording):
    """Of the whole session. Its last message is about the whole if the session ended by itself; otherwise medians and
    99th percentiles are means over the windows of a second."""
    windows = recording.windows
    if not windows:
        return {"whole": None, "step_p50": None, "step_p99": None, "step_max": None, "stages": {}}
    seconds = [each.window for each in windows]
    # windows are of one second; that of the whole session is as long as all of them
    is_whole = len(windows) > 1 and seconds[-1] > (0.95 if len(windows) > 2 else 1.2) * sum(seconds[:-1])
    parts = windows[-1:] if is_whole else windows
    values = {"whole": is_whole}
    for stage, name in (("solver", "step"), ("total", "total")):
        values.update(stage_times(parts, stage, name))
    values["stages"] = solver_stages(parts)
    length = sum(each.window for each in parts)
    values["real_time_factor"] = (
        sum(each.window * each.real_time_factor for each in parts) / length if length > 0 else None
    )
    values["missed_deadlines"] = sum(each.missed_deadlines for each in parts)
    values["unfinished_steps"] = sum(each.unfinished_steps for each in parts)
    values["residual"] = max(each.residual for each in parts)
    values["particles"] = windows[-1].particle_count
    values["state_hash"] = windows[-1].state_hash
    return values


def stage_times(windows, stage, name):
    """Seconds."""
    found = [each for window in windows for each in window.stages if each.name == stage and each.max > 0]
    if not found:
        return {name + "_p50": None, name + "_p99": None, name + "_max": None}
    return {
        name + "_p50": 1e-3 * float(numpy.median([each.p50 for each in found])),
        name + "_p99": 1e-3 * float(numpy.mean([each.p99 for each in found])),
        name + "_max": 1e-3 * max(each.max for each in found),
    }


def solver_stages(windows):
    """What the CPU time of a step goes to, by the name of the stage: the times of stage_times() [s]. Empty for recordings
    of releases that did not measure it."""
    prefix = "solver_"
    names = {each.name for window in windows for each in window.stages if each.name.startswith(prefix)} - {"solver_wall"}
    found = {name[len(prefix) :]: stage_times(windows, name, "time") for name in sorted(names)}
    return {name: times for name, times in found.items() if times["time_p50"] is not None}


def latency_of(recording):
    """Stamp to reception by the recorder, by topic [s]. In simulated time stamps are no wall time, so there is none."""
    if recording.is_simulated_time:
        return {}
    found = {}
    for topic, delays in sorted(recording.delays.items()):
        values = numpy.array(delays)
        p50, p99 = numpy.percentile(values, [50, 99])
        found[topic] = {"messages": len(values), "p50": float(p50), "p99": float(p99), "max": float(values.max())}
    return found


def dropped_of(recording):
    steps = numpy.array(recording.steps, dtype=numpy.int64)
    change = numpy.diff(steps)
    restarts = (change <= 0) | (numpy.diff(numpy.array(recording.runs, dtype=numpy.int64)) != 0)
    gaps = change[(change > 1) & ~restarts]
    return {
        "missing_steps": int((gaps - 1).sum()),
        "gaps": int(len(gaps)),
        "restarts": int(restarts.sum()),
        "first_step": int(steps[0]),
        "steps_without_hash": len(steps) - sum(recording.hashes) if recording.inputs_have_hashes else None,
        "lost_inputs": sum(recording.lost.values()),
        "lost_inputs_by_topic": dict(sorted(recording.lost.items())),
        "frames": recording.frames[0],
        "lost_frames": recording.frames[1],
        "diagnostics": troubles_of(recording.diagnostics),
        "thinned": thinned_of(recording),
    }


def troubles_of(diagnostics):
    """Counters of devices and cameras that should be 0 and are not."""
    found = {}
    for name, values in sorted(diagnostics.items()):
        for key, value in values.items():
            if any(word in key for word in TROUBLE) and value.strip().isdigit() and int(value) > 0:
                found["{}: {}".format(name, key)] = int(value)
    return found


def thinned_of(recording):
    """Messages per simulated second of the topics that were not recorded at every step."""
    seconds = recording.duration()
    found = {}
    for topic in THINNED:
        count = recording.count(topic)
        if 0 < count < 0.9 * len(recording.steps) and seconds > 0:
            found[topic] = round(count / seconds, 3)
    return found


def warnings_of(recording):
    """Sentences: what is wrong with the recording, then what the simulator said, each once with its number of times."""
    found = [sentence for sentence in (recording.remark, recording.cut_reason) if sentence]
    dropped = dropped_of(recording)
    if dropped["missing_steps"]:
        found.append(
            "{missing_steps} steps are missing in {gaps} gaps of applied_input: the session can be replayed up to the "
            "first gap, and again from the snapshot after each.".format(**dropped)
        )
    if recording.doubled:
        found.append(
            "{} steps are in the recording twice and count once, as in bags that were merged; messages of other topics may be "
            "there twice, too.".format(recording.doubled)
        )
    if dropped["restarts"]:
        found.append(
            "The session was reset, or a state or scene was loaded, {}; the measures are those since then.".format(
                "once" if dropped["restarts"] == 1 else "{restarts} times".format(**dropped)
            )
        )
    if dropped["first_step"] > 0:
        found.append(
            "The recording begins at step {first_step}: the recorder may have begun late, the file may be a part of another, "
            "or the session began from a snapshot.".format(**dropped)
        )
    if recording.skill is None:
        found.append("There is no procedure/skill_metrics: the measures are not known.")
    said = {}
    for _, kind, _, _, text in recording.events:
        if kind in events.WARNINGS:
            said[text] = said.get(text, 0) + 1
    found += ["{}{}".format(text, " ({} times)".format(n) if n > 1 else "") for text, n in said.items()]
    if len(found) > MOST_WARNINGS:
        found[MOST_WARNINGS:] = ["... and {} other warnings".format(len(found) - MOST_WARNINGS)]
    return found
