#include "mjarm/program/pick_place.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "mjarm/execution/execution.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/sim/sim.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;

constexpr const char* kUr5e = "universal_robots_ur5e/ur5e_gripper.xml";
constexpr const char* kPanda = "franka_emika_panda/panda.xml";
constexpr const char* kBox = "<geom type='box' size='0.02 0.025 0.03' mass='0.1'/>";

/// A robot before a table 0.2 m high, with a body of those geoms on it.
Robot at_table(const support::TempFolder& folder, const std::string& robot,
               const std::string& geoms, const std::string& more = "") {
  const auto scene = folder.write(
      "scene.xml", "<mujoco><include file='" + robot +
                       "'/><worldbody><geom name='table' type='box' size='0.3 0.45 0.1' "
                       "pos='0.6 0 0.1'/><body name='thing' pos='0.5 0.1 0.23'><freejoint/>" +
                       geoms + "</body>" + more + "</worldbody></mujoco>");
  auto loaded = load_robot(scene.string());
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().what);
  return *loaded;
}

PickTask to(const Eigen::Vector3d& p_WB) {
  return {.object = "thing", .place = PlaceGoal{.X_WB = {.p = p_WB}, .any_turn = true}};
}

Result<PickPlan, PickFailure> plan(const Robot& robot, const PickTask& task) {
  return plan_pick(robot, {}, as_span(robot.arm.home), task);
}

/// Where the thing is after the plan was executed in physics [m].
Eigen::Vector3d executed(const Robot& robot, const MotionPlan& plan) {
  Sim sim(robot.model);
  sim.reset_home();
  sim.place(robot.arm, as_span(plan.q_start));
  Execution execution = Execution::create(robot.model, plan).value();
  const auto outcome = execution.run_to_end(sim);
  EXPECT_TRUE(outcome) << (outcome ? "" : outcome.error().what);
  return frame_pose(robot.model, "thing", sim.qpos())->p;
}

TEST(PlanPick, WhatItPlansPhysicsDo) {
  for (const char* name : {kUr5e, kPanda}) {
    SCOPED_TRACE(name);
    const support::TempFolder folder;
    const Robot robot = at_table(folder, name, kBox);
    const Eigen::Vector3d goal(0.5, -0.2, 0.23);
    const auto picked = plan(robot, to(goal));
    ASSERT_TRUE(picked) << picked.error().what;
    ASSERT_EQ(picked->plan.moves.size(), 8u);
    EXPECT_LT((frame_pose(robot.model, "thing", picked->plan.scene_end.qpos)->p - goal).norm(),
              2e-3);
    EXPECT_LT((executed(robot, picked->plan) - goal).norm(), 5e-3);
  }
}

/// No hidden weld can pass that: with pads of ice it stays on the table.
TEST(PlanPick, NothingHoldsButFriction) {
  const support::TempFolder folder;
  const Robot robot = at_table(
      folder, kUr5e,
      "<geom type='box' size='0.02 0.025 0.03' mass='0.1' friction='0 0 0' priority='2'/>");
  const auto picked = plan(robot, to({0.5, -0.2, 0.23}));
  ASSERT_TRUE(picked) << picked.error().what;
  EXPECT_GT(executed(robot, picked->plan).y(), 0);
}

TEST(PlanPick, InTwoPartsItIsTheSame) {
  const support::TempFolder folder;
  const Robot robot = at_table(folder, kPanda, kBox);
  const auto lifted = plan(robot, {.object = "thing"});
  ASSERT_TRUE(lifted) << lifted.error().what;
  EXPECT_FALSE(lifted->X_WB_place);
  ASSERT_EQ(lifted->plan.scene_end.attached.size(), 1u);
  const PlaceGoal goal{.X_WB = {.p = {0.5, -0.2, 0.23}}, .any_turn = true};
  const auto put = plan_place(robot, lifted->plan.scene_end, as_span(lifted->plan.q_end()), goal);
  ASSERT_TRUE(put) << put.error().what;
  EXPECT_TRUE(put->plan.scene_end.attached.empty());
  EXPECT_LT((put->X_WB_place->p - goal.X_WB.p).norm(), 1e-12);
}

