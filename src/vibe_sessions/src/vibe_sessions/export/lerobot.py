"""A LeRobot data set of recordings: an episode for each goal of a trainee, or for each run that somebody else drove."""

from array import array

import numpy
from vibe_msgs.msg import GoalProgress, ProcedureEvent

from ..report.bag_file import BagError
from .pictures import Images, Recorded, topic_of
from .source import Source, in_order_of_stamps

FPS = 30
KINDS = dict(sorted((value, name) for name, value in vars(ProcedureEvent).items() if name.isupper() and isinstance(value, int)))
MISHAPS = {"GRAB_MISSED", "SLIP", "BITE_MISSED", "BITE_WITHDRAWN", "TEAR_OUT", "THREAD_BROKE", "CINCH_LOOSE", "DEEP_BURN",
           "BLEEDING_OVERDUE", "REJECTED"}  # fmt: skip
JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right", "helix_advance", "helix_rotation", "needle_driver"]
NAMES = {
    "observation.state": [*JOINTS, *(each + "_velocity" for each in JOINTS)],
    "observation.pose": ["x", "y", "z", "qx", "qy", "qz", "qw"],
    "observation.wrench": ["force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"],
    "observation.contacts": ["count", "normal_force", "force_x", "force_y", "force_z"],
    "observation.gas": ["pressure"],
    "observation.events": [name.lower() for name in KINDS.values()],
    "action": [*JOINTS, "argon", "helix", "needle", "t_tag", "cinch", "insufflate"],
}
STATES = ("scope/measured_js", "suturing_device/measured_js", "scope/measured_cp", "scope/measured_cf", "scope/contacts",
          "step_result")  # fmt: skip
CAMERA = "observation.images.endoscope"


def lacks(source):
    """Topics that it needs and a recording does not have."""
    return [name for name in ("applied_input", *STATES) if not source.count(name)]


def xyz(vector):
    return [vector.x, vector.y, vector.z]


class Episode:
    def __init__(self, goal, task):
        self.goal, self.task, self.kinds = goal, task, set()
        self.times, self._new = array("q"), [0] * len(KINDS)
        self._rows = {name: array("f") for name in NAMES}  # 300 bytes a row in all

    def event(self, kind):
        if kind in KINDS:  # a newer release may have others
            self.kinds.add(KINDS[kind])
            self._new[kind] += 1

    def frame(self, time, latest, step):
        scope, device, pose, wrench, contacts, result = (latest[name].fields for name in STATES)
        forces = numpy.array([xyz(each.force) for each in contacts.contacts]).reshape(-1, 3)
        pressing = sum(each.normal_force for each in contacts.contacts)
        row = ([*scope.position, *device.position, *scope.velocity, *device.velocity],
               [*xyz(pose.pose.position), *xyz(pose.pose.orientation), pose.pose.orientation.w],
               [*xyz(wrench.wrench.force), *xyz(wrench.wrench.torque)], [len(forces), pressing, *forces.sum(axis=0)],
               [result.pressure], self._new, [*step.joints, *step.buttons])  # fmt: skip
        for name, values in zip(NAMES, row):
            self._rows[name].extend(values)
        self.times.append(time)
        self._new = [0] * len(KINDS)

    def end(self):
        """What has happened since the last row is in that one, and not lost."""
        for kind, count in enumerate(self._new):
            self._rows["observation.events"][kind - len(self._new)] += count

    def split(self, success):
        return "failure" if not success else "recovery" if self.kinds & MISHAPS else "train"

    def columns(self):
        return {name: numpy.array(values).reshape(len(self.times), -1) for name, values in self._rows.items()}


