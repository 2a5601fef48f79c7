"""Runs what a regression describes: vibe_headless, which writes the measures by name."""
import json

from vibe_sessions import headless
from vibe_sessions.headless import SessionError


def flatten(outcome):
    """{name: (value or None, unit)}: measures, and counts of events as events.KIND."""
    values = {name: (m["value"], m["unit"]) for name, m in outcome["measures"].items()}
    values.update({f"events.{kind}": (count, "1") for kind, count in outcome["events"].items()})
    return values


def known_measures():
    """{name: SI unit}"""
    return {name: unit for name, (_, unit) in flatten(json.loads(headless.call(["--list-measures"]))).items()}


def perform(regression):
    """(values as of flatten(), hash of the last state)"""
    arguments = ["--scene", regression.scene]
    for option in ("script", "mesh"):
        address = getattr(regression, option)
        arguments += [f"--{option}", address] if address else []
    arguments += ["--seed", str(regression.seed)] if regression.seed is not None else []
    arguments += ["--duration", repr(regression.duration)] if regression.duration > 0 else []
    try:
        outcome = headless.perform(arguments)
    except SessionError as error:
        raise SessionError(f"{regression.file}: {error}") from None
    return flatten(outcome), outcome["state_hash"]
