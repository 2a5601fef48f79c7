"""The messages of a recording that are asked for, in the order of their reception."""

import difflib
import fnmatch
import functools
import heapq
import re
import struct
import sys
import time

import genpy

from ..report.bag_file import BagError, BagFile
from ..report.message_types import has_its_definition, parse, stamp_of

# sent on change, and needed to understand the rest at any time
ALWAYS = ("scene", "session_info", "tissue/topology", "trainee/progress")
LATEST = 3  # [s]; a recorder that stands still for longer mixes times
WHOLE = ("vibe_msgs/ProcedureEvent", "rosgraph_msgs/Log", "tf2_msgs/TFMessage")  # types of which a rate leaves none out


def fits(topic, patterns):
    """Whether a name, or the end of it, is one of these."""
    return any(fnmatch.fnmatchcase("/" + topic.lstrip("/"), "*/" + pattern.lstrip("/")) for pattern in patterns)


def in_order_of_stamps(messages, rank):
    """What belongs to one time together, although it was received up to LATEST seconds apart: a simulator stamps the input of
    a step with its begin and sends it after it, and a session that is filled has repeated topics beside others that
    have the times of the recorder. At equal stamps the lower rank(message) comes first. Where the stamps of a topic go back,
    time was set back, and what came before is given first."""
    waiting, newest, last = [], 0, {}
    for count, message in enumerate(messages):
        topic = message.connection.topic
        if message.time < last.get(topic, 0):
            yield from (each[-1] for each in sorted(waiting))
            waiting, newest, last = [], 0, {}
        last[topic] = message.time
        heapq.heappush(waiting, (message.time, rank(message), count, message))
        newest = max(newest, message.time)
        while waiting[0][0] < newest - 1e9 * LATEST:
            yield heapq.heappop(waiting)[-1]
    yield from (each[-1] for each in sorted(waiting))


@functools.lru_cache(maxsize=None)
def has_header(definition):
    return bool(re.match(r"(\s*#[^\n]*\n|\s*\n)*\s*(std_msgs/)?Header\s+\w+", definition))


class Message:
    """One message, which is parsed where somebody asks for its fields."""

    def __init__(self, source, number, received, data):
        self._source, self.data = source, data
        self.number, self.connection, self.received = number, source.bag.connections[number], received  # [ns]
        self.stamp = stamp_of(data)[1] if has_header(self.connection.definition) else received  # [ns]; 0 says: invalid
        self.time = self.stamp or received  # [ns]

    @functools.cached_property
    def fields(self):
        try:
            return parse(self.connection, self.data)
        except (struct.error, genpy.DeserializationError, ValueError) as error:
            raise self._source.damaged(self.connection, self.received, error) from None


class Source:
    """A recording that was closed. `topics`: patterns of names with or without namespace, None: all; from `begin` to `end`
    [s of its stamps]; at most `rate` messages of a topic per second, None: all. Raises BagError."""

    def __init__(self, path, topics=None, begin=None, end=None, rate=None):
        self.path, self.bag = path, BagFile(path)
        self._begin, self._gap = 1e9 * (begin or 0), 1e9 / rate if rate else 0  # [ns]
        self.cut = 1e9 * end if end else None  # where it ends before the recording does [ns]
        self._always, self.chosen = set(self.numbers_of(*ALWAYS)), set(self.numbers_of(*(topics or ["*"])))
        unknown = [pattern for pattern in topics or () if not self.numbers_of(pattern)]
        problem = self._unknown(unknown[0]) if unknown else ""
        if self.bag.cut_reason:
            problem = self.bag.cut_reason.rstrip(".") + "; `rosbag reindex` mends it"
        if problem:
            self.__exit__()
            raise BagError("{}: {}".format(path, problem))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bag.__exit__()

    def _unknown(self, pattern):
        names = [each.topic.lstrip("/") for each in self.bag.connections.values()]
        near = difflib.get_close_matches(pattern.lstrip("/"), names, 1, 0)
        return (
            "has no topic '{}'; the nearest is '{}' (`rosbag info` lists all; --fill adds those that a compact recording leaves "
            "out)".format(pattern, *near or ["none"])
        )

    def numbers_of(self, *names):
        """Connections whose topics end so."""
        return [number for number, each in self.bag.connections.items() if fits(each.topic, names)]

    def of_one_simulator(self, name):
        """Connections of a topic that only one namespace may have."""
        numbers = self.numbers_of(name)
        topics = sorted({self.bag.connections[number].topic for number in numbers})
        if len(topics) > 1:
            raise BagError("{}: has two simulators ({} and {}), and this format holds one; take one of them out, for example with "
                           "`rosbag filter`".format(self.path, *topics[:2]))  # fmt: skip
        return numbers

    def count(self, name):
        return sum(self.bag.count(number) for number in self.numbers_of(name))

    def is_compact(self):
        return self.count("step_result") < 0.9 * self.count("applied_input")

    def messages(self, wanted):
        """Those of some connections; on a terminal a line says how far it is. Raises BagError where one cannot be read."""
        total, due, seen, said = sum(self.bag.count(number) for number in wanted), {}, set(), 0
        is_shown = sys.stderr.isatty()
        for done, (number, received, data) in enumerate(self.bag.in_time(wanted), 1):
            connection = self.bag.connections[number]
            if number not in seen and not has_its_definition(connection):
                raise BagError("{}: the definition of {} is not that of its MD5 sum; it may have been edited or damaged, so take the "
                               "recording as it was".format(self.path, connection.datatype))  # fmt: skip
            seen.add(number)
            try:
                message = Message(self, number, received, data)
            except struct.error as error:
                raise self.damaged(connection, received, error) from None
            if self._is_wanted(message, due):
                yield message
            if is_shown and (time.monotonic() - said > 0.2 or done == total):
                said = time.monotonic()
                print("\r\033[K{} {} %".format(self.path, 100 * done // total), end="" if done < total else "\r\033[K", file=sys.stderr)

    def damaged(self, connection, received, error):
        return BagError(
            "{}: a message of {} at {:.3f} s does not fit its definition ({}); the recording may have been edited or damaged, "
            "so copy it again".format(self.path, connection.topic, 1e-9 * received, error)
        )

    def _is_wanted(self, message, due):
        if self.cut is not None and message.time > self.cut:
            return False
        if message.number in self._always:
            return True
        if message.time < self._begin:
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
