#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/kinematics/seven_axis_search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWithin = kSevenWithin;
constexpr double kAlmost = 1e-3;    // likewise: to be looked at more closely
constexpr double kHopeless = 0.05;  // likewise: closer samples would not help
constexpr double kNear = 0.2;       // [rad] an answer so near to the seed ends the search

/// Range of cos(x) for x in [lower, upper].
std::pair<double, double> cosine_range(double lower, double upper) noexcept {
  const auto meets = [&](double x) {
    return x + 2 * kPi * std::ceil((lower - x) / (2 * kPi)) <= upper;
  };
  const auto [low, high] = std::minmax({std::cos(lower), std::cos(upper)});
  return {meets(kPi) ? -1 : low, meets(0) ? 1 : high};
}

}  // namespace

double SevenSearch::Interval::at(double t) const noexcept {
  return a + (b - a) * 0.5 * (1 - std::cos(t));
}

SevenSearch::SevenSearch(const SevenGeometry& geometry, const Chain& chain,
                         const BranchQuery& query, Branches& out) noexcept
    : g_(geometry), chain_(chain), query_(query), out_(out), kernel_(seven_kernel()) {
  set_goal();
}

void SevenSearch::set_goal() noexcept {
  using Eigen::Map;
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  const Pose X_W6 = query_.X_WT * g_.X_T6;
  Map<Vector3d>(goal_.p_6S) = X_W6.R.transpose() * (Map<const Vector3d>(g_.p_WS) - X_W6.p);
  Map<Matrix3d>(goal_.R_0u6) = Map<const Matrix3d>(g_.R_W0).transpose() * X_W6.R;
  for (int i = 0; i < 7; ++i) {
    goal_.near_cos[i] = std::cos(query_.near[i]);
    goal_.near_sin[i] = std::sin(query_.near[i]);
  }
}

/// The ranges of the last joint in which the distance SW is one that joint 4 allows.
void SevenSearch::find_intervals() noexcept {
  const double* u = g_.p_3uS;
  const double* w = g_.p_3W;
  const double across = u[0] * w[0] + u[1] * w[1];
  const double turned = u[0] * w[1] - u[1] * w[0];
  const double size = std::hypot(across, turned);
  const double sum =
      u[0] * u[0] + u[1] * u[1] + w[0] * w[0] + w[1] * w[1] + (u[2] - w[2]) * (u[2] - w[2]);
  std::pair<double, double> cosine{-1, 1};
  if (!chain_.full_turn[3]) {
    const double folded = std::atan2(-turned, across);
    cosine = cosine_range(chain_.lower[3] - folded, chain_.upper[3] - folded);
  }
  const double slack = 1e-9 * sum;
  const double d2_low = sum - 2 * size * cosine.second - slack;
  const double d2_high = sum - 2 * size * cosine.first + slack;

  const double* p = goal_.p_6S;
  const double* v = g_.p_6uW;
  const double p_dot_v = p[0] * v[0] + p[1] * v[1];
  const double p_cross_v = p[0] * v[1] - p[1] * v[0];
  const double reach = std::hypot(p_dot_v, p_cross_v);
  const double mean =
      p[0] * p[0] + p[1] * p[1] + v[0] * v[0] + v[1] * v[1] + (p[2] - v[2]) * (p[2] - v[2]);
  double low = chain_.lower[6];
  double high = chain_.upper[6];
  if (chain_.full_turn[6]) {
    low = query_.near[6] - kPi;
    high = query_.near[6] + kPi;
  }
  arm_d2_low_ = std::max(sum - 2 * size, 0.0);
  arm_d2_high_ = sum + 2 * size;
  goal_d2_low_ = mean - 2 * reach;
  goal_d2_high_ = mean + 2 * reach;
  // |SW|^2 = mean - 2 reach cos(q7 - nearest).
  const double from = std::max((mean - d2_high), -2 * reach);
  const double to = std::min((mean - d2_low), 2 * reach);
  if (from > to) return;
  const double nearest = std::atan2(p_cross_v, p_dot_v);
  const double scale = reach > 0 ? 1 / (2 * reach) : 0;
  const double inner = to >= 2 * reach ? 0 : std::acos(to * scale);
  const double outer = from <= -2 * reach ? kPi : std::acos(from * scale);
  if (inner == 0) {
    add_arc(nearest - outer, nearest + outer, low, high);
  } else {
    add_arc(nearest + inner, nearest + outer, low, high);
    add_arc(nearest - outer, nearest - inner, low, high);
  }
}

