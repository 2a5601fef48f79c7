"""Demonstrations as training sets: robomimic's HDF5, Minari's, or LeRobot's folder; and the environment back from a file."""

import hashlib
import inspect
import itertools
import json
import os
import re
import types

import numpy as np

import vibe

from ..data import files, hdf5, lerobot
from .environment import Environment
from .episodes import Task
from .settings import PICTURES, whole
from .watched import Watched

STATE = ("joints", "tip", "direction", "wrench")  # of the robot; what else is observed is of its surroundings


def record(environment, policy, file, episodes, seed=0, progress=None, format="robomimic"):
    """Runs episodes with a policy (reset(), action(observation)) and writes those that succeed; they have the seeds
    seed, seed + 1, ... Returns how many of how many succeeded.

    format  "robomimic": `file` is an HDF5 file, from which environment_of() and replay() make everything again (h5py);
            "minari": the folder of a data set, named such as reach-v0 (h5py);
            "lerobot": the folder of a data set of version 3.0, with `colour` pictures as video (pyarrow, av)

    Each episode is written whole as it ends. A set that was begun with the same task, settings, policy and version of vibe is
    gone on with after its last episode, whatever stopped it. Wrappers about the Environment may watch, and truncate
    episodes; one that changes actions, observations, rewards or resets is refused by its name, with vibe.Error, before the
    episode is written."""
    if not isinstance(format, str) or format not in FORMATS:
        raise vibe.Error(f"'format' is {vibe._shown(format)}; use {', '.join(FORMATS)}.")
    if not isinstance(getattr(environment, "unwrapped", None), Environment):
        raise vibe.Error(f"'environment' is {vibe._shown(environment)}; give a vibe.env.Environment.")
    file, episodes, seed = vibe._file("file", file), whole("episodes", episodes, 1, 10**9), whole("seed", seed, 0, 2**63)
    begun = {**made_of(environment.unwrapped), "seed": seed, "policy": re.sub(r" at 0x[0-9a-f]+", "", repr(policy))}
    if not all(callable(getattr(policy, name, None)) for name in ("reset", "action")):
        raise vibe.Error(f"'policy' is {vibe._shown(policy)}; give an object with reset() and action(observation).")
    if progress is not None and not callable(progress):
        raise vibe.Error(f"'progress' is {vibe._shown(progress)}; give a function of (episodes done, of how many, successes), or None.")
    with FORMATS[format](environment.unwrapped, file, begun) as out:
        tried = out.seeds[-1] + 1 - seed if out.seeds else 0
        watched = environment if environment is environment.unwrapped else Watched(environment)
        for number in range(seed + tried, seed + episodes):
            rows, success = episode(watched, policy, number)
            if success:
                out.add(_columns(rows), number, _hash(environment))
            if progress:
                progress(number - seed + 1, episodes, len(out.seeds))
        return len(out.seeds), max(tried, episodes)


def episode(environment, policy, seed):
    """One episode: rows (observation, action, reward, done, next observation), and whether it succeeded."""
    seen, _ = environment.reset(seed=seed)
    policy.reset()
    rows, over, info = [], False, {}
    while not over:
        action = policy.action(seen)
        following, reward, terminated, truncated, info = environment.step(action)
        over = terminated or truncated
        rows.append((seen, action, reward, over, following))
        seen = following
    return rows, info["is_success"]


def environment_of(file):
    """The environment that the demonstrations of a robomimic file are of, from the file alone."""
    with hdf5.opened(vibe._file("file", file), "data") as found:
        begun = json.loads(found.attrs["begun"])
    if begun["vibe"] != vibe.__version__:
        raise vibe.Error(f"{file} was made by version {begun['vibe']}, and this is {vibe.__version__}, whose episodes may differ; install that one.")
    environment = Environment(begun["task"]["class"], **begun["environment"]["env_kwargs"])
    files.compare(file, begun["task"], _said(environment.task))
    return environment


