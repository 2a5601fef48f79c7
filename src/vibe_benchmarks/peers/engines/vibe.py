"""This simulator's shell, by `vibe_bench` and a case that is written for the scene."""

import csv
import math
import os
import resource
import subprocess
import tempfile

import numpy as np
import yaml

from drive import Outcome
from scenes import FRAME, HERE

NAME, PACKAGE, VERSION = "ViBE", "", ""
BENCH = os.environ.get("VIBE_BENCH") or os.path.join(HERE, *[os.pardir] * 3, "devel/lib/vibe_benchmarks/vibe_bench")
SWEEP = {"60 Hz, 2 iterations": {"step": FRAME, "iterations": 2, "radius": 0.2},
         "60 Hz, 6 iterations": {"step": FRAME, "iterations": 6, "radius": 0.2},
         "240 Hz, 2 iterations": {"step": FRAME / 4, "iterations": 2, "radius": 0.2},
         "240 Hz, 20 iterations": {"step": FRAME / 4, "iterations": 20, "radius": 0.2},
         "240 Hz, 2 iterations, radius 0.8": {"step": FRAME / 4, "iterations": 2, "radius": 0.8}}  # fmt: skip


def cannot(scene):
    return {"force": "of the disc without that of the gas"} if scene.pressure else {}


def case(scene, settings, folder):
    """The case file of a scene, beside its mesh."""
    def save(name, rows, form):
        np.savetxt(os.path.join(folder, name), rows, form)  # not whole: scratch

    save("nodes.txt", scene.nodes, "%.12g")
    save("tris.txt", scene.triangles, "%d")
    with open(os.path.join(folder, "sets.txt"), "w", encoding="utf-8") as stream:  # not whole: scratch
        for name, hold in scene.holds.items():
            stream.write(f"{name}: {' '.join(map(str, np.sort(hold.nodes)))}\n")
        for node in scene.record:
            stream.write(f"n{node}: {node}\n")
    still = [name for name, hold in scene.holds.items() if not hold.motions]
    moves = []
    for name, hold in scene.holds.items():
        for m in hold.motions:
            moves.append({"set": name, "translation": [float(v) for v in m.translation], "held": list(m.axes),
                          "ramp": [m.start, m.end]})
            if m.turn:
                moves[-1].update(centre=list(m.centre), axis=[0, 1, 0], angle=float(m.turn))
    loads = {"prescribed": moves}
    if scene.gravity:
        loads["gravity"] = [0, 0, -scene.gravity]
    if scene.pressure:
        loads["gas"] = {"pressure": scene.pressure, "ramp": [0, 1]}
    out = {"name": scene.name, "mesh": {k: k + ".txt" for k in ("nodes", "tris", "sets")}, "element": "shell",
           "thickness": scene.thickness, "density": scene.density,
           "material": {"law": "neo_hookean", "young_modulus": scene.young, "poisson_ratio": scene.poisson},
           "hinged" if scene.hinged else "clamped": still, "loads": {k: v for k, v in loads.items() if v}}  # fmt: skip
    if scene.thickness_along_z:
        out["thickness_along"] = [0, 0, 1]
    if scene.thread:
        out["spots"] = {n: {"centre": [x, 0, 0], "radius": 0.005, "across": [0, 0, 1]} for n, x in
                        (("plus", 0.02), ("minus", -0.02))}  # fmt: skip
        out["loads"]["cinch"] = {"first": "plus", "second": "minus", "direction": [1, 0, 0],
                                 "distance": scene.thread.distance, "ramp": [0, 1]}  # fmt: skip
    # dead loads are those at the end of the path
    path = [[0, 1], [1, 1]] if scene.gravity else [[0, 0], [scene.duration, scene.duration]]
    out["transient"] = {"step": settings["step"], "duration": scene.duration, "iterations": settings["iterations"],
                        "spectral_radius": settings["radius"], "path": path}  # fmt: skip
    out["sample"] = [{"name": f"n{n}{a}", "kind": "displacement", "set": f"n{n}", "direction": d} for n in scene.record
                     for a, d in zip("xyz", np.eye(3, dtype=int).tolist())]  # fmt: skip
    if scene.force and scene.thread:
        out["sample"].append({"name": "force", "kind": "tension"})
    elif scene.force:
        out["sample"].append({"name": "force", "kind": "reaction", "set": scene.force[0],
                              "direction": list(scene.force[1])})  # fmt: skip
    return out


def bench(scene, settings, limit, duration):
    """The values of a run, and the CPU time of all threads of its process [s]."""
    with tempfile.TemporaryDirectory() as folder:
        file, values = os.path.join(folder, "case.yaml"), os.path.join(folder, "values.csv")
        written = case(scene, settings, folder)
        written["transient"]["duration"] = duration
        with open(file, "w", encoding="utf-8") as stream:  # not whole: scratch
            yaml.safe_dump(written, stream, sort_keys=False)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([BENCH, "--case", file, "--values", values], capture_output=True, text=True,
                              timeout=20 * limit, check=False)  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode not in (0, 1) or not os.path.exists(values):
            raise RuntimeError(f"vibe_bench ended with {done.returncode}: {done.stderr.strip()[-600:]}")
        with open(values, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
    return rows, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run(scene, settings, limit):
    """The time of a run of one frame, which reads the case and makes the first factor, is taken off."""
    _, start = bench(scene, settings, limit, FRAME)
    rows, all_in_all = bench(scene, settings, limit, scene.duration)
    return outcome(scene, settings, rows, (all_in_all - start) / (scene.duration - FRAME))


def outcome(scene, settings, rows, cpu):
    per_frame = round(FRAME / settings["step"])
    series = {}
    for row in rows:
        series.setdefault(row["sample"], {})[round(float(row["at"]) / settings["step"])] = float(row["value"])
    frames = range(per_frame, round(scene.duration / settings["step"]) + 1, per_frame)
    moved = np.array([[[series[f"n{n}{a}"][f] for a in "xyz"] for n in scene.record] for f in frames])
    force = series["force"][frames[-1]] if "force" in series else math.nan
    return Outcome(np.concatenate([np.zeros_like(moved[:1]), moved]), cpu, force)
