"""A LeRobot data set of recordings: an episode for each goal of a trainee, or of a whole session that somebody else drove."""

import os

import numpy
from vibe_msgs.msg import GoalProgress, ProcedureEvent

from ..report.bag_file import BagError
from .source import Source

FPS = 30
KINDS = dict(sorted((value, name) for name, value in vars(ProcedureEvent).items() if name.isupper() and isinstance(value, int)))
MISHAPS = {ProcedureEvent.GRAB_MISSED, ProcedureEvent.SLIP, ProcedureEvent.BITE_MISSED, ProcedureEvent.BITE_WITHDRAWN,
           ProcedureEvent.TEAR_OUT, ProcedureEvent.THREAD_BROKE, ProcedureEvent.CINCH_LOOSE, ProcedureEvent.DEEP_BURN,
           ProcedureEvent.BLEEDING_OVERDUE, ProcedureEvent.REJECTED}  # fmt: skip
JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right", "helix_advance", "helix_rotation", "needle_driver"]
BUTTONS = ["argon", "helix", "needle", "t_tag", "cinch", "insufflate"]
NAMES = {
    "observation.state": [*JOINTS, *(each + "_velocity" for each in JOINTS)],
    "observation.pose": ["x", "y", "z", "qx", "qy", "qz", "qw"],
    "observation.wrench": ["force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"],
    "observation.contacts": ["count", "normal_force", "force_x", "force_y", "force_z"],
    "observation.gas": ["pressure"],
    "observation.events": [name.lower() for name in KINDS.values()],
    "action": [*JOINTS, *BUTTONS],
}
STATES = ("scope/measured_js", "suturing_device/measured_js", "scope/measured_cp", "scope/measured_cf", "scope/contacts",
          "step_result")  # fmt: skip
CAMERA = "observation.images.endoscope"


def lacks(source):
    """Topics that it needs and a recording does not have."""
    return [name for name in ("applied_input", *STATES) if not source.count(name)]


def xyz(vector):
    return [vector.x, vector.y, vector.z]


def observation(latest):
    """Rows of the features, from the newest message of each topic."""
    scope, device, pose, wrench, contacts, result = (latest[name].fields for name in STATES)
    forces = [xyz(each.force) for each in contacts.contacts]
    position, turn = pose.pose.position, pose.pose.orientation
    return {
        "observation.state": [*scope.position, *device.position, *scope.velocity, *device.velocity],
        "observation.pose": [*xyz(position), *xyz(turn), turn.w],
        "observation.wrench": [*xyz(wrench.wrench.force), *xyz(wrench.wrench.torque)],
        "observation.contacts": [len(forces), sum(each.normal_force for each in contacts.contacts),
                                 *numpy.sum(forces, axis=0, initial=0.0).tolist()] if forces else [0.0] * 5,
        "observation.gas": [result.pressure],
    }  # fmt: skip


class Episode:
    def __init__(self, goal, task):
        self.goal, self.task = goal, task
        self.times, self.rows = [], {name: [] for name in NAMES}
        self.kinds, self._new = set(), numpy.zeros(len(KINDS))

    def event(self, kind):
        self.kinds.add(kind)
        self._new[kind] += 1

    def frame(self, time, latest, step):
        row = {**observation(latest), "observation.events": self._new, "action": [*step.joints, *step.buttons]}
        for name, values in row.items():
            self.rows[name].append(values)
        self.times.append(time)
        self._new = numpy.zeros(len(KINDS))

    def split(self, success):
        if not success:
            return "failure"
        return "recovery" if self.kinds & MISHAPS else "train"

    def columns(self):
        return {name: numpy.array(values, numpy.float32) for name, values in self.rows.items()}


