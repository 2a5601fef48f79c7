"""Meshes of the suturing device: cap, needle arm with its needle, helix. Millimetres, in the frames of the links.

Sources as in make_scope_urdf.py: [S] SAGES Manual of Flexible Endoscopy (OverStitch: 15.8 mm closed, 23.3 mm open,
18.4 mm beyond the endoscope), [U] USP <861> (2-0 suture: 0.300 to 0.339 mm), [D] design choice.
"""
import math

from make_scope_urdf import (ARM_REACH, CAP_LENGTH, CAP_RADIUS, HELIX_PITCH, HELIX_RADIUS, HELIX_STEM, HELIX_TURNS,
                             HELIX_WIRE, NEEDLE_OPEN, SCOPE_RADIUS)
from mesh_shapes import Mesh, along, arc, bezier, flat_bar, revolved, subtract, swept

CAP = 1000 * CAP_RADIUS       # [S]
BACK = -1000 * CAP_LENGTH
POINT = tuple(1000 * v for v in NEEDLE_OPEN)
PLANE = POINT[1]              # y of the plane in which the arm moves
HINGE = (1.2, 6.0)            # [D] (x, z), within the cap's 15.8 mm
SOCKET = (4.3, 6.9)           # [D] end of the link that the open arm sits in
EXCHANGE = (-2.5, -1.0)       # (y, z) where the needle's path ends, 4 mm before the face
EXCHANGE_RADIUS = 1.0         # [D] fits the channel of 3.7 mm
EXCHANGE_FRONT = 4.3          # [D] the closed needle's point is 0.3 mm inside
THREAD_RADIUS = 0.16          # [U]
NEEDLE_LENGTH = 3.6           # [D] of the detachable needle that stays behind as T-tag
IN_PLANE = (0, 1, 0)


def cap_ring():
    """Steel ring with two grooves, and behind it a collar that is round as the collision shape is."""
    inner = 1000 * SCOPE_RADIUS + 0.05
    front = [(-0.3, inner), (0, inner + 0.3), (0, 7.0)] + arc((-0.8, CAP - 0.8), 0.8, 70, 90, 3)
    groove = [(offset + x, CAP - depth) for offset in (-3.2, -5.0)
              for x, depth in ((0.35, 0), (0.25, 0.25), (-0.25, 0.25), (-0.35, 0))]
    ring = front + groove + [(-8.0, CAP), (-8.15, CAP - 0.15), (-8.15, inner)]
    rear = arc((BACK, 0), CAP, 94, 126, 4)
    collar = [(-8.2, inner), (-8.2, CAP - 0.15), (-8.4, CAP), (BACK, CAP)] + rear + [(rear[-1][0], inner)]
    return revolved(ring, 48, hollow=True), revolved(collar, 40, hollow=True)


def exchange():
    """Catheter of the anchor exchange with its bore."""
    front, bore = EXCHANGE_FRONT, 0.58
    profile = [(-6.0, 0), (-6.0, EXCHANGE_RADIUS), (front - 1.5, EXCHANGE_RADIUS), (front - 1.4, EXCHANGE_RADIUS - 0.1),
               (front - 1.2, EXCHANGE_RADIUS - 0.1), (front - 1.1, EXCHANGE_RADIUS), (front - 0.15, EXCHANGE_RADIUS),
               (front, EXCHANGE_RADIUS - 0.15), (front, bore + 0.12), (front - 0.2, bore)]
    inside = [(front - 0.2, bore), (front - 2.0, bore), (front - 2.0, 0)]
    outer = revolved(profile + inside[1:], 24, EXCHANGE)
    dark = 24 * 3  # the last rings: bore and its bottom
    return [(t, "channel_dark" if k >= len(outer) - dark else "steel") for k, t in enumerate(outer)]


def add_clevis(mesh):
    """Two cheeks, the pin, and the link between them that carries the arm."""
    for right in (-0.55 - 0.6, 0.55):
        mesh.add(flat_bar((-1.2, HINGE[1]), HINGE, 0.92, PLANE + right, PLANE + right + 0.6, sides=24), "steel")
    pin = [(-1.3, 0), (-1.3, 0.4), (-1.2, 0.5), (1.2, 0.5), (1.3, 0.4), (1.3, 0)]
    turned = [tuple((HINGE[0] + b, PLANE + a, HINGE[1] + c) for a, b, c in t) for t in revolved(pin, 16)]
    mesh.add(turned, "steel_dark")
    mesh.add(flat_bar(HINGE, SOCKET, 0.54, PLANE - 0.45, PLANE + 0.45, 0.25, 24), "steel")


def cap():
    mesh = Mesh()
    ring, collar = cap_ring()
    mesh.add(ring, "steel")
    mesh.add(collar, "device_polymer")
    mesh.add_painted(exchange())
    add_clevis(mesh)
    return mesh


def arm_curve():
    """(x, z) of the arm from the needle's point to the link that carries it. The point is driven along (-0.6, -0.8)."""
    foremost = (1000 * ARM_REACH - POINT[0] - 0.4, -0.9)
    bend = (-0.6, -4.1)
    root = (SOCKET[0] - 0.4 - POINT[0], SOCKET[1] - 0.05 - POINT[2])
    length = math.dist(bend, root)
    back = ((root[0] - bend[0]) / length, (root[1] - bend[1]) / length)
    first = bezier((0, 0), (1.98, 2.64), (foremost[0], 1.9), foremost, 14)
    second = bezier(foremost, (foremost[0], -2.8), (bend[0] - 2.0 * back[0], bend[1] - 2.0 * back[1]), bend, 10)
    third = bezier(bend, (bend[0] + length / 3 * back[0], bend[1] + length / 3 * back[1]),
                   (root[0] - length / 3 * back[0], root[1] - length / 3 * back[1]), root, 4)
    return first + second + third + [root]


