#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/trajectory/path_torque_internal.hpp"
#include "mjarm/trajectory/peaks_internal.hpp"
#include "mjarm/trajectory/retime_internal.hpp"
#include "mjarm/trajectory/smooth_profile_internal.hpp"
#include "mjarm/trajectory/smooth_timing_internal.hpp"

namespace mjarm::detail {
namespace {

/// Cells of the time law: many between two waypoints, as far as there are not too many of those.
double time_cells(const CubicSpline& spline) {
  constexpr double kFewest = 400, kEach = 40, kMost = 1500;
  const auto pieces = static_cast<double>(spline.knots().size() - 1);
  return std::max(std::clamp(kEach * pieces, kFewest, kMost), pieces);
}

/// A reference motion along the path, sampled where the time law has its knots.
struct Reference {
  std::vector<double> tau;         // [s]
  std::vector<PathState> states;   // there
  std::vector<std::size_t> piece;  // of the spline, after each knot (the last: before it)
};

/// Time at which `smooth` meets `s`, within [from, to]: Newton's method kept between bounds.
double time_of(const SmoothProfile& smooth, double s, double from, double to) {
  double t = 0.5 * (from + to);
  for (int k = 0; k < 60 && to - from > 1e-14 * to; ++k) {
    const PathState x = smooth.at(t);
    if (x.s == s) return t;
    (x.s < s ? from : to) = t;
    const double next = t - (x.s - s) / x.v;
    const bool inside = next > from && next < to;
    if (inside && std::abs(next - t) < 1e-15 * to) return next;
    t = inside ? next : 0.5 * (from + to);
  }
  return t;
}

Reference reference_along(const CubicSpline& spline, const SmoothProfile& smooth,
                          const SpeedProfile& profile, double window, double cells) {
  const std::vector<double>& knots = spline.knots();
  const double longest = smooth.duration() / cells;
  const double fewest = 2 * static_cast<double>(knots.size()) > cells ? 1 : 2;
  Reference reference;
  double from = 0;
  std::size_t cell = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    double to = smooth.duration();
    if (i + 2 < knots.size()) {
      // The profile meets it there, the smoothed one at most a window later.
      while (profile.s[cell] < knots[i + 1]) ++cell;
      to = time_of(smooth, knots[i + 1], std::max(from, profile.t[cell]), profile.t[cell] + window);
    }
    const double count = std::max(fewest, std::ceil((to - from) / longest));
    for (int k = 0; k < count; ++k) {
      reference.tau.push_back(from + (to - from) * k / count);
      reference.states.push_back(smooth.at(reference.tau.back()));
      if (k == 0) reference.states.back().s = knots[i];
      reference.piece.push_back(i);
    }
    from = to;
  }
  reference.tau.push_back(from);
  reference.states.push_back({spline.end(), 0, 0, smooth.at(from).j});
  reference.piece.push_back(knots.size() - 2);
  return reference;
}

/// x', x'' and x''' of all joints where the reference is, by the cubic of one piece.
struct Derivatives {
  JointVec v, a, j;
};
Derivatives derivatives(const SplinePoint& p, const PathState& x) {
  return {p.d * x.v, p.d * x.a + p.e * (x.v * x.v),
          p.d * x.j + p.e * (3 * x.v * x.a) + p.f * (x.v * x.v * x.v)};
}

/// Appends one row a joint and one for the path.
void append(std::vector<double>& rows, const JointVec& joints, const JointVec& bounds, double path,
            double path_bound) {
  for (Eigen::Index r = 0; r < joints.size(); ++r) rows.push_back(joints[r] / bounds[r]);
  rows.push_back(path / path_bound);
}

/// Appends the rows of torques.
void append_torques(RetimeProblem& problem, const TorqueTerms& terms, const PathState& x,
                    const JointVec& limit) {
  for (Eigen::Index r = 0; r < limit.size(); ++r) {
    problem.a_a.push_back((terms.by_a[r] * x.a + terms.by_u[r] * x.v * x.v) / limit[r]);
    problem.v_a.push_back(terms.by_a[r] * x.v / limit[r]);
    problem.root_a.push_back(terms.viscous[r] * x.v / limit[r]);
    problem.still.push_back((terms.still[r] + terms.dry[r]) / limit[r]);
  }
}

RetimeProblem problem_of(const CubicSpline& spline, const Reference& reference,
                         const Bounds& bounds, const PathBounds& path) {
  RetimeProblem problem;
  const auto dof = static_cast<std::size_t>(spline.dof());
  problem.rows = dof + 1;
  problem.a_rows = problem.rows + (bounds.dynamics ? dof : 0);
  problem.tau = reference.tau;
  const std::size_t n = reference.tau.size();
  for (std::size_t i = 0; i < n; ++i) {
    const PathState& x = reference.states[i];
    const auto add_jerks = [&](const Derivatives& d) {
      append(problem.j_j, d.j, bounds.j, x.j, path.jerk);
      append(problem.a_j, d.a, bounds.j, x.a, path.jerk);
      append(problem.v_j, d.v, bounds.j, x.v, path.jerk);
    };
    const SplinePoint p = spline.at(x.s, reference.piece[i]);
    const Derivatives d = derivatives(p, x);
    if (i > 0) add_jerks(derivatives(spline.at(x.s, reference.piece[i - 1]), x));
    if (i + 1 < n) add_jerks(d);
    append(problem.a_a, d.a, bounds.a, x.a, path.acceleration);
    append(problem.v_a, d.v, bounds.a, x.v, path.acceleration);
    problem.root_a.resize(problem.a_a.size(), 0.0);
    problem.still.resize(problem.a_a.size(), 0.0);
    if (bounds.dynamics) {
      append_torques(problem, torque_terms(bounds.dynamics, p), x, bounds.torque);
    }
    const double use =
        std::max(d.v.cwiseAbs().cwiseQuotient(bounds.v).maxCoeff(), x.v / path.speed);
    problem.u_max.push_back(1 / (use * use));
  }
  return problem;
}

/// By which factor the way along the path is too fast; <= 1 where it keeps its bounds.
double excess(const Reference& reference, const TimeLaw& law, const PathBounds& bounds) {
  double most = 0;
  for (std::size_t i = 0; i < law.t.size(); ++i) {
    const PathState& x = reference.states[i];
    most = std::max(
        {most, x.v * std::sqrt(law.u[i]) / bounds.speed,
         std::sqrt(std::abs(x.a * law.u[i] + 0.5 * x.v * law.du[i]) / bounds.acceleration)});
  }
  return most;
}

}  // namespace

