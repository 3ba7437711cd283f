#include "mjarm/trajectory/trajectory.hpp"

#include <algorithm>
#include <array>
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

/// Writes the coefficients of the quintic from `from`, with acceleration `a` there, to `to` in `h`
/// seconds.
void fit_quintic(const JointState& from, const JointVec& a, const JointState& to, double h,
                 double* c) {
  const Eigen::Index dof = a.size();
  const double h2 = h * h, h3 = h2 * h;
  for (Eigen::Index j = 0; j < dof; ++j) {
    // What the parabola of the first state misses of the second, in units of h.
    const double dq = to.q[j] - from.q[j] - h * (from.v[j] + 0.5 * h * a[j]);
    const double dv = h * (to.v[j] - from.v[j] - h * a[j]);
    const double da = h2 * (to.a[j] - a[j]);
    double* const cj = c + j;
    cj[0] = from.q[j];
    cj[dof] = from.v[j];
    cj[2 * dof] = 0.5 * a[j];
    cj[3 * dof] = (10 * dq - 4 * dv + 0.5 * da) / h3;
    cj[4 * dof] = (-15 * dq + 7 * dv - da) / (h3 * h);
    cj[5 * dof] = (6 * dq - 3 * dv + 0.5 * da) / (h3 * h2);
  }
}

/// State after `h` seconds of constant jerk.
JointState advanced(const JointState& x, const JointVec& jerk, double h) {
  return {x.q + h * (x.v + h * (0.5 * x.a + h / 6 * jerk)), x.v + h * (x.a + 0.5 * h * jerk),
          x.a + h * jerk};
}

}  // namespace

Result<Trajectory> Trajectory::through(const std::vector<double>& times,
                                       const std::vector<JointState>& knots) {
  std::vector<JointVec> a_after;
  a_after.reserve(knots.size());
  for (const JointState& knot : knots) a_after.push_back(knot.a);
  return through(times, knots, a_after);
}

Result<Trajectory> Trajectory::through(const std::vector<double>& times,
                                       const std::vector<JointState>& knots,
                                       const std::vector<JointVec>& a_after) {
  if (times.empty() || times.size() != knots.size() || knots.size() != a_after.size() ||
      times[0] != 0) {
    return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
  }
  const Eigen::Index dof = knots[0].q.size();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!sound(knots[i], dof) || a_after[i].size() != dof || !a_after[i].allFinite() ||
        !std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1]))) {
      return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
    }
  }
  Trajectory trajectory;
  trajectory.starts_.assign(times.begin(), times.end() - 1);
  const auto stride = static_cast<std::size_t>(6 * dof);
  trajectory.c_.resize(trajectory.starts_.size() * stride);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    fit_quintic(knots[i], a_after[i], knots[i + 1], times[i + 1] - times[i],
                &trajectory.c_[i * stride]);
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
    const JointVec half_a = 0.5 * state.a, sixth_j = jerks[i] / 6, zero = JointVec::Zero(dof);
    trajectory.starts_.push_back(trajectory.duration_);
    const std::array<const JointVec*, 6> c{&state.q, &state.v, &half_a, &sixth_j, &zero, &zero};
    for (const JointVec* ck : c) {
      trajectory.c_.insert(trajectory.c_.end(), ck->begin(), ck->end());
    }
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
    for (const double start : leg.starts_) whole.starts_.push_back(whole.duration_ + start);
    whole.c_.insert(whole.c_.end(), leg.c_.begin(), leg.c_.end());
    whole.last_ = leg.last_;
    whole.duration_ += leg.duration_;
  }
  return whole;
}

double Trajectory::duration() const noexcept { return duration_; }

int Trajectory::dof() const noexcept { return static_cast<int>(last_.q.size()); }

Trajectory::Piece Trajectory::piece(std::size_t i) const {
  const double end = i + 1 < starts_.size() ? starts_[i + 1] : duration_;
  const Eigen::Index size = 6 * last_.q.size();
  return {starts_[i],
          end - starts_[i],
          {c_.data() + static_cast<Eigen::Index>(i) * size, last_.q.size(), 6}};
}

Trajectory Trajectory::stretched(double factor) const {
  Trajectory slow = *this;
  slow.duration_ *= factor;
  for (double& start : slow.starts_) start *= factor;
  for (JointState* state : {&slow.first_, &slow.last_}) {
    state->v /= factor;
    state->a /= factor * factor;
  }
  const auto dof = static_cast<std::size_t>(last_.q.size());
  for (std::size_t i = 0; i < c_.size();) {
    double share = 1;
    for (int k = 0; k < 6; ++k, share /= factor) {
      for (std::size_t j = 0; j < dof; ++j) slow.c_[i++] *= share;
    }
  }
  return slow;
}

JointState Trajectory::at(double t) const {
  if (t < 0) return rest_at(first_.q);
  if (t > duration_) return rest_at(last_.q);
  if (t == duration_ || starts_.empty()) return last_;
  const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), t);
  const Piece p = piece(static_cast<std::size_t>(after - starts_.begin()) - 1);
  const double x = t - p.start;
  const auto c = [&](int k) { return p.c.col(k); };
  return {c(0) + x * (c(1) + x * (c(2) + x * (c(3) + x * (c(4) + x * c(5))))),
          c(1) + x * (2 * c(2) + x * (3 * c(3) + x * (4 * c(4) + x * 5 * c(5)))),
          2 * c(2) + x * (6 * c(3) + x * (12 * c(4) + x * 20 * c(5)))};
}

}  // namespace mjarm
