"""Whether a data set of scripts/dataset is complete. Says in one line what is not as documented, with status 1.

check_dataset.py files FOLDER: every file of docs/ground_truth.md is there, with its shape and type
check_dataset.py sheet FOLDER: README.md names every file and every value of the seed
check_dataset.py look ONE OTHER: another image everywhere, the same truth to the byte
"""

import json
import os
import re
import sys

import numpy
from PIL import Image

TRUTH = ("depth", "normals", "labels", "flow", "flow_visible")


class Wrong(Exception):
    pass


def demand(holds, sentence, *values):
    if not holds:
        raise Wrong(sentence.format(*values))


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file) if name.endswith(".json") else file.read()


def names_in(folder, kind):
    path = os.path.join(folder, kind)
    return sorted(os.listdir(path)) if os.path.isdir(path) else []


def numbered(count, ending):
    return ["{:06d}.{}".format(number, ending) for number in range(count)]


def check_kind(folder, kind, names, load, shape, dtype):
    demand(names_in(folder, kind) == names, "{}/ has {}, not {}", kind, names_in(folder, kind), names)
    for name in names:
        values = load(os.path.join(folder, kind, name))
        demand(values.shape == shape and values.dtype == dtype, "{}/{} is {} {}, not {} {}", kind, name, values.dtype,
               values.shape, numpy.dtype(dtype), shape)  # fmt: skip


def load_image(file):
    return numpy.asarray(Image.open(file))


def check_files(folder):
    data, intrinsics = read(folder, "dataset.json"), read(folder, "intrinsics.json")
    count, size = data["images"], (intrinsics["height"], intrinsics["width"])
    demand(count >= 3, "only {} images", count)
    png, npy = numbered(count, "png"), numbered(count, "npy")
    check_kind(folder, "image", png, load_image, size + (3,), numpy.uint8)
    check_kind(folder, "depth", npy, numpy.load, size, numpy.float32)
    check_kind(folder, "normals", npy, numpy.load, size + (3,), numpy.float16)
    check_kind(folder, "labels", png, load_image, size, numpy.uint8)
    check_kind(folder, "flow", npy[:-1], numpy.load, size + (2,), numpy.float32)
    check_kind(folder, "flow_visible", png[:-1], load_image, size, numpy.uint8)
    if "particles" in data["content"]:
        rest = numpy.load(os.path.join(folder, "topology", "rest_positions.npy"))
        check_kind(folder, "particles", npy, numpy.load, rest.shape, numpy.float32)
    if "sutures" in data["content"]:
        check_kind(folder, "sutures", numbered(count, "json"), load_sutures, (), numpy.dtype("O"))
    check_indexes(folder, data)


def load_sutures(file):
    with open(file, encoding="utf-8") as opened:
        demand(isinstance(json.load(opened), list), "{} is no list", file)
    return numpy.array(None, object)


def check_indexes(folder, data):
    times, poses = (numpy.loadtxt(os.path.join(folder, name), ndmin=2) for name in ("times.txt", "poses.txt"))
    demand(times.shape == (data["images"], 2), "times.txt has {} lines and columns", times.shape)
    demand(poses.shape == (data["images"], 8), "poses.txt has {} lines and columns", poses.shape)
    demand((times[:, 1] == poses[:, 0]).all(), "times.txt and poses.txt have different stamps")
    demand((numpy.diff(times[:, 1]) > 0).all(), "the stamps do not increase")
    norms = numpy.linalg.norm(poses[:, 4:], axis=1)
    demand(numpy.allclose(norms, 1, atol=1e-6), "poses.txt has a quaternion of length {}", norms)
    seen = set(numpy.unique([load_image(os.path.join(folder, "labels", name)) for name in names_in(folder, "labels")]))
    known = {row["number"] for row in read(folder, "labels.json")}
    demand(seen <= known, "labels.json does not name {}", sorted(seen - known))


def check_sheet(folder):
    text, data = read(folder, "README.md"), read(folder, "dataset.json")
    for name in set(os.listdir(folder)) - {"README.md"}:
        demand(name in text, "README.md does not name {}", name)
    demand(not re.search(r"\{\w*\}|None\b(?! \(`--seed 0`\))|\bnan\b", text), "README.md has a hole")
    for key in ("recording", "version", "arithmetic", "scene_hash", "urdf_hash", "model_hash"):
        demand(str(data[key]) and str(data[key]) in text, "README.md does not tell {}", key)
    groups = {"lens": "mount", "sensor": "sensor", "mucosa": "mucosa", "light": "light"}
    demand(bool(data["seed"]) == bool(data["varied"]), "seed {} varies {}", data["seed"], data["varied"])
    for group in data["varied"]:
        for name, value in data[groups[group]].items():
            words = "{} {:.4g}".format(name.replace("_", " "), value)
            demand(words in text, "README.md does not tell {}", words)


def check_look(one, other):
    names = names_in(one, "image")
    demand(names and names == names_in(other, "image"), "the images are {} and {}", names, names_in(other, "image"))
    for name in names:
        images = [load_image(os.path.join(folder, "image", name)).astype(float) for folder in (one, other)]
        change = numpy.abs(images[0] - images[1]).mean()
        demand(change > 1, "image/{} differs by {:.2f} levels only", name, change)
    for kind in TRUTH:
        for name in names_in(one, kind):
            contents = []
            for folder in (one, other):
                with open(os.path.join(folder, kind, name), "rb") as file:
                    contents.append(file.read())
            demand(contents[0] == contents[1], "{}/{} differs", kind, name)


def main():
    checks = {"files": check_files, "sheet": check_sheet, "look": check_look}
    try:
        checks[sys.argv[1]](*sys.argv[2:])
    except Wrong as wrong:
        sys.exit("check_dataset: {}".format(wrong))


if __name__ == "__main__":
    main()
