#include "mjarm/trajectory/tool_speed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/link_chain.hpp"

namespace mjarm {
namespace {

/// One moment of a motion.
struct Sample {
  double t = 0;
  double s = 0;
  double rate = 0;  ///< ds/dt
  JointVec d;       ///< dq/ds
  JointVec e;       ///< d2q/ds2
};

/// Speed of the tool; its rate of turn where it turns on the spot.
double tool_rate(const LinkChain& chain, const JointState& x) {
  constexpr double kOnTheSpot = 1e-4;  // [m/rad]
  const Eigen::VectorXd twist = fk_jacobian(chain, as_span(x.q)).J_W * x.v;
  const double along = twist.head<3>().norm(), turn = twist.tail<3>().norm();
  return along > kOnTheSpot * turn ? along : turn;
}

std::vector<Sample> samples_of(const IkSolver& ik, const Curve& curve,
                               const Trajectory& trajectory) {
  constexpr double kStep = 1e-3, kMax = 2e4;
  const LinkChain chain(ik.chain());
  const double count = std::clamp(std::ceil(trajectory.duration() / kStep), 2.0, kMax),
               T = trajectory.duration();
  const double dt = T / count;
  const auto rate_at = [&](double t) { return tool_rate(chain, trajectory.at(t)); };
  std::vector<Sample> samples;
  for (int i = 0; i <= static_cast<int>(count); ++i) {
    const double t = i * dt;
    const JointState x = trajectory.at(t);
    Sample out{t, 0, tool_rate(chain, x), x.v, x.a};
    if (!samples.empty()) {  // Simpson's rule
      const Sample& last = samples.back();
      out.s = last.s + dt / 6 * (last.rate + 4 * rate_at(t - 0.5 * dt) + out.rate);
    }
    samples.push_back(std::move(out));
  }
  const double scale = curve.end() / std::max(samples.back().s, 1e-300);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& at = samples[i];
    at.s *= scale;
    const std::size_t low = i == 0 ? 0 : i - 1, high = std::min(i + 1, samples.size() - 1);
    const double change =
        (samples[high].rate - samples[low].rate) / (samples[high].t - samples[low].t);
    const double rate = std::max(at.rate, 1e-300);
    at.d /= rate;
    at.e = (at.e - at.d * change) / (rate * rate);
  }
  return samples;
}

double fastest(const TimingOptions& options) {
  double speed = options.tool_speed;
  for (const SpeedFrom& from : options.tool_speeds) speed = std::max(speed, from.speed);
  return speed;
}

/// How fast a tool is that speeds up from rest as gently as it should, by the way it has come.
class Ramp {
 public:
  explicit Ramp(const TimingOptions& options, double leg) {
    constexpr int kParts = 400;
    const JointVec one = JointVec::Ones(1);
    const JointLimits limits{-one,
                             one,
                             fastest(options) * one,
                             options.tool_accel * one,
                             options.tool_accel / options.tool_ramp * one,
                             one,
                             {}};
    const double from = 0;
    const auto move = time_joint_move({&from, 1}, {&leg, 1}, limits);
    for (int i = 0; move && i <= kParts; ++i) {
      const JointState x = move->at(0.5 * move->duration() * i / kParts);
      way_.push_back(x.q[0]);
      speed_.push_back(x.v[0]);
    }
  }
  /// The way after which it is that fast.
  [[nodiscard]] double way_to(double speed) const {
    const auto above = std::upper_bound(speed_.begin(), speed_.end(), speed);
    if (above == speed_.end()) return way_.empty() ? 0 : way_.back();
    return way_[static_cast<std::size_t>(above - speed_.begin())];
  }
  [[nodiscard]] double at(double way) const {
    const auto above = std::upper_bound(way_.begin(), way_.end(), way);
    if (above == way_.begin()) return 0;
    return speed_[static_cast<std::size_t>(above - way_.begin()) - 1];
  }

