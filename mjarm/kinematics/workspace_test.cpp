#include "mjarm/kinematics/workspace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/kinematics/arms_test.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

/// Two hinges about z, links of 0.5 m and 0.3 m.
Arm planar_arm() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return testing::make_arm(
      "planar", {{{0, 0, 0}, {0, 0, 0}, z, -3, 3.5}, {{0.5, 0, 0}, {0, 0, 0}, z, -pi, pi}},
      {{0.3, 0, 0}, Eigen::Matrix3d::Identity()});
}

TEST(Workspace, OfATwoLinkArmIsARingWithTwoBranches) {
  const WorkspaceMap map = map_workspace(planar_arm(), {.at = 0, .step = 0.05}).value();
  ASSERT_EQ(map.branches.size(), static_cast<std::size_t>(map.columns) * map.rows);
  EXPECT_TRUE(map.counted);
  int reached = 0;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double r = std::hypot(map.u_at(column), map.v_at(row));
      if (std::abs(r - 0.2) < 1e-6 || std::abs(r - 0.8) < 1e-6) continue;  // the very edge
      const std::size_t cell = static_cast<std::size_t>(row) * map.columns + column;
      EXPECT_EQ(map.branches[cell], r > 0.2 && r < 0.8 ? 2 : 0) << r;
      EXPECT_EQ(std::isnan(map.manipulability[cell]), map.branches[cell] == 0);
      reached += map.branches[cell] > 0 ? 1 : 0;
    }
  }
  EXPECT_NEAR(reached * 0.05 * 0.05, pi * (0.64 - 0.04), 0.1);
}

TEST(Workspace, AxesAndBorderFollowTheSlice) {
  const WorkspaceMap map = map_workspace(planar_arm(), {.normal = 1, .at = 0, .step = 0.1}).value();
  EXPECT_EQ(map.u, 0);
  EXPECT_EQ(map.v, 2);
  EXPECT_EQ(map.rows, 3);  // the plane of the arm and a border of one cell
  EXPECT_NEAR(map.v_at(1), 0, 1e-12);
  EXPECT_EQ(map.branches[0], 0);
}

TEST(Workspace, IsTheSameForAnyNumberOfThreads) {
  WorkspaceOptions options{.at = 0.3, .step = 0.2, .R_WT = from_euler({pi, 0, 0})};
  const WorkspaceMap one = map_workspace(testing::ur5e(), options).value();
  options.threads = 4;
  const WorkspaceMap four = map_workspace(testing::ur5e(), options).value();
  EXPECT_EQ(one.branches, four.branches);
  for (std::size_t i = 0; i < one.manipulability.size(); ++i) {
    const bool same = one.manipulability[i] == four.manipulability[i];
    EXPECT_TRUE(same || std::isnan(one.manipulability[i])) << i;
  }
}

TEST(Workspace, OfARedundantArmSaysOnlyYesOrNo) {
  const WorkspaceMap map =
      map_workspace(testing::ur5e(), {.at = 0.3, .step = 0.3}).value();  // any orientation
  EXPECT_FALSE(map.counted);
  for (const int branches : map.branches) EXPECT_LE(branches, 1);
}

TEST(Workspace, RefusesWhatCannotBeMapped) {
  const Arm arm = planar_arm();
  EXPECT_EQ(map_workspace(arm, {.step = 0}).error().code, Errc::bad_input);
  EXPECT_EQ(map_workspace(arm, {.step = std::nan("")}).error().code, Errc::bad_input);
  EXPECT_EQ(map_workspace(arm, {.at = std::nan("")}).error().code, Errc::bad_input);
  EXPECT_EQ(map_workspace(arm, {.step = 1e-6}).error().code, Errc::usage);
  EXPECT_EQ(map_workspace(arm, {.at = 0.1}).error().code, Errc::impossible);
  const auto stopped = map_workspace(arm, {.at = 0, .stop = [] { return true; }});
  EXPECT_EQ(stopped.error().code, Errc::system);
}

}  // namespace
}  // namespace mjarm
