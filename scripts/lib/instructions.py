"""Instructions of the parts of a step, counted by callgrind; called by scripts/instructions."""

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../src/vibe_sessions/src"))
from vibe_sessions.whole_file import open_whole  # noqa: E402

SCENE = "base: package://vibe_core/scenes/stomach.yaml\nname: few\ngeometry: {particles: 900}\n"
STEP = "vibe::Simulation::step(vibe::StepInput const&)"
COUNTED = "vibe::benchmarks::countedStep"
PARTS = {
    "step": STEP,
    "loads": "vibe::ImplicitStep::gather(",
    "factor": "vibe::FactorSchedule::provide(",
    "energy": "vibe::Potential::evaluate(",
    "inverse": "vibe::QuasiNewton::applyInverse(",
    "rows": "vibe::ConstraintSchur::eliminate(",
    "paths": "vibe::ImplicitStep::separate(",
    "walls": "vibe::SelfContact::detect(",
}


def read(lines):
    """{function: instructions, those of what it calls included}, {(caller, function): calls} of a callgrind file."""
    names, total, calls = {}, {}, {}
    function = called = ""
    for line in lines:
        if found := re.match(r"(c?fn)=\((\d+)\)(?: (.*))?", line):
            kind, number, name = found.groups()
            name = names.setdefault(number, name)
            function, called = (name, "") if kind == "fn" else (function, name)
        elif found := re.match(r"calls=(\d+)", line):
            calls[function, called] = calls.get((function, called), 0) + int(found.group(1))
        elif found := re.match(r"[+*\-\d]\S* (\d+)$", line):
            total[function] = total.get(function, 0) + int(found.group(1))
    return total, calls


def row_of(state, lines):
    """One row: steps, and millions of instructions per step of each part."""
    total, calls = read(lines)
    steps = sum(count for (caller, name), count in calls.items() if caller.startswith(COUNTED) and name == STEP)
    if steps == 0:
        raise ValueError("callgrind has counted no step of '{}'; was vibe_contact built from these sources?".format(state))
    row = {"state": state, "steps": steps}
    for part, begin in PARTS.items():
        row[part] = "{:.3f}".format(1e-6 / steps * sum(count for name, count in total.items() if name.startswith(begin)))
    return row


def count(devel, states, scene, folder):
    """{state: row}. The program measures the free pull first; what was counted before a state's motion is that of others."""
    order = ["free", *(state for state in states if state != "free")]
    out = os.path.join(folder, "counted")
    words = ["valgrind", "--tool=callgrind", "--collect-atstart=no", "--toggle-collect=" + COUNTED + "*",
             "--dump-before=vibe::benchmarks::runContact(*", "--callgrind-out-file=" + out,
             os.path.join(devel, "lib/vibe_benchmarks/vibe_contact"), "states", *order, "--no-reference",
             "--plain-preparation", "--scene", scene]  # fmt: skip
    done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        said = [line for line in done.stderr.splitlines() if line and not line.startswith("==")]
        raise ValueError("vibe_contact states {} fails: {}".format(" ".join(order), said[-1] if said else done.returncode))
    files = [*("{}.{}".format(out, k) for k in range(2, len(order) + 1)), out]
    found = {}
    for state, file in zip(order, files):
        with open(file, encoding="utf-8") as lines:
            found[state] = row_of(state, lines)
    for part, begin in PARTS.items():
        if all(float(row[part]) == 0 for row in found.values()):
            raise ValueError("no step has called {}), which is to count as '{}'; name what it is called now".format(begin, part))
    return [found[state] for state in states]


def write(rows, file):
    with open_whole(file, newline="") as stream:
        writer = csv.DictWriter(stream, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def show(rows):
    print("millions of instructions per step\n{:12}{:>6}".format("state", "steps"), *map("{:>9}".format, PARTS), sep="")
    for row in rows:
        print("{state:12}{steps:6}".format(**row), *("{:>9}".format(row[part]) for part in PARTS), sep="")


def main(words):
    line = argparse.ArgumentParser(prog="instructions.py", allow_abbrev=False)
    for name in ("devel", "--scene", "--csv", "--read"):
        line.add_argument(name)
    line.add_argument("states", nargs="+")
    options = line.parse_args(words)
    if options.read:  # a file of callgrind: for the test
        with open(options.read, encoding="utf-8") as lines:
            return show([row_of(state, lines) for state in options.states])
    with tempfile.TemporaryDirectory(prefix="vibe_instructions.") as folder:
        scene = options.scene or os.path.join(folder, "few.yaml")
        if not options.scene:
            with open(scene, "w", encoding="utf-8") as out:  # not whole: scratch
                out.write(SCENE)
        rows = count(options.devel, options.states, scene, folder)
    show(rows)
    if options.csv:
        write(rows, options.csv)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (OSError, ValueError) as failure:
        sys.exit("instructions: {}".format(failure))
