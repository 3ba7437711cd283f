#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/region_proof_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kMaxStepTurn = 0.5;   // [rad] at once
constexpr double kMaxStepPlace = 0.2;  // [m]
constexpr double kInside = 0.7;  // share of the way from a bound to the middle that is aimed at,
constexpr double kInsideTurn = 0.1;    // [rad] at most,
constexpr double kInsidePlace = 0.02;  // [m]
constexpr double kOneAxis = 1e-12;     // |a x b| of axes that are one
constexpr double kLeastCosine = 1e-3;  // of the pitch, in rates of roll and yaw
constexpr double kLeastRange = 0.02;   // [rad or m, L2] of a step
constexpr double kHalfTurn = std::numbers::pi;
constexpr double kFreeHinge = 2 * kHalfTurn * (1 - 1e-12);  // [rad] of its range: it has no ends

/// By how much a value between two bounds has to grow to be some way inside; 0: it is.
double need_of(double value, double min, double max, double inside) {
  const double half = 0.5 * (max - min);
  const double margin = std::min(kInside * half, inside);
  const double deeper = margin + 0.5 * std::min(half - margin, margin);
  if (value < min + margin) return min + deeper - value;
  if (value > max - margin) return max - deeper - value;
  return 0;
}

/// What is left of min <= angle <= max along a straight line between two vectors (c, s) that point
/// towards the angle, and may each be shorter than 1: a lower bound, [rad].
double room_in_wedge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const TurnBounds& bounds,
                     double bulge) {
  const Eigen::Vector2d left_of_min(-std::sin(bounds.min), std::cos(bounds.min));
  const Eigen::Vector2d right_of_max(std::sin(bounds.max), -std::cos(bounds.max));
  const double above = std::min(left_of_min.dot(a), left_of_min.dot(b)) - bulge;
  const double below = std::min(right_of_max.dot(a), right_of_max.dot(b)) - bulge;
  return bounds.max - bounds.min > kHalfTurn ? std::max(above, below) : std::min(above, below);
}

/// [rad or m, L2] the chord over which as much bulges as there is room for.
double range_for(double half, double curvature) {
  return std::isfinite(half) ? std::sqrt(8 * half / std::max(curvature, 1e-6)) : kKeptRange;
}

}  // namespace

RegionProof::RegionProof(const TaskRegion& region, const Arm& arm)
    : region_(region),
      X_RW_(region.X_WR.inverse()),
      X_TF_(region.X_FT.inverse()),
      leans_(region.lean < kHalfTurn),
      hangs_on_hinge_(region.mechanism && region.mechanism->type == JointType::hinge),
      dof_(arm.dof()),
      last_turn_(arm.dof()) {
  double below = 0;  // [m] from the origin of the joint before to F
  Eigen::Vector3d offset = (arm.X_JT * X_TF_).p;
  for (int k = dof_ - 1; k >= 0; --k) {
    const auto joint = static_cast<std::size_t>(k);
    hinge_[joint] = arm.joints[joint].type == JointType::hinge;
    lever_[joint] = arm.joints[joint].axis.cross(offset).norm() + below;
    below += offset.norm();
    offset = arm.joints[joint].X_PJ.p;
  }
  find_idle_joints(arm);
  range_ = kKeptRange;
  const double longest = *std::max_element(lever_.begin(), lever_.end());
  for (int k = 0; k < 3; ++k) {
    const TurnBounds turn = turn_bounds(region_, k);
    range_ = std::min(range_, range_for(0.5 * (turn.max - turn.min), 1));
    range_ =
        std::min(range_, range_for(0.5 * (region_.place_max[k] - region_.place_min[k]), longest));
  }
  if (leans_) range_ = std::min(range_, range_for(region_.lean, 1));
  range_ = std::max(range_, kLeastRange);
}

