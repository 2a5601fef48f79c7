#!/usr/bin/env python3
"""Compliance of the stomach against the stiffness of its wall: sweep.py PICTURE.png"""
import sys
from concurrent.futures import ProcessPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import vibe

MODULI = (80, 110, 140, 170)  # [kPa]


def volume(modulus, pressure):
    """Of the stomach at rest [mL] with a modulus [kPa] and a set point [mmHg]."""
    model = vibe.load(geometry={"particles": 1000}, tissue={"young_modulus": "{} kPa".format(modulus)},
                      gas={"regulated_pressure": "{} mmHg".format(pressure)})  # fmt: skip
    simulation = vibe.Simulation(model, metrics=False, impedance=False)
    simulation.run(1200, insufflate=True)  # 20 s
    return 1e6 * simulation.volume


if __name__ == "__main__":
    with ProcessPoolExecutor() as pool:  # as many at once as there are cores
        low, high = (list(pool.map(volume, MODULI, [pressure] * len(MODULI))) for pressure in (8, 12))
    compliance = [(b - a) / 4 for a, b in zip(low, high)]
    for modulus, value in zip(MODULI, compliance):
        print("{} kPa: {:.1f} mL/mmHg".format(modulus, value))
    plt.figure(figsize=(4.8, 3.2), layout="constrained")
    plt.plot(MODULI, compliance, "o-")
    plt.axhspan(36.1 - 14.7, 36.1 + 14.7, alpha=0.2, label="84 specimens (Toro 2015)")
    plt.xlabel("Young's modulus [kPa]")
    plt.ylabel("compliance, 8 to 12 mmHg [mL/mmHg]")
    plt.legend()
    plt.savefig(sys.argv[1], dpi=110)
