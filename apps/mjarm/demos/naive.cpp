#include "apps/mjarm/demos/naive.hpp"

#include <cmath>
#include <vector>

namespace mjarm::app {
namespace {

/// A motion through the answers, as fast at each as the mean between its neighbours.
Result<Trajectory> through(const std::vector<JointVec>& q, double period) {
  const std::size_t n = q.size();
  std::vector<double> times;
  std::vector<JointState> states;
  for (std::size_t i = 0; i < n; ++i) {
    const JointVec zero = JointVec::Zero(q[i].size());
    const bool end = i == 0 || i + 1 == n;
    times.push_back(static_cast<double>(i) * period);
    states.push_back({q[i], end ? zero : JointVec((q[i + 1] - q[i - 1]) / (2 * period)), zero});
  }
  return Trajectory::through(times, states);
}

}  // namespace

Result<NaiveMotion> naive_motion(const IkSolver& ik, const Curve& curve,
                                 std::span<const double> q_start, double tool_speed, double period,
                                 double flip_step) {
  NaiveMotion motion;
  std::vector<JointVec> q;
  const auto poses = static_cast<int>(std::ceil(curve.end() / (tool_speed * period)));
  for (int i = 0; i <= poses; ++i) {
    const double fraction = static_cast<double>(i) / poses;
    const auto answer =
        ik.solve(curve.at(curve.end() * fraction), q.empty() ? q_start : as_span(q.back()));
    if (!answer) {
      if (i < 2) return fail(Errc::impossible, describe(answer.error(), ik.arm()));
      motion.fraction = fraction;
      break;
    }
    if (i > 0) {
      int joint = 0;
      const double step = (answer->q - q.back()).cwiseAbs().maxCoeff(&joint);
      if (step / period > motion.peak_speed) {
        motion.peak_speed = step / period;
        motion.peak_joint = joint;
      }
      if (step > flip_step && !motion.flip) motion.flip = {fraction, joint, step};
    }
    q.push_back(answer->q);
  }
  Result<Trajectory> trajectory = through(q, period);
  if (!trajectory) return fail(std::move(trajectory.error()));
  motion.trajectory = std::move(*trajectory);
  return motion;
}

}  // namespace mjarm::app
