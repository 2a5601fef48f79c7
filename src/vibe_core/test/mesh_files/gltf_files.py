"""glTF and GLB files: Khronos, glTF 2.0 specification, 2021; KHR_mesh_quantization."""

import base64
import json
import math
import struct

from shapes import Case, Shape, ball, placed

CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
LIMITS = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}


class Document:
    """JSON and one buffer, and the ways to pack them."""

    def __init__(self, random):
        self.random = random
        self.json = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "meshes": [], "nodes": []}
        self.bytes = b""

    def view(self, data, **more):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more})
        self.bytes += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, code, **more):
        """An accessor of vectors or scalars; vectors may have a stride and an offset."""
        width = len(rows[0])
        element = struct.calcsize("<" + CODES[code]) * width
        stride, offset = element, 0
        if width == 3 and (element % 4 or self.random.random() < 0.4):
            stride = element + -element % 4 + self.random.choice([0, 4, 8])
            offset = self.random.choice([0, 4])
        data = b"\x7f" * offset
        for row in rows:
            data += struct.pack("<" + CODES[code] * width, *row).ljust(stride, b"\x7f")
        place = {"bufferView": self.view(data, **({"byteStride": stride} if stride != element else {}))}
        place["byteOffset"] = offset
        entry = {**place, "componentType": code, "count": len(rows), "type": {1: "SCALAR", 3: "VEC3"}[width], **more}
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def indices(self, order):
        fitting = [c for c, most in ((5121, 255), (5123, 65535), (5125, 2**32 - 1)) if max(order) < most]
        return self.accessor([(v,) for v in order], self.random.choice(fitting))

    def glb(self, version=2, extra=0):
        buffer = {"byteLength": len(self.bytes)}
        self.json.setdefault("buffers", [buffer])
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.bytes + b"\0" * (-len(self.bytes) % 4)
        parts = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        if self.random.random() < 0.2:
            parts += struct.pack("<I4s", 4, b"XTRA") + b"none"
        return struct.pack("<4sII", b"glTF", version, 12 + len(parts) + extra) + parts

    def packed(self, name):
        """A case without expectation: as GLB, or as JSON with the buffer inside or beside."""
        way = self.random.choice(["glb", "data", "beside"])
        if way == "glb":
            return Case(name + ".glb", self.glb())
        buffer, beside = {"byteLength": len(self.bytes)}, {}
        if way == "data":
            kind = self.random.choice(["application/octet-stream", "application/gltf-buffer", ""])
            buffer["uri"] = f"data:{kind};base64," + base64.b64encode(self.bytes).decode()
        else:
            buffer["uri"] = name + "%20data.bin"
            beside[name + " data.bin"] = self.bytes + b"\0" * self.random.choice([0, 3])
        self.json["buffers"] = [buffer]
        text = json.dumps(self.json, indent=self.random.choice([None, 2]))
        return Case(name + ".gltf", (self.random.choice(["", "\n", "\ufeff"]) + text).encode(), beside=beside)


