"""Meshes of the needle arm: arm, hook, and the needle that leaves the hook. Millimetres, in the frames of the links with
the arm open.

Sources as in make_scope_urdf.py: [S] SAGES Manual of Flexible Endoscopy (OverStitch: 23.3 mm open, 18.4 mm beyond the
endoscope), [U] USP <861> (2-0 suture: 0.300 to 0.339 mm), [D] design choice.
"""
import math

from make_scope_urdf import ARM_REACH, HINGE, NEEDLE_OPEN, PIN_OPEN
from mesh_shapes import Mesh, along, bezier, flat_bar, revolved, subtract, swept, unit

POINT = tuple(1000 * v for v in NEEDLE_OPEN)
HINGE_MM = tuple(1000 * v for v in HINGE)
PIN = (1000 * PIN_OPEN[0], 1000 * PIN_OPEN[1])  # (x, z) in scope_tip, of the pin between arm and hook
ARM_HALF = 0.27             # [D] half of the arm's thickness
EYE = (-1.66, -1.06)        # [D] y of the hook's eye in the hook's frame, to the left of the arm
NEEDLE_TILT = math.radians(18)  # [D] from the view: the needle then stays within 42 degrees of its way
NEEDLE_LENGTH = 2.9         # [D] of the detachable needle that stays behind as T-tag
THREAD_RADIUS = 0.16        # [U]
IN_PLANE = (0, 1, 0)


def disc(x, z, radius, right, left, sides=20):
    """Round disc or pin across the plane of the arm, from y = right to y = left, its edges chamfered."""
    edge = 0.25 * min(radius, left - right)
    profile = [(right, 0), (right, radius - edge), (right + edge, radius), (left - edge, radius), (left, radius - edge),
               (left, 0)]
    return [tuple((x + b, a, z + c) for a, b, c in triangle) for triangle in revolved(profile, sides)]


def needle_arm():
    """Frame: the hinge. A flat bar with an eye at each end."""
    mesh = Mesh()
    end = (PIN[0] - HINGE_MM[0], PIN[1] - HINGE_MM[2])
    mesh.add(flat_bar((0, 0), end, 0.40, -ARM_HALF, ARM_HALF, 0.12, 20), "steel")
    mesh.add(disc(0, 0, 0.66, -0.3, 0.3, 24), "steel")
    mesh.add(disc(*end, 0.55, -0.3, 0.29, 24), "steel")
    return mesh


def hook_curve():
    """(x, z) from the needle's point over the foremost place to the pin, where the hook continues the arm."""
    foremost = (1000 * ARM_REACH - POINT[0] - 0.4, -0.3)
    pin = (PIN[0] - POINT[0], PIN[1] - POINT[2])
    back = unit((HINGE_MM[0] - PIN[0], 0, HINGE_MM[2] - PIN[1]))
    bend = (pin[0] - 4.2 * back[0], pin[1] - 4.2 * back[2])
    tip = (1.75 * math.cos(NEEDLE_TILT), 1.75 * math.sin(NEEDLE_TILT))
    first = bezier((0, 0), tip, (foremost[0], 3.35), foremost, 18)
    second = bezier(foremost, (foremost[0], -1.7), (bend[0] - 1.5 * back[0], bend[1] - 1.5 * back[2]), bend, 8)
    third = [(bend[0] + 4.2 * back[0] * k / 8, bend[1] + 4.2 * back[2] * k / 8) for k in range(9)]
    return first + second + third


def hook_path():
    """The curve in space: towards the pin it leaves the needle's plane, to pass beside the anchor exchange."""
    curve = hook_curve()
    aside = (EYE[0] + EYE[1]) / 2
    path = []
    for k, (x, z) in enumerate(curve):
        share = min(1.0, max(0.0, (k - len(curve) + 10) / 7))
        path.append((x, aside * share * share * (3 - 2 * share), z))
    return path


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


def needle_hook():
    """Frame: the needle's point. A slender bar that holds the needle in a round sleeve."""
    mesh = Mesh()
    path = hook_path()
    at = lengths_of(path)
    begin = next(k for k, s in enumerate(at) if s >= NEEDLE_LENGTH)
    width = ((0, 0.34), (5, 0.36), (8, 0.40), (20, 0.32))
    height = ((0, 0.34), (5, 0.38), (8, 0.48), (20, 0.40))
    mesh.add(swept(path[begin:], IN_PLANE, [(mixed(s, width), mixed(s, height)) for s in at[begin:]], 14, 3), "steel")
    sleeve = path[begin - 1:begin + 4]
    mesh.add(swept(sleeve, IN_PLANE, [(r, r) for r in (0.4, 0.47, 0.47, 0.47, 0.42)], 14), "device_blue")
    ahead = unit(subtract(sleeve[0], sleeve[1]))
    mesh.add(swept([along(sleeve[0], ahead, x) for x in (-0.2, 0.01)], IN_PLANE, [(0.31, 0.31)] * 2, 14), "channel_dark")
    mesh.add(disc(PIN[0] - POINT[0], PIN[1] - POINT[2], 0.55, *EYE, 24), "steel")
    beside = HINGE_MM[1] - POINT[1]
    mesh.add(disc(PIN[0] - POINT[0], PIN[1] - POINT[2], 0.3, beside - 0.42, EYE[1] + 0.12, 16), "steel_dark")
    return mesh


def suture_needle():
    """Frame: its point. The thread leaves its middle, so that it turns across when it is dropped."""
    mesh = Mesh()
    path = hook_path()
    at = lengths_of(path)
    end = next(k for k, s in enumerate(at) if s >= NEEDLE_LENGTH) + 1
    radius = ((0, 0.0), (0.8, 0.19), (1.7, 0.29), (NEEDLE_LENGTH + 2, 0.29))
    mesh.add(swept(path[:end], IN_PLANE, [(0, 0)] + [(mixed(s, radius),) * 2 for s in at[1:end]]), "needle_gold")
    middle = path[next(k for k, s in enumerate(at) if s >= 1.5)]
    knot = [along(middle, IN_PLANE, y) for y in (-0.36, 0, 0.36)]
    mesh.add(swept(knot, (1, 0, 0), [(0.1, 0.1), (0.26, 0.26), (0.1, 0.1)], 8), "thread_blue")
    begin = along(middle, IN_PLANE, 0.2)
    thread = bezier(begin, (begin[0] + 0.6, 0.7, begin[2] + 0.3), (2.9, 0.95, 1.3), (2.3, 0.75, -0.9), 12)
    mesh.add(swept(thread, IN_PLANE, [(THREAD_RADIUS,) * 2] * len(thread), 8), "thread_blue")
    return mesh


def needle_meshes():
    """Name of the file and its mesh."""
    return {"needle_arm": needle_arm(), "needle_hook": needle_hook(), "suture_needle": suture_needle()}
