"""`episode.json`: what an episode says of itself."""

from __future__ import annotations

import json
import math
import pathlib
from dataclasses import dataclass
from typing import Any, cast

from ._archive import Archive, fault

SCHEMA = "mjarm.episode/1"
MAX_JSON = 1 << 24
MAX_TEXT = 1000
MAX_ROWS = 1_000_000
MAX_NUMBER = 1_000_000_000
MAX_SEED = (1 << 64) - 1
MAX_PARTS = 64  # joints, objects


@dataclass(frozen=True)
class CameraHead:
    """A pinhole camera that stands."""

    name: str
    size: int  # [px] of the square picture
    focal: tuple[float, float]  # [px] fx, fy
    center: tuple[float, float]  # [px] cx, cy
    position: tuple[float, ...]  # [m] (3,) in the world
    quaternion: tuple[float, ...]  # (4,) w x y z; looks along -z, y is up


@dataclass(frozen=True)
class Head:
    """What decides an episode, and what came of it."""

    task: str
    robot: str
    seed: int
    number: int
    size: int
    fps: int
    rows: int
    success: bool
    reason: str
    model_hash: str
    english: str
    chinese: str
    joints: tuple[str, ...]
    objects: tuple[str, ...]
    cameras: tuple[CameraHead, ...]
    motions: tuple[str, ...]  # a word each

    @property
    def kind(self) -> tuple[object, ...]:
        """What all episodes of a set have in common."""
        return self.task, self.robot, self.size, self.fps, self.model_hash, self.joints, self.objects


class _Fields:
    """Members of an object; what does not fit raises with its name."""

    def __init__(self, source: pathlib.Path, value: Any, name: str = "") -> None:
        self._source, self._name = source, name
        if not isinstance(value, dict):
            raise self._wrong("", "{...}")
        self._object: dict[str, Any] = value

    def _wrong(self, member: str, wanted: str) -> Exception:
        where = ".".join(part for part in (self._name, member) if part) or "/"
        return fault(self._source, f'episode.json: "{where}" should be {wanted}', f"episode.json：“{where}”应为 {wanted}")

    def text(self, member: str) -> str:
        value = self._object.get(member)
        if not isinstance(value, str) or len(value) > MAX_TEXT or not value.isprintable():
            raise self._wrong(member, "\"...\"")
        return value

    def whole(self, member: str, least: int, most: int) -> int:
        value = self._object.get(member)
        if type(value) is not int or not least <= value <= most:
            raise self._wrong(member, f"{least}..{most}" if least < most else str(least))
        return value

    def flag(self, member: str) -> bool:
        value = self._object.get(member)
        if not isinstance(value, bool):
            raise self._wrong(member, "true/false")
        return value

    def numbers(self, member: str, count: int) -> tuple[float, ...]:
        value = self.list(member)
        if len(value) != count or any(
                type(one) not in (int, float) or not math.isfinite(one) or abs(one) > 1e9 for one in value):
            raise self._wrong(member, f"[{count} x number]")
        return tuple(float(one) for one in value)

    def number(self, member: str) -> float:
        value = self._object.get(member)
        return _Fields(self._source, {member: [value]}, self._name).numbers(member, 1)[0]

    def inner(self, member: str) -> _Fields:
        return _Fields(self._source, self._object.get(member), f"{self._name}.{member}".lstrip("."))

    def list(self, member: str, most: int = MAX_PARTS) -> list[Any]:
        value = self._object.get(member)
        if not isinstance(value, list) or len(cast(list[Any], value)) > most:
            raise self._wrong(member, f"[0..{most} x ...]")
        return cast(list[Any], value)

    def names(self, member: str, key: str | None = None) -> tuple[str, ...]:
        """Texts, or one member of each object; not one twice."""
        rows = [_Fields(self._source, one if key else {"": one}, member) for one in self.list(member)]
        out = tuple(row.text(key or "") for row in rows)
        if len(set(out)) != len(out) or not all(out):
            raise self._wrong(member, "[a, b, ...]")
        return out


def _camera(fields: _Fields, size: int) -> CameraHead:
    pose = fields.inner("pose")
    fields.whole("width", size, size)
    fields.whole("height", size, size)
    return CameraHead(name=fields.text("name"), size=size, focal=(fields.number("fx"), fields.number("fy")),
                      center=(fields.number("cx"), fields.number("cy")),
                      position=pose.numbers("pos", 3), quaternion=pose.numbers("quat", 4))


def read_head(archive: Archive) -> Head:
    """Reads and checks `episode.json`.

    Raises BadInput with the member and what was expected there.
    """
    source = archive.source
    try:
        document = json.loads(archive.read("episode.json", MAX_JSON))
    except (ValueError, RecursionError) as bad:
        raise fault(source, "episode.json is no JSON", "episode.json 不是 JSON") from bad
    fields = _Fields(source, document)
    if fields.text("schema") != SCHEMA:
        raise fault(source, f"episode.json: expected schema {SCHEMA}", f"episode.json：schema 应为 {SCHEMA}")
    language, plan, size = fields.inner("language"), fields.inner("plan"), fields.whole("size", 16, 1024)
    cameras = tuple(_camera(_Fields(source, one, "cameras"), size) for one in fields.list("cameras", 8))
    names = [camera.name for camera in cameras]
    if len(set(names)) != len(names) or not all(name.isidentifier() for name in names):
        raise fault(source, "episode.json: expected cameras with different names of letters", "episode.json：相机名应为字母且互不相同")
    return Head(task=fields.text("task"), robot=fields.text("robot"), seed=fields.whole("seed", 0, MAX_SEED),
                number=fields.whole("number", 0, MAX_NUMBER), size=size, fps=fields.whole("fps", 1, 50),
                rows=fields.whole("rows", 0, MAX_ROWS), success=fields.flag("success"), reason=fields.text("reason"),
                model_hash=fields.text("model_hash"), english=language.text("en"), chinese=language.text("zh"),
                joints=fields.names("joints"), objects=fields.inner("scene").names("objects", "name"), cameras=cameras,
                motions=tuple(_Fields(source, one, "motions").text("word") for one in plan.list("motions", 10_000)))
