#include "apps/mjarm/commands/plan_progress.hpp"

#include <cmath>

#include "apps/mjarm/messages/plan.hpp"

namespace mjarm::app {

PlanProgress::PlanProgress(PlanOptions& options) {
  if (!progress_.is_visible()) return;
  options.progress = [this](const SearchProgress& at) {
    progress_.show([&at] {
      if (!std::isfinite(at.nearest)) return text(msg::plan_searching, at.samples);
      return text(msg::plan_searching_near, at.samples, at.nearest);
    });
  };
}

}  // namespace mjarm::app
