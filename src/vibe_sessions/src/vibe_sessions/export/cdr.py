"""Messages as bytes of ROS 2: CDR of the OMG (little-endian, version 1), in which each value begins at a multiple of its size.

The bytes of ROS 1 are the same values without gaps, so they are copied, with gaps between them, and no message is made.
"""

import struct

from .definitions import fields_of, parts_of

HEAD = b"\x00\x01\x00\x00"  # encapsulation: CDR, little-endian
SIZES = {"bool": 1, "byte": 1, "char": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2, "int32": 4, "uint32": 4, "int64": 8,
         "uint64": 8, "float32": 4, "float64": 8}  # fmt: skip
# kinds of steps, which are (kind, alignment, bytes), of COUNTED those of an element, or (EACH, how many or 0, steps of each)
COPY, COUNTED, EACH, TEXT, SKIP, EMPTY = range(6)
U32 = struct.Struct("<I")


class Encoder:
    """For messages of a type with its definition."""

    def __init__(self, datatype, definition):
        types = {name: fields_of(name, text, arrays=True) for name, text in parts_of(datatype, definition).items()}
        self._steps = steps_of(datatype, types)

    def encode(self, data):
        """Raises struct.error where a message does not fit the definition."""
        out = bytearray()
        put(self._steps, data, 0, out)
        return HEAD + out


def steps_of(datatype, types):
    steps = []
    for name, (kind, _) in types[datatype].items():
        base, is_array, count = kind.rstrip("]").partition("[")
        if (datatype, name) == ("std_msgs/Header", "seq"):  # which ROS 2 does not have
            found = [(SKIP, 1, 4)]
        elif base in SIZES:
            found = [(COPY, SIZES[base], SIZES[base])]
        elif base in ("time", "duration"):
            found = [(COPY, 4, 8)]
        else:
            found = [(TEXT, 4, 0)] if base == "string" else steps_of(base, types)
        if is_array:
            found = [repeated(found, int(count or 0))]
        if steps and steps[-1][:2] == found[0][:2] and found[0][0] == COPY:  # no gap between them
            found = [(COPY, found[0][1], steps.pop()[2] + found[0][2]), *found[1:]]
        steps += found
    return steps or [(EMPTY, 1, 0)]


def repeated(steps, count):
    """The step of an array with so many elements, or with 0 as many as a number before them says."""
    kind, alignment, size = steps[0]
    if kind != COPY or len(steps) > 1:
        return EACH, count, steps
    return (COPY, alignment, size * count) if count else (COUNTED, alignment, size)


def put(steps, data, at, out):
    """Appends what begins there, and returns where it ends."""
    for kind, about, what in steps:
        count = about
        if kind in (COUNTED, TEXT) or (kind == EACH and not about):
            (count,) = U32.unpack_from(data, at)
            at += 4
            out += bytes(-len(out) % 4) + U32.pack(count + (kind == TEXT))
        if kind == EACH:
            for _ in range(count):
                at = put(what, data, at, out)
            continue
        end = at + (what * count if kind == COUNTED else count if kind == TEXT else what)
        if end > len(data):
            raise struct.error("it ends too early")
        if kind in (COPY, COUNTED) and end > at:
            out += bytes(-len(out) % about)
        if kind != SKIP:
            out += data[at:end]
        if kind in (TEXT, EMPTY):
            out += b"\0"
        at = end
    return at
