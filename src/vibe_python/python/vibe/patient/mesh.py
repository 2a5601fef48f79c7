"""Closed triangle surfaces: measures, files, and the organ that the simulator makes of one."""

import os
import tempfile

import numpy as np

import vibe

#: what a scene of the wall alone lacks
WALL_ALONE = dict.fromkeys(("scope", "helix", "suture", "bleeding", "marking"))


def write_ply(file, vertices, triangles):
    """Vertices (n, 3), triangles (m, 3)."""
    faces = np.empty(len(triangles), [("count", "u1"), ("corner", "<i4", 3)])
    faces["count"], faces["corner"] = 3, triangles
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(file, "wb") as out:
        out.write(header.encode() + np.ascontiguousarray(vertices, "<f8").tobytes() + faces.tobytes())


def model_of(vertices, triangles, geometry, **sections):
    """The wall of the default scene in this shape, and where the surface lies in the frame of its particles: (model, vertices).
    geometry: landmarks in the frame of the surface, particles."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "surface.ply")
        write_ply(file, vertices, triangles)
        model = vibe.load(geometry={**geometry, "kind": "mesh", "file": file, "unit": 1.0}, render_surface=False, **WALL_ALONE, **sections)
    return model, vertices + centre(model.rest_positions, model.triangles) - centre(vertices, triangles)


def enclosed_volume(vertices, triangles):
    """[m^3], negative where the triangles are oriented inwards."""
    return _cones(vertices, triangles)[1].sum()


def centre(vertices, triangles):
    """Of the enclosed volume."""
    middle, volume = _cones(vertices, triangles)
    return volume @ middle / volume.sum()


def _cones(vertices, triangles):
    """Centres and volumes of the tetrahedra of each triangle with the mean of the vertices."""
    tip = vertices.mean(axis=0)
    corner = (vertices - tip)[triangles]
    return tip + corner.sum(axis=1) / 4, np.einsum("ij,ij->i", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6


def area(vertices, triangles):
    """[m^2]"""
    corner = vertices[triangles]
    return np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1).sum() / 2
