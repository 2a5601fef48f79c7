"""The moving wall as meshes: USD with a time sample for each frame, and a PLY file for each frame."""

import os

import numpy

from ..report.bag_file import BagError
from ..report.point_cloud import fields_of_cloud, positions_of

KEPT = 0.5  # of tissue/particles in a compact recording [Hz]
RATE = 24  # time codes per second, as most films have frames
PLY = {"i1": "char", "u1": "uchar", "i2": "short", "u2": "ushort", "i4": "int", "u4": "uint", "f4": "float", "f8": "double"}
BEGIN = "#usda 1.0\n(\n    endTimeCode = "  # which is known last
LAYER = """{end:20}
    defaultPrim = "wall"
    doc = "The wall of the organ in the frame '{frame}' [m]; time codes are {rate} times the stamps"
    framesPerSecond = {rate}
    metersPerUnit = 1
    startTimeCode = {start!r}
    timeCodesPerSecond = {rate}
    upAxis = "Z"
)

def Xform "wall"
{{"""
SHOWN = """        }}
        token visibility.timeSamples = {{{}: "invisible", {}: "inherited", {}: "invisible"}}
    }}
"""
SURFACE = """
    def Mesh "revision_{revision}"
    {{
        int[] faceVertexCounts = [{counts}]
        int[] faceVertexIndices = [{indices}]
        uniform token subdivisionScheme = "none"
        point3f[] points.timeSamples = {{
"""


def points_of(cloud):
    """A structured array with the fields of a cloud."""
    points = fields_of_cloud(cloud)
    kinds = [(field.name, points.dtype[field.name]) for field in cloud.fields if field.count == 1]
    return points[[name for name, _ in kinds]].astype(kinds)


def write_ply(path, points, triangles, comment):
    lines = ["ply", "format binary_little_endian 1.0", "comment " + comment, "element vertex {}".format(len(points))]
    lines += ["property {} {}".format(PLY[points.dtype[name].str[1:]], name) for name in points.dtype.names]
    lines += ["element face {}".format(len(triangles)), "property list uchar int vertex_indices", "end_header\n"]
    faces = numpy.empty(len(triangles), [("count", "u1"), ("of", "<i4", 3)])
    faces["count"], faces["of"] = 3, triangles
    with open(path, "wb") as file:
        file.write("\n".join(lines).encode() + points.tobytes() + faces.tobytes())


class Wall:
    """Frames of the wall for a class that writes them in _frame()."""

    def __init__(self, source, further=()):
        self.connections, self._path = set(), source.path
        self._topologies, self._last = {}, -1
        for name in ("tissue/topology", "tissue/particles", *further):
            numbers = source.of_one_simulator(name)
            if not numbers and name not in further:
                raise BagError("{}: has no {}, so there is no wall to write; record it, or leave mesh and gltf out".format(source.path, name))
            self.connections.update(numbers)

    def add(self, message):
        cloud = message.fields
        if message.connection.topic.endswith("topology"):
            self._topologies[cloud.revision] = numpy.array(cloud.triangles, "<i4").reshape(-1, 3)
            return
        points = points_of(cloud)
        revision = int(points["revision"][0]) if "revision" in points.dtype.names else max(self._topologies, default=0)
        if revision in self._topologies and message.time > self._last:  # time may be set back, but not in a film
            self._last = message.time
            self._frame(message.time / 1e9, revision, points, cloud.header.frame_id)

    def _check(self, frames):
        if not frames:
            raise BagError("{}: has no particles with their topology in this time; choose another, or leave mesh and gltf out".format(self._path))


class Mesh(Wall):
    def __init__(self, folder, source, files):
        super().__init__(source)
        self._usd = files.enter_context(open(os.path.join(folder, "wall.usda"), "w", encoding="utf-8"))
        self._folder, self._revision, self._frames = folder, None, ["file,stamp [s],revision"]
        os.makedirs(os.path.join(folder, "ply"))

    def _frame(self, time, revision, points, frame):
        name = "ply/wall_{:06d}.ply".format(len(self._frames) - 1)
        self._frames.append("{},{!r},{}".format(name, time, revision))
        triangles = self._topologies[revision]
        write_ply(os.path.join(self._folder, name), points, triangles, "{!r} s, frame {}".format(time, frame))
        self._add_sample(round(time * RATE, 6), revision, points, triangles, frame)

    def _add_sample(self, code, revision, points, triangles, frame):
        if self._revision is None:
            self._usd.write(BEGIN + LAYER.format(end="", frame=frame, rate=RATE, start=code))
        if revision != self._revision:
            self._usd.write("" if self._revision is None else SHOWN.format(self._first - 1, self._first, code))
            self._revision, self._first, counts = revision, code, ", ".join("3" * len(triangles))
            self._usd.write(SURFACE.format(revision=revision, counts=counts, indices=", ".join(map(str, triangles.ravel()))))
        positions = positions_of(points).ravel().tolist()
        self._usd.write("            {!r}: [{}],\n".format(code, ("({:.9g}, {:.9g}, {:.9g}), " * len(points)).format(*positions)[:-2]))

    def finish(self):
        self._check(self._frames[1:])
        end = round(self._last / 1e9 * RATE, 6)
        self._usd.write(SHOWN.format(self._first - 1, self._first, end + 1e6) + "}\n")
        self._usd.seek(len(BEGIN))
        self._usd.write(repr(end))
        self._usd.close()
        with open(os.path.join(self._folder, "frames.csv"), "w", encoding="utf-8") as file:
            file.write("\n".join(self._frames) + "\n")
        return "{} frames".format(len(self._frames) - 1)
