"""What the endoscope saw at given times: recorded pictures, or those that scripts/dataset has drawn of a session."""

import hashlib
import io
import os

import numpy

from ..report.bag_file import BagError
from .source import Message

TOPICS = ("endoscope/image_raw", "endoscope/image_raw/compressed", "endoscope/left/image_raw", "endoscope/left/image_raw/compressed")
KINDS = ("sensor_msgs/Image", "sensor_msgs/CompressedImage")
# bytes of a pixel, and which of them are red, green and blue
ENCODINGS = {"rgb8": (3, [0, 1, 2]), "bgr8": (3, [2, 1, 0]), "rgba8": (4, [0, 1, 2]), "bgra8": (4, [2, 1, 0]), "mono8": (1, [0, 0, 0])}


def load(file):
    from PIL import Image

    return numpy.asarray(Image.open(file).convert("RGB"))


def digest_of(folder):
    """SHA-256 of what Images takes from a folder, so that pictures that were drawn anew are others."""
    found = hashlib.sha256()
    pictures = os.path.join(folder, "image")
    for file in [os.path.join(folder, "times.txt"), *(os.path.join(pictures, name) for name in sorted(os.listdir(pictures)))]:
        with open(file, "rb") as stream:
            found.update(stream.read())
    return found.hexdigest()


class Images:
    """What scripts/dataset wrote of a session."""

    def __init__(self, folder):
        self._folder = folder
        try:
            self._stamps = numpy.loadtxt(os.path.join(folder, "times.txt"), ndmin=2)[:, 1]
            self.shape = list(self._load(0).shape)
        except (OSError, ValueError) as error:
            raise BagError("--images: '{}' is no folder of scripts/dataset ({}); name another".format(folder, error)) from None

    def _load(self, number):
        return load(os.path.join(self._folder, "image", "{:06d}.png".format(number)))

    def of(self, times, fps):
        """Those nearest to these times [ns], at most half a frame away."""
        apart = numpy.abs(self._stamps[None, :] - numpy.array(times)[:, None] / 1e9)
        if apart.min(axis=1).max() > 0.51 / fps:
            raise BagError("--images: '{}' has none within {:.3f} s of a frame; call scripts/dataset --rate {} --output DIR BAG".format(
                self._folder, apart.min(axis=1).max(), fps))  # fmt: skip
        return (self._load(number) for number in apart.argmin(axis=1))


def topic_of(source):
    """The connections of the topic with pictures of the endoscope, one for each start of the camera; empty: there is none."""
    connections = source.bag.connections
    found = [number for topic in TOPICS for number in source.numbers_of(topic)
             if connections[number].datatype in KINDS and source.bag.count(number)]  # fmt: skip
    return [number for number in found if connections[number].topic == connections[found[0]].topic]


class Recorded:
    """The pictures in a recording; they are read once, so times have to grow, except where the simulator was reset."""

    def __init__(self, source):
        self._source, self._wanted = source, topic_of(source)
        self._messages = (Message(source, *found) for found in source.bag.in_time(self._wanted))
        self._last = self._next = next(self._messages)
        self._asked = 0
        self.shape = list(self._decoded(self._last).shape)

    def of(self, times, fps):
        """Those nearest to these times [ns], at most half a frame away."""
        for time in times:
            if time < self._asked:  # a reset: pictures of the new time come after all of the old one
                while self._next is not None and self._next.time >= self._last.time:
                    self._advance()
                self._advance()
            self._asked = time
            while self._next is not None and abs(self._next.time - time) <= abs(self._last.time - time):
                self._advance()
            apart = abs(self._last.time - time) / 1e9
            if apart > 0.51 / fps:
                raise BagError("{}: has no picture within {:.3f} s of a frame; give the --rate with which they were recorded, or draw "
                               "them with scripts/dataset and give --images".format(self._source.path, apart))  # fmt: skip
            yield self._decoded(self._last)

    def _advance(self):
        if self._next is not None:
            self._last, self._next = self._next, next(self._messages, None)

    def _decoded(self, message):
        picture = message.fields
        try:
            if message.connection.datatype == "sensor_msgs/CompressedImage":
                return load(io.BytesIO(picture.data))
            size, colours = ENCODINGS[picture.encoding]
            rows = numpy.frombuffer(picture.data, numpy.uint8).reshape(picture.height, picture.step)
            return rows[:, : picture.width * size].reshape(picture.height, picture.width, size)[..., colours]
        except (KeyError, ValueError, OSError) as error:
            raise BagError("{}: a picture of {} at {:.3f} s cannot be read ({}); those in rgb8, bgr8, mono8, JPEG and PNG can".format(
                self._source.path, message.connection.topic, message.time / 1e9, error)) from None  # fmt: skip
