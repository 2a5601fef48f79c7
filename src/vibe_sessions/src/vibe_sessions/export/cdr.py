"""The bytes of a message of ROS 1 as those of ROS 2: CDR of the OMG (little-endian, version 1), which aligns each value to
its size. The plan of a type is made once; runs of values of fixed size are copied in one go."""

import struct

from .definitions import structure

HEAD = b"\x00\x01\x00\x00"  # encapsulation: CDR, little-endian
U32 = struct.Struct("<I")
CODES = {"bool": "B", "byte": "b", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
         "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}  # fmt: skip


def align(out, size):
    out += bytes(-len(out) % size)


class Run:
    """Values of fixed size that follow each other: (code of struct, how many) of each."""

    def __init__(self, values):
        self._values = values
        self._source = struct.Struct("<" + "".join("{}{}".format(count, code) for code, count in values))
        self._targets = {}  # by the place at which they begin, modulo 8

    def copy(self, data, at, out):
        place = len(out) % 8
        if place not in self._targets:
            self._targets[place] = self._target(place)
        out += self._targets[place].pack(*self._source.unpack_from(data, at))
        return at + self._source.size

    def _target(self, place):
        text = "<"
        for code, count in self._values:
            gap = -place % struct.calcsize("<" + code) if count else 0
            text += "{}x{}{}".format(gap, count, code)
            place += gap + struct.calcsize("<{}{}".format(count, code))
        return struct.Struct(text)


def skip(size):
    return lambda data, at, out: at + size


def copy_string(data, at, out):
    (size,) = U32.unpack_from(data, at)
    if at + 4 + size > len(data):
        raise struct.error("a text ends behind its message")
    align(out, 4)
    out += U32.pack(size + 1) + data[at + 4 : at + 4 + size] + b"\0"
    return at + 4 + size


def sequence_of(size):
    """An array of any length of numbers of this size."""

    def copy(data, at, out):
        (count,) = U32.unpack_from(data, at)
        end = at + 4 + count * size
        if end > len(data):
            raise struct.error("an array ends behind its message")
        align(out, 4)
        out += U32.pack(count)
        if count:
            align(out, size)
        out += data[at + 4 : end]
        return end

    return copy


def repeated(steps, count):
    """`count` elements, or as many as the data says."""

    def copy(data, at, out):
        number = count
        if number is None:
            (number,) = U32.unpack_from(data, at)
            at += 4
            align(out, 4)
            out += U32.pack(number)
        for _ in range(number):
            for step in steps:
                at = step(data, at, out)
        return at

    return copy


def padding(data, at, out):
    """A message without fields has one byte in ROS 2."""
    out += b"\0"
    return at


class Transcoder:
    def __init__(self, datatype, definition):
        self._types = structure(datatype, definition)
        self._steps = merged(self._plan(datatype))

    def __call__(self, data):
        """Raises struct.error if the bytes do not fit the definition."""
        out = bytearray()
        at = 0
        for step in self._steps:
            at = step(data, at, out)
        if at != len(data):
            raise struct.error("{} bytes are left over".format(len(data) - at))
        return HEAD + out

    def _plan(self, datatype):
        """Steps, and (code, count) of values of fixed size."""
        plan = []
        for field in self._types[datatype]:
            if (datatype, field.name) == ("std_msgs/Header", "seq"):
                plan.append(skip(4))
            else:
                plan += self._of_array(field) if field.array else self._of_one(field.kind)
        return plan or [padding]

    def _of_one(self, kind):
        if kind in CODES:
            return [(CODES[kind], 1)]
        if kind in ("time", "duration"):
            return [("I", 2)]
        return [copy_string] if kind == "string" else self._plan(kind)

    def _of_array(self, field):
        if field.kind not in CODES:
            return [repeated(merged(self._of_one(field.kind)), field.length())]
        if field.length() is not None:
            return [(CODES[field.kind], field.length())]
        return [sequence_of(struct.calcsize("<" + CODES[field.kind]))]


def merged(plan):
    steps, values = [], []
    for each in [*plan, None]:
        if isinstance(each, tuple):
            values.append(each)
            continue
        if values:
            steps.append(Run(values).copy)
            values = []
        if each is not None:
            steps.append(each)
    return steps
