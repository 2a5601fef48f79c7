"""Demonstrations as HDF5 in the layout of robomimic: data/demo_K with obs, next_obs, actions, rewards, dones."""

import json

import numpy as np

import vibe


def record(environment, policy, file, episodes, seed=0, progress=None):
    """Runs episodes with a policy (reset(), action(observation)) and writes those that succeed; they have the seeds
    seed, seed + 1, ... Returns how many of how many succeeded. Needs h5py (Debian: python3-h5py)."""
    try:
        import h5py
    except ImportError:
        raise vibe.Error("Demonstrations need h5py; install python3-h5py.") from None
    kept = total = 0
    with h5py.File(file, "x") as out:  # nothing is overwritten
        data = out.create_group("data")
        data.attrs["env_args"] = json.dumps({"env_name": environment.task.name, "type": 2, "env_kwargs": {
            "particles": environment.task.particles, "action": environment.task.mode}})
        for number in range(seed, seed + episodes):
            rows, success = episode(environment, policy, number)
            if success:
                total += _write(data.create_group(f"demo_{kept}"), rows, number)
                kept += 1
            if progress:
                progress(number - seed + 1, episodes, kept)
        data.attrs["total"] = total
    return kept, episodes


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
