"""Closed triangle meshes of simple shapes: lofts, revolved profiles, swept curves, plates, faces with holes.

Lengths in millimetres. Every shape is a closed surface whose triangles are counter-clockwise seen from outside.
Standard library only.
"""
import math


class Mesh:
    """Triangles of corner coordinates, each with the name of its material."""

    def __init__(self):
        self.triangles = []  # (a, b, c, material), the corners as tuples

    def add(self, triangles, material):
        """Adds a closed surface, turned inside out if it encloses a negative volume."""
        outward = volume(triangles) > 0
        for a, b, c in triangles:
            self.triangles.append((a, b, c, material) if outward else (a, c, b, material))

    def add_painted(self, painted):
        """Adds a closed surface of several materials: (triangle, material) pairs."""
        outward = volume([triangle for triangle, _ in painted]) > 0
        for (a, b, c), material in painted:
            self.triangles.append((a, b, c, material) if outward else (a, c, b, material))


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def along(a, direction, length):
    """The point at a length from a in a direction."""
    return (a[0] + length * direction[0], a[1] + length * direction[1], a[2] + length * direction[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


def volume(triangles):
    """Enclosed volume [mm^3]; negative if the surface is inside out."""
    return sum(dot(a, cross(b, c)) for a, b, c in triangles) / 6


def mean(ring):
    return tuple(sum(p[k] for p in ring) / len(ring) for k in range(3))


def band(ring, following):
    """Triangles between two rings; a ring of one point is the end of a cone."""
    if len(ring) == 1 and len(following) == 1:
        raise ValueError("Two points next to each other enclose nothing; give one of the two rings more points.")
    count = max(len(ring), len(following))
    triangles = []
    for i in range(count):
        j = (i + 1) % count
        if len(ring) > 1:
            triangles.append((ring[i], ring[j], following[j % len(following)]))
        if len(following) > 1:
            triangles.append((ring[i % len(ring)], following[j], following[i]))
    return triangles


def loft(rings, ring_of_rings=False):
    """Surface through rings of equally many points, closed at both ends, or joined end to beginning.

    The middle of an end must see its whole ring, as it does in a convex one.
    """
    triangles = []
    for ring, following in zip(rings, rings[1:]):
        triangles += band(ring, following)
    if ring_of_rings:
        return triangles + band(rings[-1], rings[0])
    for ring, inwards in ((rings[0], True), (rings[-1], False)):
        if len(ring) > 1:
            middle = [mean(ring)]
            triangles += band(middle, ring) if inwards else band(ring, middle)
    return triangles


def circle(x, radius, sides, centre=(0, 0)):
    """Ring about the x axis, or about a line along it through `centre` (y, z)."""
    if radius == 0:
        return [(x, *centre)]
    steps = (2 * math.pi * k / sides for k in range(sides))
    return [(x, centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in steps]


def revolved(profile, sides, centre=(0, 0), hollow=False):
    """Body of the profile ((x, radius), ...) about a line along x; a hollow one is a ring, its profile goes around."""
    return loft([circle(x, radius, sides, centre) for x, radius in profile], hollow)


def arc(centre, radius, begin, end, pieces):
    """Points (x, r) of an arc in a profile; angles in degrees, 0 along x."""
    steps = (math.radians(begin + (end - begin) * k / pieces) for k in range(pieces + 1))
    return [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in steps]


def swept(path, side, sizes, sides=12, flatness=2.0):
    """Bar along a path. sizes: half width along `side` and half height across it at each point; 0 ends in a point.

    flatness: exponent of the superellipse of its section; 2 is an ellipse, more is nearer to a rectangle.
    """
    rings = []
    for k, (point, (width, height)) in enumerate(zip(path, sizes)):
        if width == 0:
            rings.append([point])
            continue
        tangent = unit(subtract(path[min(k + 1, len(path) - 1)], path[max(k - 1, 0)]))
        across = unit(cross(tangent, side))
        beside = cross(across, tangent)
        ring = []
        for n in range(sides):
            c, s = math.cos(2 * math.pi * n / sides), math.sin(2 * math.pi * n / sides)
            u = math.copysign(abs(c) ** (2 / flatness), c) if abs(c) > 1e-9 else 0
            v = math.copysign(abs(s) ** (2 / flatness), s) if abs(s) > 1e-9 else 0
            ring.append(along(along(point, beside, width * u), across, height * v))
        rings.append(ring)
    return loft(rings)


def bezier(a, b, c, d, pieces):
    """Points of a cubic curve with its four control points, the last point left out."""
    points = []
    for k in range(pieces):
        t = k / pieces
        weights = ((1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t ** 2, t ** 3)
        points.append(tuple(sum(w * p[i] for w, p in zip(weights, (a, b, c, d))) for i in range(len(a))))
    return points


def bar_outline(begin, end, radius, sides):
    """Outline of a flat bar with round ends in the x-z plane; sides: of both round ends together."""
    heading = math.atan2(end[1] - begin[1], end[0] - begin[0])
    points = []
    for centre, turn in ((end, -math.pi / 2), (begin, math.pi / 2)):
        for k in range(sides // 2):
            t = heading + turn + math.pi * k / (sides // 2 - 1)
            points.append((centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)))
    return points


def flat_bar(begin, end, radius, right, left, chamfer=0.12, sides=16):
    """Flat bar with round ends between y = right and y = left, its edges chamfered."""
    rings = []
    for y, inset in ((right, chamfer), (right + chamfer, 0), (left - chamfer, 0), (left, chamfer)):
        rings.append([(x, y, z) for x, z in bar_outline(begin, end, radius - inset, sides)])
    return loft(rings)


def bridged(outline, hole):
    """Outline with a hole, joined by a double edge between the nearest points; the hole runs the other way round."""
    _, i, j = min((math.dist(p, q), i, j) for i, p in enumerate(outline) for j, q in enumerate(hole))
    return outline[:i + 1] + hole[j:] + hole[:j + 1] + outline[i:]


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def is_ear(points, a, b, c):
    if turn(a, b, c) <= 1e-12:
        return False
    others = (p for p in points if p not in (a, b, c))
    return not any(turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0 for p in others)


def triangulated(outline, holes):
    """Triangles of a flat face by cutting ears; outline counter-clockwise, holes clockwise, points (u, v)."""
    points = list(outline)
    for hole in holes:
        points = bridged(points, hole)
    triangles = []
    while len(points) > 3:
        # the ear whose new edge is shortest: triangles that are not needlessly thin
        ears = [(math.dist(points[k - 1], points[(k + 1) % len(points)]), k) for k in range(len(points))
                if is_ear(points, points[k - 1], points[k], points[(k + 1) % len(points)])]
        k = min(ears)[1]
        triangles.append((points[k - 1], points[k], points[(k + 1) % len(points)]))
        del points[k]
    return triangles + [tuple(points)]
