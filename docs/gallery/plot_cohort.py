#!/usr/bin/env python3
"""Draws two measures of a cohort against each other: plot_cohort.py COHORT.csv MEASURE MEASURE PICTURE.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

table, first, second, picture = sys.argv[1:]
with open(table, newline="") as file:
    rows = list(csv.DictReader(file))
plt.figure(figsize=(4.8, 3.2), layout="constrained")
for novice in sorted({row["novice"] for row in rows}, key=float):
    of = [row for row in rows if row["novice"] == novice]
    plt.plot([float(row[first]) for row in of], [float(row[second]) for row in of], "o", label="novice: " + novice)
plt.xlabel(first)
plt.ylabel(second)
plt.legend()
plt.savefig(picture, dpi=110)
