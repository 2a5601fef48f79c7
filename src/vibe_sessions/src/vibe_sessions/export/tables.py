"""Tables of topics: a row for each message, a column for each number; CSV, or Parquet where pyarrow is installed.

Which columns a table has is known at its end, so rows wait on disk, in blocks. An array of messages is a table of its own,
with the number of the element in the array.
"""

import csv
import os
import pickle
import re
import tempfile

from .definitions import PRIMITIVES, fields_of, parts_of

BLOCK = 4096  # rows in memory
LONGEST = 64  # array that becomes columns
# of messages whose definitions do not say it
UNITS = {"geometry_msgs/Point": "m", "geometry_msgs/Wrench.force": "N", "geometry_msgs/Wrench.torque": "N m",
         "geometry_msgs/Twist.linear": "m/s", "geometry_msgs/Twist.angular": "rad/s",
         "geometry_msgs/Transform.translation": "m", "time": "s", "duration": "s"}  # fmt: skip


class Table:
    def __init__(self, spill):
        self.columns, self._rows, self._spill = {}, [], spill  # of columns the names alone

    def add(self, row):
        self._rows.append(row)
        if not row.keys() <= self.columns.keys():
            self.columns.update(dict.fromkeys(row))
        if len(self._rows) == BLOCK:
            self._flush()

    def _flush(self):
        pickle.dump(self._rows, self._spill, pickle.HIGHEST_PROTOCOL)
        self._rows = []

    def blocks(self):
        self._flush()
        end = self._spill.tell()
        self._spill.seek(0)
        while self._spill.tell() < end:
            yield pickle.load(self._spill)


def number_of(value, kind):
    return value.to_nsec() / 1e9 if kind in ("time", "duration") else value


def meaning_of(types, datatype, table, column):
    """(type, unit) of a column: that of the field from which it comes."""
    if column in ("received", "stamp"):
        return "float64", "s"
    unit = ""
    for name in [*table.split(".")[1:], *re.sub(r"\[.*\]$", "", column).split(".")]:
        kind, own = types.get(datatype, {}).get(name, ("uint32", ""))  # the number of an element, or of elements
        unit, datatype = own or UNITS.get(datatype + "." + name) or UNITS.get(kind) or unit, kind
    return (datatype, unit) if datatype in PRIMITIVES else ("uint32", "")


class Tables:
    """What csv and parquet share; they differ in how a table is written."""

    def __init__(self, folder, source, files):
        self.connections = source.chosen
        self._folder, self._files, self._tables, self._about = folder, files, {}, {}

    def add(self, message):
        name = message.connection.topic.strip("/").replace("/", "_")
        self._about[name] = message.connection
        key = {"received": message.received / 1e9, "stamp": message.time / 1e9}
        row = dict(key)
        self._fill(message.fields, "", row, name, key)
        self._add(name, row)

    def _add(self, name, row):
        if name not in self._tables:
            self._tables[name] = Table(self._files.enter_context(tempfile.TemporaryFile(dir=self._folder)))
        self._tables[name].add(row)

    def _fill(self, part, prefix, row, table, key):
        names = getattr(part, "name", None)
        for name, kind in zip(part.__slots__, part._slot_types):
            value, column = getattr(part, name), prefix + name
            base, _, array = kind.partition("[")
            if array:
                self._fill_array(value, base, column, row, table, key, names)
            elif base in PRIMITIVES:
                row[column] = number_of(value, base)
            elif (prefix, column) == ("", "header"):
                row[column + ".frame_id"] = value.frame_id  # its stamp has a column
            else:
                self._fill(value, column + ".", row, table, key)

    def _fill_array(self, values, base, column, row, table, key, names):
        if base not in PRIMITIVES:
            table += "." + column
            for number, value in enumerate(values):
                below = {**key, column: number}
                self._fill(value, "", below, table, dict(below))
                self._add(table, below)
        elif len(values) > LONGEST:
            row[column + ".length"] = len(values)  # a mesh or an image: nothing for a table
        elif values is not names:  # which label the others, as in JointState
            named = isinstance(names, list) and len(names) == len(values) and base != "string"
            for label, value in zip(names if named else range(len(values)), values):
                row["{}[{}]".format(column, label)] = number_of(value, base)

    def finish(self):
        with open(os.path.join(self._folder, "columns.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("table", "column", "type", "unit"))
            for name, table in sorted(self._tables.items()):
                about = self._about[name.split(".")[0]]
                types = {kind: fields_of(kind, text) for kind, text in parts_of(about.datatype, about.definition).items()}
                columns = {each: meaning_of(types, about.datatype, name, each) for each in table.columns}
                writer.writerows((name, each, *meaning) for each, meaning in columns.items())
                self.write(os.path.join(self._folder, name), columns, table.blocks())
        return "{} tables".format(len(self._tables))


class Csv(Tables):
    def write(self, path, columns, blocks):
        with open(path + ".csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
            writer.writeheader()
            for block in blocks:
                writer.writerows(block)


class Parquet(Tables):
    def write(self, path, columns, blocks):
        import pyarrow
        from pyarrow import parquet

        kinds = {"bool": "bool_", "byte": "int8", "char": "uint8", "time": "float64", "duration": "float64"}
        schema = pyarrow.schema([pyarrow.field(name, getattr(pyarrow, kinds.get(kind, kind))(), metadata={"unit": unit})
                                 for name, (kind, unit) in columns.items()])  # fmt: skip
        with parquet.ParquetWriter(path + ".parquet", schema, compression="zstd") as writer:
            for block in blocks:
                writer.write_table(pyarrow.Table.from_pylist(block, schema))
