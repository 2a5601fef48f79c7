"""What a report needs of one recording: read in one pass, without building the messages that come with every step."""

import struct
from array import array
from dataclasses import dataclass, field

import numpy

from .bag_file import BagError, BagFile
from .message_types import StepReader, after_header, offset_of, parse, stamp_of
from .topics import INPUTS, choose_namespace, find_topics

# topics of which only the last message counts
NEWEST = ("procedure/skill_metrics", "trainee/progress", "session_info", "tissue/topology", "tissue/particles", "scene")
SAMPLES = 600  # of the threads, at most: a message has every point to draw
FIRST_WALL_TIME = 1e6  # stamps of simulated time begin at 1 s [s]


@dataclass
class Recording:
    path: str
    namespace: str = ""
    cut_reason: str = ""
    size: int = 0
    begin: int = 0  # stamp of the first step [ns]
    topics: list = field(default_factory=list)  # (name, type, messages)
    callers: dict = field(default_factory=dict)  # names of the nodes by input topic
    stamps: array = field(default_factory=lambda: array("q"))  # of applied_input [ns]
    steps: array = field(default_factory=lambda: array("Q"))
    runs: array = field(default_factory=lambda: array("L"))  # one more after each reset or load
    hashed_steps: int = 0
    inputs_have_hashes: bool = False
    states: list = field(default_factory=list)  # (stamp, phase, pressure, volume, blood lost)
    events: list = field(default_factory=list)  # (stamp, kind, particle, value, text)
    tip: array = field(default_factory=lambda: array("d"))  # stamp [ns], x, y, z
    force: array = field(default_factory=lambda: array("d"))  # stamp [ns], magnitude [N]
    tensions: list = field(default_factory=list)  # (stamp, largest tension of each set)
    max_tension: float = None  # of all messages [N]
    windows: list = field(default_factory=list)  # of solver_statistics
    delays: dict = field(default_factory=dict)  # of input topics: stamp to reception [s]
    lost: dict = field(default_factory=dict)  # messages missing by their sequence numbers
    frames: list = field(default_factory=lambda: [0, 0])  # of the camera: received, lost
    diagnostics: dict = field(default_factory=dict)  # last values by name
    state: object = None  # last messages
    skill: object = None
    sutures: object = None
    progress: object = None
    info: object = None
    topology: object = None
    particles: object = None
    scene: str = ""
    is_simulated_time: bool = True

    def seconds(self, stamp):
        return (stamp - self.begin) / 1e9

    def duration(self):
        period = self.state.step_period if self.state is not None else 1 / 60
        return self.seconds(self.stamps[-1]) + period

    def tip_path(self):
        """Rows of time since the first step [s], x, y, z [m]."""
        return self._since_begin(numpy.array(self.tip).reshape(-1, 4))

    def force_curve(self):
        """Rows of time since the first step [s] and magnitude [N]."""
        return self._since_begin(numpy.array(self.force).reshape(-1, 2))

    def _since_begin(self, samples):
        samples[:, 0] = (samples[:, 0] - self.begin) / 1e9
        return samples

    def has_all(self, topic):
        """Whether a topic of every step was recorded at its full rate."""
        return self.count(topic) >= 0.9 * len(self.steps)

    def count(self, topic):
        return sum(messages for name, _, messages in self.topics if name == self.namespace + "/" + topic)


def read_recording(path, namespace=None):
    """Reads a bag. Raises BagError with one sentence if there is nothing to report on."""
    with BagFile(path) as bag:
        return Reader(bag, choose_namespace(bag, namespace)).read()


