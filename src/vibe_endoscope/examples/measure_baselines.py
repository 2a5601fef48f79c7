#!/usr/bin/env python3
"""Measures methods of OpenCV on a data set of scripts/dataset against its truth:

* matches of ORB features between consecutive images, against the optical flow;
* depth from brightness: the light of an endoscope falls off with the square of the distance, so the distance is about
  1 / sqrt(light); up to a scale, which is fitted to the median;
* with a pair of rectilinear lenses, semi-global block matching.

Each beside a control that knows nothing. Usage: measure_baselines.py FOLDER
"""

import json
import os
import sys

import cv2
import numpy

MAX_IMAGES = 60  # more take long and change little


class Folder:
    def __init__(self, path):
        self.path = path
        with open(os.path.join(path, "dataset.json"), encoding="utf-8") as file:
            self.data = json.load(file)
        with open(os.path.join(path, "intrinsics.json"), encoding="utf-8") as file:
            self.intrinsics = json.load(file)
        self.numbers = range(min(self.data["images"], MAX_IMAGES))

    def file(self, kind, number, lens):
        ending = ".png" if kind in ("image", "labels", "flow_visible") else ".npy"
        side = lens if self.data["stereo"] else ""
        return os.path.join(self.path, side, kind, "{:06d}{}".format(number, ending))

    def read(self, kind, number, lens="left"):
        file = self.file(kind, number, lens)
        if kind == "image":
            return cv2.imread(file, cv2.IMREAD_COLOR)
        return cv2.imread(file, cv2.IMREAD_GRAYSCALE) if file.endswith(".png") else numpy.load(file)

    def wall(self, number):
        """Where the inside of the wall is seen."""
        labels = self.read("labels", number)
        return (labels >= 1) & (labels <= 84)


def grey(image):
    return cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)


def feature_errors(folder):
    """Distance of each match from where the truth says, and without a motion [px]."""
    orb, matcher = cv2.ORB_create(1500), cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True)
    errors, still = [], []
    for number in folder.numbers[:-1]:
        flow, visible, wall = (folder.read(kind, number) for kind in ("flow", "flow_visible", "labels"))
        mask = ((wall > 0) * 255).astype(numpy.uint8)
        first, one = orb.detectAndCompute(grey(folder.read("image", number)), mask)
        second, two = orb.detectAndCompute(grey(folder.read("image", number + 1)), None)
        if one is None or two is None:
            continue
        for match in matcher.match(one, two):
            place, there = numpy.array(first[match.queryIdx].pt), numpy.array(second[match.trainIdx].pt)
            column, row = numpy.round(place).astype(int)
            if visible[row, column] != 255:
                continue
            errors.append(numpy.linalg.norm(there - place - flow[row, column]))
            still.append(numpy.linalg.norm(flow[row, column]))
    return numpy.array(errors), numpy.array(still)


def light_of(image):
    value = image.astype(float) / 255
    linear = numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    return linear.mean(axis=2)


def brightness_errors(folder):
    """Relative error of the depth of each pixel, of brightness and of a plane at the median."""
    errors, flat = [], []
    for number in folder.numbers:
        depth, wall = folder.read("depth", number), folder.wall(number)
        if wall.sum() < 100:
            continue
        light = cv2.GaussianBlur(light_of(folder.read("image", number)), (0, 0), 4)
        guess = 1 / numpy.sqrt(numpy.maximum(light, 1e-3))
        truth, guess = depth[wall], guess[wall]
        guess *= numpy.median(truth) / numpy.median(guess)
        errors.append(numpy.abs(guess - truth) / truth)
        flat.append(numpy.abs(numpy.median(truth) - truth) / truth)
    return numpy.concatenate(errors), numpy.concatenate(flat)


def stereo_errors(folder):
    """Relative error of the depth of each pixel that gets one, and the part of the pixels that do."""
    matcher = cv2.StereoSGBM_create(0, 128, 7, P1=8 * 49, P2=32 * 49, uniquenessRatio=10, speckleWindowSize=80,
                                    speckleRange=2)  # fmt: skip
    errors, known, whole = [], 0, 0
    for number in folder.numbers:
        left, right = (grey(folder.read("image", number, lens)) for lens in ("left", "right"))
        disparity = matcher.compute(left, right).astype(float) / 16
        depth = folder.read("depth", number)
        found = (disparity > 1) & folder.wall(number)
        guess = folder.intrinsics["fx"] * folder.intrinsics["baseline"] / disparity[found]
        errors.append(numpy.abs(guess - depth[found]) / depth[found])
        known, whole = known + found.sum(), whole + folder.wall(number).sum()
    return numpy.concatenate(errors), known / max(whole, 1)


def main():
    if len(sys.argv) != 2 or not os.path.exists(os.path.join(sys.argv[1], "dataset.json")):
        sys.exit("measure_baselines.py: give the folder of a data set, as scripts/dataset writes it")
    folder = Folder(sys.argv[1])
    missing = {"depth", "labels", "flow"} - set(folder.data["content"])
    if missing:
        sys.exit("measure_baselines.py: the data set lacks {}; write it with the default --content".format(
            ", ".join(sorted(missing))))  # fmt: skip
    errors, still = feature_errors(folder)
    if len(errors):
        print("ORB matches {}: error median {:.2f} px, below 3 px {:.1f} %; no motion: median {:.2f} px".format(
            len(errors), numpy.median(errors), 100 * (errors < 3).mean(), numpy.median(still)))  # fmt: skip
    errors, flat = brightness_errors(folder)
    print("depth from brightness: relative error mean {:.1f} %, median {:.1f} %; constant depth: {:.1f} %, {:.1f} %".format(
        100 * errors.mean(), 100 * numpy.median(errors), 100 * flat.mean(), 100 * numpy.median(flat)))  # fmt: skip
    if folder.data["stereo"] and folder.data["lens"] == "rectilinear":
        errors, part = stereo_errors(folder)
        print("block matching: relative error median {:.1f} % for {:.1f} % of the wall".format(
            100 * numpy.median(errors), 100 * part))  # fmt: skip


if __name__ == "__main__":
    main()
