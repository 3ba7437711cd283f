"""Tests of what ssik_arms.py hands over; they need no ssik. Run: python3 tools/ssik_arms_test.py"""

import math
import types
import unittest
import xml.etree.ElementTree

import ssik_arms

TURN_Y = [[0, 0, 1, 0.5], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]  # by a quarter about y, half a meter on


def turned(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll), as URDF has it."""
    def about(axis, angle):
        c, s = math.cos(angle), math.sin(angle)
        R = [[1, 0, 0], [0, c, -s], [0, s, c]]
        return [[R[(i - axis) % 3][(j - axis) % 3] if i < 3 and j < 3 else float(i == j) for j in range(4)] for i in range(4)]
    return ssik_arms.product(about(2, yaw), ssik_arms.product(about(1, pitch), about(0, roll)))


class SsikArmsTest(unittest.TestCase):
    def test_turns_come_back(self):
        for angles in ((0.3, -0.7, 2.9), (-3.0, 1.2, 0.4), (0.0, math.pi / 2, 0.8), (0.0, -math.pi / 2, -1.1)):
            said = xml.etree.ElementTree.fromstring(ssik_arms.origin(turned(*angles))).get("rpy")
            again = turned(*map(float, said.split()))
            for row, expected in zip(again, turned(*angles)):
                for value, wanted in zip(row, expected):
                    self.assertAlmostEqual(value, wanted, places=9)

    def test_a_chain(self):
        def joint(kind, limits):
            return types.SimpleNamespace(T_left=TURN_Y, T_right=TURN_Y, axis=(0, 0, 1), joint_type=kind, limits=limits)
        robot = xml.etree.ElementTree.fromstring(ssik_arms.urdf("two", [joint("revolute", (-1, 2)), joint("revolute", None)]))
        first, second, flange = robot.findall("joint")
        self.assertEqual([one.get("type") for one in (first, second, flange)], ["revolute", "continuous", "fixed"])
        self.assertEqual(first.find("limit").get("upper"), "2.0")
        self.assertEqual(second.find("origin").get("xyz"), "0.5 0.0 -0.5")  # what is behind the first comes before the second
        self.assertEqual([one.find("child").get("link") for one in (first, second, flange)], ["link1", "link2", "tool"])

    def test_a_program_that_fails_is_told(self):
        self.assertEqual(ssik_arms.refused("true", "a.urdf"), "")
        self.assertIn("exit code 1", ssik_arms.refused("false", "a.urdf"))


if __name__ == "__main__":
    unittest.main()
