"""Writes MCAP files (https://mcap.dev/spec) of ROS 2 messages, in chunks that are compressed with zstd."""

import ctypes
import ctypes.util
import os
import struct
import zlib

from .cdr import Transcoder
from .definitions import ros2_definition

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F
CHUNK_SIZE = 1 << 20  # before compression [bytes]
LEVEL = 3  # of zstd: smaller than bzip2 of the recorder, at a fraction of its time


def text(words):
    data = words.encode()
    return struct.pack("<I", len(data)) + data


def sized(data):
    return struct.pack("<I", len(data)) + data


def record(kind, content):
    return struct.pack("<BQ", kind, len(content)) + content


class Zstd:
    """Of the library that dpkg itself needs; Debian 12 has no Python module that is always there."""

    def __init__(self):
        self._library = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
        for name in ("ZSTD_compressBound", "ZSTD_compress"):
            getattr(self._library, name).restype = ctypes.c_size_t

    def compress(self, data):
        room = self._library.ZSTD_compressBound(ctypes.c_size_t(len(data)))
        out = ctypes.create_string_buffer(room)
        size = self._library.ZSTD_compress(out, ctypes.c_size_t(room), bytes(data), ctypes.c_size_t(len(data)), LEVEL)
        if self._library.ZSTD_isError(ctypes.c_size_t(size)):
            raise MemoryError("zstd could not compress a chunk")
        return out.raw[:size]


class McapFile:
    def __init__(self, file):
        self._file, self._zstd = file, Zstd()
        self._schemas, self._channels = {}, {}  # records by number
        self._schema_of = {}  # number by name and definition
        self._counts, self._chunks = {}, []
        self._chunk, self._index, self._times = bytearray(), {}, []
        self._range = [None, 0]  # times of the first and last message [ns]
        self._checksum = 0  # of all before the summary
        self._write(MAGIC + record(HEADER, text("ros2") + text("ViBE for ROS")))

    def _write(self, data):
        self._checksum = zlib.crc32(data, self._checksum)
        self._file.write(data)

    def add_channel(self, number, topic, datatype, definition, latched):
        """A topic, before its first message. `definition`: that of ROS 1"""
        package, name = datatype.split("/")
        key = datatype, definition
        if key not in self._schema_of:
            schema = self._schema_of[key] = len(self._schema_of) + 1
            words = ros2_definition(datatype, definition)
            content = struct.pack("<H", schema) + text(package + "/msg/" + name) + text("ros2msg") + text(words)
            self._schemas[schema] = record(SCHEMA, content)
            self._chunk += self._schemas[schema]
        about = text("offered_qos_profiles") + text(quality(latched))
        content = struct.pack("<HH", number, self._schema_of[key]) + text(topic) + text("cdr") + sized(about)
        self._channels[number] = record(CHANNEL, content)
        self._chunk += self._channels[number]

    def add(self, channel, logged, published, data):
        """A message with the times [ns] at which it was received and sent."""
        sequence = self._counts[channel] = self._counts.get(channel, 0) + 1
        self._index.setdefault(channel, []).append((logged, len(self._chunk)))
        self._times.append(logged)
        self._chunk += record(MESSAGE, struct.pack("<HIQQ", channel, sequence, logged, published) + data)
        if len(self._chunk) >= CHUNK_SIZE:
            self._end_chunk()

    def _end_chunk(self):
        if not self._chunk:
            return
        first, last = min(self._times, default=0), max(self._times, default=0)
        packed = self._zstd.compress(self._chunk)
        sizes = struct.pack("<QQQI", first, last, len(self._chunk), zlib.crc32(self._chunk))
        start = self._file.tell()
        self._write(record(CHUNK, sizes + text("zstd") + struct.pack("<Q", len(packed)) + packed))
        end, offsets = self._file.tell(), b""
        for channel, entries in self._index.items():
            offsets += struct.pack("<HQ", channel, self._file.tell())
            places = b"".join(struct.pack("<QQ", *entry) for entry in entries)
            self._write(record(MESSAGE_INDEX, struct.pack("<H", channel) + sized(places)))
        self._chunks.append(record(CHUNK_INDEX, struct.pack("<QQQQ", first, last, start, end - start) + sized(offsets)
                                   + struct.pack("<Q", self._file.tell() - end) + text("zstd")
                                   + struct.pack("<QQ", len(packed), len(self._chunk))))  # fmt: skip
        if self._times:
            self._range = [first if self._range[0] is None else min(first, self._range[0]), max(last, self._range[1])]
        self._chunk, self._index, self._times = bytearray(), {}, []

    def close(self):
        self._end_chunk()
        self._file.write(record(DATA_END, struct.pack("<I", self._checksum)))
        start, summary, offsets = self._file.tell(), b"", b""
        groups = {SCHEMA: self._schemas.values(), CHANNEL: self._channels.values(), STATISTICS: [self._statistics()],
                  CHUNK_INDEX: self._chunks}  # fmt: skip
        for kind, records in groups.items():
            group = b"".join(records)
            if group:
                offsets += record(SUMMARY_OFFSET, struct.pack("<BQQ", kind, start + len(summary), len(group)))
            summary += group
        footer = struct.pack("<QQ", start, start + len(summary))
        checked = summary + offsets + struct.pack("<BQ", FOOTER, 20) + footer
        self._file.write(checked + struct.pack("<I", zlib.crc32(checked)) + MAGIC)

    def _statistics(self):
        counts = b"".join(struct.pack("<HQ", *pair) for pair in self._counts.items())
        sizes = struct.pack("<QHIIII", sum(self._counts.values()), len(self._schemas), len(self._channels), 0, 0,
                            len(self._chunks))  # fmt: skip
        return record(STATISTICS, sizes + struct.pack("<QQ", self._range[0] or 0, self._range[1]) + sized(counts))


def quality(latched):
    """As rosbag2 has it; the last message of a latched topic is sent to late subscribers, too."""
    never = "{sec: 9223372036, nsec: 854775807}"
    return "\n".join([
        "- history: 1", "  depth: {}".format(1 if latched else 10), "  reliability: 1",
        "  durability: {}".format(1 if latched else 2), "  deadline: " + never, "  lifespan: " + never, "  liveliness: 1",
        "  liveliness_lease_duration: " + never, "  avoid_ros_namespace_conventions: false", "",
    ])  # fmt: skip


class Mcap:
    def __init__(self, folder, source, files):
        self.connections = source.chosen
        self._stream = files.enter_context(open(os.path.join(folder, "session.mcap"), "wb"))
        self._file, self._transcoders, self._count = McapFile(self._stream), {}, 0

    @staticmethod
    def needs_more(_arguments):
        return False

    def add(self, message):
        about = message.connection
        if message.number not in self._transcoders:
            self._transcoders[message.number] = Transcoder(about.datatype, about.definition)
            self._file.add_channel(message.number, about.topic, about.datatype, about.definition, about.latched)
        data = self._transcoders[message.number](message.data)
        self._file.add(message.number, message.received, message.time, data)
        self._count += 1

    def finish(self):
        self._file.close()
        self._stream.close()
        return "{} messages".format(self._count)
