#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"

/// Every way in which the Panda can hold its flange, by trying all values of joint 7: slow, written
/// from the figures of Franka's table alone, with triangles and cross products in the world frame.
namespace mjarm::testing {

/// The least by which limits must be broken to reach a pose.
class PandaSweep {
 public:
  /// Where no angles whatever reach the pose, least_breach() is at least this.
  static constexpr double kNever = 10;

  explicit PandaSweep(const Arm& arm) : limits_(arm.limits) {}

  /// [rad] the smallest widening of all limits that makes X_WT reachable, >= kNever where none
  /// does; the first number below 0 that is met where the pose is reachable as it stands. A sample
  /// every 3 mrad of joint 7 for each of eight branches; then each local minimum is narrowed, and
  /// so is each end of a branch, near which everything moves with the square root of the distance.
  [[nodiscard]] double least_breach(const Pose& X_WT) const {
    constexpr int kSamples = 2100;
    const double first = 0.5 * (limits_.lower[6] + limits_.upper[6]) - kPi;
    const auto at = [&](int k) { return first + 2 * kPi * k / kSamples; };
    std::vector<Breaches> grid;
    double least = kNever * 10;
    for (int k = 0; k <= kSamples; ++k) {
      grid.push_back(breaches(X_WT, at(k)));
      least = std::min(least, std::ranges::min(grid.back()));
      if (least < 0) return least;
    }
    for (std::size_t b = 0; b < 8; ++b) {
      for (int k = 0; k <= kSamples; ++k) {
        const auto value = [&](int i) {
          return grid[static_cast<std::size_t>(std::clamp(i, 0, kSamples))][b];
        };
        const double from = at(std::max(k - 1, 0));
        const double to = at(std::min(k + 1, kSamples));
        if (value(k) <= value(k - 1) && value(k) <= value(k + 1)) {
          least = std::min(least, narrow(X_WT, b, from, to));
        }
        const bool ends = (value(k) < kNever) != (value(k + 1) < kNever);
        if (k < kSamples && ends) least = std::min(least, near_end(X_WT, b, at(k), at(k + 1)));
      }
    }
    return least;
  }

 private:
  using Breaches = std::array<double, 8>;
  using Vec = Eigen::Vector3d;
  using Mat = Eigen::Matrix3d;

  static constexpr double kPi = std::numbers::pi;
  static constexpr double kShoulder = 0.333;  // [m] height of the shoulder
  static constexpr double kUpper = 0.316;     // [m] along axis 3
  static constexpr double kAside = 0.0825;    // [m] elbow from axis 3, and from axis 5
  static constexpr double kLower = 0.384;     // [m] along axis 5
  static constexpr double kWrist = 0.088;     // [m] axis 7 from axis 6
  static constexpr double kFlange = 0.107;    // [m]

  /// Of the branches at one value of joint 7; two elbows, two wrists, two shoulders.
  [[nodiscard]] Breaches breaches(const Pose& X_WT, double q7) const {
    Breaches out;
    const Mat R6 = X_WT.R * turn(2, -q7) * turn(0, -kPi / 2);
    const Vec p_WW = X_WT.p - kFlange * X_WT.R.col(2) - kWrist * R6.col(0);
    const Vec u = Vec(0, 0, kShoulder) - p_WW;  // from the wrist to the shoulder
    const double length = u.norm();
    // The triangle of shoulder, elbow and wrist.
    const double se2 = kUpper * kUpper + kAside * kAside;
    const double ew2 = kLower * kLower + kAside * kAside;
    const double cosine = (length * length + ew2 - se2) / (2 * length * std::sqrt(ew2));
    if (std::abs(cosine) > 1) {
      out.fill(2 * kNever + std::abs(cosine));
      return out;
    }
    const Vec v = R6.transpose() * u;
    const double across = std::hypot(v.x(), v.y());
    for (std::size_t b = 0; b < 8; b += 2) {
      const double side = b < 4 ? 1 : -1;
      // Where u points in the plane of the arm: x4 away from the forearm, y4 along axis 5.
      const double phi = std::atan2(-kLower, kAside) + side * std::acos(cosine);
      const double wanted = length * std::sin(phi) / across;
      if (!(std::abs(wanted) <= 1)) {
        out[b] = out[b + 1] = kNever + std::abs(wanted);
        continue;
      }
      const double q6 = std::atan2(v.x(), v.y()) + (b % 4 == 0 ? 1 : -1) * std::acos(wanted);
      judge_arm(R6, p_WW, u / length, phi, q6, q7, &out[b]);
    }
    return out;
  }

