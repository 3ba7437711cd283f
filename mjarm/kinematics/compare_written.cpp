#include <algorithm>
#include <cmath>
#include <map>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/compare_internal.hpp"
#include "mjarm/model/describe.hpp"

namespace mjarm {

std::vector<Cause> explain_as_written(const Arm& first, const Arm& second,
                                      CauseTolerance tolerance) {
  std::vector<Cause> causes;
  std::vector<Cause> offsets;
  std::vector<Cause> signs;
  for (int i = 0; i < first.dof(); ++i) {
    const ArmJoint& a = first.joints[static_cast<std::size_t>(i)];
    const ArmJoint& b = second.joints[static_cast<std::size_t>(i)];
    // The axis is that of the first arm; where the other one names it differently, the frame of
    // the second is turned until both agree.
    Eigen::Vector3d axis = b.axis;
    const bool reversed = (a.axis + b.axis).norm() < (a.axis - b.axis).norm();
    if (reversed) axis = -axis;
    const Eigen::Matrix3d R_axis = rotation_between(a.axis, axis);
    const Eigen::Matrix3d R_B = b.X_PJ.R * R_axis;
    Cause link{.code = i == 0 ? CauseCode::base : CauseCode::link, .joint = i == 0 ? -1 : i};
    link.turn = rotation_log(R_B * a.X_PJ.R.transpose());
    link.shift = b.X_PJ.p - a.X_PJ.p;
    const Eigen::Vector3d about = a.X_PJ.R * a.axis;
    const bool about_axis = link.turn.cross(about).norm() < tolerance.value;
    if (i == 0) {
      const Pose X = Pose{b.X_PJ.p, R_B} * a.X_PJ.inverse();
      link.shift = X.p;
      const bool same_line = (b.X_PJ.p - a.X_PJ.p).norm() < tolerance.value;
      if (about_axis && same_line && link.turn.norm() > tolerance.value) link.same_as_zero_of = 0;
    } else if (about_axis && a.type == JointType::hinge && link.turn.norm() > tolerance.value) {
      offsets.push_back({.code = CauseCode::zero_offset, .joint = i});
      offsets.back().offset = link.turn.dot(about);
      link.turn.setZero();
    }
    if (link.shift.norm() > tolerance.value || link.turn.norm() > tolerance.value) {
      causes.push_back(link);
    }
    if (reversed) signs.push_back({.code = CauseCode::joint_sign, .joint = i});
  }
  // In this order each is given in the frames and about the axes of the first arm.
  causes.insert(causes.end(), offsets.begin(), offsets.end());
  causes.insert(causes.end(), signs.begin(), signs.end());
  add_tool(first, second, tolerance, causes);
  return causes;
}

namespace {

/// Mass that each joint of the arm moves directly, up to the next joint of the arm [kg].
std::vector<double> masses_of(const Model& model, const Arm& arm) {
  const ModelInfo info = describe(model);
  std::map<std::string, int> index;
  for (int i = 0; i < arm.dof(); ++i) index[arm.joints[static_cast<std::size_t>(i)].name] = i;
  std::vector<int> carrier(info.bodies.size(), -1);
  std::vector<double> masses(arm.joints.size(), 0);
  for (std::size_t b = 1; b < info.bodies.size(); ++b) {
    const BodyInfo& body = info.bodies[b];
    if (body.parent >= 0) carrier[b] = carrier[static_cast<std::size_t>(body.parent)];
    for (const JointInfo& joint : body.joints) {
      if (const auto found = index.find(joint.name); found != index.end()) {
        carrier[b] = found->second;
      }
    }
    if (carrier[b] >= 0) masses[static_cast<std::size_t>(carrier[b])] += body.mass;
  }
  return masses;
}

}  // namespace

std::vector<FigureDifference> compare_figures(const Model& first, const Arm& first_arm,
                                              const Model& second, const Arm& second_arm) {
  std::vector<FigureDifference> differences;
  if (first_arm.dof() != second_arm.dof()) return differences;
  bool by_name = false;
  const std::vector<int> order = match_joints(first_arm, second_arm, by_name);
  const std::vector<double> masses[] = {masses_of(first, first_arm), masses_of(second, second_arm)};
  for (std::size_t j = 0; j < order.size(); ++j) {
    const int i = order[j];
    const int k = static_cast<int>(j);
    const JointLimits& a = first_arm.limits;
    const JointLimits& b = second_arm.limits;
    const auto compare = [&](std::string_view what, double one, double other) {
      const double size = std::max(std::abs(one), std::abs(other));
      if (one == other || std::abs(one - other) <= 1e-4 * size) return;
      differences.push_back({first_arm.joints[static_cast<std::size_t>(i)].name, what, one, other});
    };
    const LimitSources& from_a = a.sources[static_cast<std::size_t>(i)];
    const LimitSources& from_b = b.sources[j];
    const auto both = [](LimitSource x, LimitSource y) {
      return x == LimitSource::file && y == LimitSource::file;
    };
    compare("mass", masses[0][static_cast<std::size_t>(i)], masses[1][j]);
    compare("lower", a.lower[i], b.lower[k]);
    compare("upper", a.upper[i], b.upper[k]);
    if (both(from_a.velocity, from_b.velocity)) compare("velocity", a.velocity[i], b.velocity[k]);
    if (both(from_a.torque, from_b.torque)) compare("torque", a.torque[i], b.torque[k]);
  }
  return differences;
}

}  // namespace mjarm
