"""Runs the scenes in the engines that are installed, keeps the results and writes the page's table and picture."""

import argparse
import csv
import datetime
import importlib
import importlib.util
import json
import math
import os
import subprocess
import sys
import tempfile

import scenes
from scenes import HERE
from vibe_sessions.whole_file import open_whole

ROOT = os.path.normpath(os.path.join(HERE, *[os.pardir] * 3))
sys.path.append(os.path.join(ROOT, "scripts", "lib"))
CSV = os.path.join(ROOT, "docs", "measured", "peers.csv")
ENGINES = ("vibe", "mujoco_flex", "newton_vbd", "newton_xpbd", "newton_style3d", "bullet")
NEEDS = {"vibe": None, "mujoco_flex": "mujoco", "bullet": "pybullet"}  # module of an engine; else newton
LIMIT = {"small": 20, "large": 30}  # CPU time of a run [s]
NEAR = 10  # times our CPU time
COLUMNS = ("scene", "size", "engine", "setting", "nodes", "step_ms", "error", "force_error", "cpu_s", "energy_gain",
           "note", "cannot", "package", "date", "version", "machine")  # fmt: skip


def installed(engine):
    needs = NEEDS.get(engine, "newton")
    return needs is None or importlib.util.find_spec(needs) is not None


def measure(engine_name, scene_name, size, settings, limit):
    """The row of one run."""
    from drive import Outcome, drive
    engine = importlib.import_module("engines." + engine_name)
    scene = scenes.make(scene_name, size == "large")
    cannot = engine.cannot(scene)
    row = dict.fromkeys(COLUMNS[:12], "") | {
           "scene": scene_name, "size": size, "engine": engine.NAME, "nodes": len(scene.nodes),
           "package": f"{engine.PACKAGE} {engine.VERSION}".strip(),
           "cannot": "; ".join(f"{k}: {v}" for k, v in cannot.items())}  # fmt: skip
    if "scene" in cannot:
        yield row | {"note": "cannot: " + cannot["scene"]}
        return
    for name in settings or engine.SWEEP:
        try:
            out = (engine.run(scene, engine.SWEEP[name], limit) if hasattr(engine, "run") else
                   drive(engine.Engine(scene, engine.SWEEP[name]), scene, limit))  # fmt: skip
        except Exception as failure:  # of an engine, whichever it may be
            out = Outcome(note=f"failed: {str(failure)[-200:]}".replace("\n", " "))
        found = row | {"setting": name, "step_ms": f"{1e3 * engine.SWEEP[name]['step']:.3g}", "cpu_s": show(out.cpu),
                       "note": out.note}  # fmt: skip
        if out.recorded is not None:
            found["error"] = show(scene.error(out.recorded))
            if scene.force:
                found["force_error"] = show(abs(out.force / scene.force[2] - 1))
            if scene.line is not None:
                found["energy_gain"] = show(scene.energy_gain(out.recorded))
        yield found


def show(value):
    return "" if math.isnan(value) else f"{value:.4g}"


def number(text):
    return float(text) if text else math.nan


def chosen(rows, ours):
    """The rows of one engine, scene and size with the smallest error: near our CPU time, and of all."""
    done = sorted((r for r in rows if r["error"]), key=lambda r: number(r["error"]))
    near = [r for r in done if ours and number(r["cpu_s"]) <= NEAR * ours]
    return (near[0] if near else None), (done[0] if done else None)


def load():
    if not os.path.exists(CSV):
        return []
    with open(CSV, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def keep(rows, fresh):
    """Puts fresh rows in the place of those of the same engine, scene, size and setting."""
    key = lambda r: (r["scene"], r["size"], r["engine"], r.get("setting") or "")
    replaced = {key(r) for r in fresh}
    known = {e.NAME: e.SWEEP for e in map(importlib.import_module, ("engines." + name for name in ENGINES if installed(name)))}
    rows[:] = [r for r in rows if key(r) not in replaced and (not r["setting"] or r["setting"] in known.get(r["engine"], [r["setting"]]))]
    rows += fresh
    rows.sort(key=lambda r: (scenes.NAMES.index(r["scene"]), r["size"] == "large"))
    with open_whole(CSV, newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def own_time(rows, scene, size):
    """CPU time of this simulator's setting with the smallest error [s per s]."""
    from engines import vibe
    best = chosen([r for r in rows if (r["engine"], r["scene"], r["size"]) == (vibe.NAME, scene, size)], None)[1]
    return number(best["cpu_s"]) if best else None


def child(engine, scene, size, settings, limit):
    """Runs an engine in a process of its own: some print, some end the process."""
    words = ["--child", json.dumps([engine, scene, size, settings, limit])]
    done = subprocess.run([sys.executable, "-B", __file__, *words], capture_output=True, text=True, check=False,
                          cwd=tempfile.gettempdir(), timeout=100 * limit)  # MuJoCo writes a log where it runs
    rows = [json.loads(line[4:]) for line in done.stdout.splitlines() if line.startswith("row ")]
    if done.returncode:
        print(f"{engine} ended with {done.returncode} in scene {scene}: {done.stderr.strip()[-400:]}", file=sys.stderr)
    return rows


def run(arguments):
    from accuracy import machine, version
    stamp = {"date": datetime.date.today().isoformat(), "version": version(ROOT), "machine": machine()}
    rows = load()
    for scene in arguments.scene or scenes.NAMES:
        for size in [arguments.size] if arguments.size else ["small"] if arguments.quick else ["small", "large"]:
            for engine in arguments.engine or ENGINES:
                if not installed(engine):
                    print(f"{engine} is absent: its package is not installed in this environment")
                    continue
                settings = choose(rows, scene, engine, arguments.quick) if size == "large" or arguments.quick else None
                fresh = [r | stamp for r in child(engine, scene, size, settings, LIMIT[size])]
                for r in fresh:
                    print(scene, size, r["engine"], r.get("setting", ""), "error", r.get("error"), "CPU", r.get("cpu_s"),
                          r["note"], flush=True)  # fmt: skip
                keep(rows, fresh)


def choose(rows, scene, engine_name, quick):
    """The setting that is best near our CPU time on the small mesh, or else of all; in a quick run the first."""
    engine = importlib.import_module("engines." + engine_name)
    if quick:
        return list(engine.SWEEP)[:1]
    mine = [r for r in rows if (r["scene"], r["size"], r["engine"]) == (scene, "small", engine.NAME)]
    best = [r["setting"] for r in chosen(mine, own_time(rows, scene, "small")) if r][:1]
    return list(dict.fromkeys([*list(engine.SWEEP)[:2], *best])) if engine_name == "vibe" else best or None


def parse(words):
    parser = argparse.ArgumentParser(prog="scripts/peers")
    parser.add_argument("--engine", action="append", choices=ENGINES)
    parser.add_argument("--scene", action="append", choices=scenes.NAMES)
    parser.add_argument("--size", choices=("small", "large"))
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--child")
    return parser.parse_args(words)


def main(words):
    arguments = parse(words)
    if arguments.child:
        for row in measure(*json.loads(arguments.child)):
            print("row " + json.dumps(row), flush=True)
        return
    if not arguments.draw:
        run(arguments)
    import page
    page.write(load(), ROOT)


if __name__ == "__main__":
    main(sys.argv[1:])
