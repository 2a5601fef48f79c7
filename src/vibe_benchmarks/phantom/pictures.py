"""Pictures of the mould and of a comparison (matplotlib)."""
import os
import pathlib

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from protocol import COMPARED, QUANTITIES  # noqa: E402


def draw_comparison(rows, file):
    """Readings with their scatter, and what the twin predicts, a plot per measurement."""
    names = [name for name in COMPARED if any(row[0] == name for row in rows)]
    figure, axes = plt.subplots(1, max(len(names), 1), figsize=(3.2 * max(len(names), 1), 3), squeeze=False)
    for name, plot in zip(names, axes[0]):
        at, mean, spread, expected = np.array([row[1:5] for row in rows if row[0] == name], dtype=float).T
        plot.plot(at, expected, "-", color="0.4", label="twin")
        plot.errorbar(at, mean, spread, fmt="o", capsize=3, label="measured")
        plot.set(title=name, xlabel=f"[{QUANTITIES[name].at_unit}]", ylabel=f"[{QUANTITIES[name].unit}]", ylim=(0, None))
    if names:
        axes[0, 0].legend()
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    plt.close(figure)


def draw_mould(folder: pathlib.Path, file):
    """The halves and the core, from the STL files of a folder, by VTK without a window."""
    import vtk
    if "DISPLAY" not in os.environ:
        raise OSError("phantom mould: there is no display to draw the picture on; begin the command with xvfb-run -a.")
    renderer, window, left = vtk.vtkRenderer(), vtk.vtkRenderWindow(), 0.0
    for name, colour in (("half_a", (0.75, 0.8, 0.85)), ("core", (0.85, 0.6, 0.45)), ("half_b", (0.75, 0.8, 0.85))):
        reader, mapper, actor = vtk.vtkSTLReader(), vtk.vtkPolyDataMapper(), vtk.vtkActor()
        reader.SetFileName(str(folder / f"{name}.stl"))
        reader.Update()
        mapper.SetInputConnection(reader.GetOutputPort())
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(colour)
        actor.GetProperty().SetAmbient(0.3)
        actor.RotateZ(90)
        low, high = actor.GetBounds()[:2]
        actor.AddPosition(left - low, 0, 0)
        left += high - low + 15
        renderer.AddActor(actor)
    lamp = vtk.vtkLight()
    lamp.SetPosition(-1, 2, 1.2)  # from above, as a reader expects it, so that a hollow looks hollow
    renderer.AddLight(lamp)
    renderer.SetBackground(1, 1, 1)
    window.SetOffScreenRendering(1)
    window.SetSize(1200, 420)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0, -0.5, 1)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera()
    camera.Zoom(2.1)
    window.Render()
    picture, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    picture.SetInput(window)
    writer.SetFileName(str(file))
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()
