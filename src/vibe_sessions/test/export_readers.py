"""What the readers of others find in exports. Called by scripts/test.d/export.sh with a name of a class, in an environment with
the packages of readers.txt."""

import contextlib
import ctypes
import dataclasses
import glob
import io
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import unittest

import numpy
import rosbag
import genpy
from export_lerobot_test import EpisodesTest
from export_ros2_test import TYPES
from export_test import ExportTest, InterruptedTest
from killed import killed
from random_messages import content, random_message
from sensor_msgs.msg import Image
from sensor_msgs.point_cloud2 import read_points

from vibe_sessions.export import main as export
from vibe_sessions.export import ros2_package
from vibe_sessions.export.definitions import fields_of, parts_of
from vibe_sessions.headless import call, find_program
from vibe_sessions.imports.session import write_commands


def content2(message):
    """Of a message of ROS 2 in the classes of either reader: lists and numbers, as content() of one of ROS 1."""
    if isinstance(message, (bool, int, float, str)):
        return message
    if hasattr(message, "tolist"):
        return content2(message.tolist())
    if isinstance(message, (list, tuple, bytes)):
        return [content2(each) for each in message]
    if dataclasses.is_dataclass(message):
        names = [field.name for field in dataclasses.fields(message) if not field.name.startswith(("structure_needs", "__"))]
    else:
        names = message.__slots__
    return [content2(getattr(message, name)) for name in names if not name.isupper()]


class McapReaders(ExportTest):
    """Every type of message, three times each, on topics of their own."""

    def setUp(self):
        super().setUp()
        dice, self.expected = random.Random(3), {}
        with rosbag.Bag(self.bag, "w", compression="bz2") as bag:
            for k in range(3 * len(TYPES)):
                kind, stamp = TYPES[k % len(TYPES)], genpy.Time(1 + k, 5)
                topic = "/of/" + kind._type.replace("/", "_")
                message = random_message(kind, dice)
                bag.write(topic, message, stamp)
                self.expected.setdefault(topic, []).append((stamp.to_nsec(), repr(content(message))))
        self.exports(to="mcap")
        self.mcap = os.path.join(self.output, "a/mcap/session.mcap")

    def with_mcap(self):
        from mcap.reader import make_reader
        from mcap.stream_reader import StreamReader
        from mcap_ros2.decoder import DecoderFactory

        found = {}
        with open(self.mcap, "rb") as file:
            list(StreamReader(file, validate_crcs=True).records)
            file.seek(0)
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            for _, channel, message, decoded in reader.iter_decoded_messages():
                found.setdefault(channel.topic, []).append((message.log_time, repr(content2(decoded))))
            statistics = reader.get_summary().statistics
        self.assertEqual(statistics.message_count, sum(map(len, self.expected.values())))
        self.assertEqual(statistics.channel_count, len(self.expected))
        return found

    def with_rosbags(self):
        from rosbags.highlevel import AnyReader

        found = {}
        with AnyReader([pathlib.Path(self.mcap)]) as reader:
            for connection, time, data in reader.messages():
                found.setdefault(connection.topic, []).append((time, repr(content2(reader.deserialize(data, connection.msgtype)))))
        return found

    def test_both_find_every_field_of_every_message(self):
        for read in (self.with_mcap, self.with_rosbags):
            found = read()
            self.assertEqual(sorted(found), sorted(self.expected))
            for topic, messages in self.expected.items():
                self.assertEqual(found[topic], messages, topic)

    def test_a_byte_that_is_changed_is_noticed(self):
        import zstandard
        from mcap.stream_reader import CRCValidationError

        with open(self.mcap, "r+b") as file:
            file.seek(os.path.getsize(self.mcap) // 10)
            byte = file.read(1)
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte[0] ^ 1]))
        with self.assertRaises((CRCValidationError, zstandard.ZstdError)):
            self.with_mcap()


