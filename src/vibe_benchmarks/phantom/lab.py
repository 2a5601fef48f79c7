"""A simulated laboratory: readings of the twin with scatter, and with one fault."""
import numpy as np

import sheet
from protocol import COMPARED, FORCES, QUANTITIES, REPEATS, coupon_force, deviation
from vibe_sessions.whole_file import open_whole

FAULTS = {"leak": "the pressure falls by 1.2 mmHg in a minute", "unit": "the pressures were read in cmH2O",
          "swap": "settings and readings of press are swapped", "offset": "the force gauge shows 0.25 N too much",
          "stiff": "the wall is 25 % stiffer than its cylinder"}
STIFFER = 1.25  # modulus of the wall over that of the cylinder
BATCH = 0.02  # standard deviation of what all readings of a phantom have in common, as a share


def readings(predicted, modulus, wall, fault=None, seed=1):
    """{(measurement, at, repeat): reading} of a phantom whose twin predicts {measurement: [reading, ...]}; modulus [Pa],
    wall [mm]. Each reading scatters by deviation(), and all by a factor that is drawn once. For `stiff` the twin must be that
    of STIFFER times the modulus."""
    random = np.random.default_rng(seed)
    true = {"coupon": [coupon_force(modulus)], "wall": [wall] * 5, "drop": [5.0] * 4, **predicted}
    factor = random.normal(1, BATCH)
    for name in COMPARED:
        true[name] = [value * factor for value in true[name]]
    if fault == "leak":
        true["drop"] = [5.0 - 1.2 * second / 60 for second in QUANTITIES["drop"].at]
    if fault == "unit":
        true["fill"] = [value * 1.35951 for value in true["fill"]]
    if fault == "offset":
        true.update({name: [value + 0.25 for value in true[name]] for name in FORCES})
    return {(name, at, repeat): round(random.normal(value, deviation(name, value)), 3)
            for name, quantity in QUANTITIES.items() for at, value in zip(quantity.at, true[name])
            for repeat in range(1, REPEATS + 1)}


def write(file, found, fault=None):
    """The sheet of readings, with two columns swapped for the rows of press if that is the fault."""
    sheet.write(file, found)
    if fault == "swap":
        rows = [line.split(",") for line in file.read_text().splitlines()]
        for row in rows:
            if row[0] == "press":
                row[1], row[3] = row[3], row[1]
        with open_whole(file) as stream:
            stream.write("\n".join(",".join(row) for row in rows) + "\n")
