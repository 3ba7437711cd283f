#include "mjarm/planning/region_goals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/finite.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm {
namespace {

constexpr int kMaxDrawn = 512;                         // poses of each region
constexpr int kMaxDrawnToReach = 64;                   // as long as none can be reached
constexpr double kFirstPull = 0.5, kLeastPull = 0.02;  // shares of the way
constexpr int kMaxPulls = 30;
constexpr double kPullPays = 1e-3;     // share of it that a step has to gain
constexpr double kSamePosture = 1e-6;  // [rad or m]

bool is_point(const TaskRegion& region) {
  if (region.mechanism && region.mechanism->min < region.mechanism->max) return false;
  const bool is_turn = region.lean > 0 && region.turn_min.head<2>() != region.turn_max.head<2>();
  return region.place_min == region.place_max && !is_turn &&
         region.turn_min[2] == region.turn_max[2];
}

/// Whether two answers differ by whole turns of hinges.
bool same_posture(const Arm& arm, const JointVec& a, const JointVec& b) {
  for (int k = 0; k < arm.dof(); ++k) {
    const bool turns = arm.joints[static_cast<std::size_t>(k)].type == JointType::hinge;
    const double off = a[k] - b[k];
    const double apart = turns ? std::remainder(off, 2 * std::numbers::pi) : off;
    if (std::abs(apart) > kSamePosture) return false;
  }
  return true;
}

}  // namespace

RegionGoals::RegionGoals(const FastChecker& checker, const IkSolver& ik,
                         std::span<const TaskRegion> regions, std::span<const double> q_near,
                         const RegionGoalOptions& options)
    : checker_(&checker),
      ik_(ik),
      regions_(regions.begin(), regions.end()),
      near_(joint_vec(q_near)),
      options_(options) {
  for (std::size_t k = 0; k < regions.size(); ++k) rngs_.emplace_back(options.seed, 3 + 16 * k);
}

Result<RegionGoals, IkFailure> RegionGoals::create(const FastChecker& checker, const IkSolver& ik,
                                                   std::span<const TaskRegion> regions,
                                                   std::span<const double> q_near,
                                                   const RegionGoalOptions& options) {
  const bool fits = q_near.size() == static_cast<std::size_t>(checker.robot().dof()) &&
                    all_finite(q_near) && ik.arm().dof() == checker.robot().dof();
  const auto sound = [](const TaskRegion& region) { return is_sound(region); };
  if (!fits || regions.empty() || !std::ranges::all_of(regions, sound) || options.poses < 0 ||
      options.max <= 0) {
    return tl::unexpected(IkFailure{.code = IkErrc::bad_input, .best = {}});
  }
  RegionGoals out(checker, ik, regions, q_near, options);
  std::optional<IkFailure> why;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    std::optional<IkFailure> failed = out.add(static_cast<int>(k), middle_of(regions[k]));
    if (k == 0) why = std::move(failed);
  }
  if (why && why->code == IkErrc::bad_input) return tl::unexpected(std::move(*why));
  out.draw_each(options.poses);
  out.choose();
  while (out.q_.empty() && out.drawn_ < kMaxDrawnToReach && out.draw_more()) continue;
  if (out.q_.empty()) return tl::unexpected(std::move(*why));
  return out;
}

bool RegionGoals::may_draw() const {
  const bool enough = drawn_ == 0 || drawn_ >= kMaxDrawn;
  return !enough && !std::ranges::all_of(regions_, is_point) && !is_stopped(options_.stop);
}

bool RegionGoals::draw_more() {
  if (!may_draw()) return false;
  options_.max *= 2;
  draw_each(drawn_);
  choose();
  return true;
}

void RegionGoals::draw_each(int poses) {
  const Reach& reach = ik_.reach();
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    if (is_point(regions_[k])) continue;
    const double radius = std::min(reach.outer(), kWidestPlace) + regions_[k].X_FT.p.norm();
    for (int i = 0; i < poses && !is_stopped(options_.stop); ++i) {
      (void)add(static_cast<int>(k), draw_from(regions_[k], reach.base_point(), radius, rngs_[k]));
    }
  }
  drawn_ += poses;
}

RegionGoals::Worth RegionGoals::worth(const JointVec& q) const {
  if (!checker_->is_free(as_span(q))) return hit;
  const Arm& arm = checker_->robot().arm();
  if (options_.tilt && tilt(*options_.tilt, arm, as_span(q)) > options_.tilt->max) return off;
  const bool kept = !options_.within || room_in(*options_.within, fk(arm, as_span(q))).within();
  return kept ? good : off;
}

/// All branches for one pose; why there is none.
std::optional<IkFailure> RegionGoals::add(int region, const Pose& X_WT) {
  const auto answers = solve_all(ik_, X_WT, as_span(near_), {.windings = true});
  if (!answers) return answers.error();
  std::vector<std::pair<JointVec, Worth>> known;  // one winding of each posture
  for (const IkSolution& answer : *answers) {
    auto seen = std::ranges::find_if(
        known, [&](const auto& other) { return same_posture(ik_.arm(), other.first, answer.q); });
    if (seen == known.end()) seen = known.insert(seen, {answer.q, worth(answer.q)});
    found_[seen->second].push_back({answer.q, region, (answer.q - near_).norm()});
  }
  return std::nullopt;
}

JointVec RegionGoals::pulled(const JointVec& q, int region, const JointVec& to) const {
  const TaskRegion& within = regions_[static_cast<std::size_t>(region)];
  const Worth least = worth(q);
  JointVec out = q;
  if (is_point(within)) return out;
  double share = kFirstPull;
  for (int k = 0; k < kMaxPulls && share > kLeastPull; ++k) {
    const JointVec tried = out + share * (to - out);
    const Pose X_WT = nearest_in(within, fk(ik_.arm(), as_span(tried)));
    const auto answer = ik_.solve(X_WT, as_span(tried));
    const double before = (out - to).norm();
    const bool nearer = answer && (answer->q - to).norm() < before * (1 - kPullPays);
    if (nearer && worth(answer->q) <= least) {
      out = answer->q;
    } else {
      share *= 0.5;
    }
  }
  return out;
}

void RegionGoals::choose() {
  std::vector<Found>& out = !found_[good].empty()  ? found_[good]
                            : !found_[off].empty() ? found_[off]
                                                   : found_[hit];
  std::ranges::stable_sort(out, {}, &Found::far);
  const std::size_t count = std::min(out.size(), static_cast<std::size_t>(options_.max));
  q_.clear();
  region_of_.clear();
  for (const Found& found : std::span(out).first(count)) {
    q_.push_back(found.q);
    region_of_.push_back(found.region);
  }
}

}  // namespace mjarm
