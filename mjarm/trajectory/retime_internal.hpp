#pragma once

#include <cstddef>
#include <vector>

namespace mjarm::detail {

/// A reference motion x(tau) of some rows (joints, or the way along a path) that is to be walked in
/// another time, at times `tau` of its own; and bounds that hold in the new time. All of a row is
/// divided by the bound it is for: v by the speed, and so on; 0 where there is no bound. Torques
/// are further rows beside accelerations: a_a u + v_a u' / 2 + root_a sqrt(u) + still within [-1,
/// 1].
struct RetimeProblem {
  std::size_t rows = 0;
  std::size_t a_rows = 0;   ///< of `a_a` and the like at one knot
  std::vector<double> tau;  ///< [s] strictly ascending, at least 2: where the law is asked for
  std::vector<std::size_t> knots;     ///< indices of those where it has knots; first and last too
  std::vector<double> u_max;          ///< per knot: largest (dtau/dt)^2 > 0 the speeds allow
  std::vector<double> a_a, v_a;       ///< per knot and row: x'' / A, x' / A
  std::vector<double> root_a, still;  ///< the same: by the rate itself, and at rest
  std::vector<double> j_j, a_j, v_j;  ///< per side, knot and row: x''' / J, x'' / J, x' / J; the
                                      ///< side after knot k is 2 k, that before it 2 k - 1
};

/// How the reference is walked: u = (dtau/dt)^2 at each `tau`, between knots quadratic and once
/// continuously differentiable everywhere.
struct TimeLaw {
  std::vector<double> t;   ///< [s] strictly ascending from 0
  std::vector<double> u;   ///< > 0
  std::vector<double> du;  ///< du/dtau
};

/// A fast time law that keeps the bounds at all knots, from both sides; the fastest one nearby, but
/// for a part in some thousand. An interior-point method that starts from an evenly slow motion and
/// never leaves what is allowed, so that it always has an answer (D. Verscheure et al., IEEE TAC 54
/// (2009) 2318, for the form; F. Debrouwere et al., IEEE T-RO 29 (2013) 1485, for the jerk).
[[nodiscard]] TimeLaw retime(const RetimeProblem& problem);

}  // namespace mjarm::detail
