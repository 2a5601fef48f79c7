"""Describes a data set that vibe_dataset has written: README.md, and preview.png, a strip of one image with its truth.

The questions are those of Gebru et al. 2021, Datasheets for Datasets (doi:10.1145/3458723).
"""

import json
import os

import numpy
from PIL import Image
from vibe_sessions.whole_file import open_whole, whole

NAN_COLOUR = (0, 0, 0)


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def load(folder, kind, number):
    for ending in (".npy", ".png"):
        file = os.path.join(folder, kind, "{:06d}{}".format(number, ending))
        if os.path.exists(file):
            return numpy.load(file) if ending == ".npy" else numpy.asarray(Image.open(file))
    return None


# --- pictures

# five steps of viridis (van der Walt, Smith; CC0), light at the near end
VIRIDIS = numpy.array([(253, 231, 37), (94, 201, 98), (33, 145, 140), (59, 82, 139), (68, 1, 84)], float)


def depth_picture(depth):
    known = numpy.isfinite(depth)
    picture = numpy.zeros(depth.shape + (3,), numpy.uint8)
    if known.any():
        near, far = numpy.percentile(depth[known], (1, 99))
        place = numpy.clip((numpy.nan_to_num(depth) - near) / max(far - near, 1e-9), 0, 1) * (len(VIRIDIS) - 1)
        for c in range(3):
            picture[..., c] = numpy.interp(place, range(len(VIRIDIS)), VIRIDIS[:, c])
    picture[~known] = NAN_COLOUR
    return picture


def normal_picture(normals):
    picture = (127.5 + 127.5 * numpy.nan_to_num(normals.astype(float)) * (1, -1, -1)).astype(numpy.uint8)
    picture[~numpy.isfinite(normals).all(axis=2)] = NAN_COLOUR
    return picture


def label_picture(labels, table):
    colours = numpy.zeros((256, 3), numpy.uint8)
    for row in table:
        colours[row["number"]] = row["colour"]
    return colours[labels]


def flow_picture(flow):
    """Direction as hue, length as saturation; white stands still, black is not known."""
    known = numpy.isfinite(flow).all(axis=2)
    x, y = numpy.nan_to_num(flow[..., 0]), numpy.nan_to_num(flow[..., 1])
    length = numpy.hypot(x, y)
    full = max(numpy.percentile(length[known], 98) if known.any() else 0, 0.5)
    hue = (numpy.arctan2(y, x) / (2 * numpy.pi) * 255).astype(int) % 256
    hsv = numpy.dstack([hue, numpy.clip(length / full, 0, 1) * 255, numpy.full(hue.shape, 255)]).astype(numpy.uint8)
    picture = numpy.asarray(Image.fromarray(hsv, "HSV").convert("RGB")).copy()
    picture[~known] = NAN_COLOUR
    return picture


