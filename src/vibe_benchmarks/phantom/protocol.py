"""The measurements of docs/phantom.md: what is set, what is read, in which units, and how far readings scatter."""
import collections

# at: what is set, in at_unit; unit, low, high: of readings, and between which they are plausible; share, floor: standard
# deviation of a reading, as a share of it and in its unit (design choice: a hand-held gauge, a water column)
Quantity = collections.namedtuple("Quantity", "at_unit at unit low high share floor what")

SCALE = 0.8  # of the default stomach's lengths, so that the mould fits a printer bed of 200 mm
WALL = 3e-3  # thickness [m]
SILENT_DROP = 0.3  # fall of pressure in a minute that is still tight [mmHg]: a water column shows a tenth of it
REPEATS = 3

QUANTITIES = {
    "coupon": Quantity("mm", [3], "N", 2, 80, 0.02, 0.1, "force on the cylinder of 50 x 30 mm, ends oiled"),
    "wall": Quantity("place", [1, 2, 3, 4, 5], "mm", 1.5, 6, 0.04, 0.05, "thickness of the wall"),
    "fill": Quantity("L", [0.05, 0.1, 0.15, 0.2], "mmHg", 0.3, 40, 0.02, 0.1, "pressure after adding air from 1 mmHg"),
    "press": Quantity("mm", [5, 10, 15], "N", 0.02, 10, 0.03, 0.02, "force of the pad pressed in, from 5 mmHg"),
    "pull": Quantity("mm", [10, 20, 30], "N", 0.02, 15, 0.03, 0.02, "force of the pad pulled out, from 5 mmHg"),
    "cinch": Quantity("mm", [10, 20, 30], "N", 0.02, 15, 0.03, 0.02, "tension of the thread drawn in, from 5 mmHg"),
    "drop": Quantity("s", [0, 20, 40, 60], "mmHg", 0, 40, 0.0, 0.03, "pressure after closing the valve at 5 mmHg"),
}
FORCES = ["press", "pull", "cinch"]  # read with one gauge
COMPARED = ["fill"] + FORCES


def deviation(quantity, reading):
    """Standard deviation that is expected of one reading, in its unit."""
    of = QUANTITIES[quantity]
    return (of.floor ** 2 + (of.share * reading) ** 2) ** 0.5


def modulus(force):
    """Young's modulus [Pa] of the cylinder, 50 mm wide and 30 mm high, that bears a force [N] when it is 3 mm shorter and
    free to widen: nominal stress E/3 (1/l^2 - l) of an incompressible neo-Hookean solid at the stretch l."""
    stretch, area = 1 - 3 / 30, 3.14159265 * 0.025 ** 2
    return 3 * force / area / (stretch ** -2 - stretch)


def coupon_force(young):
    """The reverse of modulus()."""
    return young / modulus(1.0)


MODULUS = modulus(10.86e3 * 3.14159265 * 0.025 ** 2)  # [Pa], 97 kPa: stress of Ecoflex 00-30 in the data base of the page
