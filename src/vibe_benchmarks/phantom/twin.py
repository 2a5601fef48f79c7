"""The twin of the phantom: its scene file, and what the simulator predicts for each measurement."""
import hashlib
import json

import numpy as np

import vibe
from protocol import FORCES, QUANTITIES
from vibe_sessions.whole_file import open_whole

MMHG = 133.322  # [Pa]
SPRING = 300.0  # of the pull of vibe.Simulation [N/m]
STRONGEST = 5.0  # of that pull [N]; what takes more is not predicted
PATCH = 6e-3  # radius of the patch that it pulls [m]: that of the pad on the phantom
SPEED = 0.01  # of a pull [m/s]
FORCE_RATE = 0.03  # of the thread's tension [N/s]; half of this, or of SPEED, changes no force by more than 0.4 %

SCENE = """# Twin of a silicone stomach (docs/phantom.md). It hangs by its two ends, with the greater curvature below.
name: phantom
geometry: {{kind: stomach, scale: {scale:g}}}
tissue:
  law: neo_hookean
  young_modulus: {modulus:.6g}  # [Pa], of the cylinder of the same batch
  poisson_ratio: 0.49  # silicone keeps its volume
  density: 1070  # [kg/m^3], Ecoflex 00-30
  thickness: {{cardia: {wall:.4g}, fundus: {wall:.4g}, body: {wall:.4g}, antrum: {wall:.4g}, pylorus: {wall:.4g}}}  # [m]
  self_contact: true
attachments: {{oesophagus: true, duodenum: true}}
gas: {{regulated_pressure: 5 mmHg, flow_limit: 1 L/min}}
gravity: {{acceleration: [{down[0]:.4f}, {down[1]:.4f}, {down[2]:.4f}]}}
"""


def organ(scale):
    """The stomach without stress, as the mould makes it."""
    return vibe.load(geometry={"scale": scale}, gas={"initial_pressure": 500})


def ends(model):
    """Oesophagus, then duodenum: numbers of the held particles, unit vector out of the organ, radius of the tube [m]."""
    rest, corners = model.rest_positions, np.asarray(model.triangles)
    simulation = vibe.Simulation(model, impedance=False, metrics=False)
    simulation.run(3)  # what the gas does not move is held
    held = (simulation.positions == rest).all(axis=1)
    capped = corners[held[corners].all(axis=1)]
    areas = np.cross(rest[capped[:, 1]] - rest[capped[:, 0]], rest[capped[:, 2]] - rest[capped[:, 0]]) / 2
    upper = rest[:, 2] > rest[held, 2].mean()
    found = []
    for side in (upper, ~upper):
        opening = areas[side[capped[:, 0]]].sum(axis=0)  # the area that the held part closes
        size = np.linalg.norm(opening)
        found.append((np.flatnonzero(held & side), opening / size, np.sqrt(size / np.pi)))
    return found


def pad_particle(model):
    """The particle in the middle of the greater curvature, where the pad is."""
    triangle, weight = vibe.Anatomy(vibe.Simulation(model, impedance=False)).at(0.5, 0)
    return int(model.triangles[triangle][np.argmax(weight)])


def scene(modulus, wall, scale):
    """Text of the scene file; modulus [Pa], wall [m]."""
    model = organ(scale)
    rest = model.rest_positions
    first, second = (rest[held].mean(axis=0) for held, _, _ in ends(model))
    line = (second - first) / np.linalg.norm(second - first)
    sag = np.average(rest, axis=0, weights=model.area) - first
    down = sag - sag @ line * line
    return SCENE.format(modulus=modulus, wall=wall, scale=scale, down=9.81 * down / np.linalg.norm(down))


