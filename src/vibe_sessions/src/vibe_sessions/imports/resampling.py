"""From the series of a motion to the inputs of steps, and what of them the scope cannot follow."""
import contextlib
from xml.etree import ElementTree

import numpy
import yaml

from vibe_sessions import regression_units as units
from vibe_sessions.cohort_plan import files_of, resolve
from vibe_sessions.headless import SessionError
from vibe_sessions.imports.map_file import BUTTONS, JOINTS
from vibe_sessions.imports.motion_file import cleaned

GRID = 2.0**-30  # of joints [m], [rad]: the same motion in other units gives the same bits
LONGEST = 4 * 3600  # of a motion [s]
SHOWN = {"m": ("mm", 1e3), "rad": ("deg", 57.29577951308232)}
CANDIDATES = {"m": ("m", "cm", "mm", "um"), "rad": ("turn", "rad", "deg", "mrad")}  # from large to small


def scene_facts(scene):
    """(simulated time per step [s], {joint: (lower, upper, velocity)}) of a scene."""
    period, limits = None, {}
    with contextlib.suppress(OSError, ValueError, AttributeError, TypeError, yaml.YAMLError, ElementTree.ParseError):
        for path in files_of(resolve(scene)):
            if path.endswith(".urdf") and not limits:
                for joint in ElementTree.parse(path).iter("joint"):
                    limit = joint.find("limit")
                    if joint.get("name") in JOINTS and limit is not None:
                        limits[joint.get("name")] = tuple(float(limit.get(key)) for key in ("lower", "upper", "velocity"))
            elif path.endswith((".yaml", ".yml")) and period is None:
                with open(path, encoding="utf-8") as stream:
                    text = (yaml.safe_load(stream) or {}).get("step_period")
                period = units.parse(str(text), "s")[0] if text is not None else None
    period = 1 / 60 if period is None else period
    if len(limits) < len(JOINTS) or not 1e-4 <= period <= 0.1:
        raise SessionError(f"The scene '{scene}' cannot be read or has no scope that a motion could move; name another.")
    return period, limits


def sampled(times, values, at, interpolation):
    """Between the first and the last value; before and after them, these."""
    if interpolation == "linear":
        return numpy.interp(at, times, values)
    return values[numpy.clip(numpy.searchsorted(times, at, side="right") - 1, 0, None)]


def doubt_of_unit(joint, source, raw, lower, upper):
    """Another unit in which the values would be within the limits and large enough to see; "" if this one fits."""
    dimension = JOINTS[joint]
    largest, span = max(abs(lower), abs(upper)), upper - lower
    raw = raw * (source.factor / units.unit_of(source.unit or dimension)[0])  # with the scale

    def fits(unit, most, least):
        factor = units.unit_of(unit)[0]
        return numpy.abs(raw).max() * factor <= most * largest and (raw.max() - raw.min()) * factor >= least * span

    if raw.max() == raw.min() or fits(source.unit or dimension, 3, 0.003):
        return ""
    other = next((unit for unit in CANDIDATES[dimension] if fits(unit, 1.2, 0.01)), None)
    return f" A possible cause is the unit, {source.unit or dimension}; in {other} they would fit." if other else ""


def clamped(joint, values, limits, at, doubt, notes):
    """Values within the limits of a joint; says what was beyond, and where the scope will lag behind."""
    lower, upper, speed = limits
    unit, shown = SHOWN[JOINTS[joint]]
    result = numpy.clip(values, lower, upper)
    beyond = numpy.abs(values - result)
    out = numpy.flatnonzero(beyond > GRID)
    if len(out):
        notes.append(f"'{joint}' is beyond its limits of {lower * shown:.4g} to {upper * shown:.4g} {unit} in {len(out)} of "
                     f"{len(values)} steps, from {at[out[0]]:.3f} to {at[out[-1]]:.3f} s of the motion, by up to "
                     f"{beyond.max() * shown:.4g} {unit}, and is clamped to them.{doubt}")
    elif doubt:
        notes.append(f"'{joint}' moves by {(values.max() - values.min()) * shown:.3g} {unit} in all.{doubt}")
    period = at[1] - at[0]
    steps = numpy.abs(numpy.diff(result))
    fast = numpy.flatnonzero(steps > speed * period * (1 + 1e-6))
    if len(fast):
        place, lag = result[0], 0.0
        for value in result:
            place += min(max(value - place, -speed * period), speed * period)
            lag = max(lag, abs(value - place))
        notes.append(f"'{joint}' is asked for up to {steps.max() / period * shown:.4g} {unit}/s in {len(fast)} steps, first at "
                     f"{at[fast[0]]:.3f} s of the motion, but moves at {speed * shown:.4g} {unit}/s at most; it lags by up to "
                     f"{lag * shown:.3g} {unit}.")
    return result


