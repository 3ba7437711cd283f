#include "mjarm/planning/task_region.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWholeTurn = 2 * kPi * (1 - 1e-12);
constexpr int kHalvings = 40;
constexpr int kDraws = 200;  // of directions, until one does not lean too far

bool is_pose(const Pose& X) {
  return X.p.allFinite() && X.R.allFinite() &&
         (X.R.transpose() * X.R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
         X.R.determinant() > 0;
}

/// The value nearest to 0.
double nearest_to_zero(double min, double max) { return std::max(min, std::min(0.0, max)); }

/// [rad] between z of F and of R.
double lean_of(double roll, double pitch) {
  return std::atan2(std::hypot(std::sin(pitch), std::cos(pitch) * std::sin(roll)),
                    std::cos(pitch) * std::cos(roll));
}

Eigen::Vector2d most_upright(const TaskRegion& region) {
  return {nearest_to_zero(region.turn_min[0], region.turn_max[0]),
          nearest_to_zero(region.turn_min[1], region.turn_max[1])};
}

bool is_sound_turn(double min, double max, double farthest) {
  return min >= -farthest * (1 + 1e-9) && max <= farthest * (1 + 1e-9) && min <= max &&
         max - min <= 2 * kPi * (1 + 1e-9);
}

double middle_value(double min, double max) {
  if (std::isfinite(min) && std::isfinite(max)) return 0.5 * (min + max);
  return nearest_to_zero(min, max);
}

bool is_sound_place(double value) { return std::abs(value) <= kWidestPlace; }

Pose tool_at(const TaskRegion& region, const Eigen::Vector3d& p_RF, const Eigen::Vector3d& rpy) {
  return region.X_WR * Pose{p_RF, from_euler(rpy)} * region.X_FT;
}

/// Roll and pitch: even on the sphere, whose poles are where the pitch is a right angle.
Eigen::Vector2d draw_direction(const TaskRegion& region, Rng& rng) {
  Eigen::Vector2d least = region.turn_min.head<2>(), most = region.turn_max.head<2>();
  if (region.lean < kPi / 2) {  // nothing else leans less
    least = least.cwiseMax(-region.lean);
    most = most.cwiseMin(region.lean);
  }
  for (int k = 0; k < kDraws; ++k) {
    const double roll = rng.uniform(least[0], most[0]);
    const double sine = rng.uniform(std::sin(least[1]), std::sin(most[1]));
    const double pitch = std::asin(std::clamp(sine, -1.0, 1.0));
    if (lean_of(roll, pitch) <= region.lean) return {roll, pitch};
  }
  return most_upright(region);
}

}  // namespace

TaskRegion region_about(const Pose& X_WT, const Eigen::Vector3d& half, double lean, double turn) {
  return {.X_WR = X_WT,
          .place_min = -half,
          .place_max = half,
          .turn_min = {-kFreeTurn, -kFreePitch, -turn},
          .turn_max = {kFreeTurn, kFreePitch, turn},
          .lean = lean};
}

bool is_sound(const Mechanism& mechanism) noexcept {
  const double min = mechanism.min, max = mechanism.max;
  const bool is_range = mechanism.type == JointType::hinge
                            ? is_sound_turn(min, max, 2 * kPi)
                            : is_sound_place(min) && is_sound_place(max) && min <= max;
  return is_range && mechanism.p_W.allFinite() && std::abs(mechanism.axis_W.norm() - 1) < 1e-9;
}

bool is_sound(const TaskRegion& region) noexcept {
  if (region.mechanism && !is_sound(*region.mechanism)) return false;
  if (!is_pose(region.X_WR) || !is_pose(region.X_FT)) return false;
  if (!region.turn_min.allFinite() || !region.turn_max.allFinite()) return false;
  for (int k = 0; k < 3; ++k) {
    const double min = region.place_min[k], max = region.place_max[k];
    const bool low = min == -kFreePlace || is_sound_place(min);
    const bool high = max == kFreePlace || is_sound_place(max);
    if (!low || !high || !(min <= max)) return false;
    const double farthest = k == 1 ? kFreePitch : 2 * kPi;
    if (!is_sound_turn(region.turn_min[k], region.turn_max[k], farthest)) return false;
  }
  const Eigen::Vector2d best = most_upright(region);
  return region.lean >= 0 && region.lean <= kPi && lean_of(best[0], best[1]) <= region.lean + 1e-9;
}

bool can_be_kept(const TaskRegion& region) noexcept {
  const double slack = 1 - 1e-9;
  return is_sound(region) && region.lean >= slack * kLeastTurnRange / 2 &&
         (region.place_max - region.place_min).minCoeff() >= slack * kLeastPlaceRange &&
         (region.turn_max - region.turn_min).minCoeff() >= slack * kLeastTurnRange;
}

TurnBounds turn_bounds(const TaskRegion& region, int axis) noexcept {
  double min = region.turn_min[axis], max = region.turn_max[axis];
  const bool around = axis != 1 && max - min >= kWholeTurn;
  if (around || (axis == 1 && min <= -0.25 * kWholeTurn)) min = -kFreePlace;
  if (around || (axis == 1 && max >= 0.25 * kWholeTurn)) max = kFreePlace;
  return {min, max};
}

