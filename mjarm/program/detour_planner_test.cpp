#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm::program {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kBefore = "{pos: [0.3, -0.45, 0.2], euler: [180deg, 0, 0]}";
constexpr const char* kBehind = "{pos: [-0.3, -0.45, 0.2], euler: [180deg, 0, 0]}";

/// The UR5e with a wall between x > 0 and x < 0.
const Robot& walled() {
  static const Robot kRobot = [] {
    Program program;
    program.scene = "universal_robots_ur5e/wall.xml";
    return load_program_robot(program, "").value();
  }();
  return kRobot;
}

ProgramPlan walled_plan(const std::string& instructions, const std::string& head = "") {
  const auto program =
      parse_program("robot: ur5e\n" + head + "program:\n" + instructions, "p.yaml");
  EXPECT_TRUE(program.has_value()) << program.error().what;
  return plan_program(walled().model, walled().arm, *program);
}

std::string told(const ProgramPlan& plan) {
  std::string out;
  for (const ProgramFault& fault : plan.faults) {
    out += std::to_string(fault.place.line) + " " + fault.word + " " + fault.reason + ": " +
           fault.what + "\n";
  }
  return out;
}

std::string plan_to(const std::string& goal) { return "  - plan: " + goal + "\n"; }
/// That, and a stop there.
std::string stop_at(const std::string& goal) { return plan_to(goal) + "  - wait: 0.1\n"; }

Pose tool_at_end(const PlannedMove& move) {
  return fk(walled().arm, as_span(move.trajectory.at(move.trajectory.duration()).q));
}

/// Looks along the motion in steps of at most 0.005 rad.
void expect_free(const PlannedMove& move) {
  ExactChecker checker(walled().model, walled().arm);
  const double duration = move.trajectory.duration();
  const int count = static_cast<int>(duration * 3.2 / 0.005) + 1;
  JointVec before = move.trajectory.at(0).q;
  for (int i = 0; i <= count; ++i) {
    const JointVec q = move.trajectory.at(duration * i / count).q;
    EXPECT_LT((q - before).cwiseAbs().maxCoeff(), 0.005);
    ASSERT_TRUE(checker.is_free(as_span(q))) << describe(checker.check(as_span(q)).value());
    before = q;
  }
  const LimitUse use = check_limits(move.trajectory, walled().arm.limits);
  EXPECT_LE(use.worst(), 1 + 1e-6);
  EXPECT_LE(use.position.maxCoeff(), 1e-9);
}

/// Of many scenes only the last ones are kept, so one may be asked that never planned.
TEST(DetourPlanner, TimesPathsThatAnotherOnePlanned) {
  const Robot& robot = walled();
  const ExactChecker checker(robot.model, robot.arm);
  const IkSolver ik(robot.arm, {.task = task_for(robot.arm)});
  const MoveJudge judge(robot.arm, checker, checker);
  detail::DetourPlanner first(robot, ik, judge), second(robot, ik, judge), third(robot, ik, judge);
  const auto program = parse_program(
      std::string("robot: ur5e\nprogram:\n") + stop_at(kBefore) + plan_to(kBehind), "p.yaml");
  const ProgramPlan plan = plan_program(robot.model, robot.arm, program.value());
  const JointVec from = plan.moves.back().corners.front(), to = plan.moves.back().corners.back();
  const auto motion = first.plan(from, std::span(&to, 1), 1);
  ASSERT_TRUE(motion) << motion.error().what;
  const auto again = second.timed(motion->paths, 1);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->motion.trajectory.duration(), motion->motion.trajectory.duration());
  // To rest there is nothing to be gained, and nothing changes.
  Trajectory kept = motion->motion.trajectory;
  MoveMeasures measures = motion->measures;
  const JointState end = kept.at(kept.duration());
  static_cast<void>(third.lead_into(end, motion->paths, 1, kept, measures));
  EXPECT_LE(kept.duration(), motion->motion.trajectory.duration() + 1e-9);
}

