"""LeRobot itself reads the data sets, finds nothing wrong with them, trains on them and acts in the environment. `./dev lerobot` runs it."""

import io
import json
import os
import pathlib
import subprocess
import sys
import zipfile

import gymnasium
import numpy as np
import pytest
import torch
from lerobot.datasets.aggregate import aggregate_datasets
from lerobot.datasets.compute_stats import get_feature_stats
from lerobot.datasets.lerobot_dataset import LeRobotDataset
from lerobot.envs.factory import make_env, make_env_config
from lerobot.envs.utils import env_to_policy_features
from lerobot.utils.feature_utils import dataset_to_policy_features
from lerobot.utils.import_utils import register_third_party_plugins
from PIL import Image

from mjarm.data import to_lerobot

MIN_PSNR = 32  # [dB]
SIZE = 64
TINY = ["--policy.type=act", "--policy.device=cpu", "--policy.pretrained_backbone_weights=null", "--policy.push_to_hub=false",
        "--policy.dim_model=32", "--policy.n_heads=2", "--policy.dim_feedforward=32", "--policy.n_encoder_layers=1",
        "--policy.use_vae=false", "--policy.chunk_size=4", "--policy.n_action_steps=4"]


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """Two folders of one set: from MJARM_LEROBOT_DATA, else three episodes recorded here."""
    if given := os.environ.get("MJARM_LEROBOT_DATA"):
        return [pathlib.Path(one) for one in given.split(":")]
    root = tmp_path_factory.mktemp("recorded")
    for seed, count in ((1, 2), (2, 1)):
        subprocess.run([sys.executable, "-m", "mjarm", "record", "pick_place", "--out", str(root / str(seed)), "--size", str(SIZE),
                        "--episodes", str(count), "--seed", str(seed)], check=True, timeout=600)
    return [root / "1", root / "2"]


@pytest.fixture(scope="module")
def root(parts, tmp_path_factory):
    out = tmp_path_factory.mktemp("set") / "pick"
    to_lerobot(parts, out)
    return out


@pytest.fixture(scope="module")
def archives(parts):
    return [zipfile.ZipFile(file) for part in parts for file in sorted(part.glob("episode_*.zip"))]


def column(archive, name):
    return np.load(io.BytesIO(archive.read(f"{name}.npy"))).astype(np.float32)


def test_every_row_is_that_of_the_archive(root, archives):
    data = LeRobotDataset("mjarm/pick", root=root)
    assert data.num_episodes == len(archives) and data.meta.total_frames == len(data)
    at = 0
    for archive in archives:
        state = np.hstack([column(archive, "joint_position"), column(archive, "gripper")])
        action, objects = column(archive, "action_joint"), column(archive, "object_poses")
        words = json.loads(archive.read("episode.json"))["language"]["en"]
        for row in range(len(action)):
            item = data[at]
            at += 1
            assert item["task"] == words and item["frame_index"] == row
            np.testing.assert_array_equal(item["observation.state"], state[row])
            np.testing.assert_array_equal(item["observation.environment_state"], objects[row])
            np.testing.assert_array_equal(item["action"], action[row])
            assert bool(item["next.done"]) == bool(item["next.success"]) == (row == len(action) - 1)
            for camera in ("front", "side"):
                seen = item[f"observation.images.{camera}"].numpy().transpose(1, 2, 0)
                kept = np.asarray(Image.open(io.BytesIO(archive.read(f"frames/{camera}/{row:06d}.png")))) / 255
                assert -10 * np.log10(np.mean((seen - kept) ** 2)) > MIN_PSNR
    assert at == len(data)


def test_windows_of_time_stay_within_episodes(root):
    data = LeRobotDataset("mjarm/pick", root=root, delta_timestamps={"action": [i / 10 for i in range(20)],
                                                                     "observation.images.side": [-0.1, 0]})
    last = int(data.meta.episodes[0]["dataset_to_index"]) - 1
    item = data[last]
    assert item["action"].shape == (20, 8) and item["action_is_pad"].tolist() == [False] + [True] * 19
    assert item["observation.images.side"].shape == (2, 3, *data.meta.features["observation.images.side"]["shape"][:2])