class Reader:
    def __init__(self, bag, namespace):
        self._bag = bag
        self._topics = find_topics(bag, namespace)
        self._last = {}  # data of the last message by connection
        self._sequence = {}  # last sequence number by connection
        self._frame = None
        self._suture_count = 0
        self.recording = Recording(bag.path, namespace, bag.cut_reason, bag.size)

    def read(self):
        recording = self.recording
        totals = {}
        for key, connection in self._bag.connections.items():
            name = (connection.topic, connection.datatype)
            totals[name] = totals.get(name, 0) + self._bag.count(key)
        recording.topics = sorted((*name, count) for name, count in totals.items())
        self._check()
        handlers = self._handlers()
        for connection, received, data in self._bag.messages(handlers):
            handlers[connection](connection, received, data)
        self._finish()
        return recording

    def _check(self):
        if not self._topics["applied_input"]:
            raise self._no_steps()
        if not self._topics["scene"]:
            raise BagError(
                "{}: has no scene, so what was simulated is unknown; start the recorder before the simulator, or "
                "record the topic scene, too".format(self._bag.path)
            )

    def _no_steps(self):
        name = self._bag.path
        return BagError("{}: has not one step of the simulator; record from its start to its end".format(name))

    def _handlers(self):
        """Functions by connection: each chunk is read once, since decompressing it takes longest."""
        first = self._topics["applied_input"][0]
        self._steps = StepReader(self._bag.connections[first])
        self.recording.inputs_have_hashes = self._steps.has_hash
        table = {
            "applied_input": self._step,
            "procedure/state": self._state,
            "procedure/events": self._event,
            "solver_statistics": self._window,
            "sutures": self._sutures,
            "scope/measured_cp": self._tip,
            "scope/measured_cf": self._force,
            "overstitch/tracking": self._tracking,
            "/diagnostics": self._diagnostic,
            **{topic: self._input for topic in INPUTS},
            **{topic: self._keep for topic in NEWEST},
        }
        if not self._topics["scope/measured_cp"] or not self._topics["scope/measured_cf"]:
            table["step_result"] = self._result
        handlers = {}
        for short, handler in table.items():
            handlers.update({connection: handler for connection in self._topics[short]})
        return handlers

    def _step(self, _connection, _received, data):
        stamp, step, run, state_hash = self._steps.read(data)
        self.recording.stamps.append(stamp)
        self.recording.steps.append(step)
        self.recording.runs.append(run)
        self.recording.hashed_steps += state_hash != 0

    def _state(self, connection, _received, data):
        state = self.recording.state = parse(self._bag.connections[connection], data)
        self.recording.states.append(
            (state.header.stamp.to_nsec(), state.phase, state.pressure, state.volume, state.blood_lost)
        )

    def _event(self, connection, _received, data):
        event = parse(self._bag.connections[connection], data)
        self.recording.events.append(
            (event.header.stamp.to_nsec(), event.kind, event.particle, event.value, event.text)
        )

    def _window(self, connection, _received, data):
        self.recording.windows.append(parse(self._bag.connections[connection], data))

    def _keep(self, connection, _received, data):
        self._last[connection] = data

    def _sutures(self, connection, _received, data):
        self._last[connection] = data
        stride = max(1, self._bag.count(connection) // SAMPLES)
        self._suture_count += 1
        sutures = parse(self._bag.connections[connection], data)
        largest = [max(suture.tension, default=0.0) for suture in sutures.sutures]
        self.recording.max_tension = max([self.recording.max_tension or 0.0, *largest])
        if (self._suture_count - 1) % stride == 0:
            self.recording.tensions.append((sutures.header.stamp.to_nsec(), largest))

    def _tip(self, _connection, _received, data):
        self._add_tip(stamp_of(data)[1], struct.unpack_from("<3d", data, after_header(data)))

    def _force(self, _connection, _received, data):
        self._add_force(stamp_of(data)[1], struct.unpack_from("<3d", data, after_header(data)))

    def _add_tip(self, stamp, position):
        self.recording.tip.extend((stamp, *position))

    def _add_force(self, stamp, force):
        self.recording.force.extend((stamp, (force[0] ** 2 + force[1] ** 2 + force[2] ** 2) ** 0.5))

    def _result(self, connection, _received, data):
        """In place of the two topics above, where they were not recorded."""
        definition = self._bag.connections[connection].definition
        stamp, body = stamp_of(data)[1], after_header(data)
        for topic, name, add in (
            ("scope/measured_cp", "tip", self._add_tip),
            ("scope/measured_cf", "wrench", self._add_force),
        ):
            if not self._topics[topic]:
                add(stamp, struct.unpack_from("<3d", data, body + offset_of(definition, name)))

    def _input(self, connection, received, data):
        topic = self._bag.connections[connection].topic
        sequence, stamp = stamp_of(data)
        if stamp > 0:
            self.recording.delays.setdefault(topic, array("d")).append((received - stamp) / 1e9)
        before = self._sequence.get(connection)
        if before is not None and sequence > before + 1:
            self.recording.lost[topic] = self.recording.lost.get(topic, 0) + sequence - before - 1
        self._sequence[connection] = sequence

    def _tracking(self, _connection, _received, data):
        (frame,) = struct.unpack_from("<Q", data, after_header(data))
        if self._frame is None or frame > self._frame:
            self.recording.frames[0] += 1
            self.recording.frames[1] += 0 if self._frame is None else frame - self._frame - 1
        self._frame = frame

    def _diagnostic(self, connection, _received, data):
        for status in parse(self._bag.connections[connection], data).status:
            self.recording.diagnostics[status.name] = {pair.key: pair.value for pair in status.values}

    def _finish(self):
        recording = self.recording
        if not recording.steps:
            raise self._no_steps()
        recording.begin = recording.stamps[0]
        recording.skill = self._newest("procedure/skill_metrics")
        recording.sutures = self._newest("sutures")
        recording.progress = self._newest("trainee/progress")
        recording.info = self._newest("session_info")
        recording.topology = self._newest("tissue/topology")
        recording.particles = self._newest("tissue/particles")
        scene = self._newest("scene")
        recording.scene = scene.data if scene is not None else ""
        for topic in INPUTS:
            names = sorted({self._bag.connections[c].caller for c in self._topics[topic]} - {""})
            if names:
                recording.callers[topic] = names
        recording.is_simulated_time = bool(self._topics["/clock"]) or recording.begin / 1e9 < FIRST_WALL_TIME

    def _newest(self, short):
        for connection in reversed(self._topics[short]):
            if connection in self._last:
                return parse(self._bag.connections[connection], self._last[connection])
        return None
