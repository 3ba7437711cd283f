#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/trajectory/path_torque_internal.hpp"
#include "mjarm/trajectory/peaks_internal.hpp"
#include "mjarm/trajectory/reference_internal.hpp"
#include "mjarm/trajectory/retime_internal.hpp"
#include "mjarm/trajectory/smooth_timing_internal.hpp"

namespace mjarm::detail {
namespace {

/// x', x'' and x''' of all joints where the reference is, by the cubic of one piece.
struct Derivatives {
  JointVec v, a, j;
};
Derivatives derivatives(const SplinePoint& p, const PathState& x) {
  return {p.d * x.v, p.d * x.a + p.e * (x.v * x.v),
          p.d * x.j + p.e * (3 * x.v * x.a) + p.f * (x.v * x.v * x.v)};
}

using RowVec = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxDof + 1, 1>;

/// Derivatives over the bound they are for, one row a joint and one for the path.
RowVec over(const JointVec& joints, const JointVec& bounds, double path, double path_bound) {
  RowVec all(joints.size() + 1);
  all << joints.cwiseQuotient(bounds), path / path_bound;
  return all;
}

void append(std::vector<double>& all, const RowVec& rows) {
  all.insert(all.end(), rows.begin(), rows.end());
}

/// Rows of jerks (x''', x'' and x') or of accelerations (x'' and x'), all over one bound.
struct TimingRows {
  RowVec lead, next, last;

  /// Takes over the rows of `other` with a larger lead, or by sign -1 a smaller one.
  void take(const TimingRows& other, double sign) {
    for (Eigen::Index r = 0; r < lead.size(); ++r) {
      if (sign * other.lead[r] <= sign * lead[r]) continue;
      lead[r] = other.lead[r];
      next[r] = other.next[r];
      if (last.size() > 0) last[r] = other.last[r];
    }
  }
};

/// Writes the problem of walking a reference in another time. A cell of the time law that spans
/// several samples has the extreme rows of them all.
class ProblemWriter {
 public:
  ProblemWriter(const CubicSpline& spline, const Reference& reference, const Bounds& bounds,
                const PathBounds& path)
      : spline_(spline), reference_(reference), bounds_(bounds), path_(path) {}

  RetimeProblem write() {
    const auto dof = static_cast<std::size_t>(spline_.dof());
    const std::vector<std::size_t>& law = reference_.law;
    spans_ = law.size() < reference_.tau.size();
    problem_.tau = reference_.tau;
    problem_.knots = law;
    problem_.rows = (spans_ ? 2 : 1) * (dof + 1);
    problem_.a_rows = problem_.rows + (bounds_.dynamics ? dof : 0);
    for (std::size_t k = 0; k < law.size(); ++k) {
      const std::size_t end = law[std::min(k + 1, law.size() - 1)];
      if (end > law[k]) add_jerks(law[k], end);
      add_knot(law[k], spans_ ? end : law[k]);
    }
    return std::move(problem_);
  }

 private:
  [[nodiscard]] TimingRows jerks(std::size_t i, std::size_t piece) const {
    const PathState& x = reference_.states[i];
    const Derivatives d = derivatives(spline_.at(x.s, piece), x);
    return {over(d.j, bounds_.j, x.j, path_.jerk), over(d.a, bounds_.j, x.a, path_.jerk),
            over(d.v, bounds_.j, x.v, path_.jerk)};
  }

  /// Rows of jerks at both ends of the cell between two samples.
  void add_jerks(std::size_t from, std::size_t to) {
    const TimingRows first = jerks(from, reference_.piece[from]);
    if (!spans_) {
      append_jerks(first);
      append_jerks(jerks(to, reference_.piece[from]));
      return;
    }
    TimingRows high = first, low = first;
    for (std::size_t i = from; i < to; ++i) {
      for (const std::size_t end : {i, i + 1}) {
        const TimingRows rows = jerks(end, reference_.piece[i]);
        high.take(rows, 1);
        low.take(rows, -1);
      }
    }
    for (const TimingRows* rows : {&high, &low, &high, &low}) append_jerks(*rows);
  }
  void append_jerks(const TimingRows& rows) {
    append(problem_.j_j, rows.lead);
    append(problem_.a_j, rows.next);
    append(problem_.v_j, rows.last);
  }

