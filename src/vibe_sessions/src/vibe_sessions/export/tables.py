"""Tables of topics: a row for each message, a column for each number; CSV, or Parquet where pyarrow is installed.

Which columns a table has is known at its end, so rows wait on disk, in blocks. An array of messages is a table of its own,
with the number of the element in the array.
"""

import csv
import os
import pickle
import re
import tempfile

from .definitions import PRIMITIVES, structure

BLOCK = 4096  # rows in memory
LONGEST = 64  # array that becomes columns
# of messages whose definitions do not say it
UNITS = {"geometry_msgs/Point": "m", "geometry_msgs/Wrench.force": "N", "geometry_msgs/Wrench.torque": "N m",
         "geometry_msgs/Twist.linear": "m/s", "geometry_msgs/Twist.angular": "rad/s",
         "geometry_msgs/Transform.translation": "m", "time": "s", "duration": "s"}  # fmt: skip


class Table:
    def __init__(self, spill):
        self.rows, self.columns = [], {}  # of columns the names alone
        self._spill = spill

    def add(self, row):
        self.rows.append(row)
        if not row.keys() <= self.columns.keys():
            self.columns.update(dict.fromkeys(row))
        if len(self.rows) == BLOCK:
            self._flush()

    def _flush(self):
        pickle.dump(self.rows, self._spill, pickle.HIGHEST_PROTOCOL)
        self.rows = []

    def blocks(self):
        self._flush()
        end = self._spill.tell()
        self._spill.seek(0)
        while self._spill.tell() < end:
            yield pickle.load(self._spill)


class Flattener:
    """Rows of the messages of a topic, for its table and those of the arrays in it."""

    def __init__(self, add):
        self._add = add  # (table, row)

    def add(self, table, message):
        key = {"received": message.received / 1e9, "stamp": message.time / 1e9}
        row = dict(key)
        self._fill(message.fields, "", row, table, key)
        self._add(table, row)

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


def number_of(value, kind):
    return value.to_nsec() / 1e9 if kind in ("time", "duration") else value


def meaning_of(types, datatype, table, column):
    """(type, unit, comment) of a column: that of the field from which it comes."""
    if column in ("received", "stamp"):
        return "float64", "s", "when it was received" if column == "received" else "time of the sample"
    unit, comment, found = "", "", None
    for name in [*table.split(".")[1:], *re.sub(r"\[.*\]$", "", column).split(".")]:
        found = next((field for field in types.get(datatype, ()) if field.name == name), None)
        if found is None:
            break
        unit = found.unit or UNITS.get(datatype + "." + name) or UNITS.get(found.kind) or unit
        comment = found.comment or comment  # of a vector, where x says nothing
        datatype = found.kind
    if found is None or found.kind not in PRIMITIVES:
        return "uint32", "", "number of the element, or of elements"
    return found.kind, unit, comment


class Tables:
    """What csv and parquet share; they differ in how a table is written."""

    def __init__(self, folder, source, files):
        self.connections = source.chosen
        self._folder, self._files, self._tables, self._about = folder, files, {}, {}
        self._flattener = Flattener(self._row)

    def add(self, message):
        name = message.connection.topic.strip("/").replace("/", "_")
        self._about[name] = message.connection
        self._flattener.add(name, message)

    @staticmethod
    def needs_more(_arguments):
        return False

    def _row(self, name, row):
        if name not in self._tables:
            self._tables[name] = Table(self._files.enter_context(tempfile.TemporaryFile(dir=self._folder)))
        self._tables[name].add(row)

    def finish(self):
        with open(os.path.join(self._folder, "columns.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("table", "column", "type", "unit", "description"))
            for name in sorted(self._tables):
                connection, table = self._about[name.split(".")[0]], self._tables[name]
                types = structure(connection.datatype, connection.definition)
                columns = {each: meaning_of(types, connection.datatype, name, each) for each in table.columns}
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
    PACKAGES = ("pyarrow",)

    def write(self, path, columns, blocks):
        import pyarrow
        from pyarrow import parquet

        kinds = {"bool": pyarrow.bool_(), "byte": pyarrow.int8(), "char": pyarrow.uint8(), "time": pyarrow.float64(),
                 "duration": pyarrow.float64()}  # fmt: skip
        schema = pyarrow.schema([
            pyarrow.field(name, kinds.get(kind) or getattr(pyarrow, kind)(), metadata={"unit": unit, "description": comment})
            for name, (kind, unit, comment) in columns.items()
        ])  # fmt: skip
        with parquet.ParquetWriter(path + ".parquet", schema, compression="zstd") as writer:
            for block in blocks:
                writer.write_table(pyarrow.Table.from_pylist(block, schema))
