// What the fingers hold belongs to the arm: in plans, in runs and in the report.
#include "mjarm/program/held_part_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mjarm/execution/motion_run.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using testing::PartAndFence;
using testing::pick_up;
using testing::planned;
using testing::planned_blindly;
using testing::pose_at;

std::string lifted() { return pick_up() + "  - movel: " + pose_at(0.5, -0.2, 0.2) + "\n"; }

std::string faults_of(const LoadedProgram& loaded) {
  std::string out;
  for (const ProgramFault& fault : loaded.plan.faults) out += line_of(loaded, fault) + "\n";
  return out;
}

/// How low any corner of the part comes while it is over the fence, [m].
double lowest_over_fence(const ProgramPlan& plan) {
  const Arm& arm = plan.arms.front();
  double lowest = 10;
  for (const PlannedMove& move : plan.moves) {
    if (move.attached.empty()) continue;
    for (double t = 0; t <= move.trajectory.duration(); t += 2e-3) {
      const Pose X_WB = fk(arm, as_span(move.trajectory.at(t).q)) * move.attached.front().X_TB;
      for (int k = 0; k < 8; ++k) {
        const Eigen::Vector3d corner((k & 1) != 0 ? 0.02 : -0.02, (k & 2) != 0 ? 0.02 : -0.02,
                                     (k & 4) != 0 ? 0.04 : -0.04);
        const Eigen::Vector3d p = X_WB * corner;
        const bool over = std::abs(p.y()) < 0.01 && p.x() > 0.2 && p.x() < 0.8;
        if (over) lowest = std::min(lowest, p.z());
      }
    }
  }
  return lowest;
}

struct Executed {
  explicit Executed(const LoadedProgram& loaded) : run(loaded.robot.model, loaded.robot.arm) {
    EXPECT_TRUE(run.execute(loaded.plan, loaded.control()));
    report = run.report(loaded.plan, run.measured_runs(), 5e-3);
  }
  [[nodiscard]] const ObservedObject* object(const std::string& name) const {
    const auto found = std::ranges::find(report.objects, name, &ObservedObject::name);
    return found == report.objects.end() ? nullptr : &*found;
  }
  MotionRun run;
  Report report;
};

TEST(HeldPart, PlanCarriesItOverTheFenceAndSetsItDown) {
  const LoadedProgram loaded =
      planned({}, lifted() + "  - plan: " + pose_at(0.5, 0.2, 0.2) +
                      "\n  - movel: " + pose_at(0.5, 0.2, 0.06) +
                      "\n  - grip: open\n  - movel: " + pose_at(0.5, 0.2, 0.2) + "\n");
  ASSERT_TRUE(loaded.plan.ok()) << faults_of(loaded);
  EXPECT_GT(lowest_over_fence(loaded.plan), 0.25);
  const Executed done(loaded);
  EXPECT_TRUE(done.report.ok) << done.report.reason << ": " << done.report.detail;
  EXPECT_EQ(done.report.first_contact, "") << "of the hand with what it carries";
  const ObservedObject* part = done.object("part");
  ASSERT_NE(part, nullptr);
  EXPECT_TRUE(part->carried);
  EXPECT_NEAR(part->moved, 0.4, 5e-3);
  EXPECT_LT(part->off_plan, kCarriedPosition);
}

/// The fingers clear the fence at this height, the part does not.
TEST(HeldPart, StraightMovesIntoTheFenceAreRefused) {
  const std::string over =
      "  - movel: " + pose_at(0.5, -0.2, 0.29) + "\n  - movel: " + pose_at(0.5, 0.2, 0.29) + "\n";
  const LoadedProgram held = planned({}, lifted() + over);
  ASSERT_EQ(held.plan.faults.size(), 1U) << faults_of(held);
  EXPECT_EQ(held.plan.faults[0].reason, "collision");
  EXPECT_THAT(held.plan.faults[0].what, HasSubstr("fence"));
  EXPECT_THAT(held.plan.faults[0].what, HasSubstr("part"));
  EXPECT_TRUE(planned({}, "  - movej: " + pose_at(0.5, -0.2, 0.29) + "\n" + over).plan.ok())
      << "without the part";
}

/// A joint move goes where the part clears the fence as well, or is refused.
TEST(HeldPart, JointMovesKnowIt) {
  const std::string moves = lifted() + "  - movel: " + pose_at(0.5, -0.2, 0.29) + "\n  - movej: ";
  const LoadedProgram pose = planned({}, moves + pose_at(0.5, 0.2, 0.29) + "\n");
  if (pose.plan.ok()) {
    EXPECT_GT(lowest_over_fence(pose.plan), 0.25);
  }
  // Where the tool has come on the other side, turned about the base alone.
  const LoadedProgram there = planned({}, moves + pose_at(0.5, -0.2, 0.3) + "\n");
  JointVec q = there.plan.q_end();
  q[0] += 2 * std::atan2(0.2, 0.5);
  std::string joints = "{joints: [";
  for (const double value : q) joints += std::to_string(value) + ", ";
  joints.replace(joints.size() - 2, 2, "]}");
  const LoadedProgram turned =
      planned({}, moves + pose_at(0.5, -0.2, 0.3) + "\n  - movej: " + joints + "\n");
  ASSERT_EQ(turned.plan.faults.size(), 1U) << faults_of(turned);
  EXPECT_THAT(turned.plan.faults[0].what, HasSubstr("fence"));
}