TEST(DetourPlanner, TheStraightWayHitsAndThePlannedOneDoesNot) {
  const ProgramPlan hits =
      walled_plan(std::string("  - movej: ") + kBefore + "\n  - movel: " + kBehind + "\n");
  ASSERT_EQ(hits.faults.size(), 1U) << told(hits);
  EXPECT_THAT(told(hits), AllOf(HasSubstr("4 movel collision"), HasSubstr("wall")));

  ProgramPlan plan = walled_plan(stop_at(kBefore) + plan_to(kBehind));
  ASSERT_TRUE(plan.ok()) << told(plan);
  ASSERT_EQ(plan.moves.size(), 3U);
  plan.moves.erase(plan.moves.begin() + 1);
  for (const PlannedMove& move : plan.moves) {
    EXPECT_EQ(move.word, "plan");
    expect_free(move);
    EXPECT_GT(move.measures->clearance, 0);
    EXPECT_LE(move.measures->max_step, 0.005 + 1e-12);
  }
  EXPECT_LT((tool_at_end(plan.moves[0]).p - Eigen::Vector3d(0.3, -0.45, 0.2)).norm(), 1e-6);
  EXPECT_LT((tool_at_end(plan.moves[1]).p - Eigen::Vector3d(-0.3, -0.45, 0.2)).norm(), 1e-6);
  EXPECT_GE(plan.moves[1].corners.size(), 3U);
  EXPECT_EQ(plan.moves[0].corners.front(), plan.q_start);
  EXPECT_EQ(plan.moves[1].corners.front(), plan.moves[0].corners.back());
}

TEST(DetourPlanner, BlockedMovesTellTheDetour) {
  const std::string before = std::string("  - plan: ") + kBefore + "\n";
  const ProgramPlan line = walled_plan(before + "  - movel: " + kBehind + "\n" + before);
  ASSERT_EQ(line.faults.size(), 1U) << told(line);
  ASSERT_TRUE(line.faults[0].detour.has_value());
  const ProgramPlan done = walled_plan(stop_at(kBefore) + stop_at(kBehind) + before);
  ASSERT_TRUE(done.ok()) << told(done);
  EXPECT_EQ(line.faults[0].detour->edges, done.moves[2].corners.size() - 1);
  EXPECT_EQ(line.faults[0].detour->duration, done.moves[2].trajectory.duration());
  EXPECT_EQ(line.faults[0].detour->clearance, done.moves[2].measures->clearance);
  // It goes on from where the detour ends.
  EXPECT_EQ(line.moves.back().corners, done.moves.back().corners);

  // None where the goal itself is blocked.
  const ProgramPlan inside =
      walled_plan(before + "  - movel: {pos: [0, -0.45, 0.2], euler: [180deg, 0, 0]}\n");
  ASSERT_EQ(inside.faults.size(), 1U) << told(inside);
  EXPECT_FALSE(inside.faults[0].detour.has_value());
}

TEST(DetourPlanner, SamePlanEveryTime) {
  const std::string program = plan_to(kBefore) + plan_to(kBehind);
  const ProgramPlan a = walled_plan(program), b = walled_plan(program);
  ASSERT_TRUE(a.ok()) << told(a);
  ASSERT_EQ(a.moves.size(), b.moves.size());
  for (std::size_t i = 0; i < a.moves.size(); ++i) {
    EXPECT_EQ(a.moves[i].corners, b.moves[i].corners);
    EXPECT_EQ(a.moves[i].trajectory.duration(), b.moves[i].trajectory.duration());
    const double t = 0.37 * a.moves[i].trajectory.duration();
    EXPECT_EQ(a.moves[i].trajectory.at(t).q, b.moves[i].trajectory.at(t).q);
  }
}

TEST(DetourPlanner, JointGoalsRotationsOfAllKindsAndTheSpeedThatIsSet) {
  const ProgramPlan plan =
      walled_plan(stop_at("{pos: [0.3, -0.45, 0.2], quat: [0, 1, 0, 0]}") +
                  stop_at("{pos: [-0.3, -0.45, 0.2], matrix: [1, 0, 0, 0, -1, 0, 0, 0, -1]}") +
                  plan_to("{joints: home}") + "  - set: {joint_speed: 0.25}\n" + stop_at(kBefore) +
                  plan_to(kBefore));
  ASSERT_TRUE(plan.ok()) << told(plan);
  ASSERT_EQ(plan.moves.size(), 8U);
  const PlannedMove& home = plan.moves[4];
  EXPECT_EQ(home.trajectory.at(home.trajectory.duration()).q, walled().arm.home);
  const PlannedMove& slow = plan.moves[5];
  EXPECT_LE(check_limits(slow.trajectory, walled().arm.limits).velocity.maxCoeff(), 0.25 + 1e-9);
  EXPECT_GT(check_limits(slow.trajectory, walled().arm.limits).velocity.maxCoeff(), 0.2);
  for (const std::size_t i : {0, 2, 4, 5}) expect_free(plan.moves[i]);
  EXPECT_EQ(plan.moves[7].trajectory.duration(), 0) << "it is there already";
}

/// [s] how long all joints are slower than 1 % of their limits, ends left out.
double standstill(const PlannedMove& move) {
  constexpr double kStep = 1e-3;
  double out = 0;
  const double duration = move.trajectory.duration();
  for (double t = 0.1; t < duration - 0.1; t += kStep) {
    const JointVec v = move.trajectory.at(t).v.cwiseQuotient(walled().arm.limits.velocity);
    if (v.cwiseAbs().maxCoeff() < 0.01) out += kStep;
  }
  return out;
}

