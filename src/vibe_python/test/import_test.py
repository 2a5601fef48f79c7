#!/usr/bin/env python3
"""vibe_import: label maps of procedural organs with every kind of header and defect, each taken, doubted or refused for its true
reason; volume, regions and the shape at rest against what they were made from."""
import contextlib
import functools
import importlib.util
import io
import os
import re
import tempfile
import unittest

import numpy as np

import vibe

if not all(importlib.util.find_spec(name) for name in ("nibabel", "skimage", "scipy", "matplotlib")):
    raise unittest.SkipTest("python3-nibabel, python3-skimage, python3-scipy or python3-matplotlib is not installed")

import label_maps
import nibabel
from label_maps import DUODENUM, LIVER, OESOPHAGUS, SPLEEN, STOMACH
from scipy import ndimage
from scipy.spatial import cKDTree
from vibe.patient import importing, mesh
from vibe.patient.label_map import LabelMap

SPACING = 3.0
whole = functools.lru_cache(maxsize=None)(label_maps.label_map)


def organ(**options):
    data, frame = whole(SPACING, **options)
    return data.copy(), frame.copy()


def alone(data):
    return np.where(data == STOMACH, STOMACH, 0).astype(np.uint8)


class ImportTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "map.nii.gz")

    def attempt(self, path=None, *options, label=STOMACH):
        """(status, what was said)"""
        said = io.StringIO()
        words = [path or self.path, "--output", os.path.join(self.folder.name, "patient"), "--particles", "500", *options]
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            status = importing.main(words + (["--label", str(label)] if label else []))
        return status, said.getvalue()

    def taken(self, *doubts, path=None, options=(), label=STOMACH):
        """Is taken with these doubts and no others."""
        status, said = self.attempt(path, *options, label=label)
        self.assertEqual(status, 0, said)
        lines = [line for line in said.splitlines() if line.startswith("doubt: ")]
        self.assertEqual(len(lines), len(doubts), said)
        for line, doubt in zip(sorted(lines), sorted(doubts)):
            self.assertIn(doubt, line)
        with open(os.path.join(self.folder.name, "patient", "report.md"), encoding="utf-8") as page:
            text = page.read()
        voxels, surface = map(float, re.search(r"of the surface \| ([\d.]+) mL; ([\d.]+) mL", text).groups())
        self.assertLess(abs(surface / voxels - 1), 0.002)
        for line in lines:
            self.assertIn(line[len("doubt: "):], text)
        return vibe.load(os.path.join(self.folder.name, "patient", "scene.yaml"))

    def refused(self, *reasons, path=None, options=(), label=STOMACH):
        status, said = self.attempt(path, *options, label=label)
        self.assertEqual(status, 2, said)
        self.assertEqual(len(said.splitlines()), 1, said)
        for reason in reasons:
            self.assertIn(reason, said)
        self.assertNotIn("Traceback", said)

    # --- taken

    def same_regions(self, model, shape="sthenic"):
        """Share of the wall with the region that the procedural organ has there."""
        truth = label_maps.model(shape)
        shift = mesh.centre(truth.rest_positions, truth.triangles) - mesh.centre(model.rest_positions, model.triangles)
        _, nearest = cKDTree(truth.rest_positions).query(model.rest_positions + shift)
        return model.area[model.region == truth.region[nearest]].sum() / model.area.sum()

    def test_ends_by_the_labels_of_the_neighbours(self):
        for shape, turn in (("sthenic", (0, 0, 0)), ("j", (0.25, -0.2, 0.5)), ("steer_horn", (-0.1, 0.3, 2.0))):
            with self.subTest(shape):
                label_maps.save(self.path, *organ(shape=shape, turn=turn))
                self.assertGreater(self.same_regions(self.taken(), shape), 0.8)

    def test_ends_by_shape_where_there_are_no_neighbours(self):
        data, frame = organ(neighbours=False)
        label_maps.save(self.path, np.where(data == STOMACH, 1, 0).astype(np.uint8), frame)
        self.assertGreater(self.same_regions(self.taken(label=None)), 0.8)

    def test_flat_voxels(self):
        label_maps.save(self.path, *label_maps.label_map((1.0, 1.0, 5.0), turn=(0.1, 0.2, 0)))
        self.assertGreater(self.same_regions(self.taken("half of 5.0 mm")), 0.8)

    def test_types_byte_orders_units_and_handedness_do_not_matter(self):
        data, frame = organ()
        expected = None
        flipped = frame @ np.diag([-1, 1, 1, 1])
        flipped[:3, 3] = frame[:3, 3] + frame[:3, 0] * (data.shape[0] - 1)
        metres = frame.copy()
        metres[:3] *= 1e-3
        swapped = nibabel.Nifti1Image(data.astype(">i2"), frame, nibabel.Nifti1Header(endianness=">"))
        for name, image in {
            "int16, big-endian": swapped, "float32": nibabel.Nifti1Image(data.astype("f4"), frame), "NIfTI-2": nibabel.Nifti2Image(data, frame),
            "left-handed": nibabel.Nifti1Image(data[::-1], flipped), "in metres": nibabel.Nifti1Image(data, metres),
            "four dimensions, one volume": nibabel.Nifti1Image(data[..., None], frame),
        }.items():  # fmt: skip
            with self.subTest(name):
                image.header.set_xyzt_units("meter" if name == "in metres" else "mm")
                path = os.path.join(self.folder.name, name + (".nii" if "big" in name else ".nii.gz"))
                nibabel.save(image, path)
                found = importing.bring_in(path, STOMACH, (OESOPHAGUS, DUODENUM), 500, 0)
                self.assertEqual(found["organ"].doubts, [])
                x, t = found["rest"], found["organ"].triangles
                now = np.array([mesh.enclosed_volume(x, t), mesh.area(x, t), *mesh.centre(x, t), *np.ravel(list(found["landmarks"].values()))])
                expected = now if expected is None else expected
                np.testing.assert_allclose(now[:2], expected[:2], rtol=1e-3)
                np.testing.assert_allclose(now[2:5], expected[2:5], atol=1e-4)  # [m]
                np.testing.assert_allclose(now[5:], expected[5:], atol=1e-3 * SPACING)

    def test_volume_and_area_are_those_of_another_program(self):
        if not importlib.util.find_spec("SimpleITK"):
            self.skipTest("SimpleITK is not installed (PyPI, 2.4.1)")
        import SimpleITK

        for spacing in (1.0, 2.0, (0.8, 0.8, 3.0), 5.0):
            with self.subTest(spacing=spacing):
                label_maps.save(self.path, *label_maps.label_map(spacing, turn=(0.1, -0.2, 0.3)))
                statistics = SimpleITK.LabelShapeStatisticsImageFilter()
                statistics.ComputePerimeterOn()
                statistics.Execute(SimpleITK.ReadImage(self.path, SimpleITK.sitkUInt8))
                found = importing.bring_in(self.path, STOMACH, (OESOPHAGUS, DUODENUM), 500, 0)
                x, t = found["rest"], found["organ"].triangles
                self.assertLess(abs(1e9 * mesh.enclosed_volume(x, t) / statistics.GetPhysicalSize(STOMACH) - 1), 0.002)
                if np.ndim(spacing) == 0:  # its estimate is far off where voxels are flat
                    self.assertLess(abs(1e6 * mesh.area(x, t) / statistics.GetPerimeter(STOMACH) - 1), 0.06)
                place = np.array(statistics.GetCentroid(STOMACH)) * 1e-3  # LPS
                np.testing.assert_allclose(mesh.centre(x, t), [-place[1], place[0], place[2]], atol=2e-4)

    # --- doubted

    def test_lost_spacing_and_axes(self):
        data, frame = organ()
        label_maps.save(self.path, data, np.diag([1.0, 1, 1, 1]))
        status, said = self.attempt()
        self.assertIn("the spacing may be lost", said, status)
        label_maps.save(self.path, data, frame, sform=0, qform=0)
        self.refused("to the left of the spleen", "neither qform nor sform")  # without them, columns run to the left
        label_maps.save(self.path, data[::-1], frame, sform=0, qform=0)
        self.taken("neither qform nor sform")
        ones = frame @ np.diag([1 / SPACING] * 3 + [1])  # but with an origin, as after resampling
        label_maps.save(self.path, np.kron(data, np.ones((3, 3, 3), np.uint8)), ones)
        self.taken()

    def test_specks_holes_and_walls(self):
        data, frame = organ()
        specks = data.copy()
        specks[2:4, 2:4, 2:4] = STOMACH
        label_maps.save(self.path, specks, frame)
        self.taken("has 2 parts")
        core = ndimage.binary_erosion(data == STOMACH, iterations=3)
        holes = data.copy()
        holes[core & (np.indices(data.shape).sum(axis=0) % 9 == 0)] = 0
        holes[~ndimage.binary_erosion(data == STOMACH, iterations=6) & core] = STOMACH
        label_maps.save(self.path, holes, frame)
        self.taken("has holes inside")
        wall = data.copy()
        wall[core] = 0
        label_maps.save(self.path, wall, frame)
        model = self.taken("wall around a cavity")
        self.assertIn("thickness", model.scene)

    def test_border_and_shared_faces(self):
        data, frame = organ(neighbours=False)
        cut = data.copy()
        low = np.flatnonzero((data == STOMACH).any(axis=(1, 2)))
        cut = cut[: low[-1] - 1] if frame[0, 0] > 0 else cut
        label_maps.save(self.path, cut, frame)
        self.taken("reaches the border of the image towards the right")
        data, frame = organ()
        near = ndimage.distance_transform_edt(data != STOMACH) < 4
        lower = np.indices(data.shape)[2] < data.shape[2] * 0.55
        data[near & lower & (data == 0)] = 20
        label_maps.save(self.path, data, frame)
        self.taken("Label 20 shares")

    def test_a_neighbour_that_is_none(self):
        data, frame = organ()
        near = ndimage.distance_transform_edt(data != STOMACH) < 3
        data[near & (data == 0)] = 99
        label_maps.save(self.path, data, frame)
        self.taken("Label 99 touches the organ over", options=["--neighbours", f"{OESOPHAGUS},99"])

    # --- refused

    def test_files(self):
        data, frame = organ()
        label_maps.save(self.path, data, frame)
        with open(self.path, "rb") as source:
            content = source.read()
        plain = os.path.join(self.folder.name, "map.nii")
        nibabel.save(nibabel.load(self.path), plain)
        with open(plain, "rb") as source:
            bare = source.read()
        for name, written, reason in (("a.nii.gz", b"", "is empty"), ("b.nii.gz", content[: len(content) // 2], "cut off"), ("c.nii", bare[:-1000], "cut off"),
                                      ("d.nii.gz", b"<html>no such page</html>", "no NIfTI"), ("e.nii", os.urandom(4000), "no NIfTI"),
                                      ("f.nii.gz", content[:200] + bytes(300) + content[500:], "")):  # fmt: skip
            with self.subTest(name):
                path = os.path.join(self.folder.name, name)
                with open(path, "wb") as out:
                    out.write(written)
                self.refused(path, reason, path=path)
        self.refused("there is no such file", path=os.path.join(self.folder.name, "none.nii.gz"))

    def test_what_is_no_label_map(self):
        data, frame = organ()
        random = np.random.default_rng(1)
        for name, array, reason in (("4-D", np.stack([data] * 2, -1), "4 dimensions"), ("probabilities", ndimage.gaussian_filter((data == STOMACH).astype("f4"), 1),
                                     "perhaps probabilities"), ("NaN", np.where(data, data, np.nan), "not numbers"),
                                    ("the image", random.integers(-1024, 2000, data.shape).astype("i2"), "perhaps the image"), ("a slice", data[:, :, :1], "no volume"),
                                    ("complex", data.astype("c8"), "not numbers")):  # fmt: skip
            with self.subTest(name):
                nibabel.save(nibabel.Nifti1Image(array, frame), self.path)
                self.refused(reason)

    def test_labels(self):
        label_maps.save(self.path, *organ())
        self.refused("no voxel has the label 7", "6 (0.8", "15 (", label=7)
        self.refused("which label is the stomach?", label=None)
        label_maps.save(self.path, np.zeros((9, 9, 9), np.uint8), label_maps.affine(2.0))
        self.refused("There are: none")

    def test_sizes(self):
        data, frame = organ()
        label_maps.save(self.path, data, frame, unit="meter")
        self.refused("perhaps its unit is 'mm' and not 'meter'")
        label_maps.save(self.path, data, frame, unit="micron")
        self.refused("perhaps its unit is 'mm' and not 'micron'")
        small = frame.copy()
        small[:3, :3] *= 0.3
        label_maps.save(self.path, data, small)
        self.refused("stomachs hold 0.1 to 3 L", "spacing is lost")
        label_maps.save(self.path, data[::12, ::12, ::12], frame @ np.diag([12, 12, 12, 1]))
        self.refused("voxels wide")

    def test_forms_that_differ_and_axes_that_are_slanted(self):
        data, frame = organ()

        def with_qform(moved=(0, 0, 0), turn=0.0):
            image, other = nibabel.Nifti1Image(data, frame), frame.copy()
            other[:3, :3] = label_maps.affine(1, (0, 0, turn))[:3, :3] @ frame[:3, :3]
            other[:3, 3] += moved
            image.header.set_xyzt_units("mm")
            image.set_sform(frame, 1)
            image.set_qform(other, 1)
            nibabel.save(image, self.path)

        far = SPACING * np.array([data.shape])
        for moved, turn, differ in (((0, 0, 0), 0, False), ((0.4 * SPACING, 0, 0), 0, False), ((0, -1.5 * SPACING, 0), 0, True),
                                    ((100, 50, -80), 0, True), ((0, 0, 0), 0.3 * SPACING / np.linalg.norm(far), False),
                                    ((0, 0, 0), 3 * SPACING / np.linalg.norm(far[0, :2]), True)):
            with_qform(moved, turn)
            self.assertEqual([d[:40] for d in LabelMap(self.path).doubts], ["qform and sform of the header differ by "] * differ, (moved, turn))
        with_qform((100, 50, -80))
        self.taken("differ by up to 137 mm")
        for slant in (0, 1, 20, -40):
            slanted = frame @ np.array([[1, 0, 0, 0], [0, 1, np.tan(np.radians(slant)), 0], [0, 0, 1, 0], [0, 0, 0, 1]])
            image = nibabel.Nifti1Image(data, None)
            image.header.set_xyzt_units("mm")
            image.set_sform(slanted, 1)
            image.header["pixdim"][1:4] = np.linalg.norm(slanted[:3, :3], axis=0)
            nibabel.save(image, self.path)
            self.assertEqual([d[:50] for d in LabelMap(self.path).doubts],
                             [f"The axes of the voxels are {abs(slant)} degrees off a right "] * (abs(slant) > 2), slant)

    def test_a_header_that_contradicts_itself(self):
        data, frame = organ()
        image = nibabel.Nifti1Image(data, frame)
        image.header["pixdim"][3] = 1.0
        nibabel.save(image, self.path)
        raw = nibabel.load(self.path)
        raw.header["pixdim"][1:4] = 1
        header = raw.header.copy()
        header.set_sform(frame, 1)
        header["qform_code"] = 0
        plain = os.path.join(self.folder.name, "map.nii")
        with open(plain, "wb") as out:
            header.set_data_dtype(np.uint8)
            header["vox_offset"] = 352
            out.write(header.binaryblock + bytes(4) + data.tobytes(order="F"))
        self.refused("contradicts itself", path=plain)
        flat = frame.copy()
        flat[:3, 2] = 0
        header.set_sform(flat, 1)
        with open(plain, "wb") as out:
            out.write(header.binaryblock + bytes(4) + data.tobytes(order="F"))
        self.refused("no inverse", path=plain)

    def test_mirrored(self):
        data, frame = organ()
        label_maps.save(self.path, data[::-1], frame)
        self.refused("the liver (label 5) lies to the left of the spleen (label 1)")
        label_maps.save(self.path, alone(data)[::-1], frame)
        self.refused("the landmarks cannot be found", "not like a stomach")

    def test_neighbouring_organs_show_a_lost_spacing(self):
        data, frame = organ()
        x, y = 3, data.shape[1] - 6
        for k, label in enumerate(range(29, 34)):
            data[x : x + 4, y : y + 4, 10 + 4 * k : 13 + 4 * k] = label
        label_maps.save(self.path, data, frame)  # 12 mm apart
        self.refused("neighbouring vertebrae are 12 mm apart")

    def test_shapes_that_are_no_organ(self):
        data, frame = organ()
        inside = data == STOMACH
        half = data.shape[2] // 2
        cut = data[:, :, :half]
        label_maps.save(self.path, cut, frame)
        self.refused("towards the head", "cut off")
        two = data.copy()
        two[:, :, half - 1 : half + 1] = 0
        label_maps.save(self.path, two, frame)
        self.refused("has 2 parts", "not one organ")
        bowl = data.copy()
        bowl[ndimage.binary_erosion(inside, iterations=2)] = 0
        bowl[:, :, data.shape[2] * 2 // 3 :][bowl[:, :, data.shape[2] * 2 // 3 :] == STOMACH] = 0
        label_maps.save(self.path, bowl, frame)
        self.refused("nowhere wider")
        i, j, k = np.indices((70, 70, 40))
        ring = (np.hypot(i - 35, j - 35) - 20) ** 2 + (k - 20) ** 2 < 100
        label_maps.save(self.path, np.where(ring, STOMACH, 0).astype(np.uint8), label_maps.affine(2.0))
        self.refused("1 handle")

    # --- the shape at rest

    def test_the_shape_at_rest_is_found_again(self):
        truth = label_maps.model()
        gas = {"initial_pressure": "8 mmHg", "regulated_pressure": "8 mmHg", "flow_limit": 0.01, "insufflator_on": True}
        model = vibe.load(geometry={"particles": 3000}, gas=gas, render_surface=False, **mesh.WALL_ALONE)
        simulation = vibe.Simulation(model)
        simulation.run(180)
        label_maps.save(self.path, *label_maps.voxelise(simulation.positions, truth.triangles, 2.0))
        found = self.taken(options=["--pressure", "8"])
        begin = vibe.Simulation(found).volume
        self.assertAlmostEqual(begin / vibe.Simulation(truth).volume, 1, delta=0.03)
        self.assertGreater(simulation.volume / begin, 1.2)


if __name__ == "__main__":
    unittest.main()
