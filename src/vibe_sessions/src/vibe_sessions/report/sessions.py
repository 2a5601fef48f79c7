"""The sessions of a recording: a simulator that was started again, or several in namespaces, each with an identity.

Most topics carry no identity. What was received between two messages with one belongs to the session of the first, since
a simulator that is started again under its name sends nothing before the former one has ended.
"""

import struct
from array import array
from bisect import bisect_left
from dataclasses import dataclass, field

from .bag_file import BagError
from .message_types import StepReader
from .topics import find_topics, namespaces_of, quoted, without_slash

IDENTITY = struct.Struct("<Q")


def identity_of(connection, data):
    """0 in a message of an older release. The field is the last one."""
    return IDENTITY.unpack_from(data, len(data) - 8)[0] if "\nuint64 session\n" in connection.definition else 0


@dataclass
class Session:
    namespace: str
    identity: int = 0
    steps: int = 0
    seen: dict = field(default_factory=dict)  # (stamp, hash) by (run, step) of a session without identity
    stamps: array = field(default_factory=lambda: array("q"))  # of its steps [ns]

    def name(self):
        identity = "{:016x}".format(self.identity) if self.identity else "without identity"
        return "{} in {}".format(identity, self.namespace or "/")


class SessionTracker:
    """Which session of a namespace the messages belong to that are received now."""

    def __init__(self, namespace):
        self.namespace = namespace
        self.sessions = []
        self.alternate = False  # messages of one came after those of the next
        self.current = None

    def identify(self, identity):
        """A message with this identity."""
        if self.current is not None and self.current.identity == identity:
            return
        before = next((each for each in self.sessions if each.identity == identity), None)
        self.alternate |= before is not None
        self.current = before or self._begin(identity)

    def step(self, identity, run, step, content):
        """`content`: stamp and hash of the state"""
        if identity:
            self.identify(identity)
        elif self.current is None:
            self._begin(0)
        else:
            self._step_again(run, step, content)
        if not identity:
            self.current.seen[(run, step)] = content
        self.current.steps += 1
        self.current.stamps.append(content[0])

    def _step_again(self, run, step, content):
        """Of an older release, in which a session begins with a step 0 that has been there; a reset begins another run."""
        before = self.current.seen.get((run, step)) if run else None
        if before is not None and step == 0:
            self._begin(0)
        elif before is not None and before != content:
            self.alternate = True

    def _begin(self, identity):
        self.current = Session(self.namespace, identity)
        self.sessions.append(self.current)
        return self.current


def list_sessions(bag):
    """All sessions with steps; by the time of their start where they have an identity, which begins with it."""
    found = []
    for namespace in namespaces_of(bag):
        tracker = SessionTracker(namespace)
        topics = find_topics(bag, namespace)["applied_input"]
        readers = {connection: StepReader(bag.connections[connection]) for connection in topics}
        for connection, _received, data in bag.messages(readers):
            stamp, step, run, state_hash = readers[connection].read(data)
            tracker.step(identity_of(bag.connections[connection], data), run, step, (stamp, state_hash))
        found += tracker.sessions
    return sorted(found, key=lambda session: session.identity)


class StampOwners:
    """Which of several sessions a message without identity belongs to, by its stamp: that of the only session with a step
    that began or ended then."""

    NEAR = 2000  # [ns]

    def __init__(self, sessions):
        self._moments = [(session.identity, self._moments_of(session.stamps)) for session in sessions]

    def identity_at(self, stamp):
        """0 if no session has such a step, or several have."""
        owners = [identity for identity, moments in self._moments if self._has(moments, stamp)]
        return owners[0] if len(owners) == 1 else 0

    def _moments_of(self, stamps):
        moments = sorted(stamps)
        return moments + [2 * moments[-1] - moments[-2]] if len(moments) > 1 else moments

    def _has(self, moments, stamp):
        place = bisect_left(moments, stamp - self.NEAR)
        return place < len(moments) and moments[place] <= stamp + self.NEAR


def choose_session(bag, namespace=None, session=None, read=False):
    """(all sessions, number of the chosen one, from 0); without `read` the list is empty where the first of the only
    namespace is meant, which needs no reading. Raises BagError if there is none such."""
    names = namespaces_of(bag)
    if not names:
        others = sorted(connection.topic for connection in bag.connections.values())
        what = "only {}".format(", ".join(others[:3]) + (", ..." if len(others) > 3 else "")) if others else "no message"
        raise BagError(
            "{}: has no topic applied_input of this simulator, but {}; give a recording of scripts/run or scripts/record, "
            "and if topics were chosen, keep applied_input".format(bag.path, what)
        )
    asked = None if namespace is None else without_slash(namespace)
    if asked is not None and asked not in names:
        raise BagError("{}: has no session in '{}', but in {}".format(bag.path, asked, quoted(names)))
    if session is None and len(names) == 1 and not read:
        return [], 0
    sessions = list_sessions(bag)
    fitting = [
        number for number, each in enumerate(sessions)
        if asked in (None, each.namespace) and is_meant(each, number, session)
    ]  # fmt: skip
    if not fitting:
        listed = ", ".join("{} ({})".format(number + 1, each.name()) for number, each in enumerate(sessions))
        what = "session '{}'".format(session) if session is not None else "step"
        what += " in '{}'".format(asked or "/") if asked is not None else ""
        raise BagError("{}: has no {}, but {}; choose one of them".format(bag.path, what, listed or "no session at all"))
    return sessions, fitting[0]


def is_meant(session, number, words):
    """Whether these words are its number, or the beginning of its identity."""
    if words is None or words == str(number + 1):
        return True
    return session.identity != 0 and len(words) >= 4 and "{:016x}".format(session.identity).startswith(words)