/// Adds the windings of the arc [from, to] that meet [low, high].
void SevenSearch::add_arc(double from, double to, double low, double high) noexcept {
  if (to - from >= 2 * kPi - 1e-12) {
    intervals_[interval_count_++] = {low, high};
    return;
  }
  double shift = 2 * kPi * std::ceil((low - to) / (2 * kPi));
  for (; from + shift <= high && interval_count_ < kMaxIntervals; shift += 2 * kPi) {
    intervals_[interval_count_++] = {std::max(from + shift, low), std::min(to + shift, high)};
  }
}

void SevenSearch::run() noexcept {
  out_.complete = true;
  if (!query_.all && step_from_seed()) return;
  find_intervals();
  for (int i = 0; i < interval_count_; ++i) scan(intervals_[i], kSpacing);
  if (within_count_ == 0) descend_valleys();
  if (within_count_ == 0) search_finely();
  if (within_count_ > 0) {
    bring_nearest_to_front();
    slide_towards_seed(within_[0]);
    for (int i = 0; i < (query_.all ? within_count_ : 1); ++i) write(within_[i]);
    return;
  }
  if (least_count_ > 0) write(least_[0]);
  // So near to the limits the samples may have missed a way between them.
  out_.complete = (least_count_ == 0 || least_[0].rank > kAlmost) &&
                  (closest_count_ == 0 || closest_[0].rank > kAlmost);
  out_.has_best = closest_count_ > 0;
  if (out_.has_best) angles(closest_[0], out_.best);
  tell_breach();
}

/// Says so where the wrist is too far from the shoulder, or too near to it, for every elbow.
void SevenSearch::tell_breach() noexcept {
  const double far = std::sqrt(std::max(goal_d2_low_, 0.0)) - std::sqrt(arm_d2_high_);
  const double near = std::sqrt(arm_d2_low_) - std::sqrt(std::max(goal_d2_high_, 0.0));
  if (std::max(far, near) <= 0) return;
  out_.why = far > 0 ? IkErrc::out_of_reach : IkErrc::inner_void;
  out_.shape = far > 0 ? ReachShape::outer_sphere : ReachShape::inner_sphere;
  out_.amount = std::max(far, near);
  out_.bound = std::sqrt(far > 0 ? arm_d2_high_ : arm_d2_low_);
}

/// Evaluates one block and keeps what it met.
void SevenSearch::sample(const double* q7) noexcept {
  std::copy_n(q7, kBlock, q7_);
  kernel_(g_, goal_, q7_, block_);
  const int capacity = query_.all ? Branches::kCapacity : kKept;
  for (int branch = 0; branch < 8; ++branch) {
    for (int lane = 0; lane < kBlock; ++lane) {
      const double beyond = block_.beyond[branch][lane];
      if (beyond <= kWithin) {
        keep(within_, within_count_, capacity, block_.away[branch][lane], branch, lane);
      } else if (block_.open[branch][lane] <= kWithin) {
        keep(least_, least_count_, 1, beyond, branch, lane);
      } else {
        keep(closest_, closest_count_, 1, beyond, branch, lane);
      }
    }
  }
}

