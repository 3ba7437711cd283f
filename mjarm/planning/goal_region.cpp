#include "mjarm/planning/goal_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/core/finite.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm {
namespace {

constexpr double kWidest = 10;  // [m]

bool is_point(const GoalRegion& region) {
  return region.half.isZero(0) && region.lean == 0 && region.turn == 0;
}

/// A pose of the region: places even in the box, directions even on the cap of the sphere.
Pose draw(const GoalRegion& region, Rng& rng) {
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) p[k] = region.half[k] * rng.uniform(-1, 1);
  const double lean = std::acos(1 - rng.uniform() * (1 - std::cos(region.lean)));
  const double way = rng.uniform(-std::numbers::pi, std::numbers::pi);
  const double turn = rng.uniform(-1, 1) * region.turn;
  const Eigen::Vector3d axis(std::cos(way), std::sin(way), 0);
  const Eigen::Matrix3d R =
      rotation_exp(lean * axis) * rotation_exp(turn * Eigen::Vector3d::UnitZ());
  return region.X_WR * Pose{p, R};
}

/// Configurations, and what they are sorted by.
class Goals {
 public:
  Goals(const FastChecker& checker, const std::optional<TiltLimit>& tilt,
        std::span<const double> q_near)
      : checker_(checker), tilt_(tilt), near_(joint_vec(q_near)) {}

  void add(std::span<const IkSolution> answers) {
    for (const IkSolution& answer : answers) {
      const bool free = checker_.is_free(as_span(answer.q));
      const bool upright =
          !tilt_ || tilt(*tilt_, checker_.robot().arm(), as_span(answer.q)) <= tilt_->max;
      (!free ? hit_ : upright ? good_ : leaning_).push_back(answer.q);
    }
  }

  std::vector<JointVec> take(int max) {
    std::vector<JointVec>& out = !good_.empty() ? good_ : !leaning_.empty() ? leaning_ : hit_;
    const auto far = [&](const JointVec& q) { return (q - near_).norm(); };
    std::ranges::stable_sort(out, {}, far);
    if (out.size() > static_cast<std::size_t>(max)) out.resize(static_cast<std::size_t>(max));
    return std::move(out);
  }

 private:
  const FastChecker& checker_;
  const std::optional<TiltLimit>& tilt_;
  JointVec near_;
  std::vector<JointVec> good_, leaning_, hit_;
};

}  // namespace

bool is_sound(const GoalRegion& region) noexcept {
  const auto within = [](double x, double max) { return x >= 0 && x <= max; };
  return within(region.half.minCoeff(), kWidest) && within(region.half.maxCoeff(), kWidest) &&
         region.half.allFinite() && within(region.lean, std::numbers::pi) &&
         within(region.turn, std::numbers::pi);
}

Result<std::vector<JointVec>, IkFailure> goals_in(const FastChecker& checker, const IkSolver& ik,
                                                  const GoalRegion& region,
                                                  std::span<const double> q_near,
                                                  const GoalOptions& options) {
  const bool fits = q_near.size() == static_cast<std::size_t>(checker.robot().dof()) &&
                    all_finite(q_near) && ik.arm().dof() == checker.robot().dof();
  if (!fits || !is_sound(region) || options.poses < 0 || options.max <= 0) {
    return tl::unexpected(IkFailure{.code = IkErrc::bad_input, .best = {}});
  }
  Goals goals(checker, options.tilt, q_near);
  Rng rng(options.seed, 3);
  const int poses = is_point(region) ? 0 : options.poses;
  std::optional<IkFailure> why;
  bool any = false;
  for (int k = 0; k <= poses; ++k) {
    const Pose X_WT = k == 0 ? region.X_WR : draw(region, rng);
    const auto answers = solve_all(ik, X_WT, q_near, {.windings = true});
    if (answers) goals.add(*answers);
    any = any || answers.has_value();
    if (k == 0 && !answers) why = answers.error();
    if (why && why->code == IkErrc::bad_input) break;
    if (is_stopped(options.stop)) break;
  }
  if (!any) return tl::unexpected(std::move(*why));
  return goals.take(options.max);
}

}  // namespace mjarm
