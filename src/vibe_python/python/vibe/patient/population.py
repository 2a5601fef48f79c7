"""vibe_population: scenes of stomachs that differ as those of patients do. Every number is drawn from a published distribution, or
is a design choice that says so."""

import argparse
import math
import os

import numpy as np

import vibe

from .label_map import need
from .mesh import WALL_ALONE
from .painting import paint, plotting

_MMHG = 133.322  # [Pa]
#: shapes and their shares among 397 scintigraphies (Lee 2025, doi 10.1111/nmo.14968: crescentic 41.8, J 34.0, reversed L 19.9 %, others
#: left out). That a crescent is our steer horn and a reversed L our sthenic type is a design choice.
SHAPES = {"steer_horn": 41.8, "j": 34.0, "sthenic": 19.9}
#: of the default scene: what the modulus is scaled from
_MODULUS, _COMPLIANCE, _VOLUME, _WALL = 110e3, 36.1e-6, 0.9e-3, 2.33e-3  # [Pa], [m^3/mmHg], [m^3], [m]
_CORRELATION = 0.8  # of volume and compliance (of the normal numbers behind them), not published: a larger organ of the same wall is more compliant
_PRESSURE = 10.0  # of gastroscopy [mmHg]
_LEAST_REST = 0.5  # share of the volume at that pressure

#: measure: unit, factor, mean, standard deviation, range, source
PUBLISHED = {
    "volume at 10 mmHg": ("mL", 1e6, 1310, 307, (800, 1800), "98 obese patients, gas-distended CT, pressure not stated (El-Sayes 2020)"),
    "compliance at 10 mmHg": ("mL/mmHg", 1e6, 36.1, 14.7, (14.3, 85.7), "84 resected specimens (Toro 2015)"),
    "wall of the body": ("mm", 1e3, 2.33, 0.47, (1.2, 3.6), "mean: 50 specimens; spread: 2.0 +- 0.4 mm of the anterior body on CT (Pickhardt 2003)"),
    "width of the fundus": ("1", 1, 1, 0.06, (0.9, 1.25), "design choice"),
    "angle of the antrum": ("deg", 180 / math.pi, 0, 8, (-25, 25), "design choice"),
}
_WALLS = {"cardia": 1.97, "fundus": 1.97, "body": 2.33, "antrum": 2.70, "pylorus": 2.70}  # [mm], their ratios

_SCENE = """# Written by vibe_population, seed {seed}, number {number}.
base: package://vibe_core/scenes/stomach.yaml
name: stomach_{number:03d}
seed: {number}
geometry:
  shape: {shape}
  volume: {volume:.4f} L # at rest
  fundus_width: {fundus:.4f}
  antrum_angle: {antrum:.3f} deg
tissue:
  young_modulus: {modulus:.2f} kPa
  thickness: {{{walls}}}
"""


def _quantile(name, share):
    """Of the beta distribution that has the mean, the standard deviation and the range [SI units]."""
    _, factor, mean, spread, (least, most), _ = PUBLISHED[name]
    m, variance = (mean - least) / (most - least), (spread / (most - least)) ** 2
    both = m * (1 - m) / variance - 1
    return (least + (most - least) * float(need("scipy.special", "python3-scipy").betaincinv(m * both, (1 - m) * both, share))) / factor


def draw(random):
    """One stomach: dictionary of what its scene states, in SI units."""
    normal = need("scipy.special", "python3-scipy").ndtr
    while True:
        z = random.normal(size=2)
        volume = _quantile("volume at 10 mmHg", normal(z[0]))
        compliance = _quantile("compliance at 10 mmHg", normal(_CORRELATION * z[0] + math.sqrt(1 - _CORRELATION**2) * z[1]))
        rest = volume - _PRESSURE * compliance
        if rest > _LEAST_REST * volume:
            break
    wall = _quantile("wall of the body", random.random())
    # a thin sphere: volume per pressure goes with volume times radius over modulus times wall
    modulus = _MODULUS * (_COMPLIANCE / compliance) * (rest / _VOLUME) ** (4 / 3) * _WALL / wall
    words, shares = zip(*SHAPES.items())
    return {"shape": str(random.choice(words, p=np.array(shares) / sum(shares))), "volume": rest, "wall": wall, "modulus": modulus,
            "fundus": _quantile("width of the fundus", random.random()), "antrum": _quantile("angle of the antrum", random.random())}


def scene_text(stomach, number, seed):
    walls = ", ".join(f"{name}: {value * 1e3 * stomach['wall'] / _WALLS['body']:.3f} mm" for name, value in _WALLS.items())
    return _SCENE.format(seed=seed, number=number, shape=stomach["shape"], volume=1e3 * stomach["volume"], fundus=stomach["fundus"],
                         antrum=math.degrees(stomach["antrum"]), modulus=1e-3 * stomach["modulus"], walls=walls)


