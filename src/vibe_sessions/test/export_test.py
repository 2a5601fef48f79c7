"""Exports of a recording: what is in the files, what an interruption leaves, and one sentence for what cannot be done."""

import contextlib
import csv
import ctypes
import errno
import glob
import io
import json
import os
import re
import shutil
import signal
import struct
import unittest
import zlib
from unittest import mock

import genpy
import numpy
import rosbag
import vibe_msgs.msg
from in_folder import InFolder
from killed import killed
from report_bags import SyntheticSession
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String

from vibe_sessions.export import gltf as gltf_module
from vibe_sessions.export import main as export
from vibe_sessions.export.definitions import COUNTED, fields_of, parts_of
from vibe_sessions.export.source import Source
from vibe_sessions.whole_file import digest


def tree(folder):
    """Bytes by path."""
    found = {}
    for place, _, names in os.walk(folder):
        for path in [os.path.join(place, name) for name in names]:
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


class ExportTest(InFolder):
    def setUp(self):
        super().setUp()
        self.bag, self.output = os.path.join(self.folder, "a", "session.bag"), os.path.join(self.folder, "out")
        os.mkdir(os.path.dirname(self.bag))

    def make(self, **options):
        return SyntheticSession(self.bag, **{"duration": 2.0, **options}).write()

    def call(self, *words, to="csv", output=None):
        """(status, what was said, what was complained of)"""
        said, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            try:
                status = export.main([*(words if words and words[0].endswith(("bag", "active")) else (self.bag, *words)),
                                      "--to", to, "--output", output or self.output])  # fmt: skip
            except SystemExit as ended:
                status = ended.code
        return status, said.getvalue(), complained.getvalue()

    def exports(self, *words, **options):
        status, said, complained = self.call(*words, **options)
        self.assertEqual((status, complained), (0, ""))
        return said

    def refuses(self, pattern, *words, **options):
        status, _, complained = self.call(*words, **options)
        self.assertEqual((status, complained.count("\n")), (2, 1), complained)
        self.assertRegex(complained, pattern)
        self.assertRegex(complained, "; |--help")  # the remedy
        self.assertNotIn("Traceback", complained)

    def table(self, name, form="a/csv"):
        with open(os.path.join(self.output, form, name + ".csv"), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def messages(self, topic):
        with rosbag.Bag(self.bag) as bag:
            return [message for _, message, _ in bag.read_messages(topics=["/" + topic])]


class TablesTest(ExportTest):
    def test_they_have_every_message(self):
        self.make()
        self.exports()
        with rosbag.Bag(self.bag) as bag:
            counts = {topic.strip("/").replace("/", "_"): about.message_count
                      for topic, about in bag.get_type_and_topic_info().topics.items()}  # fmt: skip
        for name, count in counts.items():
            self.assertEqual(len(self.table(name)), count, name)
        for row, message in zip(self.table("scope_measured_cp"), self.messages("scope/measured_cp")):
            self.assertEqual(float(row["pose.position.x"]), message.pose.position.x)
            self.assertEqual(float(row["stamp"]), message.header.stamp.to_nsec() / 1e9)
        inputs = self.table("applied_input")
        self.assertEqual([int(row["state_hash"]) for row in inputs], [m.state_hash for m in self.messages("applied_input")])
        self.assertEqual(inputs[0]["joints[6]"], "0.0")
        self.assertEqual({row["sutures"] + row["bites"] for row in self.table("sutures.sutures.bites")}, {"00", "01"})
        self.assertEqual(self.table("procedure_skill_metrics")[0]["log_dimensionless_jerk"], "nan")

    def test_no_two_topics_share_a_table(self):
        self.make()
        alike = {"/left_scope/force": Float64, "/left/scope/force": Float64, "/left/scope_force": String, "/columns": Float64}
        with rosbag.Bag(self.bag, "a") as bag:
            for number, (topic, kind) in enumerate(alike.items()):
                bag.write(topic, kind(str(number) if kind is String else number), genpy.Time(2))
        self.exports()
        found = {row["topic"]: (row["table"], row["type"], row["unit"]) for row in self.table("columns") if row["column"] == "data"}
        self.assertEqual(len({name for name, _, _ in found.values()}), len(found))
        for number, (topic, kind) in enumerate(alike.items()):
            name, type_name, unit = found[topic]
            self.assertEqual((type_name, unit), ("string" if kind is String else "float64", ""))
            self.assertEqual([float(row["data"]) for row in self.table(name)], [number])

    def test_an_invalid_stamp_and_a_joint_that_is_named_twice(self):
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/joints", JointState(name=["a", "b", "a"], position=[1, 2, 3]), genpy.Time(7))
        self.exports()
        (row,) = self.table("joints")
        self.assertEqual((row["received"], row["stamp"]), ("7.0", "0.0"))
        self.assertEqual([row["position[{}]".format(k)] for k in range(3)], ["1.0", "2.0", "3.0"])

    def test_units_of_our_messages(self):
        """A number that counts, a word and a truth have none, and what is in brackets and no unit is none."""
        seen = set()
        for kind in vars(vibe_msgs.msg).values():
            for part, text in parts_of(kind._type, kind._full_text).items() if hasattr(kind, "_full_text") else ():
                for name, (type_name, unit) in fields_of(part, text).items():
                    if part.startswith("vibe_msgs/") and unit:
                        self.assertNotIn(type_name, COUNTED, (part, name))
                        seen.add(unit)
        self.assertEqual(seen, {"m", "s", "ms", "N", "J", "Pa", "rad", "px", "m/s", "N/m", "N s/m", "m^2", "m^3", "m^3/s", "m or rad",
                                "m/s or rad/s", "N or N m", "N/m or N m/rad", "N s/m or N m s/rad"})  # fmt: skip
        self.assertEqual(fields_of("a/B", "# At k of x[k] [m].\nfloat64 x\nbool y\nuint8 Z = 1\nfloat64 z\nuint8 n  # [px]"), {
            "x": ("float64", "m"), "y": ("bool", ""), "z": ("float64", ""), "n": ("uint8", "px")})  # fmt: skip

    def test_columns_and_their_units(self):
        self.make(origin=1.7e9)
        self.exports()
        rows = {(row["table"], row["column"]): row for row in self.table("columns")}
        units = {("scope_measured_cp", "pose.position.x"): "m", ("scope_measured_cf", "wrench.force.z"): "N",
                 ("procedure_state", "pressure"): "Pa", ("applied_input", "stamp"): "s", ("sutures.sutures.bites", "depth"): "m",
                 ("scope_measured_cp", "pose.orientation.w"): "", ("applied_input", "buttons[0]"): ""}  # fmt: skip
        self.assertEqual({key: rows[key]["unit"] for key in units}, units)
        self.assertEqual(rows["applied_input", "state_hash"]["type"], "uint64")
        counts = [row for row in rows.values() if row["column"].endswith(".length") or row["column"] == "sutures"]
        self.assertEqual({row["unit"] for row in counts}, {""})
        for table in {name for name, _ in rows}:
            with open(os.path.join(self.output, "a/csv", table + ".csv"), encoding="utf-8") as file:
                self.assertEqual(file.readline().strip().split(","), [column for name, column in rows if name == table])
        self.assertEqual(self.table("scope_input_joint_states")[0]["position[insertion]"], "0.1")

    def test_topics_time_and_rate(self):
        self.make()
        self.exports("--topics", "scope/*,procedure/events", "--from", "1.5", "--to-time", "2.5", "--rate", "10")
        found = sorted(os.path.basename(path)[:-4] for path in glob.glob(self.output + "/a/csv/*.csv"))
        self.assertEqual(found, ["columns", "scope_measured_cf", "scope_measured_cp"])  # the event was before
        stamps = [float(row["stamp"]) for row in self.table("scope_measured_cp")]
        self.assertEqual(len(stamps), 11)
        self.assertTrue(all(1.5 <= stamp <= 2.5 for stamp in stamps))
        self.assertLess(abs(numpy.diff(stamps) - 0.1).max(), 1e-6)

    def test_what_is_sent_once_is_there_at_any_time(self):
        self.make()
        self.exports("--from", "2.5", to="mcap,mesh")
        with Source(self.bag, begin=2.5) as source:
            topics = {message.connection.topic for message in source.messages(source.chosen)}
        self.assertLess({"/scene", "/tissue/topology"}, topics)
        self.assertNotIn("/procedure/events", topics)

    def test_messages_come_in_the_order_of_time_from_a_bag_that_was_filled(self):
        self.make()
        with rosbag.Bag(self.bag) as bag:
            every = list(bag.read_messages(raw=True))
        with rosbag.Bag(self.bag, "w", chunk_threshold=4096) as bag:  # results first, as a replay writes them
            for inputs in (False, True):
                for topic, message, stamp in every:
                    if (topic == "/applied_input") == inputs:
                        bag.write(topic, message, stamp, raw=True)
        with Source(self.bag) as source:
            found = [(message.received, message.connection.topic) for message in source.messages(source.chosen)]
        self.assertEqual(len(found), len(every))
        self.assertEqual([time for time, _ in found], sorted(time for time, _ in found))


class McapTest(ExportTest):
    def records(self, data):
        """(operation, content)"""
        at = 0
        while at < len(data):
            operation, size = struct.unpack_from("<BQ", data, at)
            yield operation, data[at + 9 : at + 9 + size]
            at += 9 + size

    def test_chunks_and_their_index(self):
        self.make(duration=20.0)
        self.exports(to="mcap")
        with open(self.output + "/a/mcap/session.mcap", "rb") as file:
            whole = file.read()
        self.assertEqual((whole[:8], whole[-8:]), (b"\x89MCAP0\r\n",) * 2)
        zstd, size, chunks, indexed = ctypes.CDLL("libzstd.so.1"), ctypes.c_size_t, [], []
        for operation, content in self.records(whole[8:-8]):
            if operation == 6:
                length, crc = struct.unpack_from("<QI", content, 16)
                out = ctypes.create_string_buffer(length)
                zstd.ZSTD_decompress(out, size(length), content[44:], size(len(content) - 44))
                self.assertEqual(zlib.crc32(out.raw), crc)
                chunks.append(out.raw)
            elif operation == 7:
                for time, place in struct.iter_unpack("<QQ", content[6:]):
                    self.assertEqual(chunks[-1][place], 5)  # a message, received then
                    self.assertEqual(struct.unpack_from("<Q", chunks[-1], place + 15)[0], time)
                    indexed.append(time)
            elif operation == 8:
                begin, length = struct.unpack_from("<QQ", content, 16)
                self.assertEqual(next(self.records(whole[begin : begin + length]))[0], 6)
        with rosbag.Bag(self.bag) as bag:
            self.assertEqual(sorted(indexed), sorted(stamp.to_nsec() for _, _, stamp in bag.read_messages(raw=True)))
        (end,) = (content for operation, content in self.records(whole[8:-8]) if operation == 15)
        self.assertEqual(struct.unpack("<I", end)[0], zlib.crc32(whole[: whole.index(struct.pack("<BQ", 15, 4) + end)]))


class MeshTest(ExportTest):
    def test_points_and_triangles(self):
        self.make()
        self.exports(to="mesh")
        cloud, topology = self.messages("tissue/particles")[0], self.messages("tissue/topology")[0]
        points = numpy.frombuffer(cloud.data, numpy.dtype([("xyz", "<f4", 3), ("grade", "u1"), ("", "V3")]))
        with open(os.path.join(self.output, "a/mesh/ply/wall_000000.ply"), "rb") as file:
            header, body = file.read().split(b"end_header\n")
        self.assertIn(b"element vertex 208\n", header)
        vertices = numpy.frombuffer(body[: 13 * 208], numpy.dtype([("xyz", "<f4", 3), ("grade", "u1")]))
        numpy.testing.assert_array_equal(vertices["xyz"], points["xyz"])
        numpy.testing.assert_array_equal(vertices["grade"], points["grade"])
        faces = numpy.frombuffer(body[13 * 208 :], numpy.dtype([("count", "u1"), ("of", "<i4", 3)]))
        self.assertEqual(faces["of"].ravel().tolist(), list(topology.triangles))
        with open(os.path.join(self.output, "a/mesh/wall.usda"), encoding="utf-8") as file:
            text = file.read()
        sample = re.search(r"^ +72\.0: \[(.*)\],$", text, re.MULTILINE)[1]  # at 3 s
        self.assertEqual(numpy.array(re.findall("[-.e0-9]+", sample), "f4").tolist(), points["xyz"].ravel().tolist())
        self.assertEqual(text.count("{"), text.count("}"))
        self.assertIn("endTimeCode = 72.0 ", text)


class GltfTest(ExportTest):
    def read(self, path):
        """What the text says, and the values of each accessor."""
        with open(path, "rb") as file:
            data = file.read()
        magic, version, size, length, kind = struct.unpack_from("<4sIIII", data)
        self.assertEqual((magic, version, size, kind, length % 4), (b"glTF", 2, len(data), 0x4E4F534A, 0))
        self.assertEqual(struct.unpack_from("<II", data, 20 + length), (len(data) - length - 28, 0x004E4942))
        gltf, values = json.loads(data[20 : 20 + length]), []
        for accessor in gltf["accessors"]:
            view = gltf["bufferViews"][accessor["bufferView"]]
            width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
            found = numpy.frombuffer(data, {5126: "<f4", 5125: "<u4"}[accessor["componentType"]], accessor["count"] * width, 28 + length + view["byteOffset"])
            self.assertEqual(found.nbytes, view["byteLength"])
            values.append(found.reshape(-1, width))
            if "min" in accessor:
                self.assertEqual((accessor["min"], accessor["max"]), (values[-1].min(axis=0).tolist(), values[-1].max(axis=0).tolist()))
        return gltf, values

    def test_each_frame_is_that_of_its_message(self):
        self.make()
        with rosbag.Bag(self.bag, "a") as bag:  # three frames more, each a little larger
            cloud = next(message for _, message, _ in bag.read_messages(topics=["/tissue/particles"]))
            points = numpy.frombuffer(cloud.data, "<f4").reshape(-1, 4)
            for k in range(1, 4):
                moved = points.copy()
                moved[:, :3] *= 1 + 0.1 * k
                cloud.data, cloud.header.stamp = moved.tobytes(), genpy.Time.from_sec(3 + k / 7)
                bag.write("/tissue/particles", cloud, cloud.header.stamp)
        self.exports(to="gltf")
        gltf, values = self.read(self.output + "/a/gltf/wall.glb")
        x, y, z, w = gltf["nodes"][-1]["rotation"]
        numpy.testing.assert_allclose([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)], [0, 1, 0], atol=1e-15)  # z is up
        (primitive,) = gltf["meshes"][0]["primitives"]
        base, targets = values[primitive["attributes"]["POSITION"]], [values[each["POSITION"]] for each in primitive["targets"]]
        (weights,) = (sampler for channel, sampler in zip(gltf["animations"][0]["channels"], gltf["animations"][0]["samplers"])
                      if channel["target"]["path"] == "weights")  # fmt: skip
        weights = values[weights["output"]].reshape(-1, len(targets))
        frames, clouds = self.table("frames", "a/gltf"), self.messages("tissue/particles")
        self.assertEqual((len(weights), len(frames)), (4, 4))
        for row, weight, cloud in zip(frames, weights, clouds):
            shown = base + sum(each * target for each, target in zip(weight, targets))
            wanted = numpy.frombuffer(cloud.data, "<f4").reshape(-1, 4)[:, :3]
            self.assertLessEqual(abs(shown - wanted).max(), float(row["deviation [m]"]) * 1.01)
            self.assertLess(float(row["deviation [m]"]), 1e-8)
            self.assertEqual(float(row["stamp [s]"]), cloud.header.stamp.to_nsec() / 1e9)
        self.assertEqual(values[primitive["indices"]].ravel().tolist(), list(self.messages("tissue/topology")[0].triangles))

    def test_the_scope_moves_as_it_was_measured(self):
        self.make()
        with rosbag.Bag(self.bag, "a") as bag:
            cloud = next(message for _, message, _ in bag.read_messages(topics=["/tissue/particles"]))
            cloud.header.stamp = genpy.Time(2)
            bag.write("/tissue/particles", cloud, cloud.header.stamp)
        self.exports(to="gltf")
        gltf, values = self.read(self.output + "/a/gltf/wall.glb")
        channels = {channel["target"]["path"]: gltf["animations"][0]["samplers"][channel["sampler"]] for channel in gltf["animations"][0]["channels"]
                    if gltf["nodes"][channel["target"]["node"]]["name"] == "scope_tip"}  # fmt: skip
        poses = [message for message in self.messages("scope/measured_cp") if message.header.stamp.to_sec() >= 2]
        numpy.testing.assert_allclose(values[channels["translation"]["output"]], [[p.x, p.y, p.z] for p in (m.pose.position for m in poses)], atol=1e-8)
        numpy.testing.assert_allclose(values[channels["translation"]["input"]].ravel(), [m.header.stamp.to_sec() - 2 for m in poses], atol=1e-6)
        self.assertEqual(values[channels["rotation"]["output"]].tolist(), [[0, 0, 0, 1]] * len(poses))

    def test_what_cannot_be_one_file(self):
        self.make()
        with mock.patch.object(gltf_module, "MOST", 0):
            self.refuses("has more than 0 frames, .*give a lower --rate", to="gltf")