/// Turns about z of R before all others, and about z of F after all others, change nothing that is
/// bounded where the turns about these axes are free.
void RegionProof::find_idle_joints(const Arm& arm) {
  std::array<Pose, kMaxDof> X_WJ;
  const JointVec zero = JointVec::Zero(dof_);
  const Pose X_WF = fk_all(arm, mjarm::as_span(zero), X_WJ) * X_TF_;
  const auto is_about = [&](int k, const Eigen::Vector3d& axis_W) {
    const auto joint = static_cast<std::size_t>(k);
    return hinge_[joint] &&
           (X_WJ[joint].R * arm.joints[joint].axis).cross(axis_W).norm() < kOneAxis;
  };
  const auto slides = [&](int k) { return !hinge_[static_cast<std::size_t>(k)]; };
  const auto is_free = [&](int axis) { return !turn_bounds(region_, axis).any(); };
  const auto is_open = [&](int k) {
    return region_.place_min[k] == -kFreePlace && region_.place_max[k] == kFreePlace;
  };
  const Eigen::Vector3d z_W = region_.X_WR.R.col(2);
  // Before them comes a hinge that R hangs on; one about z of R is as idle.
  const bool still = !hangs_on_hinge_ || region_.mechanism->axis_W.cross(z_W).norm() < kOneAxis;
  while (first_turn_ < dof_ && still && is_free(2) &&
         (slides(first_turn_) || is_about(first_turn_, z_W))) {
    ++first_turn_;
  }
  const bool is_cone = is_free(0) && is_free(1) && is_free(2);
  const auto idle_at_end = [&](int k) { return slides(k) || is_about(k, X_WF.R.col(2)); };
  while (last_turn_ > first_turn_ && is_cone && idle_at_end(last_turn_ - 1)) --last_turn_;
  if (is_cone && !leans_) first_turn_ = last_turn_;
  const bool level = still && is_open(0) && is_open(1);
  while (first_place_ < dof_ && level && is_about(first_place_, z_W)) ++first_place_;
  if (is_open(0) && is_open(1) && is_open(2)) first_place_ = dof_;
}

EdgeMotion RegionProof::motion(std::span<const double> q0, std::span<const double> q1) const {
  EdgeMotion out;
  for (int k = first_turn_; k < last_turn_; ++k) {
    const auto joint = static_cast<std::size_t>(k);
    if (hinge_[joint]) out.turn += std::abs(q1[joint] - q0[joint]);
  }
  double slid = 0;   // [m] by slides after the joint
  double after = 0;  // [m] twice what later joints, with their levers, move
  for (int k = dof_ - 1; k >= first_place_; --k) {
    const auto joint = static_cast<std::size_t>(k);
    const double move = std::abs(q1[joint] - q0[joint]);
    if (hinge_[joint]) {
      const double far = (lever_[joint] + slid) * move;
      out.place += move * (far + after);
      after += 2 * far;
    } else {
      slid += std::max(std::abs(q0[joint]), std::abs(q1[joint]));
      after += 2 * move;
    }
  }
  out.speed = 0.5 * after;
  return out;
}

SeenTool RegionProof::see(const Pose& X_WT) const {
  if (!region_.mechanism) return {.X_RF = X_RW_ * X_WT * X_TF_};
  const double value = value_for(region_, X_WT);
  const Pose X_WF = X_WT * X_TF_;
  const double off = region_.mechanism->axis_W.cross(X_WF.p - region_.mechanism->p_W).norm();
  return {standing_at(region_, value).X_WR.inverse() * X_WF, value, off};
}

RegionRoom RegionProof::room(const SeenTool& a, const SeenTool& b, const EdgeMotion& motion,
                             double part) const {
  double place = part * part * motion.place, turn = part * motion.turn;
  if (hangs_on_hinge_) {
    const Mechanism& hinge = *region_.mechanism;
    double by = b.value - a.value;
    if (hinge.max - hinge.min >= kFreeHinge) by = std::remainder(by, 2 * kHalfTurn);
    by = std::abs(by);
    const double way = part * motion.speed, off = 0.5 * (a.off + b.off + way);
    place += by * (2 * way + by * off);
    turn += by;
  }
  return between(a.X_RF, b.X_RF, place / 8, turn * turn / 8);
}

/// @param place  [m] by which the place may be off the straight line.
/// @param turn   and a unit vector.
RegionRoom RegionProof::between(const Pose& a, const Pose& b, double place, double turn) const {
  RegionRoom out;
  for (int k = 0; k < 3; ++k) {
    out.place = std::min({out.place, std::min(a.p[k], b.p[k]) - place - region_.place_min[k],
                          region_.place_max[k] - std::max(a.p[k], b.p[k]) - place});
  }
  out.turn = room_to_turn(a.R, b.R, turn);
  return out;
}