class Reader:
    """Cuts a session into episodes, with frames at the times of steps."""

    def __init__(self, source, fps):
        missing = lacks(source)
        if missing:
            raise BagError("{}: has no {}, which lerobot needs; record a session with a scope, and with --record-all unless it is "
                           "compact".format(source.path, missing[0]))  # fmt: skip
        self._source, self._gap = source, 1e9 / fps
        self._names = {}
        for name in (*STATES, "applied_input", "trainee/progress", "procedure/events"):
            self._names.update({number: name for number in source.numbers_of(name)})
        self._has_goals = source.count("trainee/progress") > 0
        self._latest, self._run, self._due, self._episode = {}, None, 0, None

    def episodes(self, progress):
        """(episode, success)"""
        for message in self._source.messages(self._names, progress):
            name = self._names[message.number]
            if name == "trainee/progress":
                yield from self._goals(message.fields.goals)
            elif name == "procedure/events":
                if self._episode and message.fields.kind in KINDS:  # a newer release may have others
                    self._episode.event(message.fields.kind)
            elif name == "applied_input":
                yield from self._step(message)
            else:
                self._latest[name] = message
        yield from self._end(ProcedureEvent.CINCHED in self._episode.kinds if self._episode and not self._has_goals else False)

    def _goals(self, goals):
        ours = next((goal for goal in goals if self._episode and goal.id == self._episode.goal), None)
        if ours is not None and ours.state == GoalProgress.ACTIVE:
            return
        yield from self._end(ours is not None and ours.state == GoalProgress.REACHED)
        self._episode = next((Episode(goal.id, goal.goal) for goal in goals if goal.state == GoalProgress.ACTIVE), None)
        self._due = 0

    def _step(self, message):
        if self._run not in (None, message.fields.run):  # a reset, or another state or scene
            yield from self._end(False)
            self._due = 0
        self._run = message.fields.run
        if self._episode is None and not self._has_goals:
            self._episode = Episode(None, "Endoscopic suturing of the stomach")
        if self._episode and len(self._latest) == len(STATES) and message.time >= self._due - 1e3:
            self._due = max(self._due or message.time, message.time - self._gap) + self._gap
            self._episode.frame(message.time, self._latest, message.fields)

    def _end(self, success):
        ended, self._episode = self._episode, None
        if ended is None or not ended.times:
            return
        seconds, wanted = (ended.times[-1] - ended.times[0]) / 1e9, 1e9 / self._gap
        if len(ended.times) < 0.9 * seconds * wanted:
            raise BagError("{}: has {:.0f} steps per second, fewer than {:g} frames; give a lower --rate".format(
                self._source.path, len(ended.times) / seconds, wanted))  # fmt: skip
        yield ended, success


class Images:
    """What scripts/dataset wrote of a session."""

    def __init__(self, folder):
        from PIL import Image

        self._open, self._folder = Image.open, folder
        try:
            self._stamps = numpy.loadtxt(os.path.join(folder, "times.txt"), ndmin=2)[:, 1]
            self.shape = list(self._load(0).shape)
        except (OSError, ValueError) as error:
            raise BagError("--images: '{}' is no folder of scripts/dataset ({})".format(folder, error)) from None

    def _load(self, number):
        return numpy.asarray(self._open(os.path.join(self._folder, "image", "{:06d}.png".format(number))).convert("RGB"))

    def of(self, times, fps):
        """Those nearest to these times [ns], at most half a frame away."""
        seconds = numpy.array(times) / 1e9
        numbers = numpy.abs(self._stamps[None, :] - seconds[:, None]).argmin(axis=1)
        apart = numpy.abs(self._stamps[numbers] - seconds).max()
        if apart > 0.51 / fps:
            raise BagError("--images: '{}' has none within {:.3f} s of a frame; call scripts/dataset --rate {} --output DIR BAG".format(
                self._folder, apart, fps))  # fmt: skip
        return (self._load(number) for number in numbers)


def features_of(images):
    features = {name: {"dtype": "float32", "shape": [len(names)], "names": names} for name, names in NAMES.items()}
    if images:
        features[CAMERA] = {"dtype": "video", "shape": images.shape, "names": ["height", "width", "channels"]}
    return features


class DataSet:
    """In a folder that grows by whole episodes; sessions.csv says which are of which session."""

    def __init__(self, folder, arguments):
        try:
            import vibe
            from vibe.data import lerobot
        except ImportError as error:
            raise BagError("lerobot needs the Python module vibe ({}); build vibe_python: scripts/build --part python".format(error)) from None
        self.error = vibe.Error
        self._fps, self._folder, self._arguments = int(arguments.rate or FPS), folder, arguments
        self._images = Images(arguments.images) if arguments.images else None
        self._writer = lerobot.Writer(folder, version=arguments.lerobot_version, fps=self._fps, features=features_of(self._images))
        self._list = os.path.join(folder, "sessions.csv")
        with open(self._list, "a+", encoding="utf-8") as file:
            file.seek(0)
            self._done = [line.rsplit(",", 1) for line in file.read().splitlines()]

    def has(self, number):
        return number < len(self._done)

    def add(self, path, name, progress):
        """The next session. What of it was there before an interruption stays."""
        begin = int(self._done[-1][1]) if self._done else 0
        with Source(path, None, self._arguments.begin, self._arguments.end) as source:
            for number, (episode, success) in enumerate(Reader(source, self._fps).episodes(progress), begin):
                if number >= self._writer.episodes:
                    videos = {CAMERA: self._images.of(episode.times, self._fps)} if self._images else None
                    self._writer.add(episode.columns(), episode.task, videos, episode.split(success), success)
        self._done.append([name, str(self._writer.episodes)])
        with open(self._list, "a", encoding="utf-8") as file:
            file.write(",".join(self._done[-1]) + "\n")

    def finish(self):
        return "{} episodes".format(self._writer.episodes)
