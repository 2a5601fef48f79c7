#!/usr/bin/env python3
"""Training sets: what is in them, that no kill and no full disk loses a finished episode, and that a set is not mixed."""
import errno
import hashlib
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import numpy as np

import vibe
from vibe.data import files, hdf5, lerobot
from vibe.env import Environment, Expert, Reach, demonstrations

SMALL = {"particles": 300, "organs": [("steer_horn", 0.92)]}
FEATURES = {"observation.state": {"dtype": "float32", "shape": [2], "names": ["insertion", "rotation"]},
            "observation.wall": {"dtype": "float32", "shape": [3, 3], "names": None},
            "action": {"dtype": "float32", "shape": [2], "names": None}, "next.done": {"dtype": "bool", "shape": [1], "names": None}}
VIDEO = {"observation.images.endoscope": {"dtype": "video", "shape": [32, 48, 3], "names": ["height", "width", "channels"]}}
EPISODES, ROWS = 3, 6
libraries = tempfile.TemporaryDirectory()
sys.dont_write_bytecode = True  # a child with little room would leave modules that are cut off


def setUpModule():
    """pyarrow and av are not in Debian, or not installed: they come from the registry of Python, with pinned versions."""
    if not (can("pyarrow") and can("av")):
        here = os.path.dirname(os.path.abspath(__file__))
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", "--only-binary=:all:", "--require-hashes",
                        "--retries=0", "--timeout=5", "--target", libraries.name, "-r", os.path.join(here, "reader_tools.txt")], capture_output=True)
        sys.path.append(libraries.name)


def can(module):
    try:
        __import__(module)
        return True
    except ImportError:
        return False


def need(test, *modules):
    for module in modules:
        if not can(module):
            test.skipTest(f"the Python module {module} is not installed and cannot be fetched")


def columns(number):
    random = np.random.default_rng(number)
    return {"observation.state": random.random((ROWS, 2)), "observation.wall": random.random((ROWS, 3, 3)), "action": random.random((ROWS, 2)),
            "next.done": np.arange(ROWS) == ROWS - 1}


def frames(number):
    return np.broadcast_to(np.arange(0, ROWS * 20, 20, np.uint8)[:, None, None, None] + np.uint8(number), (ROWS, 32, 48, 3))


class LeRobot:
    """A set of either version: writes episodes up to a number, and reads what is there."""

    def __init__(self, version, video=False):
        self.version, self.features = version, {**FEATURES, **(VIDEO if video else {})}
        self.modules = ("pyarrow", "av") if video else ("pyarrow",)

    def write(self, place, until, told=lambda number: None):
        with lerobot.Writer(place, self.version, 20, self.features) as writer:
            for number in range(writer.episodes, until):
                videos = {name: frames(number) for name in self.features if name in VIDEO}
                writer.add(columns(number), f"task {number % 2}", videos, split=("train", "val")[number == 1], success=number != 2, seed=number)
                told(number)

    def read(self, place):
        """How many episodes info.json counts; each has to be there as it was given."""
        import pyarrow.parquet as parquet

        if not os.path.exists(os.path.join(place, "meta/info.json")):
            return 0
        info = json.loads(text(place, "meta/info.json"))
        for number in range(info["total_episodes"]):
            file = info["data_path"].format(chunk_index=0, file_index=number, episode_chunk=0, episode_index=number)
            found = parquet.read_table(os.path.join(place, file)).to_pydict()
            for name, rows in columns(number).items():
                assert np.array_equal(found[name], np.asarray(rows, FEATURES[name]["dtype"])), name
        return info["total_episodes"]


class Hdf5:
    modules = ("h5py",)

    def write(self, place, until, told=lambda number: None):
        os.makedirs(place, exist_ok=True)
        with hdf5.Episodes(os.path.join(place, "set {0}.hdf5"), "data/demo_{}", {"a": [1, 2]}) as out:
            for number in range(len(out.seeds), until):
                out.add({"action": columns(number)["action"]}, {"seed": number})
                told(number)

    def read(self, place):
        import h5py

        if not os.path.exists(os.path.join(place, "set {0}.hdf5")):
            return 0
        with h5py.File(os.path.join(place, "set {0}.hdf5"), "r") as found:
            count = len(found.get("data", ()))
            for number in range(count):
                assert np.array_equal(found[f"data/demo_{number}/action"], columns(number)["action"])
            return count


