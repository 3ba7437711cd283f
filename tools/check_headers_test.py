"""Tests of check_headers.py."""

import json
import os
import pathlib
import tempfile
import unittest

import check_headers

COMPILER = os.environ.get("CXX", "c++")


class CheckHeaders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.build = self.root / "build"
        self.build.mkdir()
        entry = {"directory": str(self.build), "file": "x.cpp", "command": f"/usr/bin/env {COMPILER} -O2 -c x.cpp"}
        (self.build / "compile_commands.json").write_text(json.dumps([entry]))
        self.write("core/result.hpp", "#pragma once\n#include <string>\nnamespace mjarm { using Name = std::string; }\n")

    def write(self, name, text):
        path = self.root / "mjarm" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def faults(self):
        return check_headers.check(self.root, self.build)

    def test_a_header_that_lacks_an_include_is_told_until_it_has_it(self):
        lacking = "#pragma once\nnamespace mjarm { inline Name name() { return {}; } }\n"
        self.write("core/lacking.hpp", lacking)
        self.write("core/whole.hpp", '#pragma once\n#include "mjarm/core/result.hpp"\ninline mjarm::Name f() { return {}; }\n')
        for _ in range(2):  # a fault is not forgotten by the next run
            faults = self.faults()
            self.assertEqual(len(faults), 1)
            self.assertIn("mjarm/core/lacking.hpp does not compile alone", faults[0])
        self.write("core/lacking.hpp", '#include "mjarm/core/result.hpp"\n' + lacking)
        self.assertEqual(self.faults(), [])

    def test_a_change_far_below_is_seen(self):
        self.write("core/user.hpp", '#pragma once\n#include "mjarm/core/result.hpp"\ninline mjarm::Name g() { return {}; }\n')
        self.assertEqual(self.faults(), [])
        self.write("core/result.hpp", "#pragma once\nnamespace mjarm {}\n")
        self.assertIn("mjarm/core/user.hpp", self.faults()[0])

    def test_what_is_not_for_users_is_not_looked_at(self):
        self.write("core/odd_internal.hpp", "nonsense\n")
        self.assertEqual(self.faults(), [])


if __name__ == "__main__":
    unittest.main()
