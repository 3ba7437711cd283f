"""The calls of ikpy on mjarm: `from mjarm.ikpy import Chain` in place of `from ikpy.chain import Chain`.

Vectors have ikpy's shape: one number a link, the base and fixed links included. What cannot be reached raises, where ikpy
gives back the nearest it met without a word.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import BadInput, Pose, Robot
from ._core import language

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._core import Array

# Which turn puts an axis of the tool to where its z axis was: for inverse kinematics that meets one axis.
_TURNS = {"X": [0.0, np.pi / 2, 0.0], "Y": [-np.pi / 2, 0.0, 0.0], "Z": [0.0, 0.0, 0.0]}


@dataclass(frozen=True)
class Link:
    """What ikpy calls a link: a joint of the URDF and its origin; the first is the base."""

    name: str
    joint_type: str
    """ "revolute", "prismatic" or "fixed"."""
    bounds: tuple[float, float]
    """[rad or m]"""


class Chain:
    """The joints of a URDF from a base link to the tip, with ikpy's calls.

    Attributes
    ----------
    robot : Robot
        What answers.
    links : list of Link
    active_links_mask : array of bool, shape (n,)
    """

    def __init__(self, robot: Robot, links: Sequence[Link], base: Pose, *, name: str = "chain",
                 active_links_mask: ArrayLike | None = None) -> None:
        self.robot, self.links, self.name = robot, list(links), name
        self._base = base
        self._columns = [i for i, link in enumerate(self.links) if link.joint_type != "fixed"]
        mask = np.ones(len(self.links), bool) if active_links_mask is None else np.asarray(active_links_mask, bool)
        if mask.shape != (len(self.links),):
            raise _bad(f"active_links_mask: expected shape ({len(self.links)},), not {mask.shape}",
                       f"active_links_mask：形状应为 ({len(self.links)},)，而不是 {mask.shape}")
        if not mask[self._columns].all():
            still = [self.links[i].name for i in self._columns if not mask[i]]
            raise _bad(f"active_links_mask: joints cannot be left out of the search here ({', '.join(still)}); only fixed "
                       "links and the base may be False",
                       f"active_links_mask：这里不能把关节排除在求解之外（{', '.join(still)}）；只有固定连杆和基座可以为 False")
        self.active_links_mask = mask
        self._turned = {axis: robot.with_tool(Pose(euler=turn)) for axis, turn in _TURNS.items()}

    @classmethod
    def from_urdf_file(cls, urdf_file: str | os.PathLike[str], base_elements: Sequence[str] | None = None,
                       last_link_vector: ArrayLike | None = None, base_element_type: str = "link",
                       active_links_mask: ArrayLike | None = None, name: str = "chain", symbolic: bool = True) -> Chain:
        """The chain from a link of a URDF, "base_link" where none is named, always on to the first child
        below which something moves.

        `last_link_vector` [m] adds a tip there; `symbolic` makes no difference.
        """
        del symbolic
        if base_element_type != "link":
            raise _bad('base_element_type: only "link" is known here', 'base_element_type：这里只支持“link”')
        base, joints, tip = _walk(urdf_file, list(base_elements or ["base_link"]))
        robot = Robot(urdf_file, tip=tip, looks=False)
        moving = [name for name, kind in joints if kind != "fixed"]
        if moving != robot.joints:
            raise _bad(f"{os.fspath(urdf_file)}: joints before {base}, or coupled ones, are not known here: {moving}, not "
                       f"{robot.joints}",
                       f"{os.fspath(urdf_file)}：这里不支持 {base} 之前的关节或联动关节：{moving}，而不是 {robot.joints}")
        limits = iter(zip(robot.limits.lower, robot.limits.upper))
        links = [Link("Base link", "fixed", (-np.inf, np.inf))]
        links += [Link(name, kind, (0.0, 0.0) if kind == "fixed" else next(limits)) for name, kind in joints]
        if last_link_vector is not None:
            robot = robot.with_tool(Pose(last_link_vector))
            links.append(Link("last_joint", "fixed", (0.0, 0.0)))
        return cls(robot, links, robot.frame(base), name=name, active_links_mask=active_links_mask)

    def __len__(self) -> int:
        return len(self.links)

    def __repr__(self) -> str:
        return f"Kinematic chain name={self.name} links={[link.name for link in self.links]}"

    def forward_kinematics(self, joints: ArrayLike, full_kinematics: bool = False) -> Array:
        """The tip in the base link, a matrix of shape (4, 4). `joints` has one number a link."""
        if full_kinematics:
            raise _bad("full_kinematics: frames between base and tip are told by Robot(..., tip=LINK).fk",
                       "full_kinematics：基座与末端之间的坐标系请用 Robot(..., tip=连杆).fk 求得")
        return (self._base.inverse() @ self.robot.fk(self._active(joints, "joints"))).matrix

    def inverse_kinematics(self, target_position: ArrayLike | None = None, target_orientation: ArrayLike | None = None,
                           orientation_mode: str | None = None, *, initial_position: ArrayLike | None = None) -> Array:
        """One number a link that put the tip to a place in the base link [m].

        `orientation_mode` "X", "Y" or "Z" also has that axis of the tip point along the vector `target_orientation`,
        "all" has it turned as that matrix says. Of several answers that nearest to `initial_position` is taken.

        Raises
        ------
        Unreachable
            With the reason.
        """
        if target_position is None:
            raise _bad("target_position: expected a place [m]; a turn alone is not known here",
                       "target_position：应给出位置（m）；这里不支持只给姿态")
        target = np.eye(4)
        target[:3, 3] = target_position
        if orientation_mode == "all":
            target[:3, :3] = target_orientation
        elif orientation_mode in _TURNS:
            target[:3, :3] = _frame_with(np.asarray(target_orientation, float), "XYZ".index(orientation_mode))
        elif orientation_mode is not None:
            raise _bad(f'orientation_mode: expected None, "X", "Y", "Z" or "all", not {orientation_mode!r}',
                       f'orientation_mode：应为 None、"X"、"Y"、"Z" 或 "all"，而不是 {orientation_mode!r}')
        return self.inverse_kinematics_frame(target, initial_position, orientation_mode=orientation_mode)

    def inverse_kinematics_frame(self, target: ArrayLike, initial_position: ArrayLike | None = None, *,
                                 orientation_mode: str | None = None) -> Array:
        """The same for a matrix of shape (4, 4), of which `orientation_mode` says what has to be met."""
        X = self._base @ Pose.from_matrix(target)
        start = np.zeros(len(self.links)) if initial_position is None else np.asarray(initial_position, float)
        seed = self._active(start, "initial_position")
        if orientation_mode == "all":
            q = self.robot.ik(X, seed).q
        elif orientation_mode in _TURNS:
            q = self._turned[orientation_mode].ik(X @ Pose(euler=_TURNS[orientation_mode]), seed, task="axis").q
        else:
            q = self.robot.ik(X, seed, task="position").q
        answer = start.copy()
        answer[self._columns] = q
        return answer

    def _active(self, values: ArrayLike, name: str) -> Array:
        given = np.asarray(values, float)
        if given.shape != (len(self.links),):
            raise _bad(f"{name}: expected one number a link, shape ({len(self.links)},), not {given.shape}",
                       f"{name}：每个连杆一个数，形状应为 ({len(self.links)},)，而不是 {given.shape}")
        return given[self._columns]


def _bad(english: str, chinese: str) -> BadInput:
    """What is wrong, in the language in use."""
    return BadInput(chinese if language() == "zh" else english)


def _frame_with(axis: Array, column: int) -> Array:
    """Some rotation matrix with that axis [any length] as its column."""
    if axis.shape != (3,) or not np.isfinite(axis).all() or np.linalg.norm(axis) < 1e-9:
        raise _bad("target_orientation: expected a direction, shape (3,)", "target_orientation：应为方向，形状 (3,)")
    axis = axis / np.linalg.norm(axis)
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    side /= np.linalg.norm(side)
    frame = np.empty((3, 3))
    frame[:, column], frame[:, (column + 1) % 3], frame[:, (column + 2) % 3] = axis, side, np.cross(axis, side)
    return frame


def _walk(urdf_file: str | os.PathLike[str], elements: list[str]) -> tuple[str, list[tuple[str, str]], str]:
    """The base link, name and type of each joint from there on, and the last link."""
    try:
        root = ElementTree.parse(urdf_file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise _bad(f"{os.fspath(urdf_file)}: {error}", f"{os.fspath(urdf_file)}：{error}") from None
    known = [link.get("name") for link in root.findall("link")]
    if elements[0] not in known:
        names = ", ".join(map(str, known))
        raise _bad(f'{os.fspath(urdf_file)}: no link "{elements[0]}"; name one with base_elements: {names}',
                   f'{os.fspath(urdf_file)}：没有连杆“{elements[0]}”；请用 base_elements 指定其中之一：{names}')
    base = link = elements[0]
    wanted = elements[1:]
    joints: list[tuple[str, str]] = []
    while len(joints) < len(known):
        leaving = [j for j in root.findall("joint") if (p := j.find("parent")) is not None and p.get("link") == link]
        if wanted:
            leaving = [j for j in leaving if j.get("name") == wanted[0]]
            if not leaving:
                raise _bad(f'{os.fspath(urdf_file)}: no joint "{wanted[0]}" leaves {link}',
                           f'{os.fspath(urdf_file)}：{link} 之后没有关节“{wanted[0]}”')
            wanted = wanted[2:]
        if not leaving:
            break
        joint = next((j for j in leaving if _moves(root, j, len(known))), leaving[0])
        kind = joint.get("type", "fixed")
        joints.append((joint.get("name", ""), "revolute" if kind == "continuous" else kind))
        link = _child_of(joint)
    return base, joints, link


def _child_of(joint: ElementTree.Element) -> str:
    child = joint.find("child")
    return "" if child is None else child.get("link", "")


def _moves(root: ElementTree.Element, joint: ElementTree.Element, depth: int) -> bool:
    """Whether this joint moves, or one below it."""
    if joint.get("type", "fixed") != "fixed":
        return True
    below = [j for j in root.findall("joint") if (p := j.find("parent")) is not None and p.get("link") == _child_of(joint)]
    return depth > 0 and any(_moves(root, j, depth - 1) for j in below)
