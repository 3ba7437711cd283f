"""Tests that the layer check finds what it is for. Run: python3 tools/check_layers_test.py"""

import pathlib
import tempfile
import unittest

import check_layers

ROOT = pathlib.Path(__file__).resolve().parent.parent


def faults(path, text):
    return list(check_layers.faults_of(path, text))


class CheckLayersTest(unittest.TestCase):
    def assert_fault(self, path, text, part):
        found = faults(path, text)
        self.assertEqual(len(found), 1, found)
        self.assertIn(part, found[0])
        self.assertIn(path, found[0])

    def test_data_flows_one_way(self):
        self.assertEqual(faults("mjarm/path/a.cpp", '#include "mjarm/kinematics/ik.hpp"\n'), [])
        self.assert_fault("mjarm/kinematics/a.cpp", '#include "mjarm/path/line.hpp"\n', "kinematics may include")
        self.assert_fault("mjarm/kinematics/a.cpp", '#include "mjarm/collision/exact.hpp"\n', "may include only")
        self.assert_fault("mjarm/core/a.hpp", ' # include "mjarm/model/model.hpp"\n', "nothing")

    def test_line_number_is_named(self):
        self.assert_fault("mjarm/core/a.cpp", '\n\n#include "mjarm/sim/sim.hpp"\n', "a.cpp:3:")

    def test_every_room_stands_after_those_it_may_include(self):
        seen = []
        for room, allowed in check_layers.ALLOWED.items():
            self.assertTrue(set(allowed.split()) <= set(seen), room)
            seen.append(room)

    def test_unknown_rooms(self):
        self.assert_fault("mjarm/misc/a.cpp", "", "not in the order")
        self.assert_fault("mjarm/core/a.cpp", '#include "mjarm/misc/a.hpp"\n', "no room misc")

    def test_mujoco_stays_low(self):
        line = "#include <mujoco/mujoco.h>\n"
        for path in ("mjarm/model/load.cpp", "mjarm/view/window.cpp", "mjarm/path/line_test.cpp"):
            self.assertEqual(faults(path, line), [], path)
        for path in ("mjarm/model/model.hpp", "mjarm/kinematics/fk.cpp", "mjarm/collision/spheres.cpp", "apps/mjarm/a.cpp"):
            self.assert_fault(path, line, "MuJoCo")

    def test_test_headers_do_not_leak(self):
        self.assert_fault("mjarm/path/line.cpp", "#include <gtest/gtest.h>\n", "for tests")
        self.assert_fault("mjarm/path/line.cpp", '#include "mjarm/core/data_test.hpp"\n', "for tests")
        self.assert_fault("mjarm/path/line.cpp", '#include "tests/support/data.hpp"\n', "for tests")
        self.assertEqual(faults("mjarm/path/line_test.cpp", '#include "mjarm/core/data_test.hpp"\n'), [])
        self.assertEqual(faults("mjarm/path/line_test.cpp", '#include "tests/support/data.hpp"\n'), [])

    def test_internal_headers_stay_in_their_room(self):
        line = '#include "mjarm/model/impl_internal.hpp"\n'
        self.assertEqual(faults("mjarm/model/a.cpp", line), [])
        self.assert_fault("mjarm/sim/a.cpp", line, "room model alone")
        self.assert_fault("apps/mjarm/a.cpp", line, "room model alone")

    def test_kernel_headers_are_for_sources_of_any_room(self):
        line = '#include "mjarm/core/simd/lanes.hpp"\n'
        self.assertEqual(faults("mjarm/core/simd/lanes.hpp", "#include <immintrin.h>\n"), [])
        for path in ("mjarm/rl/a.cpp", "mjarm/rl/a_internal.hpp", "mjarm/core/simd/functions.hpp"):
            self.assertEqual(faults(path, line), [], path)
        self.assert_fault("mjarm/rl/policy.hpp", line, "not installed")

    def test_public_headers_show_only_eigen(self):
        good = "#include <Eigen/Core>\n#include <vector>\n"
        self.assertEqual(faults("mjarm/path/line.hpp", good), [])
        self.assertEqual(faults("mjarm/core/result.hpp", "#include <tl/expected.hpp>\n"), [])
        for header in ("fmt/core.h", "nlohmann/json.hpp", "tl/expected.hpp", "cairo.h"):
            self.assert_fault("mjarm/path/line.hpp", f"#include <{header}>\n", "standard library and Eigen only")

    def test_system_calls_stand_in_one_file(self):
        self.assertEqual(faults("mjarm/core/os.cpp", "#include <unistd.h>\n"), [])
        self.assert_fault("mjarm/sim/a.cpp", "#include <sys/stat.h>\n", "operating system")

    def test_paths_start_at_the_root(self):
        self.assert_fault("mjarm/core/a.cpp", '#include "pose.hpp"\n', "from the root")

    def test_long_files(self):
        self.assertEqual(faults("mjarm/core/a.cpp", "\n" * 500), [])
        self.assert_fault("mjarm/core/a.cpp", "\n" * 501, "501 lines")

    def test_whole_tree(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "mjarm/core").mkdir(parents=True)
            (root / "mjarm/core/a.cpp").write_text('#include "mjarm/rl/ppo.hpp"\n')
            self.assertEqual(len(check_layers.check(root)), 1)
            (root / "mjarm/core/a.cpp").write_text("")
            self.assertEqual(check_layers.check(root), [])


if __name__ == "__main__":
    unittest.main()
