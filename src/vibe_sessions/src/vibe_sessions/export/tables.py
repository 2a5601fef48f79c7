"""Tables of topics: a row for each message, a column for each number; CSV, or Parquet where pyarrow is installed.

Which columns a table has is known at its end, so rows wait on disk, in blocks. An array of messages is a table of its own,
with the number of the element in the array.
"""

import csv
import functools
import itertools
import marshal
import operator
import os
import re
import tempfile

from .definitions import PRIMITIVES, fields_of, parts_of

BLOCK = 4096  # rows in memory
LONGEST = 64  # array that becomes columns
TIMES = ("time", "duration")
# of messages whose definitions do not say it
UNITS = {"geometry_msgs/Point": "m", "geometry_msgs/Wrench.force": "N", "geometry_msgs/Wrench.torque": "N m",
         "geometry_msgs/Twist.linear": "m/s", "geometry_msgs/Twist.angular": "rad/s",
         "geometry_msgs/Transform.translation": "m", "time": "s", "duration": "s"}  # fmt: skip


class Table:
    def __init__(self, spill):
        self.columns, self._names, self._rows, self._spill = {}, [], [], spill  # of columns the names alone, in the order of their values

    def add(self, row):
        if list(row) != self._names:
            self.columns.update(dict.fromkeys(row))
            self._names = list(self.columns)
            row = {name: row.get(name) for name in self._names}
        self._rows.append(list(row.values()))
        if len(self._rows) == BLOCK:
            self._flush()

    def _flush(self):
        marshal.dump(self._rows, self._spill)  # takes half as long as pickle
        self._rows = []

    def blocks(self):
        """Lists of rows, of which those before a column came are shorter."""
        self._flush()
        end = self._spill.tell()
        self._spill.seek(0)
        while self._spill.tell() < end:
            yield marshal.load(self._spill)


@functools.lru_cache(4096)
def columns_of(array, labels):
    return ["{}[{}]".format(array, label) for label in labels]


def steps_of(part, prefix=""):
    """How the columns of a message are filled, in their order, as (columns, type, whether it is an array, what gets the values,
    what gets the labels of an array). Numbers and texts that follow each other are one step."""
    run = []
    for name, kind in [*zip(part.__slots__, part._slot_types), ("", "[")]:
        base, bracket, _ = kind.partition("[")
        column = "header.frame_id" if prefix + name == "header" else prefix + name  # its stamp has a column
        if column == "header.frame_id" or (base in PRIMITIVES and base not in TIMES and not bracket):
            run.append(column)
            continue
        if run:
            yield run, "", False, operator.attrgetter(*run) if len(run) > 1 else lambda each, get=operator.attrgetter(*run): (get(each),), None
            run = []
        if name and (bracket or base in TIMES):
            labels = operator.attrgetter(prefix + "name") if "name" in part.__slots__ else None
            yield column, base, bool(bracket), operator.attrgetter(column), labels
        elif name:
            yield from steps_of(getattr(part, name), column + ".")


def number_of(value, kind):
    return value.to_nsec() / 1e9 if kind in TIMES else value


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
        self._steps = {}  # by class

    def add(self, message):
        name = message.connection.topic.strip("/").replace("/", "_")
        self._about[name] = message.connection
        key = {"received": message.received / 1e9, "stamp": message.time / 1e9}
        row = dict(key)
        self._fill(message.fields, row, name, key)
        self._add(name, row)

    def _add(self, name, row):
        if name not in self._tables:
            self._tables[name] = Table(self._files.enter_context(tempfile.TemporaryFile(dir=self._folder)))
        self._tables[name].add(row)

    def _fill(self, part, row, table, key):
        if type(part) not in self._steps:
            self._steps[type(part)] = list(steps_of(part))
        for columns, base, is_array, get, get_labels in self._steps[type(part)]:
            if is_array:
                self._fill_array(get(part), base, columns, row, table, key, get_labels and get_labels(part))
            elif base in TIMES:
                row[columns] = number_of(get(part), base)
            else:
                row.update(zip(columns, get(part)))

    def _fill_array(self, values, base, column, row, table, key, labels):
        if base not in PRIMITIVES:
            table += "." + column
            for number, value in enumerate(values):
                below = {**key, column: number}
                self._fill(value, below, table, dict(below))
                self._add(table, below)
        elif len(values) > LONGEST:
            row[column + ".length"] = len(values)  # a mesh or an image: nothing for a table
        elif values is not labels:  # which label the others, as in JointState
            named = isinstance(labels, list) and len(labels) == len(values) and base != "string"
            if base in TIMES:
                values = [number_of(value, base) for value in values]
            row.update(zip(columns_of(column, tuple(labels) if named else range(len(values))), values))

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
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            for block in blocks:
                writer.writerows(row + [None] * (len(columns) - len(row)) for row in block)


class Parquet(Tables):
    def write(self, path, columns, blocks):
        import pyarrow
        from pyarrow import parquet

        kinds = {"bool": "bool_", "byte": "int8", "char": "uint8", "time": "float64", "duration": "float64"}
        schema = pyarrow.schema([pyarrow.field(name, getattr(pyarrow, kinds.get(kind, kind))(), metadata={"unit": unit})
                                 for name, (kind, unit) in columns.items()])  # fmt: skip
        with parquet.ParquetWriter(path + ".parquet", schema, compression="zstd") as writer:
            for block in blocks:
                values = itertools.zip_longest(*block, [None] * len(columns))  # a row more, so that there is every column
                arrays = [pyarrow.array(column[:-1], field.type) for column, field in zip(values, schema)]
                writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))
