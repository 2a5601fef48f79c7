"""vibe_import: a scene from the label map of a segmented image."""

import argparse
import os
import sys

import numpy as np

import vibe

from . import landmarks, report
from .label_map import LabelMap, need
from .label_surface import Organ
from .mesh import model_of, write_ply
from .painting import REGIONS
from .rest_shape import unload


_MMHG = 133.322  # [Pa]
_DOUBTFUL = 0.5e-3  # residual [m]
_PRESSED = 0.5  # [N]
_SCENE = """# Written by vibe_import from {file}, label {label}. What is doubtful: report.md.
base: package://vibe_core/scenes/stomach.yaml
name: patient
geometry:
  kind: mesh
  file: surface.ply # at rest, in the image's world: x to the front, y to the left, z to the head
  unit: 1 m
  particles: {particles}
  landmarks:
{landmarks}
{tissue}"""


def parse(words):
    parser = argparse.ArgumentParser("vibe_import", description="Makes a scene of a patient from a label map in NIfTI, as TotalSegmentator writes it "
                                     "(docs/patients.md). Status 2: refused, with the reason in one sentence.", allow_abbrev=False)
    parser.add_argument("file", help="label map, .nii or .nii.gz")
    parser.add_argument("--label", type=int, metavar="N", help="that of the stomach, 6 in TotalSegmentator (default: the only one)")
    parser.add_argument("--output", default="patient", metavar="DIR", help="folder for scene.yaml, surface.ply and report.md (default: patient)")
    parser.add_argument("--particles", type=int, default=3618, metavar="N", help="of the simulated wall (default: 3618)")
    parser.add_argument("--pressure", type=float, default=0.0, metavar="MMHG", help="in the stomach above that around it when the image was taken; the "
                        "scene is then at rest without it (default: 0, the imaged shape is the one at rest)")
    parser.add_argument("--neighbours", default=None, metavar="O,D", help="labels of oesophagus and duodenum (default: {},{} with --label {}, as in "
                        "TotalSegmentator 2)".format(*landmarks.NEIGHBOURS, landmarks.STOMACH))
    arguments = parser.parse_args(words)
    if not 0 <= arguments.pressure <= 30:
        parser.error("--pressure: needs 0 to 30 mmHg")
    if not 100 <= arguments.particles <= 200000:
        parser.error("--particles: needs 100 to 200000")
    try:
        given = arguments.neighbours
        arguments.neighbours = tuple(map(int, given.split(","))) if given else landmarks.NEIGHBOURS if arguments.label == landmarks.STOMACH else ()
    except ValueError:
        parser.error("--neighbours: needs two labels, such as 15,19")
    return arguments


def bring_in(file, label, neighbours, particles, pressure):
    """What was found, as a dictionary: organ, rest (n, 3), landmarks, and how."""
    labels = LabelMap(file)
    label = labels.choose(label)
    organ = Organ(labels, label)
    if label == landmarks.STOMACH:
        labels.check_body()
    places, sources = landmarks.find(organ, neighbours)
    landmarks.check_shared_faces(organ, neighbours)
    geometry = {"particles": particles, "landmarks": {k: places[k].tolist() for k in landmarks.NAMES}}
    thickness = _thickness(organ, geometry)
    found = {"organ": organ, "label": label, "rest": organ.vertices, "landmarks": places, "sources": sources, "thickness": thickness,
             "pressure": pressure, "residual": None}
    if pressure > 0:
        tissue = {"thickness": thickness} if thickness else {}
        found["rest"], found["residual"], found["volume"] = unload(organ.vertices, organ.triangles, geometry["landmarks"], tissue, _MMHG * pressure)
        if found["residual"][0] > _DOUBTFUL:
            organ.doubts.append(f"At {pressure:g} mmHg the surface stays {1e3 * found['residual'][0]:.1f} mm (root mean square) from the imaged one: a wall as "
                                "stiff as the scene's does not take this shape under this pressure. State a lower --pressure, or change the wall.")
        for name, place in places.items():  # with the wall
            nearest = np.linalg.norm(organ.vertices - place, axis=1).argmin()
            places[name] = place + found["rest"][nearest] - organ.vertices[nearest]
    return found


def _thickness(organ, geometry):
    """By region [m], where the label is a wall; else none, and the scene's published values stay."""
    if organ.wall is None:
        return {}
    model, surface = model_of(organ.vertices, organ.triangles, geometry)
    region = model.region[need("scipy.spatial", "python3-scipy").cKDTree(model.rest_positions).query(surface)[1]]
    index = np.linalg.solve(organ.labels.axes, (organ.vertices - organ.labels.origin).T).T - organ.first
    wall = organ.wall(index)
    if wall.mean() < 2 * organ.labels.spacing.max():
        organ.doubts.append(f"The wall is {1e3 * wall.mean():.1f} mm thick in the image, fewer than two voxels, so published thicknesses were taken.")
        return {}
    return {name: float(np.clip(wall[region == k].mean(), 1e-4, 0.02)) for k, name in enumerate(REGIONS) if (region == k).any()}


def write_scene(found, folder, particles):
    organ = found["organ"]
    write_ply(os.path.join(folder, "surface.ply"), found["rest"], organ.triangles)
    places = "\n".join(f"    {name}: [{', '.join(f'{v:.5f}' for v in found['landmarks'][name])}]" for name in landmarks.NAMES)
    walls = "".join(f"    {name}: {1e3 * value:.2f} mm\n" for name, value in found["thickness"].items())
    path = os.path.join(folder, "scene.yaml")
    with open(path, "w", encoding="utf-8") as out:
        out.write(_SCENE.format(file=os.path.basename(organ.labels.file), label=found["label"], particles=particles, landmarks=places,
                                tissue="tissue:\n  thickness: # from the image\n" + walls if walls else ""))
    return path


def _check_start(model, organ):
    """One second of the scene."""
    simulation = vibe.Simulation(model)
    simulation.run(round(1 / model.step_period))
    force = np.linalg.norm(simulation.wrench[:3])
    if force > _PRESSED:
        organ.doubts.append(f"At the start the scope presses on the wall with {force:.1f} N: it has no free way in from the landmark of the oesophagus. Look at "
                            "the picture, and correct the landmark in scene.yaml.")


def main(words=None):
    arguments = parse(words)
    try:
        found = bring_in(arguments.file, arguments.label, arguments.neighbours, arguments.particles, arguments.pressure)
        os.makedirs(arguments.output, exist_ok=True)
        scene = write_scene(found, arguments.output, arguments.particles)
        model = vibe.load(scene)
        _check_start(model, found["organ"])
        report.write(found, model, arguments.output)
    except (vibe.Error, OSError) as error:
        print(f"vibe_import: {error}", file=sys.stderr)
        return 2
    for doubt in found["organ"].doubts:
        print(f"doubt: {doubt}", file=sys.stderr)
    print(f"{scene}: {model.particles} particles; look at {os.path.join(arguments.output, 'report.md')}, then scripts/run --scene {scene}")
    return 0
