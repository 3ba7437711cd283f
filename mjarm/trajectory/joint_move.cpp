#include <algorithm>
#include <array>
#include <limits>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/extremal_internal.hpp"
#include "mjarm/trajectory/limits_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

Result<Trajectory> time_joint_move(std::span<const double> q0, std::span<const double> q1,
                                   const JointLimits& limits, const TimingOptions& options) {
  if (q0.empty() || q0.size() != q1.size() || q0.size() > static_cast<std::size_t>(kMaxDof)) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_ends));
  }
  const JointVec from = joint_vec(q0), to = joint_vec(q1);
  const JointVec way = to - from;
  if (!way.allFinite()) return fail(Errc::bad_input, text(msg::trajectory_bad_ends));
  const Result<detail::Bounds> bounds = detail::bounds_of(limits, options, from.size());
  if (!bounds) return fail(bounds.error());
  const JointState start = JointState::at_rest(from), end = JointState::at_rest(to);
  if (way.isZero(0)) return Trajectory::from_jerks(start, {}, {}, end);

  const JointVec distance = way.cwiseAbs();
  const double v = 1 / distance.cwiseQuotient(bounds->v).maxCoeff();
  const double a = 1 / distance.cwiseQuotient(bounds->a).maxCoeff();
  const double j = 1 / distance.cwiseQuotient(bounds->j).maxCoeff();
  const detail::FarthestMotions moves({0, 0, 0, 0, 1, v, a, 1 / j, 0});
  const double duration = moves.first_far_enough(0, std::numeric_limits<double>::infinity());
  std::array<double, 7> durations{};
  std::array<JointVec, 7> jerks;
  std::size_t i = 0;
  for (const detail::JerkPhase& phase : moves.phases(duration)) {
    durations[i] = phase.duration;
    jerks[i++] = phase.jerk * way;
  }
  return Trajectory::from_jerks(start, durations, jerks, end);
}

}  // namespace mjarm
