"""Messages of a bag: whole ones by their own definitions, and single fields of many without building the messages."""

import re
import struct

import genpy.dynamic

_classes = {}  # by md5 sum
STAMP = struct.Struct("<III")  # seq, secs, nsecs of a Header
SIZES = {"bool": 1, "int8": 1, "uint8": 1, "byte": 1, "char": 1, "int16": 2, "uint16": 2, "int32": 4, "uint32": 4}
SIZES.update({"float32": 4, "int64": 8, "uint64": 8, "float64": 8, "time": 8, "duration": 8})
SIZES.update({"geometry_msgs/Point": 24, "geometry_msgs/Vector3": 24, "geometry_msgs/Quaternion": 32})
SIZES.update({"geometry_msgs/Pose": 56, "geometry_msgs/Wrench": 48})


def message_class(connection):
    """The class of the messages of a connection, from the definition in the bag; ValueError where that is not whole."""
    if connection.md5sum not in _classes and not has_its_definition(connection):
        raise ValueError("the definition of {} is not that of its MD5 sum; it may have been edited or damaged".format(connection.datatype))
    return _classes[connection.md5sum]


def has_its_definition(connection):
    """Whether the definition is that of the MD5 sum beside it, and not one that was edited or damaged."""
    try:
        made = genpy.dynamic.generate_dynamic(connection.datatype, connection.definition)[connection.datatype]
    except Exception:  # of whatever kind: genpy runs what it makes of the text
        return False
    if made._md5sum == connection.md5sum:
        _classes.setdefault(connection.md5sum, made)
    return made._md5sum == connection.md5sum


def parse(connection, data):
    return message_class(connection)().deserialize(data)


def stamp_of(data):
    """seq and stamp [ns] of a message that begins with a Header."""
    seq, secs, nsecs = STAMP.unpack_from(data)
    return seq, secs * 1_000_000_000 + nsecs


def after_header(data):
    return 16 + struct.unpack_from("<I", data, 12)[0]


def offset_of(definition, name):
    """Where the field `name` begins behind the header of a message whose fields before it have fixed sizes; None if the
    message has no such field, or one of another size before it."""
    at = None
    for line in definition.split("\n====", 1)[0].splitlines():
        match = re.match(r"^\s*([A-Za-z0-9_/]+)(\[(\d*)\])?\s+([A-Za-z]\w*)\s*(#.*)?$", line)
        if not match:
            continue
        kind, array, count, field = match.group(1, 2, 3, 4)
        if kind in ("Header", "std_msgs/Header"):
            at = 0
        elif field == name:
            return at
        elif at is None or kind not in SIZES or (array and not count):
            return None
        else:
            at += SIZES[kind] * int(count or 1)
    return None


class StepReader:
    """(stamp [ns], step, run, hash of the state) of a vibe_msgs/StepInput; 0 for what an older one does not have."""

    def __init__(self, connection):
        self._connection = connection
        self._places = [offset_of(connection.definition, name) for name in ("step", "run", "state_hash")]
        self.has_hash = self._places[2] is not None

    def read(self, data):
        body = after_header(data)
        step, run, state_hash = (
            struct.unpack_from(kind, data, body + at)[0] if at is not None else 0
            for kind, at in zip(("<Q", "<I", "<Q"), self._places)
        )
        return stamp_of(data)[1], step, run, state_hash
