"""The moving wall as meshes: USD with a time sample for each frame, and a PLY file for each frame."""

import os

import numpy

from ..report.bag_file import BagError

KEPT = 0.5  # of tissue/particles in a compact recording [Hz]
TYPES = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}  # by datatype of PointField
PLY = {"i1": "char", "u1": "uchar", "i2": "short", "u2": "ushort", "i4": "int", "u4": "uint", "f4": "float", "f8": "double"}
RATE = 24  # time codes per second, as most films have frames
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
{{
"""
SURFACE = """    def Mesh "revision_{revision}"
    {{
        int[] faceVertexCounts = [{counts}]
        int[] faceVertexIndices = [{indices}]
        uniform token subdivisionScheme = "none"
        point3f[] points.timeSamples = {{
"""


def points_of(cloud):
    """A structured array with the fields of a cloud, without a copy."""
    fields = [field for field in cloud.fields if field.count == 1]
    kind = numpy.dtype({"names": [field.name for field in fields], "formats": [TYPES[field.datatype] for field in fields],
                        "offsets": [field.offset for field in fields], "itemsize": cloud.point_step})  # fmt: skip
    return numpy.frombuffer(cloud.data, kind)


def write_ply(path, points, triangles, comment):
    kinds = [(name, points.dtype[name]) for name in points.dtype.names]
    lines = ["ply", "format binary_little_endian 1.0", "comment " + comment, "element vertex {}".format(len(points))]
    lines += ["property {} {}".format(PLY[kind.str[1:]], name) for name, kind in kinds]
    lines += ["element face {}".format(len(triangles)), "property list uchar int vertex_indices", "end_header\n"]
    faces = numpy.empty(len(triangles), [("count", "u1"), ("of", "<i4", 3)])
    faces["count"], faces["of"] = 3, triangles
    with open(path, "wb") as file:
        file.write("\n".join(lines).encode())
        file.write(points.astype([(name, kind) for name, kind in kinds]).tobytes() + faces.tobytes())


class Usd:
    """A text layer; a mesh for each revision of the topology, shown while it lasts."""

    def __init__(self, file):
        self._file, self._revision, self._first, self._last = file, None, None, None

    def add(self, time, revision, positions, triangles, frame):
        self._last = code = round(time * RATE, 6)
        if self._revision is None:
            self._file.write(BEGIN + LAYER.format(end="", frame=frame, rate=RATE, start=code))
        if revision != self._revision:
            self._end(code)
            self._revision, self._first = revision, code
            indices = ", ".join(map(str, triangles.ravel()))
            self._file.write(SURFACE.format(revision=revision, counts=", ".join("3" * len(triangles)), indices=indices))
        numbers = ("({:.9g}, {:.9g}, {:.9g}), " * len(positions)).format(*positions.ravel().tolist())
        self._file.write("            {!r}: [{}],\n".format(code, numbers[:-2]))

    def _end(self, code=None):
        if self._revision is not None:
            times = {self._first - 1: "invisible", self._first: "inherited", **({code: "invisible"} if code is not None else {})}
            shown = ", ".join('{!r}: "{}"'.format(*each) for each in times.items())
            self._file.write("        }}\n        token visibility.timeSamples = {{{}}}\n    }}\n".format(shown))

    def close(self):
        self._end()
        self._file.write("}\n")
        self._file.seek(len(BEGIN))
        self._file.write(repr(self._last))


class Mesh:
    def __init__(self, folder, source, files):
        self.connections = set()
        for name in ("tissue/topology", "tissue/particles"):
            topics = sorted({source.bag.connections[number].topic for number in source.numbers_of(name) if source.count(name)})
            if not topics:
                raise BagError("{}: has no {}, so there is no wall to write; record this topic, or leave mesh out".format(
                    source.path, name))  # fmt: skip
            self.connections.update(source.numbers_of(topics[0]))
        self._folder, self._path = folder, source.path
        self._usd_file = files.enter_context(open(os.path.join(folder, "wall.usda"), "w", encoding="utf-8"))
        self._usd = Usd(self._usd_file)
        self._topologies, self._last, self._frames = {}, -1, []
        os.makedirs(os.path.join(folder, "ply"))

    @staticmethod
    def needs_more(arguments):
        return bool(arguments.rate and arguments.rate > KEPT)

    def add(self, message):
        if message.connection.topic.endswith("topology"):
            self._topologies[message.fields.revision] = numpy.array(message.fields.triangles, "<i4").reshape(-1, 3)
            return
        points = points_of(message.fields)
        revision = int(points["revision"][0]) if "revision" in points.dtype.names else max(self._topologies, default=0)
        if revision in self._topologies and message.time > self._last:  # time may be set back, but not in a film
            self._last = message.time
            self._write(message, points, revision)

    def _write(self, message, points, revision):
        triangles, time = self._topologies[revision], message.time / 1e9
        if triangles.size and triangles.max() >= len(points):
            raise ValueError("triangles of more particles than there are")
        name = "ply/wall_{:06d}.ply".format(len(self._frames))
        self._frames.append((name, time, revision))
        write_ply(os.path.join(self._folder, name), points, triangles, "{!r} s, frame {}".format(time, message.fields.header.frame_id))
        positions = numpy.stack([points[axis] for axis in "xyz"], axis=1)
        self._usd.add(time, revision, positions, triangles, message.fields.header.frame_id)

    def finish(self):
        if not self._frames:
            raise BagError("{}: has no particles with their topology in this time; choose another, or leave mesh out".format(self._path))
        self._usd.close()
        self._usd_file.close()
        with open(os.path.join(self._folder, "frames.csv"), "w", encoding="utf-8") as file:
            file.writelines("{},{},{}\n".format(*row) for row in [("file", "stamp [s]", "revision"), *self._frames])
        return "{} frames".format(len(self._frames))