 private:
  std::vector<double> way_, speed_;
};

/// The speed asked for at each sample.
std::vector<double> asked_speeds(const Curve& curve, const std::vector<Sample>& samples,
                                 const TimingOptions& options) {
  constexpr double kSpareWay = 1.5;
  const std::vector<double>& corners = curve.corners();
  std::vector<double> out;
  std::size_t leg = 0;
  Ramp ramp(options, corners[1] - corners[0]);
  // Where the speed changes it does so as gently as from a stop.
  const auto zone_speed = [&](double s) {
    double speed = options.speed_at(s);
    double before = options.tool_speed;
    for (const SpeedFrom& from : options.tool_speeds) {
      const double slower = s < from.s ? from.speed : before;
      before = from.speed;
      if (slower >= speed) continue;
      speed = std::min(speed, ramp.at(ramp.way_to(slower) + std::abs(s - from.s) / kSpareWay));
    }
    return speed;
  };
  for (const Sample& at : samples) {
    while (leg + 2 < corners.size() && at.s > corners[leg + 1]) {
      ++leg;
      ramp = Ramp(options, corners[leg + 1] - corners[leg]);
    }
    const double way = std::min(at.s - corners[leg], corners[leg + 1] - at.s);
    out.push_back(std::min(ramp.at(way / kSpareWay), zone_speed(at.s)));
  }
  return out;
}

/// What a motion takes of each limit.
using Use = std::array<JointVec, 3>;

/// What it would take of them at the speed `asked`, kept at a sample.
Use use_at_speed(const JointLimits& limits, double share, const Sample& at, const JointVec& f,
                 double asked) {
  return {asked * at.d.cwiseAbs().cwiseQuotient(share * limits.velocity),
          asked * asked * at.e.cwiseAbs().cwiseQuotient(share * limits.acceleration),
          asked * asked * asked * f.cwiseAbs().cwiseQuotient(limits.jerk)};
}

/// What it takes of them at a time.
Use use_at_time(const JointLimits& limits, double share, const Trajectory& trajectory, double t) {
  constexpr double kAround = 2e-3;  // [s]
  const double from = std::max(t - kAround, 0.0), to = std::min(t + kAround, trajectory.duration());
  const JointState x = trajectory.at(t);
  const JointVec jerk = (trajectory.at(to).a - trajectory.at(from).a) / (to - from);
  return {x.v.cwiseAbs().cwiseQuotient(share * limits.velocity),
          x.a.cwiseAbs().cwiseQuotient(share * limits.acceleration),
          jerk.cwiseAbs().cwiseQuotient(limits.jerk)};
}

/// The limit that allows the least share of a speed.
void note_limit(const Use& use, SpeedDip& dip) {
  for (std::size_t order = 0; order < use.size(); ++order) {
    int joint = 0;
    const double max = use[order].maxCoeff(&joint);
    const double kept = std::pow(std::max(max, 1e-300), -1.0 / static_cast<double>(order + 1));
    if (dip.joint >= 0 && kept >= dip.kept) continue;
    dip.joint = joint;
    dip.limit = static_cast<SpeedLimit>(order);
    dip.use = max;
    dip.kept = kept;
  }
}

/// The dip of the samples first to last.
SpeedDip dip_of(const IkSolver& ik, const Trajectory& trajectory,
                const std::vector<Sample>& samples, const std::vector<double>& asked,
                std::size_t first, std::size_t last, double share) {
  constexpr std::size_t kWindow = 5;  // samples to either side for third derivatives
  constexpr double kNear = 0.05;      // smallest singular value
  constexpr double kSlowest = 1.02;   // of the lowest speed, where the limit is looked for
  const JointLimits& limits = ik.arm().limits;
  const auto ratio = [&](std::size_t i) { return samples[i].rate / asked[i]; };
  std::size_t slowest = first;
  for (std::size_t i = first; i <= last; ++i) slowest = ratio(i) < ratio(slowest) ? i : slowest;
  SpeedDip dip{samples[first].s, samples[last].s, samples[first].t, samples[last].t}, all;
  for (std::size_t i = first; i <= last; ++i) {
    const Sample &low = samples[i - std::min(i, kWindow)],
                 &high = samples[std::min(i + kWindow, samples.size() - 1)];
    const JointVec f = (high.e - low.e) / std::max(high.s - low.s, 1e-12);
    const Use use = use_at_speed(limits, share, samples[i], f, asked[i]);
    note_limit(use, all);
    if (ratio(i) <= kSlowest * ratio(slowest)) note_limit(use, dip);
  }
  if (dip.use <= 1) {  // it is on its way to that speed
    dip.joint = -1;
    note_limit(use_at_time(limits, share, trajectory, samples[slowest].t), dip);
  }
  dip.least = samples[slowest].rate;
  dip.s_least = samples[slowest].s;
  dip.kept = std::min(all.kept, ratio(slowest));
  dip.kind = singularity(ik, as_span(trajectory.at(samples[slowest].t).q), kNear).kind;
  return dip;
}

}  // namespace

std::string_view name(SpeedLimit limit) noexcept {
  switch (limit) {
    case SpeedLimit::velocity:
      return "velocity";
    case SpeedLimit::acceleration:
      return "acceleration";
    case SpeedLimit::jerk:
      break;
  }
  return "jerk";
}

std::string describe(const SpeedDip& dip, const Arm& arm) {
  const auto word = [&] {
    switch (dip.limit) {
      case SpeedLimit::velocity:
        return text(msg::trajectory_velocity);
      case SpeedLimit::acceleration:
        return text(msg::trajectory_acceleration);
      case SpeedLimit::jerk:
        break;
    }
    return text(msg::trajectory_jerk);
  };
  const bool known = dip.joint >= 0 && dip.joint < arm.dof();
  const std::string joint = known ? arm.joints[static_cast<std::size_t>(dip.joint)].name : "?";
  const std::string line = text(msg::trajectory_dip, dip.s_from, dip.s_to, dip.t_from, dip.t_to,
                                dip.least, joint, word());
  if (dip.kind == SingularKind::none) return line;
  return text(msg::trajectory_dip_singular, line, describe(dip.kind));
}

std::vector<SpeedDip> find_speed_dips(const IkSolver& ik, const Curve& curve,
                                      const Trajectory& trajectory, const TimingOptions& options) {
  constexpr double kSlower = 0.01;  // of the speed asked for
  constexpr double kOneDip = 0.02;  // [s] dips no farther apart are one
  if (!(trajectory.duration() > 0)) return {};
  const std::vector<Sample> samples = samples_of(ik, curve, trajectory);
  const std::vector<double> asked = asked_speeds(curve, samples, options);
  struct Range {
    std::size_t first, last;
  };
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(samples[i].rate < asked[i] - kSlower * options.speed_at(samples[i].s))) continue;
    if (ranges.empty() || samples[i].t > samples[ranges.back().last].t + kOneDip) {
      ranges.push_back({i, i});
    }
    ranges.back().last = i;
  }
  std::vector<SpeedDip> dips;
  for (const Range& range : ranges) {
    dips.push_back(
        dip_of(ik, trajectory, samples, asked, range.first, range.last, options.joint_share));
  }
  return dips;
}

}  // namespace mjarm