TEST(PlanPick, TellsWhyItCannot) {
  const support::TempFolder folder;
  const Robot robot = at_table(folder, kUr5e, kBox);
  const auto refused = [](const Robot& asked, const PickTask& task) {
    const auto picked = plan(asked, task);
    EXPECT_FALSE(picked);
    return picked ? PickFailure{} : picked.error();
  };
  const PickFailure unknown = refused(robot, {.object = "thingy"});
  EXPECT_EQ(unknown.code, PickErrc::no_object);
  EXPECT_THAT(unknown.what, HasSubstr("there are: thing"));

  EXPECT_EQ(refused(robot, to({0.5, -1.5, 0.23})).code, PickErrc::place_out_of_reach);
  EXPECT_EQ(refused(robot, to({0.5, -0.2, 0.15})).code, PickErrc::place_blocked);

  const Robot wide = at_table(folder, kUr5e, "<geom type='box' size='0.05 0.05 0.05' mass='0.1'/>");
  const PickFailure too_wide = refused(wide, to({0.5, -0.2, 0.25}));
  EXPECT_EQ(too_wide.code, PickErrc::too_wide);
  EXPECT_THAT(too_wide.what, HasSubstr("100.0 mm wide at its narrowest, the gripper opens 85.0"));

  const Robot walled = at_table(folder, kUr5e, kBox,
                                "<geom type='box' size='0.1 0.1 0.01' pos='0.5 0.1 0.28'/>"
                                "<geom type='box' size='0.1 0.01 0.05' pos='0.5 0.14 0.25'/>"
                                "<geom type='box' size='0.1 0.01 0.05' pos='0.5 0.06 0.25'/>"
                                "<geom type='box' size='0.01 0.1 0.05' pos='0.535 0.1 0.25'/>"
                                "<geom type='box' size='0.01 0.1 0.05' pos='0.465 0.1 0.25'/>");
  const PickFailure blocked = refused(walled, to({0.5, -0.2, 0.23}));
  EXPECT_EQ(blocked.code, PickErrc::grasp_blocked) << blocked.what;
  EXPECT_FALSE(blocked.dropped.empty());
}

TEST(PlanPick, FingersThatCloseMeetNothingElse) {
  const support::TempFolder folder;
  const auto plate = [](const char* name, double x) {
    return "<body name='" + std::string(name) + "' pos='" + std::to_string(x) +
           " 0.1 0.23'><freejoint/><geom type='box' size='0.002 0.06 0.03' mass='0.1'/></body>";
  };
  // Between the open fingers and the box.
  const Robot robot = at_table(folder, kUr5e, "<geom type='box' size='0.02 0.06 0.03' mass='0.1'/>",
                               plate("plate", 0.47) + plate("other", 0.53));
  const auto picked = plan(robot, to({0.5, -0.2, 0.23}));
  ASSERT_FALSE(picked);
  EXPECT_EQ(picked.error().code, PickErrc::grasp_blocked) << picked.error().what;
  EXPECT_TRUE(std::ranges::any_of(picked.error().dropped, [](const DroppedGrasp& one) {
    return one.what.find("would push") != std::string::npos;
  }));
}

/// Between two walls the fingers that hold it fit either way, but along one alone may they open.
TEST(PlanPick, PutsItDownWhereTheFingersMayOpen) {
  const support::TempFolder folder;
  const Robot robot =
      at_table(folder, kUr5e, kBox,
               "<geom name='left_wall' type='box' size='0.1 0.005 0.03' pos='0.5 -0.135 0.23'/>"
               "<geom name='right_wall' type='box' size='0.1 0.005 0.03' pos='0.5 -0.265 0.23'/>");
  const PlaceGoal goal{.X_WB = {.p = {0.5, -0.2, 0.23}}};
  const auto picked = plan(robot, {.object = "thing", .place = goal});
  ASSERT_TRUE(picked) << picked.error().what;
  std::size_t blocked = 0;
  for (const DroppedGrasp& one : picked->dropped) {
    EXPECT_NE(one.code, PickErrc::no_way) << one.what;
    if (one.code != PickErrc::place_blocked) continue;
    ++blocked;
    EXPECT_THAT(one.what, HasSubstr("_wall"));
  }
  EXPECT_GT(blocked, 0u);
}

/// The faults of a program before the shipped table.
std::vector<ProgramFault> faults_of(const std::string& instructions) {
  const support::TempFolder folder;
  const auto file =
      folder.write("one.yaml", "scene: universal_robots_ur5e/pick.xml\nprogram:\n" + instructions);
  auto loaded = load_program(file.string());
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().what);
  return loaded ? std::move(loaded->plan.faults) : std::vector<ProgramFault>();
}

TEST(PickInstruction, FaultsNameTheirPlaceAndWhatIsKnown) {
  const auto unknown = faults_of("  - pick: cann\n  - place: {pos: [0.5, -0.26, 0.256]}\n");
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_EQ(unknown[0].place.line, 3);
  EXPECT_EQ(unknown[0].reason, "no_object");
  EXPECT_THAT(unknown[0].what, HasSubstr("there are: box, can, house (did you mean \"can\"?)"));
  const auto empty = faults_of("  - place: {pos: [0.5, -0.26, 0.256]}\n");
  ASSERT_EQ(empty.size(), 1u);
  EXPECT_EQ(empty[0].reason, "hand_full");
  EXPECT_EQ(empty[0].what, "the fingers hold nothing");
}

TEST(PickInstruction, GoesOnFromWhereThingsWerePut) {
  EXPECT_TRUE(faults_of("  - pick: {object: can}\n  - plan: {joints: home}\n"
                        "  - place: {pos: [0.5, -0.3, 0.256]}\n  - pick: box\n"
                        "  - place: {pos: [0.52, 0.2, 0.23], euler: [0, 0, 0]}\n")
                  .empty());
  const auto taken = faults_of(
      "  - pick: can\n  - place: {pos: [0.5, -0.3, 0.256]}\n"
      "  - pick: box\n  - place: {pos: [0.5, -0.3, 0.236]}\n");
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].reason, "place_blocked") << taken[0].what;
  EXPECT_EQ(taken[0].place.line, 5);
}

}  // namespace
}  // namespace mjarm::program
