#include <algorithm>
#include <cstddef>
#include <utility>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/self_motion.hpp"
#include "mjarm/path/even_track_internal.hpp"

namespace mjarm::detail {
namespace {

/// An elastic band through what each pose leaves free. What it is drawn to is first smooth over
/// long stretches and then over ever shorter ones, so that what is to be spread gets far soon.
class ElasticBand {
 public:
  ElasticBand(const PathLayers& layers, std::span<const Pose> poses, std::span<const double> s,
              const Track& track)
      : layers_(layers),
        poses_(poses),
        s_(s),
        tightness_(track.last.front().rank.tightness),
        ik_(layers.within(std::min(tightness_, kMost))),
        first_(track.q),
        q_(track.q) {}

  /// Where it is stopped, some answers are drawn and others are not.
  std::vector<JointVec> run() {
    const double length = s_.back() - s_.front();
    for (double width = length / 4; width > length / kFinest; width /= 2) {
      for (int i = 0; i < kRounds; ++i) draw(smoothed(width));
    }
    for (std::size_t k = 0; k < q_.size(); ++k) {
      if (!layers_.has_room(q_[k], tightness_)) q_[k] = first_[k];
    }
    return std::move(q_);
  }

 private:
  static constexpr double kMost = 0.95;  // tightness: what goes to a limit cannot go on from there
  static constexpr int kRounds = 4;
  static constexpr double kFinest = 256;

  /// y of y - width^2 y'' = q over s, with the first answer as it is and y' = 0 behind the last.
  [[nodiscard]] std::vector<JointVec> smoothed(double width) const {
    const std::size_t n = q_.size();
    std::vector<JointVec> y = q_;
    std::vector<double> above(n, 0.0);      // of the triangle that elimination leaves
    const auto pull = [&](std::size_t k) {  // of the stretch behind station k
      const double tiny = 1e-9 * (s_.back() - s_.front());
      return width * width / std::max(s_[k + 1] - s_[k], tiny);
    };
    for (std::size_t k = 1; k < n; ++k) {
      const bool last = k + 1 == n;
      const double weight = 0.5 * (s_[last ? k : k + 1] - s_[k - 1]);
      const double before = pull(k - 1), behind = last ? 0 : pull(k);
      const double pivot = weight + behind + before * (1 - above[k - 1]);
      above[k] = behind / pivot;
      y[k] = (weight * q_[k] + before * y[k - 1]) / pivot;
    }
    for (std::size_t k = n - 1; k-- > 1;) y[k] += above[k] * y[k + 1];
    return y;
  }

  void draw(const std::vector<JointVec>& y) {
    const PathOptions& options = layers_.options();
    for (std::size_t k = 1; k < q_.size() && !is_stopped(options.stop); ++k) {
      const auto moved = options.orientation_tol > 0 ? turned(k, y[k]) : within_itself(k, y[k]);
      if (moved) q_[k] = moved->q;
    }
  }

  /// Answer k moved towards `y`, the tool at rest.
  [[nodiscard]] Result<IkSolution, IkFailure> within_itself(std::size_t k,
                                                            const JointVec& y) const {
    return null_space_step(
        ik_, poses_[k], as_span(q_[k]),
        {.goal = PostureGoal::near_posture, .posture = y, .max_steps = 3, .tolerance = 1e-10});
  }

  /// The answer near to that, the tool turned as it would be there as far as the tolerance goes.
  [[nodiscard]] Result<IkSolution, IkFailure> turned(std::size_t k, const JointVec& y) const {
    constexpr double kLongest = 0.2;  // [rad or m] of the joint that moves most
    const JointVec wish = y - q_[k];
    const double longest = std::max(wish.cwiseAbs().maxCoeff(), kLongest);
    const JointVec seed = q_[k] + kLongest / longest * wish;
    const Eigen::Matrix3d R_WT = fk(layers_.ik().arm(), as_span(seed)).R;
    return ik_.solve(turned_to(poses_[k], R_WT, layers_.options().orientation_tol), as_span(seed));
  }

  const PathLayers& layers_;
  std::span<const Pose> poses_;
  std::span<const double> s_;
  double tightness_;
  IkSolver ik_;
  std::vector<JointVec> first_, q_;
};

}  // namespace

void even_out(const PathLayers& layers, std::span<const Pose> poses, std::span<const double> s,
              Track& track) {
  std::vector<JointVec> q = ElasticBand(layers, poses, s, track).run();
  if (is_stopped(layers.options().stop)) return;
  const double tightness = track.last.front().rank.tightness;
  for (std::size_t k = 1; k < q.size(); ++k) {
    if (layers.step_share(poses[k - 1], poses[k], q[k] - q[k - 1]) > tightness) return;
  }
  track.q = std::move(q);
}

}  // namespace mjarm::detail
