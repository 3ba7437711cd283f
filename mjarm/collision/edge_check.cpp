#include "mjarm/collision/edge_check.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/collision/fast_access_internal.hpp"
#include "mjarm/collision/prove_edge.hpp"
#include "mjarm/collision/solid_scene_internal.hpp"

namespace mjarm {
namespace {

using detail::FastAccess;

constexpr std::size_t kMaxOpen = 2048;  // intervals that wait; more means: undecided
constexpr int kMaxWidth = 16;
constexpr std::size_t kMaxLeft = 512;    // intervals that wait to be looked at closer
constexpr int kMaxStations = 20'000;     // of an edge that is looked at closer
constexpr int kSphereRounds = 3;         // of a checker that looks closer, before it does
constexpr double kGrain = 0x1p-40;       // of places on an edge: sums of them are exact
constexpr float kUp = 1.0001F;           // more than rounding
constexpr double kCloserShare = 0x1p-6;  // of the resolution: exact distances leave no other room

/// So many floats fill whole registers.
constexpr std::size_t kWhole(int n) {
  return static_cast<std::size_t>((n + kMaxWidth - 1) / kMaxWidth * kMaxWidth);
}

/// t and half are sums of powers of two, which floats hold exactly.
struct OpenInterval {
  float t, half;
};

/// Intervals that wait, widest first.
struct IntervalQueue {
  std::array<OpenInterval, kMaxOpen> open;
  std::size_t size = 0;

  bool push(OpenInterval interval) {
    if (size == kMaxOpen) return false;
    open[size++] = interval;
    return true;
  }
};

class EdgeSearch {
 public:
  EdgeSearch(const FastChecker& checker, std::span<const double> q0, std::span<const double> q1,
             const EdgeOptions& options)
      : checker_(checker),
        data_(FastAccess::data(checker.robot())),
        solids_(FastAccess::solids(checker)),
        width_(checker.width()),
        closer_margins_(FastAccess::closer_margins(checker)) {
    double length = 0;
    for (std::size_t i = 0; i < q0.size(); ++i) {
      start_[i] = q0[i];
      way_[i] = q1[i] - q0[i];
      dq_[i] = static_cast<float>(way_[i]);
      length += way_[i] * way_[i];
      const detail::FastJoint& joint = data_.tables.joints[i];
      const double off = options.beside.empty() ? 0 : options.beside[i];
      const auto fits = [&](double q) { return q - off > joint.lower && q + off < joint.upper; };
      if (!fits(q0[i])) outside_ = 0;
      if (fits(q0[i]) && !fits(q1[i])) outside_ = std::min(outside_, 1.0);
    }
    length_ = std::sqrt(length);
    least_half_ = static_cast<float>(
        std::clamp(0.5 * options.resolution / std::max(length_, 1e-12), 0x1p-16, 1.0));
    bound_motion();
    if (!options.beside.empty()) bound_beside(options.beside);
  }

  EdgeResult run(std::vector<EdgeInterval>* proof) {
    proof_ = proof;
    if (checker_.fixed_overlap()) return {EdgeVerdict::hit, 0, 0};
    if (outside_ <= 1) return {EdgeVerdict::outside, outside_, 0};
    run_spheres();
    if (solids_ != nullptr && is_open_) run_solids();
    return result_;
  }

  double length() const { return length_; }

 private:
  void run_spheres() {
    IntervalQueue* now = &queues_[0];
    IntervalQueue* next = &queues_[1];
    split({0.5F, 0.5F}, width_, *now);
    for (int round = 1; now->size > 0 && is_open_; ++round) {
      next->size = 0;
      if (is_wide_) widen(now->open[0].half);
      for (std::size_t first = 0; first < now->size && is_open_; first += width_) {
        look(*now, first, *next);
      }
      if (is_open_ && solids_ != nullptr && round == kSphereRounds) return leave(*next);
      if (is_open_) refine(*next, *now);
    }
  }

  void leave(const IntervalQueue& rest) {
    for (std::size_t k = 0; k < rest.size && is_open_; ++k) {
      leave(rest.open[k].t, rest.open[k].half);
    }
  }

  /// For the solids.
  void leave(double t, double half) {
    if (left_size_ == left_->size()) return end(EdgeVerdict::undecided, t);
    (*left_)[left_size_++] = {t, half};
  }

  /// What spheres left: the middle of each interval proves what lies next to it; then what is left.
  void run_solids() {
    while (left_size_ > 0 && is_open_) {
      const std::size_t count = left_size_;
      std::swap(left_, looked_at_);
      left_size_ = 0;
      for (std::size_t k = 0; k < count && is_open_; ++k) {
        look_closer((*looked_at_)[k].t, (*looked_at_)[k].half);
      }
    }
  }

