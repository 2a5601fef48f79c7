#!/usr/bin/env python3
"""Error of tracked slides against the truth of synthetic images: compare_tracks.py FOLDER, draws FOLDER/error.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

folder = sys.argv[1]
with open(folder + "/truth.csv", newline="") as file:
    truth = {(row["sequence"], row["instrument"]): float(row["slide"]) for row in csv.DictReader(file)}
errors = {}
with open(folder + "/result.csv", newline="") as file:
    for row in csv.DictReader(file):
        if row["tracked"] == "1":
            error = float(row["slide"]) - truth[row["sequence"], row["instrument"]]
            errors.setdefault(row["instrument"], []).append((int(row["sequence"]), 1e6 * error))
plt.figure(figsize=(4.8, 3.2), layout="constrained")
for name, values in errors.items():
    rms = (sum(e * e for _, e in values) / len(values)) ** 0.5
    print("{}: {} frames, error of the slide {:.2f} um RMS".format(name, len(values), rms))
    plt.plot(*zip(*values), label=name)
plt.xlabel("frame")
plt.ylabel("error of the slide [µm]")
plt.legend()
plt.savefig(folder + "/error.png", dpi=110)
