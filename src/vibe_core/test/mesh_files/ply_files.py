"""PLY files: Turk 1994, The PLY polygon file format."""

import struct

from shapes import Case, ball, concave, placed

TYPES = {"char": ("b", "int8"), "uchar": ("B", "uint8"), "short": ("h", "int16"), "ushort": ("H", "uint16"),
         "int": ("i", "int32"), "uint": ("I", "uint32"), "float": ("f", "float32"), "double": ("d", "float64")}
WHOLE = [t for t in TYPES if t not in ("float", "double")]


class Writer:
    """Header and rows in one of the three forms."""

    def __init__(self, random):
        self.random = random
        self.form = random.choice(["ascii", "binary_little_endian", "binary_big_endian"])
        self.end = random.choice(["\n", "\n", "\r\n", "\r"])
        self.header = ["ply"]
        self.header += [f"comment made by {random.random()}"] * random.randint(0, 1)
        self.header += [f"format {self.form} 1.0", *random.sample(["obj_info x 1", "comment", "comment element face 7"], 1)]
        self.body = b""

    def name(self, kind):
        return self.random.choice([kind, TYPES[kind][1]])

    def element(self, name, properties, rows):
        """properties: (name, type) or (name, type of count, type); rows: a value or a list for each."""
        self.header.append(f"element {name} {len(rows)}")
        for p in properties:
            words = ["list", self.name(p[1]), self.name(p[2])] if len(p) == 3 else [self.name(p[1])]
            self.header.append(" ".join(["property", *words, p[0]]))
        for row in rows:
            values = []
            for p, value in zip(properties, row):
                values += [(p[1], len(value)), *((p[2], v) for v in value)] if len(p) == 3 else [(p[1], value)]
            self.body += self._row(values)

    def _row(self, values):
        if self.form == "ascii":
            texts = [f"{v:.9g}" if t in ("float", "double") else str(int(v)) for t, v in values]
            return (self.random.choice(["", "", " "]) + " ".join(texts) + self.end).encode()
        order = "<" if self.form == "binary_little_endian" else ">"
        return b"".join(struct.pack(order + TYPES[t][0], v if t in ("float", "double") else int(v)) for t, v in values)

    def content(self):
        return self.end.join([*self.header, "end_header", ""]).encode() + self.body


def _vertices(writer, shape, kind):
    """Coordinates in any order among other properties."""
    random = writer.random
    properties = [("x", kind), ("y", kind), ("z", kind)]
    others = random.sample([("nx", "float"), ("red", "uchar"), ("quality", "double"), ("tags", "uchar", "short")],
                           random.randint(0, 3))
    properties += others
    random.shuffle(properties)
    rows = []
    for v in shape.vertices:
        known = dict(zip("xyz", v))
        rows.append([known[p[0]] if p[0] in known else [1, -2] if len(p) == 3 else 3 for p in properties])
    writer.element("vertex", properties, rows)


def _faces(writer, shape):
    random = writer.random
    largest = max(len(p) for p in shape.polygons)
    name = random.choice(["vertex_indices", "vertex_index"])
    index = random.choice([t for t in WHOLE if len(shape.vertices) < 128 or t not in ("char", "uchar")])
    properties = [(name, random.choice([t for t in WHOLE if largest < 128]), index)]
    properties += random.sample([("flags", "uchar"), ("texcoord", "uchar", "float")], random.randint(0, 2))
    random.shuffle(properties)
    rows = [[p if q[0] == name else [0.5, 0.25] if len(q) == 3 else 7 for q in properties] for p in shape.polygons]
    writer.element("face", properties, rows)


def _strips(writer, shape):
    """Strips of one or two triangles, with -1 between them."""
    strip, triangles = [], shape.triangles()
    while triangles:
        a, b, c = triangles.pop(0)
        strip += [a, b, c]
        if triangles and triangles[0][:2] == (c, b):
            strip.append(triangles.pop(0)[2])
        strip.append(-1)
    writer.element("tristrips", [("vertex_indices", "int", "int")], [[strip[:-1]]])


def _other(writer, name):
    writer.element(name, [("a", "short"), ("b", "uchar", "double")], [[k, [0.5] * k] for k in range(3)])


def _with_first_byte(shape, byte, order):
    """The shape with a first coordinate that begins with this byte as a float."""
    packed = bytearray(struct.pack(order + "f", shape.vertices[0][0]))
    packed[0] = byte
    x = struct.unpack(order + "f", bytes(packed))[0]
    moved = shape.moved(lambda v: v)
    moved.vertices[0] = (x, *shape.vertices[0][1:])
    return moved