def replay(file):
    """Makes the environment of a robomimic file, performs the actions of each demonstration and compares observations,
    rewards, dones and the state in the end, to the bit. Returns their number; raises vibe.Error at the first difference."""
    environment = environment_of(file)
    with hdf5.opened(file, "data") as found:
        for name, demo in found["data"].items():
            actions = itertools.chain(demo["actions"][:], itertools.repeat(0 * demo["actions"][0]))
            rows, _ = episode(environment, types.SimpleNamespace(reset=lambda: None, action=lambda _, rest=actions: next(rest)), int(demo.attrs["seed"]))
            differ = [key for key, again in _columns(rows).items() if not np.array_equal(demo[key][:], again)]
            if differ or demo.attrs["hash"] != _hash(environment):
                raise vibe.Error(f"{file}: {name} has other {differ[0] if differ else 'states'} when its actions are performed again; "
                                 "was the task or the file changed?")
        return len(found["data"])


# --- what a set is of


def made_of(environment):
    """Everything but policy and seed in which episodes of one set are alike, as JSON has it: version of vibe, settings, task
    with a digest of its source, dtypes and shapes of observations and actions. Raises vibe.Error for what is no Environment
    of a task that has a name."""
    if type(environment) is not Environment:
        raise vibe.Error(f"Demonstrations are of an Environment, and this is a {type(environment).__name__}; record with Environment, whose "
                         "observations hold everything that goals with hindsight are made of.")
    task, kind = environment.task, type(environment.task)
    if not kind.name:
        raise vibe.Error(f"The task {kind.__qualname__} has no name by which it could be made again; give it one.")
    settings = {"particles": task.particles, "organs": task.organs, "action": task.mode, "breathing": task.breathing,
                "step_period": task.step_period, "camera": task.camera, "pictures": task.pictures if task.camera else None}
    made = {"env_name": f"{kind.__module__}:vibe/{task.name}-v0", "env_version": vibe.__version__, "type": 2,
            "env_kwargs": json.loads(json.dumps({**settings, **environment._settings}, default=vibe._plain))}
    spaces = {**environment.observation_space, "actions": environment.action_space}
    return {"vibe": vibe.__version__, "environment": made, "task": _said(task),
            "shapes": {name: [str(space.dtype), *space.shape] for name, space in spaces.items()}}


def _said(task):
    """The task itself: two of one name may differ in their source."""
    kinds = [kind for kind in type(task).__mro__ if issubclass(kind, Task) and kind is not Task]
    return {"class": f"{type(task).__module__}:{task.name}", "goal": task.summary(), "source": source_of(kinds)}


def source_of(objects):
    """A digest of the source of classes or modules; None where one was typed in."""
    try:
        return hashlib.sha256("".join(map(inspect.getsource, objects)).encode()).hexdigest()[:16]
    except (OSError, TypeError):
        return None


def _hash(environment):
    return f"{environment.unwrapped.simulation.hash():016x}"


def _columns(rows):
    """As robomimic names them."""
    found = {f"{name}/{key}": np.stack([row[column][key] for row in rows]) for name, column in (("obs", 0), ("next_obs", 4)) for key in rows[0][0]}
    return {**found, "actions": np.clip([row[1] for row in rows], -1, 1), "rewards": np.array([row[2] for row in rows], np.float32),
            "dones": np.array([row[3] for row in rows], np.int64)}


# --- formats: add(rows, seed, hash), and the seeds of what is there


class _Robomimic(hdf5.Episodes):
    def finish(self, out, said):
        super().finish(out, said)
        names = np.array([f"demo_{k}" for k in range(len(said))], "S")
        valid = np.arange(len(said)) % 10 == 1
        out.require_group("data").attrs.update(env_args=json.dumps(self.begun["environment"]), total=sum(int(one["num_samples"]) for one in said))
        out["mask/train"], out["mask/valid"] = names[~valid], names[valid]

    def add(self, columns, seed, state):
        super().add(columns, {"num_samples": len(columns["actions"]), "seed": seed, "hash": state})