def _positions(document, shape):
    """An accessor of the vertices as floats, some or all of them replaced by a sparse one."""
    rows = [list(v) for v in shape.vertices]
    way = document.random.choice(["plain", "plain", "sparse", "only sparse"])
    if way == "plain":
        return document.accessor(rows, 5126)
    some = sorted(document.random.sample(range(len(rows)), len(rows) // 2)) if way == "sparse" else list(range(len(rows)))
    spoilt = [[9e9, 0, 0] if k in some else row for k, row in enumerate(rows)]
    code = document.random.choice([5121, 5123, 5125])
    sparse = {"count": len(some),
              "indices": {"bufferView": document.view(struct.pack(f"<{len(some)}{CODES[code]}", *some)),
                          "componentType": code},
              "values": {"bufferView": document.view(b"".join(struct.pack("<3f", *rows[k]) for k in some))}}
    if way == "sparse":
        return document.accessor(spoilt, 5126, sparse=sparse)
    document.json["accessors"].append({"componentType": 5126, "count": len(rows), "type": "VEC3", "sparse": sparse})
    return len(document.json["accessors"]) - 1


def _primitives(document, shape, position):
    """The triangles as a list, without indices, or as many strips and fans."""
    triangles = shape.triangles()
    way = document.random.choice(["list", "list", "parts", "strips", "fans"])
    attributes = {"POSITION": position}
    if way == "list":
        return [{"attributes": attributes, "indices": document.indices([v for t in triangles for v in t])}]
    if way == "parts":
        cut = len(triangles) // 2
        return [{"attributes": attributes, "mode": 4, "indices": document.indices([v for t in part for v in t])}
                for part in (triangles[:cut], triangles[cut:])]
    parts = []
    while triangles:
        a, b, c = triangles.pop(0)
        order = [a, b, c] if way == "strips" else [c, a, b]  # a fan turns about its first
        if triangles and triangles[0][:2] == (c, b):
            d = triangles.pop(0)[2]
            order = [a, b, c, d] if way == "strips" else [b, d, c, a]
        parts.append({"attributes": attributes, "mode": 5 if way == "strips" else 6, "indices": document.indices(order)})
    return parts


def _apply(matrix, v):
    return [sum(matrix[r][c] * v[c] for c in range(3)) + matrix[r][3] for r in range(3)]


def _product(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def _trs(random):
    """A node's translation, rotation and scale, perhaps mirroring, and the same as a matrix."""
    t = [random.uniform(-5, 5) for _ in range(3)]
    q = [random.gauss(0, 1) for _ in range(4)]
    norm = math.sqrt(sum(x * x for x in q))
    x, y, z, w = q = [v / norm for v in q]
    s = [random.choice([-1, 1]) * random.uniform(0.5, 2) for _ in range(3)]
    rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix = [[rotation[r][c] * s[c] for c in range(3)] + [t[r]] for r in range(3)] + [[0, 0, 0, 1]]
    return {"translation": t, "rotation": q, "scale": s}, matrix


def _nodes(document, shape):
    """A chain of nodes above the mesh; returns the shape as it is shown."""
    random = document.random
    matrix = [[float(r == c) for c in range(4)] for r in range(4)]
    nodes = document.json["nodes"]
    for _ in range(random.randint(0, 3)):
        trs, own = _trs(random)
        columns = [own[r][c] for c in range(4) for r in range(4)]
        nodes.append({**random.choice([trs, {"matrix": columns}]), "children": [len(nodes) + 1]})
        matrix = _product(matrix, own)
    nodes.append({"mesh": 0})
    return shape.moved(lambda v: _apply(matrix, v))


def _scenes(document):
    """One scene, several of which the second is shown, or none."""
    way = document.random.choice(["one", "one", "several", "none"])
    if way == "one":
        document.json["scenes"] = [{"nodes": [0]}]
    if way == "several":
        document.json["nodes"].append({"name": "empty"})
        document.json["scenes"] = [{"nodes": [len(document.json["nodes"]) - 1]}, {"nodes": [0]}]
        document.json["scene"] = 1


def _extras(document):
    """What says nothing about the surface."""
    random, root = document.random, document.json
    if random.random() < 0.2:
        root["extensionsUsed"] = ["VENDOR_unknown"]
    if random.random() < 0.2:
        root["extensionsUsed"] = root["extensionsRequired"] = ["KHR_materials_unlit"]
    if random.random() < 0.2:
        root["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
    if random.random() < 0.2:
        root["animations"] = []
        root["skins"] = [{"joints": [0]}]  # of no node
    if random.random() < 0.2:
        position = root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        root["meshes"][0]["primitives"].append({"attributes": {"POSITION": position}, "mode": random.randint(0, 3)})


def _finished(document, shape, name):
    shown = _nodes(document, shape)
    _scenes(document)
    _extras(document)
    case = document.packed(name)
    case.shape = shown
    return case


def _valid(random, name):
    document, shape = Document(random), placed(ball(random), random)
    morph = random.random() < 0.2
    moved = [[random.uniform(-0.2, 0.2) for _ in range(3)] for _ in shape.vertices]
    primitives = _primitives(document, shape, _positions(document, shape))
    mesh = {"primitives": primitives}
    if morph:
        target = document.accessor(moved, 5126)
        for primitive in primitives:
            primitive["targets"] = [{"POSITION": target}]
        weight = random.choice([None, 0, 0.5])
        if weight is not None:
            mesh["weights"] = [weight]
            shape = Shape([tuple(x + weight * d for x, d in zip(v, m)) for v, m in zip(shape.vertices, moved)],
                          shape.polygons)
    document.json["meshes"].append(mesh)
    return _finished(document, shape, name)


def _quantised(random, name):
    """Whole coordinates, or shares of the largest one, and a node that gives them their size."""
    document, shape = Document(random), ball(random)
    code, normalised = random.choice(list(LIMITS)), random.random() < 0.5
    limit = LIMITS[code]
    low = min(x for v in shape.vertices for x in v)
    high = max(x for v in shape.vertices for x in v)
    start = 0 if code in (5121, 5123) else -limit
    rows = [[round(start + (x - low) / (high - low) * (limit - start)) for x in v] for v in shape.vertices]
    shape = Shape([tuple(x / limit if normalised else x for x in row) for row in rows], shape.polygons)
    position = document.accessor(rows, code, **({"normalized": True} if normalised else {}))
    document.json["meshes"].append({"primitives": _primitives(document, shape, position)})
    case_shape = shape
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    shown = _nodes(document, case_shape)
    _scenes(document)
    case = document.packed(name)
    case.shape = shown
    return case


def _without_indices(random, name):
    document, shape = Document(random), placed(ball(random), random)
    corners = [list(shape.vertices[v]) for t in shape.triangles() for v in t]
    document.json["meshes"].append({"primitives": [{"attributes": {"POSITION": document.accessor(corners, 5126)}}]})
    return _finished(document, shape, name)


def _plain(random):
    """A document with one mesh, one node, one scene and a list of triangles."""
    document, shape = Document(random), placed(ball(random), random)
    position = document.accessor([list(v) for v in shape.vertices], 5126)
    order = [v for t in shape.triangles() for v in t]
    indices = document.accessor([(v,) for v in order], 5123)
    document.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}]
    document.json["nodes"] = [{"mesh": 0}]
    document.json["scenes"] = [{"nodes": [0]}]
    return document, len(shape.vertices), len(order)


def _changed(**changes):
    return lambda root: root.update(changes)


def _at(*path, **changes):
    """Changes an entry that lies so deep."""
    def change(root):
        for key in path:
            root = root[key]
        root.update(changes)
    return change


WRONG = [
    (_changed(extensionsRequired=["KHR_draco_mesh_compression"]), "requires the extension 'KHR_draco_mesh_compression'"),
    (_changed(extensionsRequired=["EXT_meshopt_compression"]), "requires the extension 'EXT_meshopt_compression'"),
    (_changed(extensionsRequired=["EXT_mesh_gpu_instancing"]), "requires the extension 'EXT_mesh_gpu_instancing'"),
    (_changed(scenes=[{"nodes": []}]), "shows no mesh: no node"),
    (_changed(asset={"version": "1.0"}), "is glTF of version '1.0'"),
    (_changed(asset={"version": "2.0", "minVersion": "2.1"}), "requires glTF of version '2.1'"),
    (_changed(asset=None), "has no 'asset'"),
    (_changed(scenes=[{"nodes": [0]}, {"nodes": []}]), "has 2 scenes and does not say which"),
    (_changed(scenes=[{"nodes": [5]}]), "names nodes[5], which is not there"),
    (_changed(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0, "children": [0]}]), "nodes[0] is below more than one node"),
    (_changed(scenes=[{"nodes": [0, 0]}]), "nodes[0] is below more than one node"),
    (_changed(nodes=[{"mesh": 3}]), "names meshes[3], which is not there"),
    (_changed(nodes=[{"mesh": 0, "skin": 0}]), "nodes[0] has a skin, which is not supported"),
    (_changed(nodes=[{"mesh": 0, "scale": [1, 2]}]), "'scale' of nodes[0] is not a list of 3 numbers"),
    (_changed(nodes=[{"mesh": 0, "matrix": [1] * 15 + ["1"]}]), "'matrix' of nodes[0] is not a list of 16 numbers"),
    (_changed(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}]), "has no faces"),
    (_changed(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 9}]}]), "has the mode 9"),
    (_at("accessors", 0, count=10**6), "accessors[0] reaches beyond bufferViews[0]"),
    (_at("accessors", 0, type="VEC4"), "accessors[0] is not of the type VEC3"),
    (_at("accessors", 0, componentType=5124), "has the componentType 5124"),
    (_at("accessors", 1, componentType=5126), "has the componentType 5126, which is not allowed there"),
    (_at("accessors", 0, byteOffset=-4), "'byteOffset' of accessors[0] is not a whole number"),
    (_at("accessors", 0, bufferView=7), "names bufferViews[7], which is not there"),
    (_at("bufferViews", 0, byteLength=10**7), "bufferViews[0] reaches beyond buffers[0]"),
    (_at("bufferViews", 1, buffer=1), "names buffers[1], which is not there"),
    (_at("bufferViews", 0, byteStride=4), "a stride that is too small"),
    (_changed(buffers=[{"byteLength": 10**6}]), "buffers[0] states 1000000 bytes, but there are"),
    (_changed(buffers=[{"byteLength": 10, "uri": "none.bin"}]), "names 'none.bin', which does not exist"),
    (_changed(buffers=[{"byteLength": 10, "uri": "../up.bin"}]), "names '../up.bin', which is not in its folder"),
    (_changed(buffers=[{"byteLength": 10, "uri": "https://x.org/a.bin"}]), "which is not a file beside this one"),
    (_changed(buffers=[{"byteLength": 10, "uri": "data:;base64,A?="}]), "is not base64"),
    (_changed(buffers=[{"byteLength": 10, "uri": "data:,abc"}]), "is not in base64, which alone is supported"),
]


