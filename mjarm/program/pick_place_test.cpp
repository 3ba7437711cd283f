#include "mjarm/program/pick_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

/// A robot before a table with a box on it.
Robot at_table(const support::TempFolder& folder, const std::string& robot,
               const std::string& objects) {
  const auto scene = folder.write("scene.xml", "<mujoco><include file='" + robot +
                                                   "'/><worldbody>"
                                                   "<geom name='table' type='box' size='0.3 0.4 0.1' pos='0.6 0 0.1'/>" +
                                                   objects + "</worldbody></mujoco>");
  auto loaded = load_robot(scene.string());
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().what);
  return *loaded;
}

constexpr const char* kBox =
    "<body name='box' pos='0.5 0.1 0.23'><freejoint/><geom type='box' size='0.02 0.025 0.03' mass='0.1'/></body>";

TEST(PlanPick, CarriesABoxOverTheTable) {
  for (const char* name :
       {"universal_robots_ur5e/ur5e_gripper.xml", "franka_emika_panda/panda.xml"}) {
    SCOPED_TRACE(name);
    const support::TempFolder folder;
    const Robot robot = at_table(folder, name, kBox);
    const PickTask task{"box", {.X_WB = {{0.5, -0.2, 0.23}, Eigen::Matrix3d::Identity()}, .any_turn = true}};
    const auto plan = plan_pick(robot, {}, as_span(robot.arm.home), task);
    ASSERT_TRUE(plan) << plan.error().what;
    EXPECT_EQ(plan->plan.moves.size(), 9u);
    std::printf("%zu dropped, %.2f s, width %.3f\n", plan->dropped.size(), plan->plan.duration(), plan->grasp.width);
  }
}

}  // namespace
}  // namespace mjarm::program