class Bench:
    """The twin on the bench, at 5 mmHg with the valve closed, and one pad that is pulled."""

    def __init__(self, model):
        self.particle = pad_particle(model)
        self.eyelet = model.rest_positions[ends(model)[0][0]].mean(axis=0)
        away = np.linalg.norm(model.rest_positions - model.rest_positions[self.particle], axis=1) / PATCH
        self.patch = np.flatnonzero(away < 1)
        share = model.area[self.patch] * (1 - away[self.patch] ** 2)
        self.share = share / share.sum()
        self.simulation = vibe.Simulation(model, impedance=False, metrics=False)
        self.simulation.run(120)
        self.fill = self._fill(lambda: self.simulation.pressure >= 5 * MMHG)
        self.simulation.run(120, insufflate=False)
        self.start = self.simulation.snapshot()

    def _fill(self, full):
        """Volumes and pressures on the way until it is full."""
        curve, most = [], self.simulation.volume + 1e-3
        while not full():
            self.simulation.step(insufflate=True)
            curve.append((self.simulation.volume, self.simulation.pressure))
            if self.simulation.volume > most:
                raise ValueError("The twin gives way at less than 5 mmHg; check modulus and thickness of its wall.")
        return curve

    def held(self):
        return self.share @ self.simulation.positions[self.patch]

    def filled(self, at):
        """Pressure [mmHg] after adding volumes [L] from 1 mmHg."""
        self.simulation.restore(self.start)
        zero = np.interp(MMHG, *np.array(self.fill).T[::-1])
        wanted = zero + 1e-3 * np.array(at)
        curve = self.fill + self._fill(lambda: self.simulation.volume > wanted.max())
        return np.interp(wanted, *np.array(curve).T) / MMHG

    def pulled(self, at, sign):
        """Force [N] when the pad has been moved by distances [mm] along the normal, outwards (sign 1) or inwards (-1)."""
        self.simulation.restore(self.start)
        way, begin, curve = sign * self.simulation.normals[self.particle], self.held(), [(0.0, 0.0)]
        target = 0.0
        while curve[-1][0] < max(at) and curve[-1][1] < STRONGEST:
            target += SPEED * self.simulation.model.step_period
            self.simulation.step(pull=(self.particle, begin + target * way))
            moved = (self.held() - begin) @ way
            curve.append((1e3 * moved, SPRING * (target - moved)))
        return np.interp(at, *np.array(curve).T, right=np.nan)

    def cinched(self, at):
        """Tension [N] of a thread from the pad to the eyelet in the oesophagus that has been drawn in by lengths [mm]."""
        self.simulation.restore(self.start)
        length, tension, curve = np.linalg.norm(self.eyelet - self.held()), 0.0, [(0.0, 0.0)]
        while curve[-1][0] < max(at) and tension < STRONGEST:
            tension += FORCE_RATE * self.simulation.model.step_period
            held = self.held()
            way = (self.eyelet - held) / np.linalg.norm(self.eyelet - held)
            self.simulation.step(pull=(self.particle, held + tension / SPRING * way))
            curve.append((1e3 * (length - np.linalg.norm(self.eyelet - self.held())), tension))
        return np.interp(at, *np.array(curve).T, right=np.nan)


def predict(text, folder):
    """What the twin of a scene predicts: readings by measurement, in the order of the settings, NaN where a force is above
    STRONGEST. Takes a minute the first time and is kept in a file of the folder after that."""
    kept = folder / f"twin_{hashlib.sha256((text + repr(QUANTITIES)).encode()).hexdigest()[:12]}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    file = kept.with_suffix(".yaml")
    with open_whole(file) as stream:
        stream.write(text)
    bench = Bench(vibe.load(file, gas={"regulated_pressure": "100 mmHg"}))  # it is filled by volume
    at = {name: QUANTITIES[name].at for name in ["fill"] + FORCES}
    found = {"fill": bench.filled(at["fill"]), "press": bench.pulled(at["press"], -1),
             "pull": bench.pulled(at["pull"], 1), "cinch": bench.cinched(at["cinch"])}
    found = {name: [round(float(value), 4) for value in values] for name, values in found.items()}
    with open_whole(kept) as stream:
        json.dump(found, stream)
    return found
