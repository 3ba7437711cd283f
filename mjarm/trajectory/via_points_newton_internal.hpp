#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/trajectory/via_points_segment_internal.hpp"

namespace mjarm::detail {

/// A motion of all joints through all waypoints, or a change of one.
struct ViaSpline {
  Eigen::MatrixXd v, a;      ///< at the waypoints; joints x waypoints
  std::vector<double> h;     ///< [s] cell length of each segment
  std::vector<Inner> inner;  ///< of joint j in segment k: [k * joints + j]

  ViaSpline(int joints, int segments);
  [[nodiscard]] int joints() const { return static_cast<int>(v.rows()); }
  [[nodiscard]] int segments() const { return static_cast<int>(h.size()); }
  [[nodiscard]] Shared shared(int k, int j) const {
    return {v(j, k), a(j, k), v(j, k + 1), a(j, k + 1), h[static_cast<std::size_t>(k)]};
  }
  [[nodiscard]] std::size_t index(int k, int j) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(v.rows()) +
           static_cast<std::size_t>(j);
  }
  [[nodiscard]] double duration() const;  ///< [s]
};

/// Solves the Newton system of all segments: each waypoint's velocities and accelerations hang on
/// its neighbours' only, once the cell lengths are eliminated, so that a block Cholesky factor
/// takes time in proportion to the number of waypoints. Keeps its memory from call to call.
class ViaNewton {
 public:
  ViaNewton(int joints, int segments);

  /// Minimises the sum of the condensed models plus `time_weight` times the duration.
  /// @param parts        as ViaSpline::inner.
  /// @param time_weight  0 keeps all cell lengths.
  /// @param out          the change; none at both ends, which stay at rest.
  /// @return false where the system is not positive definite.
  [[nodiscard]] bool solve(const std::vector<Condensed>& parts, double time_weight, ViaSpline& out);

 private:
  void assemble(const std::vector<Condensed>& parts, int k);
  [[nodiscard]] bool eliminate_time(int k);
  [[nodiscard]] bool factor();
  void substitute(const std::vector<Condensed>& parts, bool fixed_times, ViaSpline& out);

  int joints_, segments_;
  // Of each waypoint: its own block, the one towards the next waypoint, and the right hand side.
  // Rows are v and a of joint 0, then of joint 1, ...
  std::vector<Eigen::MatrixXd> diag_, next_;
  std::vector<Eigen::VectorXd> rhs_;
  // Of each segment: its cell length against the waypoint before and after, itself, its gradient.
  std::vector<Eigen::VectorXd> before_, after_;
  std::vector<double> time_, time_grad_;
};

}  // namespace mjarm::detail
