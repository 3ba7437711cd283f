#include "mjarm/planning/enclosure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/collision/link_balls.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/cell_channel_internal.hpp"

namespace mjarm {
namespace {

using detail::CellChannel;
using detail::CellTree;
using Eigen::Vector3d;

constexpr std::int64_t kMaxWork = 20'000'000;  // for all balls and goals
constexpr std::int64_t kFirstWork = 200'000;   // for each ball, before others get more
constexpr int kMoreWork = 4;                   // times as much, the next time
constexpr double kSamePlace = 1e-6;            // [m]

/// One look for a proof.
class Prover {
 public:
  Prover(const Arm& arm, const BallScene& scene, std::span<const double> start)
      : arm_(arm), scene_(scene), start_(centers(start)) {
    for (std::size_t k = 0; k < scene.balls.size(); ++k) {
      trees_.emplace_back(scene, k, detail::reach_of(arm, scene.balls[k]));
    }
  }

  /// Where each ball has its centre, in the world.
  std::vector<Vector3d> centers(std::span<const double> q) const {
    std::array<Pose, kMaxDof> X_WJ;
    fk_all(arm_, q, X_WJ);
    std::vector<Vector3d> out;
    for (const LinkBall& ball : scene_.balls) {
      out.push_back(X_WJ[static_cast<std::size_t>(ball.joint)] * ball.center);
    }
    return out;
  }

  /// Something that keeps the balls from going from the start to there. What takes little work is
  /// tried with all balls before more is spent on one.
  std::optional<Pocket> separate(const std::vector<Vector3d>& goal) {
    std::vector<std::size_t> left;
    for (std::size_t k = 0; k < trees_.size(); ++k) {
      if ((goal[k] - start_[k]).norm() > kSamePlace) left.push_back(k);
    }
    for (std::int64_t share = kFirstWork; !left.empty() && work_ < kMaxWork; share *= kMoreWork) {
      std::vector<std::size_t> unsure;
      for (const std::size_t k : left) {
        CellChannel channel(trees_[k], start_[k], goal[k]);
        const std::int64_t before = trees_[k].work();
        const CellChannel::Outcome outcome = channel.run(std::min(share, kMaxWork - work_));
        work_ += trees_[k].work() - before;
        if (outcome == CellChannel::Outcome::shut) return pocket_of(channel, k);
        if (outcome == CellChannel::Outcome::spent) unsure.push_back(k);
      }
      left = std::move(unsure);
    }
    return std::nullopt;
  }

 private:
  Pocket pocket_of(const CellChannel& channel, std::size_t k) const {
    const CellChannel::Room start = channel.room(0), goal = channel.room(1);
    const bool at_goal = goal.volume < start.volume;
    const CellChannel::Room& room = at_goal ? goal : start;
    const LinkBall& ball = scene_.balls[k];
    return {ball.link, ball.radius, at_goal, room.volume, room.smallest};
  }

  const Arm& arm_;
  const BallScene& scene_;
  std::vector<Vector3d> start_;
  std::vector<CellTree> trees_;
  std::int64_t work_ = 0;
};

bool are_same(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  return std::ranges::equal(a, b, [](const Vector3d& p, const Vector3d& x) {
    return (p - x).norm() < kSamePlace * 1e-3;
  });
}

std::optional<Pocket> prove(const Arm& arm, const BallScene& scene, std::span<const double> start,
                            std::span<const JointVec> goals) {
  Prover prover(arm, scene, start);
  std::vector<std::vector<Vector3d>> done;
  std::optional<Pocket> out;
  for (const JointVec& goal : goals) {
    std::vector<Vector3d> centers = prover.centers(as_span(goal));
    // Another winding has the balls in the same places.
    const auto is_done = [&](const auto& other) { return are_same(centers, other); };
    if (std::ranges::any_of(done, is_done)) continue;
    const std::optional<Pocket> pocket = prover.separate(centers);
    if (!pocket) return std::nullopt;
    if (!out || (out->at_goal && !pocket->at_goal)) out = pocket;
    done.push_back(std::move(centers));
  }
  if (out) out->goals = static_cast<int>(goals.size());
  return out;
}

}  // namespace

const BallScene& EnclosureTest::scene() {
  if (!scene_) scene_ = ball_scene(checker_, obstacles_);
  return *scene_;
}

const std::optional<Pocket>& EnclosureTest::find() {
  if (!found_) found_ = prove(checker_.robot().arm(), scene(), start_, goals_);
  return *found_;
}

const std::optional<JointBarrier>& EnclosureTest::barrier() {
  if (!barrier_) barrier_ = find_barrier(checker_.robot().arm(), scene(), start_, goals_);
  return *barrier_;
}

}  // namespace mjarm
