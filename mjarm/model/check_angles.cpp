#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;

/// Hinges of arms turn by two revolutions at most; a number above, in radians, is most likely one
/// of degrees, and surely so where it is whole.
constexpr double kMaxHingeAngle = 4 * pi;
/// Fixed rotations stay within one revolution.
constexpr double kMaxFixedAngle = 2 * pi + 0.01;
/// 1.57, 3.14 and 6.28 are this far from what they stand for, relatively.
constexpr double kRounding = 6e-4;

/// Beyond this, numbers stand for "no limit" rather than for degrees.
constexpr double kMaxDegrees = 1000;

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-9; }

/// True for multiples of pi/4 up to two revolutions, as people write them (1.57, 3.1416, ...).
bool looks_like_radians(double value) {
  const double quarters = std::round(std::abs(value) / (pi / 4));
  if (quarters < 1 || quarters > 16 || is_whole(value)) return false;
  return std::abs(std::abs(value) / (quarters * pi / 4) - 1) < kRounding;
}

/// An attribute that holds angles.
struct Angles {
  const SourceNode* node;
  const char* attribute;
  std::vector<double> values;
  double max;  ///< [rad] the largest that makes sense
};

bool reads_degrees(const Description& description) {
  bool degrees = true;  // MJCF's default
  for (const SourceNode& node : description.nodes()) {
    if (node.kind() == "compiler" && !node.attribute("angle").empty()) {
      degrees = node.attribute("angle") == "degree";
    }
  }
  return degrees;
}

std::vector<Angles> angles_of_mjcf(const Description& description) {
  std::vector<Angles> all;
  for (const SourceNode& node : description.nodes()) {
    if (node.section != "worldbody" && node.section != "default") continue;
    if (node.kind() == "joint" && !node.attribute("range").empty()) {
      const std::optional<Setting> type = description.setting(node, "type");
      if (!type || type->value == "hinge" || type->value == "ball") {
        all.push_back({&node, "range", numbers_in(node.attribute("range")), kMaxHingeAngle});
      }
    }
    if (!node.attribute("euler").empty()) {
      all.push_back({&node, "euler", numbers_in(node.attribute("euler")), kMaxFixedAngle});
    }
    if (const auto values = numbers_in(node.attribute("axisangle")); values.size() == 4) {
      all.push_back({&node, "axisangle", {values[3]}, kMaxFixedAngle});
    }
  }
  return all;
}

std::vector<Angles> angles_of_urdf(const Description& description) {
  std::vector<Angles> all;
  for (const SourceNode& node : description.nodes()) {
    if (node.kind() == "origin" && !node.attribute("rpy").empty()) {
      all.push_back({&node, "rpy", numbers_in(node.attribute("rpy")), kMaxFixedAngle});
    }
    if (node.section != "joint" || node.kind() != "limit") continue;
    const tinyxml2::XMLElement* joint = node.element->Parent()->ToElement();
    if (joint->Attribute("type", "revolute") == nullptr) continue;
    for (const char* end : {"lower", "upper"}) {
      all.push_back({&node, end, numbers_in(node.attribute(end)), kMaxHingeAngle});
    }
    // 45, 90, 180 and their like; 50, 100 or 1000 rad/s are what people write for "no limit".
    const std::vector<double> speed = numbers_in(node.attribute("velocity"));
    if (!speed.empty() && speed[0] > 40 && std::fmod(speed[0], 15) == 0) {
      all.push_back({&node, "velocity", speed, kMaxHingeAngle});
    }
  }
  return all;
}

void report(const CheckContext& context, const Angles& angles, CheckCode code, Grade grade,
            Msg message, double value) {
  context.add(
      code, grade, context.description.place(*angles.node),
      text(message, angles.attribute, std::string(angles.node->attribute(angles.attribute)), value,
           code == CheckCode::degrees_for_radians ? value * pi / 180 : value * 180 / pi));
}

void find_degrees(const CheckContext& context, const std::vector<Angles>& all) {
  for (const Angles& angles : all) {
    for (const double value : angles.values) {
      if (!(std::abs(value) > angles.max) || !(std::abs(value) < kMaxDegrees)) continue;
      report(context, angles, CheckCode::degrees_for_radians,
             is_whole(value) && std::string_view(angles.attribute) != "velocity" ? Grade::error
                                                                                 : Grade::warning,
             msg::check_degrees, value);
      break;
    }
  }
}

void find_radians(const CheckContext& context, const std::vector<Angles>& all) {
  std::vector<std::pair<const Angles*, double>> suspects;
  std::size_t ranges = 0;
  std::size_t small = 0;
  for (const Angles& angles : all) {
    const auto odd = std::find_if(angles.values.begin(), angles.values.end(), looks_like_radians);
    if (odd != angles.values.end()) suspects.emplace_back(&angles, *odd);
    if (std::string_view(angles.attribute) != "range") continue;
    ++ranges;
    small += std::all_of(angles.values.begin(), angles.values.end(),
                         [](double v) { return std::abs(v) < kMaxFixedAngle; });
  }
  // Where every hinge would turn by a few degrees at most, not the ranges are wrong but the unit.
  if (ranges > 0 && small == ranges && (!suspects.empty() || ranges > 2)) {
    const auto is_range = [](const Angles& a) { return std::string_view(a.attribute) == "range"; };
    const Angles& first = *std::find_if(all.begin(), all.end(), is_range);
    Place place = context.description.root();
    for (const SourceNode& node : context.description.nodes()) {
      if (node.kind() == "compiler") place = context.description.place(node);
    }
    context.add(
        CheckCode::radians_for_degrees, Grade::error, place,
        text(msg::check_radians_everywhere, ranges, std::string(first.node->attribute("range"))));
    return;
  }
  for (const auto& [angles, value] : suspects) {
    report(context, *angles, CheckCode::radians_for_degrees, Grade::error, msg::check_radians,
           value);
  }
}

}  // namespace

void check_angles(const CheckContext& context) {
  const Description& description = context.description;
  if (description.is_urdf()) return find_degrees(context, angles_of_urdf(description));
  const std::vector<Angles> all = angles_of_mjcf(description);
  if (reads_degrees(description)) {
    find_radians(context, all);
  } else {
    find_degrees(context, all);
  }
}

}  // namespace mjarm
