"""Writes MCAP files (https://mcap.dev/spec) of ROS 2 messages, in chunks that are compressed with zstd."""

import ctypes
import ctypes.util
import functools
import os
import shutil
import struct
import zlib

from .cdr import Encoder
from .definitions import ros2_definition

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, DATA_END = 0x0B, 0x0F
BESIDE = "foxglove.json", "rerun_view.py"  # a layout, and what shows the file
CHUNK_SIZE = 1 << 20  # before compression [bytes]
LEVEL = 1  # of zstd: 2 % larger than level 3 in half its time, and smaller than bzip2 of the recorder


def sized(data):
    data = data.encode() if isinstance(data, str) else data
    return struct.pack("<I", len(data)) + data


def record(kind, content):
    return struct.pack("<BQ", kind, len(content)) + content


@functools.lru_cache
def library():
    """That which dpkg itself needs; Debian 12 has no Python module that is always there."""
    zstd = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    zstd.ZSTD_compressBound.restype = zstd.ZSTD_compress.restype = ctypes.c_size_t
    return zstd


def compress(data):
    zstd, size = library(), ctypes.c_size_t
    room = zstd.ZSTD_compressBound(size(len(data)))
    out = ctypes.create_string_buffer(room)
    length = zstd.ZSTD_compress(out, size(room), bytes(data), size(len(data)), LEVEL)
    return ctypes.string_at(out, length)


class Mcap:
    def __init__(self, folder, source, files):
        self.connections = source.chosen
        self._file = files.enter_context(open(os.path.join(folder, "session.mcap"), "wb"))
        for name in BESIDE:
            shutil.copyfile(os.path.join(os.path.dirname(__file__), name), os.path.join(folder, name))
        self._checksum = 0  # of all before the summary
        self._schemas, self._channels, self._chunks = {}, {}, []  # records; schemas by type and definition, channels by number
        self._encoders = {}  # by channel
        self._counts, self._range = {}, [2**64 - 1, 0]  # messages by channel; times of the first and the last one [ns]
        self._chunk, self._index = bytearray(), {}
        self._write(MAGIC + record(HEADER, sized("ros2") + sized("ViBE for ROS")))

    def _write(self, data):
        self._checksum = zlib.crc32(data, self._checksum)
        self._file.write(data)

    def add(self, message):
        channel = message.number
        if channel not in self._channels:
            self._add_channel(channel, message.connection)
        sequence = self._counts[channel] = self._counts.get(channel, 0) + 1
        self._index.setdefault(channel, []).append((message.received, len(self._chunk)))
        head = struct.pack("<HIQQ", channel, sequence, message.received, message.time)
        self._chunk += record(MESSAGE, head + self._encoders[channel].encode(message.data))
        if len(self._chunk) >= CHUNK_SIZE:
            self._end_chunk()

    def _add_channel(self, number, connection):
        key = connection.datatype, connection.definition
        self._encoders[number] = Encoder(*key)
        if key not in self._schemas:
            name = sized(connection.datatype.replace("/", "/msg/")) + sized("ros2msg")
            self._schemas[key] = record(SCHEMA, struct.pack("<H", len(self._schemas) + 1) + name + sized(ros2_definition(*key)))
            self._chunk += self._schemas[key]
        numbers = struct.pack("<HH", number, list(self._schemas).index(key) + 1)
        self._channels[number] = record(CHANNEL, numbers + sized(connection.topic) + sized("cdr") + sized(""))
        self._chunk += self._channels[number]

    def _end_chunk(self):
        times = [time for entries in self._index.values() for time, _ in entries]
        if not times:
            return
        first, last, packed, begin = min(times), max(times), compress(self._chunk), self._file.tell()
        self._range = [min(first, self._range[0]), max(last, self._range[1])]
        sizes = struct.pack("<QQQI", first, last, len(self._chunk), zlib.crc32(self._chunk))
        self._write(record(CHUNK, sizes + sized("zstd") + struct.pack("<Q", len(packed)) + packed))
        end, offsets = self._file.tell(), b""
        for channel, entries in self._index.items():
            offsets += struct.pack("<HQ", channel, self._file.tell())
            places = b"".join(struct.pack("<QQ", *entry) for entry in entries)
            self._write(record(MESSAGE_INDEX, struct.pack("<H", channel) + sized(places)))
        place = struct.pack("<QQQQ", first, last, begin, end - begin) + sized(offsets) + struct.pack("<Q", self._file.tell() - end)
        self._chunks.append(record(CHUNK_INDEX, place + sized("zstd") + struct.pack("<QQ", len(packed), len(self._chunk))))
        self._chunk, self._index = bytearray(), {}

    def finish(self):
        self._end_chunk()
        self._write(record(DATA_END, struct.pack("<I", self._checksum)))
        begin = self._file.tell()
        counts = b"".join(struct.pack("<HQ", *pair) for pair in self._counts.items())
        sizes = struct.pack("<QHIIII", sum(self._counts.values()), len(self._schemas), len(self._channels), 0, 0, len(self._chunks))
        statistics = record(STATISTICS, sizes + struct.pack("<QQ", *(self._range if self._chunks else (0, 0))) + sized(counts))
        summary = b"".join([*self._schemas.values(), *self._channels.values(), statistics, *self._chunks])
        summary += struct.pack("<BQQQ", FOOTER, 20, begin, 0)
        self._file.write(summary + struct.pack("<I", zlib.crc32(summary)) + MAGIC)
        self._file.close()
        return "{} messages".format(sum(self._counts.values()))
