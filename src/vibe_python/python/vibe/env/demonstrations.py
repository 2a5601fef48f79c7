"""Demonstrations as HDF5 in the layout of robomimic: data/demo_K with obs, next_obs, actions, rewards, dones."""

import json

import numpy as np

import vibe


def record(environment, policy, file, episodes, seed=0, progress=None):
    """Runs episodes with a policy (reset(), action(observation)) and writes those that succeed; they have the seeds
    seed, seed + 1, ... A file that was begun in the same way is gone on with. Returns how many of how many succeeded.
    Needs h5py (Debian: python3-h5py)."""
    try:
        import h5py
    except ImportError:
        raise vibe.Error("Demonstrations need h5py; install python3-h5py.") from None
    try:
        out = h5py.File(file, "a")
    except OSError as error:
        raise vibe.Error(f"{file} cannot be written as HDF5 ({error}); name another file.") from None
    with out:
        data = out.require_group("data")
        _begin(data, environment.task, seed, file)
        kept, tried, total = (int(data.attrs[name]) for name in ("kept", "tried", "total"))
        for number in range(seed + tried, seed + episodes):
            rows, success = episode(environment, policy, number)
            if success:
                data.pop(f"demo_{kept}", None)  # of a run that was killed while it wrote
                total += _write(data.create_group(f"demo_{kept}"), rows, number)
                kept += 1
            data.attrs.update({"kept": kept, "tried": number - seed + 1, "total": total})
            out.flush()
            if progress:
                progress(number - seed + 1, episodes, kept)
    return kept, max(tried, episodes)


def _begin(data, task, seed, file):
    """Writes what the episodes are of, or sees that it is the same as when the file was begun."""
    args = json.dumps({"env_name": task.name, "type": 2,
                       "env_kwargs": {"particles": task.particles, "action": task.mode, "organs": task.organs,
                                      "breathing": task.breathing, "step_period": task.step_period}})
    if data.attrs.setdefault("env_args", args) != args or data.attrs.setdefault("seed", seed) != seed:
        raise vibe.Error(f"{file} holds demonstrations of other settings, {data.attrs['env_args']}; name another file.")
    for name in ("kept", "tried", "total"):
        data.attrs.setdefault(name, 0)


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


def _write(group, rows, seed):
    group.attrs["num_samples"], group.attrs["seed"] = len(rows), seed
    for name, column in (("obs", 0), ("next_obs", 4)):
        for key in rows[0][column]:
            group.create_dataset(f"{name}/{key}", data=np.stack([row[column][key] for row in rows]), compression=1)
    group.create_dataset("actions", data=np.stack([row[1] for row in rows]))
    group.create_dataset("rewards", data=np.array([row[2] for row in rows], np.float32))
    group.create_dataset("dones", data=np.array([row[3] for row in rows], np.int64))
    return len(rows)
