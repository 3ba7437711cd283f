#pragma once

#include "mjarm/core/messages.hpp"

namespace mjarm::msg {
#define MJARM_MSG(id, english, chinese) inline constexpr Msg id{english, chinese};
#include "apps/bench/messages/bench.inc"
#include "apps/bench/messages/bench_pick.inc"
#include "apps/bench/messages/bench_plan.inc"
#include "apps/bench/messages/bench_rl.inc"
#include "apps/bench/messages/control_suite.inc"
#undef MJARM_MSG
}  // namespace mjarm::msg
