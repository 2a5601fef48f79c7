"""Asks every program with a window on the X display DISPLAY to close it, as a click on its cross does. For tests."""

import ctypes
import sys

CLIENT_MESSAGE = 33


class ClientMessage(ctypes.Structure):
    """XClientMessageEvent of Xlib.h, as long as an XEvent."""

    _fields_ = [
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int),
        ("data", ctypes.c_long * 5),
        ("rest", ctypes.c_long * 24),
    ]


class Display:
    def __init__(self):
        self.x11 = ctypes.CDLL("libX11.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        for name in ("XDefaultRootWindow", "XInternAtom"):
            getattr(self.x11, name).restype = ctypes.c_ulong
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(None))
        if not self.display:
            sys.exit("close_window: DISPLAY names no display that can be opened; set it to one")

    def atom(self, name):
        return self.x11.XInternAtom(self.display, name, 0)

    def windows(self):
        """The windows of programs: the children of the root."""
        root, parent, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
        children = ctypes.POINTER(ctypes.c_ulong)()
        top = ctypes.c_ulong(self.x11.XDefaultRootWindow(self.display))
        self.x11.XQueryTree(
            self.display, top, ctypes.byref(root), ctypes.byref(parent), ctypes.byref(children), ctypes.byref(count)
        )
        return [children[i] for i in range(count.value)]

    def closes(self, window):
        """Whether the window takes the request to close."""
        protocols, count = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_int()
        found = self.x11.XGetWMProtocols(
            self.display, ctypes.c_ulong(window), ctypes.byref(protocols), ctypes.byref(count)
        )
        return bool(found) and self.atom(b"WM_DELETE_WINDOW") in [protocols[i] for i in range(count.value)]

    def close(self, window):
        message = ClientMessage(type=CLIENT_MESSAGE, window=window, format=32)
        message.message_type = self.atom(b"WM_PROTOCOLS")
        message.data[0] = self.atom(b"WM_DELETE_WINDOW")
        self.x11.XSendEvent(self.display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(message))
        self.x11.XFlush(self.display)


def main():
    display = Display()
    windows = [window for window in display.windows() if display.closes(window)]
    for window in windows:
        display.close(window)
    sys.exit(0 if windows else 1)


if __name__ == "__main__":
    main()
