"""Messages as bytes of ROS 2: CDR of the OMG (little-endian, version 1), in which each value begins at a multiple of its size."""

import struct

HEAD = b"\x00\x01\x00\x00"  # encapsulation: CDR, little-endian
CODES = {"bool": "?", "byte": "b", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
         "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}  # fmt: skip


def cdr_of(message):
    """Bytes of a message of genpy."""
    out = bytearray()
    put_message(out, message)
    return HEAD + out


def put_message(out, message):
    for name, kind in zip(message.__slots__, message._slot_types):
        if (message._type, name) != ("std_msgs/Header", "seq"):  # which ROS 2 does not have
            put(out, kind, getattr(message, name))
    if not message.__slots__:
        out += b"\0"  # a message without fields has one byte in ROS 2


def put(out, kind, value):
    base, _, count = kind.partition("[")
    if count == "]":
        put_numbers(out, "I", (len(value),))
    if base in CODES:
        put_numbers(out, CODES[base], value if count else (value,))
        return
    for each in value if count else (value,):
        if base == "string":
            data = each.encode() if isinstance(each, str) else each
            put_numbers(out, "I", (len(data) + 1,))
            out += data + b"\0"
        elif base in ("time", "duration"):
            put_numbers(out, "i", (each.secs,))
            put_numbers(out, "I", (each.nsecs,))
        else:
            put_message(out, each)


def put_numbers(out, code, values):
    if len(values):
        out += bytes(-len(out) % struct.calcsize(code))
        out += values if isinstance(values, bytes) else struct.pack("<{}{}".format(len(values), code), *values)
