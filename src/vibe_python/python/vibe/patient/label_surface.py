"""The smooth closed surface of one label, with the volume of its voxels, and what is doubtful about its shape."""

import numpy as np

from .. import Error
from .label_map import METRES, need
from .mesh import area, enclosed_volume

STEP = 2e-3  # of the grid in which the surface is found [m]: half the distance of 3,618 particles
_SMOOTHING = 0.6  # standard deviation over the largest of spacing and STEP
_NARROW = 8e-3  # radius of the largest ball inside [m]; the scope has 6 mm
_TUBE = 30e-3  # diameter of a section of oesophagus or duodenum [m], at most
_SMALL_PART = 0.1  # share of a part that may be lost
_CAVITY = 0.05  # share of the volume from which on a label is a wall and not a filled organ
_POSSIBLE, _USUAL = (0.03e-3, 6e-3), (0.1e-3, 3e-3)  # [m^3]
_SIZES = "stomachs hold 0.1 to 3 L (0.3 to 1.8 L resected, Toro 2015; 0.36 to 1.1 L fed, MRI; 0.8 to 1.8 L gas-distended, El-Sayes 2020)"
_NAMES = ("front", "back", "left", "right", "head", "feet")


class Organ:
    """Vertices (n, 3) in the world [m] and triangles (m, 3), oriented outwards. `wall` gives the thickness at points where the
    label is a wall around a cavity [m], else it is None."""

    def __init__(self, labels, label):
        self.labels, self.doubts = labels, labels.doubts
        self._check_size(label)
        mask = self._largest_part(self._crop(labels.data == label), label)
        if min(np.ptp(np.argwhere(mask), axis=0)) < 8:
            raise Error(f"{labels.file}: label {label} is fewer than 9 voxels wide, which shows no shape; segment an image with smaller voxels.")
        labels.check_slices()
        self._check_border(label)
        self.wall = None
        self.voxel_volume = 0.0  # inside [m^3]
        self.vertices, self.triangles = self._surface(self._distance(mask, label))
        self.mask, self.label = mask, label

    # --- voxels

    def _crop(self, mask):
        """The label with a free margin, so that what is around it can be seen."""
        sides = [np.flatnonzero(mask.any(axis=tuple({0, 1, 2} - {a}))) for a in range(3)]
        margin = np.ceil(8e-3 / self.labels.spacing).astype(int) + 2
        begin = np.array([s[0] for s in sides]) - margin
        end = np.array([s[-1] for s in sides]) + 1 + margin
        self.first = begin  # index of the first voxel of the crop, may lie outside of the image
        self.inside = tuple(slice(max(b, 0), min(e, n)) for b, e, n in zip(begin, end, mask.shape))
        self.pad = [(max(-b, 0), max(e - n, 0)) for b, e, n in zip(begin, end, mask.shape)]
        return np.pad(mask[self.inside], self.pad)

    def around(self):
        """The labels in the crop."""
        return np.pad(self.labels.data[self.inside], self.pad)

    def world(self, index):
        """Places of voxels of the crop [m]."""
        return (np.asarray(index) + self.first) @ self.labels.axes.T + self.labels.origin

    def _largest_part(self, mask, label):
        measure = need("scipy.ndimage", "python3-scipy")
        parts, count = measure.label(mask)
        if count == 1:
            return mask
        sizes = np.bincount(parts.ravel())[1:]
        rest = 1 - sizes.max() / sizes.sum()
        said = f"label {label} has {count} parts; the largest holds {100 * (1 - rest):.1f} % of its voxels"
        if rest > _SMALL_PART:
            raise Error(f"{self.labels.file}: {said}, so it is not one organ; join or remove the others in the segmentation.")
        self.doubts.append(f"{said[0].upper()}{said[1:]} and was taken. Look at the others in the segmentation.")
        return parts == 1 + sizes.argmax()

    def _check_size(self, label):
        volume = self.labels.volume(label)
        text = f"label {label} holds {1e3 * volume:.3g} L with voxels of {' x '.join(f'{1e3 * s:.3g}' for s in self.labels.spacing)} mm, and {_SIZES}"
        if not _POSSIBLE[0] < volume < _POSSIBLE[1]:
            likely = [u for u, m in METRES.items() if _USUAL[0] < volume * (m / METRES[self.labels.unit]) ** 3 < _USUAL[1]]
            unit = f"perhaps its unit is '{likely[0]}' and not '{self.labels.unit}' (xyzt_units of the header)" if likely else "look for another label"
            raise Error(f"{self.labels.file}: {text}; {unit}, or its spacing is lost.")
        if not _USUAL[0] < volume < _USUAL[1]:
            self.doubts.append(f"{text[0].upper()}{text[1:]}. Compare label and spacing with the image.")

    def _check_border(self, label):
        """A section in the outermost slice: the organ goes on beyond the image."""
        data, spacing = self.labels.data, self.labels.spacing
        for axis in range(3):
            for end, next_one, sign in ((0, 1, -1), (-1, -2, 1)):
                count = np.count_nonzero(data.take(end, axis) == label)
                if not count:
                    continue
                wide = 2 * np.sqrt(count * np.prod(np.delete(spacing, axis)) / np.pi)
                way = sign * self.labels.axes[:, axis]
                side = _NAMES[2 * np.abs(way).argmax() + (way[np.abs(way).argmax()] < 0)]
                said = f"label {label} reaches the border of the image towards the {side}, there {1e3 * wide:.0f} mm wide"
                if wide > _TUBE and count > 0.8 * np.count_nonzero(data.take(next_one, axis) == label):
                    raise Error(f"{self.labels.file}: {said}, so the organ is cut off; segment an image that shows all of it.")
                self.doubts.append(f"{said[0].upper()}{said[1:]}; what lies beyond is missing, and the end was closed. Look whether it is an end "
                                   "of the organ.")

    # --- surface

    def _distance(self, mask, label):
        """Signed distance to the surface [m], positive inside, per voxel; to the middle of the wall where the label is one."""
        measure = need("scipy.ndimage", "python3-scipy")
        filled = measure.binary_fill_holes(mask)
        volume, cell = filled.sum(), abs(np.linalg.det(self.labels.axes))
        cavity = filled & ~mask
        share = cavity.sum() / volume
        to_outside = measure.distance_transform_edt(filled, self.labels.spacing)
        if share > _CAVITY:
            to_cavity = measure.distance_transform_edt(~cavity, self.labels.spacing)
            self.wall = lambda index: measure.map_coordinates(to_outside + to_cavity, index.T, order=1) - self.labels.spacing.mean()
            self.doubts.append(f"Label {label} is a wall around a cavity of {1e3 * cavity.sum() * cell:.3g} L: the surface half-way between its "
                               "inner and its outer side was taken, and the thickness from the image. Look whether the cavity is all of the lumen.")
            distance = (to_outside - to_cavity) / 2
            self.voxel_volume = np.count_nonzero(distance > 0) * cell + 0.5 * np.count_nonzero(distance == 0) * cell
            return distance
        if share > 0:
            self.doubts.append(f"Label {label} has holes inside, {100 * share:.2g} % of its volume, which were filled.")
        if to_outside.max() < _NARROW:
            raise Error(f"{self.labels.file}: label {label} is nowhere wider than {2e3 * to_outside.max():.0f} mm, so it is perhaps a wall with an "
                        "opening, or a tube; label the lumen together with the wall.")
        self.voxel_volume = volume * cell
        return to_outside - measure.distance_transform_edt(~filled, self.labels.spacing)

    def _surface(self, distance):
        measure = need("scipy.ndimage", "python3-scipy")
        spacing = self.labels.spacing
        ratio = STEP / spacing
        shape = np.ceil((np.array(distance.shape) - 1) / ratio).astype(int) + 1
        even = measure.affine_transform(distance, np.diag(ratio), output_shape=tuple(shape), order=1, mode="nearest")
        smoothing = _SMOOTHING * max(spacing.max(), STEP) / STEP
        for stronger in (1, 1.5, 2):
            vertices, triangles = self._level(measure.gaussian_filter(even, stronger * smoothing), ratio)
            handles = 1 - (len(vertices) - len(triangles) / 2) / 2
            if handles == 0:
                return vertices, triangles
        raise Error(f"{self.labels.file}: the surface of the label has {handles:.0f} handle(s), as where walls touch that are apart in the patient; "
                    "separate them in the segmentation.")

    def _level(self, field, ratio):
        """The level that encloses the volume of the voxels, by Newton's method: the volume falls with the level as the area says."""
        level = 0.0
        for _ in range(5):
            vertices, triangles = _march(field, level)
            vertices = self.world(vertices * ratio)
            volume = enclosed_volume(vertices, triangles)
            if volume < 0:
                triangles, volume = triangles[:, ::-1], -volume
            if abs(volume - self.voxel_volume) < 1e-4 * self.voxel_volume:
                break
            level += (volume - self.voxel_volume) / area(vertices, triangles)
        return vertices, triangles


def _march(field, level):
    """The largest part of a level set."""
    skimage = need("skimage.measure", "python3-skimage")
    graph, sparse = need("scipy.sparse.csgraph", "python3-scipy"), need("scipy.sparse", "python3-scipy")
    vertices, triangles, _, _ = skimage.marching_cubes(field, level, allow_degenerate=False)
    edges = np.vstack([triangles[:, :2], triangles[:, 1:]])
    count = len(vertices)
    _, part = graph.connected_components(sparse.coo_matrix((np.ones(len(edges)), edges.T), (count, count)), directed=False)
    keep = part == np.bincount(part).argmax()
    number = np.cumsum(keep) - 1
    return vertices[keep].astype(float), number[triangles[keep[triangles[:, 0]]]]

