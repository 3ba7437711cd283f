#include "mjarm/path/path_measures.hpp"

#include <algorithm>

#include "mjarm/core/finite.hpp"
#include "mjarm/kinematics/link_chain.hpp"

namespace mjarm {
namespace {

/// Smallest singular values of Jacobians that hardly differ from one to the next.
class SingularWalk {
 public:
  /// [mixed units] None is smaller: no singular value changes by more than the norm of the
  /// difference (Weyl).
  [[nodiscard]] double at_least(const Jacobian& J) const {
    return J.cols() == J_.cols() ? smallest_ - (J - J_).norm() - kRounded : 0;
  }
  double of(const Jacobian& J) {
    J_ = J;
    return smallest_ = smallest_singular_value(J);
  }

 private:
  static constexpr double kRounded = 1e-12;
  Jacobian J_;
  double smallest_ = 0;
};

}  // namespace

PathMeasures measure_path(const Arm& arm, std::span<const JointVec> q,
                          const ClearanceCheck& clearance, const StopCheck& stop) {
  const LinkChain chain{Chain(arm)};
  PathMeasures out{{kInfinity, 0}, {kInfinity, 0}, {kInfinity, 0}, {kInfinity, 0}};
  SingularWalk singular;
  for (std::size_t i = 0; i < q.size() && !is_stopped(stop); ++i) {
    const auto note = [i](LeastAlong& least, double value) {
      if (value < least.value) least = {value, i};
    };
    const Jacobian J_W = fk_jacobian(chain, as_span(q[i])).J_W;
    note(out.manipulability, manipulability(J_W));
    if (singular.at_least(J_W) < out.singular_value.value) {
      note(out.singular_value, singular.of(J_W));
    }
    note(out.limit_room,
         std::min((q[i] - arm.limits.lower).minCoeff(), (arm.limits.upper - q[i]).minCoeff()));
    if (clearance && clearance.at_least(as_span(q[i])) < out.clearance.value) {
      note(out.clearance, clearance(as_span(q[i])).distance);
    }
  }
  return out;
}

}  // namespace mjarm
