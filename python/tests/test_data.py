"""Episodes in other formats, read back with the libraries that others read them with, and compared with the archives."""

import io
import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest

av = pytest.importorskip("av")
h5py = pytest.importorskip("h5py")
pq = pytest.importorskip("pyarrow.parquet")
pytest.importorskip("foxglove_schemas_protobuf")
from mcap.reader import make_reader  # noqa: E402
from mcap_protobuf.decoder import DecoderFactory  # noqa: E402
from PIL import Image  # noqa: E402

import mjarm  # noqa: E402
import mjarm.data.lerobot  # noqa: E402
from mjarm.data import to_lerobot, to_mcap, to_robomimic  # noqa: E402

SIZE = 64
MIN_PSNR = 32  # [dB] of a video's picture; half of 8-bit colours' squares is lost at 51


def program(*words):
    return subprocess.run([sys.executable, "-m", "mjarm", *map(str, words)], capture_output=True, text=True, timeout=300)


def converter(*words):
    return subprocess.run([sys.executable, "-m", "mjarm.data", *map(str, words)], capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """Two folders of one set: two episodes and one."""
    root = tmp_path_factory.mktemp("recorded")
    for seed, count in ((1, 2), (2, 1)):
        done = program("record", "reach", "--out", root / str(seed), "--size", SIZE, "--episodes", count, "--seed", seed)
        assert done.returncode == 0, done.stderr
    return [root / "2", root / "1"]


@pytest.fixture(scope="module")
def archives(parts):
    """What the set should hold, by seed and number, read without mjarm."""
    return [Recorded(file) for file in sorted(parts[1].glob("*.zip")) + sorted(parts[0].glob("*.zip"))]


class Recorded:
    def __init__(self, file):
        with zipfile.ZipFile(file) as entries:
            self.entries = {name: entries.read(name) for name in entries.namelist()}
        self.about = json.loads(self.entries["episode.json"])
        self.rows = self.about["rows"]

    def __getitem__(self, column):
        return np.load(io.BytesIO(self.entries[f"{column}.npy"]))

    def picture(self, camera, row):
        return np.asarray(Image.open(io.BytesIO(self.entries[f"frames/{camera}/{row:06d}.png"])))


def psnr(a, b):
    return 10 * np.log10(255**2 / np.mean((a.astype(float) - b.astype(float)) ** 2))


def video_pictures(file):
    with av.open(str(file)) as container:
        return [(float(frame.pts * frame.time_base), frame.to_ndarray(format="rgb24")) for frame in container.decode(video=0)]


def rows_of(folder):
    files = sorted((folder / "data").glob("*/*.parquet"))
    return [row for file in files for row in pq.read_table(file).to_pylist()]


def json_of(folder, name):
    return json.loads((folder / "meta" / f"{name}.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("action", ["joint", "tool"])
def test_lerobot_holds_every_row(parts, archives, tmp_path, action):
    assert to_lerobot(parts, tmp_path / "set", action=action) == len(archives) == 3
    rows = rows_of(tmp_path / "set")
    assert [row["index"] for row in rows] == list(range(sum(one.rows for one in archives)))
    names = json_of(tmp_path / "set", "info")["features"]
    at = 0
    for i, one in enumerate(archives):
        mine = rows[at:at + one.rows]
        at += one.rows
        wanted = {"observation.state": np.hstack([one["joint_position"], one["gripper"]]),
                  "observation.environment_state": one["object_poses"], "action": one[f"action_{action}"],
                  "timestamp": np.arange(one.rows) / 10, "frame_index": np.arange(one.rows),
                  "episode_index": np.full(one.rows, i), "next.reward": np.arange(one.rows) == one.rows - 1,
                  "next.done": np.arange(one.rows) == one.rows - 1, "next.success": np.arange(one.rows) == one.rows - 1}
        for key, values in wanted.items():
            np.testing.assert_array_equal(np.array([row[key] for row in mine]), values.astype(names[key]["dtype"]), key)
    assert all(len(one["names"]) == one["shape"][0] for one in names.values() if one["dtype"] == "float32" and one["names"])


def test_lerobot_describes_itself(parts, archives, tmp_path):
    to_lerobot(parts, tmp_path / "set", chinese=True)
    info = json_of(tmp_path / "set", "info")
    assert info["codebase_version"] == "v3.0" and info["fps"] == 10 and info["total_episodes"] == 3
    assert info["total_frames"] == sum(one.rows for one in archives) and info["splits"] == {"train": "0:3"}
    tasks = pq.read_table(tmp_path / "set" / "meta" / "tasks.parquet")
    words = [one.about["language"]["zh"] for one in archives]
    assert tasks.column("task").to_pylist() == list(dict.fromkeys(words)) and info["total_tasks"] == len(set(words))
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    told = [words.index(word) for word in tasks.column("task").to_pylist()]
    assert [archives[i].about["language"]["zh"] for i in told] == tasks.column("task").to_pylist()
    assert [row["task_index"] for row in rows_of(tmp_path / "set") if row["frame_index"] == 0] == \
        [tasks.column("task").to_pylist().index(word) for word in words]


def test_lerobot_statistics_are_those_of_the_data(parts, archives, tmp_path, monkeypatch):
    monkeypatch.setattr(mjarm.data.lerobot, "BATCH", 2)
    to_lerobot(parts, tmp_path / "set")
    total = json_of(tmp_path / "set", "stats")
    episodes = pq.read_table(tmp_path / "set" / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert [one["length"] for one in episodes] == [one.rows for one in archives]

    def compare(found, values):
        for name, wanted in {"min": values.min(0), "max": values.max(0), "mean": values.mean(0), "std": values.std(0),
                             "q01": np.quantile(values, 0.01, axis=0), "q50": np.median(values, axis=0),
                             "q99": np.quantile(values, 0.99, axis=0)}.items():
            np.testing.assert_allclose(np.ravel(found[name]), wanted, atol=1e-9, err_msg=name)

    actions = [one["action_joint"].astype(np.float32).astype(float) for one in archives]
    pictures = [np.stack([one.picture("side", row) for row in range(one.rows)]).reshape(-1, 3) / 255 for one in archives]
    for values, key in ((actions, "action"), (pictures, "observation.images.side")):
        compare(total[key], np.concatenate(values))
        assert total[key]["count"] == [sum(one.rows for one in archives)]
        for one, row in zip(values, episodes, strict=True):
            compare({name: row[f"stats/{key}/{name}"] for name in ("min", "max", "mean", "std", "q01", "q50", "q99")}, one)
    assert np.shape(total["observation.images.side"]["mean"]) == (3, 1, 1)


@pytest.mark.parametrize("megabytes", [200, 0])
def test_lerobot_videos_show_the_pictures(parts, archives, tmp_path, monkeypatch, megabytes):
    """In one file, or where no file may be larger than nothing, in a file an episode."""
    for name in ("DATA_MB", "VIDEO_MB"):
        monkeypatch.setattr(mjarm.data.lerobot, name, megabytes)
    to_lerobot(parts, tmp_path / "set")
    episodes = pq.read_table(tmp_path / "set" / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert len(list((tmp_path / "set").glob("data/*/*.parquet"))) == (1 if megabytes else 3)
    for camera in ("front", "side"):
        key = f"videos/observation.images.{camera}"
        assert len(list((tmp_path / "set" / key).glob("*/*.mp4"))) == (1 if megabytes else 3)
        for row, one in zip(episodes, archives, strict=True):
            shown = video_pictures(tmp_path / "set" / key / f"chunk-{row[f'{key}/chunk_index']:03d}" / f"file-{row[f'{key}/file_index']:03d}.mp4")
            first, last = row[f"{key}/from_timestamp"], row[f"{key}/to_timestamp"]
            mine = [(time, picture) for time, picture in shown if first - 1e-6 <= time < last - 1e-6]
            np.testing.assert_allclose([time for time, _ in mine], first + np.arange(one.rows) / 10, atol=1e-6)
            assert min(psnr(picture, one.picture(camera, i)) for i, (_, picture) in enumerate(mine)) > MIN_PSNR
    assert len(rows_of(tmp_path / "set")) == sum(one.rows for one in archives)


@pytest.mark.parametrize("action", ["joint", "tool"])
def test_robomimic_holds_every_row(parts, archives, tmp_path, action):
    to_robomimic(parts, tmp_path / "set.hdf5", action=action, next_obs=action == "tool")
    with h5py.File(tmp_path / "set.hdf5") as file:
        assert file["data"].attrs["total"] == sum(one.rows for one in archives) and len(file["data"]) == 3
        assert json.loads(file["data"].attrs["env_args"])["env_kwargs"] == {
            "task": "reach", "robot": "panda", "size": SIZE, "fps": 10, "action": action}
        assert sorted([*file["mask/train"], *file["mask/valid"]]) == [b"demo_0", b"demo_1", b"demo_2"]
        for i, one in enumerate(archives):
            demo = file["data"][f"demo_{i}"]
            assert demo.attrs["num_samples"] == one.rows and json.loads(demo.attrs["ep_meta"])["lang"] == one.about["language"]["en"]
            np.testing.assert_array_equal(demo["actions"], one[f"action_{action}"])
            np.testing.assert_array_equal(demo["obs/object"], one["object_poses"])
            np.testing.assert_array_equal(demo["obs/joint_position"], one["joint_position"])
            np.testing.assert_array_equal(demo["states"], np.hstack([one["time"], one["qpos"], one["qvel"]]))
            assert demo["dones"][:].tolist() == demo["rewards"][:].tolist() == [0] * (one.rows - 1) + [1]
            for row in (0, one.rows // 2, one.rows - 1):
                np.testing.assert_array_equal(demo["obs/side_image"][row], one.picture("side", row))
            assert ("next_obs" in demo) == (action == "tool")
            if action == "tool":
                for name in demo["obs"]:
                    here, ahead = demo["obs"][name][:], demo["next_obs"][name][:]
                    np.testing.assert_array_equal(ahead, np.concatenate([here[1:], here[-1:]]))


def messages_of(file):
    out = {}
    with file.open("rb") as stream:
        for _, channel, message, decoded in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            out.setdefault(channel.topic, []).append((message.log_time, decoded))
    return out


def test_mcap_holds_every_row(parts, archives, tmp_path):
    assert to_mcap(parts, tmp_path / "set") == 3
    files = [tmp_path / "set" / f"episode_{one.about['seed']}_{one.about['number']:06d}.mcap" for one in archives]
    assert sorted((tmp_path / "set").iterdir()) == sorted(files)
    for file, one in zip(files, archives, strict=True):
        topics = messages_of(file)
        times = np.array([time for time, _ in topics["/joint_states"]]) / 1e9
        np.testing.assert_allclose(times, one["time"][:, 0], atol=1e-9)
        joints = np.array([[joint.position for joint in message.joints] for _, message in topics["/joint_states"]])
        np.testing.assert_array_equal(joints, np.hstack([one["joint_position"], one["gripper"]]))
        assert [message.data for _, message in topics["/front/image"]] == \
            [one.entries[f"frames/front/{row:06d}.png"] for row in range(one.rows)]
        frames = [{frame.child_frame_id: frame for frame in message.transforms} for _, message in topics["/tf"]]
        tool = np.array([[getattr(frame["tool"].translation, axis) for axis in "xyz"] for frame in frames])
        np.testing.assert_array_equal(tool, one["tool_pose"][:, :3])
        said = {message.name: message.message for _, message in topics["/log"]}
        assert said["task"] == one.about["language"]["en"] and said["outcome"] == "success"


def test_mcap_cameras_see_objects_where_they_are(parts, archives, tmp_path):
    """An object's middle, brought into a camera's frame and through its matrix, has the object's colour in the picture."""
    to_mcap(parts, tmp_path / "set")
    hits = 0
    for one in archives:
        topics = messages_of(tmp_path / "set" / f"episode_{one.about['seed']}_{one.about['number']:06d}.mcap")
        frames = {frame.child_frame_id: frame for frame in topics["/tf"][0][1].transforms}
        for camera in ("front", "side"):
            calibration, place = topics[f"/{camera}/calibration"][0][1], frames[camera]
            X = mjarm.Pose([place.translation.x, place.translation.y, place.translation.z],
                           quat=[place.rotation.w, place.rotation.x, place.rotation.y, place.rotation.z])
            for thing in one.about["scene"]["objects"]:
                x, y, z = np.array(calibration.K).reshape(3, 3) @ (X.inverse() @ mjarm.Pose(thing["pos"])).pos
                assert z > 0.3
                seen = one.picture(camera, 0)[int(y / z), int(x / z)] / 255
                wanted = np.array(thing["rgba"][:3])
                hits += float(seen @ wanted / np.linalg.norm(seen) / np.linalg.norm(wanted)) > 0.97
    assert hits >= 16  # of 18: the arm may stand before one


def test_the_same_bytes_again_from_parts_in_any_order(parts, tmp_path):
    for convert, name in ((to_lerobot, "set"), (to_robomimic, "set.hdf5"), (to_mcap, "mcap")):
        convert(parts, tmp_path / f"a-{name}")
        convert(parts[::-1], tmp_path / f"b-{name}")
        both = [tmp_path / f"{letter}-{name}" for letter in "ab"]
        held = [{file.relative_to(one): file.read_bytes() for file in [one, *one.rglob("*")] if file.is_file()} for one in both]
        assert held[0] and held[0] == held[1]


def test_what_is_there_is_kept(parts, tmp_path):
    out = tmp_path / "set"
    to_mcap(parts, out)
    before = {file: file.read_bytes() for file in out.iterdir()}
    with pytest.raises(mjarm.Usage, match="exists"):
        to_mcap(parts, out)

    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        to_mcap(parts, out, force=True, progress=stop)
    assert {file: file.read_bytes() for file in out.iterdir()} == before
    to_mcap(parts[:1], out, force=True)
    assert len(list(out.iterdir())) == 1
    (out / "thesis.tex").touch()
    for convert in (to_mcap, to_lerobot, to_robomimic):
        with pytest.raises(mjarm.Usage, match="something else"):
            convert(parts, out, force=True)
    assert (out / "thesis.tex").exists() and list(tmp_path.iterdir()) == [out]


def test_a_process_that_is_ended_leaves_nothing(parts, tmp_path):
    code = "import os, signal, sys; import mjarm.data.__main__ as it; " \
           "it._shown = lambda: lambda done, total: os.kill(os.getpid(), signal.SIGTERM); sys.exit(it.main(sys.argv[1:]))"
    for name in ("lerobot", "robomimic", "mcap"):
        done = subprocess.run([sys.executable, "-c", code, name, *map(str, parts), "--out", str(tmp_path / name)],
                              capture_output=True, text=True, timeout=300)
        assert done.returncode == 130 and "was not written" in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_missing_packages_are_told():
    for name, module, package in (("lerobot", "pyarrow", "pyarrow"), ("lerobot", "av", "av"), ("robomimic", "h5py", "h5py"),
                                  ("mcap", "mcap", "mcap"), ("mcap", "mcap_protobuf.writer", "mcap-protobuf-support")):
        code = f"import sys; sys.modules[{module!r}] = None; from mjarm.data.__main__ import main; " \
               f"sys.exit(main([{name!r}, '/nowhere', '--out', '/nowhere/out']))"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
        assert done.returncode == 1 and done.stderr.endswith(f"or pip install {package}\n"), done.stderr
        assert done.stderr.count("\n") == 1


def test_the_program(parts, tmp_path):
    done = converter("mcap", *parts, "--out", tmp_path / "set")
    assert done.returncode == 0 and done.stdout == f"{tmp_path / 'set'}: 3 episodes\n", done.stderr
    for words in (["mcap", *parts, "--out", tmp_path / "set"], ["mcap", tmp_path / "none", "--out", tmp_path / "x"],
                  ["lerobot", *parts, parts[0], "--out", tmp_path / "x"], ["robomimic", tmp_path, "--out", tmp_path / "x"]):
        done = converter(*words)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and not done.stdout, done.stderr
    assert converter("lerobot", "--help").returncode == 0
    assert list(tmp_path.iterdir()) == [tmp_path / "set"]
