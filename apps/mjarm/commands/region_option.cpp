#include "apps/mjarm/commands/region_option.hpp"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/plan.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm::app {
namespace {

const std::vector<std::string>& region_keys() {
  static const std::vector<std::string> kKeys{
      "frame", "pos",  "euler", "quat", "tool-pos", "tool-euler", "tool-quat", "x",    "y",
      "z",     "roll", "pitch", "yaw",  "lean",     "hinge",      "slide",     "axis", "hinge-pos"};
  return kKeys;
}
constexpr std::size_t kFirstBound = 7, kLean = 13, kHinge = 14, kSlide = 15, kAxis = 16,
                      kHingePos = 17;  // in the list

/// The values of the words `KEY=VALUE`, in the order of region_keys(); empty: not given.
using RegionWords = std::vector<std::string>;

Result<RegionWords> split_region(const std::string& words) {
  const std::vector<std::string>& keys = region_keys();
  RegionWords out(keys.size());
  std::istringstream in(words);
  for (std::string word; in >> word;) {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals);
    const auto known = std::ranges::find(keys, key);
    if (known == keys.end()) {
      return fail(Errc::usage,
                  text(msg::plan_region_key, key, did_you_mean(key, keys), listed(keys)));
    }
    std::string& value = out[static_cast<std::size_t>(known - keys.begin())];
    if (equals == std::string::npos || equals + 1 == word.size() || !value.empty()) {
      return fail(Errc::usage, text(msg::plan_region_value, key));
    }
    value = word.substr(equals + 1);
  }
  return out;
}

/// A pose by its place and either way to tell how it stands; what is not given is none.
Result<Pose> pose_in_words(const std::string& prefix, const std::string& pos,
                           const std::string& euler, const std::string& quat) {
  Pose out;
  if (!pos.empty()) {
    const auto p = parse_list(prefix + "pos", pos, Quantity::length, 3);
    if (!p) return fail(p.error());
    out.p = {(*p)[0], (*p)[1], (*p)[2]};
  }
  if (!euler.empty() && !quat.empty()) {
    return fail(Errc::usage, text(msg::plan_region_value, prefix + "quat"));
  }
  if (!euler.empty()) {
    const auto angles = parse_list(prefix + "euler", euler, Quantity::angle, 3);
    if (!angles) return fail(angles.error());
    out.R = from_euler({(*angles)[0], (*angles)[1], (*angles)[2]});
  } else if (!quat.empty()) {
    const auto wxyz = parse_list(prefix + "quat", quat, Quantity::number, 4);
    if (!wxyz) return fail(wxyz.error());
    const Result<Eigen::Matrix3d> R = rotation_of_quat(*wxyz);
    if (!R) return fail(in_option(prefix + "quat", R.error()));
    out.R = *R;
  }
  return out;
}

/// `free`, `A..B`, or `A` for -A..A; at `A..` or `..B` the other side is free.
Result<std::pair<double, double>> parse_range(const std::string& key, const std::string& value,
                                              Quantity quantity, double farthest) {
  if (value == "free") return std::pair{-farthest, farthest};
  const auto number = [&](const std::string& word, double none) -> Result<double> {
    if (word.empty()) return none;
    const Result<double> read = parse_quantity(word, quantity);
    if (!read) return fail(in_option(key, read.error()));
    return read;
  };
  const std::size_t dots = value.find("..");
  const bool both = dots != std::string::npos;
  const Result<double> low = number(value.substr(0, dots), -farthest);
  if (!low) return fail(low.error());
  if (!both) return std::pair{-*low, *low};
  const Result<double> high = number(value.substr(dots + 2), farthest);
  if (!high) return fail(high.error());
  return std::pair{*low, *high};
}

