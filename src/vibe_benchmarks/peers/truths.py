"""Makes truths.csv: the pressed ball and the dragged disc as quadratic solids, each on two meshes; 5 minutes."""

import csv
import os

import numpy as np
import scipy.sparse as sparse

import beams
import scenes
from meshes import grid, prisms, ringed_plate
from scenes import BALL, CAP, HERE, SOUTH, STRIP, WIDTH
from solid import Solid
from vibe_sessions.whole_file import open_whole

COLUMNS = ("scene", "x", "y", "z", "ux", "uy", "uz", "force", "uncertainty")
T = 3.5e-3  # thickness [m]


def half_plate(rings, spokes):
    """The half y >= 0 of the plate of the scenes bite and drag."""
    nodes, triangles = ringed_plate(0.05, 0.005, 2, rings, spokes)
    kept = (nodes[triangles, 1] > -1e-9).all(1)
    used = np.unique(triangles[kept])
    return nodes[used], np.searchsorted(used, triangles[kept])


def dragged(rings, spokes, points, layers=1):
    """Displacements at points of the mid-plane, and the force along x on the disc."""
    body = Solid(*prisms(*half_plate(rings, spokes), T, layers), 40e3, 0.45)
    place = body.places
    edge = np.flatnonzero(abs(place[:, :2]).max(1) > 0.05 - 1e-9)
    disc = np.flatnonzero(np.hypot(place[:, 0], place[:, 1]) < 0.005 + 1e-9)
    held = {3 * n + 1: 0.0 for n in np.flatnonzero(place[:, 1] < 1e-9)}
    held.update({3 * n + c: 0.0 for n in edge for c in range(3)})
    u = None
    for aside, steps in ((0, 6), (0.02, 16)):
        held.update({3 * n + c: (aside, 0, 0.02)[c] for n in disc for c in range(3)})
        u, force = body.settle(held, steps=steps, tolerance=1e-7, start=u)
    return at(body, u, points), 2 * force[disc, 0].sum()


def at(body, u, points):
    """Displacements at points of a body."""
    shapes = body.basis.probes(np.array(points).T)  # rows: points
    return np.stack([shapes @ u[:, c] for c in range(u.shape[1])], 1)