  void look_closer(double t, double half) {
    std::array<double, kMaxDof> q;
    const auto dof = static_cast<std::size_t>(data_.tables.dof);
    for (std::size_t i = 0; i < dof; ++i) q[i] = start_[i] + t * way_[i];
    double proved = solids_->free_half({q.data(), dof}, {way_.data(), dof}, half, closer_margins_);
    ++result_.stations;
    if (proved < 0) return end(EdgeVerdict::hit, t);
    if (proved < half) proved = std::floor(proved / kGrain) * kGrain;
    const double rest = 0.5 * (half - proved);
    if (proved < half && (proved < kCloserShare * static_cast<double>(least_half_) ||
                          result_.stations > kMaxStations)) {
      return end(EdgeVerdict::undecided, t);
    }
    if (proof_ != nullptr) proof_->push_back({t, proved});
    if (rest <= 0) return;
    leave(t - proved - rest, rest);
    if (is_open_) leave(t + proved + rest, rest);
  }

  /// Bounds of speeds and second derivatives along the edge, for every group and every pair.
  void bound_motion() {
    std::array<float, kMaxDof> rate, turn;
    std::array<float, kMaxDof + 1> before;  // rates of the joints before, summed
    before[0] = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(data_.tables.dof); ++k) {
      rate[k] = std::abs(dq_[k]);
      turn[k] = rate[k] * (rate[k] + 2 * before[k]);
      before[k + 1] = before[k] + rate[k];
    }
    const detail::FastRates rates{data_.tables.dof, rate.data(), turn.data(), before.data()};
    const auto bound = FastAccess::kernels(checker_).bound_motion;
    bound(rates, data_.group_levers.tables(), rate_.data(), bend_.data());
    bound(rates, data_.pair_levers.tables(), pair_rate_.data(), pair_bend_.data());
  }

  /// How far groups, pairs and solids get when every joint goes as far beside the edge as is asked.
  void bound_beside(std::span<const double> beside) {
    std::array<float, kMaxDof> rate, turn;
    std::array<float, kMaxDof + 1> before{};  // what bends does not matter
    for (std::size_t k = 0; k < beside.size(); ++k) rate[k] = static_cast<float>(beside[k]) * kUp;
    turn.fill(0);
    const detail::FastRates rates{data_.tables.dof, rate.data(), turn.data(), before.data()};
    const auto bound = FastAccess::kernels(checker_).bound_motion;
    bound(rates, data_.group_levers.tables(), wide_.data(), wide_bend_.data());
    bound(rates, data_.pair_levers.tables(), pair_wide_.data(), pair_wide_bend_.data());
    bare_bend_ = bend_;
    bare_pair_rate_ = pair_rate_;
    bare_pair_bend_ = pair_bend_;
    is_wide_ = true;
    if (solids_ == nullptr) return;
    const double most = solids_->farthest(beside);
    closer_margins_.obstacles += most;
    closer_margins_.links += most;
  }

  /// Intervals of a round are equally wide, and what lies beside them is part of how far they bend.
  void widen(float half) {
    const float share = kUp / (half * half), pair_share = kUp / half;
    for (std::size_t i = 0; i < wide_.size(); ++i) bend_[i] = bare_bend_[i] + share * wide_[i];
    for (std::size_t i = 0; i < pair_wide_.size(); ++i) {
      pair_rate_[i] = bare_pair_rate_[i] + pair_share * pair_wide_[i];
      pair_bend_[i] = bare_pair_bend_[i] + share * pair_wide_[i];
    }
  }

  bool split(OpenInterval whole, std::size_t parts, IntervalQueue& to) {
    const float half = whole.half / static_cast<float>(parts);
    for (std::size_t k = 0; k < parts; ++k) {
      const float t = whole.t - whole.half + half * static_cast<float>(2 * k + 1);
      if (!to.push({t, half})) return false;
    }
    return true;
  }

  /// One block of intervals; those that are not proved go to `rest`.
  void look(const IntervalQueue& queue, std::size_t first, IntervalQueue& rest) {
    const std::size_t count = std::min(width_, queue.size - first);
    const OpenInterval* const open = &queue.open[first];
    alignas(64) float t[kMaxWidth], half[kMaxWidth];
    for (std::size_t k = 0; k < width_; ++k) {
      const OpenInterval& interval = open[std::min(k, count - 1)];
      half[k] = interval.half;
      t[k] = interval.t;
    }
    const detail::FastMotion motion{start_.data(),    way_.data(),  dq_.data(),
                                    rate_.data(),     bend_.data(), pair_rate_.data(),
                                    pair_bend_.data()};
    const std::uint32_t lanes = (std::uint32_t{1} << count) - 1;
    const detail::FastVerdict found =
        FastAccess::kernels(checker_).cover(data_.tables, FastAccess::world(checker_).tables, lanes,
                                            motion, t, half, solids_ == nullptr);
    result_.stations += static_cast<int>(count);
    if (found.hit != 0 && solids_ == nullptr) {
      return end(EdgeVerdict::hit, open[__builtin_ctz(found.hit)].t);
    }
    for (std::size_t k = 0; k < count && is_open_; ++k) {
      if (((found.blocked >> k) & 1) == 0) {
        if (proof_ != nullptr) proof_->push_back({open[k].t, open[k].half});
      } else if (((found.hit >> k) & 1) != 0) {
        look_closer(open[k].t, open[k].half);
      } else if (solids_ != nullptr && open[k].half <= least_half_) {
        leave(open[k].t, open[k].half);
      } else if (open[k].half <= least_half_) {
        return end(EdgeVerdict::undecided, open[k].t);
      } else {
        rest.push(open[k]);
      }
    }
  }