/// What R hangs on: none without `hinge` and `slide`.
/// @param X_WB  the frame that its axis is given in.
Result<std::optional<Mechanism>> mechanism_in_words(const RegionWords& values, const Pose& X_WB) {
  const std::vector<std::string>& keys = region_keys();
  const bool hinge = !values[kHinge].empty(), slide = !values[kSlide].empty();
  if (hinge && slide) {
    return fail(Errc::usage, text(msg::app_exclusive_options, keys[kHinge], keys[kSlide]));
  }
  if (!hinge && !values[kHingePos].empty()) {
    return fail(Errc::usage, text(msg::plan_region_needs, keys[kHingePos], "hinge"));
  }
  if (!hinge && !slide && !values[kAxis].empty()) {
    return fail(Errc::usage, text(msg::plan_region_needs, keys[kAxis], "hinge, slide"));
  }
  if (!hinge && !slide) return std::nullopt;
  const std::size_t key = hinge ? kHinge : kSlide;
  const auto range = parse_range(keys[key], values[key], hinge ? Quantity::angle : Quantity::length,
                                 hinge ? kFreeTurn : kFreePlace);
  if (!range) return fail(range.error());
  Mechanism out{.type = hinge ? JointType::hinge : JointType::slide,
                .p_W = X_WB.p,
                .axis_W = X_WB.R.col(2),
                .min = range->first,
                .max = range->second};
  if (!values[kHingePos].empty()) {
    const auto p = parse_list(keys[kHingePos], values[kHingePos], Quantity::length, 3);
    if (!p) return fail(p.error());
    out.p_W = X_WB * Eigen::Vector3d((*p)[0], (*p)[1], (*p)[2]);
  }
  if (!values[kAxis].empty()) {
    const auto axis = parse_list(keys[kAxis], values[kAxis], Quantity::number, 3);
    if (!axis) return fail(axis.error());
    const Eigen::Vector3d along((*axis)[0], (*axis)[1], (*axis)[2]);
    if (!(along.norm() > 0)) return fail(Errc::usage, text(msg::plan_region_axis));
    out.axis_W = X_WB.R * along.normalized();
  }
  if (!is_sound(out)) return fail(Errc::usage, text(msg::plan_region_mechanism));
  return out;
}

/// The bounds of place and turn, and the lean.
Result<void> read_region_bounds(const RegionWords& values, Unnamed unnamed, TaskRegion& out) {
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_place = k < 3;
    const double farthest = is_place ? kFreePlace : k == 4 ? kFreePitch : kFreeTurn;
    const std::string none = unnamed == Unnamed::free ? "free" : "0";
    const std::string& given = values[kFirstBound + k];
    const auto range = parse_range(region_keys()[kFirstBound + k], given.empty() ? none : given,
                                   is_place ? Quantity::length : Quantity::angle, farthest);
    if (!range) return fail(range.error());
    const auto axis = static_cast<Eigen::Index>(k % 3);
    (is_place ? out.place_min : out.turn_min)[axis] = range->first;
    (is_place ? out.place_max : out.turn_max)[axis] = range->second;
  }
  if (values[kLean].empty()) return {};
  const Result<double> angle = parse_quantity(values[kLean], Quantity::angle);
  if (!angle) return fail(in_option("lean", angle.error()));
  out.lean = *angle;
  // A cone alone: what it leaves of roll and pitch is not to be said once more.
  if (values[kFirstBound + 3].empty() && values[kFirstBound + 4].empty()) {
    out.turn_min.head<2>() << -kFreeTurn, -kFreePitch;
    out.turn_max.head<2>() << kFreeTurn, kFreePitch;
  }
  return {};
}

Result<Pose> pose_of_frame(const std::string& name, const Robot& robot,
                           const std::optional<Pose>& X_WT) {
  if (name.empty()) return Pose{};
  if (name != "start") {
    Result<Pose> found = frame_pose(robot.model, name);
    if (!found) return fail(in_option("frame", found.error()));
    return found;
  }
  if (!X_WT) return fail(Errc::usage, text(msg::plan_region_start));
  return *X_WT;
}

}  // namespace

Result<TaskRegion> parse_region(const std::string& option, const std::string& words,
                                Unnamed unnamed, const Robot& robot,
                                const std::optional<Pose>& X_WT) {
  const auto in = [&](const Error& error) { return fail(in_option(option, error)); };
  const Result<RegionWords> values = split_region(words);
  if (!values) return in(values.error());
  const auto value = [&](std::size_t key) { return (*values)[key]; };
  const Result<Pose> X_WB = pose_of_frame(value(0), robot, X_WT);
  if (!X_WB) return in(X_WB.error());
  const Result<Pose> X_BR = pose_in_words("", value(1), value(2), value(3));
  if (!X_BR) return in(X_BR.error());
  const Result<Pose> X_FT = pose_in_words("tool-", value(4), value(5), value(6));
  if (!X_FT) return in(X_FT.error());
  TaskRegion out{.X_WR = *X_WB * *X_BR, .X_FT = *X_FT};
  if (Result<void> read = read_region_bounds(*values, unnamed, out); !read) return in(read.error());
  const auto mechanism = mechanism_in_words(*values, *X_WB);
  if (!mechanism) return in(mechanism.error());
  out.mechanism = *mechanism;
  if (!is_sound(out)) return in({Errc::usage, text(msg::plan_region_bounds)});
  return out;
}

}  // namespace mjarm::app
