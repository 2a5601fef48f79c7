"""What the tests of the vision node share: programs, recorders of topics, rendered scenes with their truth."""

import csv
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import rospkg
import rospy
from PIL import Image

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGE = os.path.join(HERE, "..", "..")
JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]
INSTRUMENTS = ["helix", "needle_driver"]
RATE = 147.0  # of rendered scenes [Hz]
START = 1_700_000_000.0  # stamp of their first frame [s]

sys.path.insert(0, os.path.join(PACKAGE, "examples"))
import udp_receiver  # noqa: E402,F401  for the tests


def wait_until(condition, seconds=15.0):
    """Whether the condition became true within some seconds."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.01)
    return bool(condition())


def find_program(program, package="vibe_vision"):
    for folder in os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep) + ["/usr"]:
        path = os.path.join(folder, "lib", package, program)
        if os.path.exists(path):
            return path
    if shutil.which(program):
        return shutil.which(program)
    raise rospkg.ResourceNotFound(program)


class Program:
    """A program with its output. ROS parameters as keywords."""

    def __init__(self, program, *arguments, name=None, package="vibe_vision", **parameters):
        if name and rospy.has_param("/" + name):
            rospy.delete_param("/" + name)  # of an earlier program of this name
        command = [find_program(program, package)] + list(arguments)
        command += ["_{}:={}".format(key, value) for key, value in parameters.items()]
        if name:
            command.append("__name:=" + name)
        environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self.lines = []
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, env=environment
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def output(self):
        return "\n".join(self.lines)

    def says(self, text, seconds=15.0):
        return wait_until(lambda: any(text in line for line in list(self.lines)), seconds)

    def ends(self, seconds=15.0):
        """The exit status, or None if it still runs after that time."""
        try:
            self.process.wait(seconds)
            self._reader.join(5)
        except subprocess.TimeoutExpired:
            return None
        return self.process.returncode

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        if self.ends() is None:
            self.process.kill()
        return self.ends()

    def memory(self):
        """Resident memory [bytes]."""
        with open("/proc/{}/statm".format(self.process.pid)) as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Recorder:
    """Everything that arrives on a topic, in order, with the time of arrival."""

    def __init__(self, topic, message_type):
        self._arrivals = []
        self._lock = threading.Lock()
        self.subscriber = rospy.Subscriber(topic, message_type, self._append, queue_size=None, tcp_nodelay=True)

    def _append(self, message):
        with self._lock:
            self._arrivals.append((time.time(), message))

    @property
    def arrivals(self):
        with self._lock:
            return list(self._arrivals)

    @property
    def messages(self):
        return [message for _, message in self.arrivals]

    def clear(self):
        with self._lock:
            self._arrivals = []

    def waits_for(self, condition, seconds=15.0):
        """The first message for which it holds, or None."""
        found = []
        wait_until(lambda: found.extend(m for m in self.messages if condition(m)) or found, seconds)
        return found[0] if found else None

    def waits_for_connection(self):
        return wait_until(lambda: self.subscriber.get_num_connections() > 0)

    def disconnect(self):
        self.subscriber.unregister()


class Diagnostics:
    """Newest values of an entry on /diagnostics."""

    def __init__(self, recorder, name):
        self.recorder, self.name = recorder, name

    def newest(self, after=0.0):
        for arrival, message in reversed(self.recorder.arrivals):
            for status in message.status:
                if status.name.endswith(": " + self.name) and arrival > after:
                    return status.level, status.message, {v.key: v.value for v in status.values}
        return None, "", {}

    def waits_for(self, condition, seconds=10.0):
        """The newest (level, message, values) for which condition(level, message, values) holds."""
        begin = time.time()
        found = []

        def look():
            found[:] = [self.newest(begin)]
            return found[0][0] is not None and condition(*found[0])

        return found[0] if wait_until(look, seconds) else None


class Scene:
    """A rendered scene: video or images, configuration and truth."""

    def __init__(self, name, frames, format="images"):
        self.folder = tempfile.mkdtemp(prefix="vibe_vision_")
        command = [find_program("vibe_render"), "--scene", name, "--frames", str(frames), "--start", repr(START)]
        subprocess.run(command + ["--out", self.folder, "--format", format], check=True, stdout=subprocess.DEVNULL)
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
    """Errors of slide [m] and rotation [rad] of an instrument in messages of overstitch/tracking."""
    index = INSTRUMENTS.index(instrument)
    slides, rotations = [], []
    for message in tracks:
        track = message.instruments[index]
        if track.tracked:
            slide, rotation = scene.truth_of(instrument, message.frame_sequence)
            slides.append(track.slide - slide)
            rotations.append(math.remainder(track.rotation - rotation, 2 * math.pi) if index == 0 else 0)
    return slides, rotations
