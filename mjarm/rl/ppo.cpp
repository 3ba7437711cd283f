#include "mjarm/rl/ppo.hpp"

#include "mjarm/rl/option_table_internal.hpp"

namespace mjarm::rl {

std::string_view name(Schedule schedule) noexcept {
  return schedule == Schedule::constant ? "constant" : "linear";
}

Result<void> check(const PpoOptions& options) {
  detail::RangeCheck ranges;
  ranges("ppo", "threads", options.threads, detail::kThreads);
  detail::visit_ppo(options, ranges);
  return ranges.result();
}

}  // namespace mjarm::rl
