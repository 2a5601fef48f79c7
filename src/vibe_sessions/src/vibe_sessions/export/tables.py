"""Tables of topics: a row for each message, a column for each number; CSV, or Parquet where pyarrow is installed.

Which columns a table has is known at its end, so rows wait on disk.
"""

import csv
import io
import itertools
import marshal
import os
import re
import shutil
import tempfile

from .definitions import PRIMITIVES, fields_of, parts_of
from .rows import Rows

CELLS = 1 << 14  # in memory, of a table of Parquet
GROUP = 4096  # rows of Parquet that are compressed together
KEY = ("received", "stamp")
# of messages whose definitions do not say it
UNITS = {"geometry_msgs/Point": "m", "geometry_msgs/Wrench.force": "N", "geometry_msgs/Wrench.torque": "N m",
         "geometry_msgs/Twist.linear": "m/s", "geometry_msgs/Twist.angular": "rad/s",
         "geometry_msgs/Transform.translation": "m", "time": "s", "duration": "s"}  # fmt: skip


class Table:
    """Takes rows, whose columns become more."""

    def __init__(self, spill):
        self.columns, self._last, self._spill = [], [], spill

    def add(self, columns, values):
        if columns != self._last:
            known = dict.fromkeys(self.columns)
            if not known.keys() >= set(columns):
                self.widen()
                self.columns = list({**known, **dict.fromkeys(columns)})
            self._last = columns
        if columns != self.columns:
            row = dict(zip(columns, values))
            values = [row.get(name) for name in self.columns]
        self.put(values)

    def widen(self):
        """Called before there are more columns."""


def meaning_of(types, datatype, table, column):
    """(type, unit) of a column: that of the field from which it comes."""
    if column in ("received", "stamp"):
        return "float64", "s"
    unit = ""
    for name in [*table.split(".")[1:], *re.sub(r"\[.*\]$", "", column).split(".")]:
        if name not in types.get(datatype, {}):  # the number of an element, or of elements
            return "uint32", ""
        kind, own = types[datatype][name]
        unit, datatype = own or UNITS.get(datatype + "." + name) or UNITS.get(kind) or unit, kind
    return (datatype, unit) if datatype in PRIMITIVES else ("uint32", "")


def names_of(connections):
    """Of tables, by topic and type: the topic with _ for /, and a number behind it where two topics would have the same one."""
    names, taken = {}, {"columns"}
    for topic, datatype in sorted({(each.topic, each.datatype) for each in connections}):
        name = plain = topic.strip("/").replace("/", "_")
        for number in itertools.count(2):
            if name not in taken:
                break
            name = "{}-{}".format(plain, number)
        names[topic, datatype] = name
        taken.add(name)
    return names


class Tables:
    """What csv and parquet share; they differ in the table."""

    def __init__(self, folder, source, files):
        self.connections = source.chosen
        self._folder, self._files, self._tables, self._about = folder, files, {}, {}
        self._names = names_of(source.bag.connections[number] for number in self.connections)
        self._rows = {}  # (name, rows) by connection

    def add(self, message):
        number = message.number
        if number not in self._rows:
            self._begin(number, message.connection)
        name, rows = self._rows[number]
        rows.read(message.data, name, KEY, (message.received / 1e9, message.stamp / 1e9))

    def _begin(self, number, connection):
        name = self._names[connection.topic, connection.datatype]
        self._about[name] = connection
        types = {kind: fields_of(kind, text, arrays=True) for kind, text in parts_of(connection.datatype, connection.definition).items()}
        self._rows[number] = name, Rows(connection.datatype, types, self._add)

    def _add(self, name, columns, values):
        if name not in self._tables:
            self._tables[name] = self.Table(self._files.enter_context(tempfile.TemporaryFile(dir=self._folder)))
        self._tables[name].add(columns, values)

    def finish(self):
        with open(os.path.join(self._folder, "columns.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("table", "column", "type", "unit", "topic"))
            for name, table in sorted(self._tables.items()):
                about = self._about[name.split(".")[0]]
                types = {kind: fields_of(kind, text) for kind, text in parts_of(about.datatype, about.definition).items()}
                columns = {each: meaning_of(types, about.datatype, name, each) for each in table.columns}
                writer.writerows((name, each, *meaning, about.topic) for each, meaning in columns.items())
                table.write(os.path.join(self._folder, name), columns)
        return "{} tables".format(len(self._tables))


class CsvTable(Table):
    """Rows wait as text, so that one is in memory."""

    def __init__(self, spill):
        super().__init__(spill)
        self._narrow = []  # (columns, where rows with so many end)
        self._text = io.TextIOWrapper(spill, encoding="utf-8", newline="")
        self._writer = csv.writer(self._text, lineterminator="\n")
        self.put = self._writer.writerow

    def widen(self):
        self._text.flush()
        self._narrow.append((len(self.columns), self._spill.tell()))

    def write(self, path, columns):
        self._text.flush()
        self._spill.seek(0)
        with open(path + ".csv", "wb") as file:
            text = io.TextIOWrapper(file, encoding="utf-8", newline="")
            csv.writer(text, lineterminator="\n").writerow(columns)
            text.flush()
            for count, end in self._narrow:
                self._fill_up(file, end, b"," * (len(columns) - count) + b"\n")
            shutil.copyfileobj(self._spill, file)
            text.detach()

    def _fill_up(self, file, end, further):
        """Copies rows to which cells are added; in a quoted text a line may end."""
        is_quoted = False
        while self._spill.tell() < end:
            line = self._spill.readline()
            is_quoted ^= line.count(b'"') % 2 == 1
            file.write(line if is_quoted else line[:-1] + further)


class Csv(Tables):
    Table = CsvTable


class ParquetTable(Table):
    """Rows wait as blocks of values, of which those before a column came are shorter."""

    def __init__(self, spill):
        super().__init__(spill)
        self._rows = []

    def put(self, values):
        self._rows.append(values)
        if len(self._rows) * len(values) >= CELLS:
            self._flush()

    def _flush(self):
        marshal.dump(self._rows, self._spill)  # takes half as long as pickle
        self._rows = []

    def _waiting(self):
        self._flush()
        end = self._spill.tell()
        self._spill.seek(0)
        while self._spill.tell() < end:
            yield from marshal.load(self._spill)

    def write(self, path, columns):
        import pyarrow
        from pyarrow import parquet

        kinds = {"bool": "bool_", "byte": "int8", "char": "uint8", "time": "float64", "duration": "float64"}
        schema = pyarrow.schema([pyarrow.field(name, getattr(pyarrow, kinds.get(kind, kind))(), metadata={"unit": unit})
                                 for name, (kind, unit) in columns.items()])  # fmt: skip
        rows = self._waiting()
        with parquet.ParquetWriter(path + ".parquet", schema, compression="zstd") as writer:
            while block := list(itertools.islice(rows, GROUP)):
                values = itertools.zip_longest(*block, [None] * len(columns))  # a row more, so that there is every column
                arrays = [pyarrow.array(column[:-1], field.type) for column, field in zip(values, schema)]
                writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))


class Parquet(Tables):
    Table = ParquetTable