TEST(HeldPart, IsAnObstacleWhereItWasLeftAndNoMoreWhereItWas) {
  const std::string moved =
      lifted() + "  - plan: " + pose_at(0.5, 0.2, 0.2) + "\n  - movel: " + pose_at(0.5, 0.2, 0.06) +
      "\n  - grip: open\n  - movel: " + pose_at(0.5, 0.2, 0.2) + "\n  - grip: close\n";
  const auto into = [&](double y) {
    return planned({}, moved + "  - plan: " + pose_at(0.5, y, 0.2) +
                           "\n  - movel: " + pose_at(0.5, y, 0.05) + "\n");
  };
  const LoadedProgram there = into(0.2);
  ASSERT_EQ(there.plan.faults.size(), 1U) << faults_of(there);
  EXPECT_THAT(there.plan.faults[0].what, HasSubstr("part"));
  const LoadedProgram away = into(-0.2);
  EXPECT_TRUE(away.plan.ok()) << faults_of(away);
}

TEST(HeldPart, PlanBeginsAndEndsWhereThePartStandsOnTheFloor) {
  const LoadedProgram loaded = planned({}, pick_up() + "  - plan: " + pose_at(0.5, 0.2, 0.06) +
                                               "\n  - grip: open\n" + "  - plan: {joints: home}\n");
  ASSERT_TRUE(loaded.plan.ok()) << faults_of(loaded);
  EXPECT_GT(lowest_over_fence(loaded.plan), 0.25);
  const Executed done(loaded);
  EXPECT_TRUE(done.report.ok) << done.report.reason << ": " << done.report.detail;
}

/// Nobody sees friction in a plan: the run does.
TEST(HeldPart, WhatSlipsOutOfTheFingersIsSaid) {
  const LoadedProgram loaded = planned({.friction = 0.001}, lifted());
  ASSERT_TRUE(loaded.plan.ok()) << faults_of(loaded);
  const Executed done(loaded);
  EXPECT_FALSE(done.report.ok);
  EXPECT_EQ(done.report.reason, "object_lost");
  EXPECT_THAT(done.report.detail, HasSubstr("part"));
  const std::string json = to_json(done.report);
  EXPECT_THAT(json, HasSubstr("\"objects\""));
  EXPECT_THAT(json, HasSubstr("\"object_lost\""));
}

/// A plan that never looked at contact: the part is knocked off by the fence.
TEST(HeldPart, WhatHitsTheFenceWithdrawsOk) {
  const LoadedProgram loaded =
      planned_blindly({}, lifted() + "  - movel: " + pose_at(0.5, -0.2, 0.29) +
                              "\n  - movel: " + pose_at(0.5, 0.2, 0.29) + "\n");
  ASSERT_TRUE(loaded.plan.ok());
  const Executed done(loaded);
  EXPECT_FALSE(done.report.ok);
  EXPECT_EQ(done.report.reason, "object_touched");
  const ObservedObject* part = done.object("part");
  ASSERT_NE(part, nullptr);
  EXPECT_EQ(part->touched, "fence");
}

/// Things that nobody meant to touch.
TEST(HeldPart, WhatTheArmPushesAwayWithdrawsOkAndWhatFallsByItselfDoesNot) {
  const std::string things =
      "<body name='can' pos='0.5 -0.1 0.05'><freejoint/><geom name='can' type='cylinder' "
      "size='0.02 0.05' mass='0.1'/></body><body name='apple' pos='-0.6 0 0.3'><freejoint/><geom "
      "name='apple' size='0.02' mass='0.1'/></body>";
  const std::string sweep =
      "  - movej: " + pose_at(0.5, -0.25, 0.2) + "\n  - movel: " + pose_at(0.5, -0.25, 0.12) + "\n";
  const PartAndFence cell{.more = things};
  const LoadedProgram loaded =
      planned_blindly(cell, sweep + "  - movel: " + pose_at(0.5, -0.05, 0.09) + "\n");
  const Executed pushed(loaded);
  EXPECT_FALSE(pushed.report.ok);
  EXPECT_THAT(pushed.report.reason, HasSubstr("object_"));
  const Executed beside(planned(cell, sweep));
  EXPECT_TRUE(beside.report.ok) << beside.report.reason << ": " << beside.report.detail;
  const ObservedObject* apple = beside.object("apple");
  ASSERT_NE(apple, nullptr) << "it fell";
  EXPECT_TRUE(apple->fell && apple->by_itself);
  EXPECT_EQ(beside.object("can"), nullptr);
}

TEST(HeldPart, TheSamePlanEveryTime) {
  const std::string text = pick_up() + "  - plan: " + pose_at(0.5, 0.2, 0.2) + "\n";
  const LoadedProgram a = planned({}, text), b = planned({}, text);
  ASSERT_EQ(a.plan.moves.size(), b.plan.moves.size());
  EXPECT_EQ(a.plan.q_end(), b.plan.q_end());
  EXPECT_EQ(a.plan.duration(), b.plan.duration());
}

}  // namespace
}  // namespace mjarm::program
