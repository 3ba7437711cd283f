#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/sim/sim.hpp"

// The instruction `look`: where the objects are says whoever looks, not the model.
namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Robot& pick_robot() {
  static const Robot kRobot = load_robot("universal_robots_ur5e/pick.xml").value();
  return kRobot;
}

ProgramPlan planned_seeing(const std::string& instructions, const SeeScene& see) {
  const auto program = parse_program(
      "scene: universal_robots_ur5e/pick.xml\nprogram:\n" + instructions, "look.yaml");
  EXPECT_TRUE(program) << program.error().what;
  return plan_program(pick_robot().model, pick_robot().arm, *program, {.see = see});
}

/// Sees the box so far from where the model has it.
SeeScene eye(const Eigen::Vector3d& off, std::string* asked = nullptr) {
  return [off, asked](const Robot& of, const std::string& camera, const SceneState&,
                      std::span<const double> q) -> Result<SeenScene> {
    EXPECT_EQ(static_cast<int>(q.size()), of.arm.dof());
    if (asked != nullptr) *asked = camera;
    Sim sim(of.model);
    sim.reset_home();
    Pose X_WB = frame_pose(of.model, "box", sim.qpos()).value();
    X_WB.p += off;
    sim.place_free("box", X_WB);
    return SeenScene{.scene = {.qpos = {sim.qpos().begin(), sim.qpos().end()}}};
  };
}

/// Where the tool is when the gripper first closes.
Eigen::Vector3d grasp_of(const ProgramPlan& plan) {
  for (const PlannedMove& move : plan.moves) {
    if (move.close.value_or(false)) {
      return fk(plan.arms.front(), as_span(move.trajectory.at(0).q)).p;
    }
  }
  return {};
}

TEST(Look, ThingsArePickedUpWhereTheyAreSeen) {
  std::string asked;
  const Eigen::Vector3d off(0.02, 0.03, 0);
  const ProgramPlan there =
      planned_seeing("  - look: rgbd\n  - pick: box\n", eye({0, 0, 0}, &asked));
  const ProgramPlan seen = planned_seeing("  - look: {camera: rgbd}\n  - pick: box\n", eye(off));
  ASSERT_THAT(there.faults, IsEmpty());
  ASSERT_THAT(seen.faults, IsEmpty());
  EXPECT_EQ(asked, "rgbd");
  EXPECT_LT((grasp_of(seen) - grasp_of(there) - off).head<2>().norm(), 0.02);
  EXPECT_GT((grasp_of(seen) - grasp_of(there)).norm(), 0.02);
}

TEST(Look, WhatIsNotSeenIsNotPickedUp) {
  const SeeScene see = [](const Robot&, const std::string&, const SceneState& scene,
                          std::span<const double>) -> Result<SeenScene> {
    return SeenScene{.scene = scene, .unseen = {{"box", "it is hidden"}}};
  };
  const ProgramPlan plan =
      planned_seeing("  - look: rgbd\n  - pick: box\n  - place: {pos: [0.5, -0.3, 0.236]}\n", see);
  ASSERT_EQ(plan.faults.size(), 1u);
  EXPECT_EQ(plan.faults.front().reason, "not_seen");
  EXPECT_EQ(plan.faults.front().place.line, 4);
  EXPECT_THAT(plan.faults.front().what, HasSubstr("it is hidden"));
}

TEST(Look, APlaceMayBeTakenAsTheSymmetryOfTheThingHasIt) {
  const Pose flipped{.R = Eigen::Vector3d(1, -1, -1).asDiagonal()};  // it is seen upside down
  const auto see = [&](bool same) -> SeeScene {
    return [=](const Robot& of, const std::string&, const SceneState&,
               std::span<const double>) -> Result<SeenScene> {
      Sim sim(of.model);
      sim.reset_home();
      sim.place_free("box", frame_pose(of.model, "box", sim.qpos()).value() * flipped);
      SeenScene out{.scene = {.qpos = {sim.qpos().begin(), sim.qpos().end()}}};
      if (same) out.same["box"] = {Pose{}, flipped};
      return out;
    };
  };
  const std::string text =
      "  - look: rgbd\n  - pick: box\n  - place: {pos: [0.5, -0.3, 0.236], euler: [0, 0, 0]}\n";
  EXPECT_THAT(planned_seeing(text, see(true)).faults, IsEmpty());
  // To turn it over it would have to be held from below.
  EXPECT_EQ(planned_seeing(text, see(false)).faults.size(), 1u);
}

TEST(Look, StandsBeforeAllThatMoves) {
  const ProgramPlan plan =
      planned_seeing("  - movej: {joints: home}\n  - look: rgbd\n", eye({0, 0, 0}));
  ASSERT_EQ(plan.faults.size(), 1u);
  EXPECT_EQ(plan.faults.front().place.line, 4);
  EXPECT_THAT(plan.faults.front().what, HasSubstr("before all that moves"));
}

TEST(Look, NeedsSomebodyWhoLooks) {
  const ProgramPlan plan = planned_seeing("  - look: rgbd\n", {});
  ASSERT_EQ(plan.faults.size(), 1u);
  EXPECT_EQ(plan.faults.front().reason, "not_available");
}

TEST(Look, TellsWhatTheEyeSays) {
  const SeeScene see = [](const Robot&, const std::string& camera, const SceneState&,
                          std::span<const double>) -> Result<SeenScene> {
    return fail(Errc::bad_input, "no camera " + camera);
  };
  const ProgramPlan plan = planned_seeing("  - look: rgb\n", see);
  ASSERT_EQ(plan.faults.size(), 1u);
  EXPECT_EQ(plan.faults.front().reason, "unknown_name");
  EXPECT_EQ(plan.faults.front().code, Errc::bad_input);
  EXPECT_THAT(plan.faults.front().what, HasSubstr("no camera rgb"));
}

}  // namespace
}  // namespace mjarm::program
