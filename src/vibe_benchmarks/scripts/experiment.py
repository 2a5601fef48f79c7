#!/usr/bin/python3
"""Simulates one published experiment of ../measurements and writes what the simulator predicts.

An experiment is a YAML file:

  title, source   what was done, and where it is published
  judge, found    who knows better; what the comparison shows (text of the page)
  points          name of what `at` is; compared_apart: runs of which only the first is listed; relative_to: {quantity:
                  the one whose size its error is relative to}
  numbers         name: number or expression; later ones may use earlier ones
  runs            a list of {name: number}: what differs from run to run; `label` is the name of a run
  case            a case of vibe_bench (see ../cases), in which $(EXPRESSION) stands for its value; or
  scene           a function of experiment_scenes.py with its arguments
  predict         quantity: {unit, value, reference, at: [..], each: {name: number}}

`value` and `reference` are expressions of the numbers, of `at`, of `each`, and of the samples of the case, which are
indexed by level: "force[1]". `reference` is a closed form or the result of another program; without it, a measurement is the
judge: see ../measurements/measured.csv. Nothing here reads that file.
"""

import argparse
import csv
import math
import os
import re
import subprocess
import sys
import tempfile

import yaml
from vibe_sessions.whole_file import open_whole

HERE = os.path.dirname(os.path.realpath(__file__))
FOLDER = os.path.join(HERE, "..", "measurements")
COLUMNS = ("experiment", "run", "quantity", "at", "unit", "predicted", "reference")


def interpolate(at, places, values):
    """The value at a place, linear between those given in ascending order."""
    for (a, left), (b, right) in zip(zip(places, values), list(zip(places, values))[1:]):
        if a <= at <= b:
            return left + (right - left) * (at - a) / (b - a)
    raise ValueError(f"{at:g} is not between {places[0]:g} and {places[-1]:g}")


WORDS = {"interpolate": interpolate, "range": range}
WORDS.update((name, getattr(math, name)) for name in ("pi", "sqrt", "log", "exp", "sin", "cos", "atan", "atanh", "inf"))


class Sample(dict):
    """Values of a sample by level, which is found within the digits that vibe_bench writes."""

    def __missing__(self, level):
        for known, value in self.items():
            if math.isclose(known, level, rel_tol=1e-7):
                return value
        raise ValueError(f"level {level} is missing, or no equilibrium was found there; the sample has "
                         f"{', '.join(map(str, self))}")


def evaluate(expression, names):
    """The value of an expression of an experiment file."""
    if not isinstance(expression, str):
        return expression
    try:
        return eval(expression, {"__builtins__": {"abs": abs, "max": max, "min": min, "sum": sum}, **names})
    except Exception as failure:
        raise ValueError(f"'{expression}' cannot be computed: {failure}") from failure


def show(expression, names):
    value = evaluate(expression, names)
    return "" if value is None else "{:.6g}".format(value)


def numbers_of(experiment, run):
    names = {**WORDS, **run, "run": run}
    for name, value in experiment.get("numbers", {}).items():
        names[name] = evaluate(value, names)
    return names


def filled(node, names):
    """A part of a case with the values of its $(EXPRESSIONS); one that is a whole text becomes a number."""
    if isinstance(node, dict):
        return {key: filled(value, names) for key, value in node.items()}
    if isinstance(node, list):
        return [filled(value, names) for value in node]
    if not isinstance(node, str):
        return node
    whole = re.fullmatch(r"\$\(([^$]*)\)", node)
    if whole:
        return evaluate(whole.group(1), names)
    return re.sub(r"\$\(([^$]*?)\)(?!\))", lambda found: str(evaluate(found.group(1), names)), node)


def run_case(case, log):
    """Samples of a case of vibe_bench, by name and level."""
    with tempfile.TemporaryDirectory(prefix="vibe_experiment.") as folder:
        file, values = os.path.join(folder, "case.yaml"), os.path.join(folder, "values.csv")
        with open(file, "w", encoding="utf-8") as out:  # not whole: scratch
            yaml.safe_dump(case, out)
        program = os.path.join(os.environ.get("VIBE_DEVEL", os.path.join(HERE, "../../../devel")),
                               "lib/vibe_benchmarks/vibe_bench")
        done = subprocess.run([program, "--case", file, "--values", values], stderr=subprocess.PIPE, text=True)
        log.write(done.stderr)
        if done.returncode not in (0, 1):  # 1: it has buckled
            raise ValueError((done.stderr.strip() or f"vibe_bench ended with {done.returncode}").splitlines()[-1])
        samples = {}
        with open(values, newline="", encoding="utf-8") as stream:
            for row in csv.DictReader(stream):
                sample = samples.setdefault(row["sample"], Sample())
                if row["value"]:
                    sample[float(row["at"])] = float(row["value"])
        return samples


def run_scene(scene, log):
    try:
        import experiment_scenes
    except ImportError as failure:
        raise ValueError(f"{failure}; build the workspace and source devel/setup.bash") from failure
    function, arguments = next(iter(scene.items()))
    samples = getattr(experiment_scenes, function)(log=log, **arguments)
    return {name: Sample(value) if isinstance(value, dict) else value for name, value in samples.items()}


def predictions(name, experiment, log):
    """Rows of an experiment."""
    for run in experiment.get("runs", [{}]):
        names = numbers_of(experiment, run)
        label = run.get("label") or ", ".join(f"{key} {value:g}" for key, value in run.items())
        log.write(f"{name} {label}\n")
        if "case" in experiment:
            case = filled(experiment["case"], names)
            samples = run_case({"name": name, "density": 1000, **case}, log)
        else:
            samples = run_scene(filled(experiment["scene"], names), log)
        for quantity, rule in experiment["predict"].items():
            for at in rule.get("at", [""]):
                for each, number in rule.get("each", {"": None}).items():
                    known = {**names, **samples, "at": at, "each": number}
                    value, reference = (show(rule.get(word), known) for word in ("value", "reference"))
                    what = " ".join(filter(None, (quantity, each)))
                    if value:
                        yield dict(zip(COLUMNS, (name, label, what, at, rule["unit"], value, reference)))


def read(name):
    with open(os.path.join(FOLDER, name + ".yaml"), encoding="utf-8") as text:
        return yaml.safe_load(text)


def main(words):
    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("experiment", help="a file of ../measurements without its ending")
    line.add_argument("--csv", default="-", help="where to write the rows; - for the standard output")
    arguments = line.parse_args(words)
    try:
        rows = list(predictions(arguments.experiment, read(arguments.experiment), sys.stderr))
    except (OSError, ValueError) as failure:
        sys.exit(f"experiment {arguments.experiment}: {failure}")
    with open_whole("/dev/stdout" if arguments.csv == "-" else arguments.csv, newline="") as out:
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main(sys.argv[1:])