class Reader:
    """Cuts a session into episodes, with frames at the times of steps."""

    def __init__(self, source, fps):
        missing = lacks(source)
        if missing:
            raise BagError("{}: has no {}, which lerobot needs; record a session with a scope, and with --record-all unless it is "
                           "compact".format(source.path, missing[0]))  # fmt: skip
        self._source, self._gap = source, 1e9 / fps
        ranks = {**dict.fromkeys(STATES, 0), "procedure/events": 1, "trainee/progress": 2, "applied_input": 3}  # at equal stamps
        self._ranks = {number: (rank, name) for name, rank in ranks.items() for number in source.of_one_simulator(name)}
        self._has_goals = source.count("trainee/progress") > 0
        self._latest, self._run, self._due, self._episode = {}, None, 0, None

    def episodes(self):
        """(episode, success)"""
        messages = self._source.messages(self._ranks)
        for message in in_order_of_stamps(messages, lambda each: self._ranks[each.number][0]):
            name = self._ranks[message.number][1]
            if name == "trainee/progress":
                yield from self._goals(message.fields.goals)
            elif name == "procedure/events" and self._episode:
                self._episode.event(message.fields.kind)
            elif name == "applied_input":
                yield from self._step(message)
            elif name in STATES:
                self._latest[name] = message
        yield from self._end(self._is_reached_later())

    def _is_reached_later(self):
        """Whether the goal that the end of the range cuts is reached after it."""
        if not self._episode or not self._source.cut or not self._has_goals:
            return False
        with Source(self._source.path) as whole:
            for message in whole.messages(whole.numbers_of("trainee/progress")):
                state = next((goal.state for goal in message.fields.goals if goal.id == self._episode.goal), None)
                if message.time > self._source.cut and state != GoalProgress.ACTIVE:
                    return state == GoalProgress.REACHED
        return False

    def _goals(self, goals):
        ours = next((goal for goal in goals if self._episode and goal.id == self._episode.goal), None)
        if ours is None or ours.state != GoalProgress.ACTIVE:
            yield from self._end(ours is not None and ours.state == GoalProgress.REACHED)
            self._episode = next((Episode(goal.id, goal.goal) for goal in goals if goal.state == GoalProgress.ACTIVE), None)
            self._due = 0

    def _step(self, message):
        run = message.fields.session, message.fields.run
        if self._run not in (None, run):  # a simulator that was started anew, a reset, another state or scene
            yield from self._end()
            self._due = 0
        self._run = run
        if self._episode is None and not self._has_goals:
            self._episode = Episode(None, "Endoscopic suturing of the stomach")
        is_known = len(self._latest) == len(STATES) and all(each.time <= message.time for each in self._latest.values())
        if self._episode and is_known and message.time >= self._due - 1e3:
            self._due = max(self._due or message.time, message.time - self._gap) + self._gap
            self._episode.frame(message.time, self._latest, message.fields)

    def _end(self, success=False):
        """Without goals success is a set that was cinched."""
        ended, self._episode = self._episode, None
        if ended and ended.times:
            ended.end()
            seconds = (ended.times[-1] - ended.times[0]) / 1e9
            if len(ended.times) < 0.9e9 * seconds / self._gap:
                raise BagError("{}: has {:.0f} steps per second, fewer than {:g} frames; give a lower --rate".format(
                    self._source.path, len(ended.times) / seconds, 1e9 / self._gap))  # fmt: skip
            yield ended, success or (not self._has_goals and "CINCHED" in ended.kinds)


class DataSet:
    """In a folder that is new or was begun by the same call. Whether it has pictures, and their size, says its first recording."""

    def __init__(self, folder, arguments, first):
        try:
            import vibe
            from vibe.data import lerobot
        except ImportError as error:
            raise BagError("lerobot needs the Python module vibe ({}); build it: scripts/build --part python".format(error)) from None
        self._error, self._fps = vibe.Error, int(arguments.rate or FPS)
        self._images = Images(arguments.images) if arguments.images else None
        shape = self._images.shape if self._images else Recorded(first).shape if topic_of(first) else None
        self._has_pictures = shape is not None
        features = {name: {"dtype": "float32", "shape": [len(names)], "names": names} for name, names in NAMES.items()}
        if shape:
            features[CAMERA] = {"dtype": "video", "shape": shape, "names": ["height", "width", "channels"]}
        try:
            self._writer = lerobot.Writer(folder, version=arguments.lerobot_version, fps=self._fps, features=features)
        except vibe.Error as error:
            raise BagError("lerobot: {}".format(error)) from None

    def add(self, source, before):
        """The episodes of a recording, of which some may be there already; `before` were there when it began. Returns how many
        there are then."""
        if not self._images and self._has_pictures != bool(topic_of(source)):
            raise BagError("{}: {} pictures of the endoscope, unlike the first recording; export them apart".format(
                source.path, "has no" if self._has_pictures else "has"))  # fmt: skip
        pictures = (self._images or Recorded(source)) if self._has_pictures else None
        try:
            for number, (episode, success) in enumerate(Reader(source, self._fps).episodes(), before):
                if number >= self._writer.episodes:
                    videos = {CAMERA: pictures.of(episode.times, self._fps)} if pictures else None
                    self._writer.add(episode.columns(), episode.task, videos, episode.split(success), success)
        except self._error as error:
            raise BagError(str(error)) from None
        return self._writer.episodes
