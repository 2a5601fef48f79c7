"""What a report needs of one recording: read in one pass, without building the messages that come with every step."""

import struct
from array import array
from collections import Counter
from dataclasses import dataclass, field

import numpy

from .bag_file import BagError, BagFile
from .message_types import StepReader, after_header, offset_of, parse, stamp_of
from .sessions import SessionTracker, StampOwners, choose_session, identity_of
from .topics import INPUTS, find_topics, namespaces_of

# topics of which only the last message counts, and the fields that keep it
NEWEST = {"procedure/skill_metrics": "skill", "trainee/progress": "progress", "session_info": "info",
          "tissue/topology": "topology", "tissue/particles": "particles"}  # fmt: skip
SAMPLES = 600  # of the threads, at most: a message has every point to draw
FIRST_WALL_TIME = 1e6  # stamps of simulated time begin at 1 s [s]


@dataclass
class Recording:
    path: str
    namespace: str = ""
    cut_reason: str = ""
    size: int = 0
    identity: int = 0  # of the session; 0: of a release without them
    remark: str = ""  # that there are other sessions, as a sentence
    begin: int = 0  # stamp of the first step [ns]
    topics: list = field(default_factory=list)  # (name, type, messages)
    callers: dict = field(default_factory=dict)  # names of the nodes by input topic
    stamps: array = field(default_factory=lambda: array("q"))  # of applied_input [ns]
    steps: array = field(default_factory=lambda: array("Q"))
    runs: array = field(default_factory=lambda: array("L"))  # one more after each reset or load
    doubled: int = 0  # steps that were recorded twice, which count once
    hashes: array = field(default_factory=lambda: array("B"))  # 1 for steps that have one
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

    def resets(self):
        """Times since the first step at which another run begins [s]: there the scope jumps."""
        runs = numpy.array(self.runs)
        return [self.seconds(self.stamps[k + 1]) for k in numpy.flatnonzero(numpy.diff(runs))]

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


def read_recording(path, namespace=None, session=None):
    """Reads one session of a bag, by default the first. Raises BagError with one sentence if there is nothing to report
    on."""
    with BagFile(path) as bag:
        try:
            return reader_of(bag, *choose_session(bag, namespace, session)).read()
        except SessionsAlternate:
            return reader_of(bag, *choose_session(bag, namespace, session, read=True), StampReader).read()


def reader_of(bag, sessions, chosen, kind=None):
    if not sessions:
        return Reader(bag, namespaces_of(bag)[0])
    target = sessions[chosen]
    in_namespace = [each for each in sessions if each.namespace == target.namespace]
    kind = kind or Reader
    return kind(bag, target.namespace, target.identity, in_namespace.index(target), sessions, chosen)


class SessionsAlternate(Exception):
    """Messages of sessions in one namespace come in turns, so that their order does not tell whose they are."""


