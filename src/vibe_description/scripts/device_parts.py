"""Meshes of the suturing device: cap with hinge and anchor exchange, helix, argon probe. Millimetres, in the frames of
the links. The needle arm is in needle_parts.py.

Sources as in make_scope_urdf.py: [S] SAGES Manual of Flexible Endoscopy (OverStitch: 15.8 mm closed), [D] design choice.
"""
import math

from make_scope_urdf import (CAP_LENGTH, CAP_RADIUS, HELIX_PITCH, HELIX_RADIUS, HELIX_STEM, HELIX_TURNS, HELIX_WIRE,
                             SCOPE_RADIUS)
from mesh_shapes import Mesh, along, arc, bezier, cross, flat_bar, revolved, subtract, swept, unit
from needle_parts import ARM_HALF, HINGE_MM, disc, needle_meshes
from scope_parts import HELIX_CHANNEL

CAP = 1000 * CAP_RADIUS       # [S]
BACK = -1000 * CAP_LENGTH
EXCHANGE = (-2.5, -1.0)       # (y, z) where the needle's path ends, 4 mm before the face
EXCHANGE_RADIUS = 1.0         # [D] fits the channel of 3.7 mm
EXCHANGE_FRONT = 4.3          # [D] the closed needle's point is 0.3 mm inside
CHEEK = 0.34                  # [D] thickness of the cheeks beside the arm
PROBE_RADIUS = 1.15           # probes of 2.3 mm pass channels of 2.8 mm
PROBE_LENGTH = 0.010          # of marking.probe_length, for which the probe passes the middle of its channel's mouth
PROBE_REAR = 6.0              # [D] behind that mouth
PROBE_TIP = 2.0               # [D] of ceramic


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


def add_hinge(mesh):
    """Two cheeks and the pin, between which the arm turns."""
    x, y, z = HINGE_MM
    for right in (y - ARM_HALF - 0.06 - CHEEK, y + ARM_HALF + 0.06):
        mesh.add(flat_bar((-1.2, z), (x, z), 0.7, right, right + CHEEK, 0.1, 24), "steel")
    mesh.add(disc(x, z, 0.38, y - 0.78, y + 0.78, 16), "steel_dark")


def cap():
    mesh = Mesh()
    ring, collar = cap_ring()
    mesh.add(ring, "steel")
    mesh.add(collar, "device_polymer")
    mesh.add_painted(exchange())
    add_hinge(mesh)
    return mesh


def argon_probe():
    """Frame: the end of the probe. It leaves the channel of the helix and leans to the middle, where the beam begins."""
    mesh = Mesh()
    mouth = (-1000 * PROBE_LENGTH, *HELIX_CHANNEL)
    ahead = unit(subtract((0, 0, 0), mouth))
    straight = along(mouth, ahead, 1.7)
    rear = (1.04 * mouth[1], 1.04 * mouth[2])  # in the channel, parallel to it
    turn = bezier((mouth[0] - 1.2, *rear), (mouth[0] - 0.2, *rear), along(straight, ahead, -1.5), straight, 8)
    path = [(mouth[0] - PROBE_REAR, *rear)] + turn + [along((0, 0, 0), ahead, -PROBE_TIP)]
    mesh.add(swept(path, (0, 0, 1), [(PROBE_RADIUS,) * 2] * len(path), 20), "probe_polymer")
    for x in (3.6, 6.4):
        ring = [along((0, 0, 0), ahead, -x - w) for w in (0.7, 0.65, 0.05, 0)]
        mesh.add(swept(ring, (0, 0, 1), [(r, r) for r in (1.1, 1.17, 1.17, 1.1)], 20), "scope_black")
    mesh.add_painted([(tuple(turned(p, ahead) for p in t), m) for t, m in probe_tip()])
    return mesh


def probe_tip():
    """Ceramic tube along x that ends at the origin, with the bore that the argon leaves."""
    sides, bore = 20, 0.5
    outside = [(-PROBE_TIP - 0.3, 0), (-PROBE_TIP - 0.3, 1.0), (-PROBE_TIP, PROBE_RADIUS), (-0.25, PROBE_RADIUS),
               (0, PROBE_RADIUS - 0.25), (0, bore)]
    shape = revolved(outside + [(-1.2, bore), (-1.2, 0)], sides)
    return [(t, "channel_dark" if k >= len(shape) - 3 * sides else "ceramic") for k, t in enumerate(shape)]


def turned(point, ahead):
    """The point after the turn that takes the x axis to `ahead`, without twist (Rodrigues)."""
    axis = (0.0, -ahead[2], ahead[1])
    spin, share = cross(axis, point), 1 / (1 + ahead[0])
    twice = cross(axis, spin)
    return tuple(p + s + share * t for p, s, t in zip(point, spin, twice))


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
    return {"cap": cap(), "helix": helix(), "argon_probe": argon_probe(), **needle_meshes()}
