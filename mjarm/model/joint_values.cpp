#include "mjarm/model/joint_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "mjarm/core/messages/model.hpp"

namespace mjarm {
namespace {

constexpr double kMaxBeyond = 1;  // [rad or m] farther beyond a limit nobody goes on purpose

/// A value of one joint, beside what the joint may do.
struct Judged {
  const ArmJoint& joint;
  double value;  ///< [rad or m]
  double lower;  ///< [rad or m] -inf without a limit
  double upper;  ///< [rad or m] inf without a limit

  [[nodiscard]] bool slides() const { return joint.type == JointType::slide; }
  /// [rad or m] beyond the limits; negative within them.
  [[nodiscard]] double beyond() const { return std::max(value - upper, lower - value); }
  /// The value if degrees or millimetres were meant [rad or m].
  [[nodiscard]] double converted() const {
    return slides() ? value / 1e3 : value * std::numbers::pi / 180;
  }
  /// More than is taken without a unit.
  [[nodiscard]] bool is_large() const {
    return std::abs(value) > (slides() ? kMaxBareLength : kMaxBareAngle);
  }
  [[nodiscard]] bool is_endless() const { return std::isinf(value > 0 ? upper : lower); }
};

Judged judge(double value, const Arm& arm, int i) {
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
  const bool has_limits = arm.limits.lower.size() == arm.dof();
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return {joint, value, has_limits ? arm.limits.lower[i] : -kNone,
          has_limits ? arm.limits.upper[i] : kNone};
}

Error unit_refusal(const Judged& judged, Msg turn, Msg length) {
  const double value = judged.value;
  return {Errc::bad_input, text(judged.slides() ? length : turn, judged.joint.name, value,
                                judged.lower, judged.upper, judged.converted())};
}

}  // namespace

Result<double> joint_value(const WrittenNumber& written, const Arm& arm, int i) {
  const Judged judged = judge(written.value, arm, i);
  const Quantity own = judged.slides() ? Quantity::length : Quantity::angle;
  if (written.unit != Quantity::number) {
    if (written.unit == own) return written.value;
    return fail(Errc::bad_input,
                text(judged.slides() ? msg::model_joint_slides : msg::model_joint_turns,
                     judged.joint.name));
  }
  const bool wanted = judged.beyond() > kMaxBeyond ||
                      (judged.is_large() && (judged.beyond() > 0 || judged.is_endless()));
  if (!wanted) return written.value;
  return fail(unit_refusal(judged, msg::model_joint_bare_angle, msg::model_joint_bare_length));
}

Result<std::vector<double>> parse_joint_values(std::string_view words, const Arm& arm) {
  const std::vector<std::string_view> entries = split_list(words);
  if (entries.size() != arm.joints.size()) {
    return fail(Errc::bad_input, text(msg::model_joint_count, arm.dof(), entries.size()));
  }
  std::vector<double> q;
  for (int i = 0; i < arm.dof(); ++i) {
    const bool slides = arm.joints[static_cast<std::size_t>(i)].type == JointType::slide;
    const std::array own{slides ? Quantity::length : Quantity::angle};
    const Result<WrittenNumber> written = parse_written(entries[static_cast<std::size_t>(i)], own);
    if (!written) return fail(written.error());
    const Result<double> value = joint_value(*written, arm, i);
    if (!value) return fail(value.error());
    q.push_back(*value);
  }
  return q;
}

Result<void> check_joint_units(std::span<const double> q, const Arm& arm) {
  for (int i = 0; i < arm.dof(); ++i) {
    const Judged judged = judge(q[static_cast<std::size_t>(i)], arm, i);
    if (!judged.is_large() || !(judged.beyond() > kMaxBeyond)) continue;
    // What makes no sense in degrees either is for others to refuse.
    const Judged in_degrees = judge(judged.converted(), arm, i);
    if (in_degrees.beyond() > kMaxBeyond) continue;
    return fail(unit_refusal(judged, msg::model_joint_no_radians, msg::model_joint_no_metres));
  }
  return {};
}

}  // namespace mjarm
