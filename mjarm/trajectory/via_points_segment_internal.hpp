#pragma once

#include <array>

namespace mjarm::detail {

// One joint between two waypoints: its velocity is a quadratic B-spline over cells of one length h,
// with coefficients c[0..kCells+1]. At the nodes v_i = (c[i] + c[i+1]) / 2 and
// a_i = (c[i+1] - c[i]) / h, in the cells jerk_i = (c[i+2] - 2 c[i+1] + c[i]) / h^2; the velocity
// stays in the hull of c[1..kCells]. C. de Boor, A Practical Guide to Splines (1978).

inline constexpr int kCells = 16;          ///< cells of constant jerk a segment, >= 5
inline constexpr int kCoefs = kCells + 2;  ///< coefficients of one segment
inline constexpr int kInner = kCells - 2;  ///< those the ends leave free: c[2..kCells-1]
/// Rows |g(c)| <= b(h): kCells velocities, kCells + 1 accelerations, kCells jerks.
inline constexpr int kRows = 3 * kCells + 1;

using Coefs = std::array<double, kCoefs>;
using Inner = std::array<double, kInner>;
using Rows = std::array<double, kRows>;
/// What a joint shares with the next segments and the other joints: v and a at the start, v and a
/// at the end, length h [s] of a cell.
using Shared = std::array<double, 5>;

/// One joint between two waypoints: the way [rad or m] and the limits.
struct SegmentTask {
  double step, v, a, j;
};

/// One number for each direction of every row: the rooms b - g and b + g, or their multipliers.
struct RowPairs {
  Rows up, down;
};

/// All coefficients, from the shared numbers and the inner coefficients.
[[nodiscard]] Coefs coefs_of(const Shared& y, const Inner& inner);

/// Their change to first order.
[[nodiscard]] Coefs coefs_step(const Shared& y, const Shared& dy, const Inner& d_inner);

/// Sum of the inner coefficients with which the segment covers its way exactly.
[[nodiscard]] double inner_sum(const SegmentTask& task, const Shared& y);

/// Values of the rows. Linear in `c`.
[[nodiscard]] Rows row_values(const Coefs& c);

/// The least factor on time that keeps the limits: v goes with 1 / factor, a and j with its square
/// and cube.
[[nodiscard]] double time_factor(const SegmentTask& task, const Coefs& c, double h);

/// One number for all velocity, acceleration and jerk rows each; the bounds are (v, a h, j h^2).
[[nodiscard]] Rows row_fill(double v, double a, double j);

/// A quadratic model in the coefficients, five-diagonal, and h.
struct SegmentModel {
  Coefs diag{}, off1{}, off2{};  ///< off1[i] couples i with i + 1, off2[i] with i + 2
  Coefs with_h{};                ///< couples coefficient i with h
  Coefs grad{};
  double hh = 0, grad_h = 0;
  double a0_h = 0, a1_h = 0;  ///< from products of unknowns: end accelerations with h
};

/// Adds weight * (jerk row i)^2 / 2 at coefficients `c`, for every cell: the smoothness of a
/// motion.
[[nodiscard]] SegmentModel smoothness_model(const Coefs& c, double weight);

/// The log barrier of the rows with its Newton model of a primal-dual interior point method
/// (J. Nocedal and S. Wright, Numerical Optimization, 2nd ed., chapter 19).
/// @param mu         weight of the barrier, > 0.
/// @param rooms      taken for those of the rows, all > 0.
/// @param missed     the rows' own rooms less those taken for them.
/// @param curvature  1: the whole second derivative of the Lagrangian; 0: its convex part.
[[nodiscard]] SegmentModel barrier_model(const SegmentTask& task, const Shared& y, double mu,
                                         const RowPairs& rooms, const RowPairs& missed,
                                         const RowPairs& multipliers, double curvature);

/// A model with the inner coefficients eliminated, which follow as the best ones on the way.
struct Condensed {
  std::array<Shared, 5> m;  ///< symmetric, both halves filled
  Shared grad;

  Inner l0, l1, l2;               ///< Cholesky factor L of the inner part, l0 inverted
  std::array<Inner, 5> coupling;  ///< L^-1 (inner against shared)
  Inner ones, inner_grad;         ///< L^-1 1, L^-1 (gradient of the inner ones)
  Shared pull;                    ///< d(inner sum)/d(shared) + coupling^T ones
  double ones_ones, ones_grad;
};

/// @return false where the inner part is not positive definite.
[[nodiscard]] bool condense(const SegmentTask& task, const Shared& y, const SegmentModel& model,
                            Condensed& out);

/// Change of the inner coefficients that goes with `dy`.
[[nodiscard]] Inner inner_step(const Condensed& condensed, const Shared& dy);

}  // namespace mjarm::detail
