#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/path_torque_internal.hpp"

namespace mjarm::detail {

TorqueTerms torque_terms(const InverseDynamics& dynamics, const SplinePoint& p) {
  const JointVec zero = JointVec::Zero(p.q.size());
  const JointVec rest = dynamics(p.q, zero, zero);
  const JointVec ahead = dynamics(p.q, p.d, p.e), back = dynamics(p.q, -p.d, p.e);
  const JointVec twice = dynamics(p.q, 2 * p.d, 4 * p.e);
  TorqueTerms terms;
  terms.by_a = dynamics(p.q, zero, p.d) - rest;
  terms.by_u = 0.5 * (ahead + back) - rest;
  const JointVec friction = 0.5 * (ahead - back);  // viscous and dry, of which one doubles
  terms.viscous = twice - rest - 4 * terms.by_u - friction;
  terms.dry = friction - terms.viscous;
  terms.still = rest;
  return terms;
}

Result<void> check_still(const JointVec& torque, const JointVec& limit, double share) {
  constexpr double kLeft = 1e-3;  // of the limit, to move with
  for (Eigen::Index j = 0; j < limit.size(); ++j) {
    if (std::abs(torque[j]) <= (1 - kLeft) * limit[j]) continue;
    return fail(Errc::impossible,
                text(msg::trajectory_too_heavy, 100 * share, j + 1, std::abs(torque[j]), limit[j]));
  }
  return {};
}

Result<double> stretch_for_torque(const Trajectory& motion, const Bounds& bounds) {
  constexpr int kSamples = 4;  // of each piece
  const JointVec zero = JointVec::Zero(motion.dof());
  double factor = 1;
  for (std::size_t i = 0; i < motion.pieces(); ++i) {
    const Trajectory::Piece piece = motion.piece(i);
    for (int k = 0; k < kSamples; ++k) {
      const double t = piece.start + piece.duration * k / kSamples;
      const JointState x = motion.at(t);
      const JointVec torque = bounds.dynamics(x.q, x.v, x.a);
      if ((torque.cwiseAbs() - bounds.torque).maxCoeff() <= 0) continue;
      const JointVec rest = bounds.dynamics(x.q, zero, zero);
      if (Result<void> fine = check_still(rest, bounds.torque, t / motion.duration()); !fine) {
        return fail(std::move(fine.error()));
      }
      for (Eigen::Index j = 0; j < torque.size(); ++j) {
        // What motion adds falls at least with the factor: friction so, the rest with its square.
        const double limit = std::copysign(bounds.torque[j], torque[j]);
        factor = std::max(factor, (torque[j] - rest[j]) / (limit - rest[j]));
      }
    }
  }
  return factor;
}

}  // namespace mjarm::detail
