"""LeRobot data sets, codebase versions v2.1 and v3.0: tables as Parquet, pictures as video, metadata beside them."""

import copy
import json
import pathlib

import numpy as np

import vibe

from . import files, statistics, video

CHUNK = 1000  # files in a folder
DTYPES = ("float32", "float64", "bool", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))
INDICES = {"timestamp": "float32", "frame_index": "int64", "episode_index": "int64", "index": "int64", "task_index": "int64"}
LAYOUT = {"v3.0": {"data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
                   "video_path": "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4",
                   "data_files_size_in_mb": 100, "video_files_size_in_mb": 200},
          "v2.1": {"data_path": "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet",
                   "video_path": "videos/chunk-{episode_chunk:03d}/{video_key}/episode_{episode_index:06d}.mp4"}}
EPISODES = "meta/episodes/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"  # of v3.0
TASKS = {"pandas": json.dumps({"index_columns": ["task"], "column_indexes": [], "columns": [
    {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": numpy, "metadata": None}
    for name, kind, numpy in (("task_index", "int64", "int64"), ("task", "unicode", "object"))]})}  # their index is the task
CARD = """* Dataset description, collection procedure: made with the simulator ViBE for ROS.
* Robot: `{robot_type}`. `info.json` names what its state and actions hold; SI units. Sensors: {sensors}.
* Synchronization: row k of an episode is the moment k / {fps} s after its first row, and frame k of its videos is of that moment.
"""


class Writer:
    """Adds episodes to a data set in `folder`, which is new or was begun with the same arguments.

    version   "v3.0" (LeRobot from 0.4 on) or "v2.1" (Open-H-Embodiment, GR00T)
    fps       rows per second, a whole number
    features  by name: {"dtype": "float32", "shape": [4], "names": [...] or None}. dtype is one of numpy's, or "video", which
              has the shape [height, width, 3], both even. LeRobot's own (timestamp, frame_index, episode_index, index,
              task_index) are added
    robot     robot_type of the data set
    begun     a dictionary of what else has to be the same when it goes on; kept in info.json

    An episode is a file of each kind, written under another name, synchronised and renamed; info.json, which counts episodes,
    comes last. So a kill or a full disk leaves all finished episodes, and a new Writer goes on after them: `episodes` is their
    number. The same input gives the same bytes. Each video is in memory while it is encoded (H.264). Needs pyarrow, and av for
    videos. Raises vibe.Error, also where the folder was begun with other arguments."""

    def __init__(self, folder, version="v3.0", fps=30, features=None, robot="vibe_endoscope", begun=None):
        self._arrow, self._parquet = (files.needed(name, 'pip install "pyarrow<24"') for name in ("pyarrow", "pyarrow.parquet"))
        self.folder, self.info = pathlib.Path(folder), _begun(version, fps, features, robot, begun)
        self._videos = [name for name, feature in self.info["features"].items() if feature["dtype"] == "video"]
        self._rows, self._stats, self._tasks = [], {}, []  # the table of episodes; statistics of all; tasks
        self._lines = {"episodes": b"", "episodes_stats": b""}  # of v2.1
        there = [path for path in self.folder.rglob("*") if path.is_file() and path.suffix != files.PARTIAL]
        info = json.loads((self.folder / "meta/info.json").read_text()) if self.folder / "meta/info.json" in there else {}
        if there and "vibe" not in info:
            raise vibe.Error(f"{self.folder} holds {there[0].name} and no data set that was begun here; name another folder.")
        if info:
            fixed = ("codebase_version", "fps", "robot_type", "features")
            files.compare(self.folder, *({**{name: one[name] for name in fixed}, **one["vibe"]} for one in (info, self.info)))
            self._take_up(info["total_episodes"])
        else:
            self._write_json("info", self.info)
        sensors = ", ".join(f"`{name}`" for name in self.info["features"] if name.startswith("observation"))
        files.write(self.folder / "meta/README.md", CARD.format(sensors=sensors, **self.info).encode())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass  # every episode is whole already

    @property
    def episodes(self):
        return self.info["total_episodes"]

    def add(self, columns, task, videos=None, split="train", success=True, **further):
        """An episode.

        columns   name of a feature to its array (rows, *shape); all of them but the videos, all with as many rows
        task      the goal in words
        videos    name of a video to its frames, as many as rows: any iterable of (height, width, 3) uint8
        split     of info.json: "train", "val", "test", "recovery", "failure", ...; one whose episodes are not in a row has
                  several ranges there, as in "0:8,9:12"
        further   numbers and texts that the table of episodes has besides, the same of each episode
        """
        features, number, videos = self.info["features"], self.episodes, dict(videos or {})
        files.same_names("videos", videos, self._videos)
        files.same_names("columns", columns, [name for name in features if name not in INDICES and name not in self._videos])
        columns = {name: _column(name, columns[name], feature) for name, feature in features.items() if name in columns}
        counts = {name: len(value) for name, value in columns.items()}
        count = next(iter(counts.values()), 0)
        if count == 0 or set(counts.values()) != {count}:
            raise vibe.Error(f"The columns have the rows {counts}; give as many of each, at least one.")
        columns.update(timestamp=(np.arange(count) / self.info["fps"]).astype(np.float32), frame_index=np.arange(count),
                       episode_index=np.full(count, number), index=self.info["total_frames"] + np.arange(count),
                       task_index=np.full(count, [*self._tasks, task].index(task)))
        stats = {name: statistics.of_rows(value.reshape(count, *features[name]["shape"])) for name, value in columns.items()}
        for name, frames in videos.items():
            samples, shape = [], features[name]["shape"]
            files.write(self._file("video_path", number, name), video.encode(video.seen(name, frames, count, shape, samples), self.info["fps"], shape))
            stats[name] = statistics.of_pictures(samples)
        files.write(self._file("data_path", number), self._bytes({name: _array(self._arrow, value) for name, value in columns.items()}))
        row = {"episode_index": number, "tasks": [task], "length": count, "split": split, "success": bool(success), **further}
        if self.info["codebase_version"] == "v3.0":
            files.write(self._file("episodes", number), self._bytes(self._episode(row, stats)))
        after = copy.copy(self)
        after._count(row, stats)
        after._describe()
        vars(self).update(vars(after))  # it does not count before info.json is there

    # --- what is said of the episodes

    def _count(self, row, stats):
        """One more episode in all that is said of them."""
        number, known = self.episodes, self._stats
        self._rows, self._tasks = [*self._rows, row], list(dict.fromkeys([*self._tasks, *row["tasks"]]))
        self._stats = {name: statistics.together(known[name], stats[name]) if known else stats[name] for name in stats}
        self._lines = {"episodes": self._lines["episodes"] + _line(row),
                       "episodes_stats": self._lines["episodes_stats"] + _line({"episode_index": number, "stats": stats})}
        self.info = {**self.info, "total_episodes": number + 1, "total_frames": self.info["total_frames"] + row["length"],
                     "total_tasks": len(self._tasks), "splits": _extended(self.info["splits"], row["split"], number)}
        if self.info["codebase_version"] == "v2.1":
            self.info.update(total_videos=(number + 1) * len(self._videos), total_chunks=1 + number // CHUNK)

    def _describe(self):
        """Writes what is of all episodes together, info.json last."""
        if self.info["codebase_version"] == "v2.1":
            tasks = b"".join(_line({"task_index": k, "task": task}) for k, task in enumerate(self._tasks))
            for name, text in {**self._lines, "tasks": tasks}.items():
                files.write(self.folder / f"meta/{name}.jsonl", text)
        else:
            tasks = {"task_index": list(range(len(self._tasks))), "task": self._tasks}
            files.write(self.folder / "meta/tasks.parquet", self._bytes(tasks, TASKS))
        self._write_json("stats", self._stats)
        self._write_json("info", self.info)

    def _take_up(self, count):
        """The state after this many episodes; what is left of another one is removed."""
        for row, stats in map(self._episode_of, range(count)) if self.info["codebase_version"] == "v3.0" else self._lines_of(count):
            self._count(row, stats)
        begun = [self._file("data_path", count), self._file("episodes", count), *(self._file("video_path", count, name) for name in self._videos)]
        for path in (*begun, *(path for path in self.folder.glob("meta/*.*") if count == 0 and path.name != "info.json")):
            path.unlink(missing_ok=True)
        if count:
            self._describe()

    def _episode(self, row, stats):
        """As the table of v3.0 has it: where its files are, and its statistics, one column each."""
        chunk, file = divmod(row["episode_index"], CHUNK)
        first = self.info["total_frames"]
        found = {**row, "dataset_from_index": first, "dataset_to_index": first + row["length"]}
        for where in ("data", "meta/episodes", *(f"videos/{name}" for name in self._videos)):
            found.update({f"{where}/chunk_index": chunk, f"{where}/file_index": file})
        for name in self._videos:
            found.update({f"videos/{name}/from_timestamp": 0.0, f"videos/{name}/to_timestamp": row["length"] / self.info["fps"]})
        found.update({f"stats/{name}/{key}": value for name, part in stats.items() for key, value in part.items()})
        return {name: [value] for name, value in found.items()}

    def _episode_of(self, number):
        found = {name: value[0] for name, value in self._parquet.read_table(self._file("episodes", number)).to_pydict().items()}
        row, stats = {name: value for name, value in found.items() if "/" not in name and not name.startswith("dataset_")}, {}
        for _, feature, key in (name.split("/") for name in found if name.startswith("stats/")):
            stats.setdefault(feature, {})[key] = found[f"stats/{feature}/{key}"]
        return row, stats

    def _lines_of(self, count):
        rows, stats = ((self.folder / f"meta/{name}.jsonl").read_text().splitlines()[:count] if count else [] for name in self._lines)
        return [(json.loads(row), json.loads(part)["stats"]) for row, part in zip(rows, stats)]

    # --- files

    def _file(self, kind, number, video_key=None):
        pattern = EPISODES if kind == "episodes" else LAYOUT[self.info["codebase_version"]][kind]
        chunk, file = divmod(number, CHUNK)
        return self.folder / pattern.format(chunk_index=chunk, file_index=file, episode_chunk=chunk, episode_index=number, video_key=video_key)

    def _bytes(self, columns, metadata=None):
        out = self._arrow.BufferOutputStream()
        self._parquet.write_table(self._arrow.table(columns).replace_schema_metadata(metadata), out)
        return out.getvalue()

    def _write_json(self, name, value):
        files.write(self.folder / f"meta/{name}.json", json.dumps(value, indent=4).encode())


def _line(value):
    return json.dumps(value).encode() + b"\n"


def _begun(version, fps, features, robot, begun):
    """info.json of no episodes, or vibe.Error."""
    if version not in LAYOUT:
        raise vibe.Error(f"There is no version {version!r} of LeRobot here; use one of {', '.join(LAYOUT)}.")
    if not isinstance(fps, int) or fps < 1:
        raise vibe.Error(f"'fps' is {fps!r}; give a whole number of rows per second.")
    if not isinstance(features, dict) or not features:
        raise vibe.Error(f"'features' is {vibe._shown(features)}; give a dictionary of name to dtype, shape and names.")
    features = {name: _feature(name, feature, fps) for name, feature in features.items()}
    features.update({name: {"dtype": dtype, "shape": [1], "names": None} for name, dtype in INDICES.items()})
    info = {"codebase_version": version, "robot_type": robot, "total_episodes": 0, "total_frames": 0, "total_tasks": 0,
            "chunks_size": CHUNK, "fps": fps, "splits": {}, **LAYOUT[version], "features": features,
            "vibe": json.loads(json.dumps(begun or {}))}
    if not any(feature["dtype"] == "video" for feature in features.values()):
        info["video_path"] = None
    return info


def _feature(name, feature, fps):
    """One that can be written, with lists as JSON has them."""
    dtype, shape = (feature.get("dtype"), list(feature.get("shape", ()))) if isinstance(feature, dict) else (None, [])
    sizes = bool(shape) and all(isinstance(size, int) and size > 0 for size in shape)
    video = dtype == "video" and len(shape) == 3 and shape[2] == 3 and shape[0] % 2 == shape[1] % 2 == 0
    if not sizes or not video and dtype not in DTYPES or name in INDICES or "/" in name:
        raise vibe.Error(f"The feature {name!r} is {vibe._shown(feature)}; give a dtype of {', '.join(DTYPES)} with its shape, or 'video' with "
                         "[height, width, 3], both even, under a name without '/' that LeRobot itself does not use.")
    found = {"dtype": dtype, "shape": shape, "names": feature.get("names")}
    if video:
        found["info"] = {"video.height": shape[0], "video.width": shape[1], "video.codec": "h264", "video.pix_fmt": "yuv420p",
                         "video.is_depth_map": False, "video.fps": fps, "video.channels": 3, "has_audio": False}
    return found


def _column(name, value, feature):
    """The rows of a feature as they are stored: (rows, *shape), without the axis of shape [1]."""
    shape, rows = feature["shape"], np.asarray(value)
    if rows.ndim == 1 and shape == [1]:
        rows = rows[:, None]
    if rows.dtype.kind not in "biuf" or not np.can_cast(rows.dtype, feature["dtype"], "same_kind") or rows.ndim == 0 or list(rows.shape[1:]) != shape:
        raise vibe.Error(f"The column {name!r} is {rows.dtype} of the shape {rows.shape}; give {feature['dtype']} of the shape "
                         f"(rows, {', '.join(map(str, shape))}).")
    if not np.isfinite(rows).all():
        raise vibe.Error(f"The column {name!r} is not finite in row {np.argwhere(~np.isfinite(rows))[0][0]}; leave such rows out, or fill them.")
    return rows.astype(feature["dtype"]).reshape(len(rows), *([] if shape == [1] else shape))


def _array(arrow, rows):
    """Lists of a fixed size for every further axis."""
    if rows.ndim == 1:
        return arrow.array(rows)
    return arrow.FixedSizeListArray.from_arrays(_array(arrow, rows.reshape(-1, *rows.shape[2:])), rows.shape[1])


def _extended(splits, name, number):
    """Ranges of episodes by split, with one more episode."""
    *ranges, last = splits[name].split(",") if name in splits else [f"{number}:{number}"]
    first, end = last.split(":")
    ranges += [f"{first}:{number + 1}"] if end == str(number) else [last, f"{number}:{number + 1}"]
    return {**splits, name: ",".join(ranges)}
