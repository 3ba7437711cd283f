#include "mjarm/planning/joint_barrier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace mjarm {
namespace {

using Eigen::Vector3d;

constexpr int kFirstJoints = 3;                 // of which one may be barred
constexpr double kBetweenValues = 0.1;          // [rad or m] that are tried
constexpr int kMostValues = 100;                // of a joint
constexpr double kNarrowest = 0.01;             // [rad or m] half a part
constexpr int kMostParts = 4000;                // for one value
constexpr std::int64_t kMostLooks = 4'000'000;  // at pieces, in all
constexpr double kRounding = 1e-6;              // [m] more than that of all that is computed here

/// Values of the first joints, each to both sides of a middle.
struct Part {
  std::array<double, kFirstJoints> middle{};
  std::array<double, kFirstJoints> half{};
};

class BarrierSearch {
 public:
  BarrierSearch(const Arm& arm, const BallScene& scene) : arm_(arm), scene_(scene) {}

  /// The joint and value that bar the way, those of the base first.
  std::optional<JointBarrier> between(std::span<const double> start, const JointVec& goal) {
    for (int joint = 0; joint < std::min(kFirstJoints, arm_.dof()); ++joint) {
      const double from = start[static_cast<std::size_t>(joint)], way = goal[joint] - from;
      const int values = std::min(static_cast<int>(std::abs(way) / kBetweenValues), kMostValues);
      for (int k = 1; k <= values && looks_ <= kMostLooks; ++k) {
        const double at = from + way * k / (values + 1);
        if (const std::optional<Hit> hit = is_barred(joint, at)) {
          return JointBarrier{joint, at, hit->link, hit->obstacle};
        }
      }
    }
    return std::nullopt;
  }

 private:
  struct Hit {
    int link, obstacle;
  };

  /// All that the joints before `joint` can be; none where a slide has no end.
  [[nodiscard]] std::optional<Part> all_before(int joint, double at) const {
    Part all;
    for (int i = 0; i < joint; ++i) {
      const auto k = static_cast<std::size_t>(i);
      double lower = arm_.limits.lower[i], upper = arm_.limits.upper[i];
      if (arm_.joints[k].type == JointType::hinge && !(upper - lower < 2 * std::numbers::pi)) {
        lower = -std::numbers::pi;  // farther turns come to the same places
        upper = std::numbers::pi;
      }
      if (!std::isfinite(upper - lower)) return std::nullopt;
      all.middle[k] = (lower + upper) / 2;
      all.half[k] = (upper - lower) / 2;
    }
    all.middle[static_cast<std::size_t>(joint)] = at;
    return all;
  }

  /// What is hit in the middle of the whole, where everything is hit all over.
  std::optional<Hit> is_barred(int joint, double at) {
    const std::optional<Part> all = all_before(joint, at);
    if (!all) return std::nullopt;
    std::optional<Hit> first;
    std::vector<Part> left{*all};
    for (int parts = 0; !left.empty(); ++parts) {
      const Part part = left.back();
      left.pop_back();
      const std::optional<Hit> middle = hit_in({part.middle, {}}, joint);
      if (!middle || parts == kMostParts || looks_ > kMostLooks) return std::nullopt;
      if (!first) first = middle;
      if (hit_in(part, joint)) continue;
      const auto widest = static_cast<std::size_t>(
          std::max_element(part.half.begin(), part.half.end()) - part.half.begin());
      if (part.half[widest] < kNarrowest) return std::nullopt;
      for (const double side : {-0.5, 0.5}) {
        left.push_back(part);
        left.back().middle[widest] += side * part.half[widest];
        left.back().half[widest] /= 2;
      }
    }
    return first;
  }

  /// A ball that hits something wherever in the part its joints are.
  std::optional<Hit> hit_in(const Part& part, int joint) {
    std::array<Pose, kFirstJoints> X_WJ;
    for (int i = 0; i <= joint; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const ArmJoint& one = arm_.joints[k];
      X_WJ[k] = (i > 0 ? X_WJ[k - 1] : Pose{}) * one.X_PJ;
      if (one.type == JointType::slide) {
        X_WJ[k].p += X_WJ[k].R * (part.middle[k] * one.axis);
      } else {
        X_WJ[k].R *= Eigen::AngleAxisd(part.middle[k], one.axis).toRotationMatrix();
      }
    }
    for (const LinkBall& ball : scene_.balls) {
      if (ball.joint > joint) continue;
      const Vector3d center = X_WJ[static_cast<std::size_t>(ball.joint)] * ball.center;
      const double radius = ball.radius - kRounding - way_of(center, ball.joint, X_WJ, part);
      const int obstacle = radius > 0 ? obstacle_at(center, radius, ball.link) : -1;
      if (obstacle >= 0) return Hit{ball.link, obstacle};
    }
    return std::nullopt;
  }

  /// [m] that the ball is moved at most as its joints, the last one first, go from the middle of
  /// the part to anywhere in it.
  double way_of(const Vector3d& center, int joint, const std::array<Pose, kFirstJoints>& X_WJ,
                const Part& part) const {
    double way = 0;
    for (int i = joint; i >= 0; --i) {
      const auto k = static_cast<std::size_t>(i);
      const Vector3d axis = X_WJ[k].R * arm_.joints[k].axis;
      const double lever =
          arm_.joints[k].type == JointType::slide ? 1 : axis.cross(center - X_WJ[k].p).norm() + way;
      way += part.half[k] * lever;
    }
    return way;
  }

  int obstacle_at(const Vector3d& center, double radius, int link) {
    looks_ += static_cast<std::int64_t>(scene_.pieces.size());
    for (const StandingPiece& piece : scene_.pieces) {
      const Vector3d outside =
          (piece.low - center).cwiseMax(center - piece.high).cwiseMax(Vector3d::Zero());
      if (outside.squaredNorm() >= radius * radius) continue;
      if (piece.distance(center, radius) >= radius) continue;
      const IgnoredPair pair{link, piece.obstacle};
      if (std::ranges::find(scene_.ignored, pair) == scene_.ignored.end()) return piece.obstacle;
    }
    return -1;
  }

  const Arm& arm_;
  const BallScene& scene_;
  std::int64_t looks_ = 0;
};

}  // namespace

std::optional<JointBarrier> find_barrier(const Arm& arm, const BallScene& scene,
                                         std::span<const double> start,
                                         std::span<const JointVec> goals) {
  BarrierSearch search(arm, scene);
  std::optional<JointBarrier> first;
  for (const JointVec& goal : goals) {
    const std::optional<JointBarrier> barrier = search.between(start, goal);
    if (!barrier) return std::nullopt;
    if (!first) first = barrier;
  }
  return first;
}

}  // namespace mjarm
