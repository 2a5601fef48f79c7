"""Rows of tables from the bytes of ROS 1 messages, without making the messages.

What lies between two parts of unknown length is read at once. An array of messages is a table of its own.
"""

import functools
import struct

from .definitions import PRIMITIVES

LONGEST = 64  # array that becomes columns
CODES = {"bool": "?", "byte": "b", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
         "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}  # fmt: skip
TIMES = {"time": struct.Struct("<II"), "duration": struct.Struct("<ii")}
U32 = struct.Struct("<I")
NUMBERS, TIME, TEXT, ARRAY, EACH, SKIP = range(6)


@functools.lru_cache(4096)
def columns_of(array, labels):
    return ["{}[{}]".format(array, label) for label in labels]


@functools.lru_cache(4096)
def labels_of(names, count):
    """Names of the elements of an array, if each has its own; else their numbers."""
    return names if len(names) == len(set(names)) == count else range(count)


@functools.lru_cache(1024)
def numbers_of(count, code):
    return struct.Struct("<{}{}".format(count, code))


def text_at(data, at):
    """(text, where it ends)"""
    end = at + 4 + U32.unpack_from(data, at)[0]
    if end > len(data):
        raise struct.error("it ends too early")
    return str(data[at + 4 : end], "utf-8", "rosmsg"), end


def steps_of(datatype, types, prefix=""):
    """How a message or a part of one is read, as (kind, column, what is read)."""
    fields, steps = types[datatype], []
    is_labelled = fields.get("name", ("",))[0].startswith("string[")  # as the arrays of a JointState
    for name, (kind, _) in fields.items():
        base, bracket, count = kind.rstrip("]").partition("[")
        column, count = prefix + name, int(count or 0)
        if bracket and base in PRIMITIVES:
            if base in CODES and 0 < count <= LONGEST and not is_labelled:
                steps.append((NUMBERS, columns_of(column, range(count)), count * CODES[base]))
            else:
                steps.append((ARRAY, column, (base, count, name == "name" and is_labelled, is_labelled and base != "string")))
        elif bracket:
            steps.append((EACH, column, (count, list(joined(steps_of(base, types))))))
        elif base in CODES:
            steps.append((NUMBERS, [column], CODES[base]))
        elif base in PRIMITIVES:
            steps.append((TEXT if base == "string" else TIME, column, TIMES.get(base)))
        else:
            steps += steps_of(base, types, column + ".")
    return steps


def joined(steps):
    """Numbers that follow each other are one step."""
    columns, codes = [], ""
    for kind, column, what in [*steps, (None, "", None)]:
        if kind == NUMBERS:
            columns, codes = columns + column, codes + what
            continue
        if columns:
            yield NUMBERS, columns, struct.Struct("<" + codes)
            columns, codes = [], ""
        if kind is not None:
            yield kind, column, what


class Rows:
    """Gives the rows of messages of one type to `add(table, columns, values)`."""

    def __init__(self, datatype, types, add):
        steps = steps_of(datatype, types)
        if [column for _, column, _ in steps[:2]] == [["header.seq"], "header.stamp"]:  # which has a column already
            steps[:2] = [(SKIP, "", 12)]
        self._steps, self._add = list(joined(steps)), add

    def read(self, data, table, columns, values):
        """The row of a message and those of its arrays of messages, which all begin with these values. Raises struct.error
        where it does not fit the definition."""
        self._read(self._steps, data, 0, table, (columns, values))

    def _read(self, steps, data, at, table, key):
        columns, values, labels = [*key[0]], [*key[1]], None
        for kind, column, what in steps:
            if kind == NUMBERS:
                columns += column
                values += what.unpack_from(data, at)
                at += what.size
            elif kind == TEXT:
                columns.append(column)
                text, at = text_at(data, at)
                values.append(text)
            elif kind == TIME:
                columns.append(column)
                values.append(time_at(what, data, at))
                at += 8
            elif kind == ARRAY:
                found, at = array_at(what, data, at)
                if what[2]:
                    labels = found
                else:
                    self._put(found, column, labels if what[3] else None, columns, values)
            elif kind == EACH:
                at = self._read_each(what, data, at, table + "." + column, column, key)
            else:
                at += what
        self._add(table, columns, values)
        return at

    def _read_each(self, what, data, at, table, column, key):
        count, steps = what
        if not count:
            (count,), at = U32.unpack_from(data, at), at + 4
        columns = [*key[0], column]
        for number in range(count):
            at = self._read(steps, data, at, table, (columns, [*key[1], number]))
        return at

    def _put(self, found, column, labels, columns, values):
        if len(found) > LONGEST:  # a mesh or an image: nothing for a table
            columns.append(column + ".length")
            values.append(len(found))
        elif found:
            columns += columns_of(column, labels_of(tuple(labels or ()), len(found)))
            values += found


def time_at(what, data, at):
    secs, nsecs = what.unpack_from(data, at)
    return (secs * 1_000_000_000 + nsecs) / 1e9


def array_at(what, data, at):
    """(values of an array of numbers, times or texts, where it ends); of a long one of numbers its bytes"""
    base, count = what[:2]
    if not count:
        (count,), at = U32.unpack_from(data, at), at + 4
    if base == "string":
        found = []
        for _ in range(count):
            text, at = text_at(data, at)
            found.append(text)
        return found, at
    if base in TIMES:
        return [time_at(TIMES[base], data, at + 8 * k) for k in range(count)], at + 8 * count
    what = numbers_of(count, CODES[base]) if count <= LONGEST else None
    size = struct.calcsize("<" + CODES[base])
    end = at + count * size
    if end > len(data):
        raise struct.error("it ends too early")
    return what.unpack_from(data, at) if what else range(count), end
