#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/general_six_internal.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace detail {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kFlag = GeneralRows::kFlag;
constexpr int kEquations = kFlag - 1;  // the last part of every flag is 1
constexpr double kDependent = 1e-6;    // singular values below, of the largest: the joints 2 and 3
                                       // cannot be told from the equations
constexpr double kNoRank = 1e-8;       // pivots below, of the largest, are rounding
constexpr double kNoSeries = 1e-6;     // with more noise the determinant is no series
constexpr double kSteep = 1e-4;        // with more there is no need to look from the tool
constexpr int kRankProbes = 10;        // poses by which the rank is found
constexpr int kSlopeProbes = 8;        // poses by which the two ways are weighed

Matrix3d cross(const Vector3d& v) {
  Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

/// How flags move. The flag of a line of direction h through the point p is h, p x h, p^2 h -
/// 2 (p h) p, p h, p, p^2, 1: all that the equations of Raghavan and Roth are made of. Under a
/// motion X each part changes linearly: flag of X * line = motion(X) flag.
MatrixXd motion(const Pose& X) {
  MatrixXd out = MatrixXd::Zero(kFlag, kFlag);
  const Matrix3d T = cross(X.p);
  const double p2 = X.p.squaredNorm();
  for (const int i : {0, 3, 6, 10}) out.block<3, 3>(i, i) = X.R;
  out.block<3, 3>(3, 0) = T * X.R;
  out.block<3, 3>(6, 0) = (p2 * Matrix3d::Identity() - 2 * X.p * X.p.transpose()) * X.R;
  out.block<3, 3>(6, 3) = -2 * T * X.R;
  out.block<3, 1>(6, 9) = -2 * X.p;
  out.block<1, 3>(9, 0) = X.p.transpose() * X.R;
  out.block<3, 1>(10, 14) = X.p;
  out.block<1, 3>(13, 10) = 2 * X.p.transpose() * X.R;
  out(9, 9) = out(13, 13) = out(14, 14) = 1;
  out(13, 14) = p2;
  return out;
}

/// The derivative of motion() at the identity along a small turn and shift.
MatrixXd generator(const Vector3d& turn, const Vector3d& shift) {
  MatrixXd out = MatrixXd::Zero(kFlag, kFlag);
  for (const int i : {0, 3, 6, 10}) out.block<3, 3>(i, i) = cross(turn);
  out.block<3, 3>(3, 0) = cross(shift);
  out.block<3, 3>(6, 3) = -2 * cross(shift);
  out.block<3, 1>(6, 9) = -2 * shift;
  out.block<1, 3>(9, 0) = shift.transpose();
  out.block<3, 1>(10, 14) = shift;
  out.block<1, 3>(13, 10) = 2 * shift.transpose();
  return out;
}

/// motion() of a turn about z is part[0] + cos part[1] + sin part[2].
struct TurnParts {
  MatrixXd part[3] = {MatrixXd::Identity(kFlag, kFlag), MatrixXd::Zero(kFlag, kFlag),
                      MatrixXd::Zero(kFlag, kFlag)};

  /// `sign` -1: of the turn back.
  explicit TurnParts(int sign) {
    for (const int i : {0, 3, 6, 10}) {
      part[1](i, i) = part[1](i + 1, i + 1) = 1;
      part[2](i + 1, i) = sign;
      part[2](i, i + 1) = -sign;
    }
    part[0] -= part[1];
  }
};

/// The flag of axis 1 seen from the frame before joint 4, without its last part: `constant` plus
/// `factors` (14 x 8) times cos q3, sin q3, cos q2, cos q2 cos q3, cos q2 sin q3, sin q2, sin q2
/// cos q3, sin q2 sin q3.
struct NearSide {
  VectorXd constant;
  MatrixXd factors;
};

/// motion() in units of `g.length`.
MatrixXd link_motion(const GeneralGeometry& g, Pose X) {
  X.p /= g.length;
  return motion(X);
}

/// `between`: what is to be done to flags between the joints 2 and 3.
NearSide near_side(const GeneralGeometry& g, const MatrixXd& between) {
  const TurnParts back(-1);
  VectorXd axis = VectorXd::Zero(kFlag);
  axis[2] = axis[14] = 1;
  const VectorXd first = link_motion(g, g.chain.X_PJ[1].inverse()) * axis;
  const MatrixXd to3 = between * link_motion(g, g.chain.X_PJ[2].inverse());
  const MatrixXd to4 = link_motion(g, g.chain.X_PJ[3].inverse());
  NearSide out{VectorXd(), MatrixXd(kEquations, 8)};
  for (int k2 = 0; k2 < 3; ++k2) {
    for (int k3 = 0; k3 < 3; ++k3) {
      const VectorXd flag = to4 * back.part[k3] * (to3 * (back.part[k2] * first));
      if (k2 + k3 == 0) {
        out.constant = flag.head(kEquations);
      } else {
        out.factors.col(3 * k2 + k3 - 1) = flag.head(kEquations);
      }
    }
  }
  return out;
}

/// The rows of left (10 x 15) times the flag seen from the frame before joint 4.
GeneralRows rows_of(const GeneralGeometry& g, const MatrixXd& left) {
  const TurnParts turn(1);
  const MatrixXd to5 = link_motion(g, g.chain.X_PJ[4]);
  const MatrixXd to6 = link_motion(g, g.chain.X_PJ[5]);
  GeneralRows out;
  for (int k4 = 0; k4 < 3; ++k4) {
    for (int k5 = 0; k5 < 3; ++k5) {
      const MatrixXd rows = left * turn.part[k4] * to5 * turn.part[k5] * to6;
      for (int r = 0; r < GeneralRows::kCount; ++r) {
        for (int i = 0; i < kFlag; ++i) out.part[i][9 * r + 3 * k4 + k5] = rows(r, i);
      }
    }
  }
  return out;
}

/// The arm's rows: what joints 2 and 3 cannot change, and what they do; and, for where rank is
/// lacking, how they change while the link between the joints 2 and 3 turns and shifts somehow.
bool set_rows(GeneralGeometry& g) {
  const NearSide near = near_side(g, MatrixXd::Identity(kFlag, kFlag));
  const SingularValues svd = singular_values(near.factors);
  if (svd.values[7] < kDependent * svd.values[0]) return false;
  const MatrixXd N = null_space(near.factors.transpose()).transpose();  // 6 x 14
  const MatrixXd inverse =
      svd.V * svd.values.cwiseInverse().asDiagonal() * svd.U.transpose();  // 8 x 14
  MatrixXd left(GeneralRows::kCount, kFlag);
  left.topLeftCorner(6, kEquations) = N;
  const int wanted[4] = {2, 5, 0, 1};  // cos and sin of joint 2, of joint 3
  for (int i = 0; i < 4; ++i) left.row(6 + i).head(kEquations) = inverse.row(wanted[i]);
  left.col(kEquations) = -left.leftCols(kEquations) * near.constant;
  g.rows.push_back(rows_of(g, left));
  // N factors = 0 and N inverse^T = 0 remain so.
  const NearSide slope = near_side(g, generator({0.7, -0.4, 0.9}, {-0.5, 0.8, 0.3}));
  const MatrixXd dN = -N * slope.factors * inverse;
  MatrixXd change = MatrixXd::Zero(GeneralRows::kCount, kFlag);
  change.topLeftCorner(6, kEquations) = dN;
  change.col(kEquations).head(6) = -dN * near.constant - N * slope.constant;
  g.rows.push_back(rows_of(g, change));
  return true;
}

/// The matrix of the kernels' determinant.
MatrixXd matrix_at(const GeneralEquations& equations, double q4) {
  MatrixXd out(12, 12);
  const double c4 = std::cos(q4), s4 = std::sin(q4);
  for (int r = 0; r < 6; ++r) {
    for (int k6 = 0; k6 < 3; ++k6) {
      const double* const e = equations.at[k6] + 9 * r;
      const auto at = [&](int k5) { return e[k5] + c4 * e[3 + k5] + s4 * e[6 + k5]; };
      const double e0 = at(0), c = 0.5 * at(1), s = 0.5 * at(2);
      const double rows[2][4] = {{e0 + c, s, c, s}, {s, e0 - c, -s, c}};
      for (int m = 0; m < 4; ++m) {
        out(2 * r, 3 * m + k6) = rows[0][m];
        out(2 * r + 1, 3 * m + k6) = rows[1][m];
      }
    }
  }
  return out;
}

/// A pose that the arm reaches.
struct Probe {
  double q[6];
  Pose X_WT;

  Probe(const Chain& chain, Rng& rng) {
    for (double& value : q) value = rng.uniform(-std::numbers::pi, std::numbers::pi);
    X_WT = chain.fk(q);
  }
};

/// How far the parts of a null space in the columns of a set are from dependent.
double independence(const MatrixXd& space, unsigned set, int count) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, GeneralGeometry::kMostLacking,
                GeneralGeometry::kMostLacking>
      part(count, count);
  int row = 0;
  for (int i = 0; i < 12; ++i) {
    if ((set >> i & 1U) != 0) part.row(row++) = space.row(i).head(count);
  }
  return std::abs(part.determinant());
}