class _Minari(hdf5.Episodes):
    def __init__(self, environment, folder, begun):
        if not re.search(r"[\w-]-v\d+$", os.path.normpath(folder)):
            raise vibe.Error(f"{folder} is no name of Minari; give one that ends in a version, such as reach-v0.")
        self._folder, self._environment = folder, environment
        place = os.path.relpath(folder, os.environ.get("MINARI_DATASETS_PATH", os.path.expanduser("~/.minari/datasets")))
        self._identifier = os.path.basename(os.path.normpath(folder)) if place.startswith("..") else place
        super().__init__(os.path.join(folder, "data", "main_data.hdf5"), "episode_{}", begun)
        self._metadata(self._said)

    def _write(self, links, said):
        super()._write(links, said)
        self._metadata(said)

    def _metadata(self, said):
        """After the file: it never counts an episode that is not there."""
        made = self.begun["environment"]
        spec = {"id": made["env_name"].split(":")[1], "entry_point": "vibe.env:Environment", "additional_wrappers": [],
                "kwargs": {"task": self.begun["task"]["class"], **made["env_kwargs"]}}
        observed = {name: _box(space) for name, space in self._environment.observation_space.items()}
        files.write(os.path.join(self._folder, "data", "metadata.json"), json.dumps({
            "dataset_id": self._identifier, "data_format": "hdf5", "minari_version": "0.5.4", "jpeg_encoding": False,
            "total_episodes": len(said), "total_steps": sum(int(one["total_steps"]) for one in said), "env_spec": json.dumps(spec),
            "observation_space": json.dumps({"type": "Dict", "subspaces": observed}), "action_space": json.dumps(_box(self._environment.action_space)),
            "algorithm_name": self.begun["policy"]}).encode())

    def add(self, columns, seed, state):
        content = {name.replace("obs", "observations", 1): np.append(value, columns[f"next_{name}"][-1:], 0)
                   for name, value in columns.items() if name.startswith("obs/")}
        over = columns["dones"] > 0
        content.update(actions=columns["actions"], rewards=columns["rewards"], terminations=over, truncations=over & False)
        super().add(content, {"id": len(self.seeds), "seed": seed, "total_steps": len(over), "hash": state})


def _box(space):
    return {"type": "Box", "dtype": str(space.dtype), "shape": list(space.shape), "low": space.low.tolist(), "high": space.high.tolist()}


class _LeRobot(lerobot.Writer):
    def __init__(self, environment, folder, begun):
        spaces, self._task = environment.observation_space, f"{environment.task.name}: {environment.task.summary()}"
        self._pictures = {name: "observation.images.endoscope" if name == "colour" else f"observation.{name}" for name in spaces if name in PICTURES}
        self._vectors = {"observation.state": STATE,
                         "observation.environment_state": [name for name in spaces if name not in STATE and name not in PICTURES]}
        features = {"action": _vector([f"action_{k}" for k in range(environment.action_space.shape[0])]), "next.reward": _vector(["reward"]),
                    **{name: {**_vector([name]), "dtype": "bool"} for name in ("next.done", "next.success")}}
        for name, parts in self._vectors.items():
            features[name] = _vector([f"{part}_{k}" for part in parts for k in range(int(np.prod(spaces[part].shape)))])
        for name, feature in self._pictures.items():
            features[feature] = {"dtype": "video" if name == "colour" else str(spaces[name].dtype), "shape": list(spaces[name].shape),
                                 "names": ["height", "width", "channels"][:len(spaces[name].shape)]}
        super().__init__(folder, "v3.0", environment.task.rate, features, begun=begun)

    @property
    def seeds(self):
        return [row["seed"] for row in self._rows]

    def add(self, columns, seed, state):
        found = {"action": columns["actions"], "next.reward": columns["rewards"], "next.done": columns["dones"] > 0, "next.success": columns["dones"] > 0}
        for name, parts in self._vectors.items():
            found[name] = np.hstack([columns[f"obs/{part}"].reshape(len(found["action"]), -1) for part in parts])
        found.update({feature: columns[f"obs/{name}"] for name, feature in self._pictures.items()})
        videos = {name: found.pop(name) for name in self._videos}
        super().add(found, self._task, videos, seed=seed, hash=state)


def _vector(names):
    return {"dtype": "float32", "shape": [len(names)], "names": names}


FORMATS = {"robomimic": lambda _, file, begun: _Robomimic(file, "data/demo_{}", begun), "minari": _Minari, "lerobot": _LeRobot}
