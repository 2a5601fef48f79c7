"""Closed surfaces from fields that are negative inside, on a grid [mm]; checks of them; binary STL."""
import struct

import numpy as np
import vtk
from vtk.util import numpy_support
from vibe_sessions.whole_file import open_whole


def polydata(points, triangles):
    data, cells, place = vtk.vtkPolyData(), vtk.vtkCellArray(), vtk.vtkPoints()
    rows = np.hstack([np.full((len(triangles), 1), 3), triangles]).astype(np.int64)
    place.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetCells(len(triangles), numpy_support.numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    data.SetPoints(place)
    data.SetPolys(cells)
    return data


def signed_distance(points, triangles, at):
    """Distance to a closed surface at places (..., 3), negative inside."""
    distance, out = vtk.vtkImplicitPolyDataDistance(), vtk.vtkDoubleArray()
    distance.SetInput(polydata(points, triangles))
    distance.FunctionValue(numpy_support.numpy_to_vtk(np.ascontiguousarray(at.reshape(-1, 3)), deep=True), out)
    return numpy_support.vtk_to_numpy(out).reshape(at.shape[:-1])


def surface(field, axes):
    """Points (n, 3) and triangles of the body where a field over the grid of three axes is negative. The body ends at the
    grid: a layer outside of it is marched, too, and its points are moved to the border, so that faces there are flat and
    their edges sharp."""
    padded = np.pad(field, 1, constant_values=1.0)
    image, marching = vtk.vtkImageData(), vtk.vtkFlyingEdges3D()
    image.SetDimensions(*padded.shape)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(padded.ravel(order="F"), deep=True))
    marching.SetInputData(image)
    marching.SetValue(0, 0.0)
    marching.ComputeNormalsOff()
    marching.Update()
    found = marching.GetOutput()
    index = numpy_support.vtk_to_numpy(found.GetPoints().GetData()) - 1.0
    triangles = numpy_support.vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    points = np.stack([np.interp(index[:, k], np.arange(len(axis)), axis) for k, axis in enumerate(axes)], axis=1)
    points, triangles = welded(points, triangles)
    return points, (triangles if volume(points, triangles) > 0 else triangles[:, ::-1])


def welded(points, triangles):
    """Equal points made one, to the precision of STL, and triangles that have collapsed left out."""
    points, number = np.unique(points.astype(np.float32), axis=0, return_inverse=True)
    triangles = number[triangles]
    a, b, c = triangles.T
    return points.astype(float), triangles[(a != b) & (b != c) & (c != a)]


def volume(points, triangles):
    """Of a closed surface that is oriented outwards, in cubed units of its points."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def faults(points, triangles, lines=400):
    """What is wrong with a surface, as sentences: open or badly joined edges, orientation, and crossings of itself as far
    as vertical lines at random places show them, along which ways in and out must alternate."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    key = edges[:, 0] * len(points) + edges[:, 1]
    back = edges[:, 1] * len(points) + edges[:, 0]
    unmatched = len(np.setxor1d(key, back))
    said = [f"{unmatched} edges have no neighbour of the same orientation"] if unmatched else []
    if len(np.unique(key)) < len(key):
        said.append(f"{len(key) - len(np.unique(key))} edges are shared by more than two triangles")
    if volume(points, triangles) <= 0:
        said.append("it is oriented inwards")
    wrong = sum(not _alternates(points, triangles, at) for at in np.random.default_rng(1).uniform(
        points[:, :2].min(0), points[:, :2].max(0), (lines, 2)))
    return said + ([f"{wrong} of {lines} vertical lines cross it out of turn"] if wrong else [])


def _alternates(points, triangles, at):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    near = ((np.minimum(np.minimum(a, b), c)[:, :2] <= at) & (np.maximum(np.maximum(a, b), c)[:, :2] >= at)).all(axis=1)
    a, b, c = a[near], b[near], c[near]

    def turn(p, q):
        return (q[:, 0] - p[:, 0]) * (at[1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (at[0] - p[:, 0])
    weights = np.stack([turn(b, c), turn(c, a), turn(a, b)])
    area = weights.sum(axis=0)
    inside = ((weights * np.sign(area)) > 0).all(axis=0)
    height = (weights * np.stack([a[:, 2], b[:, 2], c[:, 2]])).sum(axis=0)[inside] / area[inside]
    signs = np.sign(area[inside])[np.argsort(height)]
    return signs.sum() == 0 and (signs[::2] < 0).all() and (signs[1::2] > 0).all()


def write_stl(file, points, triangles):
    """Binary STL, in the unit of the points."""
    corners = points[triangles].astype("<f4")
    record = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    record["normal"] = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    record["corners"] = corners
    with open_whole(file, "wb") as stream:
        stream.write(b"ViBE phantom [mm]".ljust(80) + struct.pack("<I", len(corners)) + record.tobytes())
