"""Pictures of the endoscope's eye: the image of endoscope_camera in twelve states of four sessions.

The simulator begins paused and is taken from picture to picture by its service `step`, so that a picture shows the same
state on every machine.
"""

import functools
import json
import os
import re
import signal
import tempfile
import time

import numpy
import rospy
from PIL import Image as Picture
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import String
from vibe_sessions.whole_file import whole

from . import places
from .graph import GraphError
from .run import defaults, trainee
from .rviz_window import PATIENCE, wait_for
from .session import Interrupted, carry_out, interruptible
from .take_pictures import PictureSession
from .view_list import SESSIONS, VIEWS

COLUMNS = 4  # of the sheet


def scene_with(changes, folder):
    """The default scene, with other values of some keys."""
    file = places.find(places.SCENE)
    if not changes:
        return file
    with open(file, encoding="utf-8") as scene:
        text = scene.read()
    for key, value in changes.items():
        text, count = re.subn(r"(?m)^(\s*{}:\s*)\S+".format(key), r"\g<1>{}".format(value), text)
        if count != 1:
            raise GraphError("the scene {} has no single key '{}'".format(file, key))
    changed = os.path.join(folder, "scene.yaml")
    with open(changed, "w", encoding="utf-8") as scene:  # not whole: scratch
        scene.write(text)
    return changed


def array_of(image):
    """The values of an image message."""
    kind, channels = {"rgb8": (numpy.uint8, 3), "8UC1": (numpy.uint8, 1), "32FC1": (numpy.float32, 1)}[image.encoding]
    values = numpy.frombuffer(image.data, kind).reshape(image.height, image.width, channels)
    return values if channels > 1 else values[..., 0]


class ViewSession(PictureSession):
    """A session that stands still whenever nobody steps it, with the endoscope's camera instead of rviz."""

    def __init__(self, arguments, changes, wanted):
        super().__init__(arguments)
        self.changes, self.size, self.pictures_folder = changes, wanted.size, wanted.output
        self.topics = {"image_raw": Image}
        if wanted.truth:
            self.topics.update({"labels": Image, "depth/image_raw": Image, "label_table": String})
        self.messages = {}  # per topic: by stamp
        self.subscribers = []
        self.follower = None

    def set_parameters(self):
        super().set_parameters()
        self.graph.set_parameter("/sim_node/scene", scene_with(self.changes, self.output))

    def start(self):
        graph = self.graph
        graph.start_master()
        self.set_parameters()
        width, height = self.size.split("x")
        options = ["_width:=" + width, "_height:=" + height, "_rate:=0"]
        graph.start_robot()
        graph.start_node("vibe_endoscope", "endoscope_camera", *options)
        graph.start_node("vibe_sim", "vibe_trainee")
        self.sim = graph.start_node("vibe_sim", "sim_node", patience=30.0)
        wait_for(self.is_ready, "the simulator and the camera did not begin (see {})".format(self.logs))

    def become_node(self):
        os.environ.update({k: self.graph.env[k] for k in ("ROS_MASTER_URI", "ROS_HOSTNAME")})
        rospy.init_node("views", anonymous=True, disable_signals=True)

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

    def take(self, view):
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
        self.save(max(self.pictures()), os.path.join(self.pictures_folder, "eye_{}.png".format(view.name)))

    def save(self, stamp, file):
        """The picture, and its truth as FILE.npz: labels, depth, and the names of the labels by their numbers."""
        images = {t: array_of(self.messages[t][stamp]) for t, kind in self.topics.items() if kind is Image}
        with whole(file) as part:
            Picture.fromarray(images["image_raw"]).save(part)
        if "labels" in images:
            table = json.loads(next(iter(self.messages["label_table"].values())).data)
            names = numpy.full(256, "", dtype=object)
            for row in table:
                names[row["number"]] = row["name"]
            with whole(os.path.splitext(file)[0] + ".npz") as part:
                numpy.savez_compressed(part, labels=images["labels"], depth=images["depth/image_raw"], names=names.astype(str))


def take_session(arguments, name, views):
    """One session in a process of its own, because a ROS client cannot change its master. Returns the exit status."""
    script, changes = SESSIONS[name]
    with tempfile.TemporaryDirectory(prefix="vibe-views-") as folder:
        session = ViewSession(defaults(script=trainee(script), fast=True, output=folder), changes, arguments)
        takes = [functools.partial(session.take, view) for view in views]
        return carry_out("views", [session.start, session.become_node, *takes], session.stop)


def make_sheet(arguments):
    """All views that exist on one sheet, in half of their size."""
    files = [os.path.join(arguments.output, "eye_{}.png".format(view.name)) for view in VIEWS]
    pictures = [Picture.open(file).convert("RGB") for file in files if os.path.exists(file)]
    width, height = pictures[0].width // 2, pictures[0].height // 2
    rows = -(-len(pictures) // COLUMNS)
    sheet = Picture.new("RGB", (COLUMNS * width, rows * height))
    for number, picture in enumerate(pictures):
        sheet.paste(picture.resize((width, height)), (number % COLUMNS * width, number // COLUMNS * height))
    with whole(os.path.join(arguments.output, "eye_views.png")) as part:
        sheet.save(part)


def take_all(arguments):
    """Returns the exit status."""
    os.makedirs(arguments.output, exist_ok=True)
    for name in SESSIONS:
        views = sorted((view for view in arguments.views if view.session == name), key=lambda view: view.seconds)
        if not views:
            continue
        child = os.fork()
        if child == 0:
            os._exit(take_session(arguments, name, views))
        try:
            with interruptible():
                status = os.waitpid(child, 0)[1]
        except Interrupted:
            os.kill(child, signal.SIGTERM)
            status = os.waitpid(child, 0)[1]
        if status != 0:
            return 1
    make_sheet(arguments)
    return 0
