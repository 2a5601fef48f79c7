"""Messages with random content, and their content without classes."""

import math
import random
import struct

import genpy

RANGES = {"bool": (0, 1), "int8": (-128, 127), "byte": (0, 127), "uint8": (0, 255), "char": (0, 255), "int16": (-2**15, 2**15 - 1),
          "uint16": (0, 2**16 - 1), "int32": (-2**31, 2**31 - 1), "uint32": (0, 2**32 - 1), "int64": (-2**63, 2**63 - 1),
          "uint64": (0, 2**64 - 1)}  # fmt: skip


def random_value(kind, dice):
    base, _, count = kind.rstrip("]").partition("[")
    if kind.endswith("]"):
        values = [random_value(base, dice) for _ in range(int(count) if count else dice.randrange(4))]
        return bytes(values) if base in ("uint8", "char") else values
    if base in RANGES:
        return dice.randint(*RANGES[base]) if base != "bool" else dice.random() < 0.5
    if base in ("float32", "float64"):
        value = dice.choice([0.0, -0.0, math.inf, math.nan, dice.gauss(0, 1e3)])
        return struct.unpack("<f", struct.pack("<f", value))[0] if base == "float32" else value
    if base == "string":
        return "".join(dice.choice("aä€,\"\n ") for _ in range(dice.randrange(6)))
    if base == "time":
        return genpy.Time(dice.randrange(2**31), dice.randrange(10**9))
    if base == "duration":
        return genpy.Duration(dice.randrange(-(2**31), 2**31), dice.randrange(10**9))
    return random_message(genpy.message.get_message_class("std_msgs/Header" if base == "Header" else base), dice)


def random_message(kind, dice=random):
    return kind(*(random_value(each, dice) for each in kind._slot_types))


def content(value):
    """Lists and numbers; of a header without its sequence number, which ROS 2 does not have."""
    if isinstance(value, genpy.TVal):
        return [value.secs, value.nsecs]
    if isinstance(value, genpy.Message):
        slots = [slot for slot in value.__slots__ if (value._type, slot) != ("std_msgs/Header", "seq")]
        return [content(getattr(value, slot)) for slot in slots]
    return [content(each) for each in value] if isinstance(value, (list, tuple, bytes)) else value
