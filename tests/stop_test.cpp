// Every long call of the library ends early when it is told to, and says so; one that is never told
// to gives the same answer as one that is not asked.
#include "mjarm/core/stop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mjarm/collision/cover.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/path_measures.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

constexpr const char* kStopped = "stopped by the user";

/// False so many times, then true for good.
class After {
 public:
  explicit After(int times) : left_(times) {}
  StopCheck check() {
    return [this] { return left_-- <= 0; };
  }

 private:
  int left_;
};

StopCheck never() {
  return [] { return false; };
}

class Stop : public ::testing::Test {
 protected:
  LanguageScope english_{Language::english};
  Robot robot_ = load_robot("ur5e").value();
  IkSolver ik_{robot_.arm};
  Curve line_ = Curve::line(Pose{{0.3, 0.4, 0.4}, down()}, Pose{{-0.3, 0.4, 0.4}, down()}).value();

  static Eigen::Matrix3d down() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }
};

TEST_F(Stop, PathsEndInTheMiddle) {
  CurveOptions options;
  const auto whole = solve_curve(ik_, line_, as_span(robot_.arm.home), options);
  ASSERT_TRUE(whole);
  options.path.stop = never();
  const auto asked = solve_curve(ik_, line_, as_span(robot_.arm.home), options);
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->q, whole->q);
  for (const int times : {0, 1, 20, 70, 100}) {
    After after(times);
    options.path.stop = after.check();
    const auto part = solve_curve(ik_, line_, as_span(robot_.arm.home), options);
    ASSERT_FALSE(part) << times;
    EXPECT_EQ(part.error().code, PathErrc::stopped) << times;
    EXPECT_EQ(name(part.error().code), "stopped");
  }
}

TEST_F(Stop, RepairsAndMeasuresEnd) {
  const Curve far =
      Curve::line(Pose{{0.3, 0.4, 0.4}, down()}, Pose{{2.3, 0.4, 0.4}, down()}).value();
  CurveOptions options;
  const auto failed = solve_curve(ik_, far, as_span(robot_.arm.home), options);
  ASSERT_FALSE(failed);
  int asked = 0;
  options.path.stop = [&asked] { return ++asked > 5; };
  EXPECT_TRUE(find_fixes(ik_, far, as_span(robot_.arm.home), options, failed.error()).empty());
  const std::vector<Pose> poses(50, Pose{{5, 0, 0}, down()});
  EXPECT_TRUE(
      unreachable_ranges(ik_, poses, as_span(robot_.arm.home), [] { return true; }).empty());
  const std::vector<JointVec> rows(50, robot_.arm.home);
  EXPECT_TRUE(
      std::isinf(measure_path(robot_.arm, rows, {}, [] { return true; }).manipulability.value));
}

TEST_F(Stop, CoversAndPlansEnd) {
  for (const int times : {0, 100}) {
    After after(times);
    const auto cover = cover_model(robot_.model, robot_.arm, {.stop = after.check()});
    ASSERT_FALSE(cover) << times;
    EXPECT_EQ(cover.error().what, kStopped);
  }
  auto world = PlanningWorld::create(robot_).value();
  JointVec goal = robot_.arm.home;
  goal[0] += 1;
  const std::vector<JointVec> goals{goal};
  ASSERT_TRUE(world.plan(as_span(robot_.arm.home), goals));
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    PlanOptions options{.planner = planner, .rounds = 4, .stop = never()};
    EXPECT_TRUE(world.plan(as_span(robot_.arm.home), goals, options));
    options.stop = [] { return true; };
    const auto part = world.plan(as_span(robot_.arm.home), goals, options);
    ASSERT_FALSE(part);
    EXPECT_EQ(part.error().code, WorldErrc::no_path);
    EXPECT_EQ(part.error().search.code, PlanErrc::stopped);
    EXPECT_EQ(part.error().what, kStopped);
  }
}

TEST_F(Stop, ProgramsEndAndNeverPassForWhole) {
  const support::TempFolder folder;
  const auto file = folder.write("p.yaml",
                                 "robot: ur5e\nprogram:\n"
                                 "  - movej: {joints: [0, -1.57, 1.57, -1.57, -1.57, 0]}\n"
                                 "  - movel: {pos: [-0.3, -0.5, 0.4], euler: [3.14, 0, 0]}\n"
                                 "  - movel: {pos: [-0.3, -0.35, 0.4], euler: [3.14, 0, 0]}\n");
  ASSERT_TRUE(program::load_program(file.string(), never()));
  for (const int times : {0, 3, 30}) {
    After after(times);
    const auto part = program::load_program(file.string(), after.check());
    ASSERT_FALSE(part) << times;
    EXPECT_EQ(part.error().what, kStopped);
  }
}

TEST_F(Stop, EvaluationsEndWithinAStep) {
  const rl::ReachOptions task;
  const Model model = rl::reach_model(task).value();
  const auto still = [](std::span<const float>, std::span<float> actions) {
    std::ranges::fill(actions, 0.0F);
  };
  const auto whole = rl::evaluate(model, task, still, {.episodes = 3});
  ASSERT_TRUE(whole);
  const auto asked = rl::evaluate(model, task, still, {.episodes = 3, .stop = never()});
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->distances, whole->distances);
  for (const int times : {0, 1, 9}) {
    After after(times);
    const auto part = rl::evaluate(model, task, still, {.episodes = 3, .stop = after.check()});
    ASSERT_FALSE(part) << times;
    EXPECT_EQ(part.error().what, kStopped);
  }
}

}  // namespace
}  // namespace mjarm
