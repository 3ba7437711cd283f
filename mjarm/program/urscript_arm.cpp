#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/urscript_arm_internal.hpp"

namespace mjarm::program::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kUrJoints = 6;
constexpr double kMaxApart = 0.003;  // [m] models round the lengths
constexpr double kMaxTurned = 0.01;  // [rad]

constexpr std::array<std::string_view, kUrJoints> kUrNames{
    "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
    "wrist_1_joint",      "wrist_2_joint",       "wrist_3_joint"};

constexpr std::array<UrLengths, 9> kUrArms{{
    {"UR3", 0.1519, 0.24365, 0.21325, 0.11235, 0.08535, 0.0819},
    {"UR5", 0.089159, 0.425, 0.39225, 0.10915, 0.09465, 0.0823},
    {"UR10", 0.1273, 0.612, 0.5723, 0.163941, 0.1157, 0.0922},
    {"UR3e", 0.15185, 0.24355, 0.2132, 0.13105, 0.08535, 0.0921},
    {"UR5e", 0.1625, 0.425, 0.3922, 0.1333, 0.0997, 0.0996},
    {"UR10e", 0.1807, 0.6127, 0.57155, 0.17415, 0.11985, 0.11655},
    {"UR16e", 0.1807, 0.4784, 0.36, 0.17415, 0.11985, 0.11655},
    {"UR20", 0.2363, 0.862, 0.7287, 0.201, 0.1593, 0.1543},
    {"UR30", 0.2363, 0.637, 0.5037, 0.201, 0.1593, 0.1543},
}};

/// An axis of a joint as a line.
struct Axis {
  Vector3d p;  ///< [m] any point of it
  Vector3d z;  ///< unit
};
using Axes = std::array<Axis, kUrJoints>;

/// The frames after each joint, X_B0 = identity first.
std::array<Pose, kUrJoints + 1> chain(const UrLengths& l, std::span<const double> q) {
  constexpr double kRight = std::numbers::pi / 2;
  const double d[] = {l.d1, 0, 0, l.d4, l.d5, l.d6};
  const double a[] = {0, -l.a2, -l.a3, 0, 0, 0};
  const double alpha[] = {kRight, 0, 0, kRight, -kRight, 0};
  std::array<Pose, kUrJoints + 1> out;
  for (std::size_t i = 0; i < kUrJoints; ++i) {
    const Eigen::Matrix3d R = from_euler({0, 0, q[i]});
    out[i + 1] = out[i] * Pose{R * Vector3d(a[i], 0, d[i]), R * from_euler({alpha[i], 0, 0})};
  }
  return out;
}

constexpr std::array<double, kUrJoints> kStretched{};  // all joints at zero

/// The point of `line` that is nearest to `other`, which is not parallel to it.
Vector3d nearest_point(const Axis& line, const Axis& other) {
  const Vector3d n = line.z.cross(other.z);
  return line.p + line.z * ((other.p - line.p).cross(other.z).dot(n) / n.squaredNorm());
}

Axes axes_of(const Arm& arm) {
  std::array<Pose, kUrJoints> X_WJ;
  fk_all(arm, kStretched, X_WJ);
  Axes out;
  for (std::size_t i = 0; i < kUrJoints; ++i) out[i] = {X_WJ[i].p, X_WJ[i].R * arm.joints[i].axis};
  return out;
}

/// The base frame of an arm whose first two axes meet at right angles; none where they do not.
std::optional<Pose> base_of(const Axes& axes, const UrLengths& lengths) {
  const Vector3d z = axes[0].z, y = -axes[1].z;
  if (std::abs(z.dot(y)) > kMaxTurned) return std::nullopt;
  Pose X_WB;
  X_WB.R.col(2) = z;
  X_WB.R.col(1) = (y - z * z.dot(y)).normalized();
  X_WB.R.col(0) = X_WB.R.col(1).cross(z);
  X_WB.p = nearest_point(axes[0], axes[1]) - lengths.d1 * z;
  return X_WB;
}