  /// Both shoulders of one elbow and wrist.
  void judge_arm(const Mat& R6, const Vec& p_WW, const Vec& to_shoulder, double phi, double q6,
                 double q7, double* out) const {
    const Mat R5 = R6 * turn(2, -q6) * turn(0, -kPi / 2);
    Mat R4, R3;
    R4.col(1) = R5.col(2);
    R4.col(0) = (to_shoulder - std::sin(phi) * R4.col(1)) / std::cos(phi);
    R4.col(2) = R4.col(0).cross(R4.col(1));
    const Vec p_WE = p_WW + kAside * R4.col(0) - kLower * R4.col(1);
    const Vec w = p_WE - Vec(0, 0, kShoulder);
    R3.col(1) = -R4.col(2);
    const Vec side = R3.col(1).cross(w);
    R3.col(2) = (kUpper * w - kAside * side) / w.squaredNorm();
    R3.col(0) = R3.col(1).cross(R3.col(2));
    const double q5 = angle_of((R4 * turn(0, -kPi / 2)).transpose() * R5);
    const double q4 = angle_of((R3 * turn(0, kPi / 2)).transpose() * R4);
    for (int shoulder = 0; shoulder < 2; ++shoulder) {
      const double s = shoulder == 0 ? 1 : -1;
      const double q1 = std::atan2(s * R3(1, 2), s * R3(0, 2));
      const double q2 = s * std::atan2(std::hypot(R3(0, 2), R3(1, 2)), R3(2, 2));
      const double q3 = std::atan2(s * R3(2, 1), -s * R3(2, 0));
      const double q[] = {q1, q2, q3, q4, q5, q6, q7};
      out[shoulder] = -kPi;
      for (int i = 0; i < 7; ++i) {
        const double middle = 0.5 * (limits_.lower[i] + limits_.upper[i]);
        const double off = std::abs(std::remainder(q[i] - middle, 2 * kPi));
        out[shoulder] = std::max(out[shoulder], off - (limits_.upper[i] - middle));
      }
    }
  }

  /// Golden section.
  [[nodiscard]] double narrow(const Pose& X_WT, std::size_t branch, double from, double to) const {
    constexpr double kGolden = 0.6180339887498949;
    double a = to - kGolden * (to - from);
    double b = from + kGolden * (to - from);
    double at_a = breaches(X_WT, a)[branch];
    double at_b = breaches(X_WT, b)[branch];
    for (int step = 0; step < 45; ++step) {
      if (at_a < at_b) {
        to = b;
        b = a;
        at_b = at_a;
        a = to - kGolden * (to - from);
        at_a = breaches(X_WT, a)[branch];
      } else {
        from = a;
        a = b;
        at_a = at_b;
        b = from + kGolden * (to - from);
        at_b = breaches(X_WT, b)[branch];
      }
    }
    return std::min(at_a, at_b);
  }

  /// Between a value of joint 7 where the branch exists and one where it does not.
  [[nodiscard]] double near_end(const Pose& X_WT, std::size_t branch, double in, double out) const {
    if (breaches(X_WT, in)[branch] >= kNever) std::swap(in, out);
    const double start = in;
    for (int step = 0; step < 45; ++step) {
      const double middle = 0.5 * (in + out);
      (breaches(X_WT, middle)[branch] < kNever ? in : out) = middle;
    }
    constexpr int kSteps = 16;
    const auto at = [&](int k) { return in + (start - in) * k * k / (kSteps * kSteps); };
    double value[kSteps + 1];
    for (int k = 0; k <= kSteps; ++k) value[k] = breaches(X_WT, at(k))[branch];
    double least = std::min(value[0], value[kSteps]);
    for (int k = 1; k < kSteps; ++k) {
      least = std::min(least, value[k]);
      if (value[k] > value[k - 1] || value[k] > value[k + 1]) continue;
      const auto [from, to] = std::minmax({at(k - 1), at(k + 1)});
      least = std::min(least, narrow(X_WT, branch, from, to));
    }
    return least;
  }

  static Mat turn(int axis, double angle) {
    return Eigen::AngleAxisd(angle, Vec::Unit(axis)).toRotationMatrix();
  }
  /// Of a turn about z.
  static double angle_of(const Mat& R) { return std::atan2(R(1, 0), R(0, 0)); }

  JointLimits limits_;
};

}  // namespace mjarm::testing
