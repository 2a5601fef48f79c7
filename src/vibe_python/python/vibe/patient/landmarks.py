"""The four landmarks of an imaged organ: from the labels of its neighbours where the map has them, else from its shape."""

import os
import re
import tempfile

import numpy as np

import vibe

from .label_map import need
from .mesh import WALL_ALONE, write_ply

NAMES = ("oesophagus", "fundus", "incisura", "pylorus")
NEIGHBOURS = (15, 19)  # oesophagus and duodenum of TotalSegmentator 2, task total
STOMACH = 6  # the same
_TOUCHING = 3e-3  # farther apart neighbours do not touch [m]
_OPENING = 40e-3  # a contact wider than that is no end of the organ [m]
_FROM_JUNCTION = 25e-3  # the highest point nearer to the junction is a stump of the oesophagus [m]
_INCISURA = (0.35, 0.85)  # along the lesser curvature; 40 % of it in a steer-horn stomach, 62 % in a sthenic one, 74 % in a J
_SHARED = 0.2  # share of the surface


def find(organ, neighbours):
    """Dictionary: name to place [m], and by what it was found."""
    ends = dict(zip(("oesophagus", "pylorus"), (_opening(organ, k) for k in neighbours)))
    ends = {name: place for name, place in ends.items() if place is not None}
    if ends.get("oesophagus", [0, 0, 1])[2] < ends.get("pylorus", [0, 0, -1e9])[2] - 0.05:
        organ.doubts.append("The junction with the oesophagus lies more than 5 cm below the pylorus by the labels beside it; look at the landmarks.")
    if len(ends) == 2:
        return {**ends, **_between(organ, ends)}, dict.fromkeys(ends, "neighbour's label") | dict.fromkeys(("fundus", "incisura"), "surface, between the ends")
    guessed = _guess(organ)
    return {**guessed, **ends}, dict.fromkeys(NAMES, "shape") | dict.fromkeys(ends, "neighbour's label")


def check_shared_faces(organ, neighbours):
    """Other organs whose labels share much of the surface."""
    data, mask = organ.around(), organ.mask
    faces = {}
    for axis in range(3):
        for shift in (-1, 1):
            beside, count = np.unique(np.roll(data, shift, axis)[mask & ~np.roll(mask, shift, axis)], return_counts=True)
            for k, c in zip(beside, count):
                faces[int(k)] = faces.get(int(k), 0) + int(c)
    for k, count in faces.items():
        share = count / sum(faces.values())
        if k not in (0, organ.label, *neighbours) and share > _SHARED:
            organ.doubts.append(f"Label {k} shares {100 * share:.0f} % of the surface of label {organ.label}: there the wall is where the segmentation "
                                "drew the border. Compare it with the image.")


def _opening(organ, neighbour):
    """Centre of the contact with a neighbour [m], or None."""
    other = organ.around() == neighbour
    if not other.any():
        return None
    distance = need("scipy.ndimage", "python3-scipy").distance_transform_edt(~other, organ.labels.spacing)
    touching = organ.world(np.argwhere(organ.mask & (distance <= max(_TOUCHING, 1.01 * organ.labels.spacing.max()))))
    if not len(touching):
        return None
    centre = touching.mean(axis=0)
    wide = np.sqrt(8 * np.mean(np.sum((touching - centre) ** 2, axis=1)))  # of a disc with this scatter
    if wide > _OPENING:
        organ.doubts.append(f"Label {neighbour} touches the organ over {1e3 * wide:.0f} mm, which is too wide for an end of it, so the landmark was "
                            "not taken from there. State the labels of oesophagus and duodenum with --neighbours.")
        return None
    return organ.vertices[np.linalg.norm(organ.vertices - centre, axis=1).argmin()]


def _between(organ, ends):
    """Fundus: the highest point away from the junction. Incisura: the shortest way along the wall from junction to pylorus is the
    lesser curvature; its point farthest from the straight line between them, away from both."""
    graph, sparse = need("scipy.sparse.csgraph", "python3-scipy"), need("scipy.sparse", "python3-scipy")
    x, t = organ.vertices, organ.triangles
    away = np.linalg.norm(x - ends["oesophagus"], axis=1) > _FROM_JUNCTION
    edges = np.vstack([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    lengths = np.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1)
    begin, end = (int(np.linalg.norm(x - ends[name], axis=1).argmin()) for name in ("oesophagus", "pylorus"))
    from_begin, before = graph.dijkstra(sparse.coo_matrix((lengths, edges.T), (len(x), len(x))), indices=begin, return_predecessors=True)
    way = [end]
    while way[-1] != begin:
        way.append(int(before[way[-1]]))
    way = [v for v in way if _INCISURA[0] < from_begin[v] / from_begin[end] < _INCISURA[1]]
    chord = (x[end] - x[begin]) / np.linalg.norm(x[end] - x[begin])
    return {"fundus": x[away][x[away][:, 2].argmax()], "incisura": x[way][np.linalg.norm(np.cross(x[way] - x[begin], chord), axis=1).argmax()]}


def _guess(organ):
    """From the shape alone, as for any surface (docs/tutorials/own_mesh.md)."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "surface.ply")
        lps = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # to our axes; those that a file without others is taken in
        write_ply(file, 1e3 * organ.vertices @ lps, organ.triangles)
        try:
            report = vibe.load(mesh=file, geometry={"particles": 500}, **WALL_ALONE).mesh_report
        except vibe.Error as error:
            said = str(error).replace(file + ": ", "").split(" State them")[0]
            raise vibe.Error(f"{organ.labels.file}: the landmarks cannot be found. {said} Give a map that has oesophagus and duodenum too; "
                             f"or, if its axes are wrong, {organ.labels.axes_remedy}.") from None
    doubt = re.search(r"The landmarks of .*? are doubtful: (.*?);", report)
    if doubt:
        organ.doubts.append(f"The landmarks were guessed from the shape and are doubtful: {doubt.group(1)}. Look at the pictures, and correct scene.yaml.")
    place = {name: re.search(name + r": \[(.*?)\]", report).group(1).split(",") for name in NAMES}
    return {name: 1e-3 * lps @ np.array(values, float) for name, values in place.items()}
