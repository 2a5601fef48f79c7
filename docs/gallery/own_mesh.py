#!/usr/bin/env python3
"""Insufflates the stomach of a surface file and colours it by its stretch: own_mesh.py SURFACE PICTURE.png

A surface that does not exist is written first: the default stomach, flattened, as an OBJ file
in millimetres with the axes of medical images: x to the left, y to the back, z to the head."""
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import vibe

if not os.path.exists(sys.argv[1]):
    stomach = vibe.Simulation(vibe.load(geometry={"particles": 1000}))
    with open(sys.argv[1], "w") as file:
        for x, y, z in 1e3 * stomach.positions * (0.8, 1, 1):
            file.write("v {:.3f} {:.3f} {:.3f}\n".format(y, -x, z))  # ours: x to the front, y to the left
        for a, b, c in stomach.model.triangles + 1:
            file.write("f {} {} {}\n".format(a, b, c))

# What the file does not say (unit, axes, landmarks) is read from a file beside it, or guessed.
model = vibe.load(mesh=sys.argv[1], geometry={"particles": 1000})
simulation = vibe.Simulation(model)
empty = simulation.volume
simulation.run(600, insufflate=True)  # ten seconds
print("{:.0f} mL, {:.0f} mL at {:.1f} mmHg".format(1e6 * empty, 1e6 * simulation.volume, simulation.pressure / 133.322))

x, y, z = 1e3 * simulation.positions.T  # [mm]
axes = plt.figure(figsize=(6, 4)).add_subplot(projection="3d")
surface = axes.plot_trisurf(y, x, z, triangles=model.triangles, cmap="viridis")
stretch = simulation.strain[model.triangles].mean(axis=1)
surface.set_array(100 * stretch)
plt.colorbar(surface, label="strain [%]", shrink=0.7, location="left")
axes.set(xlabel="left [mm]", ylabel="front [mm]", zlabel="head [mm]", aspect="equal")
plt.savefig(sys.argv[2], dpi=90)
