"""Pictures of the endoscope's eye: the image of endoscope_camera in ten states of three sessions.

scripts/views has checked the arguments, built the workspace and sourced its environment. The simulator begins paused and
is taken from picture to picture by its service `step`, so that a picture shows the same state on every machine.
"""

import argparse
import collections
import json
import os
import re
import signal
import sys
import tempfile
import time

import numpy
import rospy
from PIL import Image as Picture
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import String

from graph import GraphError
from run_session import Interrupted, attempt, interrupt, session_defaults
from rviz_window import PATIENCE, wait_for
from take_pictures import PictureSession

View = collections.namedtuple("View", "name session seconds followed", defaults=(None,))
# followed: from when on the camera listens, for what depends on the past: smoke, and the colour of marks
SESSIONS = {  # script, and what differs from the default scene
    "eye": ("eye.yaml", {}),
    "states": ("five_states.yaml", {}),
    "bleeding": ("five_states.yaml", {"mild_probability": 1.0, "brisk_probability": 0.0}),
}
VIEWS = [
    View("rest", "eye", 1.9),
    View("5mmhg", "eye", 5.6),
    View("10mmhg", "eye", 16.0),
    View("antrum", "eye", 21.5),
    View("retroflexed", "eye", 35.5),
    View("marked", "states", 48.0),
    View("sutured", "states", 89.5),
    View("bleeding", "bleeding", 89.5),
    View("smoke", "eye", 48.4, followed=45.0),
    View("scar", "eye", 332.0, followed=45.0),
]
COLUMNS = 5  # of the sheet


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    for name in ("--workspace", "--size", "--output"):
        parser.add_argument(name, required=True)
    parser.add_argument("--truth", action="store_true")
    parser.add_argument("views", nargs="+", choices=[view.name for view in VIEWS])
    return parser.parse_args()


def scene_with(workspace, changes, folder):
    """The default scene, with other values of some keys."""
    file = os.path.join(workspace, "src/vibe_core/scenes/stomach.yaml")
    if not changes:
        return file
    with open(file, encoding="utf-8") as scene:
        text = scene.read()
    for key, value in changes.items():
        text, count = re.subn(r"(?m)^(\s*{}:\s*)\S+".format(key), r"\g<1>{}".format(value), text)
        if count != 1:
            raise GraphError("the scene {} has no single key '{}'".format(file, key))
    changed = os.path.join(folder, "scene.yaml")
    with open(changed, "w", encoding="utf-8") as scene:
        scene.write(text)
    return changed


def array_of(image):
    """The values of an image message."""
    kind, channels = {"rgb8": (numpy.uint8, 3), "8UC1": (numpy.uint8, 1), "32FC1": (numpy.float32, 1)}[image.encoding]
    values = numpy.frombuffer(image.data, kind).reshape(image.height, image.width, channels)
    return values if channels > 1 else values[..., 0]