Result<Trajectory> time_smoothly(const CubicSpline& spline, const Bounds& bounds,
                                 const PathBounds& path_bounds) {
  constexpr std::size_t kSpeedCells = 800;  // of the path for the reference
  constexpr double kWindow = 120;           // cells of the time law
  constexpr double kMostWork = 3e7;         // cells of the reference in all windows at waypoints
  const Result<SpeedProfile> fastest = fastest_profile(spline, kSpeedCells, bounds, path_bounds);
  if (!fastest) return fail(fastest.error());
  const SpeedProfile& profile = *fastest;
  // So long that the reference is smooth compared with the cells, as the time law has to be; and
  // that its jerks are of the size allowed.
  const double ramp = std::max(bounds.a.cwiseQuotient(bounds.j).maxCoeff(),
                               path_bounds.acceleration / path_bounds.jerk);
  const double cells = time_cells(spline);
  // And no longer than can be averaged over at every waypoint in a few seconds.
  const double affordable = kMostWork / (static_cast<double>(profile.s.size()) *
                                         static_cast<double>(spline.knots().size()));
  const double window = std::min(std::max(2 * ramp, kWindow * profile.duration() / cells),
                                 std::min(0.5, affordable) * profile.duration());
  const SmoothProfile smooth(profile, window);
  const Reference reference = reference_along(spline, smooth, profile, window, cells);
  const TimeLaw law = retime(problem_of(spline, reference, bounds, path_bounds));

  std::vector<JointState> knots;
  knots.reserve(law.t.size());
  for (std::size_t i = 0; i < law.t.size(); ++i) {
    const SplinePoint p = spline.at(reference.states[i].s, reference.piece[i]);
    const Derivatives d = derivatives(p, reference.states[i]);
    knots.push_back({p.q, d.v * std::sqrt(law.u[i]), d.a * law.u[i] + 0.5 * law.du[i] * d.v});
  }
  const JointVec zero = JointVec::Zero(spline.dof());
  for (JointState* end : {&knots.front(), &knots.back()}) end->v = end->a = zero;
  Result<Trajectory> motion = Trajectory::through(law.t, knots);
  if (!motion) return fail(motion.error());
  const double factor = std::max(peaks_of(*motion, bounds, true).stretch(bounds),
                                 excess(reference, law, path_bounds));
  return std::move(*motion).stretched(factor);
}

}  // namespace mjarm::detail
