"""A display for programs that draw, without a screen and without a graphics card."""

from .program import Program
from .wait import wait_until


class VirtualDisplay(Program):
    """Xvfb on a free display, which is there when this returns; to be stopped. env: what those who draw on it need."""

    def __init__(self, size="1280x720"):
        super().__init__("xvfb", "Xvfb", "-displayfd", "1", "-screen", "0", size + "x24", "-nolisten", "tcp")
        wait_until(lambda: self._number() or not self.is_running())
        assert self._number(), "Xvfb names no display:\n" + self.output()
        self.env = {"DISPLAY": ":" + self._number(), "LIBGL_ALWAYS_SOFTWARE": "1", "QT_X11_NO_MITSHM": "1"}

    def _number(self):
        return next((line for line in list(self.lines) if line.isdigit()), "")