/// Puts those columns last in which the null spaces are farthest from dependent; in the second
/// order where those of the first are near it.
void set_orders(const std::vector<MatrixXd>& spaces, GeneralGeometry& g) {
  std::vector<double> reached(spaces.size(), 0.0);
  for (auto& column : g.column) {
    double best = -1;
    unsigned chosen = 0;
    for (unsigned set = 0; set < 1U << 12; ++set) {
      if (std::popcount(set) != g.lacking) continue;
      double least = 1;
      for (std::size_t i = 0; i < spaces.size() && least > best; ++i) {
        least = std::min(least, std::max(reached[i], independence(spaces[i], set, g.lacking)));
      }
      if (least <= best) continue;
      best = least;
      chosen = set;
    }
    for (std::size_t i = 0; i < spaces.size(); ++i) {
      reached[i] = std::max(reached[i], independence(spaces[i], chosen, g.lacking));
    }
    int first = 0, last = 12 - g.lacking;
    for (int i = 0; i < 12; ++i) column[i] = (chosen >> i & 1U) != 0 ? last++ : first++;
  }
}

/// Finds the rank that is lacking at every pose.
bool set_rank(GeneralGeometry& g) {
  Rng rng(11);
  std::vector<MatrixXd> spaces;
  g.lacking = 12;
  for (int i = 0; i < kRankProbes; ++i) {
    const Probe probe(g.chain, rng);
    GeneralEquations equations;
    set_equations(g, g.rows.front(), probe.X_WT, equations);
    spaces.push_back(null_space(matrix_at(equations, rng.uniform(-3, 3)), kNoRank));
    g.lacking = std::min(g.lacking, static_cast<int>(spaces.back().cols()));
    if (g.lacking == 0) break;
  }
  if (g.lacking > GeneralGeometry::kMostLacking) return false;
  set_orders(spaces, g);
  if (g.lacking == 0) g.rows.pop_back();
  return true;
}