double RegionProof::room_to_turn(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b,
                                 double bulge) const {
  double room = std::numeric_limits<double>::infinity();
  const TurnBounds roll = turn_bounds(region_, 0), pitch = turn_bounds(region_, 1),
                   yaw = turn_bounds(region_, 2);
  // Cosine and sine of the roll stand in the last row, of the yaw in the first column, both times
  // the cosine of the pitch; its sine is -R(2, 0).
  if (roll.any()) {
    const Eigen::Vector2d from(a(2, 2), a(2, 1)), to(b(2, 2), b(2, 1));
    room = std::min(room, room_in_wedge(from, to, roll, bulge));
  }
  if (yaw.any()) {
    room = std::min(room, room_in_wedge(a.block<2, 1>(0, 0), b.block<2, 1>(0, 0), yaw, bulge));
  }
  if (pitch.min > -kFreePlace) {
    room = std::min(room, std::min(-a(2, 0), -b(2, 0)) - bulge - std::sin(pitch.min));
  }
  if (pitch.max < kFreePlace) {
    room = std::min(room, std::sin(pitch.max) - std::max(-a(2, 0), -b(2, 0)) - bulge);
  }
  if (!leans_) return room;
  const double along = std::min(a(2, 2), b(2, 2)) - bulge;
  if (region_.lean >= kHalfTurn / 2) return std::min(room, along - std::cos(region_.lean));
  if (along <= 0) return -kHalfTurn;
  const double sine = std::max(a.block<2, 1>(0, 2).norm(), b.block<2, 1>(0, 2).norm()) + bulge;
  return std::min(room, region_.lean - std::asin(std::min(sine, 1.0)));
}

void RegionProof::add_rows(const FkJacobian& at, std::vector<JointVec>& rows,
                           std::vector<double>& needs) const {
  const SeenTool seen = see(at.X_WT);
  const Pose& X_RF = seen.X_RF;
  const Eigen::Matrix3d R_WR = standing_at(region_, seen.value).X_WR.R, R_RW = R_WR.transpose();
  const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxDof> turns =
      R_RW * at.J_W.bottomRows<3>();
  const Eigen::Vector3d p_TF_W = at.X_WT.R * X_TF_.p;
  const auto add = [&](const JointVec& row, double need, double max) {
    rows.push_back(row);
    needs.push_back(std::clamp(need, -max, max));
  };
  for (int k = 0; k < 3; ++k) {
    const double need =
        need_of(X_RF.p[k], region_.place_min[k], region_.place_max[k], kInsidePlace);
    if (need == 0) continue;
    const Eigen::Vector3d axis_W = R_WR.col(k);
    const JointVec row = at.J_W.topRows<3>().transpose() * axis_W +
                         at.J_W.bottomRows<3>().transpose() * p_TF_W.cross(axis_W);
    add(row, need, kMaxStepPlace);
  }
  const Eigen::Vector3d rpy = to_euler(X_RF.R);
  const double level_x = std::cos(rpy[2]), level_y = std::sin(rpy[2]);
  const double cosine = std::max(std::cos(rpy[1]), kLeastCosine);
  const Eigen::Vector3d along(level_x / cosine, level_y / cosine, 0);
  const std::array<Eigen::Vector3d, 3> rates{along, Eigen::Vector3d(-level_y, level_x, 0),
                                             std::sin(rpy[1]) * along + Eigen::Vector3d::UnitZ()};
  for (int k = 0; k < 3; ++k) {
    const TurnBounds bounds = turn_bounds(region_, k);
    if (!bounds.any()) continue;
    const double angle = k == 1 ? rpy[k] : nearest_winding_to(rpy[k], bounds);
    const double need = need_of(angle, bounds.min, bounds.max, kInsideTurn);
    if (need == 0) continue;
    add(turns.transpose() * rates[static_cast<std::size_t>(k)], need, kMaxStepTurn);
  }
  if (!leans_) return;
  // The turn that would put u upright is about an axis across u, as are all that change it.
  const Eigen::Vector3d u = X_RF.R.col(2), way = u.cross(Eigen::Vector3d::UnitZ());
  const double sine = way.norm(),
               need = -need_of(std::atan2(sine, u[2]), -region_.lean, region_.lean, kInsideTurn);
  if (need == 0) return;
  const Eigen::Vector3d about = sine > kOneAxis ? Eigen::Vector3d(way / sine) : u.unitOrthogonal();
  add(turns.transpose() * about, need, kMaxStepTurn);
  add(turns.transpose() * u.cross(about), 0, kMaxStepTurn);
}

}  // namespace mjarm::detail
