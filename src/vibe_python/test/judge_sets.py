"""Training sets before their own loaders: scripts/test.d/training_sets.sh calls `write` with Debian's Python, and the rest in an
environment that has the packages of judges.txt."""
import os
import sys

import numpy as np

DEMOS, CAMERA = 12, (64, 48, 1.7)


def write(folder):
    from vibe.data import lerobot
    from vibe.env import Environment, Expert, demonstrations

    environment = Environment("Reach", particles=300, organs=[("sthenic", 1.0)], camera=CAMERA, pictures=["colour", "depth"])
    for format, name in (("robomimic", "reach.hdf5"), ("lerobot", "v3.0"), ("minari", "sets/vibe/reach-v0")):
        os.environ["MINARI_DATASETS_PATH"] = os.path.join(folder, "sets")
        assert demonstrations.record(environment, Expert(environment), os.path.join(folder, name), DEMOS, seed=1, format=format) == (DEMOS, DEMOS)
    features = {name: {"dtype": "float32", "shape": [4], "names": None} for name in ("observation.state", "action")}
    features["observation.images.endoscope"] = {"dtype": "video", "shape": [480, 640, 3], "names": ["height", "width", "channels"]}
    with lerobot.Writer(os.path.join(folder, "v2.1"), "v2.1", 20, features) as writer:
        for number in range(DEMOS):
            grey = np.broadcast_to(np.arange(0, 200, 10, np.uint8)[:, None, None, None], (20, 480, 640, 3))
            rows = np.random.default_rng(number).random((20, 4))
            writer.add({"observation.state": rows, "action": rows}, "reach", {"observation.images.endoscope": grey})


def read_lerobot(folder, version):
    """Every row with its picture, by LeRobot itself."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    found = LeRobotDataset("local/set", root=os.path.join(folder, version), video_backend="pyav")
    assert found.num_episodes == DEMOS and len(found) == found.meta.total_frames, len(found)
    for number in range(len(found)):
        row = found[number]
        assert row["index"] == number and row["observation.images.endoscope"].shape[0] == 3
        if version == "v2.1":
            assert abs(row["observation.images.endoscope"].mean() * 255 - 10 * row["frame_index"]) < 4, number


def read_robomimic(folder):
    from robomimic.utils import file_utils, obs_utils
    from robomimic.utils.dataset import SequenceDataset

    obs_utils.initialize_obs_utils_with_obs_specs({"obs": {"low_dim": ["joints", "tip"], "rgb": ["colour"]}})
    file = os.path.join(folder, "reach.hdf5")
    assert file_utils.get_env_metadata_from_dataset(file)["env_name"] == "vibe.env.tasks:vibe/Reach-v0"
    for mask, demos in (("train", DEMOS - 2), ("valid", 2)):
        found = SequenceDataset(file, obs_keys=["joints", "tip", "colour"], dataset_keys=["actions", "rewards", "dones"], seq_length=4,
                                hdf5_cache_mode=None, filter_by_attribute=mask)
        assert found.n_demos == demos and found[3]["obs"]["colour"].shape == (4, CAMERA[1], CAMERA[0], 3)


def read_minari(folder):
    os.environ["MINARI_DATASETS_PATH"] = os.path.join(folder, "sets")
    import minari

    assert list(minari.list_local_datasets()) == ["vibe/reach-v0"]
    found = minari.load_dataset("vibe/reach-v0")
    episodes = list(found.iterate_episodes())
    assert len(episodes) == found.total_episodes == DEMOS and sum(len(one.actions) for one in episodes) == found.total_steps
    for one in episodes:
        assert one.terminations[-1] and len(one.observations["tip"]) == len(one.actions) + 1
        assert all(found.observation_space[name].contains(rows[-1]) for name, rows in one.observations.items())


if __name__ == "__main__":
    globals()[sys.argv[1]](*sys.argv[2:])
