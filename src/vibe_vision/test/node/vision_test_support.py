"""What the tests of the vision node share: rendered scenes with their truth."""

import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile

from PIL import Image
from vibe_testing.program import find_program

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGE = os.path.join(HERE, "..", "..")
JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]
INSTRUMENTS = ["helix", "needle_driver"]
RATE = 147.0  # of rendered scenes [Hz]
START = 1_700_000_000.0  # stamp of their first frame [s]

sys.path.insert(0, os.path.join(PACKAGE, "examples"))
import udp_receiver  # noqa: E402,F401  for the tests


class Scene:
    """A rendered scene: video or images, configuration and truth."""

    def __init__(self, name, frames, format="images"):
        self.folder = tempfile.mkdtemp(prefix="vibe_vision_")
        command = [find_program("vibe_vision", "vibe_render"), "--scene", name, "--frames", str(frames)]
        command += ["--start", repr(START), "--out", self.folder, "--format", format]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        self.config = os.path.join(self.folder, "config.yaml")
        table = "video.mkv.csv" if format == "video" else "frames.csv"
        self.source = "video:" + self.path("video.mkv") if format == "video" else self._plain_images()
        with open(self.path(table)) as file:
            self.stamps = {int(row["sequence"]): float(row["stamp"]) for row in csv.DictReader(file)}
        self.truth = {name: {} for name in INSTRUMENTS}
        with open(self.path("truth.csv")) as file:
            for row in csv.DictReader(file):
                values = float(row["slide"]), float(row["rotation"])
                self.truth[row["instrument"]][int(row["sequence"])] = values

    def _plain_images(self):
        """Source of the rendered images without compression, which are read in real time on a slow machine, too."""
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".png"):
                Image.open(self.path(name)).save(self.path(name[:-4] + ".pgm"))
                os.remove(self.path(name))
        return "images:" + self.path("frame_*.pgm")

    def path(self, name):
        return os.path.join(self.folder, name)

    def stamp_of(self, sequence):
        """Of a frame of a recording that is repeated."""
        repetition, frame = divmod(sequence, len(self.stamps))
        return self.stamps[frame] + repetition * len(self.stamps) / RATE

    def truth_of(self, instrument, sequence):
        return self.truth[instrument][sequence % len(self.stamps)]

    def changed_config(self, name, old, new):
        """A copy of the configuration with another text in one place."""
        with open(self.config) as file:
            text = file.read()
        assert old in text, old
        with open(self.path(name), "w") as file:
            file.write(text.replace(old, new, 1))
        return self.path(name)

    def grey_images(self, value, count=400):
        """Source of images of one grey value, with the size of the scene's."""
        os.makedirs(self.path("grey"), exist_ok=True)
        pixels = b"P5\n728 544\n255\n" + bytes([value]) * (728 * 544)
        with open(self.path("grey/0.pgm"), "wb") as file:
            file.write(pixels)
        for k in range(1, count):
            link = self.path("grey/{}.pgm".format(k))
            if not os.path.exists(link):
                os.link(self.path("grey/0.pgm"), link)
        return "images:" + self.path("grey/*.pgm")

    def remove(self):
        shutil.rmtree(self.folder, ignore_errors=True)


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def errors_of(scene, tracks, instrument):
    """Errors of slide [m] and rotation [rad] of an instrument in messages of suturing_device/tracking."""
    index = INSTRUMENTS.index(instrument)
    slides, rotations = [], []
    for message in tracks:
        track = message.instruments[index]
        if track.tracked:
            slide, rotation = scene.truth_of(instrument, message.frame_sequence)
            slides.append(track.slide - slide)
            rotations.append(math.remainder(track.rotation - rotation, 2 * math.pi) if index == 0 else 0)
    return slides, rotations
