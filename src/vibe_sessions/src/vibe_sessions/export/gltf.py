"""The moving wall as one file of glTF 2.0 (https://registry.khronos.org/glTF): each frame is a morph target of the first one."""

import json
import math
import os
import shutil
import struct
import tempfile
from array import array

import numpy

from ..report.bag_file import BagError
from ..report.point_cloud import positions_of
from .mesh import Wall

MOST = 2000  # frames, whose weights alone take 16 MB: one number for each frame at each frame
RADIUS, LENGTH, SIDES = 0.006, 0.06, 16  # of the tube that stands for the scope [m]
UPRIGHT = [-(0.5**0.5), 0, 0, 0.5**0.5]  # z is up here, y in glTF
FLOAT, UINT = 5126, 5125
VERTICES, INDICES = 34962, 34963
COLOURS = {"wall": [0.8, 0.4, 0.36, 1], "scope_tip": [0.1, 0.1, 0.12, 1]}


def tube():
    """Vertices and triangles of the end of the scope, which looks along x."""
    angles = 2 * numpy.pi * numpy.arange(SIDES) / SIDES
    ring = numpy.stack([0 * angles, RADIUS * numpy.cos(angles), RADIUS * numpy.sin(angles)], axis=1)
    this, following = numpy.arange(SIDES), (numpy.arange(SIDES) + 1) % SIDES
    sides = [[this + SIDES, following, this], [this + SIDES, following + SIDES, following]]
    tip = [[0, k, k + 1] for k in range(1, SIDES - 1)]
    return numpy.concatenate([ring, ring - [LENGTH, 0, 0]]), numpy.concatenate([*(numpy.stack(each, axis=1) for each in sides), tip])


