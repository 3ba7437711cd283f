#include "mjarm/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/trajectory.hpp"

namespace mjarm {
namespace {

constexpr double kJoined = 1e-9;  // [rad or m] between the end of a leg and the start of the next

bool sound(const JointState& state, Eigen::Index dof) {
  return dof > 0 && state.q.size() == dof && state.v.size() == dof && state.a.size() == dof &&
         state.q.allFinite() && state.v.allFinite() && state.a.allFinite();
}

JointState rest_at(const JointVec& q) {
  return {q, JointVec::Zero(q.size()), JointVec::Zero(q.size())};
}

/// Coefficients of the quintic from `from` to `to` in `h` seconds.
void fit_quintic(const JointState& from, const JointState& to, double h, JointVec (&c)[6]) {
  // What the parabola of the first state misses of the second, in units of h.
  const JointVec dq = to.q - from.q - h * (from.v + 0.5 * h * from.a);
  const JointVec dv = h * (to.v - from.v - h * from.a);
  const JointVec da = h * h * (to.a - from.a);
  const double h3 = h * h * h;
  c[0] = from.q;
  c[1] = from.v;
  c[2] = 0.5 * from.a;
  c[3] = (10 * dq - 4 * dv + 0.5 * da) / h3;
  c[4] = (-15 * dq + 7 * dv - da) / (h3 * h);
  c[5] = (6 * dq - 3 * dv + 0.5 * da) / (h3 * h * h);
}

/// State after `h` seconds of constant jerk.
JointState advanced(const JointState& x, const JointVec& jerk, double h) {
  return {x.q + h * (x.v + h * (0.5 * x.a + h / 6 * jerk)), x.v + h * (x.a + 0.5 * h * jerk),
          x.a + h * jerk};
}

}  // namespace

Result<Trajectory> Trajectory::through(const std::vector<double>& times,
                                       const std::vector<JointState>& knots) {
  if (times.empty() || times.size() != knots.size() || times[0] != 0) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
  }
  const Eigen::Index dof = knots[0].q.size();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!sound(knots[i], dof) || !std::isfinite(times[i]) ||
        (i > 0 && !(times[i] > times[i - 1]))) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
    }
  }
  Trajectory trajectory;
  trajectory.pieces_.resize(times.size() - 1);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    trajectory.pieces_[i].start = times[i];
    fit_quintic(knots[i], knots[i + 1], times[i + 1] - times[i], trajectory.pieces_[i].c);
  }
  trajectory.first_ = knots.front();
  trajectory.last_ = knots.back();
  trajectory.duration_ = times.back();
  return trajectory;
}

Result<Trajectory> Trajectory::from_jerks(const JointState& start,
                                          std::span<const double> durations,
                                          std::span<const JointVec> jerks, const JointState& end) {
  const Eigen::Index dof = start.q.size();
  bool good = durations.size() == jerks.size() && sound(start, dof) && sound(end, dof);
  for (std::size_t i = 0; good && i < durations.size(); ++i) {
    good = std::isfinite(durations[i]) && durations[i] >= 0 && jerks[i].size() == dof &&
           jerks[i].allFinite();
  }
  if (!good) return fail(Errc::bad_input, text(msg::trajectory_bad_knots));

  Trajectory trajectory;
  JointState state = start;
  for (std::size_t i = 0; i < durations.size(); ++i) {
    if (durations[i] == 0) continue;
    const JointVec zero = JointVec::Zero(dof);
    trajectory.pieces_.push_back(
        {trajectory.duration_, {state.q, state.v, 0.5 * state.a, jerks[i] / 6, zero, zero}});
    state = advanced(state, jerks[i], durations[i]);
    trajectory.duration_ += durations[i];
  }
  trajectory.first_ = start;
  trajectory.last_ = end;
  return trajectory;
}

Result<Trajectory> Trajectory::chain(std::span<const Trajectory> legs) {
  if (legs.empty()) return fail(Errc::bad_input, text(msg::trajectory_bad_chain));
  Trajectory whole = legs[0];
  for (const Trajectory& leg : legs.subspan(1)) {
    if (leg.dof() != whole.dof() ||
        (leg.first_.q - whole.last_.q).lpNorm<Eigen::Infinity>() > kJoined) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_chain));
    }
    for (Piece piece : leg.pieces_) {
      piece.start += whole.duration_;
      whole.pieces_.push_back(std::move(piece));
    }
    whole.last_ = leg.last_;
    whole.duration_ += leg.duration_;
  }
  return whole;
}

double Trajectory::duration() const noexcept { return duration_; }

int Trajectory::dof() const noexcept { return static_cast<int>(last_.q.size()); }

JointState Trajectory::at(double t) const {
  if (t < 0) return rest_at(first_.q);
  if (t > duration_) return rest_at(last_.q);
  if (t == duration_ || pieces_.empty()) return last_;
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                      [](double value, const Piece& p) { return value < p.start; });
  const Piece& piece = *(after - 1);
  const double x = t - piece.start;
  const JointVec(&c)[6] = piece.c;
  return {c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
          c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))),
          2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5]))};
}

}  // namespace mjarm
