"""Six scenes with a soft wall: mesh, material, loads over time, quantity asked and truth, for every engine. SI units."""

import csv
import os
import sys
from dataclasses import dataclass, field

import numpy as np

import beams
from meshes import grid, interpolation, ringed_plate, sphere

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "../../vibe_sessions/src"))  # for whole_file, which needs the standard library only
REFERENCE = os.path.join(os.path.dirname(HERE), "reference")
FRAME = 1 / 60  # of recorded positions [s]
GRAVITY = 9.81
NAMES = ("pressed", "bite", "cinch", "sheet", "drag", "fold")


@dataclass
class Motion:
    """A rotation about an axis through a centre, then a translation; both grow from time `start` to `end` [s]."""
    translation: tuple = (0, 0, 0)
    start: float = 0
    end: float = 1
    centre: tuple = (0, 0, 0)
    turn: float = 0  # about y [rad]
    axes: str = "xyz"  # that it prescribes

    def part(self, time):
        return float(np.clip((time - self.start) / (self.end - self.start), 0, 1))


@dataclass
class Hold:
    """Nodes that move together, in all three directions unless the motions are empty and only the places matter."""
    nodes: np.ndarray
    motions: list = field(default_factory=list)

    def turned(self, time):
        return sum(m.turn * m.part(time) for m in self.motions)

    def at(self, rest, time):
        """Places of points that move with the hold."""
        places = rest.copy()
        for m in self.motions:
            angle, from_centre = m.turn * m.part(time), places - m.centre
            x, z = from_centre[:, 0].copy(), from_centre[:, 2].copy()
            from_centre[:, 0] = np.cos(angle) * x + np.sin(angle) * z
            from_centre[:, 2] = np.cos(angle) * z - np.sin(angle) * x
            places = from_centre + m.centre + m.part(time) * np.array(m.translation)
        return places


@dataclass
class Thread:
    """An ideal thread along x between the weighted means of two spots, drawn in to a distance within a second."""
    plus: tuple  # nodes, weights
    minus: tuple
    distance: float  # at the end [m]

    def length(self, positions):
        return sum(s * w @ positions[n, 0] for s, (n, w) in ((1, self.plus), (-1, self.minus)))


@dataclass
class Scene:
    name: str
    nodes: np.ndarray
    triangles: np.ndarray
    duration: float  # [s]
    holds: dict  # name: Hold
    probes: np.ndarray  # places at rest whose displacement is asked
    truth: np.ndarray  # displacement of the probes, at the end or at every frame (frame, probe, xyz); NaN: not asked
    young: float = 40e3
    poisson: float = 0.45
    thickness: float = 3.5e-3
    density: float = 1050
    thickness_along_z: bool = False
    gravity: float = 0  # along -z [m/s^2]
    pressure: float = 0  # within the closed surface, reached after a second [Pa]
    thread: Thread = None
    force: tuple = None  # (hold or "thread", direction, truth [N])
    line: np.ndarray = None  # nodes whose energy is followed
    hinged: bool = False  # a single row of nodes is held

    def __post_init__(self):
        self.corners, self.weights = interpolation(self.nodes, self.triangles, self.probes)
        record = self.corners.ravel() if self.line is None else np.concatenate([self.corners.ravel(), self.line])
        self.record = np.unique(record)

    @property
    def bending(self):
        return self.young * self.thickness**3 / 12 / (1 - self.poisson**2)

    def areas(self):
        a, b, c = (self.nodes[self.triangles[:, k]] for k in range(3))
        cross = np.cross(b - a, c - a) / 2
        flat = abs(cross[:, 2]) / np.linalg.norm(cross, axis=1) if self.thickness_along_z else 1.0
        return np.linalg.norm(cross, axis=1), self.thickness * flat

    def masses(self):
        area, thickness = self.areas()
        share = np.repeat((area * thickness)[:, None] * self.density / 3, 3, 1)
        return np.bincount(self.triangles.ravel(), share.ravel(), len(self.nodes))

    def asked(self, recorded):
        """Displacements of the probes, from those of the recorded nodes (..., node, xyz)."""
        rows = np.searchsorted(self.record, self.corners)
        return np.einsum("pk,...pkc->...pc", self.weights, recorded[..., rows, :])

    def error(self, recorded):
        """sqrt(sum d^2 / sum truth^2) of displacements of the recorded nodes at every frame, the start first."""
        found = self.asked(recorded)
        found = found[1:1 + len(self.truth)] if self.truth.ndim == 3 else found[-1]
        asked = ~np.isnan(self.truth)
        return float(np.sqrt(((found - self.truth)[asked] ** 2).sum() / (self.truth[asked] ** 2).sum()))

    def energy_gain(self, recorded):
        """Largest gain of kinetic and potential energy over that at the start, over the potential energy of a fall by
        the length of the line (ratio); velocities by central differences of frames."""
        x = recorded[:, np.searchsorted(self.record, self.line)]
        mass = np.gradient(self.nodes[self.line, 0])
        mass[[0, -1]] /= 2
        speed = (x[2:] - x[:-2]) / (2 * FRAME)
        energy = (mass * (0.5 * (speed**2).sum(-1) + self.gravity * x[1:-1, :, 2])).sum(-1)
        return max(0.0, energy.max()) / (mass.sum() * self.gravity * np.ptp(self.nodes[self.line, 0]))


