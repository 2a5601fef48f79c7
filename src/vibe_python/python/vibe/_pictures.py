"""Pictures of a simulation for people: as arrays, as PNG, and in a window, without ROS."""

import struct
import time
import zlib

import numpy as np

import vibe

from ._core import Error, Simulation

VIEWS = ("endoscope", "outside")
_WIDE = 1.7  # field of view of the endoscope [rad]
_NARROW = 0.5  # of the outside view [rad]
_ROOM = 1.4  # of the outside view: the size of the organ at rest and room for gas, breath and scope
_MARK = np.array([60, 220, 90], np.uint8)  # colour of a goal
#: axes of a camera before the patient: x to the patient's left, y down, z to the back
_FACING = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def picture(simulation, view="endoscope", size=480, goal=None):
    """What a simulation looks like, with device and threads: a new array (size, size, 3) uint8.

    view  'endoscope': what its lens sees; 'outside': organ and scope from before the patient, through the near wall
    size  pixels of each side, 1 to 4096
    goal  a place (3,) in world that the outside view marks [m]; None: no mark
    """
    if not isinstance(simulation, Simulation):
        raise Error(f"'simulation' is {vibe._shown(simulation)}; give a vibe.Simulation.")
    check_view(view)
    if isinstance(size, bool) or not isinstance(size, (int, np.integer)) or not 1 <= size <= 4096:
        raise Error(f"'size' is {vibe._shown(size)}; give the pixels of each side, from 1 to 4096.")
    if goal is not None:
        goal = _place(goal)
    if view == "endoscope":
        return simulation.camera(size, size, _WIDE, colour=True, tool=True)["colour"]
    rest = simulation.model.rest_positions
    low, high = rest.min(0), rest.max(0)
    far = _ROOM * max(high[1:] - low[1:]) / 2 / np.tan(_NARROW / 2) + (high[0] - low[0]) / 2
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = _FACING, (low + high) / 2 + [far, 0, 0]
    seen = simulation.camera(size, size, _NARROW, colour=True, tool=True, pose=pose, lamp=far)["colour"]
    if goal is not None:
        _mark(seen, pose, goal)
    return seen


def _place(goal):
    place = vibe._array_of(goal)
    if place.dtype.kind not in "iuf" or place.shape != (3,) or not np.isfinite(place).all():
        raise Error(f"'goal' is {vibe._shown(goal)}; give a place (3,) in world [m], or None.")
    return place.astype(float)


def check_view(view):
    if not isinstance(view, str) or view not in VIEWS:
        raise Error(f"'view' is {vibe._shown(view)}; use {' or '.join(map(repr, VIEWS))}.")


def _mark(seen, pose, goal):
    """A disc where the goal is, whatever hides it."""
    size = len(seen)
    x, y, z = pose[:3, :3].T @ (goal - pose[:3, 3])
    focal = size / 2 / np.tan(_NARROW / 2)
    row, column = np.mgrid[:size, :size] + 0.5 - size / 2
    seen[np.hypot(column - focal * x / z, row - focal * y / z) < size / 80] = _MARK


def png(pixels):
    """A picture (height, width, 3) uint8 as a file in bytes."""
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    height, width, _ = pixels.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with the number of its filter, 0: none
    rows[:, 1:] = pixels.reshape(height, -1)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b""))


class Window:
    """A picture on the screen, until close() or until somebody closes it. Of one thread."""

    def __init__(self, title, draw):
        try:
            import tkinter

            self._root = tkinter.Tk()
        except ImportError:
            raise Error("A window needs Python's tkinter; install python3-tk, or take vibe.picture().") from None
        except tkinter.TclError as error:
            raise Error(f"No window can be opened ({error}); set DISPLAY to a display, or take vibe.picture().") from None
        self._root.title(title)
        self._root.protocol("WM_DELETE_WINDOW", self.close)
        self._photo, self._draw, self._shown = tkinter.PhotoImage(master=self._root), draw, 0.0
        tkinter.Label(self._root, image=self._photo).pack()

    @property
    def closed(self):
        """Whether the window is gone."""
        return self._root is None

    def update(self, period=0.0):
        """Draws the present state, at least `period` after the last time [s]. Returns whether the window is still there."""
        if not self.closed:
            self._photo.configure(data=png(self._draw()))
            time.sleep(max(0.0, self._shown + period - time.monotonic()))
            self._shown = time.monotonic()
            self._root.update()
        return not self.closed

    def close(self):
        """Takes the window away."""
        if not self.closed:
            self._root.destroy()
            self._root = None


def view(simulation, view="endoscope", size=480):
    """Opens a window with picture(simulation, view, size) and returns it; needs a display and tkinter, no ROS:

        window = vibe.view(simulation, "outside")
        while window.update(1 / 60):
            simulation.step(insertion=0.1)

    window.update(period) draws the present state, at least `period` after the last time [s], and says whether the window is still
    there; window.close() takes it away."""
    picture(simulation, view, size)  # what is wrong is said before a window is opened
    window = Window("vibe", lambda: picture(simulation, view, size))
    window.update()
    return window


def _repr_png_(simulation):
    """What a notebook shows; None: nothing, of a simulation without scope or that is closed."""
    try:
        return png(picture(simulation))
    except Error:
        return None


Simulation._repr_png_ = _repr_png_
