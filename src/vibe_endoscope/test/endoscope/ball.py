"""A hollow ball of tissue with burnt spots, as messages: a scene of which everything about a picture is known."""

import struct

import numpy
from sensor_msgs.msg import PointCloud2, PointField
from vibe_msgs.msg import TissueTopology

FRAME = "stomach"
RADIUS = 0.05  # [m]
SPOT = 0.0032  # radius of a burnt spot [m]
REVISION = 7


def unit(vector):
    vector = numpy.asarray(vector, float)
    return vector / numpy.linalg.norm(vector)


def icosphere(subdivisions):
    """Unit vectors, and triangles counter-clockwise seen from outside."""
    golden = (1 + 5**0.5) / 2
    ring = [(-1, golden), (1, golden), (-1, -golden), (1, -golden)]
    points = [unit(p) for p in [(a, b, 0) for a, b in ring] + [(0, a, b) for a, b in ring] + [(b, 0, a) for a, b in ring]]
    faces = [
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
        (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7),
        (9, 8, 1),
    ]  # fmt: skip
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit(points[a] + points[b]))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return numpy.array(points), numpy.array(faces)


class Ball:
    def __init__(self, subdivisions=5):
        directions, self.triangles = icosphere(subdivisions)
        self.points = RADIUS * directions
        self.grade = numpy.zeros(len(self.points), int)

    def burn(self, direction):
        """Burns a round spot in a direction and tells where its middle is."""
        burnt = numpy.linalg.norm(self.points - RADIUS * unit(direction), axis=1) < SPOT
        self.grade[burnt] = 3
        return self.points[burnt].mean(axis=0)

    def topology(self, stamp):
        count = len(self.points)
        message = TissueTopology(revision=REVISION, name="ball")
        message.header.stamp, message.header.frame_id = stamp, FRAME
        message.triangles = self.triangles.flatten().tolist()
        message.rest_positions = self.points.flatten().tolist()
        message.region = message.wall = message.end = bytes(count)
        message.thickness = [0.003] * count
        return message

    def particles(self, stamp):
        names = [("x", 7), ("y", 7), ("z", 7), ("strain", 7), ("id", 6), ("revision", 6), ("thermal_dose", 7)]
        message = PointCloud2(height=1, width=len(self.points), point_step=32, is_dense=True)
        message.header.stamp, message.header.frame_id = stamp, FRAME
        message.row_step = 32 * len(self.points)
        message.fields = [PointField(name, 4 * k, kind, 1) for k, (name, kind) in enumerate(names)]
        message.fields += [PointField("region", 28, 2, 1), PointField("grade", 29, 2, 1)]
        message.data = b"".join(
            struct.pack("<ffffIIfBBxx", *place, 0.0, number, REVISION, 0.0, 0, grade)
            for number, (place, grade) in enumerate(zip(self.points, self.grade))
        )
        return message
