"""The messages of a recording that are asked for, in the order of their reception."""

import difflib
import fnmatch
import functools
import re
import struct

import genpy

from ..report.bag_file import BagError, BagFile
from ..report.message_types import has_its_definition, parse, stamp_of

# sent on change, and needed to understand the rest at any time
ALWAYS = ("scene", "session_info", "tissue/topology", "trainee/progress")
WHOLE = ("vibe_msgs/ProcedureEvent", "rosgraph_msgs/Log", "tf2_msgs/TFMessage")  # types of which a rate leaves none out


class Message:
    """One message, which is parsed where somebody asks for its fields."""

    def __init__(self, source, number, received, data):
        self._source, self.connection, self.number = source, source.bag.connections[number], number
        self.received, self.data = received, data  # [ns], bytes
        self.stamp = stamp_of(data)[1] if has_header(self.connection.definition) else 0  # [ns]; 0: none
        self.time = self.stamp or received  # [ns]

    @functools.cached_property
    def fields(self):
        try:
            return parse(self.connection, self.data)
        except (struct.error, genpy.DeserializationError, ValueError) as error:
            raise self._source.damaged(self.connection, self.received, error) from None


@functools.lru_cache(maxsize=None)
def has_header(definition):
    return bool(re.match(r"(\s*#[^\n]*\n|\s*\n)*\s*(std_msgs/)?Header\s+\w+", definition))


class Source:
    """A recording that was closed. `topics`: patterns of names with or without namespace, None: all; from `begin` to `end`
    [s of its stamps]; at most `rate` messages of a topic per second, 0: all. Raises BagError."""

    def __init__(self, path, topics=None, begin=None, end=None, rate=0):
        self.path = path
        self.bag = BagFile(path)
        try:
            self._choose(topics)
        except BagError:
            self.bag.__exit__()
            raise
        self._begin, self._end = 1e9 * (begin or 0), 1e9 * (end if end is not None else 1e10)
        self._gap = 1e9 / rate if rate else 0  # [ns]

    def _choose(self, topics):
        if self.bag.cut_reason:
            raise BagError("{}: {} `rosbag reindex` mends it".format(self.path, self.bag.cut_reason.rstrip(".") + ";"))
        self.chosen = {n for n, each in self.bag.connections.items() if topics is None or fits(each.topic, topics)}
        self._always = set(self.numbers_of(*ALWAYS))
        for pattern in topics or ():
            if not any(fits(self.bag.connections[number].topic, [pattern]) for number in self.chosen):
                raise BagError(self._unknown(pattern))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bag.__exit__()

    def _unknown(self, pattern):
        names = sorted({each.topic.lstrip("/") for each in self.bag.connections.values()})
        near = difflib.get_close_matches(pattern.lstrip("/"), names, 1, 0.3) or names[:1]
        return (
            "{}: has no topic '{}'; the nearest is '{}' (`rosbag info` lists all; --fill adds those that a compact recording "
            "leaves out)".format(self.path, pattern, *near or ["none"])
        )

    def numbers_of(self, *names):
        """Connections whose topics end so."""
        return [number for number, each in self.bag.connections.items() if fits(each.topic, names)]

    def count(self, name):
        return sum(self.bag.count(number) for number in self.numbers_of(name))

    def messages(self, wanted, progress=lambda share: None):
        """Those of some connections. Raises BagError where one cannot be read."""
        total, done, due, seen = sum(self.bag.count(number) for number in wanted), 0, {}, set()
        for number, received, data in self.bag.in_time(wanted):
            done += 1
            progress(done / total)
            if number not in seen and not has_its_definition(self.bag.connections[number]):
                raise BagError("{}: the definition of {} is not that of its MD5 sum; it may have been edited or damaged, so take the "
                               "recording as it was".format(self.path, self.bag.connections[number].datatype))  # fmt: skip
            seen.add(number)
            try:
                message = Message(self, number, received, data)
            except struct.error as error:
                raise self.damaged(self.bag.connections[number], received, error) from None
            if self._is_wanted(message, due):
                yield message

    def damaged(self, connection, received, error):
        return BagError(
            "{}: a message of {} at {:.3f} s does not fit its definition ({}); the recording may have been edited or damaged, "
            "so copy it again".format(self.path, connection.topic, 1e-9 * received, error)
        )

    def _is_wanted(self, message, due):
        if message.number in self._always and message.time <= self._end:
            return True
        if not self._begin <= message.time <= self._end:
            return False
        if not self._gap or message.connection.datatype in WHOLE:
            return True
        next_time = due.get(message.number, message.time)
        if next_time - self._gap > message.time:  # time was set back
            next_time = message.time
        if message.time < next_time - 1e3:
            return False
        due[message.number] = max(next_time, message.time - self._gap) + self._gap
        return True


def fits(topic, patterns):
    """Whether a name, or the end of it, is one of these."""
    whole = "/" + topic.lstrip("/")
    return any(fnmatch.fnmatchcase(whole, "*/" + pattern.lstrip("/")) for pattern in patterns)