def _wrong(random, name):
    document, vertices, corners = _plain(random)
    ways = ["json"] * 6 + ["length", "cut", "version", "garbled", "vertex", "corners", "pointer", "fallback", "hole"]
    way = random.choice(ways)
    if way == "json":
        change, refused = random.choice(WRONG)
        change(document.json)
        return Case(name + ".glb", document.glb(), refused=refused)
    if way == "length":
        return Case(name + ".glb", document.glb(extra=8), refused="bytes but has")
    if way == "cut":
        return Case(name + ".glb", document.glb()[:-40], refused="bytes but has")
    if way == "version":
        return Case(name + ".glb", document.glb(version=1), refused="is GLB of version 1")
    if way == "garbled":
        return Case(name + ".gltf", json.dumps(document.json).replace(":", "=", 3).encode(),
                    refused="its JSON cannot be understood at byte")
    if way == "vertex":
        place = document.json["bufferViews"][1]["byteOffset"]
        document.bytes = document.bytes[:place] + struct.pack("<H", vertices) + document.bytes[place + 2:]
        return Case(name + ".glb", document.glb(), refused=f"names vertex {vertices}, but has 0 to {vertices - 1}")
    if way == "corners":
        document.json["accessors"][1]["count"] = corners - 1
        return Case(name + ".glb", document.glb(), refused="which is no multiple of three")
    if way == "hole":
        document.json["accessors"][1]["count"] = corners - 3
        return Case(name + ".glb", document.glb(), refused="hole")
    if way == "fallback":
        document.json["buffers"] = [{"byteLength": len(document.bytes)},
                                    {"byteLength": 99, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}]
        document.json["bufferViews"][0]["buffer"] = 1
        return Case(name + ".glb", document.glb(), refused="only those of the extension 'EXT_meshopt_compression'")
    document.json["buffers"] = [{"byteLength": len(document.bytes), "uri": name + ".bin"}]
    pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 99\n"
    return Case(name + ".gltf", json.dumps(document.json).encode(), beside={name + ".bin": pointer},
                refused="which it names, is a Git LFS pointer")


def cases(random, count):
    """The last third is wrong."""
    for k in range(count - count // 3):
        yield random.choice([_valid, _valid, _quantised, _without_indices])(random, f"valid_gltf_{k}")
    for k in range(count // 3):
        yield _wrong(random, f"wrong_gltf_{k}")
