"""Reads rosbag files of format 2.0, also those that a killed recorder has left without an index.

rosbag's own reader makes an object for each message of the whole file, and loses the chunk in which a file was cut; this
one reads only the connections that are asked for, one chunk at a time. Format: http://wiki.ros.org/Bags/Format/2.0.
"""

import bz2
import contextlib
import functools
import os
import struct
from dataclasses import dataclass, field

import numpy

MAGIC = b"#ROSBAG V2.0\n"
CONNECTION, FILE_HEADER, MESSAGE, INDEX, CHUNK, CHUNK_INFO = 7, 3, 2, 4, 5, 6
LARGEST = 1 << 31  # of a record; a larger size is damage [bytes]
U32 = struct.Struct("<I")
DAMAGE = (EOFError, KeyError, ValueError, struct.error, OSError)


class BagError(Exception):
    """A recording that cannot be reported on; one sentence with file, problem and remedy."""


@dataclass
class Connection:
    topic: str
    datatype: str
    md5sum: str
    definition: str
    caller: str  # name of the node that published


@dataclass
class Chunk:
    position: int  # of its record in the file
    counts: dict  # messages by number of connection
    entries: dict = field(default=None)  # rows of secs, nsecs, offset by connection; None: in the file behind the chunk


def fields_of(header):
    """The fields of a record header, as bytes by name."""
    fields, at = {}, 0
    while at < len(header):
        (size,) = U32.unpack_from(header, at)
        name, _, value = header[at + 4 : at + 4 + size].partition(b"=")
        fields[name.decode("ascii", "replace")] = value
        at += 4 + size
    return fields


def number(fields, name):
    return int.from_bytes(fields[name], "little")


def decompress(data, compression):
    if compression == b"none":
        return data
    if compression == b"bz2":
        return bz2.decompress(data)
    if compression == b"lz4":
        import roslz4

        return roslz4.decompress(data)
    raise BagError("compression '{}' is not known".format(compression.decode("ascii", "replace")))


