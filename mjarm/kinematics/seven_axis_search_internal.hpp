#pragma once

#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/descent_internal.hpp"
#include "mjarm/kinematics/seven_axis_block_internal.hpp"

namespace mjarm::detail {

/// One search of SevenAxis: everything about one pose.
class SevenSearch {
 public:
  SevenSearch(const SevenGeometry& geometry, const Chain& chain, const BranchQuery& query,
              Branches& out) noexcept;
  void run() noexcept;

 private:
  /// A range of the last joint [rad]. Sampled at a + (b - a) (1 - cos t) / 2, t in [0, pi], which
  /// takes away the square-root ends where a triangle ceases to close.
  struct Interval {
    double a, b;
    [[nodiscard]] double at(double t) const noexcept;
  };
  /// An answer met, angles as cosine and sine; joint 7 as its value.
  struct Met {
    double rank;  ///< smaller is nearer to the seed (within), or less beyond the limits
    int branch;
    double q7;
    double angle[6][2];
  };
  /// Where a branch comes nearest to its limits between three samples.
  struct Valley {
    double lowest;  ///< of the samples
    int branch;
    Interval interval;
    double t0, t1;  ///< the range of t
  };
  static constexpr int kKept = 6;
  static constexpr int kValleys = 24;
  static constexpr int kMaxIntervals = 6;

  void set_goal() noexcept;
  void find_intervals() noexcept;
  void add_arc(double from, double to, double low, double high) noexcept;
  void sample(const double* q7) noexcept;
  void scan(const Interval& interval, double spacing) noexcept;
  void follow(const Valley& valley) noexcept;
  void descend_valleys() noexcept;
  void search_finely() noexcept;
  bool step_from_seed() noexcept;
  void bring_nearest_to_front() noexcept;
  void slide_towards_seed(Met& met) noexcept;
  void keep(Met* list, int& count, int capacity, double rank, int branch, int lane) noexcept;
  void note(const Valley& valley) noexcept;
  void write(const Met& met) noexcept;
  void tell_breach() noexcept;
  [[nodiscard]] double distance(const Met& met) const noexcept;
  void angles(const Met& met, double* q) const noexcept;

  const SevenGeometry& g_;
  const Chain& chain_;
  const BranchQuery& query_;
  Branches& out_;
  SevenKernel kernel_;
  SevenGoal goal_;
  double q7_[kBlock];
  SevenBlock block_;
  Interval intervals_[kMaxIntervals];
  int interval_count_ = 0;
  Met within_[Branches::kCapacity];
  int within_count_ = 0;
  Met least_[1];  ///< breaks the limits least
  int least_count_ = 0;
  Met closest_[1];  ///< of those where a triangle does not close, the nearest to closing
  int closest_count_ = 0;
  Valley valleys_[kValleys];
  int valley_count_ = 0;
  static constexpr double kSpacing = 0.15;     ///< [rad] about the distance between samples
  double arm_d2_low_ = 0, arm_d2_high_ = 0;    ///< [m^2] |SW|^2 at the ends of the elbow's way
  double goal_d2_low_ = 0, goal_d2_high_ = 0;  ///< [m^2] |SW|^2 round the last axis
};

}  // namespace mjarm::detail
