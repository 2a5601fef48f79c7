"""report.md of an import: what was found, how, what is doubtful, and pictures of the organ from two sides."""

import os

import numpy as np

from .landmarks import NAMES
from .mesh import area, centre, enclosed_volume
from .painting import COLOURS, REGIONS, paint, plotting

_SIDES = (("from the front", 0), ("from the patient's left", 90))  # azimuth of the eye about z, 0: in front
_PAGE = """# Organ of {file}, label {label}

Frame: that of the image, x to the front, y to the patient's left, z to the head [m]. No validated model of a patient: look at all of it.

![Organ from the front and from the left, coloured by region, with landmarks](organ.png)

## Doubts

{doubts}

## What was found

| | |
|---|---|
| voxels | {spacing} mm |
| volume of the label's voxels; of the surface | {voxels:.1f} mL; {surface:.1f} mL |
| area | {area:.0f} cm^2 |
| rest shape | {rest} |
| particles | {particles}, {distance:.1f} mm apart |

| landmark | place [mm] | found by |
|---|---|---|
{landmarks}

| region | area | thickness of the wall | source |
|---|---|---|---|
{regions}
"""


def write(found, model, folder):
    organ = found["organ"]
    _draw(found, model, os.path.join(folder, "organ.png"))
    published = "published, see `tissue.thickness` in docs/scenes.md"
    given = [_scene_thickness(model, name) for name in REGIONS]
    share = [model.area[model.region == k].sum() for k in range(len(REGIONS))]
    text = _PAGE.format(
        file=os.path.basename(organ.labels.file), label=found["label"], doubts="\n".join(f"* {d}" for d in organ.doubts) or "None was found.",
        spacing=" x ".join(f"{1e3 * s:.3g}" for s in organ.labels.spacing), voxels=1e6 * organ.voxel_volume,
        surface=1e6 * enclosed_volume(organ.vertices, organ.triangles), area=1e4 * area(organ.vertices, organ.triangles), rest=_rest(found),
        particles=model.particles, distance=1e3 * np.sqrt(2 / np.sqrt(3) * model.area.sum() / model.particles),
        landmarks="\n".join(f"| {n} | {', '.join(f'{1e3 * v:.1f}' for v in found['landmarks'][n])} | {found['sources'][n]} |" for n in NAMES),
        regions="\n".join(f"| {n} | {1e4 * a:.0f} cm^2 | {1e3 * t:.2f} mm | {'the image' if n in found['thickness'] else published} |"
                          for n, a, t in zip(REGIONS, share, given)))  # fmt: skip
    with open(os.path.join(folder, "report.md"), "w", encoding="utf-8") as out:
        out.write(text)


def _scene_thickness(model, name):
    section = model.scene.split("thickness:", 1)[1]
    return float(section.split(name + ":", 1)[1].split()[0])


def _rest(found):
    if found["residual"] is None:
        return "the imaged shape: no pressure was stated"
    organ, (mean, most) = found["organ"], found["residual"]
    return (f"{1e6 * enclosed_volume(found['rest'], organ.triangles):.1f} mL; at {found['pressure']:g} mmHg the surface is {1e3 * mean:.2f} mm (root mean "
            f"square) and at most {1e3 * most:.2f} mm from the imaged one, and the simulated organ holds {1e6 * found['volume']:.1f} mL")


def _draw(found, model, file):
    pyplot = plotting()
    figure = pyplot.figure(figsize=(10, 5.5))
    triangles = found["organ"].triangles
    marks = 1e3 * (np.array([found["landmarks"][n] for n in NAMES]) + centre(model.rest_positions, model.triangles) - centre(found["rest"], triangles))
    for k, (title, azimuth) in enumerate(_SIDES):
        axes = figure.add_subplot(1, 2, k + 1, projection="3d", title=title, proj_type="ortho", computed_zorder=False)
        paint(axes, model, azimuth)
        axes.set(xlabel="front [mm]", ylabel="left [mm]", zlabel="head [mm]")
        axes.scatter(*marks.T, color="black", s=14, zorder=9, depthshade=False)
        for name, mark in zip(NAMES, marks):
            axes.text(*mark, " " + name, zorder=10, fontsize=8)
        along_view = (axes.xaxis, axes.yaxis)[azimuth // 90]
        along_view.set_ticks([])
        along_view.set_label_text("")
    handles = [pyplot.Line2D([], [], marker="s", linestyle="", color=c, label=n) for n, c in zip(REGIONS, COLOURS)]
    figure.legend(handles=handles, loc="lower center", ncol=5, frameon=False)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
