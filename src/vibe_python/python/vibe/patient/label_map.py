"""Label maps in NIfTI: the file, its header, and which labels there are. What cannot be right raises vibe.Error; what may be
wrong is a sentence in `doubts`."""

import gzip
import importlib
import itertools
import os
import zlib

import numpy as np

from .. import Error

#: from RAS, the axes of NIfTI, to ours: x to the front, y to the left, z to the head
TO_WORLD = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
METRES = {"meter": 1.0, "mm": 1e-3, "micron": 1e-6, "unknown": 1e-3}  # NIfTI programs write millimetres when they write no unit
_SLANT = 2.0  # of two axes [degrees]; rounded headers are a thousandth of that
_MANY_VALUES = 500  # more than the labels of any atlas of the whole body
_ANISOTROPIC = 3.0  # ratio of spacings
_THICK = 5.5e-3  # slices [m]; those of most abdominal CT are at most 5 mm

# TotalSegmentator, class maps of `total` in its versions 1 and 2 and of `total_mr`
SPLEEN, LIVER = 1, 5
VERTEBRAE = range(27, 45)  # L5 to T1, version 2
_VERTEBRA_STEP = (15e-3, 50e-3)  # between neighbours [m]: 20 mm at T1 to 40 mm at L5 of adults, wide margins