class InterruptedTest(ExportTest):
    FORMATS = "csv,mcap,mesh,gltf"

    def reference(self):
        self.make(duration=0.5)
        self.exports(to=self.FORMATS, output=self.folder + "/reference")
        return tree(self.folder + "/reference")

    def check_left(self, wanted):
        """Under final names there are whole formats only."""
        left = {path: data for path, data in tree(self.output).items() if not any(part.startswith(".") for part in path.split("/"))}
        for form in {path.split("/")[1] for path in left}:
            self.assertEqual({path for path in left if path.split("/")[1] == form}, {path for path in wanted if path.split("/")[1] == form})
        self.assertEqual(left, {path: wanted[path] for path in left})
        return left

    def test_same_bytes_and_kept(self):
        wanted = self.reference()
        self.exports(to=self.FORMATS)
        self.assertEqual(tree(self.output), wanted)
        times = {path: os.stat(os.path.join(self.output, path)).st_mtime_ns for path in wanted}
        self.assertEqual(self.exports(to=self.FORMATS).count("complete, kept"), len(self.FORMATS.split(",")))
        self.assertEqual({path: os.stat(os.path.join(self.output, path)).st_mtime_ns for path in wanted}, times)
        self.refuses("other options; remove it", "--rate", "5")

    def test_a_full_disk_at_any_moment_leaves_whole_formats(self):
        wanted, number, complete = self.reference(), 0, False
        while not complete:
            number += 13
            calls, flush = iter(range(number)), export.flush

            def full(path, calls=calls, flush=flush):
                if next(calls, None) is None:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)
                flush(path)

            shutil.rmtree(self.output, ignore_errors=True)
            with mock.patch.object(export, "flush", full):
                status, _, complained = self.call(to=self.FORMATS)
            complete = status == 0
            if not complete:
                self.assertRegex(complained, "^export: No space left on device .*make room there.*same command goes on.*\n$")
                self.check_left(wanted)
                self.assertFalse([path for path in tree(self.output) if "/." in path])  # the room is free again
                self.exports(to=self.FORMATS)
            self.assertEqual(self.check_left(wanted), wanted)
        self.assertGreater(number, 30)

    def test_a_kill_at_any_moment_keeps_what_is_finished_and_leaves_nothing_half_done(self):
        wanted, at, status = self.reference(), 0, None
        formats = sorted(self.FORMATS.split(","))
        while status != 0:
            at += 6
            shutil.rmtree(self.output, ignore_errors=True)
            status = killed(at, lambda: export.main([self.bag, "--to", self.FORMATS, "--output", self.output]))
            self.assertIn(status, (0, -signal.SIGKILL))
            left = self.check_left(wanted)
            times = {path: os.stat(os.path.join(self.output, path)).st_mtime_ns for path in left}
            self.exports(to=self.FORMATS)
            self.assertEqual(tree(self.output), wanted)
            self.assertEqual(sorted(os.listdir(self.output + "/a")), formats)
            self.assertEqual({path: os.stat(os.path.join(self.output, path)).st_mtime_ns for path in left}, times)
        self.assertGreater(at, 12 * len(formats))

    def test_what_a_killed_export_has_repeated_is_not_repeated_again(self):
        self.make(duration=0.5)
        scratch = os.path.join(self.output, "a", ".filling")
        os.makedirs(scratch)
        shutil.copy(self.bag, os.path.join(scratch, digest(self.bag) + ".bag"))
        asked = mock.patch.object(Source, "is_compact", lambda source: True)
        with asked, mock.patch.object(export, "repeat") as repeat:
            self.exports("--fill")
            repeat.assert_not_called()
            self.assertEqual(os.listdir(self.output + "/a"), ["csv"])
            os.makedirs(scratch)
            shutil.copy(self.bag, os.path.join(scratch, "of_another.bag"))
            repeat.side_effect = shutil.copy
            self.exports("--fill", to="mcap")
            repeat.assert_called_once()