/// Largest distance [m] of an axis from where it should be; infinite where one is turned.
double apart(const Axes& axes, const UrLengths& lengths, const Pose& X_WB) {
  const auto frames = chain(lengths, kStretched);
  double worst = 0;
  for (std::size_t i = 0; i < kUrJoints; ++i) {
    const Vector3d z = X_WB.R * frames[i].R.col(2);
    if ((z - axes[i].z).norm() > kMaxTurned) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, (axes[i].p - X_WB * frames[i].p).cross(z).norm());
  }
  return worst;
}

/// What stands before the usual names of joints and frames; none where the names are others.
std::optional<std::string> prefix_of(const Arm& arm) {
  if (arm.joints.size() != kUrJoints) return std::nullopt;
  const std::string& first = arm.joints[0].name;
  if (!first.ends_with(kUrNames[0])) return std::nullopt;
  std::string prefix = first.substr(0, first.size() - kUrNames[0].size());
  for (std::size_t i = 0; i < kUrJoints; ++i) {
    if (arm.joints[i].name != prefix + std::string(kUrNames[i])) return std::nullopt;
  }
  return prefix;
}

/// The base where the model says that it stands: the height of the shoulder is rounded too.
void take_named_base(const Model& model, const std::string& prefix, UrArm& ur) {
  for (const char* name : {"base", "base_link"}) {
    const Result<Pose> X = frame_pose(model, prefix + name, model.qpos0());
    if (!X || (X->p - ur.X_WB.p).norm() > kMaxApart) continue;
    ur.X_WB.p = X->p;
    return;
  }
}

/// The flange: the model's frame of that name, else by the last two axes.
Pose flange_in_joint(const Model& model, const Arm& arm, const std::string& prefix, const UrArm& ur,
                     const Axes& axes) {
  std::array<Pose, kUrJoints> X_WJ;
  fk_all(arm, kStretched, X_WJ);
  const Vector3d p = nearest_point(axes[5], axes[4]) + ur.lengths.d6 * axes[5].z;
  const Pose by_axes = X_WJ[5].inverse() * Pose{p, ur.X_WB.R * ur_flange(ur.lengths, kStretched).R};
  for (const char* name : {"tool0", "attachment_site"}) {
    const Result<Arm> named = find_arm(model, {.tip = prefix + name});
    if (!named || named->joints.size() != kUrJoints) continue;
    if (named->joints.back().qpos != arm.joints.back().qpos) continue;
    if ((named->X_JT.p - by_axes.p).norm() > kMaxApart) continue;
    if (angle_between(named->X_JT.R, by_axes.R) < kMaxTurned) return named->X_JT;
  }
  return by_axes;
}

}  // namespace

Pose ur_flange(const UrLengths& lengths, std::span<const double> q) {
  return chain(lengths, q).back();
}

Result<UrArm> find_ur_arm(const Model& model, const Arm& arm) {
  const std::optional<std::string> prefix = prefix_of(arm);
  if (!prefix) {
    return fail(Errc::impossible, text(msg::program_urscript_other_arm, arm.name));
  }
  const Axes axes = axes_of(arm);
  std::optional<UrArm> best;
  double nearest = kMaxApart;
  for (const UrLengths& lengths : kUrArms) {
    const std::optional<Pose> X_WB = base_of(axes, lengths);
    if (!X_WB) continue;
    const double worst = apart(axes, lengths, *X_WB);
    if (worst > nearest) continue;
    nearest = worst;
    best = UrArm{lengths, *X_WB, {}};
  }
  if (!best) {
    return fail(Errc::impossible, text(msg::program_urscript_other_axes, arm.name));
  }
  take_named_base(model, *prefix, *best);
  best->X_JF = flange_in_joint(model, arm, *prefix, *best, axes);
  return *best;
}

}  // namespace mjarm::program::detail
