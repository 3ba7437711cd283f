#pragma once

#include <string>
#include <vector>

#include "mjarm/kinematics/arms_test.hpp"

/// Arms of six hinges without a closed form, by public figures (Denavit and Hartenberg's, of the
/// makers or of published calibrations), and arms of random geometry.
namespace mjarm::testing {

/// Link length, twist, offset and the angle at which the joint stands at 0, all in [m] and [rad].
struct DhRow {
  double a, alpha, d, theta;
};

/// Joints that turn from -pi to pi.
/// @param proximal  true: a and alpha are before the joint (J. J. Craig), false: behind it.
inline Arm dh_arm(const std::string& name, const std::vector<DhRow>& rows, bool proximal = false) {
  const auto about = [](double angle, const Eigen::Vector3d& axis) {
    return Pose{Eigen::Vector3d::Zero(), Eigen::AngleAxisd(angle, axis).toRotationMatrix()};
  };
  std::vector<JointRow> joints(rows.size());
  for (JointRow& joint : joints)
    joint = {{}, {0, 0, 0}, {0, 0, 1}, -std::numbers::pi, std::numbers::pi};
  Arm arm = make_arm(name, joints, {});
  Pose behind;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Pose link = about(rows[i].alpha, Eigen::Vector3d::UnitX());
    link.p.x() = rows[i].a;
    const Pose at_zero = about(rows[i].theta, Eigen::Vector3d::UnitZ());
    const Pose offset{{0, 0, rows[i].d}, Eigen::Matrix3d::Identity()};
    arm.joints[i].X_PJ = proximal ? behind * link * at_zero : behind * at_zero;
    behind = proximal ? offset : offset * link;
  }
  arm.X_JT = behind;
  return arm;
}

/// The arm with every joint's frame moved by about `size` [m and rad], as a calibration finds it.
inline Arm calibrated(Arm arm, double size, Rng& rng) {
  for (ArmJoint& joint : arm.joints) {
    const Eigen::Vector3d shift(rng.normal(), rng.normal(), rng.normal());
    const Eigen::Vector3d turn(rng.normal(), rng.normal(), rng.normal());
    joint.X_PJ.p += size * shift;
    joint.X_PJ.R = joint.X_PJ.R * rotation_exp(size * turn);
  }
  return arm;
}

inline Arm random_six(int number) {
  Rng rng(700, static_cast<std::uint64_t>(number));
  std::vector<DhRow> rows;
  for (int i = 0; i < 6; ++i) {
    const double a = rng.uniform(0, 0.3), alpha = rng.uniform(-3, 3);
    rows.push_back({a, alpha, rng.uniform(-0.3, 0.3), 0});
  }
  return dh_arm("random" + std::to_string(number), rows);
}

inline std::vector<Arm> built_six_axis_arms() {
  constexpr double h = std::numbers::pi / 2, pi = std::numbers::pi;
  const std::vector<DhRow> xarm{
      {0, 0, 0.267, 0},        {0, -h, 0, -1.3849179}, {0.28948866, 0, 0, 1.3849179},
      {0.0775, -h, 0.3425, 0}, {0, h, 0, 0},           {0.076, -h, 0.097, 0}};
  const std::vector<DhRow> crx{{0, h, 0, 0},     {0.54, 0, 0, h},  {0, h, 0, 0},
                               {0, -h, 0.54, 0}, {0, h, -0.15, 0}, {0, 0, 0.16, 0}};
  const std::vector<DhRow> gen3{{0, h, 0.2433, 0}, {0.28, pi, 0.03, h}, {0, h, 0.02, h},
                                {0, h, 0.245, h},  {0, h, 0.057, pi},   {0, 0, 0.235, h}};
  const std::vector<DhRow> hc10{{0, -h, 0.275, 0}, {0.7, pi, 0, -h},   {0, -h, 0, 0},
                                {0, h, -0.5, 0},   {0, -h, -0.162, 0}, {0, 0, -0.17, 0}};
  const std::vector<DhRow> piper{
      {0, 0, 0.123, 0},          {0, -h, 0, -3.0058}, {0.28503, 0, 0, -1.7939},
      {-0.02198, h, 0.25075, 0}, {0, -h, 0, 0},       {0, h, 0.091, 0}};
  const std::vector<DhRow> cr7{{0, -h, 0.296, 0}, {0.4, 0, 0, -h},    {0, -h, 0, -h},
                               {0, h, 0.4, 0},    {0, -h, 0.1405, 0}, {0, 0, 0.13, 0}};
  const std::vector<DhRow> jaco{{0, h, 0.2755, 0},        {0.41, pi, 0, -h},
                                {0, h, -0.0098, h},       {0, 1.047, -0.2501, 0},
                                {0, 1.047, -0.0856, -pi}, {0, pi, -0.2028, h}};
  return {dh_arm("xArm6", xarm, true), dh_arm("CRX10", crx),         dh_arm("Gen3lite", gen3),
          dh_arm("HC10", hc10),        dh_arm("PiPER", piper, true), dh_arm("xMateCR7", cr7),
          dh_arm("Jaco", jaco)};
}

/// Twelve: arms as they are built, calibrated ones next to closed forms, of random geometry.
inline std::vector<Arm> general_six_axis_arms() {
  std::vector<Arm> out = built_six_axis_arms();
  Rng rng(701);
  out.push_back(calibrated(ur5e(), 1e-3, rng));
  out.back().name = "UR5eCalibrated";
  out.push_back(calibrated(out[2], 1e-5, rng));
  out.back().name = "Gen3liteCalibrated";
  for (int number = 0; number < 3; ++number) out.push_back(random_six(number));
  return out;
}

}  // namespace mjarm::testing
