#include "mjarm/path/path_measures.hpp"

#include <algorithm>
#include <limits>

#include "mjarm/kinematics/link_chain.hpp"

namespace mjarm {

PathMeasures measure_path(const Arm& arm, std::span<const JointVec> q,
                          const ClearanceCheck& clearance, const StopCheck& stop) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const LinkChain chain{Chain(arm)};
  PathMeasures out{{kInfinity, 0}, {kInfinity, 0}, {kInfinity, 0}, {kInfinity, 0}};
  for (std::size_t i = 0; i < q.size() && !is_stopped(stop); ++i) {
    const auto note = [i](LeastAlong& least, double value) {
      if (value < least.value) least = {value, i};
    };
    const Jacobian J_W = fk_jacobian(chain, as_span(q[i])).J_W;
    note(out.manipulability, manipulability(J_W));
    note(out.singular_value, smallest_singular_value(J_W));
    note(out.limit_room,
         std::min((q[i] - arm.limits.lower).minCoeff(), (arm.limits.upper - q[i]).minCoeff()));
    if (clearance) note(out.clearance, clearance(as_span(q[i])).distance);
  }
  return out;
}

}  // namespace mjarm