def strip(folder, number, table):
    """One image and its truth, side by side."""
    parts = [load(folder, "image", number)]
    for kind, draw in (
        ("depth", depth_picture),
        ("normals", normal_picture),
        ("labels", lambda labels: label_picture(labels, table)),
        ("flow", flow_picture),
    ):
        values = load(folder, kind, number)
        if values is not None:
            parts.append(draw(values))
    # the circle alone
    height, width = parts[0].shape[:2]
    left = max(0, (width - height) // 2)
    return Image.fromarray(numpy.hstack([part[:, left : width - left] for part in parts]))


def liveliest(folder, count):
    """The image with the most different labels among some: something is to be seen there."""
    best, number = -1, 0
    for candidate in range(0, max(1, count - 1), max(1, count // 40)):
        labels = load(folder, "labels", candidate)
        kinds = 0 if labels is None else (numpy.bincount(labels.flatten(), minlength=256) > 20).sum()
        if kinds > best:
            best, number = kinds, candidate
    return number


# --- words

LAYOUT = {
    "image": "`image/NNNNNN.png`: colour, 8 bit RGB, sRGB, black outside of the circle",
    "depth": "`depth/NNNNNN.npy`: float32, height x width: distance along the optical axis in metres; NaN: nothing",
    "normals": "`normals/NNNNNN.npy`: float16, height x width x 3: unit normals towards the camera, in its frame",
    "labels": "`labels/NNNNNN.png`: 8 bit; the table is `labels.json`",
    "flow": "`flow/NNNNNN.npy`: float32, height x width x 2: to the same material point in image N + 1, x right, y down"
    " [px]; NaN: nothing, not material (blood), or outside of image N + 1. `flow_visible/NNNNNN.png`: 255 the point is"
    " visible in image N + 1, 128 hidden there, 0 no flow. The last image has none",
    "particles": "`particles/NNNNNN.npy`: float32, particles x 3: positions of the particles of the wall [m];"
    " `topology/`: triangles, positions at rest, and the weights of the drawn surface"
    " (docs/interfaces.md, tissue/topology)",
    "sutures": "`sutures/NNNNNN.json`: threads, bites and tensions of all sutures [m, N]",
}


def percent(part, whole):
    return "{:.2f} %".format(100 * part / whole) if whole else "-"


def label_rows(data, table):
    pixels = {int(number): count for number, count in data["label_pixels"].items()}
    whole = sum(count for number, count in pixels.items() if number > 0)
    objects = {}
    for row in table:
        if row["number"] > 0:
            objects[row["object"]] = objects.get(row["object"], 0) + pixels.get(row["number"], 0)
    marked = sum(pixels.get(row["number"], 0) for row in table if row.get("heat", "none") != "none")
    rows = ["| {} | {} |".format(name, percent(count, whole)) for name, count in objects.items() if count]
    return rows + ["| of the wall: marked or burnt | {} |".format(percent(marked, whole))]


# what a seed varies: key of dataset.json, and words for it
VARIED = {
    "lens": ("mount", "Lens in its mount [rad]"),
    "sensor": ("sensor", "Sensor"),
    "mucosa": ("mucosa", "Mucosa [lengths in m]"),
    "light": ("light", "Light [m, K]"),
}


def variation(data, degrees):
    if data["seed"] == 0:
        return "None (`--seed 0`): ideal lens and sensor, and the usual mucosa and light."
    sentences = ["Seed {}, of: {}.".format(data["seed"], ", ".join(data["varied"]))]
    for what in data["varied"]:
        key, words = VARIED[what]
        numbers = ", ".join("{} {:.4g}".format(name.replace("_", " "), value) for name, value in data[key].items())
        sentences.append("{}: {}.".format(words, numbers))
    if "lens" in data["varied"]:
        sentences.append("Field of view: {:.2f} degrees.".format(degrees))
    if "sensor" in data["varied"]:
        sentences.append(
            "The images are distorted as `distortion_of_image` in `intrinsics.json` says; **the truth is that of the"
            " undistorted lens**, so undistort an image before it is laid over it."
        )
    return " ".join(sentences + ["The ranges are in docs/ground_truth.md of the simulator."])


def sheet(data, intrinsics, table, replayed):
    lenses = "`left/` and `right/`, each with the folders below" if data["stereo"] else "one lens"
    return """# {name}: {images} images of a simulated sleeve gastroplasty with their truth

![Image and truth](preview.png)

## Motivation

For training and testing methods that estimate depth, surface normals, motion, segmentation or camera pose in endoscopic
video of a soft organ that is pushed, pulled and sutured. The truth of each pixel is known, which no real endoscope
tells.

## Composition

{images} images from {first:.3f} s to {last:.3f} s of simulated time, {lenses}. Content: {content}.

{layout}
* `times.txt`, `poses.txt`: stamps, and camera poses (format of TUM: stamp, tx ty tz, qx qy qz qw) in the frame
  `{frame}` of the particles, in metres; of the left lens in a pair. Camera frame: z forward, x right, y down.
* `intrinsics.json`: model `{model}`, focal length {fx:.3f} px, centre ({cx}, {cy}), field of view {degrees:.2f} degrees;
  the centre of the first pixel is (0, 0).
* `dataset.json`: everything below by machine, with the whole scene file.

| object | part of the pixels that show something |
|---|---|
{labels}

No patient and no person is shown. All images come from one session on one organ: split training and test sets by
recording, not by image.

## How it was made

| | |
|---|---|
| recording | `{name}`; replay: {replayed} |
| simulator | ViBE for ROS {version}, arithmetic {arithmetic} |
| hashes | scene {scene_hash}, URDF {urdf_hash}, model {model_hash} |
| images | {rate:g} per second of simulated time (0: every state), one in {every} |

The colour image is drawn (OGRE, OpenGL). The truth is cast: one ray through the centre of each pixel meets the
triangles that are drawn. The flow follows the material point of the ray to the next image.

Variation: {variation}

## Limits

* The relief of the mucosa that is finer than the drawn triangles is shading: depth, normals and flow do not contain it.
* Blood is opaque for the truth where at least half of its colour is seen, and transparent elsewhere.
* The thread's flow follows its drawn shape, not the sliding of the thread along itself.
* Nearer than 0.6 mm nothing is drawn or cast. No motion blur, rolling shutter, smoke or fluid on the lens in the truth.
* The physics is a simulation with the limits that the documentation of the simulator states (docs/accuracy.md).

## Use and licence

The data set is the output of the program; the licence of the simulator (BSD-3-Clause) does not bind it. Results on
these images say nothing about patients.
""".format(
        name=data["recording"], images=data["images"], first=data["first"], last=data["last"], lenses=lenses,
        content=", ".join(data["content"]), layout="\n".join("* {}.".format(LAYOUT[kind]) for kind in data["content"]),
        frame=data["frame"], model=intrinsics["model"], fx=intrinsics["fx"], cx=intrinsics["cx"], cy=intrinsics["cy"],
        degrees=intrinsics["field_of_view"], labels="\n".join(label_rows(data, table)), replayed=replayed,
        version=data["version"], arithmetic=data["arithmetic"], scene_hash=data["scene_hash"],
        urdf_hash=data["urdf_hash"], model_hash=data["model_hash"], rate=data["rate"], every=data["every"],
        variation=variation(data, intrinsics["field_of_view"]),
    )  # fmt: skip


def describe(folder, replayed):
    """Describes the data set in a folder; `replayed` says how well the recording repeated."""
    data, intrinsics, table = (read(folder, name) for name in ("dataset.json", "intrinsics.json", "labels.json"))
    with open_whole(os.path.join(folder, "README.md")) as file:
        file.write(sheet(data, intrinsics, table, replayed))
    first_lens = os.path.join(folder, "left") if data["stereo"] else folder
    with whole(os.path.join(folder, "preview.png")) as part:
        strip(first_lens, liveliest(first_lens, data["images"]), table).save(part)
