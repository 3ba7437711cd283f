#include "mjarm/trajectory/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/sound_state_internal.hpp"

namespace mjarm {

double TimingOptions::speed_at(double s) const noexcept {
  const auto above =
      std::upper_bound(tool_speeds.begin(), tool_speeds.end(), s,
                       [](double value, const SpeedFrom& from) { return value < from.s; });
  return above == tool_speeds.begin() ? tool_speed : std::prev(above)->speed;
}

namespace {

constexpr double kJoined = 1e-9;  // [rad or m] between the end of a leg and the start of the next

bool is_sound(const Trajectory::Knot& knot, Eigen::Index dof) {
  return is_sound(knot.state, dof) && knot.a_after.size() == dof && knot.a_after.allFinite();
}

/// Writes the coefficients of the quintic from `from`, with acceleration `a`
/// there, to `to` in `h` seconds.
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
  if (times.size() != knots.size()) return fail(Errc::bad_input, text(msg::trajectory_bad_knots));
  return from_knots(times, [&](std::size_t i) { return Knot{knots[i], knots[i].a}; });
}

Result<Trajectory> Trajectory::from_knots(const std::vector<double>& times,
                                          const std::function<Knot(std::size_t)>& knot) {
  const auto bad = [] { return fail(Errc::bad_input, text(msg::trajectory_bad_knots)); };
  if (times.empty() || times[0] != 0) return bad();
  Trajectory trajectory;
  Knot from = knot(0);
  const Eigen::Index dof = from.state.q.size();
  if (!is_sound(from, dof)) return bad();
  const auto stride = static_cast<std::size_t>(6 * dof);
  trajectory.starts_.assign(times.begin(), times.end() - 1);
  trajectory.c_.resize(trajectory.starts_.size() * stride);
  trajectory.first_ = from.state;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double h = times[i] - times[i - 1];
    Knot to = knot(i);
    if (!is_sound(to, dof) || !std::isfinite(times[i]) || !(h > 0)) return bad();
    fit_quintic(from.state, from.a_after, to.state, h, &trajectory.c_[(i - 1) * stride]);
    from = std::move(to);
  }
  trajectory.last_ = from.state;
  trajectory.duration_ = times.back();
  return trajectory;
}

Result<Trajectory> Trajectory::from_jerks(const JointState& start,
                                          std::span<const double> durations,
                                          std::span<const JointVec> jerks, const JointState& end) {
  const Eigen::Index dof = start.q.size();
  bool good = durations.size() == jerks.size() && is_sound(start, dof) && is_sound(end, dof);
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

Trajectory Trajectory::stretched(double factor) && {
  duration_ *= factor;
  for (double& start : starts_) start *= factor;
  for (JointState* state : {&first_, &last_}) {
    state->v /= factor;
    state->a /= factor * factor;
  }
  const auto dof = static_cast<std::size_t>(last_.q.size());
  for (std::size_t i = 0; i < c_.size();) {
    double share = 1;
    for (int k = 0; k < 6; ++k, share /= factor) {
      for (std::size_t j = 0; j < dof; ++j) c_[i++] *= share;
    }
  }
  return std::move(*this);
}

JointState Trajectory::at(double t) const {
  if (t < 0) return JointState::at_rest(first_.q);
  if (t > duration_) return JointState::at_rest(last_.q);
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
