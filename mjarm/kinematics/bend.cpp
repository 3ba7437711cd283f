#include <array>
#include <cmath>

#include "mjarm/kinematics/bend_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kNoOffset = 1e-3;  // [m] a shoulder with less is in the plane of its base axis

/// The axes of all joints in the world.
struct Axes {
  std::array<Vector3d, kMaxDof> p;  // a point of each [m]
  std::array<Vector3d, kMaxDof> a;  // unit
  Vector3d tool;
};

Axes axes_at(const Arm& arm, std::span<const double> q) noexcept {
  std::array<Pose, kMaxDof> X_WJ;
  Axes out;
  out.tool = fk_all(arm, q, X_WJ).p;
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.p[k] = X_WJ[k].p;
    out.a[k] = X_WJ[k].R * arm.joints[k].axis;
  }
  return out;
}

/// The point of the axis (p, a) that is nearest to the axis (p2, a2).
Vector3d nearest_on(const Vector3d& p, const Vector3d& a, const Vector3d& p2,
                    const Vector3d& a2) noexcept {
  const double along = a.dot(a2);
  const double across = 1 - along * along;
  if (across < 1e-12) return p;
  const Vector3d d = p2 - p;
  return p + (d.dot(a) - along * d.dot(a2)) / across * a;
}

Vector3d meet(const Axes& axes, std::size_t i, std::size_t j) noexcept {
  return nearest_on(axes.p[i], axes.a[i], axes.p[j], axes.a[j]);
}

Vector3d without(const Vector3d& v, const Vector3d& axis) noexcept {
  return v - v.dot(axis) * axis;
}

/// Across the line from the origin to `wrist`.
Vector3d across(const Vector3d& elbow, const Vector3d& wrist) noexcept {
  const double length = wrist.norm();
  return length > 0 ? without(elbow, wrist / length) : elbow;
}

/// The direction to the left of who stands at the base axis and looks to `p`.
Vector3d leftwards(const Axes& axes, const Vector3d& p) noexcept {
  const Vector3d& up = axes.a[0].z() < 0 ? Vector3d(-axes.a[0]) : axes.a[0];
  return up.cross(p - axes.p[0]);
}

void bend_six(const SixAxis& form, const Axes& axes, Bend& out) noexcept {
  const Vector3d& h = axes.a[1];
  const Vector3d centre = meet(axes, 4, 5);
  const Vector3d wrist = without((form.is_parallel() ? axes.p[3] : centre) - axes.p[1], h);
  out.aside = across(without(axes.p[2] - axes.p[1], h), wrist);
  out.turn = h.dot(wrist.cross(out.aside));
  const double offset = h.dot(without(centre - axes.p[0], axes.a[0]));
  out.left = (offset < -kNoOffset ? -1 : 1) * h.dot(leftwards(axes, centre));
  out.wrist = axes.a[3].cross(axes.a[5]).dot(axes.a[4]);
}

void bend_seven(const Axes& axes, Bend& out) noexcept {
  const Vector3d shoulder = meet(axes, 0, 1);
  const Vector3d wrist = meet(axes, 4, 5);
  const Vector3d elbow = axes.p[3] + (shoulder - axes.p[3]).dot(axes.a[3]) * axes.a[3];
  out.aside = across(elbow - shoulder, wrist - shoulder);
  out.left = leftwards(axes, wrist).dot(elbow - axes.p[0]);
  out.turn = out.left;
  out.wrist = axes.a[4].cross(axes.a[6]).dot(axes.a[5]);
}

}  // namespace

Bend bend_of(const IkSolver& ik, std::span<const double> q) noexcept {
  const Arm& arm = ik.arm();
  const int dof = arm.dof();
  Bend out;
  if (dof < 4 || dof > kMaxDof) return out;
  out.has_elbow = true;
  const Axes axes = axes_at(arm, q);
  out.closed = ik.six_axis() || ik.seven_axis();
  if (ik.six_axis()) {
    bend_six(*ik.six_axis(), axes, out);
  } else if (ik.seven_axis()) {
    bend_seven(axes, out);
  } else {
    const std::size_t elbow = dof >= 7 ? 3 : 2;
    const Vector3d& wrist = dof == 4 ? axes.tool : axes.p[dof >= 7 ? 5 : 3];
    out.aside = across(axes.p[elbow] - axes.p[1], wrist - axes.p[1]);
    out.turn = axes.a[elbow].dot((wrist - axes.p[1]).cross(out.aside));
  }
  return out;
}

}  // namespace mjarm::detail
