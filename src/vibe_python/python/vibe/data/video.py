"""A video as bytes: H.264, yuv420p, every second picture a key frame, so that readers find any picture fast."""

import io

import numpy as np

import vibe

from .files import needed


def encode(frames, fps):
    """MP4 of Frames; the same ones give the same bytes with the same libraries."""
    av = needed("av", "pip install av, or Debian's python3-av")
    out = io.BytesIO()
    with av.open(out, "w", format="mp4", container_options={"fflags": "+bitexact"}) as container:
        stream = container.add_stream("libx264", rate=fps)
        stream.height, stream.width, stream.pix_fmt = *frames.shape[:2], "yuv420p"
        stream.options = {"crf": "23", "g": "2", "bf": "0", "threads": "1", "flags": "+bitexact"}
        for frame in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame, format="rgb24")))
        container.mux(stream.encode())
    return out.getvalue()


class Frames:
    """Hands frames on, sees that they are what they should be, and keeps samples of them for statistics: up to 100, or a
    few more of a long video, at a coarser resolution, as LeRobot takes them."""

    def __init__(self, name, frames, count, shape):
        self.name, self.frames, self.count, self.shape, self.samples = name, frames, count, tuple(shape), []

    def __iter__(self):
        wanted = set(np.round(np.linspace(0, self.count - 1, max(min(self.count, 100), int(self.count**0.75)))).astype(int))
        stride = max(1, max(self.shape[:2]) // 150) if max(self.shape[:2]) >= 300 else 1
        number = 0
        for number, frame in enumerate(self.frames, 1):
            frame = np.asarray(frame)
            if number > self.count or frame.dtype != np.uint8 or frame.shape != self.shape:
                break
            if number - 1 in wanted:
                self.samples.append(frame[::stride, ::stride])
            yield np.ascontiguousarray(frame)
        else:
            if number == self.count:
                return
            raise vibe.Error(f"The video {self.name!r} has {number} frames for {self.count} rows; give as many.")
        raise vibe.Error(f"The video {self.name!r} has as frame {number} {frame.dtype} of the shape {frame.shape}; give {self.count} of uint8 of the "
                         f"shape {self.shape}.")
