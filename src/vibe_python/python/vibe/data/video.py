"""A video as bytes: H.264, yuv420p, every second picture a key frame, so that readers find any picture fast."""

import io
import itertools

import numpy as np

import vibe

from .files import needed


def encode(frames, fps, shape):
    """MP4 of frames; the same ones give the same bytes with the same libraries."""
    av = needed("av", "pip install av, or Debian's python3-av")
    out = io.BytesIO()
    with av.open(out, "w", format="mp4", container_options={"fflags": "+bitexact"}) as container:
        stream = container.add_stream("libx264", rate=fps)
        stream.height, stream.width, stream.pix_fmt = *shape[:2], "yuv420p"
        stream.options = {"crf": "23", "g": "2", "bf": "0", "threads": "1", "flags": "+bitexact"}
        for frame in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame, format="rgb24")))
        container.mux(stream.encode())
    return out.getvalue()


def seen(name, frames, count, shape, samples):
    """Hands frames on that are what they should be. `samples` gets up to 100 of them, or a few more of a long video, at a
    coarser resolution, as LeRobot takes them for statistics."""
    wanted = set(np.round(np.linspace(0, count - 1, max(min(count, 100), int(count**0.75)))).astype(int))
    stride = max(shape[:2]) // 150 if max(shape[:2]) >= 300 else 1
    for number, frame in enumerate(itertools.chain(map(np.asarray, frames), [None])):
        if number == count and frame is None:
            return
        if number == count or frame is None or frame.dtype != np.uint8 or list(frame.shape) != shape:
            what = "missing" if frame is None else f"{frame.dtype} of the shape {frame.shape}"
            raise vibe.Error(f"Frame {number} of the video {name!r} is {what}; give {count} frames of uint8 of the shape {tuple(shape)}.")
        if number in wanted:
            samples.append(frame[::stride, ::stride])
        yield np.ascontiguousarray(frame)