  /// What else holds at the samples [from, to], as rows of the first.
  void add_knot(std::size_t from, std::size_t to) {
    TimingRows high, low;
    double u_max = 0;
    for (std::size_t i = from; i <= to; ++i) {
      const PathState& x = reference_.states[i];
      const SplinePoint p = spline_.at(x.s, reference_.piece[i]);
      const Derivatives d = derivatives(p, x);
      const TimingRows rows{over(d.a, bounds_.a, x.a, path_.acceleration),
                            over(d.v, bounds_.a, x.v, path_.acceleration),
                            {}};
      const double use =
          std::max(d.v.cwiseAbs().cwiseQuotient(bounds_.v).maxCoeff(), x.v / path_.speed_at(x.s));
      const double u = 1 / (use * use);
      if (i == from) {
        high = low = rows;
        u_max = u;
      }
      high.take(rows, 1);
      low.take(rows, -1);
      u_max = std::min(u_max, u);
    }
    append(problem_.a_a, high.lead);
    append(problem_.v_a, high.next);
    if (spans_) {
      append(problem_.a_a, low.lead);
      append(problem_.v_a, low.next);
    }
    problem_.root_a.resize(problem_.a_a.size(), 0.0);
    problem_.still.resize(problem_.a_a.size(), 0.0);
    if (bounds_.dynamics) add_torques(from);
    problem_.u_max.push_back(u_max);
  }

  void add_torques(std::size_t i) {
    const PathState& x = reference_.states[i];
    const TorqueTerms terms = torque_terms(bounds_.dynamics, spline_.at(x.s, reference_.piece[i]));
    const JointVec& limit = bounds_.torque;
    for (Eigen::Index r = 0; r < limit.size(); ++r) {
      problem_.a_a.push_back((terms.by_a[r] * x.a + terms.by_u[r] * x.v * x.v) / limit[r]);
      problem_.v_a.push_back(terms.by_a[r] * x.v / limit[r]);
      problem_.root_a.push_back(terms.viscous[r] * x.v / limit[r]);
      problem_.still.push_back((terms.still[r] + terms.dry[r]) / limit[r]);
    }
  }

  const CubicSpline& spline_;
  const Reference& reference_;
  const Bounds& bounds_;
  const PathBounds& path_;
  bool spans_ = false;  // whether cells span several samples
  RetimeProblem problem_;
};

/// By which factor the way along the path is too fast; <= 1 where it keeps its bounds.
double excess(const Reference& reference, const TimeLaw& law, const PathBounds& bounds) {
  double max = 0;
  for (std::size_t i = 0; i < law.t.size(); ++i) {
    const PathState& x = reference.states[i];
    max = std::max(
        {max, x.v * std::sqrt(law.u[i]) / bounds.speed_at(x.s),
         std::sqrt(std::abs(x.a * law.u[i] + 0.5 * x.v * law.du[i]) / bounds.acceleration)});
  }
  return max;
}

/// The reference walked by a time law.
Result<Trajectory> walked(const CubicSpline& spline, const Reference& reference,
                          const TimeLaw& law) {
  std::vector<JointState> knots;
  knots.reserve(law.t.size());
  for (std::size_t i = 0; i < law.t.size(); ++i) {
    const SplinePoint p = spline.at(reference.states[i].s, reference.piece[i]);
    const Derivatives d = derivatives(p, reference.states[i]);
    knots.push_back({p.q, d.v * std::sqrt(law.u[i]), d.a * law.u[i] + 0.5 * law.du[i] * d.v});
  }
  const JointVec zero = JointVec::Zero(spline.dof());
  for (JointState* end : {&knots.front(), &knots.back()}) end->v = end->a = zero;
  return Trajectory::through(law.t, knots);
}

}  // namespace

Result<Trajectory> time_smoothly(const CubicSpline& spline, const Bounds& bounds,
                                 const PathBounds& path_bounds) {
  constexpr std::size_t kSpeedCells = 800;  // of the path for the reference
  constexpr double kWindow = 120;           // cells of the time law
  const Result<SpeedProfile> fastest = fastest_profile(spline, kSpeedCells, bounds, path_bounds);
  if (!fastest) return fail(fastest.error());
  const SpeedProfile& profile = *fastest;
  // So long that the reference is smooth compared with the cells, as the time law has to be; and
  // that its jerks are of the size allowed.
  const double ramp = std::max(bounds.a.cwiseQuotient(bounds.j).maxCoeff(),
                               path_bounds.acceleration / path_bounds.jerk);
  const double cells = law_cells(spline);
  const double window =
      std::min(std::max(2 * ramp, kWindow * profile.duration() / cells), 0.5 * profile.duration());
  const SmoothProfile smooth(profile, window);
  const Reference reference = reference_along(spline, smooth, profile, window, cells);
  const TimeLaw law = retime(ProblemWriter(spline, reference, bounds, path_bounds).write());
  Result<Trajectory> motion = walked(spline, reference, law);
  if (!motion) return fail(motion.error());
  const double factor = std::max(peaks_of(*motion, bounds, true).stretch(bounds),
                                 excess(reference, law, path_bounds));
  return std::move(*motion).stretched(factor);
}

}  // namespace mjarm::detail
