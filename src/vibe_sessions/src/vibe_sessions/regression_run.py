"""Runs what a regression describes: vibe_headless, which writes the measures by name."""
import json
import os
import signal
import subprocess
import tempfile

from vibe_sessions.regression_file import RegressionError


def find_program():
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        program = os.path.join(prefix, "lib", "vibe_core", "vibe_headless")
        if prefix and os.access(program, os.X_OK):
            return program
    raise RegressionError("There is no vibe_headless; build vibe_core and source its workspace.")


def _call(arguments):
    """What it printed.

    Raises RegressionError with the sentence that it said.
    """
    done = subprocess.run([find_program(), *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          errors="replace", check=False)
    if done.returncode == 0:
        return done.stdout
    if done.returncode < 0:
        raise RegressionError(f"vibe_headless was ended by the signal {signal.Signals(-done.returncode).name}.")
    lines = done.stderr.strip().splitlines() or [f"vibe_headless ended with status {done.returncode}."]
    raise RegressionError(lines[-1].removeprefix("vibe_headless: "))


def flatten(outcome):
    """{name: (value or None, unit)}: measures, and counts of events as events.KIND."""
    values = {name: (m["value"], m["unit"]) for name, m in outcome["measures"].items()}
    values.update({f"events.{kind}": (count, "1") for kind, count in outcome["events"].items()})
    return values


def known_measures():
    """{name: SI unit}"""
    return {name: unit for name, (_, unit) in flatten(json.loads(_call(["--list-measures"]))).items()}


def perform(regression):
    """(values as of flatten(), hash of the last state)"""
    with tempfile.TemporaryDirectory(prefix="vibe_regression_") as folder:
        file = os.path.join(folder, "measures.json")
        arguments = ["--quiet", "--scene", regression.scene, "--measures", file]
        for option in ("script", "mesh"):
            address = getattr(regression, option)
            arguments += [f"--{option}", address] if address else []
        arguments += ["--seed", str(regression.seed)] if regression.seed is not None else []
        arguments += ["--duration", repr(regression.duration)] if regression.duration > 0 else []
        try:
            _call(arguments)
        except RegressionError as error:
            raise RegressionError(f"{regression.file}: {error}") from None
        with open(file, encoding="utf-8") as stream:
            outcome = json.load(stream)
    return flatten(outcome), outcome["state_hash"]
