#!/usr/bin/env python3
"""Compares FOLDER/result.csv of vibe_track with FOLDER/truth.csv: one line per instrument with the frames found, the
error along the axis, wrong reports, and the mean squared normalised error."""
import argparse
import csv
import math
import os

from blender_scene import ROWS, SCALE


def score(folder):
    def rows(name):
        with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
            return {(r["sequence"], r["instrument"]): r for r in csv.DictReader(file)}

    truth, seen = rows("truth.csv"), rows("result.csv")
    for name in ROWS:
        keys = [k for k in truth if k[1] == name and float(truth[k]["visible"]) >= 0.5]
        found = [k for k in keys if k in seen and seen[k]["tracked"] == "1"]
        slides = [(float(seen[k]["slide"]) - float(truth[k]["slide"]), float(seen[k]["slide_deviation"])) for k in found]
        right = [(e, d) for e, d in slides if abs(e) < 5e-4]
        silent = sum(1 for k, (e, _) in zip(found, slides) if abs(e) >= 5e-4 and not seen[k]["doubt"])
        line = "%-14s found %d/%d wrong %d, without doubt %d" % (name, len(right), len(keys), len(slides) - len(right), silent)
        if right:
            mean = sum(e for e, _ in right) / len(right)
            rms = math.sqrt(sum(e * e for e, _ in right) / len(right))
            spread = math.sqrt(max(0.0, rms * rms - mean * mean))
            line += "  rms %.4f px (mean %+.4f, spread %.4f)  nees %.2f" % (
                rms * SCALE * 1e3, mean * SCALE * 1e3, spread * SCALE * 1e3, sum((e / d)**2 for e, d in right) / len(right))
        if right and name == "helix":
            turns = [float(seen[k]["rotation"]) - float(truth[k]["rotation"]) for k in found]
            turns = [math.degrees(math.remainder(t, 2 * math.pi)) for t in turns]
            line += "  rotation %.2f deg (mean %+.2f)" % (math.sqrt(sum(t * t for t in turns) / len(turns)),
                                                         sum(turns) / len(turns))
        print(line)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    score(parser.parse_args().folder)