def pushed(along, across, polar, pressure=1e3, push=-0.015):
    """Displacements (radius, height) of the mid-surface at polar angles of the ball that a disc presses."""
    cap = np.arcsin(CAP / BALL)
    angles = np.concatenate([np.linspace(0, cap, along // 6 + 1), np.linspace(cap, SOUTH, along)[1:],
                             np.linspace(SOUTH, np.pi, 4)[1:]])  # fmt: skip
    flat, triangles = grid(angles, np.linspace(-T / 2, T / 2, across + 1))
    on_ball = lambda p: np.stack([(BALL + p[:, 1]) * np.sin(p[:, 0]), (BALL + p[:, 1]) * np.cos(p[:, 0])], 1)
    body = Solid(on_ball(flat), triangles, 50e3, 0.45)
    place, angle = body.places, np.arctan2(*body.places.T)
    distance = np.hypot(*place.T)
    held = {2 * n: 0.0 for n in np.flatnonzero(place[:, 0] < 1e-9)}
    held.update({2 * n + c: (0, push)[c] for n in np.flatnonzero(angle < cap + 1e-6) for c in range(2)})
    held.update({2 * n + c: 0.0 for n in np.flatnonzero(angle > SOUTH - 1e-6) for c in range(2)})
    inner = np.flatnonzero(distance < (BALL - T / 2) * (1 + 1e-4))
    inner = inner[np.argsort(angle[inner])]
    gas = lambda u, level: gas_load(place, inner, u, level * pressure)
    u, _ = body.settle(held, gas, steps=6, tolerance=1e-8)
    points = BALL * np.stack([np.sin(polar), np.cos(polar)], 1)
    return at(body, u, points)


def gas_load(place, inner, u, pressure):
    """Forces of the gas on the nodes of the inner line, from the volume of the cones of its pieces, and their slope by
    differences: the volume below a straight piece is pi/3 (z0 - z1)(r0^2 + r0 r1 + r1^2)."""
    x = place + u.reshape(-1, 2)
    force, rows, columns, values = np.zeros(u.size), [], [], []
    first, second = inner[:-1], inner[1:]
    freedoms = np.stack([2 * first, 2 * first + 1, 2 * second, 2 * second + 1], 1)

    def local(q):
        r0, z0, r1, z1 = q.T
        square, height = r0**2 + r0 * r1 + r1**2, z0 - z1
        return pressure * np.pi / 3 * np.stack([height * (2 * r0 + r1), square, height * (2 * r1 + r0), -square], 1)

    q = x.ravel()[freedoms]
    np.add.at(force, freedoms, local(q))
    for c in range(4):
        ahead = q.copy()
        ahead[:, c] += 1e-7
        slope = (local(ahead) - local(q)) / 1e-7
        rows.append(freedoms)
        columns.append(np.repeat(freedoms[:, c:c + 1], 4, 1))
        values.append(slope)
    matrix = sparse.coo_matrix((np.ravel(values), (np.ravel(rows), np.ravel(columns))), (u.size, u.size))
    return force, matrix.tocsc()


def folded(along, across):
    """The mid-line (displacements) and the force per width of the fold as a solid in plane strain."""
    scene = scenes.fold()
    body = Solid(*(lambda p, t: (p[:, :2], t))(*grid(np.linspace(0, STRIP, along), np.linspace(-T / 2, T / 2, across))),
                 50e3, 0.0, revolved=False)  # fmt: skip
    rest = np.insert(body.places, 1, 0, 1)
    u = None
    for part in np.linspace(0, 1, 31)[1:]:
        held = {}
        for name, hold in scene.holds.items():
            end = np.flatnonzero(abs(rest[:, 0] - (0 if name == "left" else STRIP)) < 1e-9)
            moved = hold.at(rest[end], part) - rest[end]
            held.update({2 * n + c: m[2 * c] for n, m in zip(end, moved) for c in range(2)})
        u, force = body.settle(held, steps=1, tolerance=1e-8, start=u)
    left = np.flatnonzero(rest[:, 0] < 1e-9)
    return at(body, u, scene.probes[:, [0, 2]]), force[left, 0].sum()


def rows(scene, points, fine, coarse, force=None):
    """The values of the finer mesh; the uncertainty is the difference of both meshes over the size of the field."""
    spread = np.linalg.norm(fine - coarse) / np.linalg.norm(fine)
    for point, u in zip(points, fine):
        yield dict(zip(COLUMNS, [scene, *np.round(point, 9), *(f"{v:.6g}" for v in u)]))
    yield {"scene": scene, "force": force and f"{force[0]:.5g}",
           "uncertainty": f"{spread:.2g}" + (f" force {abs(force[1] / force[0] - 1):.2g}" if force else "")}  # fmt: skip


def beam_checks():
    """The uncertainty of the truths that are beams: the fold against a solid, the sheet against half as many parts."""
    middle, force = folded(121, 5)
    fold = scenes.fold()
    yield from rows("fold", [], middle, fold.truth[:, [0, 2]], (force * WIDTH, fold.force[2]))
    sheet = scenes.sheet()
    times = np.arange(1, len(sheet.truth) + 1) * scenes.FRAME
    half = beams.falling(STRIP, sheet.young, T, sheet.density, scenes.GRAVITY, times, 40)
    yield from rows("sheet", [], sheet.truth, sheet.truth + (half - sheet.truth) / 3)


def main():
    polar = np.radians(np.arange(20, 150, 10.0))
    points = BALL * np.stack([np.sin(polar), 0 * polar, np.cos(polar)], 1)
    coarse, fine = (np.insert(pushed(*mesh, polar), 1, 0, 1) for mesh in ((60, 2), (120, 4)))
    out = list(rows("pressed", points, fine, coarse))
    # within the half by a hair: a point on its plane of symmetry counts as outside
    line = np.array([-0.045, -0.035, -0.025, -0.018, -0.012, -0.0083, 0.0083, 0.012, 0.018, 0.025, 0.035, 0.045])
    points = np.concatenate([np.stack([line, 0 * line + 1e-7, 0 * line + 1e-7], 1), np.stack([0 * line[6:] + 1e-7, line[6:], 0 * line[6:] + 1e-7], 1)])
    (coarse, weak), (fine, strong) = (dragged(*mesh, points) for mesh in ((14, 32), (20, 48)))
    out += rows("drag", points, fine, coarse, (strong, weak))
    out += beam_checks()
    with open_whole(os.path.join(HERE, "truths.csv"), newline="") as stream:
        stream.write("# made by truths.py: neo-Hookean quadratic elements of scikit-fem; lengths in m, forces in N\n")
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(out)


if __name__ == "__main__":
    main()