def text(*names):
    with open(os.path.join(*names), encoding="utf-8") as file:
        return file.read()


def digest(place):
    found = {}
    for folder, _, names in os.walk(place):
        for name in names:
            with open(os.path.join(folder, name), "rb") as file:
                found[os.path.relpath(os.path.join(folder, name), place)] = hashlib.sha256(file.read()).hexdigest()
    return {name: value for name, value in found.items() if not name.endswith(files.PARTIAL)}


class Stopped:
    """Whatever touches the disk counts; the one with the number `at` is interrupted in its midst."""

    def __init__(self, at, stop):
        self.left, self.stop = at, stop

    def __enter__(self):
        self.patches = [mock.patch.object(files, "open", self.open, create=True)]
        self.patches += [mock.patch.object(os, name, self.counted(getattr(os, name))) for name in ("fsync", "replace", "link", "posix_fallocate")]
        for patch in self.patches:
            patch.start()
        return self

    def __exit__(self, *_):
        for patch in self.patches:
            patch.stop()

    def tick(self):
        self.left -= 1
        return self.left == 0

    def counted(self, function):
        def called(*arguments):
            if self.tick():
                self.stop()
            return function(*arguments)
        return called

    def open(self, path, mode="r", **keywords):
        file = open(path, mode, **keywords)
        if "w" in mode:
            write = file.write

            def half(data):
                if self.tick():
                    write(memoryview(data)[:len(data) // 2])
                    file.flush()
                    self.stop()
                return write(data)

            file = mock.Mock(wraps=file)
            file.__enter__, file.__exit__ = lambda _: file, lambda *_: file.close()
            file.write = half
        return file


def full():
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def forked(action):
    """What a child told with single bytes before it ended, and how it ended."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            os.close(reading)
            action(lambda number: os.write(writing, bytes([number])))
            status = 0
        except vibe.Error:
            status = 2
        finally:
            os._exit(status)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        told = pipe.read()
    return told, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


class WholeOrNot(unittest.TestCase):
    """Whatever stops a writer: what it has told of is there, nothing is half, and the next one ends with the same bytes."""

    SETS = {"LeRobot v3.0": LeRobot("v3.0"), "LeRobot v2.1": LeRobot("v2.1"), "HDF5": Hdf5()}

    def setUp(self):
        patch = mock.patch.object(os, "fsync")  # it matters where the power fails, and takes most of the time
        patch.start()
        self.addCleanup(patch.stop)

    def stopped(self, kind, folder, number, action):
        """How a set ends that was stopped once, and how that was."""
        place = os.path.join(folder, str(number))
        told, status = forked(lambda tell: action(place, tell))
        there = kind.read(place)
        self.assertGreaterEqual(there, len(told))
        kind.write(place, EPISODES)
        self.assertEqual(kind.read(place), EPISODES)
        return digest(place), status

    def stop_at_steps(self, name, stop, first=1):
        """Stops a writer at every seventh step, until it has none left. How the writers have ended."""
        kind = self.SETS[name]
        need(self, *kind.modules)
        with tempfile.TemporaryDirectory() as folder:
            kind.write(os.path.join(folder, "whole"), EPISODES)
            expected, number, ended = digest(os.path.join(folder, "whole")), first, []
            while 0 not in ended:
                def interrupted(place, tell, number=number):
                    with Stopped(number, stop):
                        kind.write(place, EPISODES, tell)
                found, status = self.stopped(kind, folder, number, interrupted)
                self.assertEqual(found, expected, f"step {number}")
                ended.append(status)
                number += 7
        return ended

    def test_a_kill_in_the_midst_of_a_step(self):
        for name in self.SETS:
            with self.subTest(name):
                *ended, last = self.stop_at_steps(name, lambda: os.kill(os.getpid(), signal.SIGKILL))
                self.assertEqual((set(ended), last), ({-signal.SIGKILL}, 0))
                self.assertGreater(len(ended), 4)

    def test_a_kill_at_any_time(self):
        need(self, "h5py")
        with tempfile.TemporaryDirectory() as folder:
            begun = time.monotonic()
            Hdf5().write(os.path.join(folder, "whole"), EPISODES)
            random, killed, takes = np.random.default_rng(3), 0, time.monotonic() - begun
            for number in range(12):
                def raced(place, tell, after=random.uniform(1e-6, takes)):
                    signal.signal(signal.SIGALRM, signal.SIG_DFL)  # ends a process as a kill does
                    signal.setitimer(signal.ITIMER_REAL, after)
                    Hdf5().write(place, EPISODES, tell)
                found, status = self.stopped(Hdf5(), folder, number, raced)
                self.assertEqual(found, digest(os.path.join(folder, "whole")))
                killed += status < 0
            self.assertGreater(killed, 0)

    def test_a_disk_that_is_full_at_a_step(self):
        for name in self.SETS:
            with self.subTest(name):
                *ended, last = self.stop_at_steps(name, full, first=3)
                self.assertEqual((set(ended), last), ({2}, 0))
                self.assertGreater(len(ended), 4)

    def test_a_disk_that_is_full(self):
        for name, kind in self.SETS.items():
            need(self, *kind.modules)
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                kind.write(os.path.join(folder, "whole"), EPISODES)
                ended = set()
                for size in (100, 1000, 3000, 6000, 9000, 20000, 3000000):
                    def limited(place, tell, size=size):
                        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
                        kind.write(place, EPISODES, tell)
                    found, status = self.stopped(kind, folder, size, limited)
                    self.assertEqual(found, digest(os.path.join(folder, "whole")), size)
                    ended.add(status)
                self.assertEqual(ended, {0, 2})

    def test_control_files_in_place(self):
        def in_place(path, data):
            os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
            with getattr(files, "open", open)(path, "wb") as file:
                file.write(data)

        with mock.patch.object(files, "write", in_place), self.assertRaises(Exception):
            self.stop_at_steps("HDF5", lambda: os.kill(os.getpid(), signal.SIGKILL))


class LeRobotSets(unittest.TestCase):
    def written(self, version, until=EPISODES):
        kind = LeRobot(version, video=True)
        need(self, *kind.modules)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        place = os.path.join(folder.name, "set")
        kind.write(place, until)
        return place

    def check_video(self, path, number):
        """Every frame is nearer to what was given than to the frame before or after it."""
        import av

        with av.open(path) as container:
            self.assertEqual((container.streams.video[0].codec_context.name, container.streams.video[0].average_rate), ("h264", 20))
            found = [(frame.time, frame.to_ndarray(format="rgb24").mean()) for frame in container.decode(video=0)]
        self.assertEqual(len(found), ROWS)
        np.testing.assert_allclose([time for time, _ in found], np.arange(ROWS) / 20, atol=1e-4)
        np.testing.assert_allclose([mean for _, mean in found], frames(number).mean((1, 2, 3)), atol=4)

    def test_version_3(self):
        with mock.patch.object(lerobot, "CHUNK", 2):
            place = self.written("v3.0")
        import pyarrow.parquet as parquet

        info = json.loads(text(place, "meta/info.json"))
        self.assertEqual(info["splits"], {"train": "0:1,2:3", "val": "1:2"})
        self.assertEqual((info["total_episodes"], info["total_frames"], info["total_tasks"], info["fps"]), (3, 3 * ROWS, 2, 20))
        rows = parquet.read_table(os.path.join(place, "meta/episodes")).to_pylist()
        for number, row in enumerate(rows):
            where = {"chunk_index": row["data/chunk_index"], "file_index": row["data/file_index"]}
            self.assertEqual(where, {"chunk_index": number // 2, "file_index": number % 2})
            data = parquet.read_table(os.path.join(place, info["data_path"].format(**where)))
            self.assertEqual(data["index"].to_pylist(), list(range(row["dataset_from_index"], row["dataset_to_index"])))
            self.assertEqual(str(data.schema.field("observation.wall").type).count("float"), 1)
            key, = VIDEO
            self.check_video(os.path.join(place, info["video_path"].format(video_key=key, **where)), number)
            self.assertEqual((row["tasks"], row["success"], row["seed"]), ([f"task {number % 2}"], number != 2, number))
        tasks = parquet.read_table(os.path.join(place, "meta/tasks.parquet")).to_pydict()
        self.assertEqual(tasks, {"task_index": [0, 1], "task": ["task 0", "task 1"]})

    def test_version_2_1(self):
        place = self.written("v2.1")
        rows = [json.loads(line) for line in text(place, "meta/episodes.jsonl").splitlines()]
        self.assertEqual([(row["episode_index"], row["length"], row["tasks"]) for row in rows],
                         [(number, ROWS, [f"task {number % 2}"]) for number in range(EPISODES)])
        for number in range(EPISODES):
            self.check_video(os.path.join(place, f"videos/chunk-000/observation.images.endoscope/episode_{number:06d}.mp4"), number)
        self.assertEqual(LeRobot("v2.1").read(place), EPISODES)

    def test_statistics_are_those_of_all_rows(self):
        for version in ("v3.0", "v2.1"):
            stats = json.loads(text(self.written(version), "meta/stats.json"))
            given = np.concatenate([columns(number)["action"] for number in range(EPISODES)]).astype(np.float32)
            for name, function in (("min", np.min), ("max", np.max), ("mean", np.mean), ("std", np.std)):
                np.testing.assert_allclose(stats["action"][name], function(given.astype(float), 0), rtol=1e-9)
            self.assertEqual(stats["action"]["count"], [EPISODES * ROWS])
            shares = np.concatenate([frames(number) for number in range(EPISODES)]) / 255
            picture = stats["observation.images.endoscope"]
            np.testing.assert_allclose(np.ravel(picture["mean"]), shares.mean((0, 1, 2)), rtol=1e-9)
            self.assertEqual(np.shape(picture["std"]), (3, 1, 1))

    def test_what_is_left_of_an_episode_is_removed(self):
        for version, until in (("v3.0", 0), ("v3.0", 2), ("v2.1", 0), ("v2.1", 2)):
            place = self.written(version, until)
            expected = digest(place)
            info = lerobot.Writer._write_json

            def stopped(writer, name, value, info=info, until=until):
                if name == "info" and value["total_episodes"] > until:
                    full()
                info(writer, name, value)

            with mock.patch.object(lerobot.Writer, "_write_json", stopped), self.assertRaises(OSError):
                LeRobot(version, video=True).write(place, until + 1)
            self.assertNotEqual(digest(place), expected)  # control
            LeRobot(version, video=True).write(place, until)
            self.assertEqual(digest(place), expected)

    def test_what_is_refused(self):
        place, state = self.written("v3.0", 1), {"dtype": "float32", "shape": [2]}
        good, pictures = columns(0), {"observation.images.endoscope": frames(0)}

        def writer(folder=place, version="v3.0", fps=20, features=LeRobot("v3.0", True).features, **further):
            return lerobot.Writer(folder, version, fps, features, **further)

        def add(videos=pictures, **changed):
            writer().add({**good, **changed}, "task", videos)

        for sentence, call in (("its fps is 20, and here it is 30", lambda: writer(fps=30)), ("its robot_type is", lambda: writer(robot="arm")),
                               ("its codebase_version is 'v3.0', and", lambda: writer(version="v2.1")), ("its a is None", lambda: writer(begun={"a": 1})),
                               ("its features action shape", lambda: writer(features={**FEATURES, **VIDEO, "action": {**state, "shape": [3]}})),
                               ("holds .* and no data set", lambda: writer(os.path.join(place, "data"))), ("no version 'v4'", lambda: writer(version="v4")),
                               ("'fps' is 0.5", lambda: writer(fps=0.5)), ("both even", lambda: writer(features={"a": {"dtype": "video", "shape": [3, 4, 3]}})),
                               ("The feature 'index'", lambda: writer(features={"index": state})), ("have 'more'; give", lambda: add(more=[1])),
                               ("'action' is float64 of the shape", lambda: add(action=np.zeros((ROWS, 3)))), ("is <U1 of", lambda: add(action=[["a", "b"]] * ROWS)),
                               ("not finite in row 2", lambda: add(action=np.where(np.arange(ROWS)[:, None] == 2, np.nan, good["action"]))),
                               ("The columns have the rows", lambda: add(action=good["action"][1:])), ("videos lack", lambda: add(videos={})),
                               ("Frame 5 of the video .* is missing", lambda: add(videos={"observation.images.endoscope": frames(0)[1:]})),
                               ("Frame 0 of the video .* is float64", lambda: add(videos={"observation.images.endoscope": frames(0) / 255}))):
            with self.assertRaisesRegex(vibe.Error, sentence):
                call()
        self.assertEqual(writer().episodes, 1)
        self.assertEqual([name for name in digest(place) if "001" in name], [])
        with mock.patch.dict(sys.modules, {"pyarrow": None}), self.assertRaisesRegex(vibe.Error, "needs the Python module pyarrow"):
            writer()


class Wrapper:
    """As Gymnasium has it."""

    def __init__(self, env):
        self.env, self.unwrapped = env, env.unwrapped

    def reset(self, **named):
        return self.env.reset(**named)

    def step(self, action):
        return self.env.step(action)


class Demonstrations(unittest.TestCase):
    """Sets of an environment; the environment from a file."""

    def setUp(self):
        need(self, "h5py")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "reach.hdf5")

    def record(self, environment, policy=None, episodes=2, **settings):
        return demonstrations.record(environment, policy or Expert(environment), self.file, episodes, **settings)

    def test_a_file_alone_repeats_its_demonstrations(self):
        import h5py

        environment = Environment("Reach", action="tip", breathing="slight", camera=(32, 24, 1.7), pictures=["colour", "depth"], **SMALL)
        self.assertEqual(self.record(environment, episodes=3), (3, 3))
        again = f"from vibe.env import demonstrations; print(demonstrations.replay({self.file!r}))"
        self.assertEqual(subprocess.run([sys.executable, "-c", again], capture_output=True, text=True).stdout, "3\n")
        with h5py.File(self.file, "r+") as found:
            self.assertEqual([list(found["mask"][name]) for name in ("train", "valid")], [[b"demo_0", b"demo_2"], [b"demo_1"]])
            found["data/demo_1/actions"][4] *= 0.99
        with self.assertRaisesRegex(vibe.Error, "demo_1 has other obs"):
            demonstrations.replay(self.file)
        with mock.patch.object(vibe, "__version__", "0.9"), self.assertRaisesRegex(vibe.Error, "made by version 1.0.0, and this is 0.9"):
            demonstrations.environment_of(self.file)

    def test_a_set_is_not_mixed(self):
        base = {**SMALL, "camera": (32, 32, 1.7)}
        self.record(Environment("Reach", **base), episodes=1)
        for changed in ({"particles": 301}, {"organs": [("sthenic", 1.08)]}, {"action": "tip"}, {"breathing": "slight"}, {"step_period": 1 / 60},
                        {"camera": (32, 34, 1.7)}, {"camera": None}, {"pictures": ["depth"]}, {"max_episode_steps": 100}):
            environment = Environment("Reach", **{**base, **changed})
            with self.assertRaisesRegex(vibe.Error, f"of other settings: its environment env_kwargs {next(iter(changed))} "):
                self.record(environment)
        environment = Environment("Reach", **base)
        other = type("Reach", (Reach,), {"__module__": "elsewhere"})  # of the same name
        other.__qualname__ = "Reach"
        for sentence, call in (("its seed is 0", lambda: self.record(environment, seed=1)),
                               ("its policy is 'Expert.seed=1.'", lambda: self.record(environment, Expert(environment, seed=2))),
                               ("its environment env_name is", lambda: self.record(Environment(other, **base))),
                               ("its environment env_name is", lambda: self.record(Environment("Mark", **SMALL)))):
            with self.assertRaisesRegex(vibe.Error, sentence):
                call()
        with mock.patch.object(vibe, "__version__", "0.9"), self.assertRaisesRegex(vibe.Error, "its vibe is '1.0.0', and here it is '0.9'"):
            self.record(environment)
        self.assertEqual(self.record(environment), (2, 2))  # control

    def test_wrappers_that_change_what_a_set_holds_are_refused(self):
        """By their names, in the midst of others and at any action; those that only watch give the file that there is without."""
        class Noting(Wrapper):
            def step(self, action):
                self.seen = self.env.step(action)
                return self.seen

        class Truncating(Wrapper):  # and has a success of its own
            def step(self, action):
                return *self.env.step(action)[:3], True, {"is_success": True}

        class Half(Wrapper):
            def step(self, action):
                return self.env.step(0.5 * action)

        class Late(Wrapper):
            def step(self, action):  # another one in the fourth action only
                self.count = getattr(self, "count", 0) + 1
                return self.env.step(0 * action if self.count == 4 else action)

        class Twice(Wrapper):
            def step(self, action):
                self.env.step(action)
                return self.env.step(action)

        class Blind(Wrapper):
            def step(self, action):
                seen, *rest = self.env.step(action)
                seen["tip"] *= 0.99  # in place
                return seen, *rest

        class Generous(Wrapper):
            def step(self, action):
                seen, reward, *rest = self.env.step(action)
                return seen, reward + 1, *rest

        class Choosing(Wrapper):
            def reset(self, **named):
                return self.env.reset(**named, options={"start": 1})

        bare = Environment("Reach", action="tip", breathing="slight", **SMALL)
        for kind, what in ((Half, "actions"), (Late, "actions"), (Twice, "the number of steps"), (Blind, "observations"),
                           (Generous, "rewards or ends"), (Choosing, "seed or options")):
            for environment in (kind(bare), Noting(kind(Noting(bare)))):
                with self.assertRaisesRegex(vibe.Error, f"The wrapper {kind.__name__} changes {what}.*; record without it"):
                    self.record(environment)
        self.assertEqual(self.record(Truncating(bare), episodes=1), (0, 1))
        self.assertNotIn("step", vars(bare))
        contents = []
        for environment in (Noting(Noting(bare)), bare):
            self.assertEqual(self.record(environment), (2, 2))
            self.assertEqual(demonstrations.replay(self.file), 2)
            with open(self.file, "rb") as file:
                contents.append(file.read())
            os.remove(self.file)
        self.assertEqual(*contents)

    def test_other_files_are_refused(self):
        environment = Environment("Reach", **SMALL)
        for content in (b"", b"no HDF5"):
            with open(self.file, "wb") as file:
                file.write(content)
            for call in (lambda: self.record(environment), lambda: demonstrations.replay(self.file)):
                with self.assertRaisesRegex(vibe.Error, "reach.hdf5 holds no .*name "):
                    call()
        with self.assertRaisesRegex(vibe.Error, "'format' is 'zarr'; use robomimic, minari, lerobot"):
            self.record(environment, format="zarr")
        with self.assertRaisesRegex(vibe.Error, "ends in a version"):
            self.record(environment, format="minari")

    def test_minari_has_an_observation_more(self):
        import h5py

        self.file = self.file.replace("reach.hdf5", "reach-v0")
        environment = Environment("Reach", **SMALL)
        self.record(environment, format="minari", episodes=2)
        said = json.loads(text(self.file, "data/metadata.json"))
        with h5py.File(os.path.join(self.file, "data/main_data.hdf5")) as found:
            rows = [len(found[f"episode_{number}/actions"]) for number in range(2)]
            self.assertEqual([len(found[f"episode_{number}/observations/tip"]) for number in range(2)], [count + 1 for count in rows])
            self.assertTrue(found["episode_1/terminations"][-1] and not found["episode_1/terminations"][:-1].any())
        self.assertEqual((said["total_episodes"], said["total_steps"], said["dataset_id"]), (2, sum(rows), "reach-v0"))

    def test_lerobot_has_state_and_picture(self):
        need(self, "pyarrow", "av")
        import pyarrow.parquet as parquet

        environment = Environment("Reach", camera=(48, 32, 1.7), pictures=["colour"], **SMALL)
        for episodes in (1, 2):  # it goes on
            self.assertEqual(self.record(environment, format="lerobot", episodes=episodes), (episodes, episodes))
        rows, _ = demonstrations.episode(environment, Expert(environment), 1)
        found = parquet.read_table(os.path.join(self.file, "data/chunk-000/file-001.parquet")).to_pydict()
        np.testing.assert_array_equal(found["action"], [row[1] for row in rows])
        np.testing.assert_array_equal(np.array(found["observation.state"])[:, 7:10], [row[0]["tip"] for row in rows])
        self.assertEqual(found["next.done"], [False] * (len(rows) - 1) + [True])


if __name__ == "__main__":
    unittest.main()