def fields(name, level):
    """Places and displacements of a reference table of the benchmark cases, at one level."""
    with open(os.path.join(REFERENCE, name), encoding="utf-8") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    rows = [r for r in rows if abs(float(r["level"]) - level) < 1e-6]
    numbers = [[float(r[c] or "nan") for c in ("x", "y", "z", "ux", "uy", "uz")] for r in rows]
    return np.array(numbers)[:, :3], np.array(numbers)[:, 3:]


def stored(name):
    """Places, displacements and force of truths.csv, which truths.py makes."""
    with open(os.path.join(HERE, "truths.csv"), encoding="utf-8") as stream:
        rows = [r for r in csv.DictReader(line for line in stream if not line.startswith("#")) if r["scene"] == name]
    table = np.array([[float(r[c] or "nan") for c in ("x", "y", "z", "ux", "uy", "uz")] for r in rows if r["x"]])
    force = [float(r["force"]) for r in rows if r["force"]]
    return table[:, :3], table[:, 3:], force[0] if force else None


def plate(large):
    spokes, inside, rings = (72, 3, 46) if large else (40, 2, 22)
    nodes, triangles = ringed_plate(0.05, 0.005, inside, rings, spokes, collar=0.003)
    edge = np.arange(len(nodes) - 2 * spokes, len(nodes))
    return nodes, triangles, edge, np.arange(1 + inside * spokes)


def bite(large=False):
    nodes, triangles, edge, disc = plate(large)
    probes, truth = fields("case6_profile.csv", 1)
    lift = Hold(disc, [Motion((0, 0, 0.03))])
    return Scene("bite", nodes, triangles, 1.5, {"edge": Hold(edge), "disc": lift}, probes, truth,
                 force=("disc", (0, 0, 1), 1.8845))  # fmt: skip


def drag(large=False):
    nodes, triangles, edge, disc = plate(large)
    probes, truth, force = stored("drag")
    moves = Hold(disc, [Motion((0, 0, 0.02), axes="yz"), Motion((0.02, 0, 0), 1, 2, axes="x")])
    return Scene("drag", nodes, triangles, 2.5, {"edge": Hold(edge), "disc": moves}, probes, truth,
                 force=("disc", (1, 0, 0), force))  # fmt: skip


def spot(nodes, masses, x, radius=0.005):
    weight = masses * np.clip(1 - ((nodes[:, 0] - x) ** 2 + nodes[:, 1] ** 2) / radius**2, 0, None) ** 2
    inside = np.flatnonzero(weight)
    return inside, weight[inside] / weight.sum()


