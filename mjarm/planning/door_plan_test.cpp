// Doors whose hands turn in their handles: paths where a hand that holds fast cannot follow.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/verify_path.hpp"

namespace mjarm {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

/// A door on an upright hinge, and a level hand in its handle that may turn about the upright by
/// `turn` to both sides.
struct Door {
  Robot robot;
  Eigen::Vector3d hinge, handle;  // [m] at rest
  double heading;                 // [rad] of the hand about the upright
  double most;                    // [rad] that the door opens

  [[nodiscard]] TaskRegion region(double turn) const {
    TaskRegion out{.X_WR = {handle, from_euler({0, 0, heading})}};
    out.X_FT.R = from_euler({std::numbers::pi / 2, 0, 0});
    out.place_min.setConstant(-0.01);
    out.place_max.setConstant(0.01);
    out.turn_max = {3 * kDegrees, 3 * kDegrees, turn};
    out.turn_min = -out.turn_max;
    out.mechanism = Mechanism{.p_W = hinge, .min = std::min(most, 0.0), .max = std::max(most, 0.0)};
    return out;
  }
  /// The same, the door at one angle and the hand in the middle of the handle.
  [[nodiscard]] TaskRegion at(double angle, double turn) const {
    TaskRegion out = region(turn);
    out.place_min.setZero();
    out.place_max.setZero();
    out.turn_min.head<2>().setZero();
    out.turn_max.head<2>().setZero();
    out.mechanism->min = out.mechanism->max = angle;
    return out;
  }
};

Eigen::Isometry3d tool_of(const Arm& arm, const JointVec& q) {
  const auto isometry = [](const Pose& X) {
    Eigen::Isometry3d out;
    out.linear() = X.R;
    out.translation() = X.p;
    out.makeAffine();
    return out;
  };
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  for (int k = 0; k < arm.dof(); ++k) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(k)];
    out = out * isometry(joint.X_PJ) * Eigen::AngleAxisd(q[k], joint.axis);
  }
  return out * isometry(arm.X_JT);
}

/// [m and rad] by how much the hand is within the handle while the door stands at `angle`.
double room_of_hand(const Door& door, double turn, double angle, const Eigen::Isometry3d& tool) {
  const Eigen::Matrix3d swing = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::Matrix3d R =
      swing * Eigen::AngleAxisd(door.heading, Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::Vector3d handle = door.hinge + swing * (door.handle - door.hinge);
  const Eigen::Vector3d p = R.transpose() * (tool.translation() - handle);
  const Eigen::Matrix3d F =
      R.transpose() * tool.linear() *
      Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()).matrix();
  const double roll = std::atan2(F(2, 1), F(2, 2)), pitch = -std::asin(F(2, 0)),
               yaw = std::atan2(F(1, 0), F(0, 0));
  return std::min({0.01 - p.cwiseAbs().maxCoeff(), 3 * kDegrees - std::abs(roll),
                   3 * kDegrees - std::abs(pitch), turn - std::abs(yaw)});
}

/// Looks every 0.01 rad where the door may stand: everywhere somewhere, from start to end, and
/// nowhere far from where it stood before.
void expect_door_follows(const Door& door, double turn, const PlannedPath& path) {
  const double least = std::min(door.most, 0.0), most = std::max(door.most, 0.0);
  double before = 0, hand = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const JointVec way = path.q[i] - path.q[i - 1];
    const int samples = std::max(2, static_cast<int>(way.norm() / 0.01));
    for (int k = 0; k <= samples; ++k) {
      const Eigen::Isometry3d tool = tool_of(door.robot.arm, path.q[i - 1] + way * k / samples);
      std::array<double, 2> best{-9, 0};
      for (int n = 0; n <= 2000; ++n) {
        const double angle = std::clamp(before + (n - 1000) * 1e-4, least, most);
        const double room = room_of_hand(door, turn, angle, tool);
        if (room > best[0]) best = {room, angle};
      }
      EXPECT_GT(best[0], -1e-4) << "edge " << i << " at " << k;
      EXPECT_LT(std::abs(best[1] - before), 0.09);
      before = best[1];
      hand = std::max(hand, std::abs(room_of_hand(door, 0, before, tool)));
    }
  }
  EXPECT_NEAR(before, door.most, 0.03);
  EXPECT_GT(hand, 10 * kDegrees) << "the hand turns in the handle";
}

/// Opens it with the hand turning, which is proved, verified and looked at, and not with the hand
/// fast.
void open_door(const Door& door) {
  PlanningWorld world = PlanningWorld::create(door.robot).value();
  const double turn = 50 * kDegrees, fast = 3 * kDegrees;
  const PathEnd start{.regions = {door.at(0, fast)}}, end{.regions = {door.at(door.most, turn)}};
  const PlanOptions options{.time_limit = 0, .within = door.region(turn)};
  const auto path = world.plan(start, end, options);
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_TRUE(path->room.within(1e-9));
  expect_door_follows(door, turn, *path);
  GivenPath given;
  for (const JointVec& q : path->q) given.rows.emplace_back(q.begin(), q.end());
  given.within = GivenRegion{door.region(turn), path->room};
  const auto faults = [&] { return verify_path(door.robot, {}, given, {}).value().faults; };
  EXPECT_TRUE(faults().empty());
  // A door that stops sooner, or has its hinge elsewhere, is another one.
  given.within->region.mechanism->p_W[0] += 0.15;
  ASSERT_EQ(faults().size(), 1u);
  EXPECT_STREQ(faults().front().kind, "region");
  given.within->region = door.region(turn);
  given.within->region.mechanism->min /= 2;
  EXPECT_EQ(faults().size(), 1u);
  given.within->region = door.region(turn);
  given.within->room.place = 0.0101;  // more than there is anywhere
  EXPECT_EQ(faults().size(), 1u);

  const auto again = world.plan(start, end, options);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->q, path->q);
  // Held fast, the door opens half of the way at most.
  const PlanOptions held{.time_limit = 0, .within = door.region(fast)};
  EXPECT_FALSE(world.plan(start, {.regions = {door.at(door.most, fast)}}, held));
  EXPECT_TRUE(world.plan(start, {.regions = {door.at(door.most / 2, fast)}}, held));
}

TEST(DoorPlan, TheHandOfAUr5eTurnsInTheHandle) {
  open_door({.robot = load_robot("universal_robots_ur5e/wall.xml").value(),
             .hinge = {0.4, -0.95, 0.3},
             .handle = {0.1, -0.72, 0.3},
             .heading = 0,
             .most = -76 * kDegrees});
}

TEST(DoorPlan, TheHandOfAPandaTurnsInTheHandle) {
  open_door({.robot = load_robot("panda").value(),
             .hinge = {0.9, 0.35, 0.4},
             .handle = {0.65, 0.1, 0.4},
             .heading = 90 * kDegrees,
             .most = -70 * kDegrees});
}

}  // namespace
}  // namespace mjarm
