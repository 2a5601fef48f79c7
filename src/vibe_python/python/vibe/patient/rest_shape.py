"""The shape without load of an organ that was imaged under pressure (inverse inflation), by fixed-point iteration:
X += x_image - x(X), where x(X) is the equilibrium under that pressure of an organ at rest in X (Sellier 2011)."""

import numpy as np

import vibe

from .label_map import need
from .mesh import model_of

_ITERATIONS = 10
_ACCURATE = 0.2e-3  # root mean square [m]
_PARTICLES = 1500  # of the organ that is inflated, whatever the scene has: the displacement is smooth
_WIDTH = 6e-3  # of the kernel that carries it to the surface [m]; what is finer would be amplified, since tension smooths ripples out
_NEIGHBOURS = 20
_WINDOW = 5  # iterations that are mixed
_SETTLING = 5  # simulated time [s]
_STILL = 1e-4  # [m/s]


def unload(vertices, triangles, landmarks, tissue, pressure):
    """(vertices at rest, residual: root mean square and greatest distance [m], volume of the simulated organ at the pressure [m^3]).
    pressure in [Pa]."""
    correction = np.zeros_like(vertices)
    corrections, errors, best = [], [], None
    for _ in range(_ITERATIONS):
        try:
            error, volume = _inflate(vertices, vertices + correction, triangles, landmarks, tissue, pressure)
        except vibe.Error:  # it passes through itself
            break
        distance = np.linalg.norm(error, axis=1)
        residual = np.sqrt(np.mean(distance**2))
        if best is None or residual < best[1][0]:
            best = vertices + correction, (residual, distance.max()), volume
        if residual < _ACCURATE or residual > 2 * best[1][0]:
            break
        corrections.append(correction)
        errors.append(error)
        correction = _next(corrections[-_WINDOW:], errors[-_WINDOW:])
    return best


def _next(corrections, errors):
    """Anderson's acceleration: the fixed-point step from the mixture of the last corrections that has the least error."""
    if len(errors) == 1:
        return corrections[0] + errors[0]
    steps = np.stack([(errors[-1] - e).ravel() for e in errors[:-1]], axis=1)
    share = np.linalg.lstsq(steps, errors[-1].ravel(), rcond=1e-3)[0]
    before = sum(s * (corrections[-1] + errors[-1] - c - e) for s, c, e in zip(share, corrections, errors))
    return corrections[-1] + errors[-1] - before


def _inflate(goal, rest, triangles, landmarks, tissue, pressure):
    """Under the pressure: what the surface misses of the goal, and the volume of the organ."""
    gas = {"initial_pressure": pressure, "regulated_pressure": pressure, "flow_limit": 0.01, "insufflator_on": True}
    nearest = np.array([np.linalg.norm(goal - landmarks[name], axis=1).argmin() for name in landmarks])
    moved = {name: (np.asarray(landmarks[name]) + rest[k] - goal[k]).tolist() for name, k in zip(landmarks, nearest)}
    model, surface = model_of(rest, triangles, {"landmarks": moved, "particles": _PARTICLES}, tissue=tissue, gas=gas)
    simulation = vibe.Simulation(model, metrics=False, impedance=False)
    for _ in range(_SETTLING):
        simulation.run(round(1 / model.step_period))
        if np.abs(simulation.velocities).max() < _STILL:
            break
    distance, near = need("scipy.spatial", "python3-scipy").cKDTree(model.rest_positions).query(surface, _NEIGHBOURS)
    weight = np.exp(-((distance / _WIDTH) ** 2) / 2)
    weight /= weight.sum(axis=1, keepdims=True)
    error = goal - rest - np.einsum("ij,ijk->ik", weight, (simulation.positions - model.rest_positions)[near])
    return error, simulation.volume
