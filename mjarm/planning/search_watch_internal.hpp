#pragma once

#include <algorithm>

#include "mjarm/planning/enclosure.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::detail {

/// Watches a search for a first path: tells the user how far it is, and looks once whether there is
/// a path at all.
class SearchWatch {
 public:
  /// @param samples  after so many the search ends.
  SearchWatch(const PlanOptions& options, int samples)
      : options_(options), proof_after_(std::min(samples, kProofSamples)) {}

  /// Whether it is proved that there is no path; to be asked after every few samples.
  /// @param nearest  [rad or m, L2] how near the trees came; infinite where that is not known.
  bool is_hopeless(int samples, double nearest) {
    if (options_.progress) options_.progress({samples, nearest});
    if (options_.enclosure == nullptr || samples < proof_after_) return false;
    return options_.enclosure->barrier() || options_.enclosure->find();
  }

  /// Why a search ended that was asked for as much.
  [[nodiscard]] PlanFailure why(int samples, double nearest) {
    PlanFailure out{.code = PlanErrc::budget_spent, .nearest = nearest, .samples = samples};
    if (options_.enclosure == nullptr || samples < proof_after_) return out;
    if (const auto& barrier = options_.enclosure->barrier()) {
      out.code = PlanErrc::barred;
      out.barrier = *barrier;
    } else if (const auto& pocket = options_.enclosure->find()) {
      out.code = PlanErrc::enclosed;
      out.pocket = *pocket;
    }
    return out;
  }

 private:
  static constexpr int kProofSamples = 2000;  // searches that are easy need fewer
  const PlanOptions& options_;
  int proof_after_;
};

}  // namespace mjarm::detail