class Reader:
    def __init__(self, bag, namespace, identity=0, number=0, sessions=(), chosen=0):
        """`identity` of the session, or, where it has none, its number in the namespace, from 0; `sessions`: all, if they
        are known already, and the number of this one among them"""
        self._bag = bag
        self._tracker = SessionTracker(namespace)
        self._identity, self._number, self._sessions, self._chosen = identity, number, sessions, chosen
        self._counts = {}  # of messages of the session by connection
        self._topics = find_topics(bag, namespace)
        self._last = {}  # data of the last message by connection
        self._sequence = {}  # last sequence number by connection
        self._frame = None
        self._suture_count = 0
        self.recording = Recording(bag.path, namespace, bag.cut_reason, bag.size)

    def read(self):
        recording = self.recording
        self._count_topics(self._bag.count)
        self._check()
        handlers = self._handlers()
        for connection, received, data in self._bag.messages(handlers):
            if self._is_ours(connection, data):
                handlers[connection](connection, received, data)
        self._finish()
        return recording

    def _count_topics(self, count):
        totals = Counter()
        for key, connection in self._bag.connections.items():
            totals[(connection.topic, connection.datatype)] += count(key)
        self.recording.topics = sorted((*name, messages) for name, messages in totals.items())

    def _is_ours(self, connection, data):
        """Whether a message belongs to the session; the first of the namespace if no identity is asked for."""
        tracker, about = self._tracker, self._bag.connections[connection]
        if connection in self._topics["applied_input"]:
            reader = self._steps if connection == self._first else StepReader(about)
            stamp, step, run, state_hash = reader.read(data)
            tracker.step(identity_of(about, data), run, step, (stamp, state_hash))
        elif connection in self._topics["session_info"] and identity_of(about, data):
            tracker.identify(identity_of(about, data))
        if tracker.alternate:
            raise SessionsAlternate
        current = tracker.current
        if current is None:
            ours = self._number == 0  # what comes before the first identity, such as a latched scene
        elif self._identity:
            ours = current.identity == self._identity
        else:
            ours = current is tracker.sessions[min(self._number, len(tracker.sessions) - 1)]
            ours &= len(tracker.sessions) > self._number
        if ours:
            self._counts[connection] = self._counts.get(connection, 0) + 1
        elif connection in self._topics["tissue/topology"] and not self._counts.get(connection):
            self._last[connection] = data  # latched; it may have come a moment before the first identity
        return ours

    def _check(self):
        if not self._topics["applied_input"]:
            raise self._no_steps()
        if not self._topics["scene"] and not self._topics["session_info"]:
            raise BagError(
                "{}: has no scene, so what was simulated is unknown: neither the topic scene nor session_info, which are "
                "sent when a session begins; if it was filtered, keep them, and if it is a part of a split recording, "
                "report on the first part".format(self._bag.path)
            )

    def _no_steps(self):
        name = self._bag.path
        return BagError("{}: has not one step of the simulator; record from its start to its end".format(name))

    def _handlers(self):
        """Functions by connection: each chunk is read once, since decompressing it takes longest."""
        self._first = self._topics["applied_input"][0]
        self._steps = StepReader(self._bag.connections[self._first])
        self.recording.inputs_have_hashes = self._steps.has_hash
        table = {
            "applied_input": self._step,
            "procedure/state": self._state,
            "procedure/events": self._event,
            "solver_statistics": self._window,
            "sutures": self._sutures,
            "scope/measured_cp": self._tip,
            "scope/measured_cf": self._force,
            "suturing_device/tracking": self._tracking,
            "/diagnostics": self._diagnostic,
            **{topic: self._input for topic in INPUTS},
            **{topic: self._keep for topic in (*NEWEST, "scene")},
        }
        if not self._topics["scope/measured_cp"] or not self._topics["scope/measured_cf"]:
            table["step_result"] = self._result
        handlers = {}
        for short, handler in table.items():
            handlers.update({connection: handler for connection in self._topics[short]})
        self._handled = set(handlers)
        return handlers

    def _step(self, _connection, _received, data):
        stamp, step, run, state_hash = self._steps.read(data)
        self.recording.stamps.append(stamp)
        self.recording.steps.append(step)
        self.recording.runs.append(run)
        self.recording.hashes.append(state_hash != 0)

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
        self._tell_sessions()
        self._sort_steps()
        recording.begin = recording.stamps[0]
        for topic, name in {**NEWEST, "sutures": "sutures"}.items():
            setattr(recording, name, self._newest(topic))
        scene = self._newest("scene")
        recording.scene = scene.data if scene is not None else ""
        if recording.info is not None and recording.info.scene:
            recording.scene = recording.info.scene
        for topic in INPUTS:
            names = sorted({self._bag.connections[c].caller for c in self._topics[topic]} - {""})
            if names:
                recording.callers[topic] = names
        recording.is_simulated_time = bool(self._topics["/clock"]) or recording.begin / 1e9 < FIRST_WALL_TIME

    def _sort_steps(self):
        """Steps that were received twice count once, as in bags that were merged; those of a release without runs stay."""
        recording = self.recording
        runs, steps = (numpy.frombuffer(column, column.typecode) for column in (recording.runs, recording.steps))
        order = numpy.lexsort((steps, runs))  # of equal ones the first comes first
        is_first = numpy.ones(len(order), bool)
        is_first[1:] = (numpy.diff(runs[order]) != 0) | (numpy.diff(steps[order]) != 0)
        if not runs.all() or is_first.all():
            return
        order = order[is_first]
        recording.doubled = len(runs) - len(order)
        for name in ("stamps", "steps", "runs", "hashes"):
            column = getattr(recording, name)
            setattr(recording, name, array(column.typecode, numpy.frombuffer(column, column.typecode)[order].tobytes()))

    def _tell_sessions(self):
        tracker, recording = self._tracker, self.recording
        ours = self._sessions[self._chosen] if self._sessions else tracker.sessions[self._number]
        sessions = self._sessions or tracker.sessions
        recording.identity = ours.identity
        if len(sessions) == 1:
            return
        recording.remark = (
            "The recording holds {} sessions; this is number {} ({}). --session and --namespace choose another.".format(
                len(sessions), self._chosen + 1, ours.name()
            )
        )
        self._count_topics(lambda key: self._counts.get(key, 0) if key in self._handled else self._bag.count(key))

    def _newest(self, short):
        for connection in reversed(self._topics[short]):
            if connection in self._last:
                return parse(self._bag.connections[connection], self._last[connection])
        return None


class StampReader(Reader):
    """Of a bag in which sessions alternate: what has neither an identity nor a stamp that only one session has is left
    out."""

    def __init__(self, bag, namespace, identity, number, sessions, chosen):
        super().__init__(bag, namespace, identity, number, sessions, chosen)
        rivals = [each for each in sessions if each.namespace == namespace]
        if not all(each.identity for each in rivals):
            raise BagError(
                "{}: has steps of several sessions in '{}' in turns, and they have no identity, as in recordings of an older "
                "release, so they cannot be told apart; it may have been merged, or sorted by simulated time; report on the "
                "recordings as they were".format(bag.path, namespace or "/")
            )
        self._owners = StampOwners(rivals)
        self._left_out = 0

    def _is_ours(self, connection, data):
        about = self._bag.connections[connection]
        owner = identity_of(about, data)
        if not owner and "\nHeader header\n" in "\n" + about.definition.replace("std_msgs/", ""):
            owner = self._owners.identity_at(stamp_of(data)[1])
        self._left_out += not owner
        if owner == self._identity:
            self._counts[connection] = self._counts.get(connection, 0) + 1
        return owner == self._identity

    def _tell_sessions(self):
        super()._tell_sessions()
        if self._left_out:
            self.recording.remark += (
                " Messages of sessions in the namespace '{}' come in turns, and {} of them say neither by identity nor by stamp "
                "whose they are; they are left out, so measures, drawings and curves may lack them.".format(
                    self.recording.namespace or "/", self._left_out
                )
            )