class Gltf(Wall):
    def __init__(self, folder, source, files):
        super().__init__(source, ["scope/measured_cp"])
        self._folder, self._binary = folder, files.enter_context(tempfile.TemporaryFile(dir=folder))
        self._gltf = {"accessors": [], "bufferViews": [], "meshes": [], "materials": [], "nodes": []}
        self._base, self._targets, self._poses, self._animated = None, [], array("d"), []
        self._rows = ["time [s],stamp [s],deviation [m]"]

    def add(self, message):
        if message.connection.topic.endswith("measured_cp"):
            place, turn, time = message.fields.pose.position, message.fields.pose.orientation, message.time / 1e9
            pose = (time, place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
            if all(map(math.isfinite, pose)) and any(pose[4:]) and (not self._poses or time > self._poses[-8]):
                self._poses.extend(pose)
        else:
            super().add(message)

    def _frame(self, time, revision, points, frame):
        positions = numpy.asarray(positions_of(points), "<f4")
        if not numpy.isfinite(positions).all():
            raise BagError("{}: a particle is nowhere at {:.3f} s, which glTF cannot say; choose the time before with --to-time".format(self._path, time))
        if self._base is None:
            self._base, self._begin, self._revision, self._name = positions, time, revision, frame
        if revision != self._revision:
            raise BagError("{}: another organ comes at {:.3f} s, and glTF has one; choose its time with --from and --to-time, in a call of its own".format(self._path, time))
        if len(self._rows) > MOST:
            raise BagError("{}: has more than {} frames, which no viewer of glTF takes; give a lower --rate in a call of its own".format(self._path, MOST))
        moved = positions - self._base
        deviation = numpy.abs(self._base + moved - positions).max()
        self._rows.append("{!r},{!r},{:.3g}".format(round(time - self._begin, 9), time, deviation))
        if len(self._rows) > 2:
            self._targets.append({"POSITION": self._accessor(moved, VERTICES)})

    def _accessor(self, values, target=None):
        """The number of the accessor of these values, whose bytes come next."""
        view = {"buffer": 0, "byteOffset": self._binary.tell(), "byteLength": values.nbytes, **({"target": target} if target else {})}
        accessor = {"bufferView": len(self._gltf["bufferViews"]), "componentType": UINT if values.dtype.kind == "u" else FLOAT,
                    "count": len(values), "type": "SCALAR" if values.ndim == 1 else "VEC{}".format(values.shape[1])}  # fmt: skip
        if target == VERTICES or not target:
            accessor.update({name: numpy.atleast_1d(of(values, axis=0)).tolist() for name, of in (("min", numpy.min), ("max", numpy.max))})
        self._binary.write(values.tobytes())
        self._gltf["bufferViews"].append(view)
        self._gltf["accessors"].append(accessor)
        return len(self._gltf["accessors"]) - 1

    def _add_node(self, name, vertices, triangles, **about):
        """The node of a mesh; `about` is further in its only primitive."""
        material = {"doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": COLOURS[name], "metallicFactor": 0, "roughnessFactor": 0.6}}
        primitive = {"attributes": {"POSITION": self._accessor(numpy.asarray(vertices, "<f4"), VERTICES)},
                     "indices": self._accessor(numpy.asarray(triangles, "<u4").ravel(), INDICES),
                     "material": len(self._gltf["materials"]), **about}  # fmt: skip
        self._gltf["materials"].append(material)
        self._gltf["meshes"].append({"name": name, "primitives": [primitive]})
        self._gltf["nodes"].append({"name": name, "mesh": len(self._gltf["meshes"]) - 1})

    def _animate(self, path, times, values):
        """A quantity of the last node."""
        self._animated.append((len(self._gltf["nodes"]) - 1, path, times, self._accessor(numpy.asarray(values, "<f4"))))

    def _times(self, times):
        return self._accessor(numpy.asarray(times, "<f4"))

    def finish(self):
        self._check(self._rows[1:])
        targets = {"targets": self._targets} if self._targets else {}
        self._add_node("wall", self._base, self._topologies[self._revision], **targets)
        if self._targets:
            times = [float(row.split(",")[0]) for row in self._rows[1:]]
            self._animate("weights", self._times(times), numpy.eye(len(times), len(self._targets), -1).ravel())
        poses = numpy.array(self._poses).reshape(-1, 8)
        poses = poses[(self._begin <= poses[:, 0]) & (poses[:, 0] <= self._last / 1e9)]
        if len(poses):
            self._add_node("scope_tip", *tube())
            times = self._times(poses[:, 0] - self._begin)
            self._animate("translation", times, poses[:, 1:4])
            self._animate("rotation", times, poses[:, 4:] / numpy.linalg.norm(poses[:, 4:], axis=1, keepdims=True))
        self._write()
        with open(os.path.join(self._folder, "frames.csv"), "w", encoding="utf-8") as file:
            file.write("\n".join(self._rows) + "\n")
        return "{} frames".format(len(self._rows) - 1)

    def _write(self):
        made, size = self._gltf, self._binary.tell()
        made["nodes"].append({"name": self._name, "rotation": UPRIGHT, "children": list(range(len(made["nodes"])))})
        made.update(asset={"version": "2.0", "generator": "ViBE for ROS"}, buffers=[{"byteLength": size}], scene=0,
                    scenes=[{"nodes": [len(made["nodes"]) - 1]}])  # fmt: skip
        if self._animated:
            channels = [{"sampler": k, "target": {"node": node, "path": path}} for k, (node, path, _, _) in enumerate(self._animated)]
            samplers = [{"input": times, "output": values} for _, _, times, values in self._animated]
            made["animations"] = [{"name": "session", "channels": channels, "samplers": samplers}]
        text = json.dumps(made, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        self._binary.seek(0)
        with open(os.path.join(self._folder, "wall.glb"), "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, 12 + 8 + len(text) + 8 + size, len(text), 0x4E4F534A) + text)
            file.write(struct.pack("<II", size, 0x004E4942))
            shutil.copyfileobj(self._binary, file)
