"""Tests of the converter with a small robot. Run: python3 tools/convert_motionbenchmaker_test.py"""

import gzip
import io
import json
import math
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest

try:
    import yaml
except ImportError:
    yaml = None

TOOL = pathlib.Path(__file__).resolve().parent / "convert_motionbenchmaker.py"

URDF = """<robot name="toy">
  <link name="foot"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.3 0 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.04"/></geometry></collision></link>
  <link name="finger"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="hand"/><origin xyz="0.5 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.1" upper="0.4" velocity="1" effort="1"/></joint>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="arm"/><origin rpy="0 0 1.5707963267948966"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="3" effort="1"/></joint>
  <joint name="fix" type="fixed"><parent link="hand"/><child link="finger"/><origin xyz="0.1 0 0"/></joint>
</robot>"""
SRDF = """<robot name="toy"><disable_collisions link1="finger" link2="foot"/></robot>"""

SCENE = """world:
  collision_objects:
    - id: rod
      pose: {position: [0, 0.7, 0], orientation: [0, 0, 0, 1]}
      primitives: [{type: cylinder, dimensions: [0.4, 0.02]}]
      primitive_poses: [{position: [0, 0, 0.1], orientation: [0, 0, 0, 2]}]
    - id: crate
      primitives: [{type: box, dimensions: [0.2, 0.4, 0.6]}]
      primitive_poses: [{position: [3, 0, 0], orientation: [0, 0, 0, 1]}]
"""
REQUEST = """start_state: {joint_state: {name: [slide, extra, turn], position: [0.1, 9, -1]}}
goal_constraints:
  - joint_constraints: [{joint_name: turn, position: 0}, {joint_name: slide, position: 0.2}]
"""


@unittest.skipIf(yaml is None, "needs PyYAML")
class ConvertTest(unittest.TestCase):
    def convert(self, out="toy.json"):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "toy"
            folder.mkdir()
            (folder / "toy_spherized.urdf").write_text(URDF)
            (folder / "toy.srdf").write_text(SRDF)
            with tarfile.open(folder / "problems.tar.bz2", "w:bz2") as archive:
                for file, text in (("scene0007", SCENE), ("request0007", REQUEST), ("scene0008", SCENE)):
                    entry = tarfile.TarInfo(f"problems/cage_toy/{file}.yaml")
                    entry.size = len(text)
                    archive.addfile(entry, io.BytesIO(text.encode()))
            done = subprocess.run([sys.executable, TOOL, folder, "--out", folder / out],
                                  capture_output=True, text=True, check=True)
            self.assertIn("1 problems of toy", done.stdout)
            content = (folder / out).read_bytes()
        return json.loads(gzip.decompress(content) if out.endswith(".gz") else content)

    def test_robot(self):
        robot = self.convert()["robot"]
        self.assertEqual(robot["base"], "foot")
        self.assertEqual(robot["joint_names"], ["turn", "slide"])  # parents first
        self.assertEqual((robot["lower"], robot["upper"]), ([-2, -0.1], [2, 0.4]))
        half = math.sqrt(0.5)
        for found, right in zip(robot["joints"][0]["quat"], [half, 0, 0, half]):
            self.assertAlmostEqual(found, right)
        self.assertEqual(len(robot["spheres"]), 4)
        # Neighbours, what is rigid, and what the SRDF allows are left out.
        self.assertEqual(robot["self_collision_link_pairs"], [["foot", "hand"]])

    def test_problem(self):
        problem, = self.convert("toy.json.gz")["problems"]
        self.assertEqual(problem["id"], "toy/cage/0007")
        self.assertEqual(problem["start"], [-1, 0.1])
        self.assertEqual(problem["goals"], [[0, 0.2]])
        rod, crate = problem["obstacles"]
        self.assertEqual((rod["length"], rod["radius"], rod["vamp_as"]), (0.4, 0.02, "capsule"))
        self.assertEqual((rod["pos"], rod["quat"]), ([0, 0.7, 0.1], [1, 0, 0, 0]))
        self.assertEqual(crate["half"], [0.1, 0.2, 0.3])
        # At turn 0 the arm points along y: the hand is at 0.7, in the rod.
        self.assertEqual((problem["start_free"], problem["goals_free"], problem["valid"]), (True, [False], False))


if __name__ == "__main__":
    unittest.main()