class RefusalTest(ExportTest):
    def test_calls(self):
        self.make()
        self.refuses("'cvs' is no format; the nearest is 'csv'", to="cvs")
        self.refuses("needs Hz from 0.001 on, not '0'", "--rate", "0")
        self.refuses("needs seconds from 0 on, not 'soon'", "--from", "soon")
        self.refuses("must be later than --from", "--from", "2", "--to-time", "1")
        self.refuses("no topic 'scope/measured_fc'; the nearest is 'scope/measured_c.'", "--topics", "scope/measured_fc")
        self.refuses("needs the Python package pyarrow|has no scope/measured_js", to="lerobot")
        self.refuses("--rate of lerobot", "--rate", "2.5", to="lerobot")

    def test_recordings(self):
        self.refuses("there is no such file|no recording")
        path = self.make()
        with open(path, "rb") as file:
            whole = file.read()
        for data, pattern in ((b"", "is empty"), (b"x" * 99, "is not a bag"), (whole[: len(whole) // 2], "not closed.*rosbag reindex")):
            with open(path, "wb") as file:
                file.write(data)
            for form in ("csv", "mcap", "mesh", "gltf"):
                self.refuses(pattern, to=form)
            self.assertEqual(tree(self.output), {})
        self.make(without=("tissue/topology",))
        self.refuses("has no tissue/topology", to="mesh")
        self.refuses("has no tissue/topology", to="gltf")
        self.make(scene="nonsense: 1\n")
        self.refuses("does not repeat.*nonsense.*export what it has", "--rate", "30", to="mesh")

    def test_an_edited_definition(self):
        path = self.make()
        with open(path, "rb") as file:
            whole = file.read()
        edited = whole.replace(b"\nfloat64 depth\n", b"\nstring  depth\n").replace(b"\nfloat64 pressure\n", b"\nstring  pressure\n")
        self.assertNotEqual(edited, whole)
        with open(path, "wb") as file:
            file.write(edited)
        for form in ("csv", "mcap"):
            self.refuses("is not that of its MD5 sum.*edited", to=form)

    def test_one_of_several(self):
        self.make()
        bad = os.path.join(self.folder, "b", "session.bag")
        os.mkdir(os.path.dirname(bad))
        with open(bad, "wb"):
            pass
        self.refuses("b/session.bag: is empty, ", bad, self.bag)
        self.assertEqual({path.split("/")[0] for path in tree(self.output)}, {"a"})

    def test_another_export_writes_there(self):
        self.make()
        os.makedirs(self.output)
        handle = os.open(self.output, os.O_RDONLY)
        self.addCleanup(os.close, handle)
        export.fcntl.flock(handle, export.fcntl.LOCK_EX)
        self.refuses("another export writes there; wait for it")


if __name__ == "__main__":
    unittest.main()