  /// Cuts what is left in two, or in so many parts that all lanes have work.
  void refine(const IntervalQueue& rest, IntervalQueue& to) {
    to.size = 0;
    if (rest.size == 0) return;
    std::size_t parts = 2;
    while (rest.size * parts * 2 <= width_) parts *= 2;
    for (std::size_t k = 0; k < rest.size; ++k) {
      if (!split(rest.open[k], parts, to)) return end(EdgeVerdict::undecided, rest.open[k].t);
    }
  }

  void end(EdgeVerdict verdict, double t) {
    result_.verdict = verdict;
    result_.t = t;
    is_open_ = false;
  }

  /// Intervals that solids are to look at; not cleared when it is made.
  struct LeftInterval {
    double t, half;
  };
  using LeftIntervals = std::array<LeftInterval, kMaxLeft>;

  const FastChecker& checker_;
  const detail::FastRobotData& data_;
  const detail::SolidScene* solids_;  // null: spheres decide
  std::size_t width_;
  std::array<double, kMaxDof> start_, way_;
  std::array<float, kMaxDof> dq_;
  std::array<float, kWhole(detail::kFastGroups)> rate_, bend_;
  std::array<float, kWhole(detail::kFastPairs)> pair_rate_, pair_bend_;
  /// What lies beside the edge, and what rate_ and so on are without it.
  std::array<float, kWhole(detail::kFastGroups)> wide_, wide_bend_, bare_bend_;
  std::array<float, kWhole(detail::kFastPairs)> pair_wide_, pair_wide_bend_, bare_pair_rate_,
      bare_pair_bend_;
  bool is_wide_ = false;
  SphereMargins closer_margins_;
  double length_ = 0;
  double outside_ = 2;  // where the edge is outside of the limits; 2: nowhere
  float least_half_ = 0;
  IntervalQueue queues_[2];
  LeftIntervals some_, others_;
  LeftIntervals* left_ = &some_;
  LeftIntervals* looked_at_ = &others_;
  std::size_t left_size_ = 0;
  std::vector<EdgeInterval>* proof_ = nullptr;
  EdgeResult result_;
  bool is_open_ = true;
};

}  // namespace

EdgeResult check_edge(const FastChecker& checker, std::span<const double> q0,
                      std::span<const double> q1, const EdgeOptions& options) noexcept {
  assert(q0.size() == q1.size() && q0.size() == static_cast<std::size_t>(checker.robot().dof()));
  return EdgeSearch(checker, q0, q1, options).run(nullptr);
}

Result<EdgeCertificate, EdgeResult> prove_edge(const FastChecker& checker,
                                               std::span<const double> q0,
                                               std::span<const double> q1,
                                               const EdgeOptions& options) {
  EdgeCertificate out;
  EdgeSearch search(checker, q0, q1, options);
  const EdgeResult result = search.run(&out.intervals);
  if (result.verdict != EdgeVerdict::free) return tl::unexpected<EdgeResult>(result);
  std::sort(out.intervals.begin(), out.intervals.end(),
            [](const EdgeInterval& a, const EdgeInterval& b) { return a.t < b.t; });
  double half = 1;
  for (const EdgeInterval& interval : out.intervals) half = std::min(half, interval.half);
  out.step = 2 * half * search.length();
  return out;
}

Result<EdgeCertificate, EdgeResult> certify_edge(const FastChecker& checker,
                                                 std::span<const double> q0,
                                                 std::span<const double> q1,
                                                 const EdgeOptions& options) {
  Result<EdgeCertificate, EdgeResult> out = prove_edge(checker, q0, q1, options);
  if (!out) return out;
  std::vector<double> q;
  for (const EdgeInterval& interval : out->intervals) {
    for (std::size_t i = 0; i < q0.size(); ++i) {
      q.push_back(q0[i] + interval.t * (q1[i] - q0[i]));
    }
  }
  const FastChecker::LeastClearance least = checker.least_clearance(q);
  out->nearest = least.nearest;
  out->nearest_t = out->intervals[least.row].t;
  return out;
}

}  // namespace mjarm
