"""Archives that are not what `mjarm record` writes are told in one line, whatever is wrong with them."""

import io
import json
import random
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import mjarm
from mjarm.data._episodes import Episode, EpisodeSet


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    out = tmp_path_factory.mktemp("recorded")
    done = subprocess.run([sys.executable, "-m", "mjarm", "record", "reach", "--out", str(out), "--size", "16", "--episodes", "1"],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return out / "episode_000000.zip"


def changed(recorded, file, entries=(), compression=zipfile.ZIP_STORED, **head):
    """A copy with other entries and other members of episode.json."""
    file.parent.mkdir(exist_ok=True)
    with zipfile.ZipFile(recorded) as source:
        held = {name: source.read(name) for name in source.namelist()}
    held["episode.json"] = json.dumps(json.loads(held["episode.json"]) | head)
    held |= dict(entries)
    with zipfile.ZipFile(file, "w", compression) as out:
        for name, data in held.items():
            if data is not None:
                out.writestr(name, data)
    return file


def read_all(file):
    with Episode(file) as episode:
        for name in ("time", "qpos", "joint_position", "action_joint"):
            episode.column(name)
        for row in range(episode.head.rows):
            episode.picture("front", row)
        return episode.head


def npy(array):
    file = io.BytesIO()
    np.save(file, array, allow_pickle=True)
    return file.getvalue()


HUGE = npy(np.zeros((2, 1))).replace(b"(2, 1)", b"(10**9, 9)")


@pytest.mark.parametrize(("change", "told"), [
    ({"schema": "mjarm.episode/2"}, "schema"), ({"rows": -1}, '"rows"'), ({"rows": True}, '"rows"'), ({"size": 1e9}, '"size"'),
    ({"fps": 0}, '"fps"'), ({"seed": 1 << 70}, '"seed"'), ({"task": "a\nb"}, '"task"'), ({"joints": ["a", "a"]}, '"joints"'),
    ({"joints": "abc"}, '"joints"'), ({"scene": []}, '"scene"'), ({"cameras": [{"name": "../x"}]}, '"cameras.pose"'),
    ({"rows": 10_000}, "npy"), ({"language": {"en": 3}}, '"language.en"'),
    ({"entries": {"time.npy": None}}, "time.npy"), ({"entries": {"time.npy": b"\x93NUMPY"}}, "time.npy"),
    ({"entries": {"time.npy": npy(np.array([[{}]]))}}, "time.npy"), ({"entries": {"time.npy": HUGE}}, "time.npy"),
    ({"entries": {"qpos.npy": npy(np.full((3, 3), np.nan))}}, "qpos.npy"), ({"entries": {"episode.json": b"[" * 100_000}}, "JSON"),
    ({"entries": {"episode.json": b"[]"}}, '"/"'), ({"entries": {"frames/front/000000.png": b"GIF89a"}}, "picture"),
    ({"entries": {"frames/front/000000.png": None}}, "000000.png"), ({"compression": zipfile.ZIP_DEFLATED}, "stored"),
])
def test_what_is_wrong_is_told(recorded, tmp_path, change, told):
    with pytest.raises(mjarm.BadInput) as wrong:
        read_all(changed(recorded, tmp_path / "episode_000000.zip", **change))
    assert told in str(wrong.value) and "\n" not in str(wrong.value) and "episode_000000.zip" in str(wrong.value)


def test_names_of_cameras_are_no_paths(recorded, tmp_path):
    with zipfile.ZipFile(recorded) as source:
        cameras = json.loads(source.read("episode.json"))["cameras"]
    for names in (("../x", "side"), ("a/b", "side"), ("side", "side"), ("", "side")):
        wrong = [camera | {"name": name} for camera, name in zip(cameras, names, strict=True)]
        with pytest.raises(mjarm.BadInput, match="different names"):
            read_all(changed(recorded, tmp_path / "episode_000000.zip", cameras=wrong))


def test_no_archive_at_all(recorded, tmp_path):
    data = recorded.read_bytes()
    for i, wrong in enumerate((b"", b"PK", data[:-1], data[:1000], data + b"x", data[:-22] + data[-22:-6] + b"\xff" * 6, b"\0" * 100)):
        file = tmp_path / f"{i}.zip"
        file.write_bytes(wrong)
        with pytest.raises(mjarm.BadInput, match="no zip archive"):
            read_all(file)
    with pytest.raises(mjarm.BadInput, match="cannot be read"):
        read_all(tmp_path / "none.zip")


def test_changed_bytes_are_noticed_or_harmless(recorded, tmp_path):
    data, draw, told = recorded.read_bytes(), random.Random(5), 0
    directory = data.rindex(b"PK\1\2", 0, data.index(b"PK\1\2") + 4)
    file = tmp_path / "episode.zip"
    for i in range(400):
        bytes_now = bytearray(data)
        for _ in range(draw.choice((1, 1, 4))):
            at = draw.randrange(directory if i % 2 else 0, len(data))
            bytes_now[at] = draw.randrange(256)
        file.write_bytes(bytes_now)
        try:
            read_all(file)
        except mjarm.BadInput as wrong:
            told += 1
            assert "\n" not in str(wrong)
    assert told > 250


def test_parts_have_the_same_options_and_other_episodes(recorded, tmp_path):
    first = recorded.parent
    for other, told in (({"fps": 5}, "another task"), ({"task": "pick_place"}, "another task"), ({"model_hash": "0"}, "another task"),
                        ({"reason": "x"}, "is in .* as well")):
        changed(recorded, tmp_path / "b" / "episode_000000.zip", **other)
        with pytest.raises(mjarm.BadInput, match=told):
            EpisodeSet([first, tmp_path / "b"])
    changed(recorded, tmp_path / "b" / "episode_000000.zip", seed=9)
    assert [entry.seed for entry in EpisodeSet([tmp_path / "b", first]).entries] == [1, 9]
    with pytest.raises(mjarm.BadInput, match="no such folder"):
        EpisodeSet([tmp_path / "none"])


def test_failures_are_left_out_unless_asked_for(recorded, tmp_path):
    changed(recorded, tmp_path / "a" / "episode_000000.zip")
    (tmp_path / "a" / "failed").mkdir()
    changed(recorded, tmp_path / "a" / "failed" / "episode_000001.zip", number=1, success=False, reason="contact")
    changed(recorded, tmp_path / "a" / "failed" / "episode_000002.zip", number=2, success=False, reason="no_path", rows=0)
    assert [entry.number for entry in EpisodeSet([tmp_path / "a"]).entries] == [0]
    failed = EpisodeSet([tmp_path / "a"], failed=True)
    assert [entry.number for entry in failed.entries] == [0, 1]  # what could not be planned has no rows
    assert [float(episode.rewards().sum()) for episode in failed] == [1, 0]


def test_an_episode_that_changes_meanwhile_is_noticed(recorded, tmp_path):
    file = changed(recorded, tmp_path / "a" / "episode_000000.zip")
    episodes = EpisodeSet([tmp_path / "a"])
    changed(recorded, file, number=7)
    with pytest.raises(mjarm.BadInput, match="changed meanwhile"):
        list(episodes)