class ViewSession(PictureSession):
    """A session that stands still whenever nobody steps it, with the endoscope's camera instead of rviz."""

    def __init__(self, arguments, size):
        arguments.pictures = []
        super().__init__(arguments)
        self.size = size
        topics = {"image_raw": Image}
        if arguments.truth:
            topics.update({"labels": Image, "depth/image_raw": Image, "label_table": String})
        self.topics = topics
        self.messages = {}  # per topic: by stamp
        self.subscribers = []
        self.follower = None

    def start(self):
        graph = self.graph
        graph.start_master()
        self.set_parameters()
        width, height = self.size.split("x")
        options = ["_width:=" + width, "_height:=" + height, "_rate:=0"]
        graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
        graph.start("endoscope_camera", ["rosrun", "vibe_rviz_plugins", "endoscope_camera", *options])
        graph.start("vibe_trainee", ["rosrun", "vibe_sim", "vibe_trainee"])
        self.sim = graph.start("sim_node", ["rosrun", "vibe_sim", "sim_node"], patience=30.0)
        wait_for(self.is_ready, "the simulator and the camera did not begin (see {})".format(self.logs))

    def is_ready(self):
        publishers, _, services = self.graph.master.getSystemState("/vibe_scripts")[2]
        offered = [name for name, _ in services]
        return "/step" in offered and any(topic == "/endoscope/image_raw" for topic, _ in publishers)

    def look(self):
        """Listens to the camera, which then listens to the simulator, until an image shows a step that begins later."""
        self.messages = {topic: {} for topic in self.topics}
        for topic, kind in self.topics.items():
            self.subscribers.append(rospy.Subscriber("/endoscope/" + topic, kind, self.keep, topic))
        wait_for(self.is_watched, "the camera did not listen to the tissue (see {})".format(self.logs))
        connected = lambda: all(subscriber.get_num_connections() > 0 for subscriber in self.subscribers)
        wait_for(connected, "the camera does not publish all of {} (see {})".format(", ".join(self.topics), self.logs))
        time.sleep(1)  # for its side of the connections, and for the transforms of before

    def follow(self):
        """Lets the camera listen to the simulator from now on without drawing: camera_info needs no image."""
        self.follower = rospy.Subscriber("/endoscope/camera_info", CameraInfo, lambda _: None)
        wait_for(self.is_watched, "the camera did not listen to the tissue (see {})".format(self.logs))
        time.sleep(1)

    def is_watched(self):
        _, subscribers, _ = self.graph.master.getSystemState("/vibe_scripts")[2]
        return any(topic == "/tissue/particles" and nodes for topic, nodes in subscribers)

    def keep(self, message, topic):
        stamp = message.header.stamp if hasattr(message, "header") else rospy.Time()
        self.messages[topic][stamp.to_nsec()] = message

    def pictures(self):
        """The stamps of which every image is there."""
        return set.intersection(*(set(self.messages[t]) for t, kind in self.topics.items() if kind is Image))

    def take(self, view, file):
        period = self.step_period()
        if view.followed is not None and self.follower is None:
            self.step_to(view.followed, period)
            self.follow()
        self.step_to(view.seconds - 5 * period, period)
        self.look()
        for left in reversed(range(5)):  # one at a time: the last one has an image, and sutures of before
            before = len(self.pictures())
            self.step_to((self.steps_done + 1) * period, period)
            # the first steps may be over before a busy machine has connected the camera
            deadline = time.monotonic() + (5 if left > 0 else PATIENCE)
            while len(self.pictures()) == before and time.monotonic() < deadline:
                time.sleep(0.05)
        if len(self.pictures()) == before:
            raise GraphError("the camera took no picture (see {})".format(self.logs))
        for subscriber in self.subscribers:
            subscriber.unregister()
        self.subscribers.clear()
        self.save(max(self.pictures()), file)

    def save(self, stamp, file):
        """The picture, and its truth as FILE.npz: labels, depth, and the names of the labels by their numbers."""
        images = {t: array_of(self.messages[t][stamp]) for t, kind in self.topics.items() if kind is Image}
        Picture.fromarray(images["image_raw"]).save(file)
        if "labels" in images:
            table = json.loads(next(iter(self.messages["label_table"].values())).data)
            names = numpy.full(256, "", dtype=object)
            for row in table:
                names[row["number"]] = row["name"]
            numpy.savez_compressed(os.path.splitext(file)[0] + ".npz", labels=images["labels"],
                                   depth=images["depth/image_raw"], names=names.astype(str))  # fmt: skip


def take_session(arguments, name, views):
    """Runs one session in a process of its own, because a ROS client cannot change its master."""
    script, changes = SESSIONS[name]
    failures = []
    session_arguments = session_defaults(fast=True)
    session_arguments.workspace, session_arguments.truth = arguments.workspace, arguments.truth
    session_arguments.script = os.path.join(arguments.workspace, "src/vibe_core/trainees/demo", script)
    with tempfile.TemporaryDirectory(prefix="vibe-views-") as session_arguments.output:
        session = None
        try:
            session_arguments.scene = scene_with(arguments.workspace, changes, session_arguments.output)
            session = ViewSession(session_arguments, arguments.size)
            attempt(session.start, failures)
            if not failures:
                os.environ.update({k: session.graph.env[k] for k in ("ROS_MASTER_URI", "ROS_HOSTNAME")})
                rospy.init_node("views", anonymous=True, disable_signals=True)
            for view in views:
                file = os.path.join(arguments.output, "eye_{}.png".format(view.name))
                if not failures:
                    attempt(lambda view=view, file=file: session.take(view, file), failures)
        except (GraphError, Interrupted) as reason:
            failures.append(str(reason))
        if session is not None:
            attempt(session.stop, failures)
    for failure in failures:
        print("views: " + failure, file=sys.stderr)
    return not failures


def make_sheet(arguments):
    """All views that exist on one sheet, in half of their size."""
    files = [os.path.join(arguments.output, "eye_{}.png".format(view.name)) for view in VIEWS]
    pictures = [Picture.open(file).convert("RGB") for file in files if os.path.exists(file)]
    width, height = pictures[0].width // 2, pictures[0].height // 2
    rows = -(-len(pictures) // COLUMNS)
    sheet = Picture.new("RGB", (COLUMNS * width, rows * height))
    for number, picture in enumerate(pictures):
        sheet.paste(picture.resize((width, height)), (number % COLUMNS * width, number // COLUMNS * height))
    sheet.save(os.path.join(arguments.output, "eye_views.png"))


def main():
    arguments = parse_arguments()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    for name in SESSIONS:
        views = sorted((v for v in VIEWS if v.session == name and v.name in arguments.views), key=lambda v: v.seconds)
        if not views:
            continue
        child = os.fork()
        if child == 0:
            os._exit(0 if take_session(arguments, name, views) else 1)
        if os.waitpid(child, 0)[1] != 0:
            sys.exit(1)
    make_sheet(arguments)


if __name__ == "__main__":
    main()
