#include "mjarm/planning/task_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

Pose random_pose(Rng& rng) {
  const Eigen::Vector3d w(rng.normal(), rng.normal(), rng.normal());
  return {Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()), rotation_exp(w)};
}

/// Bounds of every kind: none, one-sided, narrow, wide, none at all.
TaskRegion random_region(Rng& rng) {
  TaskRegion out{.X_WR = random_pose(rng), .X_FT = random_pose(rng)};
  for (int k = 0; k < 3; ++k) {
    const double low = rng.uniform(-0.5, 0.2), farthest = k == 1 ? kFreePitch : kFreeTurn;
    out.place_min[k] = rng.uniform() < 0.3 ? -kFreePlace : low;
    out.place_max[k] = rng.uniform() < 0.3 ? kFreePlace : low + rng.uniform(0, 0.5);
    const double least = rng.uniform(-farthest, 0.9 * farthest);
    const bool is_free = rng.uniform() < 0.3;
    out.turn_min[k] = is_free ? -farthest : least;
    out.turn_max[k] = is_free ? farthest : rng.uniform(least, farthest);
  }
  if (rng.uniform() < 0.5) out.lean = rng.uniform(0.1, std::numbers::pi);
  return out;
}

TEST(TaskRegion, WhatIsDrawnIsWithinAndFillsTheRegion) {
  Rng rng(3);
  int sound = 0;
  for (int k = 0; k < 300; ++k) {
    const TaskRegion region = random_region(rng);
    if (!is_sound(region)) continue;  // no direction leans so little
    ++sound;
    EXPECT_TRUE(room_in(region, middle_of(region)).within(1e-9));
    double nearest = 1;
    for (int i = 0; i < 30; ++i) {
      const RegionRoom room = room_in(region, draw_from(region, {0, 0, 0}, 1, rng));
      EXPECT_TRUE(room.within(1e-9)) << room.place << " " << room.turn;
      nearest = std::min({nearest, room.place, room.turn});
    }
    EXPECT_LT(nearest, 0.35);
    // What is outside has a place inside, what is inside stays.
    const Pose anywhere = random_pose(rng), inside = draw_from(region, {0, 0, 0}, 1, rng);
    EXPECT_TRUE(room_in(region, nearest_in(region, anywhere)).within(1e-9));
    EXPECT_LT(angle_between(nearest_in(region, inside).R, inside.R), 1e-7);
    EXPECT_LT((nearest_in(region, inside).p - inside.p).norm(), 1e-9);
  }
  EXPECT_GT(sound, 200);
}

TEST(TaskRegion, RoomIsWhatThePoseMayStillMove) {
  TaskRegion region = region_about({{1, 2, 3}, from_euler({0, 0, std::numbers::pi / 2})},
                                   {0.1, 0.2, 0.3}, 0.4, 0.5);
  const auto moved = [&](const Pose& by) { return room_in(region, region.X_WR * by); };
  EXPECT_NEAR(moved({}).place, 0.1, 1e-12);
  EXPECT_NEAR(moved({}).turn, 0.4, 1e-12);
  EXPECT_NEAR(moved({{0, 0.25, 0}, from_euler({0, 0, 0})}).place, -0.05, 1e-12);
  EXPECT_NEAR(moved({{0, 0, 0}, from_euler({0.3, 0, 0})}).turn, 0.1, 1e-12);
  EXPECT_NEAR(moved({{0, 0, 0}, from_euler({0, -0.6, 0})}).turn, -0.2, 1e-12);
  EXPECT_NEAR(moved({{0, 0, 0}, from_euler({0, 0, 0.6})}).turn, -0.1, 1e-12);
  // A turn of the object carries the tool round it, however it is grasped.
  region.X_FT = {{0, -0.2, 0.1}, from_euler({0.3, 0.2, 0.1})};
  const Pose turned{{0, 0, 0}, from_euler({0, 0, 0.2})};
  EXPECT_NEAR(room_in(region, region.X_WR * turned * region.X_FT).place, 0.1, 1e-12);
  EXPECT_NEAR(room_in(region, region.X_WR * turned * region.X_FT).turn, 0.3, 1e-12);
  // A yaw from 170 to 190 degrees, met from both sides.
  region.turn_min[2] = 170 * std::numbers::pi / 180;
  region.turn_max[2] = 190 * std::numbers::pi / 180;
  for (const double yaw : {178.0, -178.0}) {
    const Pose X_RF{{0, 0, 0}, from_euler({0, 0, yaw * std::numbers::pi / 180})};
    EXPECT_NEAR(room_in(region, region.X_WR * X_RF * region.X_FT).turn, 8 * std::numbers::pi / 180,
                1e-12);
  }
  const RegionRoom all = room_in(
      region_about({}, Eigen::Vector3d::Constant(kFreePlace), std::numbers::pi, std::numbers::pi),
      {});
  EXPECT_EQ(all.place, kFreePlace);
  EXPECT_EQ(all.turn, std::numeric_limits<double>::infinity());
}

TEST(TaskRegion, RefusesBoundsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = [](const auto& change) {
    TaskRegion region = region_about({}, {0.1, 0.1, 0.1}, 0.2, 0.3);
    change(region);
    return !is_sound(region);
  };
  EXPECT_FALSE(broken([](TaskRegion&) {}));
  EXPECT_TRUE(broken([&](TaskRegion& r) { r.place_min[1] = nan; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.place_min[1] = 0.2; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.place_max[2] = 11; }));
  EXPECT_TRUE(broken([&](TaskRegion& r) { r.turn_max[0] = nan; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.turn_max[1] = 1.6; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.turn_min[2] = -6.3; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.lean = 3.2; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.X_FT.R *= 2; }));
  EXPECT_TRUE(broken([&](TaskRegion& r) { r.X_WR.p[0] = nan; }));
  EXPECT_TRUE(broken([](TaskRegion& r) { r.turn_min[0] = 0.3; })) << "all lean by more than 0.2";
  // For a path nothing may be too narrow.
  TaskRegion path = region_about({}, {0.1, 0.1, 0.1}, 0.2, 0.3);
  EXPECT_TRUE(can_be_kept(path));
  path.place_max[0] = path.place_min[0] + 0.5e-3;
  EXPECT_FALSE(can_be_kept(path));
  EXPECT_FALSE(can_be_kept(region_about({}, {0.1, 0.1, 0.1}, 0.2, 0)));
}

}  // namespace
}  // namespace mjarm