class BagFile:
    """Connections and messages of a file. `cut_reason` is one sentence if it was not closed, else empty."""

    def __init__(self, path):
        self.path = path
        self.connections = {}
        self.chunks = []
        self.cut_reason = ""
        self._file = self._open()
        try:
            self.size = os.fstat(self._file.fileno()).st_size
            self._read_index()
        except BaseException:
            self._file.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def count(self, connection):
        return sum(chunk.counts.get(connection, 0) for chunk in self.chunks)

    def messages(self, wanted):
        """(connection, time of reception [ns], bytes) of the connections in `wanted`, in the order of the file."""
        wanted = set(wanted)
        for chunk in self.chunks:
            if not wanted.isdisjoint(chunk.counts):
                with self._reading(chunk):
                    data = self._chunk_data(chunk.position)
                    connections, times, offsets = self._index(chunk, wanted)
                    for k in numpy.argsort(offsets, kind="stable").tolist():
                        yield int(connections[k]), int(times[k]), message_at(data, int(offsets[k]))

    def in_time(self, wanted):
        """The same in the order of reception, which is another one where a bag was merged or filled. Holds the places of messages
        in the chunks that overlap in time, 20 bytes each, and the data of a few of these chunks."""
        places, data_of = [], functools.lru_cache(8)(lambda chunk: self._chunk_data(self.chunks[chunk].position))
        begins = self._begins(set(wanted))
        for (_, number), (horizon, _) in zip(begins, [*begins[1:], (None, 0)]):
            with self._reading(self.chunks[number]):
                index = self._index(self.chunks[number], wanted)
            places.append((*index, numpy.full(len(index[0]), number, numpy.int32)))
            columns = [numpy.concatenate(column) for column in zip(*places)]
            order = numpy.lexsort((columns[2], columns[3], columns[1]))
            count = len(order) if horizon is None else numpy.searchsorted(columns[1], horizon, sorter=order)
            places = [tuple(column[order[count:]] for column in columns)]
            yield from self._of(data_of, *(column[order[:count]].tolist() for column in columns))

    def _begins(self, wanted):
        """(time of the first message [ns], number of the chunk), in order."""
        found = []
        for number, chunk in enumerate(self.chunks):
            if not wanted.isdisjoint(chunk.counts):
                with self._reading(chunk):
                    times = self._index(chunk, wanted)[1]
                found += [(int(times.min()), number)] if len(times) else []
        return sorted(found)

    def _of(self, data_of, connections, times, offsets, numbers):
        last = data = None
        for connection, time, offset, number in zip(connections, times, offsets, numbers):
            try:
                if number != last:
                    last, data = number, data_of(number)
                found = message_at(data, offset)
            except DAMAGE as error:
                raise self._damaged(self.chunks[number], error) from None
            yield connection, time, found

    def _open(self):
        try:
            file = open(self.path, "rb")
        except FileNotFoundError:
            raise BagError("{}: there is no such file; check the path".format(self.path)) from None
        except OSError as error:
            raise BagError(
                "{}: cannot be read ({}); check the path and its permissions".format(self.path, error.strerror)
            ) from None
        begin = file.read(len(MAGIC))
        if begin == MAGIC:
            return file
        file.close()
        if not begin:
            problem = "is empty, so nothing was recorded; delete it and record the session again"
        elif MAGIC.startswith(begin):
            problem = "holds only the first {} bytes of a bag; copy it again".format(len(begin))
        elif begin.startswith(b"#ROS"):
            problem = "is a bag of another format than 2.0; convert it with `rosbag fix` or `rosbag reindex`"
        else:
            problem = "is not a bag; give the session.bag of a session"
        raise BagError("{}: {}".format(self.path, problem))

    def _read_index(self):
        try:
            header, _ = self._record()
            if header.get("encryptor"):
                raise BagError("{}: is encrypted; decrypt it with `rosbag decrypt`".format(self.path))
            index, chunks = number(header, "index_pos"), number(header, "chunk_count")
            connections = number(header, "conn_count")
        except (EOFError, KeyError, ValueError, struct.error):
            self._scan(len(MAGIC))
            return
        first = self._file.tell()
        try:
            if index == 0:
                raise EOFError
            self._file.seek(index)
            for _ in range(connections):
                self._add_connection(*self._record())
            for _ in range(chunks):
                self._add_chunk_info(*self._record())
        except (EOFError, KeyError, ValueError, struct.error):
            self._scan(first)

    def _scan(self, position):
        """Finds the messages of a file without an index, up to where it was cut."""
        self.connections, self.chunks = {}, []
        self._file.seek(position)
        readable = position
        try:
            while True:
                position = self._file.tell()
                header, _ = self._record(keep_data=False)
                if header["op"] == bytes([CHUNK]):
                    self._scan_chunk(position, header)
                readable = min(self._file.tell(), self.size)
        except (EOFError, KeyError, ValueError, struct.error, OSError, BagError):
            pass
        self.cut_reason = (
            "The recording was not closed (a killed recorder, a full disk or a broken copy): {:.1f} of {:.1f} MB could "
            "be read, and what came later is missing.".format(readable / 1e6, self.size / 1e6)
        )

    def _scan_chunk(self, position, header):
        """An uncompressed chunk that was being written has size 0 in its header; its messages are there nevertheless."""
        after = self._file.tell()
        chunk = Chunk(position, {}, {})
        found = {}
        try:
            for op, fields, offset, data in records_of(self._chunk_data(position)):
                if op == CONNECTION:
                    self._add_connection(fields, data)
                elif op == MESSAGE:
                    secs, nsecs = struct.unpack("<II", fields["time"])
                    found.setdefault(number(fields, "conn"), []).append((secs, nsecs, offset))
        finally:
            chunk.entries = {c: numpy.array(e, "<u4").reshape(-1, 3) for c, e in found.items() if c in self.connections}
            chunk.counts = {c: len(e) for c, e in chunk.entries.items()}
            if chunk.counts:
                self.chunks.append(chunk)
        self._file.seek(after if number(header, "size") > 0 else self.size)

    def _add_connection(self, fields, data):
        if fields["op"] != bytes([CONNECTION]):
            raise ValueError("not a connection")
        about = fields_of(data)
        text = {name: value.decode("utf-8", "replace") for name, value in about.items()}
        self.connections[number(fields, "conn")] = Connection(
            fields["topic"].decode("utf-8", "replace"),
            text.get("type", ""),
            text.get("md5sum", ""),
            text.get("message_definition", ""),
            text.get("callerid", ""),
        )

    def _add_chunk_info(self, fields, data):
        if fields["op"] != bytes([CHUNK_INFO]):
            raise ValueError("not a chunk info")
        pairs = numpy.frombuffer(data, "<u4").reshape(-1, 2)
        self.chunks.append(Chunk(number(fields, "chunk_pos"), {int(c): int(n) for c, n in pairs}))

    def _record(self, keep_data=True):
        """Header and data of the record at the present position; without data, the file stands behind it."""
        header = fields_of(self._sized())
        if keep_data:
            return header, self._sized()
        (size,) = U32.unpack(self._exactly(4))
        if self._file.tell() + size > self.size and header.get("op") != bytes([CHUNK]):
            raise EOFError
        self._file.seek(size, os.SEEK_CUR)
        return header, b""

    def _sized(self):
        (size,) = U32.unpack(self._exactly(4))
        return self._exactly(size)

    def _exactly(self, size):
        data = self._file.read(size) if size <= LARGEST else b""
        if len(data) != size:
            raise EOFError
        return data

    def _chunk_data(self, position):
        """Messages and connections of a chunk, decompressed; the file then stands at its index records."""
        self._file.seek(position)
        header = fields_of(self._sized())
        (size,) = U32.unpack(self._exactly(4))
        compression = header["compression"]
        if compression == b"none":
            return self._file.read(min(size or self.size, self.size - self._file.tell()))
        return decompress(self._exactly(size), compression)

    @contextlib.contextmanager
    def _reading(self, chunk):
        try:
            yield
        except DAMAGE as error:
            raise self._damaged(chunk, error) from None

    def _damaged(self, chunk, error):
        return BagError("{}: is damaged in the chunk at byte {} ({}); copy it again, or mend it with `rosbag reindex`".format(
            self.path, chunk.position, str(error) or "it ends there"))  # fmt: skip

    def _index(self, chunk, wanted):
        """Connections, times of reception [ns] and offsets of the messages of a chunk, as arrays."""
        entries = chunk.entries if chunk.entries is not None else self._entries(chunk)
        here = [(c, e) for c, e in entries.items() if c in wanted]
        found = numpy.concatenate([numpy.empty((0, 3), "<u4"), *(e for _, e in here)])
        connections = numpy.repeat(numpy.array([c for c, _ in here], numpy.int32), [len(e) for _, e in here])
        return connections, found[:, 0].astype(numpy.int64) * 1_000_000_000 + found[:, 1], found[:, 2]

    def _entries(self, chunk):
        self._file.seek(chunk.position)
        self._record(keep_data=False)
        entries = {}
        for _ in chunk.counts:
            header, data = self._record()
            if header["op"] != bytes([INDEX]):
                raise ValueError("no index behind it")
            entries[number(header, "conn")] = numpy.frombuffer(data, "<u4").reshape(-1, 3)
        return entries


def message_at(data, offset):
    body = offset + 4 + U32.unpack_from(data, offset)[0]
    end = body + 4 + U32.unpack_from(data, body)[0]
    return data[body + 4 : end]


def records_of(data):
    """(operation, fields, offset, data) of the records of a chunk, as far as they are complete."""
    at = 0
    while at + 4 <= len(data):
        (header_size,) = U32.unpack_from(data, at)
        body = at + 4 + header_size
        if body + 4 > len(data):
            return
        (size,) = U32.unpack_from(data, body)
        if body + 4 + size > len(data):
            return
        fields = fields_of(data[at + 4 : body])
        yield fields["op"][0], fields, at, data[body + 4 : body + 4 + size]
        at = body + 4 + size
