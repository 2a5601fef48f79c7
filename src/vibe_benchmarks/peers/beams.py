"""Planar beams: truths of the sheet that falls and of the strip that is folded."""

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp


def fold(length, gap, bending, places):
    """A strip whose ends are clamped parallel, a gap apart: Euler's elastica. @returns x and z at arc lengths `places`
    from the first end, which starts along z, and the force per width that holds the ends together [N/m]."""
    def slopes(s, y, p):  # angle to x, curvature, x, z; lengths over the whole length
        return np.stack([y[1], p[0] * np.sin(y[0]), np.cos(y[0]), np.sin(y[0])])

    def ends(a, b, p):
        return np.array([a[0] - np.pi / 2, a[2], a[3], b[0] + np.pi / 2, b[2] - gap / length])

    s = np.linspace(0, 1, 201)
    angle = np.pi * (0.5 - s)
    start = np.stack([angle, 0 * s - np.pi, (1 - np.sin(angle)) / np.pi, np.cos(angle) / np.pi])
    found = solve_bvp(slopes, ends, s, start, p=[0.0], tol=1e-8, max_nodes=20000)
    if not found.success:
        raise RuntimeError(f"the elastica at a gap of {gap:.3g} m: {found.message}; choose a larger gap")
    return length * found.sol(np.asarray(places) / length)[2:], -found.p[0] * bending / length**2


def chain(length, young, thickness, density, parts):
    """Masses per width, stiffness of links and hinges, and the forces on nodes (x, z) of a chain that is hinged at its
    first node: a beam that bends and stretches, of second order in 1 / parts."""
    h = length / parts
    mass = np.full(parts + 1, density * thickness * h)
    mass[[0, -1]] /= 2
    stretch, bend = young * thickness / h, young * thickness**3 / 12 / h

    def forces(x):  # (2, node)
        d = np.diff(x)
        size = np.hypot(*d)
        t = d / size
        normal = np.stack([-t[1], t[0]])
        angle = np.arctan2(t[0, :-1] * t[1, 1:] - t[1, :-1] * t[0, 1:], (t[:, :-1] * t[:, 1:]).sum(0))
        moment = np.concatenate([[0], bend * angle, [0]])  # at nodes
        pull = stretch * (size - h) * t - normal * np.diff(moment) / size
        out = np.zeros_like(x)
        out[:, :-1] += pull
        out[:, 1:] -= pull
        return out

    return mass, forces


def falling(length, young, thickness, density, gravity, times, parts=80):
    """Displacements of the middle and the end (time, probe, xyz) of a sheet without damping that starts level."""
    mass, forces = chain(length, young, thickness, density, parts)
    rest = np.stack([np.linspace(0, length, parts + 1), np.zeros(parts + 1)])

    def slopes(_, state):
        x, v = state.reshape(2, 2, -1)
        a = forces(x) / mass
        a[1] -= gravity
        a[:, 0] = 0
        return np.concatenate([v.ravel(), a.ravel()])

    n = parts + 1
    start = np.concatenate([rest.ravel(), np.zeros(2 * n)])
    found = solve_ivp(slopes, (0, times[-1]), start, "DOP853", times, rtol=1e-6, atol=1e-9)
    moved = found.y.T.reshape(len(times), 2, 2, n)[:, 0] - rest
    probes = moved[:, :, [parts // 2, parts]].swapaxes(1, 2)
    return np.stack([probes[..., 0], 0 * probes[..., 0], probes[..., 1]], -1)
