"""Closed surfaces with known volume, area and centroid, and the cases that are made of them."""

import math
from dataclasses import dataclass, field


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


@dataclass
class Shape:
    """Polygons, planar and counter-clockwise seen from outside; none crosses another."""

    vertices: list
    polygons: list

    def moved(self, change):
        """The shape with every vertex changed; mirrored polygons are turned."""
        shape = Shape([tuple(change(v)) for v in self.vertices], self.polygons)
        if shape.volume() < 0:
            shape.polygons = [tuple(reversed(p)) for p in self.polygons]
        return shape

    def triangles(self):
        """Triangles for formats that have nothing else: fans, which are valid for volume and area of planar polygons
        in sum, so use them for convex ones only."""
        return [(p[0], p[k - 1], p[k]) for p in self.polygons for k in range(2, len(p))]

    def _parts(self):
        for a, b, c in self.triangles():
            yield self.vertices[a], self.vertices[b], self.vertices[c]

    def volume(self):
        return sum(dot(a, cross(b, c)) for a, b, c in self._parts()) / 6

    def area(self):
        total = 0
        for p in self.polygons:
            o = self.vertices[p[0]]
            sums = [0, 0, 0]
            for k in range(2, len(p)):
                n = cross(minus(self.vertices[p[k - 1]], o), minus(self.vertices[p[k]], o))
                sums = [s + x for s, x in zip(sums, n)]
            total += math.sqrt(dot(sums, sums)) / 2
        return total

    def centroid(self):
        sums = [0, 0, 0]
        for a, b, c in self._parts():
            part = dot(a, cross(b, c)) / 24
            sums = [s + part * (x + y + z) for s, x, y, z in zip(sums, a, b, c)]
        return tuple(s / self.volume() for s in sums)


def prism(outline, height, shift=(0, 0)):
    """A skew column over a counter-clockwise outline."""
    n = len(outline)
    low = [(x, y, 0) for x, y in outline]
    high = [(x + shift[0], y + shift[1], height) for x, y in outline]
    sides = [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)]
    return Shape(low + high, [tuple(reversed(range(n))), tuple(range(n, 2 * n))] + sides)


def concave(random):
    """A column over an L, U or comb, with further corners on straight edges; whole coordinates."""
    outlines = [
        [(0, 0), (6, 0), (6, 2), (2, 2), (2, 7), (0, 7)],
        [(0, 0), (9, 0), (9, 8), (6, 8), (6, 3), (3, 3), (3, 5), (0, 5)],
        [(0, 0), (4, 0), (8, 0), (8, 6), (7, 6), (7, 1), (6, 1), (6, 4), (5, 4), (5, 1), (4, 1), (2, 1), (2, 7), (0, 7)],
    ]
    return prism(random.choice(outlines), random.randint(3, 9), (random.randint(-2, 2), random.randint(-2, 2)))


def ball(random):
    """Triangles around a lumpy, unsymmetric ball; coordinates are not whole."""
    rings, around = random.randint(3, 5), random.randint(5, 9)
    points = [(0, 0, 3.1)]
    for r in range(1, rings):
        for k in range(around):
            polar, angle = math.pi * r / rings, 2 * math.pi * (k + 0.3 * r) / around
            size = 3 + 0.8 * math.cos(angle) + random.uniform(0, 0.4)
            points.append((size * math.sin(polar) * math.cos(angle), size * math.sin(polar) * math.sin(angle),
                           1.5 * size * math.cos(polar)))
    points.append((0, 0, -4.2))
    last, faces = len(points) - 1, []
    for k in range(around):
        n = (k + 1) % around
        faces.append((0, 1 + k, 1 + n))
        for r in range(rings - 2):
            a, b = 1 + r * around + k, 1 + r * around + n
            faces += [(a, a + around, b), (b, a + around, b + around)]
        faces.append((last, last - around + n, last - around + k))
    return Shape(points, faces)


def placed(shape, random, whole=False):
    """Anywhere near the origin, of any size, with its axes exchanged."""
    scale = random.choice([1, 2, 5]) if whole else random.uniform(0.2, 30)
    axes = random.sample(range(3), 3)
    offset = [random.randint(-9, 9) if whole else random.uniform(-9, 9) * scale for _ in range(3)]
    return shape.moved(lambda v: [scale * v[a] + o for a, o in zip(axes, offset)])


@dataclass
class Case:
    """A file and what is right: the surface, or words of the refusal."""

    name: str
    content: bytes
    shape: Shape = None
    refused: str = ""
    beside: dict = field(default_factory=dict)  # further files, by name

    def expectation(self):
        if self.refused:
            return [self.name, "refused", self.refused]
        counts = [len({v for p in self.shape.polygons for v in p}), sum(len(p) - 2 for p in self.shape.polygons)]
        numbers = [self.shape.volume(), self.shape.area(), *self.shape.centroid()]
        return [self.name, "loads", *map(repr, numbers), *map(str, counts)]


def number(value, random):
    """A number in one of the ways to write it."""
    return random.choice(["{:.9g}", "{:.9e}", "{:.9E}", "{:+.9g}", "{!r}"]).format(value)


# What stands in the place of a file of any format: content and words of the refusal.
IN_ITS_PLACE = [
    (b"", "is empty"),
    (b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d"
     b"17e2393\nsize 12345\n", "Git LFS pointer"),
    (b"<!DOCTYPE html>\n<html><head><title>404</title></head></html>\n", "web page"),
    (b"\r\n <HTML><body>Sign in</body></HTML>", "web page"),
    (b"PK\x03\x04\x14\0\0\0\x08\0", "ZIP archive"),
    (b"\x1f\x8b\x08\0\0\0\0\0\0\x03", "gzip"),
    ("o organ\nv 0 0 0\n".encode("utf-16"), "UTF-16"),
]
