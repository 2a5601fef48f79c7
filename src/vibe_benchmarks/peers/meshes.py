"""Triangle meshes of the scenes [m], the same for every engine."""

import numpy as np


def ringed_plate(half, disc, rings_inside, rings, spokes, collar=0.0):
    """A square plate of rings that turn from a circle of radius `disc` into the square; with a collar outside of it.
    The first nodes are those of the disc, the last those of the edge and the collar."""
    turn = 2 * np.pi * np.arange(spokes) / spokes
    circle = np.stack([np.cos(turn), np.sin(turn)], 1)
    square = half * circle / abs(circle).max(1, keepdims=True)
    growth = np.linspace(0, 1, rings + 1)[1:, None, None] ** 1.5
    circles = [disc * (i + 1) / rings_inside * circle for i in range(rings_inside)]
    outer = list((1 - growth) * disc * circle + growth * square)
    if collar:
        outer.append(square * (1 + collar / half))
    nodes = np.concatenate([np.zeros((1, 2)), *circles, *outer])
    return np.pad(nodes, ((0, 0), (0, 1))), fan(len(circles) + len(outer), spokes)


def fan(rings, spokes):
    """Triangles of a centre node and rings of nodes around it."""
    here, after = np.arange(spokes), (np.arange(spokes) + 1) % spokes
    triangles = [np.stack([0 * here, 1 + here, 1 + after], 1)]
    for ring in range(rings - 1):
        a, b = 1 + ring * spokes, 1 + (ring + 1) * spokes
        triangles += [np.stack([a + here, b + here, b + after], 1), np.stack([a + here, b + after, a + after], 1)]
    return np.concatenate(triangles)


def grid(x, y):
    """A grid of right triangles whose diagonals alternate, so that it prefers no direction."""
    nodes = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((len(x), len(y)))], -1).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(len(x) - 1), np.arange(len(y) - 1), indexing="ij"))
    a, b = i * len(y) + j, (i + 1) * len(y) + j
    even = ((i + j) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, b + 1], 1), np.stack([a, b, a + 1], 1))
    second = np.where(even, np.stack([a, b + 1, a + 1], 1), np.stack([b, b + 1, a + 1], 1))
    return nodes, np.concatenate([first, second])


def sphere(radius, cap, rings_inside, rings, spokes):
    """Rings about the pole (0, 0, radius), the first of them at the distances of a cap; the south is a fan."""
    inside = np.arcsin(cap / radius) * np.arange(1, rings_inside + 1) / rings_inside
    outside = inside[-1] + (np.pi - inside[-1]) * np.arange(1, rings) / rings
    polar = np.concatenate([inside, outside])[:, None]
    turn = 2 * np.pi * np.arange(spokes) / spokes
    along = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar) + 0 * turn], -1)
    nodes = radius * np.concatenate([[[0, 0, 1]], along.reshape(-1, 3), [[0, 0, -1]]])
    count, here, after = len(polar), np.arange(spokes), (np.arange(spokes) + 1) % spokes
    last = 1 + (count - 1) * spokes
    south = np.stack([last + after, last + here, 0 * here + len(nodes) - 1], 1)
    return nodes, np.concatenate([fan(count, spokes), south])


def prisms(nodes, triangles, thickness, layers):
    """Tetrahedra of a plate about its mid-plane; every prism is divided by the order of its nodes."""
    offsets = np.linspace(-thickness / 2, thickness / 2, layers + 1)
    count = len(nodes)
    solid = np.concatenate([nodes + [0, 0, z] for z in offsets])
    a, b, c = np.sort(triangles, 1).T
    tets = []
    for k in range(layers):
        low, high = k * count, (k + 1) * count
        tets += [np.stack(t, 1) for t in ((a + low, b + low, c + low, c + high), (a + low, b + low, b + high, c + high),
                                          (a + low, a + high, b + high, c + high))]  # fmt: skip
    return solid, np.concatenate(tets)


def interpolation(nodes, triangles, points):
    """Nodes and weights of the places of a surface that are nearest to points."""
    a, u, v = nodes[triangles[:, 0]], *(nodes[triangles[:, k]] - nodes[triangles[:, 0]] for k in (1, 2))
    uu, uv, vv = (np.einsum("ij,ij->i", p, q) for p, q in ((u, u), (u, v), (v, v)))
    found = []
    for point in points:
        pu, pv = np.einsum("ij,ij->i", point - a, u), np.einsum("ij,ij->i", point - a, v)
        s, t = (vv * pu - uv * pv) / (uu * vv - uv**2), (uu * pv - uv * pu) / (uu * vv - uv**2)
        weights = np.clip(np.stack([1 - s - t, s, t], 1), 0, None)
        weights /= weights.sum(1, keepdims=True)
        place = a + weights[:, 1:2] * u + weights[:, 2:] * v
        best = np.argmin(np.linalg.norm(place - point, axis=1))
        found.append((triangles[best], weights[best]))
    return np.array([f[0] for f in found]), np.array([f[1] for f in found])