double nearest_winding_to(double angle, const TurnBounds& bounds) noexcept {
  const double middle = 0.5 * (bounds.min + bounds.max);
  return middle + std::remainder(angle - middle, 2 * kPi);
}

TaskRegion standing_at(const TaskRegion& region, double value) noexcept {
  TaskRegion out = region;
  if (!region.mechanism) return out;
  out.mechanism.reset();
  const Mechanism& by = *region.mechanism;
  if (by.type == JointType::slide) {
    out.X_WR.p += value * by.axis_W;
    return out;
  }
  const Eigen::Matrix3d turn = rotation_exp(value * by.axis_W);
  out.X_WR = {by.p_W + turn * (region.X_WR.p - by.p_W), turn * region.X_WR.R};
  return out;
}

RegionRoom room_in(const TaskRegion& region, const Pose& X_WT) noexcept {
  if (region.mechanism) return room_in(standing_at(region, value_for(region, X_WT)), X_WT);
  const Pose X_RF = region.X_WR.inverse() * X_WT * region.X_FT.inverse();
  RegionRoom out;
  const Eigen::Vector3d rpy = to_euler(X_RF.R);
  for (int k = 0; k < 3; ++k) {
    out.place =
        std::min({out.place, X_RF.p[k] - region.place_min[k], region.place_max[k] - X_RF.p[k]});
    const TurnBounds bounds = turn_bounds(region, k);
    if (!bounds.any()) continue;
    const double angle = k == 1 ? rpy[k] : nearest_winding_to(rpy[k], bounds);
    out.turn = std::min({out.turn, angle - bounds.min, bounds.max - angle});
  }
  if (region.lean < kPi) {
    const Eigen::Vector3d z = X_RF.R.col(2);
    out.turn = std::min(out.turn, region.lean - std::atan2(std::hypot(z[0], z[1]), z[2]));
  }
  return out;
}

Pose nearest_in(const TaskRegion& region, const Pose& X_WT) {
  if (region.mechanism) return nearest_in(standing_at(region, value_for(region, X_WT)), X_WT);
  const Pose X_RF = region.X_WR.inverse() * X_WT * region.X_FT.inverse();
  const Eigen::Vector3d p = X_RF.p.cwiseMax(region.place_min).cwiseMin(region.place_max);
  Eigen::Vector3d rpy = to_euler(X_RF.R);
  for (int k = 0; k < 3; ++k) {
    const TurnBounds bounds = turn_bounds(region, k);
    if (!bounds.any()) continue;
    const double angle = k == 1 ? rpy[k] : nearest_winding_to(rpy[k], bounds);
    rpy[k] = std::clamp(angle, bounds.min, bounds.max);
  }
  const Eigen::Vector2d given = rpy.head<2>(), best = most_upright(region);
  double good = 0, bad = 1;  // shares of the way there: the lean grows along it
  if (lean_of(given[0], given[1]) <= region.lean) good = 1;
  for (int k = 0; k < kHalvings && good < 1; ++k) {
    const double share = 0.5 * (good + bad);
    const Eigen::Vector2d there = best + share * (given - best);
    (lean_of(there[0], there[1]) <= region.lean ? good : bad) = share;
  }
  rpy.head<2>() = best + good * (given - best);
  return tool_at(region, p, rpy);
}

Pose middle_of(const TaskRegion& region) {
  if (const auto& by = region.mechanism) {
    return middle_of(standing_at(region, 0.5 * (by->min + by->max)));
  }
  Eigen::Vector3d p, rpy;
  for (int k = 0; k < 3; ++k) {
    p[k] = middle_value(region.place_min[k], region.place_max[k]);
    const double min = region.turn_min[k], max = region.turn_max[k];
    rpy[k] = turn_bounds(region, k).any() ? 0.5 * (min + max) : nearest_to_zero(min, max);
  }
  if (lean_of(rpy[0], rpy[1]) > region.lean) rpy.head<2>() = most_upright(region);
  return tool_at(region, p, rpy);
}

Pose draw_from(const TaskRegion& region, const Eigen::Vector3d& base, double radius, Rng& rng) {
  if (const auto& by = region.mechanism) {
    return draw_from(standing_at(region, rng.uniform(by->min, by->max)), base, radius, rng);
  }
  const Eigen::Vector3d p_RB = region.X_WR.inverse() * base;
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) {
    double min = region.place_min[k], max = region.place_max[k];
    // What is free ends where nothing can be reached any more; never on the wrong side.
    if (!std::isfinite(min)) min = std::min(p_RB[k] - radius, max);
    if (!std::isfinite(max)) max = std::max(p_RB[k] + radius, min);
    p[k] = rng.uniform(min, max);
  }
  const Eigen::Vector2d direction = draw_direction(region, rng);
  const double yaw = rng.uniform(region.turn_min[2], region.turn_max[2]);
  return tool_at(region, p, {direction[0], direction[1], yaw});
}

}  // namespace mjarm
