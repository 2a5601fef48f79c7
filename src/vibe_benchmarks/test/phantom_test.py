#!/usr/bin/env python3
"""The door of the sheet, the faults that a comparison names, and surfaces of the mould; without a simulation."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "phantom"))
import compare  # noqa: E402
import lab  # noqa: E402
import sheet  # noqa: E402
from protocol import MODULUS, coupon_force, modulus  # noqa: E402

try:
    import shapes
except ModuleNotFoundError:
    shapes = None

PREDICTED = {"fill": [5.1, 8.6, 11.3, 13.3], "press": [0.29, 0.5, 0.72], "pull": [1.03, 2.42, 3.95],
             "cinch": [0.54, 1.04, 1.64]}  # about what the twin says
STIFF = {"fill": [6.16, 10.58, 13.96, 16.52], "press": [0.33, 0.55, 0.8], "pull": [1.24, 2.96, 4.88],
         "cinch": [0.61, 1.17, 1.87]}  # with 1.25 times the modulus


class PhantomTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "sheet.csv"

    def write(self, fault=None, seed=1):
        true = STIFF if fault == "stiff" else PREDICTED
        lab.write(self.file, lab.readings(true, MODULUS, 3.0, fault, seed), fault)

    def named(self, fault, seed=1):
        self.write(fault, seed)
        readings = sheet.read(self.file)
        return [sentence.split(":")[0] for sentence in compare.causes(readings, compare.table(readings, PREDICTED))]

    def refusal(self, old, new):
        """What the door says of a sheet with a text replaced once."""
        self.write()
        text = self.file.read_text()
        self.assertIn(old, text)
        self.file.write_text(text.replace(old, new, 1))
        with self.assertRaises(sheet.SheetError) as refused:
            sheet.read(self.file)
        return str(refused.exception)

    def row(self, name, at):
        """The first row of a measurement at a setting."""
        self.write()
        return next(line for line in self.file.read_text().splitlines() if line.startswith(f"{name},{at},"))

    def test_modulus_is_that_of_the_cylinder(self):
        self.assertAlmostEqual(modulus(coupon_force(70e3)), 70e3)
        self.assertAlmostEqual(MODULUS, 97.4e3, delta=100)
        area, stress = np.pi * 0.025 ** 2, 10e3
        self.assertAlmostEqual(modulus(stress * area), 3 * stress / (1 / 0.81 - 0.9), delta=1)

    def test_no_fault_names_no_cause(self):
        for seed in range(50):
            self.assertEqual(self.named(None, seed), [], f"seed {seed}")

    def test_each_fault_is_named_alone(self):
        for fault in ("leak", "unit", "offset", "stiff"):
            for seed in range(10):
                self.assertEqual(self.named(fault, seed), [fault], f"seed {seed}")

    def test_table_repairs_nothing(self):
        self.write("unit")
        readings = sheet.read(self.file)
        row = compare.table(readings, PREDICTED)[0]
        self.assertAlmostEqual(row[2], np.mean(readings["fill"][0.05]))
        self.assertAlmostEqual(row[5], 100 * (row[2] / 5.1 - 1))

    def test_swapped_columns_are_told(self):
        self.write("swap")
        with self.assertRaisesRegex(sheet.SheetError, "columns at and reading are swapped"):
            sheet.read(self.file)

    def test_a_sheet_without_readings_is_refused(self):
        sheet.write(self.file)
        with self.assertRaisesRegex(sheet.SheetError, "which is no number"):
            sheet.read(self.file)

    def test_door_names_row_and_remedy(self):
        fill = self.row("fill", 0.05).split(",")
        cases = [("fill,0.05", "fyll,0.05", "did you mean 'fill'"),
                 (f"L,{fill[3]},mmHg", f"L,{fill[3]},kPa", "write mmHg"),
                 (fill[3], "nan", "what the instrument showed"), (fill[3], "5,1", "7 columns"),
                 (fill[3], "1.6e3", "read in Pa"), (fill[3], "-5", "slip of the pen")]
        for old, new, said in cases:
            refusal = self.refusal(old, new)
            self.assertIn(said, refusal)
            self.assertRegex(refusal, r"sheet\.csv:\d+: ")

    def test_missing_settings_and_measurements(self):
        self.write()
        kept = [line for line in self.file.read_text().splitlines() if not line.startswith(("coupon", "pull,20"))]
        self.file.write_text("\n".join(kept))
        with self.assertRaisesRegex(sheet.SheetError, "no reading of coupon(.|\n)*pull lacks readings at 20 mm"):
            sheet.read(self.file)

    def test_a_measurement_may_be_left_out(self):
        self.write("stiff")
        kept = [line for line in self.file.read_text().splitlines() if not line.startswith(("cinch", "drop"))]
        self.file.write_text("\n".join(kept))
        readings = sheet.read(self.file)
        self.assertEqual(len(compare.table(readings, PREDICTED)), 10)
        self.assertEqual(len(compare.causes(readings, compare.table(readings, PREDICTED))), 1)

    @unittest.skipIf(shapes is None, "python3-vtk9 is not installed")
    def test_surfaces_are_closed_and_holes_are_seen(self):
        axes = [np.arange(-12.0, 12.1), np.arange(-12.0, 12.1), np.arange(0.0, 12.1)]
        field = np.linalg.norm(np.stack(np.meshgrid(*axes, indexing="ij")), axis=0) - 10.2
        points, triangles = shapes.surface(field, axes)  # half a ball, cut off at the border of the grid
        self.assertEqual(shapes.faults(points, triangles), [])
        self.assertAlmostEqual(shapes.volume(points, triangles), 2 / 3 * np.pi * 10.2 ** 3, delta=20)
        self.assertTrue(shapes.faults(points, triangles[1:]))
        self.assertTrue(shapes.faults(points, triangles[:, ::-1]))
        second = np.concatenate([triangles, triangles + len(points)])  # a ball in another: closed, but out of turn
        self.assertTrue(shapes.faults(np.concatenate([points, points + [3.0, 0.1, 0.1]]), second))


if __name__ == "__main__":
    unittest.main()