def measure(scene, stomach):
    """What the stomach does under gas: dictionary by the names of PUBLISHED, in SI units, of 1,000 particles."""
    gas = {"regulated_pressure": _MMHG * (_PRESSURE + 2.5), "flow_limit": 2e-4, "insufflator_on": True}  # slow enough to stay in equilibrium
    model = vibe.load(scene, geometry={"particles": 1000}, gas=gas, render_surface=False, **WALL_ALONE)
    simulation = vibe.Simulation(model, metrics=False, impedance=False)
    course = [(simulation.pressure, simulation.volume)]
    while course[-1][0] < _MMHG * (_PRESSURE + 2) and len(course) < 2000:
        simulation.step()
        course.append((simulation.pressure, simulation.volume))
    volumes = np.interp(_MMHG * np.array([_PRESSURE - 2, _PRESSURE, _PRESSURE + 2]), *np.transpose(course))
    return {"volume at 10 mmHg": volumes[1], "compliance at 10 mmHg": (volumes[2] - volumes[0]) / 4, "wall of the body": stomach["wall"],
            "width of the fundus": stomach["fundus"], "angle of the antrum": stomach["antrum"]}


def move(scene, seconds=10.0):
    """What goes wrong in ten seconds with gas and a scope that moves in, turns and bends, of 1,000 particles: list of sentences."""
    model = vibe.load(scene, geometry={"particles": 1000}, render_surface=False)
    simulation = vibe.Simulation(model, impedance=False)
    steps = round(seconds / model.step_period / 4)
    events = []
    for insertion, angle, bend in ((0.05, 0.5, 0.2), (0.10, 1.0, 0.5), (0.14, 0.0, -0.5), (0.08, -0.5, 0.0)):
        events += simulation.run(steps, insertion=insertion, rotation=angle, tip_up_down=bend, insufflate=True)
    wrong = [event.text for event in events if event.kind == "recovery"]
    if not np.isfinite(simulation.positions).all():
        wrong.append("A position is not a number.")
    return wrong


def table(measured):
    """Lines of Markdown: what was measured against what is published."""
    lines = ["| | unit | published: mean +- SD (range) | here: mean +- SD (range) | source |", "|---|---|---|---|---|"]
    for name, (unit, factor, mean, spread, (least, most), source) in PUBLISHED.items():
        values = factor * np.array([m[name] for m in measured])
        lines.append(f"| {name} | {unit} | {mean:g} +- {spread:g} ({least:g} to {most:g}) | {values.mean():.4g} +- {values.std():.3g} "
                     f"({values.min():.4g} to {values.max():.4g}) | {source} |")
    return lines


def draw_row(scenes, file):
    """The first ten from the front, in one scale."""
    pyplot = plotting()
    figure = pyplot.figure(figsize=(15, 6.4))
    for k, scene in enumerate(scenes[:10]):
        model = vibe.load(scene, geometry={"particles": 2000}, render_surface=False, **WALL_ALONE)
        axes = figure.add_subplot(2, 5, k + 1, projection="3d", proj_type="ortho", computed_zorder=False)
        paint(axes, model, 0, reach=105)
        axes.set_axis_off()
        axes.set_title(f"{os.path.basename(scene)[:-5]}, {1e6 * vibe.Simulation(model).volume:.0f} mL", y=0.92, fontsize=10)
    figure.subplots_adjust(left=0, right=1, bottom=0, top=1, wspace=0, hspace=0)
    figure.savefig(file, dpi=80)
    pyplot.close(figure)


def parse(words):
    parser = argparse.ArgumentParser("vibe_population", allow_abbrev=False, description="Writes scenes of stomachs that differ as those of patients do, "
                                     "and a table of what they measure against what is published (docs/patients.md).")
    parser.add_argument("--count", type=int, default=100, metavar="N", help="how many (default: 100)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="equal seeds give equal stomachs (default: 1)")
    parser.add_argument("--output", default="stomachs", metavar="DIR", help="folder for stomach_000.yaml, ..., population.md and population.png (default: stomachs)")
    parser.add_argument("--move", action="store_true", help="also moves the scope in each for ten seconds, and tells what goes wrong; takes minutes")
    arguments = parser.parse_args(words)
    if not 1 <= arguments.count <= 1000 or arguments.seed < 0:
        parser.error("--count needs 1 to 1000, --seed 0 or more")
    return arguments


def main(words=None):
    arguments = parse(words)
    os.makedirs(arguments.output, exist_ok=True)
    measured, wrong, scenes = [], [], []
    for number in range(arguments.count):
        stomach = draw(np.random.default_rng([arguments.seed, number]))
        scenes.append(os.path.join(arguments.output, f"stomach_{number:03d}.yaml"))
        with open(scenes[-1], "w", encoding="utf-8") as text:
            text.write(scene_text(stomach, number, arguments.seed))
        measured.append(measure(scenes[-1], stomach))
        if arguments.move:
            wrong += [f"{scenes[-1]}: {sentence}" for sentence in move(scenes[-1])]
    draw_row(scenes, os.path.join(arguments.output, "population.png"))
    lines = table(measured)
    with open(os.path.join(arguments.output, "population.md"), "w", encoding="utf-8") as out:
        out.write(f"# {arguments.count} stomachs, seed {arguments.seed}\n\n" + "\n".join(lines) + "\n")
    print("\n".join(lines + wrong))
    return 1 if wrong else 0