/// Puts the answer of `branch` and `lane` into a list sorted by rank.
void SevenSearch::keep(Met* list, int& count, int capacity, double rank, int branch,
                       int lane) noexcept {
  if (count == capacity && !(rank < list[count - 1].rank)) return;
  int i = count < capacity ? count++ : count - 1;
  for (; i > 0 && rank < list[i - 1].rank; --i) list[i] = list[i - 1];
  Met& met = list[i];
  met.rank = rank;
  met.branch = branch;
  met.q7 = q7_[lane];
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 3; ++j) met.angle[j][k] = block_.shoulder[branch][2 * j + k][lane];
    met.angle[3][k] = block_.elbow[branch / 4][k][lane];
    met.angle[4][k] = block_.wrist[branch / 2][k][lane];
    met.angle[5][k] = block_.wrist[branch / 2][2 + k][lane];
  }
}

/// Where the seed is close to an answer, Newton's steps from it find that one; near a singularity
/// they keep nearest to the seed. False where they lead elsewhere.
bool SevenSearch::step_from_seed() noexcept {
  constexpr double kClose = 0.01;  // [rad^2] weighted error after the first step
  DescentOptions options;
  options.pos_tol = query_.pos_tol;
  options.rot_tol = query_.rot_tol;
  options.max_iterations = 1;
  const JointVec seed = joint_vec({query_.near, 7});
  Descent descent = descend(chain_, query_.X_WT, seed, options);
  if (descent.error > kClose) return false;
  options.max_iterations = 8;
  descent = descend(chain_, query_.X_WT, descent.q, options);
  if (!descent.converged || (descent.q - seed).cwiseAbs().maxCoeff() > kNear) return false;
  std::copy_n(descent.q.data(), 7, out_.add());
  return true;
}

/// Puts the answer nearest to the seed first.
void SevenSearch::bring_nearest_to_front() noexcept {
  int nearest = 0;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < within_count_; ++i) {
    const double away = distance(within_[i]);
    if (away >= best) continue;
    best = away;
    nearest = i;
  }
  std::swap(within_[0], within_[nearest]);
}

/// Samples an interval about every `spacing` rad and notes where branches come near to their
/// limits.
void SevenSearch::scan(const Interval& interval, double spacing) noexcept {
  const double width = interval.b - interval.a;
  const int blocks = 1 + static_cast<int>(width / (kBlock * spacing));
  const int count = kBlock * blocks;
  const double step = kPi / (count - 1);
  double before[2][8];  // the last two samples of each branch
  std::fill_n(before[0], 16, std::numeric_limits<double>::infinity());
  for (int first = 0; first <= count; first += kBlock) {
    if (first < count) {
      double q7[kBlock];
      for (int lane = 0; lane < kBlock; ++lane) q7[lane] = interval.at((first + lane) * step);
      sample(q7);
    }
    const int last = first < count ? kBlock : 1;
    for (int branch = 0; branch < 8; ++branch) {
      for (int lane = 0; lane < last; ++lane) {
        const double value =
            first < count ? block_.beyond[branch][lane] : std::numeric_limits<double>::infinity();
        const double middle = before[1][branch];
        if (middle > kWithin && middle <= before[0][branch] && middle <= value) {
          const double left = before[0][branch] - middle;
          const double right = value - middle;
          const double drop =
              std::max(std::isfinite(left) ? left : 0.0, std::isfinite(right) ? right : 0.0);
          const int at = first + lane - 1;
          if (middle < 2 * drop)
            note({middle, branch, interval, std::max(at - 1, 0) * step,
                  std::min(at + 1, count - 1) * step});
        }
        before[0][branch] = middle;
        before[1][branch] = value;
      }
    }
  }
}

void SevenSearch::note(const Valley& valley) noexcept {
  if (valley_count_ == kValleys && !(valley.lowest < valleys_[kValleys - 1].lowest)) return;
  int i = valley_count_ < kValleys ? valley_count_++ : kValleys - 1;
  for (; i > 0 && valley.lowest < valleys_[i - 1].lowest; --i) valleys_[i] = valleys_[i - 1];
  valleys_[i] = valley;
}

