"""What a step of a falling ball costs in the functions of features that its scene does not name, in instructions.

usage: count_instructions.py VIBE_HEADLESS
"""
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

STEPS = (6, 18)  # the difference leaves out what happens once
MOST = 0.005  # of a step that all functions of an absent feature may take
PERIOD = 1 / 60
BALL = """name: counted
geometry: {kind: sphere, particles: 400}
gravity: {}
"""
# feature: (what a scene says to have it, functions that only it needs)
FEATURES = {
    "gas": ("gas: {initial_pressure: 10 mmHg, insufflator_on: true}",
            r"insufflate|gaugePressure|gasAmount|lumenVolume|[gG]as(Energy|Stiffness)?\(|sweepAll<.*, true>\(vibe"),
    "bed": ("foundation: {carries_weight: false}", r"addRareTerms"),
    "scope": ("scope: {}", r"ToolCollision|ToolModel|ToolMotion|ToolTouch|ToolJacobian|ResponseEstimator"),
    "helix": ("scope: {}\nhelix: {}", r"[Hh]elix|Grip"),
    "self_contact": ("tissue: {self_contact: true}", r"SelfContact"),
    "skin": ("render_surface: true", r"[Ss]kin|Loop"),
}


def functions(profile):
    """Instructions of every function itself, without what it calls, from a file of callgrind."""
    names, costs, current, called = {}, Counter(), "", False
    for line in profile.read_text(encoding="utf-8", errors="replace").splitlines():
        named = re.match(r"c?fn=(\(\d+\)) ?(.*)", line)
        if named:
            if named[2]:
                names[named[1]] = named[2]
            if line.startswith("fn="):
                current = names[named[1]]
        elif line.startswith("calls="):
            called = True  # the next line is what the callee took
        elif re.match(r"[-+*\d]", line):
            if not called:
                costs[current] += int(line.split()[1])
            called = False
    return costs


def count(program, scene, steps, folder):
    (folder / "scene.yaml").write_text(scene, encoding="utf-8")
    profile = folder / "profile"
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", "--toggle-collect=vibe::step(*", f"--callgrind-out-file={profile}", program,
         "--scene", str(folder / "scene.yaml"), "--duration", str(steps * PERIOD), "--quiet"],
        capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = [line for line in done.stderr.splitlines() if not line.startswith("==")]
        sys.exit(f"vibe_headless failed under valgrind: {' '.join(said) or 'it said nothing'}")
    return functions(profile)


def per_step(program, scene):
    """Instructions per step of every function that takes some."""
    with tempfile.TemporaryDirectory() as folder:
        few, many = (count(program, scene, steps, Path(folder)) for steps in STEPS)
    return {name: (many[name] - few[name]) / (STEPS[1] - STEPS[0]) for name in many}


def of(costs, pattern):
    return sum(cost for name, cost in costs.items() if re.search(pattern, name))


def main(program):
    without = per_step(program, BALL)
    whole = sum(without.values())
    print(f"a falling ball of 400 particles: {whole:,.0f} instructions per step", flush=True)
    print(f"{'feature':14} {'its functions, absent':>22} {'its functions, named':>22} {'whole step, named':>20}")
    dear = []
    for feature, (text, pattern) in FEATURES.items():
        named = per_step(program, BALL + text + "\n")
        absent = of(without, pattern)
        print(f"{feature:14} {absent:22,.0f} {of(named, pattern):22,.0f} {sum(named.values()):20,.0f}", flush=True)
        if absent > MOST * whole:
            dear.append(feature)
    if dear:
        sys.exit(f"{', '.join(dear)}: takes more than {100 * MOST:g} % of a step of a scene that does not name it")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    main(sys.argv[1])
