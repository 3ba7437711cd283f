#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/kinematics/six_axis.hpp"

namespace mjarm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kAngleDefect = 0.02;  // [rad] axes farther off are another form
constexpr double kPlaceDefect = 0.01;  // [m] likewise
constexpr double kShort = 1e-3;        // [m and rad] what is shorter counts as nothing
constexpr double kExactZero = 1e-11;   // what is smaller is an exact 0 with rounding

/// The axes as lines in the world at q = 0, and the tool there.
struct Lines {
  Vector3d p[6];
  Vector3d h[6];
  double sign[6] = {1, 1, 1, 1, 1, 1};  // -1 where `h` was turned round
  Pose X_WT;

  explicit Lines(const Chain& chain) {
    for (std::size_t i = 0; i < 6; ++i) {
      X_WT = X_WT * chain.X_PJ[i];
      p[i] = X_WT.p;
      h[i] = X_WT.R.col(2);
    }
    X_WT = X_WT * chain.X_JT;
  }

  /// Turns axis `i` to the side of axis `with`; returns the angle that is left.
  double align(int i, int with) {
    if (h[i].dot(h[with]) < 0) {
      h[i] = -h[i];
      sign[i] = -1;
    }
    return h[i].cross(h[with]).norm();
  }

  /// Where the axes 5 and 6 are nearest: the point halfway, and their distance, which is infinite
  /// for nearly parallel ones.
  std::pair<Vector3d, double> last_meeting() const {
    const Vector3d n = h[4].cross(h[5]);
    const double n2 = n.squaredNorm();
    if (n2 < 1e-4) return {p[4], std::numeric_limits<double>::infinity()};
    const Vector3d d = p[5] - p[4];
    const Vector3d on5 = p[4] + h[4] * (d.cross(h[5]).dot(n) / n2);
    const Vector3d on6 = p[5] + h[5] * (d.cross(h[4]).dot(n) / n2);
    return {0.5 * (on5 + on6), (on5 - on6).norm()};
  }

  /// The point of axis `i` at the same height along `axis` as `p_level`.
  Vector3d at_level(int i, const Vector3d& axis, const Vector3d& p_level) const {
    return p[i] + h[i] * (axis.dot(p_level - p[i]) / axis.dot(h[i]));
  }
};

/// x y z of a frame with the given z, and with y as near to `y` as can be.
Matrix3d frame(const Vector3d& z, const Vector3d& y) {
  Matrix3d R;
  R.col(2) = z;
  R.col(1) = (y - z * z.dot(y)).normalized();
  R.col(0) = R.col(1).cross(z);
  return R;
}

double angle_of(const Vector2d& v) { return std::atan2(v.y(), v.x()); }

/// The wrist's constants from its axes, all in frame F at q = 0.
detail::WristStep wrist_step(const Vector3d& h5, const Vector3d& h6, const Vector3d& side) {
  detail::WristStep out;
  const double in_line = h6.z() - h5.z() * h5.dot(h6);
  const double across = h5.cross(h6).z();
  out.phase = std::atan2(across, in_line);
  out.size = std::hypot(in_line, across);
  out.constant = h5.z() * h5.dot(h6);
  if (std::abs(out.constant) < kExactZero) out.constant = 0;
  out.excess = out.size * out.size - out.constant * out.constant - 1;
  if (std::abs(out.excess) < kExactZero) out.excess = 0;
  const Matrix3d R = Eigen::AngleAxisd(out.phase, h5).toRotationMatrix();
  out.h5 = h5;
  out.h6 = R * h6;
  out.side = R * side;
  out.side2 = R * h6.cross(side);
  return out;
}

}  // namespace

std::optional<SixAxis> SixAxis::recognise(const Chain& chain) {
  const auto& slide = chain.slide;
  if (chain.dof != 6 || std::find(slide.begin(), slide.end(), true) != slide.end()) return {};
  Lines lines(chain);
  SixAxis form;
  const std::pair<Vector3d, double> meeting = lines.last_meeting();
  const Vector3d& p_C = meeting.first;  // no structured binding: clang 14 lets no lambda capture it
  const double gap = meeting.second;
  const double skew = lines.align(2, 1);
  if (skew > kAngleDefect || gap > kPlaceDefect) return {};
  form.parallel_ = lines.h[3].cross(lines.h[1]).norm() <= kAngleDefect;
  const double fourth =
      form.parallel_ ? lines.align(3, 1) : (p_C - lines.p[3]).cross(lines.h[3]).norm();
  if (fourth > kPlaceDefect && !form.parallel_) return {};
  form.defect_ = std::max({skew, gap, fourth});

  const Vector3d h =
      (lines.h[1] + lines.h[2] + (form.parallel_ ? lines.h[3] : lines.h[1])).normalized();
  const Vector3d h1 = lines.h[0];
  detail::ShoulderStep& shoulder = form.shoulder_;
  shoulder.tilt_cos = h1.dot(h);
  shoulder.tilt_sin = h1.cross(h).norm();
  if (shoulder.tilt_sin < kShort) return {};
  const Matrix3d R_WB = frame(h1, h);
  form.X_BW_ = Pose{lines.p[0], R_WB}.inverse();
  // S has the x axis of B.
  Matrix3d R_WS;
  R_WS << R_WB.col(0), h.cross(R_WB.col(0)), h;
  shoulder.R_SB = R_WS.transpose() * R_WB;
  const auto in_S = [&](const Vector3d& p_W) -> Vector3d {
    return R_WS.transpose() * (p_W - lines.p[0]);
  };
  const auto axis_in_S = [&](int i) -> Vector2d {
    return in_S(lines.at_level(i, h, p_C)).head<2>();
  };
  shoulder.height = in_S(p_C).z();

  const Vector2d end = form.parallel_ ? axis_in_S(3) : Vector2d(in_S(p_C).head<2>());
  detail::ElbowStep& elbow = form.elbow_;
  elbow.p_shoulder = axis_in_S(1);
  const Vector2d upper = axis_in_S(2) - elbow.p_shoulder;
  const Vector2d lower = end - axis_in_S(2);
  elbow.upper = upper.norm();
  elbow.lower = lower.norm();
  elbow.upper_angle = angle_of(upper);
  elbow.lower_angle = angle_of(lower);
  form.p_4C_ = in_S(p_C).head<2>() - end;

  const Vector3d side = lines.h[5].unitOrthogonal();
  const Matrix3d R_WF = form.parallel_ ? R_WS : frame(lines.h[3], lines.h[3].unitOrthogonal());
  form.R_FS_ = R_WF.transpose() * R_WS;
  form.wrist_ = wrist_step(R_WF.transpose() * lines.h[4], R_WF.transpose() * lines.h[5],
                           R_WF.transpose() * side);
  if (std::min({elbow.upper, elbow.lower, form.wrist_.size}) < kShort) return {};

  form.p_TC_ = lines.X_WT.inverse() * p_C;
  form.h6_T_ = lines.X_WT.R.transpose() * lines.h[5];
  form.side_T_ = lines.X_WT.R.transpose() * side;
  std::copy(std::begin(lines.sign), std::end(lines.sign), form.sign_);
  const double span = p_C.norm() + elbow.upper + elbow.lower + form.p_TC_.norm();
  form.slack_ = form.defect_ > kExactZero ? 4 * form.defect_ * std::max(1.0, span) : 0.0;
  return form;
}

}  // namespace mjarm
