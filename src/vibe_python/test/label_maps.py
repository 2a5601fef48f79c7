"""Label maps of the procedural organs, as a segmentation would have them: voxels of any spacing and axes, neighbours, defects."""
import functools

import nibabel
import numpy as np
from scipy import ndimage

import vibe

RAS = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # from our axes: x front, y left, z head
TUBE = 13.0  # radius [mm]; oesophagus and duodenum have 11
STOMACH, OESOPHAGUS, DUODENUM, LIVER, SPLEEN = 6, 15, 19, 5, 1


@functools.lru_cache(maxsize=None)
def model(shape="sthenic", scale=1.0):
    return vibe.load(geometry={"particles": 3000, "shape": shape, "scale": scale}, render_surface=False)


def affine(spacing, turn=(0, 0, 0), origin=(-200.0, -150.0, -1100.0)):
    """From voxels to RAS [mm]; turn: about the three axes [rad]."""
    a, b, c = turn
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    result = np.eye(4)
    result[:3, :3] = z @ y @ x @ np.diag(np.broadcast_to(spacing, 3))
    result[:3, 3] = origin
    return result


def fill(points, triangles, shape):
    """Which voxels (centres at whole numbers) lie inside a closed surface in voxel indices: parity along the last axis."""
    crossings = np.zeros((*shape[:2], shape[2] + 1), np.int32)
    points = points + [1.3e-4, 2.1e-4, 0]  # no vertex exactly above a centre
    for a, b, c in points[triangles]:
        low = np.maximum(np.ceil(np.minimum(np.minimum(a, b), c)[:2]), 0).astype(int)
        high = np.minimum(np.floor(np.maximum(np.maximum(a, b), c)[:2]), np.array(shape[:2]) - 1).astype(int)
        if (low > high).any():
            continue
        i, j = np.mgrid[low[0] : high[0] + 1, low[1] : high[1] + 1]
        det = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(det) < 1e-12:
            continue
        s = ((i - a[0]) * (c[1] - a[1]) - (j - a[1]) * (c[0] - a[0])) / det
        t = ((b[0] - a[0]) * (j - a[1]) - (b[1] - a[1]) * (i - a[0])) / det
        inside = (s >= 0) & (t >= 0) & (s + t <= 1)
        k = np.clip(np.ceil((a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]))[inside]), 0, shape[2]).astype(int)
        np.add.at(crossings, (i[inside], j[inside], k), 1)
    return (np.cumsum(crossings, axis=2)[..., :-1] % 2).astype(bool)


def grid(points, spacing, turn, margin=30.0):
    """(affine, shape) of an image around points in RAS [mm]."""
    frame = affine(spacing, turn)
    index = np.linalg.solve(frame[:3, :3], points.T).T
    border = margin / np.broadcast_to(spacing, 3)
    frame[:3, 3] = frame[:3, :3] @ (index.min(axis=0) - border)
    return frame, tuple(np.ceil(np.ptp(index, axis=0) + 2 * border).astype(int))


def voxelise(vertices, triangles, spacing, turn=(0, 0, 0), margin=30.0):
    """(data, affine) of a surface in our world [m]."""
    points = 1e3 * vertices @ RAS.T
    frame, size = grid(points, spacing, turn, margin)
    index = np.linalg.solve(frame[:3, :3], (points - frame[:3, 3]).T).T
    return np.where(fill(index, triangles, size), STOMACH, 0).astype(np.uint8), frame


def label_map(spacing=2.0, turn=(0, 0, 0), shape="sthenic", scale=1.0, neighbours=True, margin=30.0):
    """(data, affine): the organ as TotalSegmentator labels it; with neighbours, its tubes are oesophagus and duodenum, and there are
    a liver and a spleen."""
    organ = model(shape, scale)
    data, frame = voxelise(organ.rest_positions, organ.triangles, spacing, turn, margin)
    if neighbours:
        points = 1e3 * organ.rest_positions @ RAS.T
        place = np.moveaxis(np.indices(data.shape), 0, -1) @ frame[:3, :3].T + frame[:3, 3]
        inside = ndimage.distance_transform_edt(data == STOMACH, np.linalg.norm(frame[:3, :3], axis=0))
        opened = ndimage.distance_transform_edt(inside < TUBE, np.linalg.norm(frame[:3, :3], axis=0)) < TUBE  # without the tubes
        base = vibe.Simulation(organ).link_pose("scope_base")
        data[(data == STOMACH) & ~opened & (np.linalg.norm(place - 1e3 * RAS @ base[:3, 3], axis=-1) < 30)] = OESOPHAGUS
        data[(data == STOMACH) & (np.linalg.norm(place - points[points[:, 0].argmax()], axis=-1) < 18)] = DUODENUM
        parts, _ = ndimage.label(data == STOMACH)
        data[(data == STOMACH) & (parts != 1 + np.bincount(parts.ravel())[1:].argmax())] = 0  # no specks beside the cuts
        middle = points.mean(axis=0)
        for label, where, radius in ((LIVER, [105, 0, 60], 50), (SPLEEN, [-95, -30, 30], 22)):  # as large as such organs at least are
            ball = np.linalg.norm(place - middle - where, axis=-1) < radius
            data[ball & (data == 0)] = label
    return data, frame


def save(path, data, frame, unit="mm", **codes):
    """codes: sform, qform"""
    image = nibabel.Nifti1Image(data, frame)
    image.header.set_xyzt_units(unit)
    image.set_sform(frame if codes.get("sform", 1) else None, codes.get("sform", 1))
    image.set_qform(frame if codes.get("qform", 1) else None, codes.get("qform", 1))
    nibabel.save(image, path)
    return str(path)