def cinch(large=False):
    line = np.linspace(-0.05, 0.05, 58 if large else 30)
    line = np.concatenate([[-0.052], line, [0.052]])
    nodes, triangles = grid(line, line)
    inside = abs(nodes[:, :2]).max(1) < 0.05 - 1e-9
    nodes[inside, 2] = 0.004 * (np.cos(np.pi * nodes[inside, :2] / 0.1) ** 2).prod(1)
    probes, truth = fields("case7_field.csv", 1)
    scene = Scene("cinch", nodes, triangles, 1.5, {"edge": Hold(np.flatnonzero(~inside))}, probes, truth,
                  thickness_along_z=True, force=("thread", None, 1.6781))  # fmt: skip
    scene.thread = Thread(spot(nodes, scene.masses(), 0.02), spot(nodes, scene.masses(), -0.02), 0.01)
    return scene


STRIP, WIDTH = 0.1, 0.02  # of sheet and fold [m]


def sheet(large=False):
    x, y = np.linspace(0, STRIP, 134 if large else 67), np.linspace(-WIDTH / 2, WIDTH / 2, 27 if large else 15)
    nodes, triangles = grid(x, y)
    line = np.flatnonzero(abs(nodes[:, 1]) < 1e-9)
    probes = np.array([[STRIP / 2, 0, 0], [STRIP, 0, 0]])
    truth = beams.falling(STRIP, 50e3, 3.5e-3, 1050, GRAVITY, np.arange(1, 31) * FRAME)
    return Scene("sheet", nodes, triangles, 1.0, {"hinge": Hold(np.flatnonzero(nodes[:, 0] < 1e-9))}, probes, truth,
                 young=50e3, poisson=0.0, gravity=GRAVITY, line=line, hinged=True)  # fmt: skip


GAP = 0.03  # of the ends of the fold [m]


def fold(large=False):
    x, y = np.linspace(0, STRIP, 130 if large else 65), np.linspace(-WIDTH / 2, WIDTH / 2, 27 if large else 15)
    x = np.concatenate([[-0.002], x, [STRIP + 0.002]])
    nodes, triangles = grid(x, y)
    # each end turns by a right angle about a point that brings the ends to the gap and does not press the strip early
    ahead, below = (STRIP - GAP) / 2 + 0.005, -0.005
    ends = {"left": Hold(np.flatnonzero(nodes[:, 0] < 1e-9), [Motion(centre=(ahead, 0, below), turn=-np.pi / 2)]),
            "right": Hold(np.flatnonzero(nodes[:, 0] > STRIP - 1e-9),
                          [Motion(centre=(STRIP - ahead, 0, below), turn=np.pi / 2)])}  # fmt: skip
    places = np.linspace(0.1, 0.9, 9) * STRIP
    bending = 50e3 * 3.5e-3**3 / 12
    shape, force = beams.fold(STRIP, GAP, bending, places)
    probes = np.stack([places, 0 * places, 0 * places], 1)
    truth = np.stack([shape[0] + ahead + below - places, 0 * places, shape[1] + below - ahead], 1)
    return Scene("fold", nodes, triangles, 1.5, ends, probes, truth, young=50e3, poisson=0.0,
                 force=("left", (1, 0, 0), force * WIDTH))  # fmt: skip


BALL, CAP, SOUTH = 0.04, 0.01, np.radians(150)  # radius, radius of the disc, polar angle of the held bowl


def pressed(large=False):
    spokes, inside, rings = (72, 5, 46) if large else (40, 3, 23)
    nodes, triangles = sphere(BALL, CAP, inside, rings, spokes)
    polar = np.arccos(np.clip(nodes[:, 2] / BALL, -1, 1))
    probes, truth, _ = stored("pressed")
    holds = {"bowl": Hold(np.flatnonzero(polar > SOUTH - 1e-6)),
             "disc": Hold(np.arange(1 + inside * spokes), [Motion((0, 0, -0.015))])}  # fmt: skip
    return Scene("pressed", nodes, triangles, 1.5, holds, probes, truth, young=50e3, pressure=1e3)


def make(name, large=False):
    return globals()[name](large)