/// How steeply the determinant crosses 0 at answers, of its largest value: the second lowest of a
/// few poses; 0 where it does not tell the answers apart.
double steepness(const GeneralGeometry& g) {
  Rng rng(12);
  double slopes[kSlopeProbes];
  for (double& slope : slopes) {
    const Probe probe(g.chain, rng);
    GeneralEquations equations;
    set_equations(g, g.rows.front(), probe.X_WT, equations);
    const TrigSeries series = determinant_series(g, equations, probe.X_WT);
    const bool fine = series.noise < kNoSeries;
    slope = fine ? std::abs(series.at(probe.q[3]).slope) / series.largest : 0;
  }
  std::sort(std::begin(slopes), std::end(slopes));
  return slopes[1];
}

/// The arm seen from its tool: joint values are those of `chain`, negative and in reverse.
Chain reverse(const Chain& chain) {
  Chain out = chain;
  out.X_PJ[0] = chain.X_JT.inverse();
  for (std::size_t i = 1; i < 6; ++i) out.X_PJ[i] = chain.X_PJ[6 - i].inverse();
  out.X_JT = chain.X_PJ[0].inverse();
  return out;
}

/// One way to look at the arm, and how good it is.
struct View {
  GeneralGeometry geometry;
  double steepness = 0;

  explicit View(const Chain& chain) : geometry(chain) {
    geometry.length = characteristic_length(chain);
    if (set_rows(geometry) && set_rank(geometry)) steepness = detail::steepness(geometry);
  }
};

}  // namespace
}  // namespace detail

std::optional<GeneralSix> GeneralSix::recognise(const Chain& chain) {
  const auto& slide = chain.slide;
  if (chain.dof != 6 || std::find(slide.begin(), slide.end(), true) != slide.end()) return {};
  detail::View ahead(chain);
  if (ahead.steepness > detail::kSteep) return GeneralSix(std::move(ahead.geometry), false);
  detail::View back(detail::reverse(chain));
  const bool reversed = back.steepness > ahead.steepness;
  detail::View& best = reversed ? back : ahead;
  if (best.steepness == 0) return std::nullopt;
  return GeneralSix(std::move(best.geometry), reversed);
}

}  // namespace mjarm
