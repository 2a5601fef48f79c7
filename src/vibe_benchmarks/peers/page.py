"""The table of docs/peers.md and docs/pictures/peers.png, from docs/measured/peers.csv."""

import os
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FormatStrFormatter  # noqa: E402

import scenes  # noqa: E402
from compare import NEAR, chosen, number, own_time  # noqa: E402
from measured_text import day, digits, percent, sentence, table  # noqa: E402
from vibe_sessions.whole_file import open_whole, whole  # noqa: E402

COLOURS = {"ViBE": "tab:blue", "MuJoCo flex": "tab:orange", "Newton VBD": "tab:green", "Newton XPBD": "tab:olive",
           "Newton Style3D": "tab:cyan", "PyBullet": "tab:red"}  # fmt: skip


def groups(rows, scene, size):
    """Rows per engine, in the order of the engines."""
    found = {name: [] for name in COLOURS}
    for row in rows:
        if (row["scene"], row["size"]) == (scene, size):
            found[row["engine"]].append(row)
    return {name: some for name, some in found.items() if some}


def result(row):
    if row is None:
        return ["", "", "", ""]
    return [row["setting"], percent(row["error"]), percent(row["force_error"]), digits(row["cpu_s"])]


def line(scene, name, rows, ours):
    near, best = chosen(rows, ours)
    first = rows[0]
    head = [scene, name, first["nodes"]]
    if best is None:
        notes = "; ".join(f"{r['setting']}: {r['note']}" if r["setting"] else r["note"] for r in rows)
        return [*head, notes, *[""] * 8]
    stable = max(number(r["step_ms"]) for r in rows if r["error"] and number(r["error"]) < 1) if number(
        best["error"]) < 1 else ""  # fmt: skip
    if len({r["setting"] for r in rows}) == 1:  # nothing else was tried there
        return [*head, *result(best), *[""] * 5]
    beyond = ["the same", "", "", ""] if best is near else result(best)
    return [*head, *(result(near) if near else ["none", "", "", ""]), *beyond, digits(stable) if stable else "none"]


def make_table(rows):
    header = ["scene", "engine", "nodes", f"best within {NEAR}x our CPU time", "error", "of the force", "CPU",
              "best of all", "error", "of the force", "CPU", "largest step [ms]"]  # fmt: skip
    lines = [line(scene, name, some, own_time(rows, scene, size)) for scene in scenes.NAMES
             for size in ("small", "large") for name, some in groups(rows, scene, size).items()]  # fmt: skip
    gains = [f"{r['engine']} {percent(r['energy_gain'])} ({r['setting']}, {r['nodes']} nodes)" for r in rows
             if r["energy_gain"] and number(r["energy_gain"]) > 1e-4]  # fmt: skip
    gained = "Energy gained in `sheet`, over that of a fall by its length: " + (
        f"{'; '.join(gains)}; no other row gains any." if gains else "none in any row.")  # fmt: skip
    dates = sorted({(r["date"], r["version"], r["machine"]) for r in rows})
    made = "Measured: " + "; ".join(f"{day(d)}, version {v}, {m}" for d, v, m in dates) + " (`scripts/peers`)."
    packages = ", ".join(sorted({r["package"] for r in rows if r["package"]}))
    return "\n\n".join([table(header, lines), sentence(gained), sentence(f"{made} Packages: {packages}.")])


def cannots(rows):
    """What each engine cannot express, with the scenes."""
    found = {}
    for row in rows:
        for what in row["cannot"].split("; ") if row["cannot"] else []:
            found.setdefault((row["engine"], what.removeprefix("scene: ")), {})[row["scene"]] = 1
    order = list(COLOURS)
    return table(["engine", "cannot", "in the scenes"],
                 [[e, w, ", ".join(s)] for (e, w), s in sorted(found.items(), key=lambda i: order.index(i[0][0]))])


def draw(rows, file):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.5), layout="constrained")
    for axis, scene in zip(axes.ravel(), scenes.NAMES):
        for size, marker, fill in (("small", "o", True), ("large", "s", False)):
            for name, some in groups(rows, scene, size).items():
                points = sorted((number(r["cpu_s"]), 100 * number(r["error"])) for r in some if r["error"])
                if points:
                    axis.plot(*zip(*points), marker, ls="-" if fill else ":", lw=1, color=COLOURS[name], ms=7,
                              mfc=COLOURS[name] if fill else "white")  # fmt: skip
        axis.set(xscale="log", yscale="log", title=scene, xlim=(0.01, 60), ylim=(0.1, 1000))
        axis.axvline(1, color="0.6", lw=1, ls="--")
        for one in (axis.xaxis, axis.yaxis):
            one.set_major_formatter(FormatStrFormatter("%g"))
        axis.grid(True, color="0.92")
    for axis in axes[1]:
        axis.set_xlabel("CPU time per simulated second [s]; dashed: real time")
    for axis in axes[:, 0]:
        axis.set_ylabel("error [%]")
    keys = [plt.Line2D([], [], color=c, marker="o", label=n) for n, c in COLOURS.items()]
    keys += [plt.Line2D([], [], color="0.3", marker=m, mfc=f, ls=s, label=t) for m, f, s, t in
             (("o", "0.3", "-", "1,000 nodes"), ("s", "white", ":", "3,600 nodes"))]  # fmt: skip
    figure.legend(handles=keys, loc="outside upper center", ncols=8, frameon=False)
    with whole(file) as part:
        figure.savefig(part, dpi=110)


def write(rows, root):
    draw(rows, os.path.join(root, "docs", "pictures", "peers.png"))
    file = os.path.join(root, "docs", "peers.md")
    with open(file, encoding="utf-8") as stream:
        text = stream.read()
    for name, made in (("peers: results", make_table(rows)), ("peers: cannot", cannots(rows))):
        text, count = re.subn(rf"(<!-- {name} -->\n).*?(<!-- end of peers -->)",
                              lambda found: f"{found[1]}{made}\n{found[2]}", text, flags=re.DOTALL)  # fmt: skip
        if count != 1:
            raise ValueError(f"{file} has no place for '{name}'; restore its marks")
    with open_whole(file) as stream:
        stream.write(text)