class SessionTest(ExportTest):
    """A recording of the simulator with every topic, and a picture."""

    def setUp(self):
        super().setUp()
        scene = pathlib.Path(__file__).parents[1] / "regressions/scenes/coarse_stomach.yaml"
        write_commands(self.folder + "/commands.bag", str(scene), 1 / 60, numpy.zeros((5, 7)), numpy.zeros((5, 6), numpy.uint8))
        replay = find_program("vibe_sim", "vibe_replay")
        call(["--record", self.folder + "/new.bag", self.folder + "/commands.bag"], program=replay)
        call(["--fill", self.bag, self.folder + "/new.bag"], program=replay, accepted=(0, 3))
        with rosbag.Bag(self.bag, "a") as bag:
            bag.write("/endoscope/image_raw", Image(height=2, width=2, encoding="rgb8", step=6, data=b"abcdefghijkl"), genpy.Time(1))


class FoxgloveLayout(SessionTest):
    DRAWN = {"sensor_msgs/msg/PointCloud2", "geometry_msgs/msg/PoseStamped"}  # by the panel 3D itself

    def test_all_that_it_shows_is_there(self):
        from mcap.reader import make_reader

        self.exports(to="mcap")
        with open(self.output + "/a/mcap/foxglove.json", encoding="utf-8") as file:
            layout = json.load(file)
        with open(self.output + "/a/mcap/session.mcap", "rb") as file:
            summary = make_reader(file).get_summary()
        kinds = {channel.topic: summary.schemas[channel.schema_id] for channel in summary.channels.values()}
        panels = layout["configById"]
        self.assertEqual(sorted(panels), sorted(re.findall('"([^"]*!.*?)"', json.dumps(layout["layout"]))))
        for topic, about in panels["3D!organ"]["topics"].items():
            self.assertIn(kinds[topic].name, self.DRAWN, topic)
            if "colorField" in about:
                self.assertIn(about["colorField"], [field.name for field in self.messages(topic.strip("/"))[0].fields])
        self.assertEqual(kinds[panels["Image!picture"]["imageMode"]["imageTopic"]].name, "sensor_msgs/msg/Image")
        for path in (path["value"] for panel in panels.values() for path in panel.get("paths", ())):
            topic, *names = path.split(".")
            kind = kinds[topic].name.replace("/msg/", "/")
            parts = parts_of(kind, kinds[topic].data.decode())
            for name in names:
                kind = fields_of(kind, parts[kind], arrays=True)[name.partition("[")[0]][0]
                self.assertEqual(kind.endswith("]"), name.endswith("]"), path)
                kind = kind.partition("[")[0]
            self.assertIn(kind, ("float64", "string"), path)


class RerunView(SessionTest):
    def test_rerun_reads_what_the_recording_has(self):
        self.exports(to="mcap")
        python, file = os.environ["VIBE_RERUN"], self.folder + "/session.rrd"
        subprocess.run([python, self.output + "/a/mcap/rerun_view.py", "--save", file], check=True)
        judge = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rerun_judge.py")
        found = json.loads(subprocess.run([python, "-B", judge, file], check=True, stdout=subprocess.PIPE).stdout)
        drawn = {"/world/organ/wall": "tissue/particles", "/world/scope_tip": "scope/measured_cp", "/force": "scope/measured_cf",
                 "/world/scope_tip/force": "scope/measured_cf", "/world/threads": "sutures", "/events": "procedure/events",
                 "/phase": "procedure/state", "/picture": "endoscope/image_raw"}
        self.assertEqual(found["layouts"], 1)
        for entity, topic in drawn.items():
            static = entity in ("/force",)  # the names of its curves
            self.assertEqual(found["rows"].get(entity, 0) - static, len(self.messages(topic)), entity)
        cloud, topology = self.messages("tissue/particles")[0], self.messages("tissue/topology")[0]
        expected = numpy.array(list(read_points(cloud, ["x", "y", "z"])), numpy.float32)
        numpy.testing.assert_array_equal(numpy.array(found["vertex_positions"], numpy.float32), expected)
        self.assertEqual(numpy.ravel(found["triangle_indices"]).tolist(), list(topology.triangles))
        outward = (expected - expected.mean(0)) * numpy.array(found["vertex_normals"])
        self.assertGreater((outward.sum(1) > 0).mean(), 0.8)