def _valid(random, name):
    writer = Writer(random)
    kind = random.choice(["float", "double", *WHOLE])
    whole = kind in WHOLE
    shape = placed((concave if whole else random.choice([ball, concave]))(random), random, whole)
    if kind[0] == "u":
        low = [min(v[k] for v in shape.vertices) for k in range(3)]
        shape = shape.moved(lambda v: [x - y for x, y in zip(v, low)])
    strips = max(len(p) for p in shape.polygons) == 3 and random.random() < 0.4
    parts = [lambda: _vertices(writer, shape, kind), lambda: (_strips if strips else _faces)(writer, shape)]
    if random.random() < 0.3:
        parts.reverse()
    for other in random.sample(["edge", "material", "camera"], random.randint(0, 2)):
        parts.insert(random.randint(0, 2), lambda other=other: _other(writer, other))
    for part in parts:
        part()
    return Case(name, writer.content(), shape)


def _first_byte(random, name, byte):
    """Binary data that begin like the end of a line."""
    writer = Writer(random)
    writer.form = "binary_little_endian"
    writer.header = ["ply", "format binary_little_endian 1.0"]
    shape = _with_first_byte(placed(ball(random), random), byte, "<")
    writer.element("vertex", [("x", "float"), ("y", "float"), ("z", "float")], [list(v) for v in shape.vertices])
    _faces(writer, shape)
    return Case(name, writer.content(), shape)


def _wrong(random, name):
    shape = placed(ball(random), random)
    writer = Writer(random)
    writer.end, writer.name = "\n", str
    writer.form = random.choice(["ascii", "binary_little_endian"])
    writer.header = ["ply", f"format {writer.form} 1.0"]
    writer.element("vertex", [("x", "float"), ("y", "float"), ("z", "float")], [list(v) for v in shape.vertices])
    writer.element("face", [("vertex_indices", "uchar", "int")], [[p] for p in shape.polygons])
    good = writer.content()
    n, m, ascii_form = len(shape.vertices), len(shape.polygons), writer.form == "ascii"
    ends = f"ends within face {m - 1} of {m}"
    follows = "follows after the last element" if ascii_form else "bytes follow after the last element"

    def swap(old, new):
        assert old.encode() in good
        return good.replace(old.encode(), new.encode(), 1)

    cut = good[:good.rstrip(b"\n").rindex(b"\n") + 1] if ascii_form else good[:-3]
    changes = [
        (cut, ends),
        (swap(f"element face {m}", f"element face {m + 1}"), f"ends within face {m} of {m + 1}"),
        (swap(f"element face {m}", f"element face {m - 1}"), follows),
        (swap("element face", "element polygon"), "has no faces"),
        (swap("property float z", "property float depth"), "lacks a property x, y or z"),
        (swap("property float y", "property real y"), "line 5 of its header names the type 'real'"),
        (swap("vertex_indices", "corners"), "has no list 'vertex_indices'"),
        (swap(" 1.0", " 2.0"), "line 2 of its header names no format of PLY 1.0"),
        (swap(f"format {writer.form} 1.0\n", ""), "its header does not state the format"),
        (swap("uchar", "float"), "counts the items of a list with a float"),
        (swap(f"element vertex {n}", "element vertex many"), "is not 'element NAME COUNT'"),
        (b"PLY" + good[3:], "does not begin with the line 'ply'"),
        (swap("element vertex", "item vertex"), "begins with 'item'"),
    ]
    if ascii_form:
        row = " ".join(f"{x:.9g}" for x in shape.vertices[0])
        row = next(r for r in (row, " " + row) if ("\n" + r + "\n").encode() in good)
        changes += [
            (swap(row + "\n", row + " 5\n"), "line 10: has 4 values, but its vertex takes 3"),
            (swap(row + "\n", "1 2\n"), "line 10: has too few values for its vertex"),
            (swap(row + "\n", "1,5 2 3\n"), "line 10: '1,5' is not a number of this format"),
            (swap("end_header\n", ""), "line 9 of its header begins with"),
            (swap(row + "\n", "nan 2 3\n"), "not a finite number"),
        ]
    else:
        index = len(good) - 4
        changes += [
            (good[:index] + struct.pack("<i", n), f"face {m - 1}: the face names vertex {n}, but the file has 0 to {n - 1}"),
            (good[:index] + struct.pack("<i", -5), f"face {m - 1}: the face names vertex -5"),
            (good[:index - 9] + b"\xff" + good[index - 8:], ends),
        ]
    content, refused = random.choice(changes)
    return Case(name, content, refused=refused)


def cases(random, count):
    """The last third is wrong."""
    for k, byte in enumerate([0x0a, 0x0d, 0x0a, 0x0d, 0x20]):
        yield _first_byte(random, f"first_byte_{k}.ply", byte)
    for k in range(count - count // 3 - 5):
        yield _valid(random, f"valid_{k}.ply")
    for k in range(count // 3):
        yield _wrong(random, f"wrong_{k}.ply")