TEST(DetourPlanner, IsOneMotionWithoutStopsThatKeepsItsClearance) {
  const ProgramPlan plan =
      walled_plan(stop_at(kBefore) +
                  "  - plan: {pos: [-0.3, -0.45, 0.2], euler: [180deg, 0, 0], clearance: 10mm}\n");
  ASSERT_TRUE(plan.ok()) << told(plan);
  const PlannedMove& round = plan.moves.back();
  ASSERT_GT(round.corners.size(), 2U);
  EXPECT_EQ(standstill(round), 0);
  expect_free(round);
  EXPECT_GE(round.measures->clearance, 0.01 - 1e-5);
  ASSERT_TRUE(round.stopping.has_value());
  double stopping = 0;
  for (std::size_t i = 1; i < round.corners.size(); ++i) {
    stopping += time_joint_move(as_span(round.corners[i - 1]), as_span(round.corners[i]),
                                walled().arm.limits)
                    ->duration();
  }
  EXPECT_NEAR(*round.stopping, stopping, 1e-9);
  EXPECT_LT(round.trajectory.duration(), 0.75 * stopping);
  const LimitUse use = check_limits(round.trajectory, walled().arm.limits);
  EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-3);
}

TEST(DetourPlanner, OneAfterAnotherPassesTheGoalBetweenThemWithoutAStop) {
  const ProgramPlan plan = walled_plan(plan_to(kBefore) + plan_to(kBehind));
  ASSERT_TRUE(plan.ok()) << told(plan);
  ASSERT_EQ(plan.moves.size(), 1U);
  const PlannedMove& both = plan.moves[0];
  EXPECT_EQ(both.instructions, 2U);
  EXPECT_EQ(both.place.line, 3);
  expect_free(both);
  EXPECT_EQ(standstill(both), 0);
  ASSERT_EQ(both.passed.size(), 1U);
  const JointVec& before = both.corners[both.passed[0]];
  EXPECT_LT((fk(walled().arm, as_span(before)).p - Eigen::Vector3d(0.3, -0.45, 0.2)).norm(), 1e-6);
  double nearest = 1;
  for (double t = 0; t < both.trajectory.duration(); t += 1e-4) {
    nearest = std::min(nearest, (both.trajectory.at(t).q - before).norm());
  }
  EXPECT_LT(nearest, 1e-3) << "to within what it moves in a tenth of a millisecond";
  const ProgramPlan apart = walled_plan(stop_at(kBefore) + plan_to(kBehind));
  ASSERT_TRUE(apart.ok());
  EXPECT_LT(both.trajectory.duration(), apart.duration() - 0.1);
  // What is not a plan, or has another speed, makes it stop.
  for (const char* between : {"  - wait: 0\n", "  - set: {joint_speed: 0.5}\n"}) {
    EXPECT_GT(walled_plan(plan_to(kBefore) + between + plan_to(kBehind)).moves.size(), 1U);
  }
}

/// Down from where the way round ends, at the speed that is asked for.
TEST(DetourPlanner, PassesItsGoalIntoTheStraightMoveAfterIt) {
  const std::string down =
      "  - movel: {pos: [-0.3, -0.45, 0.1], euler: [180deg, 0, 0], speed: 0.1}\n";
  const ProgramPlan rests = walled_plan(stop_at(kBefore) + stop_at(kBehind) + down);
  const ProgramPlan plan = walled_plan(stop_at(kBefore) + plan_to(kBehind) + down);
  ASSERT_TRUE(rests.ok() && plan.ok()) << told(rests) << told(plan);
  ASSERT_EQ(plan.moves.size(), 4U);
  const PlannedMove &way = plan.moves[2], &line = plan.moves[3];
  EXPECT_TRUE(way.passes);
  EXPECT_FALSE(line.passes);
  EXPECT_EQ(way.corners, rests.moves[2].corners);
  expect_free(way);
  EXPECT_GT(way.measures->clearance, 0);
  // It meets the goal exactly, as fast and as fast changing as the line begins.
  const JointState end = way.trajectory.at(way.trajectory.duration());
  const JointState begin = line.trajectory.at(0);
  EXPECT_LT((end.q - way.corners.back()).norm(), 1e-9);
  EXPECT_LT((end.q - begin.q).norm(), 1e-9);
  EXPECT_LT((end.v - begin.v).norm(), 1e-9);
  EXPECT_LT((end.a - begin.a).norm(), 1e-9);
  EXPECT_GT(begin.v.norm(), 0.1);
  EXPECT_NEAR(line.trajectory.duration(), rests.moves[4].trajectory.duration() - 0.1, 0.01);
  EXPECT_LT(way.trajectory.duration(), rests.moves[2].trajectory.duration());
  ASSERT_TRUE(line.curve);
  EXPECT_NEAR(line.curve->length(), 0.1, 1e-12);
  // It stops where something happens there, and where the way after it is blended.
  for (const char* const other :
       {"  - wait: 0.1\n",
        "  - movel: {pos: [-0.3, -0.45, 0.15], euler: [180deg, 0, 0], blend: 10mm}\n"
        "  - movel: {pos: [-0.35, -0.45, 0.15], euler: [180deg, 0, 0]}\n"}) {
    const ProgramPlan stops = walled_plan(stop_at(kBefore) + plan_to(kBehind) + other);
    ASSERT_TRUE(stops.ok()) << told(stops);
    EXPECT_TRUE(std::ranges::none_of(stops.moves, &PlannedMove::passes)) << other;
  }
}

