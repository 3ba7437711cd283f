"""Tests of the comparison of numbers. Run: python3 tools/compare_numbers_test.py"""

import unittest

from compare_numbers import compare


class CompareNumbers(unittest.TestCase):
    def test_numbers_may_differ_a_little(self):
        largest, fault = compare("q 1.0,2e3\nend", "q 1.0000000001,2000\nend", 1e-9)
        self.assertIsNone(fault)
        self.assertAlmostEqual(largest, 1e-10, delta=1e-14)

    def test_too_far_apart_is_a_fault(self):
        self.assertIn("line 1: 1.0 and 1.1", compare("a 1.0", "a 1.1", 1e-9)[1])

    def test_words_and_numbers_of_lines_are_equal(self):
        self.assertIsNotNone(compare("up 1", "down 1", 1e-9)[1])
        self.assertIsNotNone(compare("1\n2", "1", 1e-9)[1])

    def test_large_numbers_are_compared_relatively(self):
        self.assertIsNone(compare("1000000000", "1000000000.5", 1e-9)[1])

    def test_a_quaternion_may_have_either_sign(self):
        table = "t,tool qw,tool qx,tool qy,tool qz\n0,0.0,1.0,0.0,0.0\n"
        self.assertIsNone(compare(table, table.replace("1.0", "-1.0"), 1e-9)[1])
        self.assertIsNotNone(compare(table, table.replace("1.0", "0.9"), 1e-9)[1])

    def test_measured_times_and_ways_to_write_a_path_do_not_count(self):
        self.assertIsNone(compare('"rtf": 1\nout/log.csv', '"rtf": 200\r\nout\\log.csv', 1e-9, ['"rtf"'])[1])


if __name__ == "__main__":
    unittest.main()