def series_of(motion, made, notes):
    """{column: (times [ns], values)} of all that the map names, cleaned, with the beginning of the motion at 0 ns."""
    columns = {source.column for source in [*made.joints.values(), *made.buttons.values()] if source.column}
    found = {column: cleaned(column, *motion.series(column), notes) for column in sorted(columns)}
    begin = min(times[0] for times, _ in found.values())
    length = (max(times[-1] for times, _ in found.values()) - begin) / 1e9
    usual = min(numpy.median(numpy.diff(times)) for times, _ in found.values()) / 1e9
    if length > LONGEST or usual > 1 or length < 0.1 or usual < 1e-4:
        doubt = (f"The motion lasts {length:.6g} s, with a value every {usual:.3g} s. A possible cause is the unit of the time: perhaps "
                 f"`time: {{unit: {'ms' if usual > 0.1 else 's'}}}`.")
        if not 0 < length < LONGEST:
            raise SessionError(f"{doubt} A motion may last {LONGEST} s.")
        notes.append(doubt)
    return {column: (times - begin, values) for column, (times, values) in found.items()}


def inputs_of(motion, made, notes):
    """(period [s], joints, buttons): a row per step. Before the motion the joints go from 0 to its first pose at half of
    their speed at most."""
    period, limits = scene_facts(made.scene)
    series = series_of(motion, made, notes)
    count = max(int(max(times[-1] for times, _ in series.values()) / (1e9 * period)) + 1, 2)
    at = numpy.round(numpy.arange(count) * period * 1e9).astype(numpy.int64)
    joints, buttons = numpy.zeros((count, len(JOINTS))), numpy.zeros((count, len(BUTTONS)), numpy.uint8)
    for k, name in enumerate(JOINTS):
        source = made.joints.get(name)
        if source is None:
            notes.append(f"'{name}' is not in the map and stays at 0.")
            continue
        times, raw = series[source.column] if source.column else (at, numpy.zeros(count))
        values = raw * source.factor
        values += source.offset if source.start is None else source.start - values[0]
        doubt = doubt_of_unit(name, source, raw, *limits[name][:2])
        joints[:, k] = clamped(name, sampled(times, values, at, made.interpolation), limits[name], at / 1e9, doubt, notes)
    for name, source in made.buttons.items():
        times, raw = series[source.column] if source.column else (at, numpy.zeros(count))
        buttons[:, BUTTONS.index(name)] = sampled(times, raw + source.offset, at, "hold") > 0
    return period, *with_lead(numpy.round(joints / GRID) * GRID, buttons, made, limits, period)


def with_lead(joints, buttons, made, limits, period):
    needed = max(abs(value) / (0.5 * limits[name][2]) for name, value in zip(JOINTS, joints[0]))
    steps = int(numpy.ceil(max(needed, made.lead) / period))
    ramp = numpy.linspace(0, 1, steps, endpoint=False)[:, None] * joints[0]
    pressed = numpy.array([name in made.buttons and not made.buttons[name].column for name in BUTTONS])
    return (numpy.round(numpy.vstack([ramp, joints]) / GRID) * GRID,
            numpy.vstack([numpy.tile(pressed * buttons[0], (steps, 1)), buttons]).astype(numpy.uint8))