void SevenSearch::descend_valleys() noexcept {
  for (int i = 0; i < valley_count_ && within_count_ == 0; ++i) follow(valleys_[i]);
}

/// The same once more with closer samples, for a pose that seems to break a limit. Where that finds
/// nothing, looks for the least breach, of joint 7 too.
void SevenSearch::search_finely() noexcept {
  valley_count_ = 0;
  if (least_count_ > 0 && least_[0].rank < kHopeless) {
    for (int i = 0; i < interval_count_; ++i) scan(intervals_[i], kSpacing / 8);
    descend_valleys();
  }
  if (within_count_ > 0) return;
  goal_.beyond_limits = true;
  const double middle = chain_.full_turn[6] ? query_.near[6] : g_.middle[6];
  scan({middle - kPi, middle + kPi}, 2 * kSpacing);
}

/// Narrows a valley, eight samples at a time, until an answer is met or none can be there.
void SevenSearch::follow(const Valley& valley) noexcept {
  double t0 = valley.t0;
  double t1 = valley.t1;
  for (int round = 0; round < 16; ++round) {
    const double step = (t1 - t0) / (kBlock + 1);
    double q7[kBlock];
    for (int lane = 0; lane < kBlock; ++lane) q7[lane] = valley.interval.at(t0 + (lane + 1) * step);
    sample(q7);
    const double* beyond = block_.beyond[valley.branch];
    const int lowest = static_cast<int>(std::min_element(beyond, beyond + kBlock) - beyond);
    if (beyond[lowest] <= kWithin) return;
    const double left = lowest > 0 ? beyond[lowest - 1] - beyond[lowest] : 0;
    const double right = lowest + 1 < kBlock ? beyond[lowest + 1] - beyond[lowest] : 0;
    if (beyond[lowest] > 3 * std::max(left, right)) return;
    t0 += lowest * step;
    t1 = t0 + 2 * step;
  }
}

/// Moves an answer along its branch to where it is nearest to the seed.
void SevenSearch::slide_towards_seed(Met& met) noexcept {
  double half = kSpacing;
  for (int round = 0; round < 3; ++round) {
    double q7[kBlock];
    for (int lane = 0; lane < kBlock; ++lane) {
      const double wish = met.q7 + half * (2 * lane - 7) / 9.0;
      q7[lane] = std::min(std::max(wish, chain_.lower[6]), chain_.upper[6]);
    }
    std::copy_n(q7, kBlock, q7_);
    kernel_(g_, goal_, q7_, block_);
    for (int lane = 0; lane < kBlock; ++lane) {
      const double away = block_.away[met.branch][lane];
      if (block_.beyond[met.branch][lane] > kWithin || !(away < met.rank)) continue;
      int count = 0;
      keep(&met, count, 1, away, met.branch, lane);
    }
    half *= 0.25;
  }
}

/// Largest joint distance to the seed [rad].
double SevenSearch::distance(const Met& met) const noexcept {
  double q[7];
  angles(met, q);
  double worst = 0;
  for (int i = 0; i < 7; ++i) {
    worst = std::max(worst,
                     std::abs(nearest_winding(chain_, i, q[i], query_.near[i]) - query_.near[i]));
  }
  return worst;
}

void SevenSearch::angles(const Met& met, double* q) const noexcept {
  for (int i = 0; i < 6; ++i) {
    const auto [c, s] = met.angle[i];
    q[i] = g_.middle[i] + std::atan2(s * g_.middle_cos[i] - c * g_.middle_sin[i],
                                     c * g_.middle_cos[i] + s * g_.middle_sin[i]);
  }
  q[6] = met.q7;
}

void SevenSearch::write(const Met& met) noexcept {
  double* const to = out_.add();
  if (to != nullptr) angles(met, to);
}

}  // namespace mjarm::detail
