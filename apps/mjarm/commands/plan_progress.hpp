#pragma once

#include "mjarm/core/progress.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::app {

/// Tells on a terminal, as long as it lives, how far a search is and how near it came.
class PlanProgress {
 public:
  /// `options` tell it from then on.
  explicit PlanProgress(PlanOptions& options);

 private:
  Progress progress_{"", 0};
};

}  // namespace mjarm::app