class Ros2Package(unittest.TestCase):
    def test_every_definition_is_read_and_has_a_hash(self):
        import rospkg
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        files = ros2_package.files_of(rospkg.RosPack().get_path("vibe_msgs"))
        for name in (Stores.ROS2_FOXY, Stores.ROS2_JAZZY):
            store, types = get_typestore(name), {}
            for path, text in files.items():
                if path.startswith("msg/"):
                    types.update(get_types_from_msg(text, "vibe_msgs/msg/" + path[4:-4]))
                elif path.startswith("srv/"):
                    for part, half in zip(("_Request", "_Response"), text.split("---\n")):
                        types.update(get_types_from_msg(half, "vibe_msgs/srv/" + path[4:-4] + part))
            store.register(types)
            self.assertEqual(len({store.hash_rihs01(each) for each in types}), len(types))
            self.assertEqual(len(types), len([each for each in files if each.startswith("msg/")]) + 2 * len([each for each in files if each.startswith("srv/")]))


class ParquetReader(InterruptedTest):
    FORMATS = "csv,parquet"

    def test_same_as_csv(self):
        from pyarrow import parquet

        self.make()
        self.exports(to="csv,parquet")
        paths = glob.glob(self.output + "/a/parquet/*.parquet")
        self.assertGreater(len(paths), 8)
        for path in paths:
            table, rows = parquet.read_table(path), self.table(os.path.basename(path)[:-8])
            self.assertEqual(table.num_rows, len(rows))
            self.assertEqual(["" if value is None else str(value) for row in table.to_pylist() for value in row.values()],
                             [value for row in rows for value in row.values()])  # fmt: skip
        units = {field.name: field.metadata[b"unit"] for field in parquet.read_schema(self.output + "/a/parquet/scope_measured_cp.parquet")}
        self.assertEqual(units["pose.position.x"], b"m")


