"""rviz on a virtual display, and what it says of itself (see rviz_report_main.cpp)."""

import json
import os
import shutil
import signal
import subprocess
import tempfile

from vibe_testing.program import Program
from vibe_testing.virtual_display import VirtualDisplay
from vibe_testing.wait import wait_until

PATIENCE = 120.0  # software rendering on a busy machine [s]


class RvizUnderTest:
    """Starts with `config`; to be stopped. Raises AssertionError where rviz does not do what is waited for."""

    def __init__(self, config):
        self.folder = tempfile.mkdtemp(prefix="vibe-rviz-test-")
        self.report_file = os.path.join(self.folder, "report.json")
        runtime = os.path.join(self.folder, "runtime")
        os.mkdir(runtime, 0o700)
        self.display = VirtualDisplay()
        # HOME: rviz reads and writes settings there
        env = {"XDG_RUNTIME_DIR": runtime, "HOME": self.folder, **self.display.env}
        env["ROS_HOME"] = os.environ.get("ROS_HOME", os.path.join(self.folder, "ros"))
        options = [self.report_file, "--splash-screen", "", "-d", config]
        self.rviz = Program("vibe_rviz_plugins", "rviz_report", *options, env=env, stdin=subprocess.PIPE)

    def stop(self):
        self.rviz.stop(signal.SIGTERM)
        self.display.stop(signal.SIGTERM)
        shutil.rmtree(self.folder, ignore_errors=True)

    def tell(self, *lines):
        """Keys and motions of the mouse, see rviz_events.hpp."""
        self.rviz.process.stdin.write("".join(line + "\n" for line in lines))
        self.rviz.process.stdin.flush()

    def picture(self, name):
        """A file with what the display shows."""
        file = os.path.join(self.folder, name)
        subprocess.run(["import", "-window", "root", file], env={**os.environ, **self.display.env}, check=True)
        return file

    def report(self):
        """The last one: {"frames", "memory", "tool", "statuses"}."""
        for program in (self.display, self.rviz):
            assert program.is_running(), "{} ended with {}:\n{}".format(
                program.process.args[0], program.ends(), program.last_words()
            )
        try:
            with open(self.report_file, encoding="utf-8") as text:
                return json.load(text)
        except FileNotFoundError:
            return {"frames": 0, "memory": 0, "tool": "", "statuses": []}

    def wait_for(self, condition, what, patience=PATIENCE):
        assert wait_until(condition, patience, interval=0.1), "{} within {:.0f} s".format(what, patience)

    def wait_for_frames(self, count):
        """Until it has drawn so many frames more: its window lives."""
        last = self.report()["frames"] + count
        self.wait_for(lambda: self.report()["frames"] >= last, "rviz does not draw {} frames".format(count))

    def status(self, display, what):
        """(level, text) of one status of a display; ("", "") where there is none."""
        for status in self.report()["statuses"]:
            if status["of"] == display and status["what"] == what:
                return status["level"], status["text"]
        return "", ""

    def wait_for_status(self, display, what, level, part):
        def is_there():
            told = self.status(display, what)
            return told[0] == level and part in told[1]

        assert wait_until(is_there, PATIENCE, interval=0.1), "{} of {} is {}, not {}, '{}'".format(
            what, display, self.status(display, what), level, part
        )
