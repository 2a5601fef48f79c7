"""Recorded motions as series of numbers: the columns of a CSV, or the fields of messages in a bag."""
import csv
import decimal

import numpy

from vibe_sessions.headless import SessionError
from vibe_sessions.report.bag_file import BagError, BagFile
from vibe_sessions.report.message_types import parse
from vibe_sessions.yaml_file import nearest

LARGEST = 1e17  # of values, and of times [ns]
GAP = 0.5  # between two values, and longer than five usual ones, is worth a sentence [s]


def number(text):
    try:
        return float(text)
    except ValueError:
        return float("nan")


def since_first(texts, factor):
    """[ns] of times since 1970 too, of which a float would lose the last digits."""
    times, first = [], None
    for text in texts:
        try:
            time = decimal.Decimal(text.strip())
            first = time if first is None and time.is_finite() else first
            times.append(float((time - first) * decimal.Decimal(repr(factor)) * 10**9))
        except (decimal.DecimalException, TypeError):
            times.append(float("nan"))
    return numpy.array(times)


class CsvMotion:
    """Columns with names in the first line, one of which is the time."""

    def __init__(self, path, time):
        """time: Source"""
        try:
            with open(path, encoding="utf-8-sig", newline="") as stream:
                first = stream.readline()
                stream.seek(0)
                delimiter = max(",;\t", key=first.count)
                rows = [row for row in csv.reader(stream, delimiter=delimiter) if any(map(str.strip, row))]
        except OSError as error:
            raise SessionError(f"'{path}' cannot be read: {error.strerror}.") from None
        except (UnicodeDecodeError, csv.Error) as error:
            raise SessionError(f"'{path}' is not a table of text: {error}.") from None
        if len(rows) < 3:
            raise SessionError(f"'{path}' has {max(len(rows) - 1, 0)} rows of values; it takes a line of names and at least two.")
        self.names = [name.strip() for name in rows[0]]
        if len(set(self.names)) < len(self.names):
            raise SessionError(f"'{path}' has two columns of the same name; rename one of them.")
        width, self.path, self._used = len(self.names), path, set()
        short = [k for k, row in enumerate(rows, 1) if len(row) != width]
        self.notes = [f"{len(short)} lines have not as many cells as there are columns, the first of them line {short[0]}; what "
                      "they lack counts as no number."] if short else []
        self._cells = numpy.array([row[:width] + [""] * (width - len(row)) for row in rows[1:]], dtype=object)
        self._times = since_first(self._column(time.column), time.factor)

    def _column(self, name):
        if name not in self.names:
            raise SessionError(f"'{self.path}' has no column '{name}'" + nearest(name, self.names))
        self._used.add(name)
        return self._cells[:, self.names.index(name)]

    def series(self, name):
        """(times [ns], values) of a column, as they are in the file."""
        return self._times, numpy.array([number(cell) for cell in self._column(name)])

    def unused(self):
        return [f"The column '{name}' is not used." for name in self.names if name not in self._used]


