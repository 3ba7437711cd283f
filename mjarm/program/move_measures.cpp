#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/path/path_measures.hpp"
#include "mjarm/program/move_measures_internal.hpp"

namespace mjarm::program {

std::vector<JointVec> joint_way(const JointVec& from, const JointVec& to) {
  constexpr double kStep = 0.02;  // [rad or m]
  const JointVec way = to - from;
  const auto steps = std::max(1, static_cast<int>(std::ceil(way.cwiseAbs().maxCoeff() / kStep)));
  std::vector<JointVec> out;
  for (int i = 0; i <= steps; ++i) out.emplace_back(from + way * (static_cast<double>(i) / steps));
  return out;
}

MoveJudge::MoveJudge(const Arm& arm, const std::optional<ExactChecker>& checker,
                     const std::optional<ExactChecker>& shown)
    : arm_(arm),
      clearance_(checker ? clearance_check(*checker) : ClearanceCheck{}),
      shown_(shown ? clearance_check(*shown) : ClearanceCheck{}) {}

std::optional<std::string> MoveJudge::beyond_limits(const JointVec& q) const {
  constexpr double kRounded = 1e-9;
  const JointLimits& limits = arm_.limits;
  int worst = -1;
  double max = kRounded;
  for (int i = 0; i < arm_.dof(); ++i) {
    const double beyond = std::max(q[i] - limits.upper[i], limits.lower[i] - q[i]);
    if (!(beyond > max)) continue;
    max = beyond;
    worst = i;
  }
  if (worst < 0) return std::nullopt;
  const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(worst)];
  std::string line = text(msg::program_beyond_limit, joint.name, q[worst], limits.lower[worst],
                          limits.upper[worst]);
  const double as_degrees = q[worst] * std::numbers::pi / 180;
  if (joint.type == JointType::hinge && as_degrees >= limits.lower[worst] &&
      as_degrees <= limits.upper[worst]) {
    line += text(msg::program_in_degrees, q[worst]);
  }
  return line;
}

MoveMeasures MoveJudge::measure(const IkSolver& ik, const std::vector<JointVec>& way) const {
  const std::lock_guard turn(*measuring_);
  const PathMeasures least = measure_path(arm_, way, shown_);
  MoveMeasures out;
  out.singularity = singularity(ik, as_span(way[least.singular_value.at]));
  out.manipulability = least.manipulability.value;
  out.limit_room = least.limit_room.value;
  const JointVec& tight = way[least.limit_room.at];
  double room = std::numeric_limits<double>::infinity();
  for (int i = 0; i < arm_.dof(); ++i) {
    const double here = std::min(arm_.limits.upper[i] - tight[i], tight[i] - arm_.limits.lower[i]);
    if (!(here < room)) continue;
    room = here;
    out.limit_joint = i;
  }
  out.clearance = least.clearance.value;
  if (shown_) out.nearest = shown_(as_span(way[least.clearance.at])).pair;
  for (std::size_t i = 1; i < way.size(); ++i) {
    out.max_step = std::max(out.max_step, (way[i] - way[i - 1]).cwiseAbs().maxCoeff());
  }
  return out;
}

std::optional<std::string> MoveJudge::touches(const MoveMeasures& measures) {
  if (!(measures.clearance < 0)) return std::nullopt;
  return text(msg::program_overlap, measures.nearest.geom1, measures.nearest.geom2,
              -1e3 * measures.clearance);
}

}  // namespace mjarm::program