def test_statistics_are_those_that_lerobot_computes(root, archives):
    """Its quantiles are read from a histogram of 5000 bins."""
    stats = LeRobotDataset("mjarm/pick", root=root).meta.stats
    for key, name in (("action", "action_joint"), ("observation.environment_state", "object_poses")):
        values = np.concatenate([column(archive, name) for archive in archives])
        theirs = get_feature_stats(values, axis=0, keepdims=False)
        assert set(theirs) == set(stats[key])
        for word, wanted in theirs.items():
            assert stats[key][word].shape == wanted.shape, word
            if word[0] != "q":
                np.testing.assert_allclose(stats[key][word], wanted, atol=2e-3, err_msg=word)
        exact = np.quantile(values, [0.01, 0.1, 0.5, 0.9, 0.99], axis=0)
        np.testing.assert_allclose([stats[key][word] for word in ("q01", "q10", "q50", "q90", "q99")], exact, atol=1e-6)
    assert stats["observation.images.front"]["mean"].shape == (3, 1, 1)


def test_parts_are_put_together_by_lerobot_too(root, parts, tmp_path):
    """Sets of one part each, put together by LeRobot's own tool, are the set of both parts."""
    if len(parts) < 2:
        pytest.skip("one part was given")
    for i, part in enumerate(parts[:2]):
        to_lerobot([part], tmp_path / str(i))
    aggregate_datasets(repo_ids=["mjarm/a", "mjarm/b"], aggr_repo_id="mjarm/both", roots=[tmp_path / "0", tmp_path / "1"],
                       aggr_root=tmp_path / "both")
    theirs, ours = LeRobotDataset("mjarm/both", root=tmp_path / "both"), LeRobotDataset("mjarm/pick", root=root)
    assert len(theirs) == len(ours)
    for at in range(0, len(ours), 25):
        for key in ("action", "observation.state", "timestamp"):
            np.testing.assert_array_equal(theirs[at][key], ours[at][key])
        seen = [one[at]["observation.images.front"] for one in (theirs, ours)]
        assert torch.mean((seen[0] - seen[1]) ** 2) < 10 ** (-MIN_PSNR / 10)


def test_the_environment_is_found_by_its_name(root):
    register_third_party_plugins()
    features = LeRobotDataset("mjarm/pick", root=root).meta.features
    size = features["observation.images.front"]["shape"][0]
    config = make_env_config("mjarm", task="reach", size=size)
    policy, env = dataset_to_policy_features(features), env_to_policy_features(config)
    assert {key: tuple(one.shape) for key, one in env.items()} == {key: tuple(one.shape) for key, one in policy.items()}
    assert {key: one.type for key, one in env.items()} == {key: one.type for key, one in policy.items()}
    (world,) = make_env(config, n_envs=2)["mjarm"].values()
    assert isinstance(world, gymnasium.vector.VectorEnv)
    seen, _ = world.reset(seed=[1, 2])
    assert seen["pixels"]["front"].shape == (2, size, size, 3)
    world.close()


def test_lerobot_trains_on_it_and_acts(root, tmp_path):
    size = json.loads((root / "meta" / "info.json").read_text())["features"]["observation.images.front"]["shape"][0]
    done = subprocess.run(
        [str(pathlib.Path(sys.executable).with_name("lerobot-train")), "--dataset.repo_id=mjarm/pick", f"--dataset.root={root}", *TINY,
         f"--output_dir={tmp_path / 'train'}", "--steps=3", "--batch_size=2", "--num_workers=0", "--log_freq=1", "--wandb.enable=false",
         "--env.type=mjarm", "--env.task=pick_place", f"--env.size={size}", "--env.seconds=0.5", "--env_eval_freq=3",
         "--eval.n_episodes=1", "--eval.batch_size=1"],
        capture_output=True, text=True, timeout=1200, stdin=subprocess.DEVNULL,
        env={**os.environ, "HF_HUB_OFFLINE": "1", "CUDA_VISIBLE_DEVICES": ""})
    assert done.returncode == 0, done.stderr[-3000:]
    losses = [float(word.removeprefix("loss:")) for word in done.stderr.split() if word.startswith("loss:")]
    assert len(losses) == 3 and np.isfinite(losses).all()
    assert "pc_success" in done.stderr and (tmp_path / "train/checkpoints/last/pretrained_model/model.safetensors").exists()