class BagMotion:
    """Fields of messages, named TOPIC/FIELD/..., TOPIC/JOINT of a sensor_msgs/JointState, TOPIC/axes/0 of an array. Times
    are the stamps of the messages, of those without one when they were received."""

    def __init__(self, path, _):
        self.path, self.notes, self._used, self._joints, self._first = path, [], set(), {}, None
        try:
            with BagFile(path) as bag:
                self._connections = bag.connections
                self.notes += [bag.cut_reason] if bag.cut_reason else []
        except BagError as error:
            raise SessionError(f"{error}.") from None

    def _topic_of(self, name):
        topics = {connection.topic for connection in self._connections.values()}
        found = [topic for topic in topics if name.startswith(topic + "/")]
        if not found:
            raise SessionError(f"'{self.path}' has no topic for '{name}'" + nearest(name, topics or {"none"}))
        return max(found, key=len)

    def series(self, name):
        """(times [ns], values) of a field."""
        topic = self._topic_of(name)
        parts = name[len(topic) + 1:].split("/")
        wanted = {key for key, connection in self._connections.items() if connection.topic == topic}
        times, values = [], []
        try:
            with BagFile(self.path) as bag:
                for key, time, data in bag.messages(wanted):
                    message = self._parse(self._connections[key], data)
                    stamp = message.header.stamp.to_nsec() if hasattr(message, "header") else 0
                    self._first = self._first or stamp or time
                    times.append(float((stamp or time) - self._first))
                    values.append(self._value(message, parts, topic))
        except BagError as error:
            raise SessionError(f"{error}.") from None
        self._used.add(topic)
        there = self._joints.get(topic, (parts[:1], None))[0]
        if parts[0] not in there:
            raise SessionError(f"No message on '{topic}' has the joint '{parts[0]}'" + nearest(parts[0], there or {"none"}))
        return numpy.array(times), numpy.array(values)

    def _parse(self, connection, data):
        try:
            return parse(connection, data)
        except Exception as error:  # pylint: disable=broad-except  # of a damaged definition anything
            raise SessionError(f"'{self.path}' has a message on '{connection.topic}' that cannot be read "
                               f"({str(error).splitlines()[0] if str(error) else type(error).__name__}); it may be damaged, so copy it again.") from None

    def _value(self, message, parts, topic):
        if message._type == "sensor_msgs/JointState" and len(parts) == 1:
            used = self._joints.setdefault(topic, (set(), set()))
            used[0].update(message.name)
            used[1].add(parts[0])
            there = dict(zip(message.name, message.position))
            return there.get(parts[0], float("nan"))
        value = message
        for part in parts:
            try:
                value = value[int(part)] if part.isdecimal() else getattr(value, part)
            except (AttributeError, IndexError, TypeError):
                fields = getattr(value, "__slots__", None) or ["0"]
                raise SessionError(f"A {message._type} on '{topic}' has no '{part}'" + nearest(part, fields)) from None
        return number(value) if isinstance(value, (int, float, str)) else float("nan")

    def unused(self):
        topics = sorted({connection.topic for connection in self._connections.values()} - self._used)
        return ([f"The joint '{name}' of '{topic}' is not used." for topic, (there, used) in self._joints.items()
                 for name in sorted(there - used)] + [f"The topic '{topic}' is not used." for topic in topics])


def open_motion(path, time):
    """A bag or a CSV, by its first bytes."""
    try:
        with open(path, "rb") as stream:
            is_bag = stream.read(4) == b"#ROS"
    except OSError as error:
        raise SessionError(f"'{path}' cannot be read: {error.strerror}.") from None
    return (BagMotion if is_bag or path.endswith((".bag", ".active")) else CsvMotion)(path, time)


def cleaned(name, times, values, notes):
    """Values that are numbers, at whole nanoseconds that rise. Says what was left out."""
    good = (numpy.abs(times) < LARGEST) & (numpy.abs(values) < LARGEST)  # false for what is not a number
    if not good.all():
        first = int(numpy.argmin(good)) + 1
        notes.append(f"'{name}': {len(good) - good.sum()} of {len(good)} values or their times are no numbers (or beyond "
                     f"{LARGEST:g}), the first of them value {first}; they are left out.")
    times, values = numpy.round(times[good]).astype(numpy.int64), values[good]
    rising = numpy.ones(len(times), bool)
    if len(times):
        rising[1:] = times[1:] > numpy.maximum.accumulate(times)[:-1]
    if not rising.all():
        back = times[:-1][~rising[1:]][0] / 1e9
        notes.append(f"'{name}': {(~rising).sum()} stamps repeat or go back, first after {back:.3f} s; their values are left out.")
    times, values = times[rising], values[rising]
    if len(times) < 2:
        raise SessionError(f"'{name}' has {len(times)} usable values; a motion takes at least two.")
    steps = numpy.diff(times) / 1e9
    gaps = steps > max(GAP, 5 * numpy.median(steps))
    if gaps.any():
        k = int(numpy.argmax(steps))
        notes.append(f"'{name}': {gaps.sum()} gaps of up to {steps[k]:.3g} s, the longest from {(times[k] - times[0]) / 1e9:.3f} s of "
                     "the motion on; values are interpolated across.")
    return times, values
