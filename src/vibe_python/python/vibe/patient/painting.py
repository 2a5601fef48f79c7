"""Organs in pictures, coloured by region."""

import numpy as np

from .label_map import need

REGIONS = ("cardia", "fundus", "body", "antrum", "pylorus")  # by number
COLOURS = ("#c44e52", "#dd8452", "#eeb69c", "#7aa6c2", "#4c72b0")


def plotting():
    """The module pyplot, for files."""
    need("matplotlib", "python3-matplotlib").use("Agg")
    return need("matplotlib.pyplot", "python3-matplotlib")


def paint(axes, model, azimuth, reach=None):
    """The wall at rest [mm], lit from the eye. azimuth of the eye about z [deg], 0: in front; reach: of the axes, else that of the organ."""
    rgb = np.array([need("matplotlib.colors", "python3-matplotlib").to_rgb(c) for c in COLOURS])
    solid = need("mpl_toolkits.mplot3d.art3d", "python3-matplotlib")
    x = 1e3 * model.rest_positions
    corner = x[model.triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    eye = np.array([np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth)), 0.3])
    light = np.clip(0.35 + 0.65 * normal @ eye / np.linalg.norm(eye) / np.linalg.norm(normal, axis=1), 0.15, 1)[:, None]
    colour = rgb[model.region[model.triangles].max(axis=1)]
    axes.add_collection3d(solid.Poly3DCollection(corner, facecolors=colour * light, edgecolors="none"))
    low, high = (x.min(axis=0), x.max(axis=0)) if reach is None else (np.full(3, -reach), np.full(3, reach))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low)
    axes.view_init(10, azimuth)