class UsdReader(ExportTest):
    def test_points_of_a_sample_are_those_of_the_message(self):
        from pxr import Usd, UsdGeom

        self.make()
        self.exports(to="mesh")
        stage = Usd.Stage.Open(self.output + "/a/mesh/wall.usda")
        (mesh,) = (UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
        self.assertEqual(mesh.GetPointsAttr().GetTimeSamples(), [72.0])  # at 3 s
        self.assertEqual((stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()), (72, 72, 24))
        cloud = self.messages("tissue/particles")[0]
        points = numpy.frombuffer(cloud.data, numpy.dtype([("xyz", "<f4", 3), ("", "V4")]))["xyz"]
        numpy.testing.assert_array_equal(numpy.array(mesh.GetPointsAttr().Get(72.0)), points)
        indices, counts = mesh.GetFaceVertexIndicesAttr().Get(), mesh.GetFaceVertexCountsAttr().Get()
        self.assertTrue(UsdGeom.Mesh.ValidateTopology(indices, counts, len(points))[0])
        self.assertEqual(list(indices), list(self.messages("tissue/topology")[0].triangles))


class LerobotReader(EpisodesTest):
    def test_rows_are_those_of_the_episodes(self):
        from pyarrow import parquet

        folder = os.path.dirname(self.write())
        contents = []
        for place in ("/a", "/b"):
            self.assertEqual(export.main([self.path, "--to", "lerobot", "--output", folder + place]), 0)
            paths = sorted(path for path in glob.glob(folder + place + "/lerobot/**", recursive=True) if os.path.isfile(path))
            contents.append({os.path.relpath(path, folder + place + "/lerobot"): pathlib.Path(path).read_bytes() for path in paths})
        self.assertEqual(*contents)
        info = json.loads(contents[0]["meta/info.json"])
        self.assertEqual(info["splits"], {"train": "0:1", "recovery": "1:2", "failure": "2:4"})
        for number, (episode, _, _) in enumerate(self.episodes()):
            table = parquet.read_table(folder + "/a/lerobot/data/chunk-000/file-{:03d}.parquet".format(number)).to_pydict()
            for name, rows in episode.columns().items():
                numpy.testing.assert_array_equal(numpy.array(table[name]).reshape(rows.shape), rows)

    def files(self, folder):
        """(bytes, time of the last change) by path."""
        paths = [path for path in pathlib.Path(folder).rglob("*") if path.is_file()]
        return {str(path.relative_to(folder)): (path.read_bytes(), path.stat().st_mtime_ns) for path in paths}

    def test_a_kill_at_any_moment_keeps_finished_episodes(self):
        first, second = self.write(), os.path.join(self.folder, "second", "session.bag")
        self.add_pictures()
        os.mkdir(os.path.dirname(second))
        shutil.copy(first, second)

        def make(place):
            return export.main([first, second, "--to", "lerobot", "--output", os.path.join(self.folder, place)])

        self.assertEqual(make("whole"), 0)
        wanted = {path: data for path, (data, _) in self.files(self.folder + "/whole").items()}
        self.assertEqual(len([path for path in wanted if path.endswith(".mp4")]), 8)
        at, status, kept = 0, None, set()
        while status != 0:
            at += 23
            shutil.rmtree(self.folder + "/out", ignore_errors=True)
            status = killed(at, lambda: make("out"))
            self.assertIn(status, (0, -signal.SIGKILL))
            part = self.files(self.folder + "/out/.lerobot.part")
            finished = json.loads(part["meta/info.json"][0])["total_episodes"] if "export.json" in part else 0
            self.assertEqual(make("out"), 0)
            found = self.files(self.folder + "/out")
            self.assertEqual({path: data for path, (data, _) in found.items()}, wanted)
            for path, (_, changed) in part.items():
                if path.endswith((".mp4", ".parquet")) and re.search("file-(...)", path) and int(re.search("file-(...)", path)[1]) < finished:
                    self.assertEqual(found["lerobot/" + path][1], changed, path)
            kept.add(finished)
        self.assertLessEqual(set(range(8)), kept)

    def test_pictures_of_the_recording_are_its_video(self):
        import av

        self.write()
        self.add_pictures()
        self.assertEqual(export.main([self.path, "--to", "lerobot", "--output", self.folder + "/out"]), 0)
        with av.open(self.folder + "/out/lerobot/videos/observation.images.endoscope/chunk-000/file-001.mp4") as video:
            shown = [frame.to_ndarray(format="rgb24").shape for frame in video.decode(video=0)]
        self.assertEqual(shown, [(16, 32, 3)] * len(self.episodes()[1][0].times))
        plain = os.path.join(self.folder, "plain", "session.bag")
        os.mkdir(os.path.dirname(plain))
        pictured, self.path = self.path, plain
        self.write()
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.assertEqual(export.main([pictured, plain, "--to", "lerobot", "--output", self.folder + "/mixed"]), 2)
        self.assertIn("has no pictures of the endoscope, unlike the first recording; export them apart", said.getvalue())


class GltfReader(ExportTest):
    def test_assimp_finds_every_frame(self):
        try:
            import pyassimp
        except Exception as error:  # AssimpError and others: it looks for a library of its version
            self.skipTest("pyassimp: {}".format(error))
        self.make()
        with rosbag.Bag(self.bag, "a") as bag:
            cloud = next(message for _, message, _ in bag.read_messages(topics=["/tissue/particles"]))
            points = numpy.frombuffer(cloud.data, "<f4").reshape(-1, 4).copy()
            points[:, 2] += 0.01
            cloud.data, cloud.header.stamp = points.tobytes(), genpy.Time(4)
            bag.write("/tissue/particles", cloud, cloud.header.stamp)
        self.exports(to="gltf")
        with pyassimp.load(self.output + "/a/gltf/wall.glb") as scene:
            wall = scene.meshes[0].contents
            self.assertEqual(wall.mNumAnimMeshes, 1)
            self.assertEqual(scene.meshes[0].faces.ravel().tolist(), list(self.messages("tissue/topology")[0].triangles))
            for found, cloud in zip((wall, wall.mAnimMeshes[0].contents), self.messages("tissue/particles")):
                vertices = ctypes.cast(found.mVertices, ctypes.POINTER(ctypes.c_float))
                wanted = numpy.frombuffer(cloud.data, "<f4").reshape(-1, 4)[:, :3]
                numpy.testing.assert_allclose(numpy.ctypeslib.as_array(vertices, (found.mNumVertices, 3)), wanted, atol=1e-8)


if __name__ == "__main__":
    unittest.main()