def lengths_of(path):
    total = [0.0]
    for a, b in zip(path, path[1:]):
        total.append(total[-1] + math.dist(a, b))
    return total


def mixed(value, table):
    """Linear between the rows (position, value) of a table."""
    for (a, fa), (b, fb) in zip(table, table[1:]):
        if value <= b:
            return fa + (fb - fa) * (value - a) / (b - a)
    return table[-1][1]


def add_arm(mesh, path, at):
    """The arm: a slender bar that is higher than wide at its root and holds the needle in a round sleeve."""
    begin = next(k for k, s in enumerate(at) if s >= NEEDLE_LENGTH)
    width = ((0, 0.34), (5, 0.36), (9, 0.42), (16, 0.42), (24, 0.32))
    height = ((0, 0.34), (5, 0.38), (9, 0.5), (16, 0.5), (24, 0.32))
    sizes = [(mixed(s, width), mixed(s, height)) for s in at[begin:]]
    mesh.add(swept(path[begin:], IN_PLANE, sizes, 14, 3), "steel")
    sleeve = path[begin - 1:begin + 3]
    mesh.add(swept(sleeve, IN_PLANE, [(0.4, 0.4), (0.47, 0.47), (0.47, 0.47), (0.42, 0.42)], 14), "device_blue")


def add_needle(mesh, path, at):
    end = next(k for k, s in enumerate(at) if s >= NEEDLE_LENGTH) + 1
    radius = ((0, 0.0), (0.9, 0.19), (2.2, 0.29), (NEEDLE_LENGTH + 2, 0.29))
    sizes = [(0, 0)] + [(mixed(s, radius),) * 2 for s in at[1:end]]
    mesh.add(swept(path[:end], IN_PLANE, sizes), "needle_gold")


def add_thread(mesh, path, at):
    """The thread leaves the middle of the needle, which so turns across when it is dropped, and runs along the arm."""
    start = next(k for k, s in enumerate(at) if s >= 1.7)
    points = []
    for k in range(start, len(path) - 2):
        away = min(1.0, (at[k] - at[start]) / 2.0)
        sag = 0.25 * math.sin(math.pi * min(1.0, (at[k] - at[start]) / 6.0))
        points.append((path[k][0], 0.2 + 0.38 * away + sag, path[k][2]))
    mesh.add(swept(points, IN_PLANE, [(THREAD_RADIUS,) * 2] * len(points), 8), "thread_blue")
    clip = [along(points[-1], subtract(points[-1], points[-2]), share) for share in (-0.25, -0.2, 0.0, 0.05)]
    clip = [(x, 0.3, z) for x, _, z in clip]
    mesh.add(swept(clip, IN_PLANE, [(0.42, 0.3), (0.5, 0.4), (0.5, 0.4), (0.42, 0.3)], 14, 3), "steel_dark")
    knot = [along(path[start], IN_PLANE, y) for y in (-0.36, 0, 0.36)]
    mesh.add(swept(knot, (1, 0, 0), [(0.1, 0.1), (0.26, 0.26), (0.1, 0.1)], 8), "thread_blue")


def needle():
    """Frame: the needle's point."""
    mesh = Mesh()
    path = [(x, 0.0, z) for x, z in arm_curve()]
    at = lengths_of(path)
    add_arm(mesh, path, at)
    add_needle(mesh, path, at)
    add_thread(mesh, path, at)
    return mesh


def coil():
    """Wire whose point is at the origin, sharpened over its last third of a turn."""
    turns, pitch, radius, wire = HELIX_TURNS, 1000 * HELIX_PITCH, 1000 * HELIX_RADIUS, 1000 * HELIX_WIRE
    steps = 20 * turns
    path, sizes = [], []
    for k in range(steps + 1):
        t = k / steps
        path.append((pitch * turns * (t - 1), radius * math.cos(2 * math.pi * turns * t),
                     radius * math.sin(2 * math.pi * turns * t)))
        size = wire * min(1.0, (1 - t) * turns / 0.35)
        sizes.append((size, size))
    return path, sizes


def helix():
    """Frame: the point of the wire; the retractor's sheath behind it."""
    mesh = Mesh()
    path, sizes = coil()
    mesh.add(swept(path, (1, 0, 0), sizes, 8), "steel")
    front = path[0][0]
    back = front - 1000 * HELIX_STEM
    profile = [(back, 0), (back, 1.2), (front - 5.0, 1.2)]
    for k in range(6):  # the sheath's own winding shows before the steel end
        x = front - 5.0 + 0.5 * k
        profile += [(x + 0.1, 1.2), (x + 0.25, 1.12), (x + 0.4, 1.2)]
    mesh.add(revolved(profile + [(front - 1.6, 1.2), (front - 1.55, 0)], 20), "device_polymer")
    head = [(front - 1.6, 0), (front - 1.6, 1.22), (front - 0.1, 1.22), (front + 0.15, 1.12), (front + 0.15, 0.6),
            (front - 0.5, 0.55), (front - 0.5, 0)]
    mesh.add(revolved(head, 20), "steel")
    return mesh


def device_meshes():
    """Name of the file and its mesh."""
    return {"cap": cap(), "needle": needle(), "helix": helix()}
