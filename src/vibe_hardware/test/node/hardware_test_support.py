"""What the tests of hardware_node share: the emulator of its devices."""

import os
import tempfile
import time

from vibe_testing.program import Program
from vibe_testing.wait import wait_until

SCOPE_JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
SUTURING_DEVICE_JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]


class Emulator:
    """vibe_emulator with a folder and a hand of its own."""

    def __init__(self, script):
        self.folder = tempfile.mkdtemp(prefix="vibe_hw_")
        self.script = os.path.join(self.folder, "hand.yaml")
        with open(self.script, "w") as file:
            file.write(script)
        self.program = None

    def sockets(self):
        """With their times: an emulator that was killed leaves its sockets behind."""
        files = [os.path.join(self.folder, f) for f in os.listdir(self.folder) if f.endswith(".hid")]
        return {(f, os.stat(f).st_ctime_ns) for f in files if os.path.exists(f)}

    def start(self):
        """Returns the time at which its devices are there."""
        stale = self.sockets()
        self.program = Program("vibe_hardware", "vibe_emulator", "--folder", self.folder, "--hand", "script", self.script)
        wait_until(lambda: len(self.sockets() - stale) == 2)
        return time.time()

    def kill(self):
        self.program.kill()

    def stop(self):
        if self.program:
            self.program.stop()
