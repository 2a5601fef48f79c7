#!/usr/bin/env python3
"""A trainee looks around until it has seen three quarters of the wall: which parts it missed, and when it saw the others."""
import sys

import matplotlib.pyplot as plt
import numpy
import vibe

PROTOCOL = """
name: a short look
goals:
  - insufflate
  - inspect: {coverage: 75 %}
"""

model = vibe.load(geometry={"particles": 1000}, inspection={})
simulation = vibe.Simulation(model)
simulation.follow(vibe.Trainee(model, PROTOCOL))
measures = simulation.measures()
for part in ("cardia", "fundus", "body", "antrum", "pylorus"):
    print("{:8} {:5.1f} % seen".format(part, 100 * measures["coverage." + part]))

x, y, z = 1e3 * simulation.positions.T  # [mm]
when = simulation.first_seen[model.triangles].max(axis=1)  # [s], NaN: not all of the triangle
axes = plt.figure(figsize=(6, 4)).add_subplot(projection="3d")
colours = plt.get_cmap("viridis").with_extremes(bad="orangered")
surface = axes.plot_trisurf(y, x, z, triangles=model.triangles, cmap=colours)
surface.set_array(numpy.ma.masked_invalid(when))
plt.colorbar(surface, label="seen at [s]; red: not yet", shrink=0.7, location="left")
axes.set(xlabel="left [mm]", ylabel="front [mm]", zlabel="head [mm]", aspect="equal")
plt.savefig(sys.argv[1], dpi=90)
