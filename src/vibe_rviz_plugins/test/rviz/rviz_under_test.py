"""rviz on a virtual display, and what it says of itself (see rviz_report_main.cpp)."""

import json
import os
import shutil
import subprocess
import tempfile
import time

PATIENCE = 120.0  # software rendering on a busy machine [s]


class RvizUnderTest:
    """Starts with `config`; to be stopped. Raises AssertionError where rviz does not do what is waited for."""

    def __init__(self, config):
        self.folder = tempfile.mkdtemp(prefix="vibe-rviz-test-")
        self.report_file = os.path.join(self.folder, "report.json")
        self.log = os.path.join(self.folder, "rviz.log")
        self.processes = []
        runtime = os.path.join(self.folder, "runtime")
        os.mkdir(runtime, 0o700)
        # HOME: rviz reads and writes settings there
        self.env = dict(
            os.environ, LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", XDG_RUNTIME_DIR=runtime, HOME=self.folder
        )
        self.env.setdefault("ROS_HOME", os.path.join(self.folder, "ros"))
        self.start_display()
        program = ["rosrun", "vibe_rviz_plugins", "rviz_report", self.report_file]
        self.rviz = self.start([*program, "--splash-screen", "", "-d", config], stdin=subprocess.PIPE)

    def start_display(self):
        number = os.path.join(self.folder, "display")
        open(number, "wb").close()
        self.start(["sh", "-c", 'exec Xvfb -displayfd 7 -screen 0 1280x720x24 -nolisten tcp 7>"$1"', "sh", number])
        self.wait_for(lambda: os.path.getsize(number) > 1, "Xvfb names no display")
        with open(number, encoding="ascii") as text:
            self.env["DISPLAY"] = ":" + text.read().strip()

    def start(self, command, stdin=subprocess.DEVNULL):
        with open(self.log, "ab") as output:
            process = subprocess.Popen(command, env=self.env, stdin=stdin, stdout=output, stderr=subprocess.STDOUT)
        self.processes.append(process)
        return process

    def stop(self):
        for process in reversed(self.processes):
            if process.poll() is None:
                process.terminate()
        for process in reversed(self.processes):
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def tell(self, *lines):
        """Keys and motions of the mouse, see rviz_events.hpp."""
        self.rviz.stdin.write("".join(line + "\n" for line in lines).encode())
        self.rviz.stdin.flush()

    def picture(self, name):
        """A file with what the display shows."""
        file = os.path.join(self.folder, name)
        subprocess.run(["import", "-window", "root", file], env=self.env, check=True)
        return file

    def last_words(self):
        with open(self.log, encoding="utf-8", errors="replace") as text:
            return "".join(text.readlines()[-15:])

    def report(self):
        """The last one: {"frames", "memory", "tool", "statuses"}."""
        for process in self.processes:
            assert process.poll() is None, "{} ended with {}:\n{}".format(
                process.args[0], process.returncode, self.last_words()
            )
        try:
            with open(self.report_file, encoding="utf-8") as text:
                return json.load(text)
        except FileNotFoundError:
            return {"frames": 0, "memory": 0, "tool": "", "statuses": []}

    def wait_for(self, condition, what, patience=PATIENCE):
        deadline = time.monotonic() + patience
        while not condition():
            assert time.monotonic() < deadline, "{} within {:.0f} s".format(what, patience)
            time.sleep(0.1)

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

        try:
            self.wait_for(is_there, "")
        except AssertionError as error:
            if not str(error).startswith(" within"):
                raise
            told = self.status(display, what)
            raise AssertionError("{} of {} is {}, not {}, '{}'".format(what, display, told, level, part)) from None