def need(module, package):
    """A module that only this needs."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise Error(f"The import of images needs the module {module}, which is not there; apt-get install {package}.") from None


class LabelMap:
    """Whole numbers `data` (i, j, k), and the map of voxel indices into the world: `axes` (3, 3), `origin` (3,) [m]."""

    def __init__(self, file):
        self.file, self.doubts, self.axes_remedy = file, [], "correct the header's affine"
        image, self.data = _load(file)
        self.axes, self.origin = self._frame(image)
        self.spacing = np.linalg.norm(self.axes, axis=0)  # [m]
        self.counts = _count(self.data, file)

    def _frame(self, image):
        header = image.header
        with np.errstate(all="ignore"):
            affine = np.asarray(image.affine, float)
        if not np.isfinite(affine).all() or abs(np.linalg.det(affine[:3, :3])) < 1e-12:
            raise Error(f"{self.file}: its affine has no inverse, so voxels have no size; take the map as the segmentation wrote it.")
        self.unit = header.get_xyzt_units()[0]
        metres = METRES[self.unit]
        self._compare_forms(header, affine, image.shape[:3])
        self._check_angles(affine[:3, :3])
        return metres * TO_WORLD @ affine[:3, :3], metres * TO_WORLD @ affine[:3, 3]

    def _compare_forms(self, header, affine, shape):
        spacing, stated = np.linalg.norm(affine[:3, :3], axis=0), np.abs(header["pixdim"][1:4].astype(float))
        sform, qform = int(header["sform_code"]), int(header["qform_code"])
        if sform and not np.allclose(spacing, stated, rtol=0.02):
            raise Error(f"{self.file}: its header contradicts itself, voxels of {_times(stated)} by pixdim and of {_times(spacing)} by the "
                        "sform; take the map with the header of the image that was segmented.")
        if sform and qform:
            corners = np.array(list(itertools.product((0, 1), repeat=3))) * (np.array(shape) - 1)
            difference = header.get_qform() - affine
            apart = np.linalg.norm(corners @ difference[:3, :3].T + difference[:3, 3], axis=1).max()
            if apart > spacing.max():
                self.doubts.append(f"qform and sform of the header differ by up to {1e3 * METRES[self.unit] * apart:.3g} mm in this image; the sform was "
                                   "taken. If left and right are exchanged, or the organ is elsewhere, take the map with the header of the image that was "
                                   "segmented.")
        if not sform and not qform:
            self.axes_remedy = "the header has neither qform nor sform, which would say so: take the map with that of the image that was segmented"
            self.doubts.append("The header has neither qform nor sform, so the axes of the patient are not known; columns were taken from left to "
                               "right, rows to the front, slices to the head. Take the map with the header of the image that was segmented.")
        if np.array_equal(spacing, [1, 1, 1]) and (not (sform or qform) or not affine[:3, 3].any()):
            self.doubts.append("Voxels of exactly 1 x 1 x 1 with the origin in a corner are what a program writes that does not know "
                               "them: the spacing may be lost, and proportions do not show it. Compare it with the image that was segmented.")

    def _check_angles(self, axes):
        """Distances between voxels are computed for axes at right angles."""
        sides = axes / np.linalg.norm(axes, axis=0)
        slant = np.degrees(np.arcsin(min(1, np.abs(sides.T @ sides - np.eye(3)).max())))
        if slant > _SLANT:
            self.doubts.append(f"The axes of the voxels are {slant:.0f} degrees off a right angle, as those of a CT with a tilted gantry: between slices "
                               "the surface may be wrong. Resample the image to axes at right angles before it is segmented.")

    def check_slices(self):
        """After the size is known to be plausible: spacing that is too coarse."""
        if self.spacing.max() > _ANISOTROPIC * self.spacing.min() or self.spacing.max() > _THICK:
            self.doubts.append(f"Voxels have {_times(1e3 * self.spacing)} mm: between slices the surface is interpolated, and may be "
                               f"wrong by half of {1e3 * self.spacing.max():.1f} mm. Segment a series with thinner slices if there is one.")

    def volume(self, label):
        """[m^3]"""
        return self.counts.get(label, 0) * abs(np.linalg.det(self.axes))

    def choose(self, label):
        """The label: the one that is asked for, or the only one."""
        if label is None and len(self.counts) == 1:
            return next(iter(self.counts))
        if label is not None and label in self.counts:
            return label
        there = ", ".join(f"{k} ({1e3 * self.volume(k):.3g} L)" for k in self.counts) or "none"
        wanted = "which label is the stomach?" if label is None else f"no voxel has the label {label};"
        raise Error(f"{self.file}: {wanted} There are: {there}; name it with --label.")

    def centroid(self, label):
        """[m]"""
        slices = [np.flatnonzero((self.data == label).any(axis=tuple({0, 1, 2} - {a}))) for a in range(3)]
        box = tuple(slice(s[0], s[-1] + 1) for s in slices)
        return self.axes @ (np.argwhere(self.data[box] == label).mean(axis=0) + [b.start for b in box]) + self.origin

    def check_body(self):
        """Against what is known of other organs, in the numbers of TotalSegmentator."""
        if 0.4e-3 < self.volume(LIVER) < 5e-3 and 0.02e-3 < self.volume(SPLEEN) < 2e-3:
            if self.centroid(LIVER)[1] > self.centroid(SPLEEN)[1]:
                raise Error(f"{self.file}: the liver (label {LIVER}) lies to the left of the spleen (label {SPLEEN}), so the image is "
                            f"mirrored, or the patient has a situs inversus; {self.axes_remedy}.")
        found = [k for k in VERTEBRAE if self.counts.get(k, 0) > 20]
        if len(found) < 3 or found[-1] - found[0] != len(found) - 1:
            return
        found = [self.centroid(k) for k in found]
        steps = np.linalg.norm(np.diff(found, axis=0), axis=1)
        in_a_row = np.linalg.norm(found[-1] - found[0]) > 0.8 * steps.sum()
        if in_a_row and not _VERTEBRA_STEP[0] < np.median(steps) < _VERTEBRA_STEP[1]:
            raise Error(f"{self.file}: neighbouring vertebrae are {1e3 * np.median(steps):.0f} mm apart, and those of adults 20 to 40 mm, so "
                        "the spacing of the voxels is not that of the image; take the map with the header of the image that was segmented.")


def _times(spacing):
    return " x ".join(f"{s:.3g}" for s in spacing)


def _load(file):
    nibabel = need("nibabel", "python3-nibabel")
    if not os.path.isfile(file):
        raise Error(f"{file}: there is no such file; give a label map in NIfTI (.nii, .nii.gz).")
    if os.path.getsize(file) == 0:
        raise Error(f"{file}: the file is empty (0 bytes); copy it again, or segment again.")
    try:
        image = nibabel.load(file)
        if not isinstance(image, nibabel.Nifti1Pair):
            raise Error(f"{file}: it is {type(image).__name__}, not NIfTI; convert it to .nii.gz.")
        dimensions = _check_shape(image, file)
        data = np.asanyarray(image.dataobj).reshape(dimensions, order="F")
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise Error(f"{file}: the compressed file is cut off or damaged ({error}); copy it again.") from None
    except (OSError, ValueError, MemoryError, nibabel.filebasedimages.ImageFileError, nibabel.spatialimages.HeaderDataError) as error:
        raise Error(f"{file}: it cannot be read as NIfTI: {' '.join(str(error).split())}; perhaps it is cut off, or no NIfTI file.") from None
    return image, _whole(data, file)


def _check_shape(image, file):
    shape = image.shape
    dimensions = shape[:3]
    if any(n != 1 for n in shape[3:]) or len(dimensions) < 3:
        raise Error(f"{file}: it has {len(shape)} dimensions, {' x '.join(map(str, shape))}; give one volume of three dimensions.")
    if min(dimensions) < 4:
        raise Error(f"{file}: it has only {' x '.join(map(str, dimensions))} voxels, which is no volume; give the map of the whole image.")
    return dimensions


def _whole(data, file):
    """The numbers as integers, if they are."""
    if data.dtype.kind not in "iufb":
        raise Error(f"{file}: its voxels are of type {data.dtype}, not numbers; give a label map.")
    if data.dtype.kind == "b" or data.dtype.kind in "iu":
        return data
    if not np.isfinite(data).all():
        raise Error(f"{file}: it has voxels that are not numbers (NaN or infinite); give a label map of whole numbers.")
    whole = np.rint(data)
    broken = np.abs(data - whole) > 1e-3
    if broken.any():
        kind = "probabilities" if 0 <= data.min() and data.max() <= 1 else "an image or interpolated labels"
        raise Error(f"{file}: {100 * broken.mean():.2g} % of its voxels are no whole numbers, such as {data[broken][0]:.3g}: they are perhaps "
                    f"{kind}; give a label map, such as one where they exceed 0.5, resampled by the nearest voxel.")
    return whole.astype(np.int32 if np.abs(whole).max() < 2**31 else np.int64)


def _count(data, file):
    """Dictionary: label to number of voxels, without the background."""
    least, most = int(data.min()), int(data.max())
    if least < 0 or most > 65535:
        values, counts = np.unique(data, return_counts=True)
    else:  # slice by slice, since bincount makes a copy of eight bytes per voxel
        counts = sum(np.bincount(data[..., k].ravel(order="K").astype(np.int64), minlength=most + 1) for k in range(data.shape[2]))
        values = np.flatnonzero(counts)
        counts = counts[values]
    if least < 0 or len(values) > _MANY_VALUES:
        raise Error(f"{file}: it has {len(values)} different values from {least} to {most}: it is perhaps the image and not its "
                    "segmentation; give the label map.")
    return {int(v): int(c) for v, c in zip(values, counts) if v != 0}
