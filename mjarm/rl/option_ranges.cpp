#include "mjarm/core/messages/rl.hpp"
#include "mjarm/rl/option_ranges_internal.hpp"

namespace mjarm::rl::detail {

std::string in_words(const OptionRange& range) {
  const bool bounded = range.most < std::numeric_limits<double>::max();
  if (!bounded) return text(range.above ? msg::rl_range_above : msg::rl_range_from, range.least);
  return text(range.above ? msg::rl_range_open : msg::rl_range_closed, range.least, range.most);
}

std::string range_fault(std::string_view name, const OptionRange& range, double value) {
  if (range.holds(value)) return {};
  return text(msg::rl_option_range, name, in_words(range), value);
}

}  // namespace mjarm::rl::detail