TEST(DetourPlanner, AClearanceThatCannotBeKeptIsAFaultWithWhatCan) {
  const ProgramPlan plan =
      walled_plan(stop_at(kBefore) +
                  "  - plan: {pos: [-0.3, -0.45, 0.2], euler: [180deg, 0, 0], clearance: 0.4}\n");
  EXPECT_THAT(told(plan), AllOf(HasSubstr("5 plan clearance"), HasSubstr("the largest")))
      << told(plan);
  const auto far = parse_program(
      "robot: ur5e\nprogram:\n  - plan: {joints: home, clearance: 600mm}\n", "p.yaml");
  ASSERT_FALSE(far.has_value());
  EXPECT_THAT(far.error().what, AllOf(HasSubstr("p.yaml:3"), HasSubstr("clearance")));
}

TEST(DetourPlanner, EndsWhereTheStraightMovesThatFollowCanBeDone) {
  const ProgramPlan plan =
      walled_plan(plan_to("{pos: [0.35, -0.35, 0.5], euler: [180deg, 0, 0]}") +
                  "  - movel: {pos: [-0.35, -0.35, 0.5], euler: [180deg, 0, 0]}\n");
  EXPECT_TRUE(plan.ok()) << told(plan);
}

TEST(DetourPlanner, AGoalInTheWallIsNamed) {
  const ProgramPlan pose = walled_plan(plan_to("{pos: [0, -0.45, 0.2], euler: [180deg, 0, 0]}"));
  EXPECT_THAT(told(pose), AllOf(HasSubstr("3 plan collision"), HasSubstr("wall"))) << told(pose);
  // By joint values, which do not look at contact.
  const auto inside =
      IkSolver(walled().arm).solve({{0, -0.45, 0.2}, testing::kDown}, testing::kSeed);
  ASSERT_TRUE(inside.has_value());
  std::string list;
  for (const double value : as_span(inside->q)) {
    list += (list.empty() ? "" : ", ") + std::to_string(value);
  }
  const ProgramPlan joints = walled_plan(plan_to("{joints: [" + list + "]}"));
  EXPECT_THAT(told(joints),
              AllOf(HasSubstr("3 plan collision: would end in contact"), HasSubstr("wall")));
  const ProgramPlan start = walled_plan(plan_to("{joints: home}"), "start: [" + list + "]\n");
  EXPECT_THAT(told(start),
              AllOf(HasSubstr("4 plan collision: begins in contact"), HasSubstr("wall")));
}

TEST(DetourPlanner, WhatCannotBeReachedIsToldAndTheRestIsPlanned) {
  const ProgramPlan plan = walled_plan(plan_to("{pos: [2, 0, 0.2], euler: [180deg, 0, 0]}") +
                                       plan_to("{joints: [0, 0, 7, 0, 0, 0]}") +
                                       plan_to("{joints: [0, 0]}") + plan_to(kBefore));
  EXPECT_EQ(plan.faults.size(), 3U) << told(plan);
  EXPECT_THAT(told(plan), AllOf(HasSubstr("3 plan out_of_reach"), HasSubstr("4 plan joint_limit"),
                                HasSubstr("5 plan bad_input")));
  ASSERT_EQ(plan.moves.size(), 1U);
  expect_free(plan.moves[0]);
}

TEST(DetourPlanner, WordsThatAreNoneGetTheNearestOne) {
  const auto misspelt =
      parse_program("robot: ur5e\nprogram:\n  - plan: {joint: [0, 0, 0, 0, 0, 0]}\n", "p.yaml");
  ASSERT_FALSE(misspelt.has_value());
  EXPECT_THAT(misspelt.error().what, AllOf(HasSubstr("p.yaml:3"), HasSubstr("\"joints\"")));
}

}  // namespace
}  // namespace mjarm::program
